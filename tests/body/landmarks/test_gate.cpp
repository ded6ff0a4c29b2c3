/// Who stands is measured, however the arms are held; who does not is told so.
#include <body/landmarks/dependents.hpp>
#include <body/landmarks/gate.hpp>
#include <support/figures.hpp>

#include <algorithm>
#include <gtest/gtest.h>
#include <sloper/body/pose.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

Eigen::Quaterniond turn(double degrees, const Vec3& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * 3.14159265358979 / 180, axis));
}

/// A mannequin measured, with its joints turned.
struct Posed {
  Body before;
  TriangleMesh skin;
};

Posed posed(const std::map<std::string, Eigen::Quaterniond>& turns) {
  Posed result{test::measure(test::mannequin("m-178-a").mesh).body, {}};
  Pose pose;
  pose.turn = turns;
  result.skin = result.before.skin;
  result.skin.positions = posed_skin(result.before, skin_weights(result.before), pose);
  return result;
}

} // namespace

TEST(Gate, who_stands_is_no_doubt) {
  for (const char* name : {"f-165-a", "m-185-t", "f-165-plus", "m-170-stout"}) {
    const MeasuredScan measured = test::measure(test::mannequin(name).mesh);
    EXPECT_TRUE(measured.doubts.empty())
        << name << ": " << (measured.doubts.empty() ? "" : measured.doubts.front().what);
  }
}

TEST(Gate, who_squats_is_told_so) {
  const Posed squat = posed({{"thigh_l", turn(-60, Vec3::UnitX())},
                             {"thigh_r", turn(-60, Vec3::UnitX())},
                             {"shin_l", turn(75, Vec3::UnitX())},
                             {"shin_r", turn(75, Vec3::UnitX())}});
  EXPECT_FALSE(test::measure(squat.skin).doubts.empty());
}

TEST(Gate, a_proportion_a_little_outside_is_told_and_one_far_outside_refused) {
  Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  const double s = body.scan.stature_m;
  auto severity_for = [&](double share) {
    body.girths["neck"].value_m = share * s;
    for (const Finding& doubt : doubts_of(body, 0))
      if (doubt.place == "neck")
        return doubt.severity;
    return std::string("none");
  };
  EXPECT_EQ(severity_for(0.2), "none");
  EXPECT_EQ(severity_for(0.13), "warning"); // a dummy's
  EXPECT_EQ(severity_for(0.09), "error");
}

TEST(Gate, a_shape_stranger_than_the_bodies_learned_from_is_told) {
  const Body body = test::measure(test::mannequin("f-165-a").mesh).body;
  auto is_told = [&](double strangeness) {
    for (const Finding& doubt : doubts_of(body, strangeness))
      if (doubt.place == "scan" && doubt.severity == "warning")
        return true;
    return false;
  };
  EXPECT_FALSE(is_told(0.9));
  EXPECT_TRUE(is_told(1.1));
}

TEST(Dependents, share_the_doubt_of_what_they_rest_on) {
  Body body;
  body.scan.stature_m = 1.7;
  auto put = [&](const char* name, double y, double confidence) {
    body.landmarks[name] = {Vec3(0.1, y, 0), 2, "rule", confidence, 0.01, {}};
  };
  put("neck_back", 1.45, 0.2);
  put("neck_side_l", 1.46, 0.5);
  put("neck_center", 1.45, 0.5);
  put("crotch", 0.8, 0.9);
  body.landmarks["crotch"].spread_m =
      0.06; // it is in doubt from front to back, which is told apart
  put("elbow_l", 1.1, 0.6);
  put("olecranon_l", 1.1, 0.5);
  put("axilla_l", 1.28, 0.7);
  put("axilla_merge_l", 1.25, 0.8); // 3 cm below: arm and trunk touch
  put("axilla_r", 1.28, 0.7);
  put("axilla_merge_r", 1.275, 0.8);
  body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning", "higher", "neck_back"});
  doubt_dependents(body, 0.8);
  auto is_warned_of = [&](const std::string& name) {
    for (const Finding& finding : body.scan.findings)
      if (finding.place == name && finding.severity == "warning")
        return true;
    return false;
  };
  EXPECT_TRUE(is_warned_of("neck_center"));
  EXPECT_DOUBLE_EQ(body.landmarks["neck_center"].confidence, 0.2);
  // most of them are right all the same
  EXPECT_FALSE(is_warned_of("neck_side_l"));
  EXPECT_DOUBLE_EQ(body.landmarks["neck_side_l"].confidence, 0.2);
  EXPECT_FALSE(is_warned_of("crotch"));
  EXPECT_FALSE(is_warned_of("olecranon_l"));
  EXPECT_TRUE(is_warned_of("axilla_merge_l"));
  EXPECT_DOUBLE_EQ(body.landmarks["axilla_merge_l"].confidence, 0.4);
  EXPECT_FALSE(is_warned_of("axilla_merge_r"));
  EXPECT_DOUBLE_EQ(body.landmarks["axilla_merge_r"].confidence, 0.8);
  put("hip_joint_l", 0.9, 0.6);
  doubt_dependents(body, 0.8);
  EXPECT_FALSE(is_warned_of("hip_joint_l")); // nothing doubts the crotch
  body.scan.findings.push_back({"scan.landmark-unlikely"_id, "warning", "higher", "crotch"});
  doubt_dependents(body, 0.8);
  EXPECT_TRUE(is_warned_of("hip_joint_l"));
  doubt_dependents(body, 1.2);
  EXPECT_LT(body.landmarks["olecranon_l"].confidence, 0.5);
}

