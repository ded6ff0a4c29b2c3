/// What stands is left as it stands; what lies is set on its soles.
#include <support/figures.hpp>

#include <body/ingest/upright.hpp>
#include <body/ingest/vertical.hpp>
#include <gtest/gtest.h>
#include <sloper/base/units.hpp>
#include <sloper/geometry/rotation.hpp>

using namespace sloper;
using namespace sloper::body;

TEST(RestingPlane, is_that_of_three_feet_under_the_place) {
  // feet on y = 0.1 x - 0.2 z + 1, others above it
  std::vector<Vec3> points;
  for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {0.0, 1.0}})
    points.emplace_back(x, 0.1 * x - 0.2 * z + 1, z);
  for (int k = 0; k < 50; ++k)
    points.emplace_back(std::cos(k), 1.6 + 0.1 * std::sin(3 * k), std::sin(k));
  const auto plane = resting_plane(points, Vec2::Zero());
  ASSERT_TRUE(plane);
  EXPECT_NEAR((*plane - Vec3(0.1, -0.2, 1)).norm(), 0, 1e-9);
  EXPECT_FALSE(resting_plane({Vec3::Zero(), Vec3::UnitX()}, Vec2::Zero()));
}

/// Calves, head, chest and toes as small crosses, as far before the calves as is usual and
/// `farther`, m, of a body of 1 m.
TEST(LikeliestLean, is_told_by_head_chest_and_toes_before_the_calves) {
  auto lean = [](double head, double chest, double toes) {
    std::vector<Vec3> points;
    auto add = [&](double y, double low, double high) {
      points.emplace_back(0, y, low);
      points.emplace_back(0, y, high);
    };
    add(0.2, -0.03, 0.03);
    add(0.95, 0.0256 + head - 0.05, 0.0256 + head + 0.05);
    add(0.72, 0.0098 + chest - 0.05, 0.0098 + chest + 0.05);
    add(0.01, -0.05, 0.1119 + toes);
    points.emplace_back(0.3, 0.72, 1); // a hand before the chest
    return units::degrees(likeliest_lean(points, 1));
  };
  EXPECT_NEAR(lean(0, 0, 0), -0.447, 1e-3);
  EXPECT_NEAR(lean(0.01, 0, 0), -0.447 - 0.177, 1e-3); // a head that hangs forward
  EXPECT_NEAR(lean(0, 0.01, 0), -0.447 + 0.241, 1e-3);
  EXPECT_NEAR(lean(0, 0, 0.01), -0.447 - 0.191, 1e-3);
  EXPECT_LT(std::abs(lean(0.3, -0.3, 0.3)), 2); // what is not usual counts no more
  EXPECT_NEAR(units::degrees(likeliest_lean({}, 1)), -0.447, 1e-3);
}

TEST(Upright, who_stands_or_leans_a_little_is_left_so) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  EXPECT_FALSE(upright_turn(mesh, segment_scan(mesh, "auto")));
  const TriangleMesh leaning =
      test::moved(mesh, Eigen::AngleAxisd(0.035, Vec3::UnitX()).toRotationMatrix(), Vec3::Zero());
  EXPECT_FALSE(upright_turn(leaning, segment_scan(leaning, "auto")));
}

TEST(Upright, who_leans_more_is_set_upright_from_there) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitZ())}) {
    const Eigen::Matrix3d lean = Eigen::AngleAxisd(0.15, axis).toRotationMatrix();
    const TriangleMesh leaning = test::moved(mesh, lean, Vec3::Zero());
    const auto upright = upright_turn(leaning, segment_scan(leaning, "auto"));
    ASSERT_TRUE(upright);
    EXPECT_GT((*upright * lean * Vec3::UnitY()).y(), std::cos(0.02));
  }
}

TEST(Upright, who_lies_askew_is_set_on_both_soles) {
  const TriangleMesh& mesh = test::mannequin("f-165-a").mesh;
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(2.0, Vec3::UnitZ()) * Eigen::AngleAxisd(0.7, Vec3::UnitX()))
          .toRotationMatrix();
  const TriangleMesh lying = test::moved(mesh, turn, Vec3(5, 5, 5));
  const auto upright = upright_turn(lying, segment_scan(lying, "auto"));
  ASSERT_TRUE(upright);
  EXPECT_LT(std::acos((*upright * turn * Vec3::UnitY()).y()), 0.02);
}

TEST(Upright, a_body_with_level_arms_is_found_however_it_lies) {
  const TriangleMesh& mesh = test::mannequin("m-185-t").mesh;
  Random random(5);
  for (int k = 0; k < 8; ++k) {
    const Eigen::Quaterniond q{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                               random.uniform(-1, 1)};
    const Eigen::Matrix3d turn = q.normalized().toRotationMatrix();
    const TriangleMesh lying = test::moved(mesh, turn, Vec3(1, 2, 3));
    const auto upright = upright_turn(lying, segment_scan(lying, "auto"));
    ASSERT_TRUE(upright) << k;
    EXPECT_GT((*upright * turn * Vec3::UnitY()).y(), std::cos(0.02)) << k;
  }
}

namespace {

/// Of the mannequin's own vertical, turned by `turn`: the angle to what is found, rad.
double missed_by(const Eigen::Matrix3d& turn, bool given) {
  ScanOptions options;
  if (given)
    options.up = "y";
  const Body body =
      test::measure(test::moved(test::mannequin("f-165-a").mesh, turn, Vec3::Zero()), options).body;
  const Vec3 up = body.scan_to_body.block<1, 3>(1, 0).transpose().normalized();
  return std::acos(std::min(1.0, up.dot(turn.col(1))));
}

} // namespace

TEST(Vertical, is_the_bodys_own_whichever_way_it_leans_in_the_file) {
  for (const double degrees : {0.0, 1.0, 4.0})
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(-1, 0, -1)}) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(degrees * 3.14159265 / 180, axis.normalized()).toRotationMatrix();
      EXPECT_LT(missed_by(turn, false), 0.005)
          << degrees; // posture tells it to a third of a degree
    }
}

TEST(Vertical, that_was_given_is_kept) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.02, Vec3::UnitX()).toRotationMatrix();
  EXPECT_NEAR(missed_by(turn, true), 0.02, 1e-6);
}

TEST(Vertical, of_the_file_stays_where_a_person_bends_over_level_soles) {
  TriangleMesh bent = test::mannequin("f-165-a").mesh;
  for (Vec3& p : bent.positions) // from the ankles up, which leaves the soles as they are
    if (p.y() > 0.12)
      p.z() += 0.08 * (p.y() - 0.12);
  const Body body = test::measure(bent).body;
  EXPECT_NEAR((body.scan_to_body.block<1, 3>(1, 0).normalized() - Vec3::UnitY().transpose()).norm(),
              0, 1e-6);
}

TEST(Vertical, of_a_slumped_person_is_the_files_where_the_soles_nearly_rest_on_its_level) {
  TriangleMesh mesh = test::mannequin("m-178-a").mesh;
  for (Vec3& p : mesh.positions) {
    if (p.y() > 0.9)
      p.z() -= 0.13 * (p.y() - 0.9); // the head lies 11 cm back
    if (p.y() < 0.1)
      p.y() -= 0.030 * (p.z() - 0.02); // soles 1.7 degrees from the level
  }
  const Body body = test::measure(mesh).body;
  const Vec3 up = body.scan_to_body.block<1, 3>(1, 0).transpose().normalized();
  EXPECT_LT(degrees_between(up, Vec3::UnitY()), 0.1);
}
