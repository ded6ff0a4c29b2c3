/// Skirts whose flare is in the seams between their panels, from the drawing to rest on a person
/// with legs and arms.
#include <support/gored_patterns.hpp>

#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <support/made_figure.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

void expect_dressed(const pattern::test::DrawnPattern& drawn) {
  const test::MadeFigure made = test::made_figure("f-165-a");
  const body::Body body = body::measure_scan(made.mesh, "f-165-a", "", {}, silent_reporter()).body;
  const pattern::Pattern source = drawn.pattern();
  Garment skirt;
  skirt.panels = pattern::mesh_pattern(source, 0.03, "skirt");
  pattern::place_panels(source, body, skirt.panels);
  const DrapeReport report = drape(skirt, &body, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  const collision::BodyCollider skin(body.skin);
  const Audit a = audit(skirt, &skin);
  EXPECT_TRUE(a.clean());
  EXPECT_LT(a.strain_p99, 0.05);
}

} // namespace

TEST(Gores, with_godets_between_them_come_to_rest_clean) {
  expect_dressed(pattern::test::skirt_with_godets(6));
}

TEST(Gores, that_are_quarters_of_a_circle_come_to_rest_clean) {
  expect_dressed(pattern::test::circle_in_quarters(12.25, 67));
}