/// A scan with a hole at the crotch: thighs were 31 to 36 mm too long below a crotch that was
/// reported, and were not reported themselves.
TEST(Dependents, girths_share_the_doubt_of_the_landmark_beside_them) {
  Body body;
  body.scan.stature_m = 1.7;
  body.landmarks["crotch"] = {Vec3(0, 0.8, 0), 1, "below_buttocks", 0.3, 0.01, {}};
  body.girths = {{"thigh_l", {0.6, 0.003}}, {"knee_l", {0.4, 0.003}}, {"neck", {0.36, 0.012}}};
  auto reports_of = [&](const std::string& name) {
    return std::count_if(
        body.scan.findings.begin(), body.scan.findings.end(),
        [&](const Finding& f) { return f.place == name && f.severity == "warning"; });
  };
  doubt_dependents(body, 0.8);
  EXPECT_EQ(reports_of("thigh_l"), 0);
  body.scan.findings.push_back({"scan.crotch-estimated"_id, "warning", "hidden", "crotch"});
  doubt_dependents(body, 0.8);
  EXPECT_EQ(reports_of("thigh_l"), 1);
  EXPECT_EQ(reports_of("thigh_r"), 0) << "it was not measured";
  EXPECT_EQ(reports_of("knee_l"), 0);
  EXPECT_EQ(reports_of("neck"), 0);
}

/// Of 28 scans as scanners deliver them five had a crotch that was estimated, told and 3 to 8 cm
/// too high, and legs and hips that rest on it, which were not reported.
TEST(Dependents, legs_and_hips_rest_on_a_crotch_that_is_estimated) {
  auto is_told = [](const char* rule) {
    Body body;
    body.scan.stature_m = 1.7;
    for (const char* name : {"crotch", "leg_top_l", "hip_joint_r", "hip_center"})
      body.landmarks[name] = {Vec3(0, 0.8, 0), 2, rule, 0.5, 0.01, {}};
    body.scan.findings.push_back({"scan.crotch-estimated"_id, "warning", "hidden", "crotch"});
    doubt_dependents(body, 0);
    return body.scan.findings.size() == 4;
  };
  EXPECT_TRUE(is_told("below_buttocks"));
  EXPECT_FALSE(is_told("by_rest_of_body"));    // off by 13 mm, as the hips are by themselves
  EXPECT_FALSE(is_told("leg_sections_merge")); // seen: only from front to back in doubt
}

/// Of four scans whose own faces had grown together the merges were 27 to 44 mm too low on three,
/// in silence, and on one the arm pits by 60 mm.
TEST(Dependents, arm_pits_and_merges_may_have_grown_together_where_the_legs_have) {
  auto reported = [](const char* rule) {
    Body body;
    body.scan.stature_m = 1.7;
    body.landmarks["crotch"] = {Vec3(0, 0.8, 0), 1, rule, 0.5, 0.01, {}};
    for (const char* name : {"axilla_l", "axilla_merge_l", "axilla_back_l"})
      body.landmarks[name] = {Vec3(0.2, 1.2, 0), 1, "gap_closes", 0.6, 0.01, {}};
    doubt_dependents(body, 0);
    return body.scan.findings.size();
  };
  EXPECT_EQ(reported("by_rest_of_body"), 3U);
  EXPECT_EQ(reported("leg_sections_merge"), 0U);
}

