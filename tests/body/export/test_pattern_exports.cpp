#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/body/export/exports.hpp>

#include <sstream>

using namespace sloper;
using namespace sloper::body;

namespace {

/// NAME: VALUE lines of the YAML.
std::map<std::string, double> values_of(const std::string& yaml) {
  std::map<std::string, double> values;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("  ") && colon != std::string::npos)
      values[line.substr(2, colon - 2)] = std::stod(line.substr(colon + 2));
  }
  return values;
}

} // namespace

TEST(GarmentCodeBody, has_every_measure_in_centimetres_and_of_a_persons_size) {
  const Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  const auto values = values_of(garmentcode_body(body));
  const std::map<std::string, std::pair<double, double>> ranges = {
      {"height", {160, 170}},
      {"head_l", {22, 32}},
      {"neck_w", {8, 18}},
      {"shoulder_w", {30, 48}},
      {"armscye_depth", {10, 26}},
      {"arm_length", {42, 65}},
      {"wrist", {12, 20}},
      {"waist", {55, 100}},
      {"waist_line", {28, 48}},
      {"waist_over_bust_line", {30, 55}},
      {"waist_back_width", {25, 50}},
      {"bust_line", {12, 32}},
      {"bust", {75, 115}},
      {"bust_points", {12, 26}},
      {"underbust", {65, 100}},
      {"back_width", {30, 55}},
      {"hips", {80, 120}},
      {"hip_back_width", {35, 65}},
      {"hips_line", {12, 30}},
      {"bum_points", {0.1, 24}},
      {"crotch_hip_diff", {3, 16}},
      {"leg_circ", {45, 75}},
      {"shoulder_incl", {0, 35}},
      {"hip_inclination", {-5, 25}},
      {"arm_pose_angle", {20, 70}}};
  for (const auto& [name, range] : ranges) {
    ASSERT_TRUE(values.count(name)) << name;
    EXPECT_GT(values.at(name), range.first) << name;
    EXPECT_LT(values.at(name), range.second) << name;
  }
  EXPECT_EQ(values.size(), ranges.size());
  EXPECT_LT(values.at("waist_back_width"), values.at("waist"));
  EXPECT_NEAR(values.at("hips"), 100 * body.levels.at("hip").girth_m, 0.006);
}

TEST(ValentinaMeasurements, are_xml_in_centimetres_without_a_statement_about_the_person) {
  const Body body = test::measure(test::mannequin("m-178-a").mesh).body;
  const std::string text = valentina_measurements(body);
  EXPECT_NE(text.find("<unit>cm</unit>"), std::string::npos);
  EXPECT_NE(text.find("<gender>unknown</gender>"), std::string::npos);
  EXPECT_EQ(text.find("<given-name/>") == std::string::npos, false);
  std::size_t open = 0, rows = 0;
  for (std::size_t at = text.find("<m name="); at != std::string::npos;
       at = text.find("<m name=", at + 1)) {
    ++rows;
    const std::size_t value = text.find("value=\"", at) + 7;
    EXPECT_GT(std::stod(text.substr(value)), 1) << text.substr(at, 60);
    EXPECT_LT(std::stod(text.substr(value)), 250) << text.substr(at, 60);
    open += text.find("/>", at) == std::string::npos;
  }
  EXPECT_GT(rows, 28u);
  EXPECT_EQ(open, 0u);
  for (const char* name : {"height", "bust_circ", "waist_circ", "hip_circ", "leg_crotch_to_floor",
                           "arm_shoulder_tip_to_wrist", "neck_back_to_waist_b"})
    EXPECT_NE(text.find("name=\"" + std::string(name) + "\""), std::string::npos) << name;
}

TEST(PatternExports, leave_out_what_was_not_found) {
  Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  body.levels.erase("waist_semantic");
  body.landmarks.erase("neck_back");
  const auto values = values_of(garmentcode_body(body));
  EXPECT_FALSE(values.count("waist"));
  EXPECT_FALSE(values.count("waist_line"));
  EXPECT_FALSE(values.count("head_l"));
  EXPECT_TRUE(values.count("hips"));
  EXPECT_EQ(valentina_measurements(body).find("waist_circ"), std::string::npos);
}
