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
  const test::MadeFigure& made = test::mannequin("m-178-a");
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

namespace {

bool is_warned_of(const Body& body, const std::string& place) {
  for (const Finding& finding : body.scan.findings)
    if (finding.severity == "warning" && finding.place == place)
      return true;
  return false;
}

/// A chest of 1 cm at the height `bust`, m, a fold under it, and a belly of the given depth 7 cm
/// below.
TriangleMesh with_high_belly(TriangleMesh mesh, double bust, double depth) {
  for (Vec3& p : mesh.positions) {
    if (std::abs(p.x()) > 0.16 || p.z() < 0.02)
      continue;
    p.z() += 0.01 * std::exp(-std::pow((p.y() - bust - 0.01) / 0.015, 2)) +
             depth * std::exp(-std::pow((p.y() - bust + 0.07) / 0.03, 2));
  }
  return mesh;
}

} // namespace

/// Of 616 sides of fresh bodies 18 had the chest's foremost place off by more than 40 mm: a
/// millimetre decides between belly and chest, here 5 cm apart.
TEST(Prominence, lies_between_a_belly_and_a_chest_that_stand_out_as_far) {
  const test::MadeFigure& made = test::mannequin("m-178-a");
  const double bust = test::in_scan(test::measure(made.mesh).body, "bust_point_l").y();
  std::vector<double> heights;
  double most = 0;
  int between = 0;
  for (double depth = 0.02; depth < 0.0521; depth += 0.004) {
    const Body body = test::measure(with_high_belly(made.mesh, bust, depth)).body;
    heights.push_back(test::in_scan(body, "bust_prominent_l").y() - bust);
    if (heights.size() > 1)
      most = std::max(most, std::abs(heights.back() - heights[heights.size() - 2]));
    if (heights.back() > 0.005 || heights.back() < -0.025)
      continue;
    EXPECT_TRUE(is_warned_of(body, "bust_prominent_l")) << depth << " " << heights.back();
    ++between;
  }
  EXPECT_GT(heights.front(), 0.005);
  EXPECT_LT(heights.back(), -0.02);
  EXPECT_GE(between, 2);
  EXPECT_LT(most, 0.035);
}

/// Of 12 bellies off by more than 40 mm among 280 fresh bodies six were so without a word: the
/// waist, which is where a belly that runs on into the chest ends, is off by 8 mm.
TEST(FlatBelly, is_told_of_where_the_waist_decides_between_belly_and_chest) {
  const test::MadeFigure& made = test::mannequin("m-178-a");
  const Body plain = test::measure(made.mesh).body;
  const double waist = plain.levels.at("waist_semantic").y, belly = waist - 0.11;
  EXPECT_FALSE(is_warned_of(plain, "abdomen_front"));
  double depth = 0;
  for (const Vec3& p : made.mesh.positions)
    if (std::abs(p.y() - waist) < 0.1 && std::abs(p.x()) < 0.15)
      depth = std::max(depth, p.z());
  TriangleMesh mesh =
      made.mesh; // a belly, a hollow above it, and a slope that is as far out at the waist
  for (Vec3& p : mesh.positions) {
    const double up = p.y() - belly;
    if (p.z() < 0.02 || std::abs(p.x()) > 0.12 || up < -0.1 || up > 0.15)
      continue;
    const double front = up < 0.06 ? depth + 0.03 - 4 * up * up
                                   : depth + 0.03 - 4 * 0.06 * 0.06 + 0.25 * (up - 0.06);
    p.z() = std::max(p.z(), front - 5 * p.x() * p.x());
  }
  const Body body = test::measure(mesh).body;
  EXPECT_TRUE(is_warned_of(body, "abdomen_front"));
}
