/// Level slices of simple solids: which loop is the trunk, where the crotch lies, and the arm pit
/// between an arm and a trunk.
#include <body/landmarks/crotch.hpp>
#include <gtest/gtest.h>
#include <sloper/body/measure/arm_trace.hpp>
#include <sloper/body/measure/level_stack.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

constexpr double STATURE = 1.7;

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const int shift = std::ssize(mesh.positions);
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  for (const Triangle& t : more.triangles)
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

/// A prism over `outline` (counterclockwise about `along`, seen whole from its first point), from
/// -half to half of it.
TriangleMesh prism(const std::vector<Vec2>& outline, const Vec3& first, const Vec3& second,
                   const Vec3& along, double half) {
  TriangleMesh mesh;
  const int n = std::ssize(outline);
  for (const double end : {-half, half})
    for (const Vec2& q : outline)
      mesh.positions.push_back(q.x() * first + q.y() * second + end * along);
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    mesh.triangles.push_back({k, next, next + n});
    mesh.triangles.push_back({k, next + n, k + n});
    if (k == 0 || next == 0)
      continue;
    mesh.triangles.push_back({0, next, k});
    mesh.triangles.push_back({n, k + n, next + n});
  }
  return mesh;
}

TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh =
      prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}},
            Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), 0.5 * (high.z() - low.z()));
  for (Vec3& p : mesh.positions)
    p.z() += 0.5 * (low.z() + high.z());
  return mesh;
}

TriangleMesh legs(double top) {
  TriangleMesh mesh = box({0.03, 0, -0.07}, {0.15, top, 0.07});
  append(mesh, box({-0.15, 0, -0.07}, {-0.03, top, 0.07}));
  return mesh;
}

/// Legs, as high as `top`, under a trunk whose lower side is lowest in front and, at the depth
/// `behind`, there by `lower` more.
TriangleMesh two_lowest_places(double lower, double behind = -0.1, double top = 0.82) {
  TriangleMesh mesh = legs(top);
  const std::vector<Vec2> side = {{0, 1.4},  {-0.12, 1.4}, {behind, 0.8 - lower},
                                  {0, 0.81}, {0.06, 0.8},  {0.12, 1.4}}; // z, y
  append(mesh, prism(side, Vec3::UnitZ(), Vec3::UnitY(), -Vec3::UnitX(), 0.17));
  return mesh;
}

} // namespace

TEST(LevelStack, trunk_goes_on_in_the_neck_where_raised_shoulders_are_larger) {
  TriangleMesh mesh = legs(0.8);
  append(mesh, box({-0.18, 0.8, -0.1}, {0.18, 1.3, 0.1}));
  append(mesh, box({-0.8, 1.3, -0.08}, {0.8, 1.4, 0.08}));
  append(mesh, box({0.15, 1.4, -0.08}, {0.5, 1.46, 0.08}));
  append(mesh, box({-0.5, 1.4, -0.08}, {-0.15, 1.46, 0.08}));
  append(mesh, box({-0.05, 1.4, -0.06}, {0.05, 1.7, 0.06}));
  const LevelStack levels(mesh, STATURE, 0.005);
  for (const double y : {1.42, 1.45, 1.55}) {
    const auto neck = levels.trunk_at(y);
    ASSERT_TRUE(neck) << y;
    EXPECT_NEAR(neck->size().x(), 0.1, 1e-9) << y;
  }
}

TEST(LevelStack, crotch_that_is_as_low_behind_lies_in_front) {
  const TriangleMesh nearly = two_lowest_places(0.0001), clearly = two_lowest_places(0.0007);
  const LevelStack front(nearly, STATURE, 0.005), back(clearly, STATURE, 0.005);
  ASSERT_TRUE(front.crotch() && back.crotch());
  EXPECT_NEAR(*front.crotch(), 0.7999, 1e-6); // its height is the lowest all the same
  EXPECT_NEAR(*back.crotch(), 0.7993, 1e-6);
  EXPECT_NEAR(front.crotch_point().y(), 0.06, 0.005);
  EXPECT_NEAR(back.crotch_point().y(), -0.1, 0.005);
}

/// Which place is the lower one is a matter of the vertical: of 444 bodies nine, whose own one was
/// half a degree from the scanner's, had the crotch 40 to 120 mm too far forward or back.
TEST(LevelStack, crotch_that_is_lowest_twice_is_the_lower_one_by_the_vertical) {
  const TriangleMesh behind = two_lowest_places(0.0007);
  const LevelStack leaning(behind, STATURE, 0.005, 0, Vec3(0, 1, -0.007).normalized());
  ASSERT_TRUE(leaning.crotch());
  EXPECT_NEAR(leaning.crotch_point().y(), 0.06, 0.005);
  const TriangleMesh before = two_lowest_places(-0.0007);
  const LevelStack back(before, STATURE, 0.005, 0, Vec3(0, 1, 0.007).normalized());
  ASSERT_TRUE(back.crotch());
  EXPECT_NEAR(back.crotch_point().y(), -0.1, 0.005);
}

