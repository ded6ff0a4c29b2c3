/// Accuracy on scans with known truth that are not part of the repository: SLOPER_SHARED names
/// their folder.
#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/io/json.hpp>
#include <sloper/io/scan_reader.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace sloper;
using namespace sloper::body;

namespace {

/// Errors of all trusted landmarks of one scan in metres, missing ones counted apart.
struct Errors {
  std::vector<double> found;
  int missing = 0;
};

/// Whether the findings say that an arm which touches the trunk hides the pit that a landmark
/// belongs to: what cannot be seen is not found.
bool reported_hidden(const Body& body, const std::string& name) {
  const bool of_pit = name.rfind("axilla", 0) == 0;
  return of_pit &&
         std::any_of(body.scan.findings.begin(), body.scan.findings.end(), [&](const Finding& f) {
           return f.place == std::string("axilla_") + name.back() &&
                  f.what.find("not found") != std::string::npos;
         });
}

Errors errors_of(const std::filesystem::path& truth_file) {
  const io::Json truth = io::read_json(truth_file.string());
  const io::Scan scan =
      io::read_scan((truth_file.parent_path() / truth["mesh"]["file"].get<std::string>()).string());
  const MeasuredScan measured = test::measure(scan.mesh);
  Mat4 body_to_file = Mat4::Identity();
  if (truth.contains("corruption") && truth["corruption"].contains("matrix_body_m_to_file"))
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) {
        const io::Json& m = truth["corruption"]["matrix_body_m_to_file"];
        body_to_file(r, c) = m[0].is_array() ? m[r][c].get<double>() : m[4 * r + c].get<double>();
      }
  const Eigen::Matrix3d to_body = body_to_file.block<3, 3>(0, 0).inverse();
  Errors errors;
  for (const auto& [name, entry] : truth["landmarks"].items()) {
    if (!entry.contains("p") || entry["p"].is_null() || entry.value("trust", "") == "low")
      continue;
    if (!measured.body.has_landmark(name)) {
      errors.missing += !reported_hidden(measured.body, name);
      continue;
    }
    const Vec3 off = to_body * (test::in_scan(measured.body, name) -
                                Vec3(entry["p"][0], entry["p"][1], entry["p"][2]));
    double sum = 0;
    for (const char axis : entry.value("compare", "xyz"))
      sum += off[axis - 'x'] * off[axis - 'x'];
    errors.found.push_back(std::sqrt(sum));
  }
  return errors;
}

void expect_accuracy(const std::string& folder, double median_bound, double p95_bound,
                     int missing_bound) {
  const char* shared = std::getenv("SLOPER_SHARED");
  if (!shared)
    GTEST_SKIP() << "SLOPER_SHARED is not set";
  Errors all;
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(shared) /
                                                               "data" / "bodies" / folder))
    if (entry.path().string().ends_with(".truth.json"))
      files.insert(entry.path());
  if (files.empty())
    GTEST_SKIP() << "no truth in " << folder;
  for (const auto& file : files) {
    const Errors one = errors_of(file);
    all.found.insert(all.found.end(), one.found.begin(), one.found.end());
    all.missing += one.missing;
  }
  std::sort(all.found.begin(), all.found.end());
  EXPECT_LT(all.found[all.found.size() / 2], median_bound);
  EXPECT_LT(all.found[all.found.size() * 95 / 100], p95_bound);
  EXPECT_LE(all.missing, missing_bound);
}

} // namespace

TEST(SharedAccuracy, of_plain_bodies) {
  expect_accuracy("plain", 0.005, 0.018, 2);
}
TEST(SharedAccuracy, of_corrupted_scans) {
  expect_accuracy("corrupted", 0.0065, 0.024, 5);
}

/// Skin between these legs hangs lower than where they join, so that no trunk is in the first
/// levels above the crotch.
TEST(SharedAccuracy, tells_the_average_figures_of_another_source_apart) {
  const char* shared = std::getenv("SLOPER_SHARED");
  const std::filesystem::path folder =
      std::filesystem::path(shared ? shared : "") / "data/bodies/smpl";
  if (!shared || !std::filesystem::exists(folder))
    GTEST_SKIP() << "SLOPER_SHARED names no folder with data/bodies/smpl";
  for (const char* sex : {"f", "m"}) {
    const io::Scan scan =
        io::read_scan((folder / (std::string(sex) + "_smpl_average_A40.obj")).string());
    const Body body = test::measure(scan.mesh).body;
    EXPECT_EQ(body.body_class.rfind(*sex == 'f' ? "female figure" : "male figure", 0), 0u)
        << body.body_class;
    for (const Finding& finding : body.scan.findings)
      EXPECT_FALSE(finding.place == "crotch" && finding.severity == "warning") << finding.what;
  }
}

/// Borders by the modeller's parts: they tilt with the head, rise outside of the hip joint and bend
/// around the shoulder.
TEST(SharedAccuracy, of_the_parts_of_plain_bodies) {
  const char* shared = std::getenv("SLOPER_SHARED");
  const std::filesystem::path folder =
      std::filesystem::path(shared ? shared : "") / "data/bodies/plain";
  std::ifstream file(folder / "vertex_parts.txt");
  if (!shared || !file)
    GTEST_SKIP() << "SLOPER_SHARED names no folder with data/bodies/plain/vertex_parts.txt";
  std::vector<int> parts;
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line.front() != '#')
      parts.push_back(std::stoi(line));
  double sum = 0;
  int bodies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj")
      continue;
    const MeasuredScan measured = test::measure(io::read_scan(entry.path().string()).mesh);
    if (measured.vertex_part.size() != parts.size())
      continue;
    int agree = 0;
    for (std::size_t v = 0; v < parts.size(); ++v)
      agree += static_cast<int>(measured.vertex_part[v]) == parts[v];
    sum += static_cast<double>(agree) / static_cast<double>(parts.size());
    ++bodies;
  }
  ASSERT_GT(bodies, 0);
  EXPECT_GT(sum / bodies, 0.993);
}
