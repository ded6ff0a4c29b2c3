/// Cloth that crosses itself along a line which stays as long however far it is drawn.
#include <support/drape_scene.hpp>

#include <algorithm>
#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/sewing.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

constexpr double LENGTH = 0.3, WIDTH = 0.15; // m, of a curtain and of a strip before it
constexpr double APART = 0.02;               // m
constexpr double THROUGH = 0.03;             // m: so far behind the curtain the strip ends
constexpr int CELLS = 20;

/// Both are held at their tops.
Garment strip_through_curtain() {
  Garment g;
  g.panels.name = "strip and curtain";
  g.panels.edge_length = LENGTH / CELLS;
  for (const bool strip : {false, true}) {
    const std::string name = strip ? "strip" : "curtain";
    const double width = strip ? WIDTH : LENGTH, x = strip ? APART : 0,
                 shift = strip ? 0.003 : 0; // not a grid on a grid
    const int columns = strip ? CELLS / 2 : CELLS;
    add_panel(
        g, name, columns, CELLS,
        [&](int c, int r) {
          return Vec2(width * (static_cast<double>(c) / columns - 0.5),
                      LENGTH * (static_cast<double>(r) / CELLS - 0.5));
        },
        [&](const Vec2& uv) { return Vec3(x, 0.7 + uv.y(), uv.x() + shift); });
    g.scene.pins.push_back({{name, Vec2(0, 1), Vec2(1, 1)}, false, Vec3::Zero(), 1e4});
  }
  unsew(g);
  std::vector<Vec3> position = g.panels.placed;
  for (Vec3& p : position)
    if (p.x() > 0.5 * APART)
      p.x() -= (APART + THROUGH) * std::clamp((0.65 - p.y()) / 0.1, 0.0, 1.0);
  weld(g, position);
  return g;
}

} // namespace

TEST(Knots, a_strip_whose_end_hangs_through_a_curtain_comes_to_rest_before_it) {
  Garment g = strip_through_curtain();
  ASSERT_GT(audit(g, nullptr).self.size(), 20U);
  const DrapeReport report = drape(g, nullptr, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_EQ(audit(g, nullptr).self.size(), 0U);
  for (std::size_t i = 0; i < g.position.size(); ++i)
    EXPECT_LT(std::abs(g.position[i].x()), 2 * APART);
}