/// Of 384 bodies 32 were warned of for a second place that was higher by a millimetre; 25 of them
/// were right.
TEST(LevelStack, crotch_has_another_place_only_where_half_a_millimetre_decides) {
  auto is_told = [](double lower) {
    const TriangleMesh skin = two_lowest_places(lower, -0.07);
    return LevelStack(skin, STATURE, 0.005).other_crotch().has_value();
  };
  EXPECT_FALSE(is_told(-0.001)); // lowest in front
  EXPECT_TRUE(is_told(0));
  EXPECT_TRUE(is_told(0.0004));
  EXPECT_FALSE(is_told(0.0012));
}

/// The place in front may lie just above the height at which the legs are one: one of twelve bodies
/// had its crotch 132 mm too far back.
TEST(LevelStack, crotch_in_front_may_lie_just_above_where_the_legs_become_one) {
  constexpr double MERGED = 0.79995; // below the place in front (0.8), above that behind (0.7999)
  const TriangleMesh skin = two_lowest_places(0.0001, -0.05, MERGED);
  const LevelStack levels(skin, STATURE, 0.005);
  ASSERT_TRUE(levels.crotch());
  EXPECT_NEAR(*levels.crotch(), 0.7999, 1e-4); // where the legs become one is bisected
  EXPECT_NEAR(levels.crotch_point().y(), 0.06, 0.005);
}

/// Legs that are one from 8 cm below the trunk by a web, `deep` from front to back.
TriangleMesh legs_with_a_web(double deep) {
  const double z = 0.5 * deep;
  const std::vector<Vec2> section = {{0.03, z},      {0.03, 0.07},  {0.15, 0.07},  {0.15, -0.07},
                                     {0.03, -0.07},  {0.03, -z},    {-0.03, -z},   {-0.03, -0.07},
                                     {-0.15, -0.07}, {-0.15, 0.07}, {-0.03, 0.07}, {-0.03, z}};
  TriangleMesh web = prism(section, Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY(), 0.05);
  for (Vec3& p : web.positions)
    p.y() += 0.77; // 0.72 to 0.82
  TriangleMesh mesh = legs(0.72);
  append(mesh, web);
  append(mesh, box({-0.17, 0.8, -0.12}, {0.17, 1.4, 0.12}));
  return mesh;
}

/// Skin that spans the gap between thighs is thin: of ten scans whose legs had grown together the
/// crotch was 31 to 56 mm too low. A trunk's underside is not.
TEST(Crotch, under_a_thin_web_is_where_the_rest_of_the_body_lets_expect_it) {
  auto moved = [](double deep) {
    const TriangleMesh skin = legs_with_a_web(deep);
    LevelStack levels(skin, STATURE, 0.005);
    EXPECT_TRUE(levels.crotch());
    EXPECT_NEAR(levels.crotch().value_or(0), 0.72, 0.001);
    CrotchSource source = CrotchSource::SKIN;
    std::vector<Finding> findings;
    std::vector<std::string> trail;
    const Rules rules = Rules::standard();
    const bool is_moved = expect_crotch(levels, {0.8 / STATURE, 0.0077}, {{}, rules, false, true},
                                        source, findings, trail);
    EXPECT_EQ(is_moved, source == CrotchSource::REST_OF_BODY);
    EXPECT_EQ(findings.size(), is_moved ? 1U : 0U);
    return levels.crotch().value_or(0) - 0.72;
  };
  EXPECT_NEAR(moved(0.03), 0.08, 0.001);
  EXPECT_NEAR(moved(0.11), 0, 0.001);
}

