#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/obj.hpp>

#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace sloper;
using namespace sloper::body;

namespace {

const Body& figure() {
  static const Body body = test::measure(test::mannequin("m-185-t").mesh).body;
  return body;
}

const SkinWeights& weights() {
  static const SkinWeights made = skin_weights(figure());
  return made;
}

Eigen::Quaterniond turn(const Vec3& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * 3.14159265358979 / 180, axis));
}

Pose stride() {
  Pose pose;
  pose.turn["upper_arm_l"] = arm_turn(figure(), true, 0.2);
  pose.turn["upper_arm_r"] = arm_turn(figure(), false, 0.2);
  pose.turn["thigh_l"] = turn(Vec3::UnitX(), -45);
  pose.turn["shin_l"] = turn(Vec3::UnitX(), 60);
  pose.turn["thigh_r"] = turn(Vec3::UnitX(), 20);
  pose.turn["spine"] = turn(Vec3::UnitY(), 15);
  pose.turn["root"] = turn(Vec3::UnitY(), 90);
  pose.shift = Vec3(0.3, 0.05, 1);
  return pose;
}

std::string temporary(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("sloper-pose-" + std::to_string(::getpid()) + "-" + name);
  std::ofstream(path) << text;
  return path.string();
}

/// A figure in T pose, y up, facing +z, its units centimetres.
std::string bvh(const std::string& frames) {
  std::string text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition "
                     "Zposition Zrotation Xrotation Yrotation\n"
                     "JOINT Spine\n{\nOFFSET 0 10 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n";
  for (const auto& [side, x] : {std::pair("Left", 1), std::pair("Right", -1)}) {
    const std::string s = side, dx = std::to_string(x);
    text += "JOINT " + s + "Arm\n{\nOFFSET " + std::to_string(x * 18) +
            " 40 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + s + "ForeArm\n{\nOFFSET " +
            std::to_string(x * 28) +
            " 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET " +
            std::to_string(x * 25) + " 0 0\n}\n}\n}\n";
  }
  text += "}\n";
  for (const auto& [side, x] : {std::pair("Left", 9), std::pair("Right", -9)}) {
    const std::string s = side;
    text += "JOINT " + s + "UpLeg\n{\nOFFSET " + std::to_string(x) +
            " 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + s +
            "Leg\n{\nOFFSET 0 -42 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nJOINT " + s +
            "Foot\n{\nOFFSET 0 -40 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd "
            "Site\n{\nOFFSET 0 -5 12\n}\n}\n}\n}\n";
  }
  return text + "}\nMOTION\n" + frames;
}

/// 6 of the root, 3 each of spine, two arms with forearms, two legs with shins and feet.
std::string frame(const std::string& root, double left_arm_z, double right_thigh_x) {
  std::string line = root + " 0 0 0";
  line += " " + std::to_string(left_arm_z) + " 0 0 0 0 0 0 0 0 0 0 0";
  line += " 0 0 0 0 0 0 0 0 0 0 " + std::to_string(right_thigh_x) + " 0 0 0 0 0 0 0\n";
  return line;
}

Vec3 direction(const Body& body, const std::map<std::string, Eigen::Isometry3d>& motion,
               const std::string& bone) {
  for (const Bone& b : body.bones)
    if (b.name == bone)
      return motion.at(bone).linear() * (b.tail - b.head).normalized();
  return Vec3::Zero();
}

} // namespace

TEST(Pose, no_turn_leaves_the_skin_where_it_is) {
  const std::vector<Vec3> same = posed_skin(figure(), weights(), {});
  for (std::size_t v = 0; v < same.size(); ++v)
    ASSERT_LT((same[v] - figure().skin.positions[v]).norm(), 1e-12);
}

TEST(Pose, weights_sum_to_one_and_never_jump_along_an_edge) {
  double steepest = 0;
  for (std::size_t v = 0; v < weights().share.size(); ++v) {
    double sum = 0;
    for (const double w : weights().share[v]) {
      ASSERT_GE(w, 0);
      sum += w;
    }
    ASSERT_NEAR(sum, 1, 1e-9);
  }
  auto share_of = [&](int v, int joint) {
    double sum = 0;
    for (int k = 0; k < SkinWeights::MOST; ++k)
      if (weights().joint[v][k] == joint)
        sum += weights().share[v][k];
    return sum;
  };
  for (const auto& e : edges_of(figure().skin.triangles)) {
    const double length = (figure().skin.positions[e[0]] - figure().skin.positions[e[1]]).norm();
    for (int j = 0; j < std::ssize(weights().joints); ++j)
      steepest = std::max(steepest, std::abs(share_of(e[0], j) - share_of(e[1], j)) /
                                        std::max(length, 0.005));
  }
  EXPECT_LT(steepest, 60) << "per metre: a whole weight within less than 17 mm";
}

TEST(Pose, bones_keep_their_length_and_landmarks_go_with_them) {
  const Body posed = posed_body(figure(), weights(), stride());
  ASSERT_EQ(posed.bones.size(), figure().bones.size());
  for (std::size_t b = 0; b < posed.bones.size(); ++b)
    EXPECT_NEAR((posed.bones[b].tail - posed.bones[b].head).norm(),
                (figure().bones[b].tail - figure().bones[b].head).norm(), 1e-12)
        << posed.bones[b].name;
  for (const Bone& b : posed.bones) {
    if (b.name != "thigh_l")
      continue;
    EXPECT_LT((b.tail - posed.landmark("knee_l")).norm(), 1e-12);
  }
  EXPECT_NEAR(posed.arm_l_deg, 11.5, 2);
  EXPECT_EQ(posed.stance_class, "I");
  EXPECT_TRUE(posed.frames.count("leg_l"));
}

TEST(Pose, shoulders_and_crotch_do_not_collapse) {
  const double before = test::volume(figure().skin);
  TriangleMesh after = figure().skin;
  after.positions = posed_skin(figure(), weights(), stride());
  EXPECT_NEAR(test::volume(after) / before, 1, 0.04);
  int squeezed = 0;
  for (const Triangle& t : figure().skin.triangles) {
    auto area = [&](const std::vector<Vec3>& p) {
      return area_normal(p[t[0]], p[t[1]], p[t[2]]).norm();
    };
    squeezed += area(after.positions) < 0.15 * area(figure().skin.positions);
  }
  EXPECT_LT(squeezed, 0.005 * static_cast<double>(figure().skin.triangles.size()));
}

TEST(Pose, a_raised_arm_lifts_its_shoulder_and_goes_where_it_is_told) {
  Pose up;
  up.turn["upper_arm_l"] = arm_turn(figure(), true, 170 * 3.14159265358979 / 180);
  const auto motion = joint_motions(figure(), up);
  EXPECT_NEAR(direction(figure(), motion, "upper_arm_l").y(), std::cos(10 * 3.14159265358979 / 180),
              0.02);
  const Body posed = posed_body(figure(), weights(), up);
  const double rise =
      posed.landmark("shoulder_joint_l").y() - figure().landmark("shoulder_joint_l").y();
  EXPECT_GT(rise, 0.03);
  EXPECT_LT(rise, 0.10);
  EXPECT_EQ(posed.landmark("shoulder_joint_r"), figure().landmark("shoulder_joint_r"));
  TriangleMesh after = figure().skin;
  after.positions = posed.skin.positions;
  EXPECT_NEAR(test::volume(after) / test::volume(figure().skin), 1, 0.04);
  up.turn["clavicle_l"] = Eigen::Quaterniond::Identity(); // told to stay
  EXPECT_LT(
      (joint_motions(figure(), up).at("clavicle_l").matrix() - Eigen::Matrix4d::Identity()).norm(),
      1e-12);
}

TEST(Pose, a_file_names_joints_and_angles_and_a_wrong_name_is_refused_with_a_suggestion) {
  const std::string good = temporary(
      "good.json",
      R"({"format": "pose", "version": 1, "arms_deg": 30, "turn_deg": {"shin_l": [50, 0, 0]}})");
  const Pose pose = read_pose(good, figure());
  EXPECT_EQ(pose.turn.count("shin_l"), 1u);
  EXPECT_NEAR(posed_body(figure(), weights(), pose).arm_r_deg, 30, 1.5);
  const std::string bad = temporary(
      "bad.json", R"({"format": "pose", "version": 1, "turn_deg": {"shin_left": [50, 0, 0]}})");
  try {
    read_pose(bad, figure());
    ADD_FAILURE() << "was read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("shin_l"), std::string::npos) << e.what();
  }
  std::filesystem::remove(good);
  std::filesystem::remove(bad);
}

