#include <support/skin_garment.hpp>

#include <garment/ingest/carried_clearance.hpp>
#include <garment/ingest/flat_panels.hpp>
#include <sloper/base/error.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/ingest/mesh_garment.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/io/files.hpp>

#include <support/scratch_folder.hpp>

#include <gtest/gtest.h>

#include <set>
#include <sstream>

namespace sloper::garment {

namespace {

const body::Body& woman() {
  static const body::Body body = measured("f-165-a");
  return body;
}
const collision::BodyCollider& her_skin() {
  static const collision::BodyCollider skin(woman().skin);
  return skin;
}

/// A mesh on its way to a file.
struct Drawn {
  std::vector<Vec3> position;
  std::vector<std::vector<int>> faces;

  void add(const Drawn& other) {
    const int first = std::ssize(position);
    position.insert(position.end(), other.position.begin(), other.position.end());
    for (std::vector<int> face : other.faces) {
      for (int& v : face)
        v += first;
      faces.push_back(face);
    }
  }
  std::string obj(double unit = 1) const {
    std::ostringstream out;
    out.precision(9);
    for (const Vec3& p : position)
      out << "v " << p.x() / unit << ' ' << p.y() / unit << ' ' << p.z() / unit << '\n';
    for (const auto& face : faces) {
      out << 'f';
      for (const int v : face)
        out << ' ' << v + 1;
      out << '\n';
    }
    return out.str();
  }
};

/// A skirt of quads around the hips, `out` wider than the tube of tube_skirt().
Drawn skirt(double out = 0, int n = 72, int rows = 30) {
  const body::Body& body = woman();
  const double top = body.levels.at("waist_semantic").y, bottom = body.landmark("knee_l").y();
  const double girth = body.levels.at("hip").girth_m + 0.06, radius = girth / (2 * M_PI);
  Drawn d;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < n; ++c) {
      const double a = 2 * M_PI * c / n;
      d.position.emplace_back(
          (1.15 * radius + out) * std::sin(a), bottom + (top - bottom) * r / rows,
          body.landmark("hip_center").z() + (0.83 * radius + out) * std::cos(a));
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * n + c, b = r * n + (c + 1) % n;
      d.faces.push_back({a, b, b + n, a + n});
    }
  return d;
}

/// The same with a thickness: outer and inner side, joined at both rims.
Drawn thick_skirt(double thickness) {
  const int n = 72, rows = 30;
  Drawn d = skirt(thickness, n, rows), inner = skirt(0, n, rows);
  const int first = std::ssize(d.position);
  for (auto& face : inner.faces)
    std::reverse(face.begin(), face.end());
  d.add(inner);
  for (int c = 0; c < n; ++c)
    for (const int r : {0, rows}) {
      const int a = r * n + c, b = r * n + (c + 1) % n;
      if (r == 0)
        d.faces.push_back({b, a, first + a, first + b});
      else
        d.faces.push_back({a, b, first + b, first + a});
    }
  return d;
}

/// A small closed box.
Drawn button(const Vec3& at, double size) {
  Drawn d;
  for (int k = 0; k < 8; ++k)
    d.position.push_back(at + size * Vec3(k % 2 - 0.5, k / 2 % 2 - 0.5, 0.3 * (k / 4)));
  d.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return d;
}

MeshGarment read(const std::string& text, const std::string& name = "garment.obj") {
  const test::ScratchFolder folder;
  const std::string path = folder / name;
  io::write_file(path, text);
  return read_mesh_garment(path, woman(), her_skin(), "hash", "cotton-poplin", silent_reporter());
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double unit = 1) {
  double d = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    d = std::max(d, (a[i] - b[i]).norm() * unit);
  return d;
}

std::vector<Vec3> dressed_positions(const MeshGarment& m, const Garment& worn) {
  return io::parse_mesh_file(dressed_mesh(m, worn, woman(), her_skin()).bytes, m.file.format, "out")
      .positions;
}

bool says_strain_is_unknown(const MeshGarment& m) {
  return std::any_of(m.findings.begin(), m.findings.end(),
                     [](const Message& f) { return f.id == "import.strain-unknown"; });
}

} // namespace