/// Of 226 fresh bodies four had their crotch between both ends of the trunk's underside, 16 to 79
/// mm off; of 21 rebuilt skins eight, 21 to 62 mm off on seven. Mannequins have theirs between.
TEST(Crotch, between_both_ends_is_doubted_and_on_rebuilt_skin_drawn_to_one) {
  struct Result {
    double z;
    std::vector<Finding> findings;
  };
  auto result = [](double lowest, bool rebuilt, double at_an_end) {
    TriangleMesh skin = legs(0.82);
    const std::vector<Vec2> side = {{0, 1.4}, {-0.12, 1.4}, {lowest, 0.8}, {0.12, 1.4}}; // z, y
    append(skin, prism(side, Vec3::UnitZ(), Vec3::UnitY(), -Vec3::UnitX(), 0.17));
    LevelStack levels(skin, STATURE, 0.005);
    EXPECT_TRUE(levels.crotch());
    EXPECT_NEAR(levels.crotch_point().y(), lowest, 0.005);
    CrotchSource source = CrotchSource::SKIN;
    Result made;
    std::vector<std::string> trail;
    const Rules rules = Rules::standard();
    EXPECT_FALSE(expect_crotch(levels, {0.8 / STATURE, 0.0077},
                               {{}, rules, rebuilt, true, at_an_end}, source, made.findings,
                               trail));
    made.z = levels.crotch_point().y();
    return made;
  };
  constexpr double BETWEEN = -0.01, AT_AN_END = 0.055;
  const Result own = result(BETWEEN, false, 1);
  EXPECT_NEAR(own.z, BETWEEN, 0.005);
  ASSERT_EQ(own.findings.size(), 1U);
  EXPECT_EQ(own.findings.front().id, "scan.crotch-rounded");
  EXPECT_EQ(own.findings.front().place, "crotch");
  const Result rebuilt = result(BETWEEN, true, 1);
  EXPECT_GT(std::abs(rebuilt.z - BETWEEN), 0.03);
  ASSERT_EQ(rebuilt.findings.size(), 1U);
  EXPECT_EQ(rebuilt.findings.front().id, "scan.crotch-rounded");
  const Result mannequin = result(BETWEEN, false, 0);
  EXPECT_EQ(mannequin.findings.size(), 0U);
  EXPECT_NEAR(result(BETWEEN, true, 0).z, BETWEEN, 0.005);
  EXPECT_EQ(result(AT_AN_END, false, 1).findings.size(), 0U);
}

namespace {

/// The left pit between a level arm and the trunk of an outline (x, y), 20 cm deep.
ArmTrace pit_of(const std::vector<Vec2>& outline) {
  const TriangleMesh skin = prism(outline, Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), 0.1);
  const LevelStack levels(skin, STATURE, 0.005);
  ArmTrace arm;
  arm.left = true;
  arm.tip = Vec3(0.75, 1.37, 0);
  arm.out = Vec3::UnitX();
  arm.sections.resize(20);
  for (std::size_t k = 0; k < arm.sections.size(); ++k) {
    LimbSection& section = arm.sections[k];
    section.along = 0.025 * static_cast<double>(k);
    section.center = arm.tip - section.along * arm.out;
    section.axis = -arm.out;
    section.girth = 0.33;
  }
  find_axilla(arm, levels, Rules::standard());
  return arm;
}

} // namespace

/// The skin from a level arm to the trunk's side runs along the lines that look for the gap between
/// both: it closes nowhere in particular.
TEST(ArmPit, lies_at_its_usual_distance_from_a_level_arm_where_the_skin_has_no_corner) {
  const ArmTrace arm = pit_of({{0.19, 1.42},
                               {0, 1.42},
                               {0, 0.9},
                               {0.15, 0.9},
                               {0.19, 1.1},
                               {0.205, 1.2253},
                               {0.26, 1.315},
                               {0.3, 1.32},
                               {0.75, 1.32},
                               {0.75, 1.42}});
  ASSERT_TRUE(arm.axilla);
  EXPECT_FALSE(arm.pit_hidden);
  EXPECT_NEAR(arm.axilla->y(), 1.282, 0.008);
}

/// A gap that ends after a few lines is a fold of the arm beside them: of 704 bodies one had both
/// its pits hidden by it.
TEST(ArmPit, is_not_hidden_by_a_fold_of_the_arm) {
  const std::vector<Vec2> trunk = {{0.19, 1.42}, {0, 1.42}, {0, 0.9}, {0.17, 0.9}, {0.19, 1.3}};
  const std::vector<Vec2> fold = {{0.402, 1.32}, {0.402, 1.325}, {0.397, 1.325},
                                  {0.397, 1.33}, {0.405, 1.33},  {0.405, 1.32}};
  std::vector<Vec2> plain = trunk, folded = trunk;
  folded.insert(folded.end(), fold.begin(), fold.end());
  for (std::vector<Vec2>* outline : {&plain, &folded})
    outline->insert(outline->end(), {{0.75, 1.32}, {0.75, 1.42}});
  const ArmTrace expected = pit_of(plain), arm = pit_of(folded);
  ASSERT_TRUE(expected.axilla && arm.axilla);
  EXPECT_FALSE(expected.pit_hidden);
  EXPECT_FALSE(arm.pit_hidden);
  EXPECT_LT((*arm.axilla - *expected.axilla).norm(), 0.001);
}
