/// What a scan's user is told of what the scan does not show.
#include <support/figures.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace sloper;
using namespace sloper::body;

namespace {

int count_of(const Body& body, const std::string& id, const std::string& words = "") {
  return static_cast<int>(std::count_if(
      body.scan.findings.begin(), body.scan.findings.end(), [&](const Finding& finding) {
        return finding.id == id && finding.what.find(words) != std::string::npos;
      }));
}

} // namespace

TEST(ScanFindings, feet_without_soles_are_told_to_make_the_stature_unsure) {
  const TriangleMesh& whole = test::mannequin("f-165-a").mesh;
  EXPECT_EQ(count_of(test::measure(whole).body, "scan.soles-open"), 0);
  TriangleMesh cut = whole; // 3 cm above the floor, where the feet are still longer than stumps
  std::erase_if(cut.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](int v) { return whole.positions[v].y() < 0.03; });
  });
  EXPECT_EQ(count_of(test::measure(cut).body, "scan.soles-open"), 1);
}

TEST(ScanFindings, the_figure_of_a_body_thinner_than_those_it_was_told_apart_on_is_unsure) {
  TriangleMesh thin = test::mannequin("m-178-a").mesh;
  EXPECT_EQ(count_of(test::measure(thin).body, "scan.figure-unsure", "thinner"), 0);
  for (Vec3& p : thin.positions)
    p = Vec3(0.75 * p.x(), p.y(), 0.75 * p.z());
  EXPECT_EQ(count_of(test::measure(thin).body, "scan.figure-unsure", "thinner"), 1);
}