TEST(MeshGarment, has_the_edge_lengths_of_its_mesh_and_no_strain) {
  const MeshGarment m = read(skirt().obj());
  EXPECT_EQ(m.surface.polygons, 72 * 30);
  EXPECT_EQ(m.garment.panels.triangles.size(), 2u * 72 * 30);
  EXPECT_EQ(m.roles.shells + m.roles.patches + m.roles.rigid_parts, 0);
  EXPECT_FALSE(m.rest_from_texture);
  EXPECT_TRUE(says_strain_is_unknown(m)) << "a tight garment would be judged too kindly in silence";
  EXPECT_TRUE(m.garment.strain_unknown);
  EXPECT_LT(stretch_of(m.garment).max, 1e-6);
  EXPECT_FALSE(m.garment.bind.empty());
  EXPECT_LT(m.panels, 6); // a tube is unrolled whole, or nearly
}

TEST(MeshGarment, comes_out_as_it_came_where_nothing_moved) {
  for (const double unit : {1.0, 0.01, 0.001, 0.0254}) {
    const Drawn d = skirt();
    const MeshGarment m = read(d.obj(unit));
    EXPECT_EQ(m.frame.unit_m, unit);
    EXPECT_LT(farthest(dressed_positions(m, m.garment), m.file.positions, unit), 1e-6);
  }
}

TEST(MeshGarment, in_the_coordinates_of_the_scan_is_known_as_such) {
  body::Body turned = woman();
  Mat4 scan = Mat4::Identity(); // z up, millimetres, beside the origin
  scan.topLeftCorner<3, 3>() << 0.001, 0, 0, 0, 0, 0.001, 0, -0.001, 0;
  scan.topRightCorner<3, 1>() = Vec3(-0.7, 0.1, 0.2);
  turned.scan_to_body = scan;
  Drawn d = skirt();
  const Mat4 back = scan.inverse();
  for (Vec3& p : d.position)
    p = (back * p.homogeneous()).head<3>();
  const test::ScratchFolder folder;
  io::write_file(folder / "g.obj", d.obj());
  const MeshGarment m = read_mesh_garment(folder / "g.obj", turned, her_skin(), "", "cotton-poplin",
                                          silent_reporter());
  EXPECT_TRUE(m.frame.in_scan);
  const std::string bytes = dressed_mesh(m, m.garment, turned, her_skin()).bytes;
  EXPECT_LT(farthest(io::parse_mesh_file(bytes, "obj", "out").positions, d.position), 1e-3); // mm
}

TEST(MeshGarment, that_lies_nowhere_near_the_body_is_refused) {
  Drawn d = skirt();
  for (Vec3& p : d.position)
    p += Vec3(4, 0, 0);
  try {
    read(d.obj());
    FAIL() << "was read";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_NE(std::string(e.what()).find("lies nowhere near the body"), std::string::npos);
  }
}

TEST(MeshGarment, texture_that_is_the_flat_pattern_gives_the_rest_shape) {
  // A tube of which the texture is the true layout, but for a factor, with a strain of 2 % in
  // space.
  const int n = 72, rows = 30;
  const Drawn d = skirt();
  std::ostringstream out;
  out.precision(9);
  out << d.obj().substr(0, d.obj().find("\nf ") + 1);
  std::vector<double> along{0};
  for (int c = 0; c < n; ++c)
    along.push_back(along.back() + (d.position[(c + 1) % n] - d.position[c]).norm() / 1.015);
  const double height = (d.position[n] - d.position[0]).norm() / 1.015;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= n; ++c)
      out << "vt " << along[c] / 3 << ' ' << height * r / 3 << '\n';
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * n + c + 1, b = r * n + (c + 1) % n + 1, t = r * (n + 1) + c + 1;
      out << "f " << a << '/' << t << ' ' << b << '/' << t + 1 << ' ' << b + n << '/' << t + n + 2
          << ' ' << a + n << '/' << t + n + 1 << '\n';
    }
  const MeshGarment m = read(out.str());
  EXPECT_TRUE(m.rest_from_texture);
  EXPECT_FALSE(m.garment.strain_unknown);
  EXPECT_FALSE(says_strain_is_unknown(m));
  EXPECT_GT(m.texture_share, 0.99);
  EXPECT_EQ(m.panels, 1);
  EXPECT_TRUE(m.garment.rest_scale.empty());
  // A scale that is no unit cannot be told from a strain that is the same everywhere.
  EXPECT_LT(stretch_of(m.garment).max, 0.01);
  std::vector<Vec2> texture;
  for (const Vec2& uv : m.file.texture)
    texture.push_back(3 * uv);
  const TextureIsometry isometry = texture_isometry(
      {m.surface.position, m.surface.triangles, {}, {}}, texture, m.surface.texture);
  EXPECT_EQ(isometry.u_m, 1);
  EXPECT_EQ(isometry.v_m, 1);
}

