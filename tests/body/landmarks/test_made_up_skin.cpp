/// Landmarks on skin that the scan does not show are reported, and no others.
#include <body/landmarks/made_up_skin.hpp>
#include <gtest/gtest.h>
#include <support/figures.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

/// Corners and middles of edges, but those within `hole`, m, of the points `without`.
TriangleMesh dense_points(const TriangleMesh& mesh, const std::vector<Vec3>& without, double hole) {
  TriangleMesh cloud;
  auto add = [&](const Vec3& p) {
    for (const Vec3& middle : without)
      if ((p - middle).norm() < hole)
        return;
    cloud.positions.push_back(p);
  };
  for (const Vec3& p : mesh.positions)
    add(p);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] < t[(k + 1) % 3]) // the skin is closed: once for both faces
        add(0.5 * (mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]));
  return cloud;
}

/// Where a mannequin's landmark is by construction, m.
Vec3 truth_of(const test::MadeFigure& mannequin, const std::string& name) {
  const auto& p = mannequin.truth["landmarks"][name]["p"];
  return Vec3(p[0], p[1], p[2]);
}

/// How far pits were put higher, m, by the decision path: 0 where they were not.
double lift_of(const MeasuredScan& measured, const std::string& pit) {
  const std::string start = pit + ": put ";
  for (const std::string& line : measured.trail)
    if (line.starts_with(start))
      return 0.001 * std::stod(line.substr(start.size()));
  return 0;
}

} // namespace

/// Right pits were put 15 to 27 mm higher.
TEST(MadeUpSkin, arm_pits_among_points_stay_where_they_are) {
  for (const char* name : {"f-165-a", "m-170-stout"}) {
    const test::MadeFigure& mannequin = test::mannequin(name);
    const MeasuredScan measured = test::measure(dense_points(mannequin.mesh, {}, 0));
    for (const char* pit : {"axilla_l", "axilla_r"}) {
      ASSERT_TRUE(measured.body.has_landmark(pit)) << name << " " << pit;
      const Vec3 off = test::in_scan(measured.body, pit) - truth_of(mannequin, pit);
      EXPECT_LT(std::abs(off.y()), 0.005) << name << " " << pit;
    }
  }
}

/// Mannequins have their crotch between both ends of the trunk's underside, where people of the
/// other make have none, and their merges elsewhere.
TEST(MadeUpSkin, what_another_make_teaches_is_nothing_to_a_mannequin) {
  for (const char* name : {"f-165-a", "m-178-a"}) {
    const test::MadeFigure& mannequin = test::mannequin(name);
    const Body own = test::measure(mannequin.mesh).body,
               rebuilt = test::measure(dense_points(mannequin.mesh, {}, 0)).body;
    for (const Body* body : {&own, &rebuilt})
      for (const Finding& finding : body->scan.findings)
        EXPECT_NE(finding.id, "scan.crotch-rounded") << name;
    for (const char* merge : {"axilla_merge_l", "axilla_merge_r"}) {
      ASSERT_TRUE(own.has_landmark(merge) && rebuilt.has_landmark(merge)) << name;
      EXPECT_LT((test::in_scan(own, merge) - test::in_scan(rebuilt, merge)).norm(), 0.012)
          << name << " " << merge;
    }
  }
}

TEST(MadeUpSkin, arm_pits_that_a_rebuilt_skin_closed_are_put_higher) {
  constexpr double HOLE = 0.07; // m
  const test::MadeFigure& mannequin = test::mannequin("f-165-a");
  const std::vector<Vec3> pits = {truth_of(mannequin, "axilla_l"), truth_of(mannequin, "axilla_r")};
  const MeasuredScan measured = test::measure(dense_points(mannequin.mesh, pits, HOLE));
  for (const char* pit : {"axilla_l", "axilla_r"}) {
    ASSERT_TRUE(measured.body.has_landmark(pit)) << pit;
    const double off = test::in_scan(measured.body, pit).y() - truth_of(mannequin, pit).y();
    const double lift = lift_of(measured, pit);
    EXPECT_GT(lift, 0.01) << pit;
    EXPECT_LT(std::abs(off), std::abs(off - lift)) << pit;
    EXPECT_LT(std::abs(off), 0.016) << pit;
  }
}

/// One of 40 corrupted scans had both its arm pits 4 cm too low where holes were closed, in
/// silence.
TEST(MadeUpSkin, landmarks_beside_a_closed_hole_are_told) {
  constexpr int N = 61;
  constexpr double STEP = 0.005; // m
  Body body;
  body.scan.stature_m = 1.7;
  std::vector<Vec3> points;
  const Vec3 hole(0.15, 0.15, 0);
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) {
      body.skin.positions.emplace_back(STEP * i, STEP * j, 0);
      if ((body.skin.positions.back() - hole).norm() > 0.03)
        points.push_back(body.skin.positions.back());
    }
  for (int j = 0; j + 1 < N; ++j)
    for (int i = 0; i + 1 < N; ++i) {
      const int a = j * N + i;
      body.skin.triangles.push_back({a, a + 1, a + N});
      body.skin.triangles.push_back({a + 1, a + N + 1, a + N});
    }
  auto put = [&](const char* name, const Vec3& p) {
    body.landmarks[name] = {p, 1, "rule", 0.6, 0.004, {}};
  };
  put("axilla_l", hole + Vec3(0.04, 0, 0));
  put("axilla_r", Vec3(0.02, 0.02, 0));
  put("head_tip", hole); // its height is known all the same
  put("crotch", hole);
  body.scan.findings.push_back({"scan.crotch-estimated"_id, "warning", "hidden", "crotch"});
  const auto made_up = made_up_skin(body.skin, body.scan.stature_m, points, {});
  doubt_made_up_skin(body, made_up, {});
  ASSERT_EQ(body.scan.findings.size(), 2U);
  EXPECT_EQ(body.scan.findings.back().place, "axilla_l");
  EXPECT_LT(body.landmarks["axilla_l"].confidence, 0.6);
  EXPECT_GT(body.landmarks["axilla_l"].spread_m, 0.01);
  EXPECT_EQ(body.landmarks["axilla_r"].confidence, 0.6);
  body.scan.findings.clear();
  doubt_made_up_skin(body, made_up, {"axilla_l"}); // a second method says the same
  ASSERT_EQ(body.scan.findings.size(), 1U);
  EXPECT_EQ(body.scan.findings.back().place, "crotch");
}
