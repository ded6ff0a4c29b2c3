/// Places that many are as far out as: the middle of a flat belly, the middle one of fingers.
#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/io/scan_reader.hpp>

#include <cstdlib>
#include <filesystem>

using namespace sloper;
using namespace sloper::body;

namespace {

int flat_findings(const Body& body) {
  int n = 0;
  for (const Finding& finding : body.scan.findings)
    n += finding.what.find("the belly is flat") != std::string::npos;
  return n;
}

/// A belly pressed flat from `low` to `high`, leaning by `slope` (m per m), and round above and
/// below.
TriangleMesh pressed(TriangleMesh mesh, double low, double high, double slope) {
  double depth = 0;
  for (const Vec3& p : mesh.positions)
    if (p.y() > low && p.y() < high && std::abs(p.x()) < 0.15)
      depth = std::max(depth, p.z());
  depth += 0.01;
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  for (Vec3& p : mesh.positions) {
    const double off = std::abs(p.y() - middle) - half;
    if (off > 0.08 || std::abs(p.x()) > 0.08 || p.z() < 0)
      continue;
    p.z() = std::max(p.z(), depth + slope * (p.y() - middle) -
                                3 * std::max(0.0, off) * std::max(0.0, off) - 5 * p.x() * p.x());
  }
  return mesh;
}

} // namespace

TEST(FlatBelly, is_given_its_middle_and_told) {
  const samples::MadeMannequin& made = test::mannequin("m-178-a");
  const double low = 0.93, high = 1.03;
  Vec3 at[2];
  for (int lean = 0; lean < 2; ++lean) {
    const Body body = test::measure(pressed(made.mesh, low, high, lean ? 0.004 : -0.004)).body;
    at[lean] = test::in_scan(body, "abdomen_front");
    EXPECT_NEAR(at[lean].y(), 0.5 * (low + high), 0.025);
    EXPECT_EQ(flat_findings(body), 1);
    EXPECT_GT(body.landmarks.at("abdomen_front").spread_m, 0.02);
    EXPECT_LT(body.landmarks.at("abdomen_front").confidence, 0.5);
  }
  EXPECT_LT((at[0] - at[1]).norm(), 0.025) << "half a degree turns the foremost level from one end "
                                              "of the flat part to the other, 100 mm away";
}

TEST(FlatBelly, is_not_told_of_a_round_one) {
  const Body body = test::measure(test::mannequin("m-170-stout").mesh).body;
  EXPECT_EQ(flat_findings(body), 0);
}

TEST(HandTip, is_that_of_the_middle_finger_where_another_reaches_as_far_over_the_skin) {
  const char* shared = std::getenv("SLOPER_SHARED");
  const auto path = std::filesystem::path(shared ? shared : "") / "data" / "bodies" / "smpl" /
                    "m_smpl_average_A40.obj";
  if (!shared || !std::filesystem::exists(path))
    GTEST_SKIP() << "needs a hand with fingers: SLOPER_SHARED";
  const TriangleMesh scan = io::read_scan(path.string()).mesh;
  const Body body = test::measure(scan).body;
  for (const char* side : {"_l", "_r"}) {
    const Vec3 wrist = test::in_scan(body, std::string("wrist") + side),
               tip = test::in_scan(body, std::string("hand_tip") + side);
    double farthest = 0;
    for (const Vec3& p : scan.positions)
      if ((p - tip).norm() < 0.15)
        farthest = std::max(farthest, (p - wrist).norm());
    EXPECT_NEAR((tip - wrist).norm(), farthest, 0.002) << side;
  }
}