TEST(MeshGarment, texture_that_is_no_pattern_is_not_taken_for_one) {
  std::string text = skirt().obj();
  std::ostringstream out;
  out << text.substr(0, text.find("\nf ") + 1);
  const Drawn d = skirt();
  for (const Vec3& p : d.position)
    out << "vt " << p.x() * p.y() << ' ' << p.y() * p.y() << '\n';
  for (const auto& face : d.faces) {
    out << 'f';
    for (const int v : face)
      out << ' ' << v + 1 << '/' << v + 1;
    out << '\n';
  }
  const MeshGarment m = read(out.str());
  EXPECT_FALSE(m.rest_from_texture);
  EXPECT_LT(stretch_of(m.garment).max, 1e-6);
}

TEST(MeshGarment, a_shell_is_simulated_as_its_inner_side) {
  const Drawn d = thick_skirt(0.004);
  const MeshGarment m = read(d.obj());
  EXPECT_EQ(m.roles.shells, 1);
  EXPECT_NEAR(m.roles.thickness_m, 0.004, 1e-3);
  EXPECT_EQ(m.garment.panels.triangles.size(), 2u * 72 * 30);
  double outermost = 0;
  for (const Vec3& p : m.garment.position)
    outermost = std::max(outermost, p.x());
  double outer = 0, inner = 0;
  for (const Vec3& p : d.position)
    outer = std::max(outer, p.x());
  for (const Vec3& p : skirt().position)
    inner = std::max(inner, p.x());
  EXPECT_NEAR(outermost, inner, 1e-6);
  EXPECT_LT(inner, outer);
  // Wider by a tenth all round, the outer side goes along, and its thickness stays.
  Garment wider = m.garment;
  for (Vec3& p : wider.position) {
    p.x() *= 1.1;
    p.z() *= 1.1;
  }
  const std::vector<Vec3> out = dressed_positions(m, wider);
  for (std::size_t i = 0; i < out.size() / 2; ++i)
    EXPECT_NEAR((out[i] - out[i + out.size() / 2]).norm(),
                (d.position[i] - d.position[i + out.size() / 2]).norm(), 3e-4);
}

/// Cloth of 20 by 9 cells of 1 cm whose other side is 4 mm above it.
struct ThickSheet {
  static constexpr int COLUMNS = 21, ROWS = 10, SIDE = COLUMNS * ROWS;
  static constexpr double CELL = 0.01, THICKNESS = 0.004; // m
  std::vector<Vec3> cloth, both;
  std::vector<Triangle> cloth_triangles, all;
  Carried carried;

  ThickSheet() {
    std::vector<int> particle;
    for (int i = 0; i < SIDE; ++i) {
      cloth.emplace_back(CELL * (i % COLUMNS), 0, -CELL * (i / COLUMNS));
      particle.push_back(i);
    }
    both = cloth;
    for (const Vec3& p : cloth)
      both.push_back(p + Vec3(0, THICKNESS, 0));
    particle.resize(both.size(), -1);
    for (int i = 0; i + COLUMNS < SIDE; ++i) {
      if (i % COLUMNS == COLUMNS - 1)
        continue;
      cloth_triangles.push_back({i, i + 1, i + 1 + COLUMNS});
      cloth_triangles.push_back({i, i + 1 + COLUMNS, i + COLUMNS});
    }
    all = cloth_triangles;
    for (const Triangle& t : cloth_triangles)
      all.push_back({t[0] + SIDE, t[1] + SIDE, t[2] + SIDE});
    carried = carry_on(both, particle, std::vector<int>(both.size(), -1), cloth, cloth_triangles);
  }
  /// Folded upwards in the middle, so that its halves are `apart`.
  std::vector<Vec3> folded(double apart) const {
    std::vector<Vec3> after = cloth;
    for (int i = 0; i < SIDE; ++i)
      if (const int column = i % COLUMNS; column > COLUMNS / 2)
        after[i] += Vec3(CELL * (COLUMNS - 2 * column), apart, 0);
    return after;
  }
  Moved moved(const std::vector<Vec3>& after) const {
    return carry_along(carried, cloth, after, cloth_triangles, nullptr);
  }
  std::size_t crossings(const std::vector<Vec3>& place) const {
    return collision::self_intersections(place, all, collision::TriangleTree(place, all)).size();
  }
};

