#include <sloper/collision/body_collider.hpp>

#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <sloper/base/parallel.hpp>

namespace sloper::collision {
namespace {

using shapes::random_point;
constexpr double FAR = std::numeric_limits<double>::infinity();

double exact_winding(const TriangleMesh& mesh, const Vec3& p) {
  double w = 0;
  for (const Triangle& t : mesh.triangles)
    w += solid_angle_fraction(p, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
  return w;
}

void expect_sphere_distances(const BodyCollider& body, double tolerance, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = i % 2 ? random_point(random, 1.5)
                         : Vec3(random_point(random).normalized() * random.uniform(0.97, 1.03));
    const SignedDistance d = body.signed_distance(p, FAR);
    ASSERT_NEAR(d.distance, p.norm() - 1, tolerance) << p.transpose();
    ASSERT_NEAR(d.normal.norm(), 1, 1e-9);
    if (std::abs(d.distance) > 0.05 && p.norm() > 0.2) {
      ASSERT_GT(d.normal.dot(p.normalized()), 0.9);
    }
    ASSERT_LT((d.point + d.distance * d.normal - p).norm(), 1e-9);
  }
}

TEST(BodyCollider, GivesTheDistanceToASphereWithItsSign) {
  const BodyCollider body(shapes::sphere(5));
  EXPECT_EQ(body.findings().flipped_triangles, 0);
  EXPECT_EQ(body.findings().untrusted_triangles, 0);
  EXPECT_EQ(body.findings().boundary_edges, 0);
  expect_sphere_distances(body, 0.002, 41);
}

TEST(BodyCollider, SignAtSharpEdgesAndCornersIsThatOfTheSolid) {
  // a spike: a tetrahedron whose faces meet at acute angles, asked near its edges and corners
  TriangleMesh spike;
  spike.positions = {{0, 0, 3}, {0.1, 0, 0}, {-0.05, 0.08, 0}, {-0.05, -0.08, 0}};
  spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const BodyCollider body(spike);
  Random random(42);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15),
                 random.uniform(-0.2, 3.2)};
    const bool truth = exact_winding(spike, p) > 0.5;
    inside += truth;
    ASSERT_EQ(body.signed_distance(p, FAR).distance < 0, truth) << p.transpose();
  }
  EXPECT_GT(inside, 100);
}

TEST(BodyCollider, TurnsFlippedFacesAndInsideOutBodies) {
  TriangleMesh mesh = shapes::sphere(4);
  for (std::size_t f = 0; f < mesh.triangles.size(); f += 3)
    std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
  const BodyCollider patched(mesh);
  EXPECT_GT(patched.findings().flipped_triangles, 0);
  expect_sphere_distances(patched, 0.01, 43);
  TriangleMesh inverted = shapes::sphere(4);
  for (Triangle& t : inverted.triangles)
    std::swap(t[0], t[1]);
  const BodyCollider turned(inverted);
  EXPECT_EQ(turned.findings().flipped_triangles, static_cast<int>(inverted.triangles.size()));
  expect_sphere_distances(turned, 0.01, 44);
}

TEST(BodyCollider, KnowsInsideBesideHoles) {
  TriangleMesh mesh = shapes::sphere(4);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.positions[t[0]].y() > 0.9;
  }); // a hole at the top
  const BodyCollider body(mesh);
  EXPECT_GT(body.findings().boundary_edges, 10);
  Random random(45);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(random, 1.3);
    if (std::abs(p.norm() - 1) < 0.02 || (p.y() > 0.75 && p.norm() < 1.1))
      continue; // in the hole itself either is right
    ASSERT_EQ(body.signed_distance(p, FAR).distance < 0, p.norm() < 1) << p.transpose();
  }
  // above the rim of the hole, the nearest feature is a boundary edge; the winding number still
  // says outside
  EXPECT_GT(body.signed_distance({0, 1.2, 0}, FAR).distance, 0);
  EXPECT_LT(body.signed_distance({0, 0.6, 0}, FAR).distance, 0);
}

