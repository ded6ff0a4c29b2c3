#include <gtest/gtest.h>
#include <render/cloth_clearance.hpp>
#include <sloper/collision/intersections.hpp>
#include <support/sheet.hpp>

#include <cmath>

using namespace sloper;
using namespace sloper::render;
using sloper::support::flat;
using sloper::support::make_sheet;

namespace {

/// Cloth around an axis along y: 0.3 m of arc with n chords.
garment::Garment make_arc(int n, double radius) {
  return make_sheet(n, [radius](const Vec2& p) {
    return Vec3(radius * std::sin(p.x() / radius), p.y(), radius * std::cos(p.x() / radius));
  });
}

DrawMesh as_obstacle(const garment::Garment& garment) {
  DrawMesh mesh;
  mesh.positions = garment.position;
  mesh.normals.assign(garment.position.size(), Vec3(0, 0, 1));
  mesh.colors.assign(garment.position.size(), Vec3::Zero());
  mesh.triangles = garment.panels.triangles;
  return mesh;
}

/// Pairs of triangles of all meshes together that cross.
std::size_t count_crossings(const std::vector<DrawMesh>& meshes) {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  for (const DrawMesh& mesh : meshes) {
    const int first = std::ssize(x);
    x.insert(x.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return collision::self_intersections(x, triangles, collision::TriangleTree(x, triangles)).size();
}

} // namespace

TEST(Cloth, cuts_of_a_mesh_without_a_pattern_are_no_seams) {
  garment::Garment g = make_sheet(4, flat);
  const std::size_t border = cloth_mesh(g).lines.size();
  Triangle& inner = g.panels.triangles[g.panels.triangles.size() / 2];
  for (int& corner : inner) { // cut out, and one with the rest by its particles
    const auto v = static_cast<std::size_t>(corner);
    corner = static_cast<int>(g.particle_of.size());
    g.particle_of.push_back(g.particle_of[v]);
    const Vec2 place = g.panels.pattern[v];
    g.panels.pattern.push_back(place);
    ++g.panels.panels[0].n_vertices;
  }
  EXPECT_GT(cloth_mesh(g).lines.size(), border);
  g.strain_unknown = true;
  const DrawMesh mesh = cloth_mesh(g);
  EXPECT_EQ(mesh.lines.size(), border);
  for (const char is_hem : mesh.is_hem)
    EXPECT_TRUE(is_hem);
}

TEST(Cloth, smoothing_keeps_flat_cloth_flat_and_hems_at_its_border) {
  garment::Garment g = make_sheet(6, flat);
  std::vector<DrawMesh> meshes = {cloth_mesh(g)};
  const std::size_t before = meshes[0].triangles.size();
  smooth_cloth(meshes);
  const DrawMesh& mesh = meshes[0];
  EXPECT_GT(mesh.triangles.size(), 16 * before);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_LE(std::abs(mesh.positions[v].z()), 0.0013); // the rim is as thick as cloth
    const Vec2 p = mesh.uv[v];
    const double border = std::min({p.x(), p.y(), 0.3 - p.x(), 0.3 - p.y()});
    EXPECT_NEAR(mesh.hem[v], std::min(border, BORDER_REACH), 1e-9);
    EXPECT_EQ(mesh.seam[v], BORDER_REACH);
  }
}

TEST(Cloth, smoothing_brings_a_coarse_cylinder_nearer_to_round) {
  garment::Garment g = make_sheet(8, [](const Vec2& p) {
    return Vec3(0.1 * std::sin(p.x() / 0.1), p.y(), 0.1 * std::cos(p.x() / 0.1));
  });
  std::vector<DrawMesh> meshes = {cloth_mesh(g)};
  smooth_cloth(meshes);
  const DrawMesh& mesh = meshes[0];
  double worst = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (mesh.hem[v] > 0.015)
      worst =
          std::max(worst, std::abs(std::hypot(mesh.positions[v].x(), mesh.positions[v].z()) - 0.1));
  EXPECT_LT(worst, 0.0009); // chords alone miss by 1.8 mm
}

TEST(Cloth, smoothing_moves_no_cloth_through_other_cloth) {
  // The middle of a chord lies 1.8 mm inside its arc, and other cloth lies 0.4 mm above it:
  // smoothed by itself the chord comes out of that.
  const garment::Garment inner = make_arc(8, 0.1),
                         outer = make_sheet(8, [](const Vec2&p) {
                           const double angle = 1.3125 + 0.1 * (p.x() / 0.3 - 0.5);
                           const double radius = 0.0987 + 0.006 * std::abs(p.y() / 0.3 - 0.5);
                           return Vec3(radius * std::sin(angle), 0.1 + 0.3 * p.y(),
                                       radius * std::cos(angle));
                         });
  std::vector<DrawMesh> alone = {cloth_mesh(inner)};
  smooth_cloth(alone);
  std::vector<DrawMesh> both = {cloth_mesh(inner), cloth_mesh(outer)};
  EXPECT_EQ(count_crossings(both), 0u);
  EXPECT_GT(count_crossings({alone[0], both[1]}), 10u);
  smooth_cloth(both);
  EXPECT_EQ(count_crossings(both), 0u);
  double moved = 0;
  for (std::size_t v = 0; v < both[0].flat.size(); ++v)
    moved = std::max(moved, (both[0].positions[v] - both[0].flat[v]).norm());
  EXPECT_GT(moved, 0.0004); // it is smooth as far as there is room
}

TEST(Cloth, smoothing_moves_no_cloth_through_a_body) {
  // Hollow cloth: its smooth surface lies inwards of the chords, where the body is.
  const garment::Garment body = make_arc(64, 0.0981), cloth = make_arc(8, 0.1);
  std::vector<DrawMesh> meshes = {cloth_mesh(cloth), as_obstacle(body)};
  for (Vec3& n : meshes[0].normals)
    n = -n;
  const std::size_t before = count_crossings(meshes);
  smooth_cloth(meshes);
  EXPECT_EQ(before, 0u);
  EXPECT_EQ(count_crossings(meshes), 0u);
}

TEST(Cloth, a_model_without_the_body_is_clear_of_it) {
  // Half a millimetre off the skin: less than a rim is thick, and less than hollow cloth is
  // rounded.
  for (const double side : {1.0, -1.0}) {
    const garment::Garment body = make_arc(8, 0.1 - 0.0005 * side), cloth = make_arc(8, 0.1);
    std::vector<DrawMesh> model = {cloth_mesh(cloth)}, picture = model;
    for (std::vector<DrawMesh>* meshes : {&model, &picture})
      for (Vec3& n : meshes->front().normals)
        n *= side;
    smooth_cloth(model, true);
    smooth_cloth(picture);
    EXPECT_EQ(count_crossings({model[0], as_obstacle(body)}), 0u);
    EXPECT_GT(count_crossings({picture[0], as_obstacle(body)}), 0u); // nobody sees it
  }
}

TEST(Cloth, an_edge_has_no_rim_where_there_is_no_room_for_one) {
  // Two sheets 0.5 mm apart: the rim of the upper one, 1.2 mm thick, would pass through the lower.
  const garment::Garment lower = make_sheet(6, flat);
  const garment::Garment upper = make_sheet(
      6, [](const Vec2& p) { return Vec3(0.9 * p.x() + 0.015, 1.015 + 0.9 * p.y(), 0.0005); });
  std::vector<DrawMesh> free = {cloth_mesh(upper)}, both = {cloth_mesh(upper), cloth_mesh(lower)};
  smooth_cloth(free);
  smooth_cloth(both);
  EXPECT_EQ(count_crossings(both), 0u);
  EXPECT_LT(both[0].triangles.size(), free[0].triangles.size());
}
