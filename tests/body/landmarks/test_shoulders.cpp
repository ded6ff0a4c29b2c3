/// Two ways to the acromion, and an arm pit that touching skin hides on one side.
#include <body/landmarks/trunk_section.hpp>
#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/io/scan_reader.hpp>

#include <cstdlib>
#include <filesystem>

using namespace sloper;
using namespace sloper::body;

namespace {

bool is_doubted(const Body& body, const std::string& place) {
  for (const Finding& f : body.scan.findings)
    if (f.severity == "warning" && f.place == place)
      return true;
  return false;
}

/// Skin from the trunk to the elbow under the left arm, as a wide sleeve has it: no gap shows the
/// pit.
TriangleMesh with_one_bat_sleeve(const TriangleMesh& plain, double s) {
  TriangleMesh mesh = plain;
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    if (const double x = p.x() / s;
        p.y() > 0.6 * s && x > 0.09 && x < 0.28 && normals[v].y() < -0.2)
      p.y() -= s * std::min(0.25, 1.6 * (0.28 - x));
  }
  return mesh;
}

} // namespace

/// A shoulder whose top runs on level where it should turn down contradicts the trunk's breadths.
TEST(Acromion, is_doubted_where_slope_and_breadths_disagree) {
  const TriangleMesh& plain = test::mannequin("f-165-a").mesh;
  const Body before = test::measure(plain).body;
  EXPECT_FALSE(is_doubted(before, "acromion_l"));
  EXPECT_FALSE(is_doubted(before, "acromion_r"));
  const Vec3 acromion = test::in_scan(before, "acromion_l");
  TriangleMesh padded = plain; // an epaulette on the left shoulder
  for (Vec3& p : padded.positions)
    if (p.y() > acromion.y() - 0.12 && p.x() > acromion.x() - 0.06 && p.y() < acromion.y() + 0.03)
      p.y() += std::clamp(acromion.y() + 0.02 - p.y(), 0.0, 0.12) *
               std::exp(-std::pow((p.x() - acromion.x() - 0.035) / 0.045, 4));
  const Body after = test::measure(padded).body;
  EXPECT_TRUE(is_doubted(after, "acromion_l"));
  EXPECT_FALSE(is_doubted(after, "acromion_r"));
  EXPECT_LT(after.landmarks.at("acromion_l").confidence,
            before.landmarks.at("acromion_l").confidence);
}

/// Two of 40 fresh bodies lost one arm pit, and with it its folds, where skin of arm and flank
/// nearly touches.
TEST(ArmPit, that_is_hidden_on_one_side_is_put_as_the_other_and_told) {
  const TriangleMesh& plain = test::mannequin("m-185-t").mesh;
  const Body before = test::measure(plain).body,
             after = test::measure(with_one_bat_sleeve(plain, 1.85)).body;
  for (const char* name : {"axilla_l", "axilla_front_l", "axilla_back_l"}) {
    ASSERT_TRUE(after.has_landmark(name)) << name;
    EXPECT_LT((test::in_scan(after, name) - test::in_scan(before, name)).norm(), 0.04) << name;
  }
  EXPECT_EQ(after.landmarks.at("axilla_l").rule, "as_other_arm");
  EXPECT_TRUE(is_doubted(after, "axilla_l"));
  EXPECT_FALSE(is_doubted(after, "axilla_r"));
}

TEST(Levels, an_arm_is_left_out_from_where_its_section_meets_the_trunks) {
  ArmTrace arm;
  arm.axilla = Vec3(0.18, 1.2214, 0);
  EXPECT_NEAR(arm_joins(arm, 1.6), 1.2194, 1e-9);
  // a level of 1.2202 had the whole arm in its girth: 143 cm in place of 98
  arm.merge = Vec3(0.19, 1.2120, -0.03);
  EXPECT_LT(arm_joins(arm, 1.6), 1.2120);
  arm.pit_hidden = true;
  EXPECT_LT(arm_joins(arm, 1.6), 1.0);
}

/// Of 112 arms of fresh bodies nine that are level had no merge, or one far out: level sections
/// meet their underside in pieces, and the piece at the trunk joins first.
TEST(ArmPit, of_a_level_arm_is_where_its_nearest_piece_joins_the_trunk) {
  TriangleMesh mesh = test::mannequin("m-185-t").mesh;
  const double s = 1.85;
  const Body before = test::measure(mesh).body;
  const Vec3 pit = test::in_scan(before, "axilla_l");
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    const double out = (p.x() - pit.x()) / s;
    if (p.y() < 0.6 * s || out < 0 || normals[v].y() > -0.2)
      continue;
    p.y() -= s * (0.014 * std::exp(-std::pow((out - 0.035) / 0.015, 2)) +
                  0.018 * std::exp(-std::pow((out - 0.13) / 0.04, 2)));
  }
  const Body after = test::measure(mesh).body;
  ASSERT_TRUE(after.has_landmark("axilla_merge_l"));
  EXPECT_NEAR(after.landmark("axilla_merge_l").x(), after.landmark("axilla_l").x(), 0.035 * s);
}