TEST(BodyCollider, SurvivesDuplicateNonManifoldAndZeroAreaFaces) {
  TriangleMesh mesh = shapes::sphere(4);
  const std::size_t n = mesh.triangles.size();
  for (std::size_t f = 0; f < n; f += 97)
    mesh.triangles.push_back(mesh.triangles[f]); // duplicates: non-manifold edges
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({5, 5, 5});
  const int fin = std::ssize(mesh.positions);
  mesh.positions.push_back({0, 0, 1.05});
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], fin});
  const BodyCollider body(mesh);
  EXPECT_GT(body.findings().non_manifold_edges, 0);
  Random random(46);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_point(random, 1.2);
    if (std::abs(p.norm() - 1) < 0.06)
      continue;
    const SignedDistance d = body.signed_distance(p, FAR);
    ASSERT_TRUE(std::isfinite(d.distance));
    ASSERT_EQ(d.distance < 0, p.norm() < 1) << p.transpose();
  }
}

TEST(BodyCollider, SkinBuriedInsideTheBodyIsNotItsSkin) {
  // two overlapping balls: inside one and just outside the other is still inside
  TriangleMesh mesh = shapes::sphere(4);
  shapes::append(mesh, shapes::sphere(4, 0.6, {0.9, 0.013, 0.007}));
  const BodyCollider body(mesh);
  EXPECT_GT(body.findings().self_intersections, 0);
  EXPECT_GT(body.findings().buried_triangles, 0);
  Random random(47);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = random_point(random, 1.6);
    const double a = p.norm() - 1, b = (p - Vec3(0.9, 0.013, 0.007)).norm() - 0.6;
    if (std::min(std::abs(a), std::abs(b)) < 0.01)
      continue;
    const SignedDistance d = body.signed_distance(p, FAR);
    ASSERT_EQ(d.distance < 0, a < 0 || b < 0) << p.transpose();
    if (a > 0 && b > 0) {
      ASSERT_NEAR(d.distance, std::min(a, b), 0.03);
    }
  }
}

TEST(BodyCollider, WindingNumberIsNearTheExactSum) {
  TriangleMesh mesh = shapes::sphere(4);
  shapes::append(mesh, shapes::sphere(3, 0.4, {1.2, 0.3, 0}));
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return mesh.positions[t[0]].x() < -0.8; });
  const BodyCollider body(mesh);
  Random random(48);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_point(random, 1.6);
    worst = std::max(worst, std::abs(body.winding_number(p) - exact_winding(body.mesh(), p)));
  }
  EXPECT_LT(worst, 0.005);
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(BodyCollider, HintChangesNothing) {
  const BodyCollider body(shapes::sphere(4));
  Random random(49);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_point(random, 1.2);
    const SignedDistance without = body.signed_distance(p, FAR),
                         with =
                             body.signed_distance(p, FAR, static_cast<int>(random.next() % 1000));
    ASSERT_EQ(without.distance, with.distance);
    ASSERT_EQ(without.triangle, with.triangle);
    ASSERT_EQ(without.point, with.point);
  }
}

TEST(BodyCollider, ReachLimitsTheSearch) {
  const BodyCollider body(shapes::sphere(3));
  EXPECT_EQ(body.signed_distance({3, 0, 0}, 0.5).triangle, -1);
  EXPECT_EQ(body.signed_distance({0, 0, 0}, 0.5).triangle, -1);
  EXPECT_GE(body.signed_distance({1.2, 0, 0}, 0.5).triangle, 0);
}

TEST(BodyCollider, FollowsAMovedBody) {
  TriangleMesh mesh = shapes::sphere(4);
  BodyCollider body(mesh);
  for (Vec3& p : mesh.positions)
    p += Vec3(5, 0, 0);
  body.set_positions(mesh.positions);
  EXPECT_NEAR(body.signed_distance({5, 0, 1.5}, FAR).distance, 0.5, 0.01);
  EXPECT_NEAR(body.winding_number({5, 0, 0}), 1, 0.01);
  EXPECT_NEAR(body.winding_number({0, 0, 0}), 0, 0.01);
}

