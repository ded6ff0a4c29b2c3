#include <support/figures.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace sloper;
using namespace sloper::body;
using test::measure;

namespace {

/// The mesh without the faces that have a corner where `is_cut` holds, and without their vertices.
template<class IsCut> TriangleMesh without(const TriangleMesh& whole, const IsCut& is_cut) {
  TriangleMesh rest;
  std::vector<int> number(whole.positions.size(), -1);
  for (Triangle t : whole.triangles) {
    if (std::any_of(t.begin(), t.end(), [&](int v) { return is_cut(whole.positions[v]); }))
      continue;
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(rest.positions.size());
        rest.positions.push_back(whole.positions[v]);
      }
      v = number[v];
    }
    rest.triangles.push_back(t);
  }
  return rest;
}

bool is_warned_of(const Body& body, const std::string& place) {
  const std::vector<Finding>& all = body.scan.findings;
  return std::any_of(all.begin(), all.end(), [&](const Finding& finding) {
    return finding.place == place && finding.severity == "warning";
  });
}

} // namespace

TEST(IncompleteScan, a_missing_hand_is_reported) {
  const test::MadeFigure& made = test::mannequin("f-165-a");
  auto reported = [](const Body& body) {
    int n = 0;
    for (const Finding& f : body.scan.findings)
      n += f.what.find("the hand is missing") != std::string::npos;
    return n;
  };
  const Body whole = measure(made.mesh).body;
  EXPECT_EQ(reported(whole), 0);
  const Vec3 wrist = test::in_scan(whole, "wrist_l"), tip = test::in_scan(whole, "hand_tip_l");
  const TriangleMesh cut = without(
      made.mesh, [&](const Vec3& p) { return p.x() > 0.3 && (p - wrist).dot(tip - wrist) > 0; });
  const Body body = measure(cut).body;
  EXPECT_EQ(reported(body), 1);
  EXPECT_LT(body.landmarks.at("hand_tip_l").confidence, 0.15);
  EXPECT_GT(body.landmarks.at("hand_tip_r").confidence, 0.5);
  EXPECT_LT((test::in_scan(body, "wrist_l") - wrist).norm(), 0.035) << "where the arm ends";
  EXPECT_LT((test::in_scan(body, "elbow_l") - test::in_scan(whole, "elbow_l")).norm(), 0.035)
      << "not half a hand's length off";
}

TEST(IncompleteScan, an_arm_that_ends_in_a_stump_is_measured_and_its_ends_are_reported) {
  const test::MadeFigure& made = test::mannequin("m-178-a");
  const Body whole = measure(made.mesh).body;
  const Vec3 shoulder = test::in_scan(whole, "shoulder_joint_l"),
             wrist = test::in_scan(whole, "wrist_l");
  for (const double share : {0.85, 0.7}) { // of the distance to the wrist
    const MeasuredScan measured = measure(without(made.mesh, [&](const Vec3& p) {
      return p.x() > 0.2 &&
             (p - shoulder).dot(wrist - shoulder) > share * (wrist - shoulder).squaredNorm();
    }));
    const Body& body = measured.body;
    EXPECT_TRUE(measured.missing.empty()) << share;
    EXPECT_TRUE(measured.doubts.empty()) << share;
    for (const char* name : {"hand_tip_l", "wrist_l", "elbow_l", "olecranon_l"})
      EXPECT_TRUE(is_warned_of(body, name)) << share << " " << name;
    EXPECT_FALSE(is_warned_of(body, "wrist_r"));
    for (const char* name :
         {"shoulder_joint_l", "acromion_l", "axilla_l", "elbow_r", "waist_side_l"})
      EXPECT_LT((test::in_scan(body, name) - test::in_scan(whole, name)).norm(), 0.02)
          << share << " " << name;
    EXPECT_LT((test::in_scan(body, "elbow_l") - test::in_scan(whole, "elbow_l")).norm(), 0.035)
        << share << ": as far from the shoulder as people's is";
    EXPECT_LT((test::in_scan(body, "hand_extreme_l") - shoulder).norm(), (wrist - shoulder).norm())
        << share << ": on the stump";
  }
}

TEST(IncompleteScan, legs_that_end_without_feet_are_refused) {
  const TriangleMesh& whole = test::mannequin("m-178-a").mesh;
  for (const double floor_m : {0.06, 0.10, 0.42}) {
    const MeasuredScan measured =
        measure(without(whole, [&](const Vec3& p) { return p.y() < floor_m; }));
    ASSERT_FALSE(measured.doubts.empty()) << floor_m;
    EXPECT_EQ(measured.doubts.front().id, "scan.foot-missing") << floor_m;
  }
  EXPECT_TRUE(measure(whole).doubts.empty());
}

TEST(IncompleteScan, each_wide_hole_is_reported_with_its_place) {
  TriangleMesh mesh = test::mannequin("f-165-a").mesh;
  const Body whole = measure(mesh).body;
  for (const char* name : {"head_tip", "crotch", "heel_l"}) {
    const Vec3 at = test::in_scan(whole, name);
    std::erase_if(mesh.triangles,
                  [&](const Triangle& t) { return (mesh.positions[t[0]] - at).norm() < 0.035; });
  }
  const Body body = measure(mesh).body;
  for (const char* name : {"head_tip", "crotch", "heel_l"}) {
    int reported = 0;
    for (const Finding& f : body.scan.findings)
      reported += f.severity == "warning" && f.what.find("a hole ") == 0 &&
                  f.what.find(std::string("near ") + name) != std::string::npos &&
                  f.place[0] == '(';
    EXPECT_EQ(reported, 1) << name;
  }
}
