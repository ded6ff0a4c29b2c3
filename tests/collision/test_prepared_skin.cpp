#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <sloper/collision/body_collider.hpp>
#include <sloper/io/files.hpp>

namespace sloper::collision {
namespace {

using shapes::random_point;
constexpr double ANY_DISTANCE = std::numeric_limits<double>::infinity();

/// Two balls that overlap, with flipped faces, a hole, a fin, a triangle of no width and a loose
/// vertex: something of all that is found.
TriangleMesh troubled() {
  TriangleMesh mesh = shapes::sphere(4);
  shapes::append(mesh, shapes::sphere(3, 0.6, {0.9, 0.013, 0.007}));
  for (int f = 100; f < 140; ++f)
    std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return mesh.positions[t[0]].y() > 0.97; });
  mesh.positions.push_back({0.1, -1.4, 0});
  mesh.triangles.push_back(
      {mesh.triangles[7][0], mesh.triangles[7][1], static_cast<int>(mesh.positions.size()) - 1});
  mesh.triangles.push_back({mesh.triangles[9][0], mesh.triangles[9][0], mesh.triangles[9][1]});
  mesh.positions.push_back({3, 3, 3});
  return mesh;
}

void expect_same(const BodyCollider& a, const BodyCollider& b) {
  EXPECT_EQ(a.findings(), b.findings());
  EXPECT_EQ(a.mesh().triangles, b.mesh().triangles);
  EXPECT_EQ(a.vertex_normals(), b.vertex_normals());
  EXPECT_EQ(a.prepared(), b.prepared());
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = random_point(random, 1.6);
    const SignedDistance here = a.signed_distance(p, ANY_DISTANCE),
                         there = b.signed_distance(p, ANY_DISTANCE);
    ASSERT_EQ(here.distance, there.distance);
    ASSERT_EQ(here.triangle, there.triangle);
    ASSERT_EQ(here.normal, there.normal);
    ASSERT_EQ(a.winding_number(p), b.winding_number(p));
  }
  const TriangleMesh cloth = shapes::sphere(4, 1.02);
  EXPECT_EQ(a.faces_through(cloth.positions, cloth.triangles),
            b.faces_through(cloth.positions, cloth.triangles));
  const auto here = a.face_contacts(cloth.positions, cloth.triangles, 0.05),
             there = b.face_contacts(cloth.positions, cloth.triangles, 0.05);
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t i = 0; i < here.size(); ++i)
    ASSERT_EQ(here[i].distance, there[i].distance);
}

TEST(PreparedSkin, MakesTheSameColliderToTheBit) {
  for (const TriangleMesh& mesh : {troubled(), shapes::sphere(4), shapes::sheet(3, 5, 1, 1)})
    for (const int k : {6, 18}) {
      const BodyCollider fresh(mesh, k);
      BodyCollider again(mesh, fresh.prepared(), k);
      expect_same(fresh, again);
    }
  const PreparedSkin found = BodyCollider(troubled()).prepared();
  EXPECT_FALSE(found.turned.empty());
  EXPECT_FALSE(found.buried.empty());
  EXPECT_FALSE(found.untrusted_edges.empty());
  EXPECT_FALSE(found.untrusted_vertices.empty());
}

TEST(PreparedSkin, IsThatOfTheSkinAlsoOnceItHasMoved) {
  const TriangleMesh mesh = troubled();
  BodyCollider fresh(mesh);
  const PreparedSkin found = fresh.prepared();
  BodyCollider again(mesh, found);
  std::vector<Vec3> moved = mesh.positions;
  for (Vec3& p : moved)
    p = 0.9 * p + Vec3(0.1, 0, 0);
  fresh.set_positions(moved);
  again.set_positions(moved);
  EXPECT_EQ(fresh.prepared(), found);
  expect_same(fresh, again);
}

TEST(PreparedSkin, GoesThroughBytes) {
  const TriangleMesh mesh = troubled();
  const std::string key = skin_key(mesh);
  const PreparedSkin found = BodyCollider(mesh).prepared();
  const std::string bytes = to_bytes(found, key);
  const auto read = prepared_from_bytes(bytes, key, mesh.positions.size(), mesh.triangles.size());
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, found);
  EXPECT_EQ(to_bytes(*read, key), bytes);
}

TEST(PreparedSkin, OtherBytesAreNoPreparedSkin) {
  const TriangleMesh mesh = shapes::sphere(2);
  const std::size_t n_v = mesh.positions.size(), n_f = mesh.triangles.size();
  const std::string key = skin_key(mesh), bytes = to_bytes(BodyCollider(mesh).prepared(), key);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    ASSERT_FALSE(prepared_from_bytes(bytes.substr(0, n), key, n_v, n_f)) << "cut to " << n;
  EXPECT_FALSE(prepared_from_bytes(bytes + "x", key, n_v, n_f));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 16);
    ASSERT_FALSE(prepared_from_bytes(damaged, key, n_v, n_f)) << "byte " << i;
  }
  EXPECT_FALSE(prepared_from_bytes(bytes, skin_key(shapes::sphere(2, 1.1)), n_v, n_f));
  EXPECT_FALSE(prepared_from_bytes(bytes, key, n_v, n_f + 1));
}

/// A sum that is right does not make indices right.
TEST(PreparedSkin, WhatDoesNotFitTheMeshIsNotTaken) {
  const TriangleMesh mesh = troubled();
  const std::size_t n_v = mesh.positions.size(), n_f = mesh.triangles.size();
  const int last = static_cast<int>(n_f);
  const PreparedSkin found = BodyCollider(mesh).prepared();
  ASSERT_TRUE(found.fits(n_v, n_f));
  const std::string key = skin_key(mesh);
  const auto is_refused = [&](const auto& damage) {
    PreparedSkin other = found;
    damage(other);
    EXPECT_FALSE(other.fits(n_v, n_f));
    EXPECT_FALSE(prepared_from_bytes(to_bytes(other, key), key, n_v, n_f));
  };
  is_refused([](PreparedSkin& s) { s.order[5] = s.order[6]; });
  is_refused([&](PreparedSkin& s) { s.order[5] = last; });
  is_refused([](PreparedSkin& s) { s.order.pop_back(); });
  is_refused([](PreparedSkin& s) { s.skin_order.clear(); });
  is_refused([&](PreparedSkin& s) { s.turned.push_back(last); });
  is_refused([](PreparedSkin& s) { s.turned.insert(s.turned.begin(), -1); });
  is_refused([](PreparedSkin& s) { std::swap(s.turned[0], s.turned[1]); });
  is_refused([](PreparedSkin& s) { s.buried.pop_back(); });
  is_refused([&](PreparedSkin& s) { s.untrusted_edges.push_back(3 * last); });
  is_refused([&](PreparedSkin& s) { s.untrusted_vertices.push_back(static_cast<int>(n_v)); });
  is_refused([](PreparedSkin& s) { s.untrusted_faces.push_back(s.untrusted_faces.back()); });
}

/// What a collider finds out has changed: raise PREPARED_SKIN_VERSION, so that what older programs
/// kept is no longer taken, and put the new digest here.
TEST(PreparedSkin, ChangesOnlyWithItsVersion) {
  const TriangleMesh mesh = troubled();
  EXPECT_EQ(PREPARED_SKIN_VERSION, 1);
  EXPECT_EQ(io::sha256(to_bytes(BodyCollider(mesh).prepared(), std::string(64, '0'))),
            "2ddc99c0483bdf17754e5096e72d758df7536302ff0817233bbd75b95330fd10");
}

} // namespace
} // namespace sloper::collision
