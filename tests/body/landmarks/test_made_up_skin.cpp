/// Landmarks on skin that the scan does not show are reported, and no others.
#include <body/landmarks/made_up_skin.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::body;

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
  doubt_made_up_skin(body, points, {}, {});
  ASSERT_EQ(body.scan.findings.size(), 2U);
  EXPECT_EQ(body.scan.findings.back().place, "axilla_l");
  EXPECT_LT(body.landmarks["axilla_l"].confidence, 0.6);
  EXPECT_GT(body.landmarks["axilla_l"].spread_m, 0.01);
  EXPECT_EQ(body.landmarks["axilla_r"].confidence, 0.6);
  body.scan.findings.clear();
  doubt_made_up_skin(body, points, {}, {"axilla_l"}); // a second method says the same
  ASSERT_EQ(body.scan.findings.size(), 1U);
  EXPECT_EQ(body.scan.findings.back().place, "crotch");
}