TEST(Carried, the_other_side_of_a_shell_comes_nearer_where_a_fold_leaves_it_no_room) {
  const ThickSheet sheet;
  const std::vector<Vec3> tight = sheet.folded(0.003); // the other sides want 8 mm
  Moved moved = sheet.moved(tight);
  EXPECT_GT(sheet.crossings(moved.place), 50u);
  const CrossingPairs left =
      keep_carried_clear(sheet.carried, tight, sheet.cloth_triangles, sheet.all, {}, moved);
  EXPECT_TRUE(left.empty());
  EXPECT_EQ(sheet.crossings(moved.place), 0u);
  for (int i = 0; i < ThickSheet::SIDE; ++i)
    EXPECT_EQ(moved.place[i], tight[i]);
}

TEST(Carried, the_other_side_of_a_shell_keeps_its_distance_where_there_is_room) {
  const ThickSheet sheet;
  const std::vector<Vec3> wide = sheet.folded(0.02);
  Moved moved = sheet.moved(wide);
  const std::vector<Vec3> before = moved.place;
  EXPECT_TRUE(
      keep_carried_clear(sheet.carried, wide, sheet.cloth_triangles, sheet.all, {}, moved).empty());
  EXPECT_EQ(moved.place, before);
}

TEST(Carried, what_crossed_in_the_source_is_left_as_it_was) {
  const ThickSheet sheet;
  const std::vector<Vec3> tight = sheet.folded(0.003);
  Moved moved = sheet.moved(tight);
  const std::vector<Vec3> before = moved.place;
  const CrossingPairs known =
      collision::self_intersections(before, sheet.all, collision::TriangleTree(before, sheet.all));
  EXPECT_EQ(
      keep_carried_clear(sheet.carried, tight, sheet.cloth_triangles, sheet.all, known, moved),
      known);
  EXPECT_EQ(moved.place, before);
}

TEST(MeshGarment, faces_that_stand_twice_are_one_layer) {
  Drawn d = skirt(), turned = skirt();
  for (auto& face : turned.faces)
    std::reverse(face.begin(), face.end());
  d.add(turned);
  const MeshGarment m = read(d.obj());
  EXPECT_EQ(m.surface.duplicates, 2 * 72 * 30);
  EXPECT_EQ(m.garment.panels.triangles.size(), 2u * 72 * 30);
  EXPECT_LT(farthest(dressed_positions(m, m.garment), m.file.positions), 1e-6);
}

TEST(MeshGarment, a_button_rides_on_the_cloth_and_keeps_its_shape) {
  Drawn d = skirt();
  const std::size_t first = d.position.size();
  const Vec3 at = d.position[15 * 72] + Vec3(0, 0, 0.003);
  d.add(button(at, 0.012));
  const MeshGarment m = read(d.obj());
  EXPECT_EQ(m.roles.rigid_parts, 1);
  Garment moved = m.garment;
  for (Vec3& p : moved.position)
    p += Vec3(0, 0, 0.02 + 0.2 * p.x() * p.x()); // curved, too
  const std::vector<Vec3> out = dressed_positions(m, moved);
  for (std::size_t i = first; i < out.size(); ++i)
    for (std::size_t j = first; j < i; ++j)
      EXPECT_NEAR((out[i] - out[j]).norm(), (d.position[i] - d.position[j]).norm(), 1e-6);
  EXPECT_NEAR(out[first].z(), d.position[first].z() + 0.02, 1e-3);
}

TEST(MeshGarment, a_patch_on_the_cloth_goes_along) {
  Drawn d = skirt();
  Drawn patch;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c)
      patch.position.push_back(d.position[(10 + r) * 72 + c] + Vec3(0, 0, 0.002));
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c)
      patch.faces.push_back({r * 6 + c, r * 6 + c + 1, r * 6 + c + 7, r * 6 + c + 6});
  d.add(patch);
  const MeshGarment m = read(d.obj());
  EXPECT_EQ(m.roles.patches, 1);
  EXPECT_EQ(m.garment.panels.triangles.size(), 2u * 72 * 30);
  EXPECT_LT(farthest(dressed_positions(m, m.garment), m.file.positions), 1e-6);
}

