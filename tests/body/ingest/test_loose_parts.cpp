/// Hair, shoes and eyes that are shells of their own change nothing of the body that they are on.
#include <support/figures.hpp>
#include <support/shapes.hpp>

#include <body/ingest/loose_parts.hpp>
#include <gtest/gtest.h>

using namespace sloper;
using namespace sloper::body;

namespace {

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const int first = std::ssize(mesh.positions);
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

void add_ellipsoid(TriangleMesh& mesh, const Vec3& center, const Vec3& radii) {
  TriangleMesh shape = shapes::sphere(3);
  for (Vec3& p : shape.positions)
    p = center + p.cwiseProduct(radii);
  append(mesh, shape);
}

/// A sheet with a border, as hair of avatars is made of: from the crown down behind the back.
void add_curtain(TriangleMesh& mesh, const Vec3& top, double width, double length) {
  const int first = static_cast<int>(mesh.positions.size()), n = 12;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      mesh.positions.push_back(top +
                               Vec3((j / double(n) - 0.5) * width, -i / double(n) * length, 0));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = first + i * (n + 1) + j;
      mesh.triangles.push_back({a, a + 1, a + n + 1});
      mesh.triangles.push_back({a + 1, a + n + 2, a + n + 1});
    }
}

int count(const Body& body, const std::string& id) {
  int n = 0;
  for (const Finding& f : body.scan.findings)
    n += f.id == id;
  return n;
}

double farthest_moved(const Body& before, const Body& after) {
  double most = before.landmarks.size() == after.landmarks.size() ? 0 : 1e9;
  for (const auto& [name, landmark] : before.landmarks)
    most =
        std::max(most, after.has_landmark(name) ? (landmark.p - after.landmark(name)).norm() : 1e9);
  return most;
}

/// A woman with a bun, eyes, a fringe of hair down her back and shoes.
TriangleMesh dressed_up(const TriangleMesh& plain, const Body& body) {
  TriangleMesh mesh = plain;
  const Vec3 crown = test::in_scan(body, "head_tip");
  add_ellipsoid(mesh, crown + Vec3(0, 0.02, -0.03), Vec3(0.05, 0.05, 0.05));
  for (const double side : {-1.0, 1.0})
    add_ellipsoid(mesh, crown + Vec3(0.03 * side, -0.11, 0.07), Vec3(0.012, 0.012, 0.012));
  add_curtain(mesh, crown + Vec3(0, -0.02, -0.14), 0.16, 0.6);
  for (const char* suffix : {"_l", "_r"}) {
    const Vec3 toe = test::in_scan(body, std::string("foot_tip") + suffix),
               heel = test::in_scan(body, std::string("heel") + suffix);
    const Vec3 middle = 0.5 * (toe + heel);
    add_ellipsoid(mesh, Vec3(middle.x(), 0.02, middle.z()),
                  Vec3(0.07, 0.06, 0.6 * (toe - heel).norm()));
  }
  return mesh;
}

} // namespace

TEST(LooseParts, are_left_out_where_the_body_is_whole_without_them) {
  const TriangleMesh& plain = test::mannequin("f-165-a").mesh;
  const Body before = test::measure(plain).body;
  const TriangleMesh mesh = dressed_up(plain, before);
  const Body after = test::measure(mesh).body;
  EXPECT_LT(farthest_moved(before, after), 1e-6);
  EXPECT_NEAR(before.scan.stature_m, after.scan.stature_m, 1e-9);
  EXPECT_EQ(count(before, "scan.loose-part"), 0);
  EXPECT_EQ(count(after, "scan.loose-part"), 2); // at the head, at the feet
  const LooseParts parts = find_loose_parts(mesh, "auto");
  ASSERT_EQ(parts.is_extra.size(), mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    ASSERT_EQ(parts.is_extra[v] != 0, v >= plain.positions.size()) << v;
}

TEST(LooseParts, are_told_from_the_body_in_any_unit_and_direction) {
  const TriangleMesh& plain = test::mannequin("m-178-a").mesh;
  const Body before = test::measure(plain).body;
  const Eigen::Matrix3d turn =
      1000 * Eigen::AngleAxisd(0.5 * 3.14159265358979, Vec3::UnitX()).toRotationMatrix();
  const Body after =
      test::measure(test::moved(dressed_up(plain, before), turn, Vec3(100, 20, 30))).body;
  EXPECT_NEAR(before.scan.stature_m, after.scan.stature_m, 1e-3);
  EXPECT_EQ(count(after, "scan.loose-part"), 2);
}

/// STL and texture seams: each face has its own corners, and is no shell.
TEST(LooseParts, faces_with_corners_of_their_own_are_one_shell) {
  const TriangleMesh& plain = test::mannequin("f-165-a").mesh;
  TriangleMesh soup;
  for (const Triangle& t : plain.triangles) {
    const int first = std::ssize(soup.positions);
    for (const int v : t)
      soup.positions.push_back(plain.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const LooseParts parts = find_loose_parts(soup, "auto");
  EXPECT_TRUE(parts.is_extra.empty());
  EXPECT_TRUE(parts.findings.empty());
}

/// A body with a large hole may be completed by what lies beside it: all is kept, and what the
/// stature includes is said.
TEST(LooseParts, of_a_body_with_a_large_hole_are_kept_and_told) {
  const TriangleMesh& plain = test::mannequin("f-165-a").mesh;
  const Body before = test::measure(plain).body;
  TriangleMesh mesh = dressed_up(plain, before);
  const Vec3 chest =
      0.5 * (test::in_scan(before, "bust_point_l") + test::in_scan(before, "bust_point_r"));
  std::erase_if(mesh.triangles,
                [&](const Triangle& t) { return (mesh.positions[t[0]] - chest).norm() < 0.12; });
  const LooseParts parts = find_loose_parts(mesh, "auto");
  EXPECT_TRUE(parts.is_extra.empty());
  ASSERT_FALSE(parts.findings.empty());
  for (const Finding& f : parts.findings) {
    EXPECT_EQ(f.id, "scan.loose-part-kept");
    EXPECT_EQ(f.severity, "warning");
  }
}