/// Of a fused scan whose crotch was 56 mm too far back, between both ends of the trunk's underside,
/// the pits were 29 mm too low and the merges 41, and nothing was reported.
TEST(Dependents, arm_pits_may_have_grown_together_where_the_crotch_is_rounded_and_they_are_low) {
  auto reported = [](bool pits_are_low, bool rebuilt) {
    Body body;
    body.scan.stature_m = 1.7;
    body.landmarks["crotch"] = {Vec3(0, 0.8, 0), 1, "leg_sections_merge", 0.9, 0.01, {}};
    for (const char* name : {"axilla_l", "axilla_merge_l", "axilla_back_l"})
      body.landmarks[name] = {Vec3(0.2, 1.2, 0), 1, "gap_closes", 0.6, 0.01, {}};
    body.scan.findings.push_back({"scan.crotch-rounded"_id, "warning", "rounded", "crotch"});
    if (rebuilt)
      body.scan.findings.push_back({"scan.skin-rebuilt"_id, "info", "rebuilt", "skin"});
    const std::size_t before = body.scan.findings.size();
    doubt_dependents(body, 0, pits_are_low);
    EXPECT_LT(body.landmarks["crotch"].confidence, 0.5);
    return body.scan.findings.size() - before;
  };
  EXPECT_EQ(reported(true, false), 3U);
  EXPECT_EQ(reported(false, false), 0U);
  EXPECT_EQ(reported(true, true), 0U);
}

TEST(Dependents, what_is_unsteady_or_hardly_believed_is_told) {
  Body body;
  body.scan.stature_m = 1.7;
  auto put = [&](const char* name, double confidence, double spread) {
    body.landmarks[name] = {Vec3(0.1, 1, 0), 2, "rule", confidence, spread, {}};
  };
  put("bust_point_l", 0.5, 0.07);
  put("bust_point_r", 0.5, 0.01);
  put("neck_front", 0.12, 0.01);
  put("crotch", 0.12, 0.07);
  body.scan.findings.push_back({"scan.crotch-estimated"_id, "warning", "estimated", "crotch"});
  doubt_dependents(body, 0);
  std::map<std::string, int> warnings;
  for (const Finding& finding : body.scan.findings)
    ++warnings[finding.place];
  EXPECT_EQ(warnings["bust_point_l"], 1);
  EXPECT_EQ(warnings["bust_point_r"], 0);
  EXPECT_EQ(warnings["neck_front"], 1);
  EXPECT_EQ(warnings["crotch"], 1);
}

TEST(Parts, a_hand_is_arm_where_the_elbow_is_bent) {
  const Posed bent =
      posed({{"forearm_l", turn(-50, Vec3::UnitX())}, {"forearm_r", turn(-35, Vec3::UnitX())}});
  const MeasuredScan measured = test::measure(bent.skin);
  ASSERT_EQ(measured.body.face_part.size(), bent.before.face_part.size());
  std::size_t agree = 0, hands = 0, hands_agree = 0;
  const double wrist = 0.06;
  for (std::size_t t = 0; t < bent.skin.triangles.size(); ++t) {
    const bool same = measured.body.face_part[t] == bent.before.face_part[t];
    agree += same;
    const Vec3& p = bent.before.skin.positions[bent.before.skin.triangles[t][0]];
    for (const char* tip : {"hand_tip_l", "hand_tip_r"})
      if ((p - bent.before.landmark(tip)).norm() < wrist) {
        ++hands;
        hands_agree += same;
      }
  }
  EXPECT_EQ(hands_agree, hands);
  EXPECT_GT(static_cast<double>(agree), 0.98 * static_cast<double>(bent.skin.triangles.size()));
}

TEST(Size, is_the_likeliest_of_units_and_stature_and_is_told_where_it_is_doubtful) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh; // 1.65 m
  auto unit_finding = [](const Body& body) {
    for (const Finding& finding : body.scan.findings)
      if (finding.what.rfind("unit ", 0) == 0)
        return finding;
    return Finding{};
  };
  const Body decimetres =
      test::measure(test::moved(mesh, 12.5 * Eigen::Matrix3d::Identity(), Vec3::Zero())).body;
  EXPECT_EQ(decimetres.scan.unit, "dm"); // 20.6 units: no adult of 52 cm in inches
  EXPECT_NEAR(decimetres.scan.stature_m, 2.06, 0.02);
  EXPECT_EQ(unit_finding(decimetres).severity, "warning"); // a scale of no unit is as likely
  const Body giant =
      test::measure(test::moved(mesh, 1.45 * Eigen::Matrix3d::Identity(), Vec3::Zero())).body;
  EXPECT_EQ(unit_finding(giant).severity, "warning");
  EXPECT_EQ(unit_finding(test::measure(mesh).body).severity, "info");
  ScanOptions given;
  given.stature_m = 1.7;
  EXPECT_NEAR(
      test::measure(test::moved(mesh, 7.7 * Eigen::Matrix3d::Identity(), Vec3::Zero()), given)
          .body.scan.stature_m,
      1.7, 0.005);
  given.stature_m = 0;
  given.metres_per_unit = 0.5;
  EXPECT_NEAR(test::measure(test::moved(mesh, 2 * Eigen::Matrix3d::Identity(), Vec3::Zero()), given)
                  .body.scan.stature_m,
              1.65, 0.01);
}
