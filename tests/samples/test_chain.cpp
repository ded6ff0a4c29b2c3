/// The samples as input of the chain: drafts are read and meshed, figures are recognised by the
/// landmark finder.
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <measures.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <support/made_figure.hpp>
using namespace sloper;
using namespace sloper::samples;

class EveryDraft : public testing::TestWithParam<Draft (*)(const Measures&)> {};
class EveryScan : public testing::TestWithParam<std::string> {};

TEST_P(EveryDraft, is_read_and_meshed_with_equal_vertex_counts_on_both_sides_of_every_seam) {
  const Draft draft = GetParam()(Measures{});
  const pattern::Pattern pattern = pattern::read_pattern_json(pattern_document(draft), draft.name);
  ASSERT_EQ(pattern.panels.size(), draft.panels.size());
  ASSERT_EQ(pattern.seams.size(), draft.seams.size());
  for (std::size_t k = 0; k < draft.seams.size(); ++k) {
    const double a = pattern::side_length(pattern, pattern.seams[k].a),
                 b = pattern::side_length(pattern, pattern.seams[k].b);
    EXPECT_NEAR(a / b, 1 + draft.seams[k].ease, 0.01) << draft.seams[k].name;
  }
  const pattern::PanelMesh mesh = pattern::mesh_pattern(pattern, 0.02, draft.name);
  EXPECT_EQ(mesh.seams.size(), draft.seams.size());
  for (const pattern::MeshSeam& s : mesh.seams)
    EXPECT_EQ(s.a.size(), s.b.size()) << s.name;
  EXPECT_GT(mesh.triangles.size(), 1000u);
}

INSTANTIATE_TEST_SUITE_P(drafts, EveryDraft,
                         testing::Values(draft_shirt, draft_tshirt, draft_skirt, draft_trousers));

TEST(shirt, has_a_collar_that_is_turned_over_on_its_seam_where_it_is_asked_for) {
  Draft draft = draft_shirt(Measures{});
  for (const bool turned : {false, true}) {
    for (DraftPanel& panel : draft.panels)
      if (turned && panel.name == "collar")
        panel.roll_edge = "low";
    const pattern::Pattern pattern =
        pattern::read_pattern_json(pattern_document(draft), draft.name);
    for (const pattern::Panel& panel : pattern.panels)
      EXPECT_EQ(pattern::turned_whole(panel), turned && panel.name == "collar") << panel.name;
  }
}

TEST_P(EveryScan, has_its_main_landmarks_found_within_15_mm) {
  const test::MadeFigure& made = test::mannequin(GetParam());
  const body::MeasuredScan found =
      body::measure_scan(made.mesh, GetParam(), "", {}, silent_reporter());
  const Mat4 back = found.body.scan_to_body.inverse();
  for (const char* name :
       {"head_tip", "heel_l", "heel_r", "crotch", "neck_center", "neck_front", "hip_center",
        "buttock_back", "knee_l", "knee_r", "bust_prominent_l", "ankle_l"}) {
    const io::Json& truth = made.truth["landmarks"][name];
    if (truth["trust"] == "low")
      continue;
    ASSERT_TRUE(found.body.has_landmark(name)) << name;
    const Vec3 p = (back * found.body.landmark(name).homogeneous()).head<3>();
    const std::string axes =
        truth.contains("compare") ? truth["compare"].get<std::string>() : "xyz";
    double squared = 0;
    for (char axis : axes) {
      const int a = axis - 'x';
      squared += std::pow(p[a] - truth["p"][a].get<double>(), 2);
    }
    EXPECT_LT(std::sqrt(squared), 0.015) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(figures, EveryScan,
                         testing::Values("f-165-a", "f-172-t", "f-165-plus", "m-178-a"),
                         [](const auto& figure) {
                           std::string name = figure.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });
