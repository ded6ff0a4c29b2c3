/// A tailor's dummy without head, arms or legs: its girths are those of the figure that it is of.
#include <support/figures.hpp>

#include <gtest/gtest.h>
#include <sloper/base/error.hpp>

using namespace sloper;
using namespace sloper::body;

namespace {

double stature_of(const TriangleMesh& mesh) {
  double top = 0;
  for (const Vec3& p : mesh.positions)
    top = std::max(top, p.y());
  return top;
}

/// Between two heights, without arms.
TriangleMesh dummy_of(const test::MadeFigure& figure, double low, double high) {
  std::vector<int> number(figure.mesh.positions.size(), -1);
  TriangleMesh dummy;
  for (std::size_t v = 0; v < number.size(); ++v) {
    const bool is_arm = figure.parts[v] == 2 || figure.parts[v] == 3;
    const double y = figure.mesh.positions[v].y();
    if (is_arm || y < low || y > high)
      continue;
    number[v] = static_cast<int>(dummy.positions.size());
    dummy.positions.push_back(figure.mesh.positions[v]);
  }
  for (const Triangle& t : figure.mesh.triangles)
    if (number[t[0]] >= 0 && number[t[1]] >= 0 && number[t[2]] >= 0)
      dummy.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return dummy;
}

constexpr double THIGHS = 0.43, NECK = 0.868; ///< of stature: where the dummies are cut off

ScanOptions dummy_options(double stature) {
  ScanOptions options;
  options.torso_only = true;
  options.stature_m = stature;
  return options;
}

} // namespace

TEST(HeadlessTorso, has_the_girths_of_the_whole_figure_however_it_is_turned) {
  for (const char* name : {"f-165-a", "m-178-a"}) {
    const test::MadeFigure& figure = test::mannequin(name);
    const Body whole = test::measure(figure.mesh).body;
    const double s = stature_of(figure.mesh);
    const TriangleMesh dummy = dummy_of(figure, THIGHS * s, NECK * s);
    for (const double degrees : {0.0, 75.0}) {
      const Eigen::Matrix3d turn = test::turn_about_y(degrees);
      const MeasuredScan measured =
          test::measure(test::moved(dummy, turn, Vec3::Zero()), dummy_options(s));
      const Body& body = measured.body;
      EXPECT_TRUE(measured.missing.empty())
          << name << ": " << ::testing::PrintToString(measured.missing);
      EXPECT_NEAR(body.scan.stature_m, s, 0.01 * s) << name;
      for (const auto& [level, most_m] : std::map<std::string, double>{{"waist_girth_min", 0.01},
                                                                       {"bust", 0.03},
                                                                       {"underbust", 0.03},
                                                                       {"omphalion", 0.015}}) {
        ASSERT_EQ(body.levels.count(level), 1u) << name << ": " << level;
        EXPECT_NEAR(body.levels.at(level).girth_m, whole.levels.at(level).girth_m, most_m)
            << name << " turned by " << degrees << ": " << level;
      }
      EXPECT_NEAR(body.girths.at("neck").value_m, whole.girths.at("neck").value_m, 0.03) << name;
      for (const char* absent : {"head_tip", "knee_l", "foot_tip_r", "ankle_l"})
        EXPECT_FALSE(body.has_landmark(absent)) << name << ": " << absent;
      const Vec3 forward =
          body.scan_to_body.block<3, 3>(0, 0).transpose().normalized() * Vec3::UnitZ();
      EXPECT_GT(forward.normalized().dot(turn * Vec3::UnitZ()), 0.9) << name << " " << degrees;
    }
  }
}

TEST(HeadlessTorso, without_a_stature_is_refused_and_the_option_is_named) {
  const test::MadeFigure& figure = test::mannequin("f-165-a");
  const double s = stature_of(figure.mesh);
  try {
    test::measure(dummy_of(figure, THIGHS * s, NECK * s), dummy_options(0));
    FAIL() << "was taken";
  } catch (const Error& e) {
    EXPECT_EQ(e.id(), "scan.no-stature"_id) << e.what();
    EXPECT_NE(std::string(e.what()).find("--stature"), std::string::npos) << e.what();
  }
}
