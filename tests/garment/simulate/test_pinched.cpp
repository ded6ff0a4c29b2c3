/// Cloth between two bodies that nearly touch, as in the fold of an arm pit, caught through one of
/// them in a few of its faces.
#include <support/drape_scene.hpp>

#include <algorithm>
#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/sewing.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

constexpr double COLUMN_RADIUS = 0.1, SLOT = 0.0025; // m
constexpr double LENGTH = 0.3;                       // m, of a curtain
constexpr int CELLS = 20;

/// Closed upright cylinder about (x, 0), from y = 0.2 to 1.2 m.
void append_column(TriangleMesh& mesh, double x) {
  shapes::append(mesh, shapes::cylinder(COLUMN_RADIUS, 0.2, 1.2, 48, 24, Vec3(x, 0, 0), 0.5));
}

/// Without bones, so that it cannot be drawn in for a start that is inside it.
body::Body two_columns() {
  body::Body body;
  append_column(body.skin, COLUMN_RADIUS + 0.5 * SLOT);
  append_column(body.skin, -COLUMN_RADIUS - 0.5 * SLOT);
  body.face_part.assign(body.skin.triangles.size(), body::Part::TORSO);
  return body;
}

/// Two curtains 0.6 mm apart in the slot, held at their top edges, drawn 60 mm into one column at a
/// spot of 30 mm radius: more than is moved out at the start.
Garment caught_curtains() {
  Garment g;
  g.panels.name = "two curtains";
  g.panels.edge_length = LENGTH / CELLS;
  for (int layer = 0; layer < 2; ++layer) {
    const std::string name = layer ? "second" : "first";
    const double x = layer ? 3e-4 : -3e-4, shift = 0.003 * layer; // not a grid on a grid
    add_panel(
        g, name, CELLS, CELLS,
        [](int c, int r) {
          return Vec2(LENGTH * (static_cast<double>(c) / CELLS - 0.5),
                      LENGTH * (static_cast<double>(r) / CELLS - 0.5));
        },
        [&](const Vec2& uv) { return Vec3(x, 0.7 + uv.y(), uv.x() + shift); });
    g.scene.pins.push_back({{name, Vec2(0, 1), Vec2(1, 1)}, false, Vec3::Zero(), 1e4});
  }
  unsew(g);
  std::vector<Vec3> position = g.panels.placed;
  for (Vec3& p : position)
    if (const double r = (p - Vec3(0, 0.7, 0)).norm(); r < 0.03)
      p.x() += 0.06 * (1 - r / 0.03);
  weld(g, position);
  return g;
}

bool freed(const std::string& repair) {
  return repair.find("faces through the skin moved out, 0 crossings remain") != std::string::npos;
}

} // namespace

TEST(Pinched,
     few_faces_caught_where_the_other_side_is_held_too_are_moved_out_while_the_cloth_settles) {
  const body::Body body = two_columns();
  const collision::BodyCollider collider(body.skin);
  Garment g = caught_curtains();
  ASSERT_GT(audit(g, &collider).through.size(), 0U);
  DrapeSettings settings;
  settings.max_steps = 45; // the first look is after 40; by contact alone eight faces are still
                           // through the skin then
  settings.cg_tolerance = 0.0099; // by rougher steps none
  DrapeReport report = drape(g, &body, settings, silent_reporter());
  EXPECT_EQ(std::count_if(report.repairs.begin(), report.repairs.end(), freed), 1);
  const Audit now = audit(g, &collider);
  EXPECT_EQ(now.through.size(), 0U);
  EXPECT_EQ(now.inside.size(), 0U);
  report = drape(g, &body, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_TRUE(audit(g, &collider).clean());
}