/// Where rebuilt skin spans the gap, level sections of arm and trunk join 5 cm below the pit, or 7
/// cm out along a level arm.
TEST(ArmPit, draws_a_merge_of_skin_that_spans_the_gap) {
  const Rules rules = Rules::standard();
  const double s = 1.7;
  const Vec3 pit(-0.19, 1.28, 0.01);
  for (const double height : {-0.9, -0.6, -0.3, -0.05}) { // from hanging to level
    ArmTrace arm;
    arm.left = false;
    arm.out = Vec3(-std::sqrt(1 - height * height), height, 0);
    const Vec3 expected = merge_by_pit(pit, arm, rules, s);
    EXPECT_LT(expected.x(), pit.x()) << height;
    EXPECT_LT((expected - pit).norm(), 0.08) << height;
    const Vec3 near = expected + Vec3(0.015, -0.012, 0.03);
    EXPECT_EQ((drawn_to_pit(near, pit, arm, rules, s) - near).norm(), 0) << height;
    const Vec3 spanned = expected + Vec3(-0.07, -0.05, 0.02);
    const Vec3 drawn = drawn_to_pit(spanned, pit, arm, rules, s);
    EXPECT_LT(std::abs(drawn.x() - expected.x()), 0.005) << height;
    EXPECT_LT(std::abs(drawn.y() - expected.y()), 0.005) << height;
    EXPECT_EQ(drawn.z(), spanned.z()) << height;
    double before = 0; // nothing jumps
    for (double off = 0; off < 0.08; off += 0.001) {
      const Vec3 at = drawn_to_pit(expected + Vec3(0, -off, 0), pit, arm, rules, s);
      EXPECT_LT(std::abs(expected.y() - at.y() - before), 0.0025) << height << " " << off;
      before = expected.y() - at.y();
    }
  }
}

/// A gap may end at a bulge of the arm far outside of the pit: of 244 fresh bodies one had its pit
/// 10 cm outside, the shoulder joint at the hip and no merge.
TEST(ArmPit, of_a_hanging_arm_is_where_level_sections_join_however_far_out_the_gap_ends) {
  const Body body = test::measure(test::mannequin("m-178-a").mesh).body;
  const double s = body.scan.stature_m;
  const LevelStack levels(body.skin, s, 0.0025 * s);
  ArmTrace arm = trace_arms(levels, EdgeGraph(body.skin), {}, Rules::standard())[0];
  ASSERT_TRUE(arm.axilla && arm.merge);
  const Vec3 pit = *arm.axilla, merge = *arm.merge;
  *arm.axilla += Vec3(0.07 * s, 0, 0);
  arm.merge.reset();
  find_merge(arm, levels);
  ASSERT_TRUE(arm.merge);
  EXPECT_LT((*arm.merge - merge).norm(), 1e-9);
  EXPECT_LT((*arm.axilla - pit).norm(), 0.02);
  EXPECT_GT(arm.moved_to_merge_m, 0.1);
}

/// Two people of one template are two ways to the same anatomy: vertex k of one is vertex k of the
/// other, and a place between goes with the vertices about it, which are 2 cm apart. Their
/// publisher gives 38.0 and 38.2 cm between the shoulders, of which the latter is elsewhere: the
/// man's vertices at the woman's 38.0 cm are 43.7 cm apart.
TEST(Acromion, of_two_bodies_of_one_template_is_the_same_place) {
  const char* shared = std::getenv("SLOPER_SHARED");
  const auto folder = std::filesystem::path(shared ? shared : "") / "data" / "bodies" / "smpl";
  if (!shared || !std::filesystem::exists(folder))
    GTEST_SKIP() << "needs two bodies of one template: SLOPER_SHARED";
  const TriangleMesh woman = io::read_scan((folder / "f_smpl_average_A40.obj").string()).mesh,
                     man = io::read_scan((folder / "m_smpl_average_A40.obj").string()).mesh;
  ASSERT_EQ(woman.positions.size(), man.positions.size());
  const Body hers = test::measure(woman).body, his = test::measure(man).body;
  for (const char* name : {"acromion_l", "acromion_r"}) {
    const Vec3 there = test::in_scan(hers, name);
    Vec3 moved = Vec3::Zero();
    double weight = 0;
    for (std::size_t v = 0; v < woman.positions.size(); ++v)
      if (const double w = 0.03 - (woman.positions[v] - there).norm(); w > 0) {
        moved += w * (man.positions[v] - woman.positions[v]);
        weight += w;
      }
    ASSERT_GT(weight, 0);
    EXPECT_LT((there + moved / weight - test::in_scan(his, name)).norm(), 0.03) << name;
  }
}