TEST(BodyCollider, FindsFacesThroughIt) {
  const BodyCollider body(shapes::sphere(3));
  const TriangleMesh outside = shapes::sphere(3, 1.1);
  EXPECT_TRUE(body.faces_through(outside.positions, outside.triangles).empty());
  TriangleMesh pushed = outside;
  pushed.positions[20] *= 0.5;
  const auto hits = body.faces_through(pushed.positions, pushed.triangles);
  ASSERT_FALSE(hits.empty());
  for (int f : hits) {
    const Triangle& t = pushed.triangles[f];
    EXPECT_TRUE(t[0] == 20 || t[1] == 20 || t[2] == 20);
  }
}

TEST(BodyCollider, FaceContactSeesACornerOfTheBodyUnderAClothFace) {
  TriangleMesh spike;
  spike.positions = {{0, 1, 0}, {0.3, 0, 0.3}, {0.3, 0, -0.3}, {-0.3, 0, -0.3}, {-0.3, 0, 0.3}};
  spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 3, 2}, {1, 4, 3}};
  const BodyCollider body(spike);
  for (double gap : {0.02, -0.02}) {
    const std::vector<Vec3> cloth = {{-1, 1 + gap, -1}, {1.1, 1 + gap, -1}, {0, 1 + gap, 1.2}};
    const auto contacts = body.face_contacts(cloth, {{0, 2, 1}}, 0.05);
    ASSERT_GE(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].kind, ContactKind::FACE);
    EXPECT_NEAR(contacts[0].distance, gap, 1e-12);
    EXPECT_NEAR(contacts[0].normal.y(), 1, 1e-9);
    EXPECT_LT((contacts[0].body_point - Vec3(0, 1, 0)).norm(), 1e-12);
  }
}

TEST(BodyCollider, EdgeContactSeesARidgeAcrossAClothEdge) {
  TriangleMesh roof; // a prism with its ridge along x at y = 1
  roof.positions = {{-1, 1, 0}, {1, 1, 0}, {-1, 0, 0.5}, {1, 0, 0.5}, {-1, 0, -0.5}, {1, 0, -0.5}};
  roof.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4},
                    {0, 4, 2}, {1, 3, 5}, {2, 4, 5}, {2, 5, 3}};
  const BodyCollider body(roof);
  for (double gap : {0.01, -0.01}) {
    const std::vector<Vec3> cloth = {{0.1, 1 + gap, -1}, {0.12, 1 + gap, 1}, {0.11, 3, 0}};
    bool found = false;
    for (const FaceContact& c : body.face_contacts(cloth, {{0, 1, 2}}, 0.05))
      if (c.kind == ContactKind::EDGE && std::abs(c.distance - gap) < 1e-9 && c.normal.y() > 0.999)
        found = true;
    EXPECT_TRUE(found) << gap;
  }
}

TEST(BodyCollider, FaceContactsAreTheSameForOneAndTwoThreads) {
  const BodyCollider body(shapes::sphere(4));
  TriangleMesh cloth = shapes::sphere(4, 1.005);
  shapes::jitter(cloth, 0.004, 50);
  std::vector<FaceContact> found[2];
  for (int threads = 1; threads <= 2; ++threads) {
    set_thread_count(threads);
    found[threads - 1] = body.face_contacts(cloth.positions, cloth.triangles, 0.02);
  }
  set_thread_count(1);
  ASSERT_GT(found[0].size(), 100u);
  ASSERT_EQ(found[0].size(), found[1].size());
  for (std::size_t i = 0; i < found[0].size(); ++i) {
    ASSERT_EQ(found[0][i].triangle, found[1][i].triangle);
    ASSERT_EQ(found[0][i].distance, found[1][i].distance);
    ASSERT_EQ(found[0][i].normal, found[1][i].normal);
  }
}

TEST(BodyCollider, EmptyBodyHasNoSkin) {
  const BodyCollider body{TriangleMesh{}};
  EXPECT_EQ(body.signed_distance({0, 0, 0}, FAR).triangle, -1);
  EXPECT_EQ(body.winding_number({0, 0, 0}), 0);
  EXPECT_TRUE(body.faces_through({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}).empty());
}

} // namespace
} // namespace sloper::collision