TEST(MeshGarment, three_faces_on_an_edge_holes_and_slivers_are_taken) {
  Drawn d = skirt();
  d.faces.erase(d.faces.begin() + 1000, d.faces.begin() + 1006); // a hole
  const int first = std::ssize(d.position);
  for (int c = 0; c < 20; ++c)
    d.position.push_back(d.position[c + 15 * 72] + Vec3(0, -0.01, 0.08)); // a flounce on a row
  for (int c = 0; c + 1 < 20; ++c)
    d.faces.push_back({15 * 72 + c, 15 * 72 + c + 1, first + c + 1, first + c});
  d.faces.push_back({0, 1, 1});        // no area
  d.faces.push_back({0, 5, 10, 7, 3}); // a polygon of any kind
  const MeshGarment m = read(d.obj());
  EXPECT_EQ(m.surface.non_manifold_edges, 19);
  EXPECT_GE(m.surface.degenerate, 1);
  EXPECT_LT(farthest(dressed_positions(m, m.garment), m.file.positions), 1e-6);
}

TEST(MeshGarment, crossings_of_the_source_are_counted_and_said) {
  Drawn d = skirt(), blade;
  const Vec3 at = d.position[15 * 72];
  for (const Vec3& p : {Vec3(-0.05, 0.003, -0.03), Vec3(0.05, 0.003, -0.03),
                        Vec3(0.05, 0.003, 0.06), Vec3(-0.05, 0.003, 0.06)})
    blade.position.push_back(at + p);
  blade.faces = {{0, 1, 2, 3}};
  d.add(blade);
  const MeshGarment m = read(d.obj());
  EXPECT_GT(m.crossings, 0);
  const bool said = std::any_of(m.findings.begin(), m.findings.end(), [](const Message& f) {
    return f.text.find("crosses itself") != std::string::npos;
  });
  EXPECT_TRUE(said);
  EXPECT_EQ(dressed_mesh(m, m.garment, woman(), her_skin()).crossings, m.crossings);
}

TEST(FlatPanels, unrolled_cloth_keeps_every_edge_length) {
  // A shirt made of the skin: as doubly curved as cloth can be.
  const Garment shirt = skin_shirt(woman());
  CurvedSurface s;
  s.position = shirt.position;
  s.triangles = shirt.particle_triangles();
  s.region.assign(s.triangles.size(), 0);
  s.warp_of_region = {Vec3::UnitY()};
  const FlatPanels flat = unrolled_panels(s);
  ASSERT_EQ(flat.panels.triangles.size(), s.triangles.size());
  std::set<int> met(flat.triangle_of.begin(), flat.triangle_of.end());
  EXPECT_EQ(met.size(), s.triangles.size());
  double largest = 1, least = 1;
  for (std::size_t f = 0; f < flat.panels.triangles.size(); ++f) {
    const Triangle &t = flat.panels.triangles[f], &u = s.triangles[flat.triangle_of[f]];
    const Vec2 a = flat.panels.pattern[t[1]] - flat.panels.pattern[t[0]],
               b = flat.panels.pattern[t[2]] - flat.panels.pattern[t[0]];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(flat.particle_of[t[k]], u[k]);
      const double rest = flat.rest_scale[f][k] *
                          (flat.panels.pattern[t[(k + 1) % 3]] - flat.panels.pattern[t[k]]).norm();
      EXPECT_NEAR(rest, (s.position[u[(k + 1) % 3]] - s.position[u[k]]).norm(), 1e-9);
      largest = std::max(largest, flat.rest_scale[f][k]);
      least = std::min(least, flat.rest_scale[f][k]);
    }
  }
  EXPECT_LT(largest, 1 + 2 * UNROLLED_STRETCH);
  EXPECT_GT(least, 1 - 2 * UNROLLED_STRETCH);
}

TEST(MeshGarment, is_retargeted_like_any_other) {
  const MeshGarment m = read(skirt().obj());
  const body::Body to = measured("f-160-a");
  const collision::BodyCollider skin(to.skin);
  for (const RetargetMode mode : {RetargetMode::KEEP_FABRIC, RetargetMode::KEEP_FIT}) {
    const Retargeted worn = retarget(m.garment, to, skin, mode, silent_reporter());
    EXPECT_EQ(worn.report.cleared.faces_through, 0);
    const DressedMesh out = dressed_mesh(m, worn.garment, to, skin);
    EXPECT_EQ(out.faces_through, 0);
    EXPECT_EQ(out.crossings, 0);
    EXPECT_EQ(io::parse_mesh_file(out.bytes, "obj", "out").faces, m.file.faces);
  }
}

} // namespace sloper::garment
