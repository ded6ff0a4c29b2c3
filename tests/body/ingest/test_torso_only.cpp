/// A torso without legs: what it shows is found, the rest is not.
#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

/// What stands above a height, with the hands and arms that hang lower where they are wanted.
TriangleMesh above(const test::MadeFigure& figure, double height, bool keeps_arms) {
  std::vector<int> number(figure.mesh.positions.size(), -1);
  TriangleMesh torso;
  for (std::size_t v = 0; v < number.size(); ++v) {
    const bool arm = figure.parts[v] == 2 || figure.parts[v] == 3;
    if (figure.mesh.positions[v].y() < height && !(arm && keeps_arms))
      continue;
    number[v] = static_cast<int>(torso.positions.size());
    torso.positions.push_back(figure.mesh.positions[v]);
  }
  for (const Triangle& t : figure.mesh.triangles)
    if (number[t[0]] >= 0 && number[t[1]] >= 0 && number[t[2]] >= 0)
      torso.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return torso;
}

ScanOptions torso_only() {
  ScanOptions options;
  options.torso_only = true;
  return options;
}

} // namespace

TEST(TorsoOnly, without_the_option_is_refused_and_the_option_is_named) {
  const TriangleMesh torso = above(test::mannequin("f-165-a"), 0.85, false);
  try {
    test::measure(torso);
    FAIL() << "was taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("--torso-only"), std::string::npos) << e.what();
  }
}

TEST(TorsoOnly, shows_head_neck_arms_and_chest_where_they_are_and_no_legs) {
  for (const char* name : {"f-165-a", "m-185-t"}) {
    const test::MadeFigure& figure = test::mannequin(name);
    const Body whole = test::measure(figure.mesh).body;
    const double cut = test::in_scan(whole, "crotch").y() + 0.04;
    for (const double degrees : {75.0}) {
      const Eigen::Matrix3d turn = test::turn_about_y(degrees);
      const MeasuredScan measured =
          test::measure(test::moved(above(figure, cut, true), turn, Vec3::Zero()), torso_only());
      EXPECT_TRUE(measured.missing.empty())
          << name << ": " << ::testing::PrintToString(measured.missing);
      for (const char* part : {"head_tip", "neck_front", "neck_back", "hand_tip_l", "hand_tip_r",
                               "wrist_l", "shoulder_joint_r", "axilla_l"}) {
        ASSERT_TRUE(measured.body.has_landmark(part)) << name << ": " << part;
        EXPECT_LT((turn * test::in_scan(whole, part) - test::in_scan(measured.body, part)).norm(),
                  0.03)
            << name << ": " << part;
      }
      for (const char* part :
           {"crotch", "hip_joint_l", "hip_center", "knee_l", "ankle_r", "foot_tip_l"})
        EXPECT_FALSE(measured.body.has_landmark(part))
            << name << ": " << part << " is not in the scan";
      EXPECT_EQ(measured.body.girths.count("thigh_l"), 0u);
      const auto said = std::count_if(measured.body.scan.findings.begin(),
                                      measured.body.scan.findings.end(), [](const Finding& f) {
                                        return f.what.starts_with("torso only") ||
                                               f.what.starts_with("not in this scan");
                                      });
      EXPECT_EQ(said, 2);
    }
  }
}

TEST(TorsoOnly, with_thighs_shows_the_crotch) {
  const test::MadeFigure& figure = test::mannequin("f-165-a");
  const Body whole = test::measure(figure.mesh).body;
  const Vec3 crotch = test::in_scan(whole, "crotch");
  const Body body = test::measure(above(figure, crotch.y() - 0.12, true), torso_only()).body;
  ASSERT_TRUE(body.has_landmark("crotch"));
  EXPECT_NEAR(test::in_scan(body, "crotch").y(), crotch.y(), 0.015);
  EXPECT_FALSE(body.has_landmark("knee_l"));
}

TEST(TorsoOnly, of_a_whole_person_changes_nothing) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  const Body with = test::measure(mesh, torso_only()).body, without = test::measure(mesh).body;
  EXPECT_EQ(with.landmarks.size(), without.landmarks.size());
}

TEST(TorsoOnly, what_has_no_head_is_refused) {
  TriangleMesh legs;
  const test::MadeFigure& figure = test::mannequin("f-165-a");
  for (const Vec3& p : figure.mesh.positions)
    if (p.y() < 0.7)
      legs.positions.push_back(p);
  EXPECT_THROW(test::measure(legs, torso_only()), Error);
}
