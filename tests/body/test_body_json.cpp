#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/body/export/exports.hpp>
#include <sloper/io/files.hpp>

#include <algorithm>
#include <filesystem>
#include <unistd.h>

using namespace sloper;
using namespace sloper::body;

namespace {

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("sloper-body-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

} // namespace

TEST(BodyDocument, comes_back_as_it_was_written) {
  const Folder folder;
  const Body written = test::measure(test::mannequin("f-165-a").mesh).body;
  write_body(folder.file("a.body.json"), written, "scan-landmarks");
  ASSERT_TRUE(std::filesystem::exists(folder.file("a.body.obj")));
  const Body read = read_body(folder.file("a.body.json"));
  ASSERT_EQ(read.landmarks.size(), written.landmarks.size());
  for (const auto& [name, landmark] : written.landmarks) {
    EXPECT_LT((read.landmark(name) - landmark.p).norm(), 2e-6) << name;
    EXPECT_EQ(read.landmarks.at(name).rule, landmark.rule);
  }
  ASSERT_EQ(read.frames.size(), written.frames.size());
  for (const auto& [name, frame] : written.frames) {
    EXPECT_EQ(read.frames.at(name).frame.mirrored, frame.frame.mirrored);
    EXPECT_NEAR(read.frames.at(name).profile.at(0.3, 0.5), frame.profile.at(0.3, 0.5), 2e-6);
  }
  EXPECT_EQ(read.skin.triangles.size(), written.skin.triangles.size());
  std::map<Part, int> before, after;
  for (Part part : written.face_part)
    ++before[part];
  for (Part part : read.face_part)
    ++after[part];
  EXPECT_EQ(before, after);
  EXPECT_EQ(read.bones.size(), written.bones.size());
  EXPECT_EQ(read.levels.size(), written.levels.size());
}

TEST(BodyDocument, names_an_exchanged_skin_of_the_same_topology) {
  const Folder folder;
  write_body(folder.file("a.json"), test::measure(test::mannequin("f-165-a").mesh).body,
             "scan-landmarks");
  EXPECT_TRUE(read_body(folder.file("a.json")).file_findings.empty());
  std::string skin = io::read_file(folder.file("a.obj"));
  skin[skin.find("\nv ") + 4] = '9';
  io::write_file(folder.file("a.obj"), skin);
  const Body read = read_body(folder.file("a.json"));
  ASSERT_EQ(read.file_findings.size(), 1u);
  EXPECT_EQ(read.file_findings[0].id, "file.mesh-changed");
}

TEST(BodyDocument, writing_twice_gives_the_same_bytes) {
  const Folder folder;
  write_body(folder.file("a.json"), test::measure(test::mannequin("f-165-a").mesh).body,
             "scan-landmarks");
  write_body(folder.file("b.json"), test::measure(test::mannequin("f-165-a").mesh).body,
             "scan-landmarks");
  EXPECT_EQ(io::read_file(folder.file("a.obj")), io::read_file(folder.file("b.obj")));
}

TEST(BodyDocument, without_its_skin_is_read_too_and_names_nobody) {
  const Folder folder;
  Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  anonymise(body);
  write_body(folder.file("a.json"), body, "scan-landmarks");
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.obj")));
  const Body read = read_body(folder.file("a.json"));
  EXPECT_TRUE(read.skin.triangles.empty());
  EXPECT_EQ(read.frames.size(), body.frames.size());
  EXPECT_EQ(io::read_file(folder.file("a.json")).find("scan.obj"), std::string::npos);
}

TEST(Exports, the_table_has_a_row_for_every_girth_and_two_for_every_level) {
  const Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  const std::string csv = measurements_csv(body);
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
            2 + body.girths.size() + 2 * body.levels.size());
  EXPECT_NE(csv.find("level_girth,bust,"), std::string::npos);
  EXPECT_NE(csv.find("bust girth"), std::string::npos);
}

TEST(Exports, the_skeleton_has_a_line_for_every_bone) {
  const Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  const std::string obj = skeleton_obj(body);
  std::size_t lines = 0;
  for (std::size_t at = obj.find("\nl "); at != std::string::npos; at = obj.find("\nl ", at + 1))
    ++lines;
  EXPECT_EQ(lines, body.bones.size());
  EXPECT_GE(lines, 15u);
}

TEST(BodyDocument, of_a_newer_version_is_refused) {
  const Folder folder;
  io::write_file(folder.file("a.json"),
                 R"({"format": "body", "version": 99, "generator": "x", "length_unit": "m"})");
  EXPECT_THROW(read_body(folder.file("a.json")), Error);
}

TEST(BodyDocument, asking_for_a_landmark_that_was_not_found_names_it) {
  Body body;
  body.scan.file = "scan.obj";
  try {
    body.landmark("crotch");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("crotch"), std::string::npos);
  }
}
