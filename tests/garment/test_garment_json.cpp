#include <sloper/base/error.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/io/files.hpp>

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <limits>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Two square panels sewn along one side: 8 panel vertices, 6 particles.
Garment two_squares() {
  Garment g;
  g.panels.name = "bag";
  g.panels.edge_length = 0.1;
  for (int k = 0; k < 2; ++k) {
    pattern::PanelInfo panel;
    panel.name = k == 0 ? "front" : "back";
    panel.first_vertex = 4 * k;
    panel.n_vertices = 4;
    panel.first_triangle = 2 * k;
    panel.n_triangles = 2;
    panel.material = k == 0 ? "" : "lining";
    panel.layer = k;
    panel.part = "torso";
    panel.outline = {4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3};
    g.panels.panels.push_back(panel);
    for (int i = 0; i < 4; ++i) {
      const double s = i == 1 || i == 2, t = i >= 2;
      g.panels.pattern.emplace_back(0.1 * s + 0.3 * k, 0.1 * t);
      g.panels.ids.push_back({k, s, t});
    }
    g.panels.triangles.push_back({4 * k, 4 * k + 1, 4 * k + 2});
    g.panels.triangles.push_back({4 * k, 4 * k + 2, 4 * k + 3});
  }
  g.panels.seams.push_back({"side", "seam", {1, 2}, {4, 7}, 0.1, 0.1});
  g.panels.findings = {{"test.fact"_id, "nothing to say"}};
  g.particle_of = {0, 1, 2, 3, 1, 4, 5, 2};
  g.position = {{0, 1, 0},   {0.1, 1, 0}, {0.1, 1.1, 1.0 / 3},
                {0, 1.1, 0}, {0.2, 1, 0}, {0.2, 1.1, 0}};
  for (const int p : g.particle_of)
    g.panels.placed.push_back(g.position[p]);
  g.materials["lining"].density_kg_m2 = 0.07;
  g.materials["lining"].source = "measured";
  g.rest_scale.assign(4, {1, 1, 1});
  g.rest_scale[2] = {0.9, 1, 1.1};
  g.bind.frames = {"torso", "arm_l"};
  g.bind.lengths_m = {0.5, 0.7};
  g.bind.marks = {{{"hip", 0.1}, {"bust", 0.7}}, {}};
  for (int p = 0; p < 6; ++p)
    g.bind.particles.push_back({{0, 0.75, 0.1 * p, 0.5, 0.01}, {1, 0.25, -0.1 * p, 1.5, 0.02}});
  g.converged = true;
  g.offset_m = 0.003;
  g.body_sha256 = "abc";
  g.body_girths_m = {{"bust", 0.9}};
  return g;
}

} // namespace

class GarmentJson : public ::testing::Test {
protected:
  void SetUp() override {
    m_folder = std::filesystem::temp_directory_path() /
               ("sloper-garment-json-" + std::to_string(::getpid()) +
                ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(m_folder);
  }
  void TearDown() override { std::filesystem::remove_all(m_folder); }
  std::string path(const std::string& name) const { return (m_folder / name).string(); }
  /// Writes a good garment, spoils one of its files and reads it: the message of the refusal.
  std::string refusal(const std::string& file, const std::string& from, const std::string& to) {
    write_garment(path("a.json"), two_squares(), "test");
    std::string text = io::read_file(path(file));
    const auto at = text.find(from);
    if (at == std::string::npos)
      return "the text to spoil is not there: " + from;
    text.replace(at, from.size(), to);
    io::write_file(path(file), text);
    try {
      read_garment(path("a.json"));
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::INPUT);
      return e.what();
    }
    return "accepted";
  }

private:
  std::filesystem::path m_folder;
};

TEST_F(GarmentJson, ReadingAndWritingAgainGivesTheSameBytes) {
  write_garment(path("a.json"), two_squares(), "test");
  const std::string json = io::read_file(path("a.json")), obj = io::read_file(path("a.obj"));
  write_garment(path("a.json"), read_garment(path("a.json")), "test");
  EXPECT_EQ(io::read_file(path("a.json")), json);
  EXPECT_EQ(io::read_file(path("a.obj")), obj);
}