TEST(Bvh, bones_take_the_directions_of_the_motion_whatever_stance_the_scan_has) {
  const std::string text = bvh("Frames: 2\nFrame Time: 0.05\n" + frame("0 90 0 0 0 0", 0, 0) +
                               frame("0 90 20 0 0 0", -80, -30));
  for (const char* name : {"m-185-t", "f-165-a"}) {
    const Body body = test::measure(test::mannequin(name).mesh).body;
    const Motion motion = parse_bvh(text, "walk.bvh", body, 0);
    ASSERT_EQ(motion.poses.size(), 2u);
    const auto first = joint_motions(body, motion.poses[0]),
               second = joint_motions(body, motion.poses[1]);
    EXPECT_GT(direction(body, first, "upper_arm_l").x(), 0.99) << "T pose first";
    EXPECT_GT(direction(body, first, "forearm_r").dot(-Vec3::UnitX()), 0.99);
    const Vec3 hanging(std::cos(-80 * 3.14159265 / 180), std::sin(-80 * 3.14159265 / 180), 0);
    EXPECT_GT(direction(body, second, "upper_arm_l").dot(hanging), 0.999);
    EXPECT_GT(direction(body, second, "forearm_l").dot(hanging), 0.999)
        << "the elbow stays straight";
    const Vec3 ahead(0, -std::cos(30 * 3.14159265 / 180), std::sin(30 * 3.14159265 / 180));
    EXPECT_GT(direction(body, second, "thigh_r").dot(ahead), 0.999);
    EXPECT_GT(motion.poses[1].shift.z() - motion.poses[0].shift.z(), 0.1)
        << "the hips travel with the legs' scale";
  }
}

TEST(Bvh, a_broken_file_is_refused_by_line_and_fact) {
  const std::string whole = bvh("Frames: 1\nFrame Time: 0.05\n" + frame("0 90 0 0 0 0", 0, 0));
  const std::pair<std::string, const char*> cases[] = {
      {whole.substr(0, whole.find("JOINT")), "ends early"},
      {whole.substr(0, whole.size() - 20), "ends early"},
      {"HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 nan\n", "not a finite number"},
      {"not a bvh", "HIERARCHY"},
      {"HIERARCHY\nROOT A\n{\nOFFSET 0 0 0\nCHANNELS 1 Wrotation\n}\n", "not a BVH channel"}};
  for (const auto& [text, fact] : cases) {
    try {
      parse_bvh(text, "walk.bvh", figure(), 0);
      ADD_FAILURE() << "was read; expected: " << fact;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::INPUT);
      EXPECT_NE(std::string(e.what()).find(fact), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("line"), std::string::npos) << e.what();
    }
  }
}

TEST(Bvh, a_motion_is_written_as_numbered_skins_of_one_topology) {
  const Motion motion =
      parse_bvh(bvh("Frames: 3\nFrame Time: 0.1\n" + frame("0 90 0 0 0 0", 0, 0) +
                    frame("0 90 5 0 0 0", -20, 10) + frame("0 90 9 0 0 0", -40, 20)),
                "walk.bvh", figure(), 0);
  const std::string base = temporary("motion.json", "");
  write_body(base, figure(), "test");
  write_motion(base, figure(), weights(), motion, "test", silent_reporter());
  const io::ObjMesh rest = io::read_obj(io::mesh_path_beside(base));
  for (const char* number : {"0001", "0002", "0003"}) {
    std::string path = io::mesh_path_beside(base);
    path.insert(path.size() - 4, std::string(".") + number);
    const io::ObjMesh mesh = io::read_obj(path);
    EXPECT_EQ(mesh.triangles, rest.triangles);
    EXPECT_EQ(mesh.positions.size(), rest.positions.size());
    std::filesystem::remove(path);
  }
  std::filesystem::remove(base);
  std::filesystem::remove(io::mesh_path_beside(base));
}
