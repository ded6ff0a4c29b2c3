/// The mannequin family: every figure is a sound mesh of the right size, and its truth lies where
/// its names say.
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <polygonise.hpp>
#include <section.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>
#include <support/made_figure.hpp>
using namespace sloper;
using namespace sloper::samples;

namespace {

Vec3 landmark(const test::MadeFigure& m, const std::string& name) {
  const io::Json& p = m.truth["landmarks"][name]["p"];
  return {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
}

double distance_to_mesh(const TriangleMesh& mesh,
                        const Vec3& p) { // to the nearest vertex; edges are about 12 mm
  double best = 1e9;
  for (const Vec3& q : mesh.positions)
    best = std::min(best, (q - p).norm());
  return best;
}

double volume(const TriangleMesh& mesh) {
  double v = 0;
  for (const Triangle& t : mesh.triangles)
    v += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
  return v;
}

} // namespace

class EveryFigure : public testing::TestWithParam<std::string> {};

TEST_P(EveryFigure, is_one_closed_outward_manifold_of_its_stature) {
  const test::MadeFigure& m = test::mannequin(GetParam());
  EXPECT_TRUE(is_closed_manifold(m.mesh));
  const std::vector<int> component =
      connected_components(m.mesh.positions.size(), m.mesh.triangles);
  EXPECT_EQ(*std::max_element(component.begin(), component.end()), 0);
  const Box3 box = bounding_box(m.mesh.positions);
  EXPECT_NEAR(box.low.y(), 0, 1e-5);
  EXPECT_NEAR(box.high.y(), preset(GetParam()).stature_m, 1e-5);
  EXPECT_GT(m.mesh.triangles.size(), 10000u);
  EXPECT_LT(m.mesh.triangles.size(), 45000u);
  // A body's mass is about its volume times water's density; the index asked for and the one had
  // agree within a quarter.
  const double mass = 985 * volume(m.mesh), index = mass / std::pow(box.high.y(), 2);
  EXPECT_NEAR(index / preset(GetParam()).bmi, 1, 0.25) << index;
}

TEST_P(EveryFigure, has_the_girths_that_it_was_asked_for) {
  const test::MadeFigure& m = test::mannequin(GetParam());
  const std::map<std::string, double> want = default_girths(preset(GetParam()));
  const auto check = [](const char* name, double got, double asked, double off = 0.03) {
    EXPECT_NEAR(got / asked, 1, off) << name;
  };
  check("waist", m.truth["levels"]["waist_semantic"]["girth_m"], want.at("waist"));
  check("hip", m.truth["levels"]["hip"]["girth_m"], want.at("hip"));
  check("bust", m.truth["levels"]["bust"]["girth_m"], want.at("bust"),
        0.05); // the root of the arm takes part in it
  check("upper_arm", m.truth["girths_m"]["upper_arm_l"], want.at("upper_arm"));
  check("wrist", m.truth["girths_m"]["wrist_l"], want.at("wrist"));
  check("neck", m.truth["girths_m"]["neck"], want.at("neck"));
  check("knee", m.truth["girths_m"]["knee_l"], want.at("knee"));
  check("calf", m.truth["girths_m"]["calf_l"], want.at("calf"));
}

TEST_P(EveryFigure, has_skin_landmarks_on_the_skin_and_joints_inside) {
  const test::MadeFigure& m = test::mannequin(GetParam());
  for (const char* name :
       {"head_tip", "hand_tip_l", "hand_tip_r", "foot_tip_l", "heel_l", "crotch", "axilla_l",
        "neck_back", "neck_front", "neck_side_l", "acromion_l", "acromion_r", "olecranon_l",
        "bust_point_l", "bust_point_r", "omphalion", "waist_side_l", "patella_l"})
    EXPECT_LT(distance_to_mesh(m.mesh, landmark(m, name)), 0.013) << name;
  for (const char* name : {"shoulder_joint_l", "elbow_l", "wrist_l", "hip_joint_l", "knee_l",
                           "ankle_l", "neck_center"})
    EXPECT_GT(distance_to_mesh(m.mesh, landmark(m, name)), 0.010) << name;
}

TEST_P(EveryFigure, has_its_landmarks_in_anatomical_order) {
  const test::MadeFigure& m = test::mannequin(GetParam());
  const auto y = [&](const char* name) { return landmark(m, name).y(); };
  const char* down[] = {"head_tip",   "neck_back", "neck_front", "axilla_l", "omphalion",
                        "hip_center", "crotch",    "knee_l",     "ankle_l"};
  for (int i = 0; i + 1 < 9; ++i)
    EXPECT_GT(y(down[i]), y(down[i + 1])) << down[i];
  EXPECT_GT(landmark(m, "foot_tip_l").z(), landmark(m, "heel_l").z() + 0.1);
  EXPECT_GT(landmark(m, "acromion_l").x(), landmark(m, "neck_side_l").x());
  EXPECT_LT(landmark(m, "neck_back").z(), landmark(m, "neck_front").z());
  const double hips = landmark(m, "hip_center").z();
  EXPECT_LT(landmark(m, "buttock_back").z(), hips - 0.05);
  EXPECT_NEAR(hips, 0, 1e-9);
}

TEST_P(EveryFigure, stands_with_its_arms_at_the_angle_asked_for) {
  const test::MadeFigure& m = test::mannequin(GetParam());
  const Vec3 arm = landmark(m, "elbow_l") - landmark(m, "shoulder_joint_l");
  EXPECT_NEAR(std::atan2(arm.x(), -arm.y()) * 180 / 3.14159265, preset(GetParam()).arm_deg, 1);
}

TEST_P(EveryFigure, labels_every_vertex_with_a_part_and_both_sides_alike) {
  const test::MadeFigure& m = test::mannequin(GetParam());
  std::array<int, 6> count{};
  for (unsigned char p : m.parts) {
    ASSERT_LT(p, 6);
    ++count[p];
  }
  for (int n : count)
    EXPECT_GT(n, 300);
  EXPECT_NEAR(static_cast<double>(count[2]) / count[3], 1, 0.05);
  EXPECT_NEAR(static_cast<double>(count[4]) / count[5], 1, 0.05);
}

INSTANTIATE_TEST_SUITE_P(figures, EveryFigure, testing::ValuesIn(preset_names()),
                         [](const auto& figure) {
                           std::string name = figure.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(mannequin, the_same_parameters_give_the_same_bytes) {
  const auto text = [] {
    const MadeMannequin m = make_mannequin(preset("f-160-a"));
    io::ObjMesh obj;
    obj.positions = m.mesh.positions;
    obj.triangles = m.mesh.triangles;
    return io::obj_text(obj, "") + io::to_text(m.truth);
  };
  EXPECT_EQ(text(), text());
}

TEST(mannequin, a_girth_that_is_given_is_had) {
  Mannequin shape = preset("f-165-a");
  shape.girths_m["waist"] = 0.82;
  shape.girths_m["hip"] = 1.06;
  const MadeMannequin m = make_mannequin(shape);
  EXPECT_NEAR(m.truth["levels"]["waist_semantic"]["girth_m"].get<double>(), 0.82, 0.015);
  EXPECT_NEAR(m.truth["levels"]["hip"]["girth_m"].get<double>(), 1.06, 0.025);
}

TEST(mannequin, parameters_outside_their_range_are_refused_by_name) {
  Mannequin shape;
  shape.stature_m = 165;
  EXPECT_THROW(make_mannequin(shape), Error);
  shape = {};
  shape.girths_m["waste"] = 0.7;
  EXPECT_THROW(make_mannequin(shape), Error);
  try {
    preset("f-165-b");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("f-165-a"), std::string::npos);
  }
}

TEST(polygonise, a_sphere_is_closed_and_on_the_surface) {
  const Field sphere = [](const Vec3& p) { return p.norm() - 0.2; };
  Box3 box;
  box.add(Vec3::Constant(-0.3));
  box.add(Vec3::Constant(0.3));
  const TriangleMesh mesh = polygonise(sphere, box, 0.02);
  EXPECT_TRUE(is_closed_manifold(mesh));
  for (const Vec3& p : mesh.positions)
    EXPECT_NEAR(p.norm(), 0.2, 1e-4);
  EXPECT_NEAR(volume(mesh), 4.0 / 3 * 3.14159265 * 0.008, 2e-4);
}

TEST(section, the_girth_of_a_notched_square_is_that_of_its_hull) {
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0.5, 0, 0.4}, {0, 0, 1}};
  const Section2 s = hull_section(points, Vec3::UnitX(), Vec3::UnitZ());
  EXPECT_NEAR(s.girth_m, 4, 1e-12);
  EXPECT_NEAR(s.area, 1, 1e-12);
  EXPECT_NEAR((s.center - Vec3(0.5, 0, 0.5)).norm(), 0, 1e-12);
}