TEST_F(GarmentJson, EverythingOfAGarmentSurvives) {
  Garment a = two_squares();
  a.panels.panels[1].in_folds = true;
  write_garment(path("a.json"), a, "test");
  const Garment b = read_garment(path("a.json"));
  EXPECT_EQ(b.particle_of, a.particle_of);
  EXPECT_EQ(b.position, a.position);
  EXPECT_EQ(b.panels.pattern, a.panels.pattern);
  EXPECT_EQ(b.panels.triangles, a.panels.triangles);
  EXPECT_EQ(b.panels.placed, a.panels.placed);
  ASSERT_EQ(b.panels.panels.size(), 2u);
  EXPECT_EQ(b.panels.panels[1].name, "back");
  EXPECT_EQ(b.panels.panels[1].outline, a.panels.panels[1].outline);
  EXPECT_EQ(b.panels.panels[1].layer, 1);
  EXPECT_TRUE(b.panels.panels[1].in_folds);
  EXPECT_FALSE(b.panels.panels[0].in_folds);
  EXPECT_EQ(b.panels.seams[0].b, a.panels.seams[0].b);
  EXPECT_EQ(b.panels.ids[6].panel, 1);
  EXPECT_EQ(b.panels.ids[6].s, 1);
  EXPECT_EQ(b.materials.at("lining").density_kg_m2, 0.07);
  EXPECT_EQ(b.rest_scale, a.rest_scale);
  EXPECT_EQ(b.bind.marks, a.bind.marks);
  EXPECT_EQ(b.bind.particles[3][1].z, 1.5);
  EXPECT_EQ(b.body_girths_m, a.body_girths_m);
  EXPECT_EQ(b.body_sha256, "abc");
  EXPECT_TRUE(b.converged);
}

TEST_F(GarmentJson, AnUnsewnGarmentKeepsItsPlacedPanels) {
  Garment a = two_squares();
  a.particle_of.clear();
  a.position.clear();
  a.bind = {};
  write_garment(path("a.json"), a, "test");
  const Garment b = read_garment(path("a.json"));
  EXPECT_TRUE(b.particle_of.empty());
  EXPECT_EQ(b.panels.placed, a.panels.placed);
}

TEST_F(GarmentJson, DamagedDocumentsAreRefusedWithTheirPlace) {
  EXPECT_NE(refusal("a.json", "\"version\": 1", "\"version\": 9").find("newer"), std::string::npos);
  EXPECT_NE(refusal("a.json", "\"format\": \"garment\"", "\"format\": \"body\"").find("/format"),
            std::string::npos);
  EXPECT_NE(refusal("a.json", "\"vertices\": 4", "\"vertices\": 3").find("/panels"),
            std::string::npos);
  EXPECT_NE(refusal("a.json", "\"a\": [1, 2]", "\"a\": [1, 99]").find("/seams/0/a/1"),
            std::string::npos);
  EXPECT_NE(refusal("a.json", "\"a\": [1, 2]", "\"a\": [1]").find("same number of vertices"),
            std::string::npos);
  EXPECT_NE(refusal("a.json", "\"grain\": [0, 1]", "\"grain\": [0, 0]").find("grain"),
            std::string::npos);
  EXPECT_NE(refusal("a.json", "[0, 0.75", "[0, 0.5").find("sum to one"), std::string::npos);
  EXPECT_NE(refusal("a.json", "[0, 0.75", "[7, 0.75").find("/bind/particles/0"), std::string::npos);
  EXPECT_NE(refusal("a.json", "[2, 0.9", "[2, -0.9").find("/rest_scale/0"), std::string::npos);
  EXPECT_NE(refusal("a.json", "\"density_kg_m2\": 0.07", "\"density_kg_m2\": 0").find("density"),
            std::string::npos);
  EXPECT_NE(refusal("a.obj", "f 1/1", "f 9/1").find("a.obj"), std::string::npos);
  EXPECT_NE(refusal("a.obj", "f 1/1", "f 1/3").find("two particles"), std::string::npos);
  EXPECT_NE(refusal("a.obj", "f 1/1", "f 1").find("pattern coordinates"), std::string::npos);
  EXPECT_NE(refusal("a.obj", "v 0 1 0\n", "v nan 1 0\n").find("line"), std::string::npos);
}

TEST_F(GarmentJson, AnExchangedMeshOfTheSameTopologyIsNamed) {
  write_garment(path("a.json"), two_squares(), "test");
  EXPECT_TRUE(read_garment(path("a.json")).file_findings.empty());
  io::ObjMesh other = io::read_obj(path("a.obj"));
  for (Vec3& p : other.positions)
    p.y() += 0.01;
  io::write_obj(path("a.obj"), other, "of another program");
  const Garment read = read_garment(path("a.json"));
  ASSERT_EQ(read.file_findings.size(), 1u);
  EXPECT_EQ(read.file_findings[0].id, "file.mesh-changed");
}

TEST_F(GarmentJson, AMissingMeshIsRefused) {
  write_garment(path("a.json"), two_squares(), "test");
  std::filesystem::remove(path("a.obj"));
  EXPECT_THROW(read_garment(path("a.json")), Error);
}

TEST_F(GarmentJson, WhatIsNotFiniteIsNeverWritten) {
  Garment a = two_squares();
  a.position[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_garment(path("a.json"), a, "test"), Error);
  EXPECT_FALSE(std::filesystem::exists(path("a.obj")));
  a = two_squares();
  a.bind.particles[1][0].gap = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_garment(path("a.json"), a, "test"), Error);
  EXPECT_FALSE(std::filesystem::exists(path("a.json")));
  EXPECT_FALSE(std::filesystem::exists(path("a.obj")));
}
