/// All patterns of the shared data set, when SLOPER_SHARED names its folder.
#include <support/mesh_quality.hpp>
#include <support/pattern_texts.hpp>

#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

namespace sloper::pattern::test {
namespace {

std::vector<std::string> shared_patterns() {
  std::vector<std::string> files;
  const char* shared = std::getenv("SLOPER_SHARED");
  if (!shared)
    return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(shared) / "data/patterns")) {
    const std::string name = entry.path().string();
    const auto ends = [&](const std::string& tail) {
      return name.size() > tail.size() &&
             name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
    };
    if (ends("_specification.json") || ends(".sew.json") || ends(".dxf"))
      files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(SharedPatterns, AllMeshIntoOrientedManifoldsWithGoodAnglesAndTheRightArea) {
  const auto files = shared_patterns();
  if (files.empty())
    GTEST_SKIP() << "SLOPER_SHARED is not set";
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Pattern pattern = read_pattern(file, "");
    const PanelMesh mesh = mesh_pattern(pattern, 0.015, file);
    EXPECT_EQ(mesh.seams.size(), pattern.seams.size());
    EXPECT_GE(smallest_angle_deg(mesh), 25);
    for (const MeshSeam& s : mesh.seams)
      EXPECT_EQ(s.a.size(), s.b.size());
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
      EXPECT_NEAR(mesh_area(mesh, mesh.panels[p]) / outline_area(pattern.panels[p]), 1, 1e-3)
          << mesh.panels[p].name;
    const Sewn sewn = sew(mesh);
    EXPECT_EQ(sewn.degenerate, 0);
    EXPECT_EQ(sewn.duplicate_faces, 0);
    EXPECT_EQ(sewn.wrong_direction, 0);
    EXPECT_EQ(sewn.non_manifold, 0);
    EXPECT_GE(sewn.boundary_loops, 2);
    EXPECT_LE(sewn.boundary_loops, 4);
  }
}

TEST(SharedPatterns, SidecarAndTextsSewTheSame) {
  const auto files = shared_patterns();
  if (files.empty())
    GTEST_SKIP() << "SLOPER_SHARED is not set";
  for (const std::string& file : files) {
    const std::string stem = file.substr(0, file.rfind('.'));
    if (!std::filesystem::exists(stem + ".seams.json"))
      continue;
    const Pattern by_texts = read_pattern(file, "");
    Pattern by_sidecar = by_texts;
    by_sidecar.seams.clear();
    read_sewing_seams(by_sidecar, io::read_json(stem + ".seams.json"), stem + ".seams.json");
    EXPECT_EQ(by_texts.seams.size(), by_sidecar.seams.size()) << file;
    EXPECT_EQ(sew(mesh_pattern(by_sidecar, 0.02, file)).boundary_loops,
              sew(mesh_pattern(by_texts, 0.02, file)).boundary_loops)
        << file;
  }
}

} // namespace
} // namespace sloper::pattern::test
