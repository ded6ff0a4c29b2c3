/// A retargeted garment that cannot be freed where it was placed is sewn anew from its panels.
#include "worn_skirt.hpp"

#include <garment/levels/coarse_start.hpp>
#include <sloper/base/random.hpp>
#include <sloper/garment/retarget/drape_retargeted.hpp>
#include <sloper/garment/sewing.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Draws the hem through the body to the other side.
void tangle(Garment& garment) {
  double low = 1e300;
  for (const Vec3& p : garment.position)
    low = std::min(low, p.y());
  for (Vec3& p : garment.position)
    if (p.y() < low + 0.2 && p.z() > 0)
      p.z() = -p.z() - 0.05;
}

} // namespace

class ASkirtOnAnotherFigure : public testing::Test {
protected:
  static void SetUpTestSuite() {
    s_from = new Figure("f-165-a");
    s_to = new Figure("f-160-a");
    s_skirt = new Garment(worn_skirt(*s_from, 0.028));
  }
  static void TearDownTestSuite() {
    delete s_skirt;
    delete s_to;
    delete s_from;
  }
  static Retargeted placed(RetargetMode mode) {
    const collision::BodyCollider skin(s_to->body.skin);
    return retarget(*s_skirt, s_to->body, skin, mode, silent_reporter());
  }
  static DrapeReport drape_it(Retargeted& retargeted, RetargetMode mode,
                              const DrapeSettings& settings = preset_settings("standard")) {
    return drape_retargeted(retargeted, {*s_skirt, s_to->body, mode}, settings, silent_reporter(),
                            {});
  }
  static bool is_sewn_anew(const DrapeReport& report) {
    for (const std::string& repair : report.repairs)
      if (repair.rfind("sewn anew around the body from its panels", 0) == 0)
        return true;
    return false;
  }

  inline static Figure *s_from = nullptr, *s_to = nullptr;
  inline static Garment* s_skirt = nullptr;
};

TEST_F(ASkirtOnAnotherFigure, that_is_clear_is_draped_from_where_it_was_placed) {
  Retargeted retargeted = placed(RetargetMode::KEEP_FIT);
  ASSERT_FALSE(retargeted.is_tangled);
  const DrapeReport report = drape_it(retargeted, RetargetMode::KEEP_FIT);
  EXPECT_TRUE(report.converged);
  EXPECT_FALSE(is_sewn_anew(report));
}

TEST_F(ASkirtOnAnotherFigure, that_was_cut_anew_and_is_tangled_is_sewn_anew) {
  Retargeted retargeted = placed(RetargetMode::KEEP_FIT);
  tangle(retargeted.garment);
  retargeted.is_tangled = true;
  const DrapeReport report = drape_it(retargeted, RetargetMode::KEEP_FIT);
  EXPECT_TRUE(report.converged) << stop_text(report);
  EXPECT_TRUE(is_sewn_anew(report));
  EXPECT_EQ(report.quality.value("faces_through_body", -1), 0);
  EXPECT_EQ(report.quality.value("self_intersections", -1), 0);
  EXPECT_EQ(retargeted.garment.particle_of, s_skirt->particle_of);
  EXPECT_EQ(retargeted.garment.position.size(), s_skirt->position.size());
}

TEST_F(ASkirtOnAnotherFigure, of_the_same_fabric_is_sewn_anew_where_the_first_drape_ends_tangled) {
  Retargeted retargeted = placed(RetargetMode::KEEP_FABRIC);
  tangle(retargeted.garment);
  DrapeSettings settings = preset_settings("standard");
  const DrapeReport report = drape_it(retargeted, RetargetMode::KEEP_FABRIC, settings);
  EXPECT_TRUE(is_sewn_anew(report));
  EXPECT_TRUE(report.converged) << stop_text(report);
}

TEST_F(ASkirtOnAnotherFigure, without_its_pattern_or_a_second_mesh_is_not_sewn_anew) {
  const Garment garment = placed(RetargetMode::KEEP_FABRIC).garment;
  DrapeSettings settings = preset_settings("standard");
  Garment panels;
  const auto why = [&](const Garment& source) {
    return panels_anew(garment, {source, s_to->body, RetargetMode::KEEP_FABRIC}, settings, panels);
  };
  EXPECT_EQ(why(*s_skirt), "");
  EXPECT_TRUE(panels.particle_of.empty());
  Garment nameless = *s_skirt;
  nameless.panels.source.reset();
  EXPECT_EQ(why(nameless), "it does not know its pattern");
  settings.levels = 1;
  EXPECT_EQ(why(*s_skirt), "it is to be draped on the given mesh alone");
}

TEST_F(ASkirtOnAnotherFigure, whose_panels_do_not_sew_whole_keeps_the_particles_of_its_source) {
  Retargeted retargeted = placed(RetargetMode::KEEP_FABRIC);
  tangle(retargeted.garment);
  retargeted.is_tangled = true;
  DrapeSettings settings = preset_settings("standard");
  settings.max_steps = 2;
  const DrapeReport report = drape_it(retargeted, RetargetMode::KEEP_FABRIC, settings);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(std::count(report.repairs.begin(), report.repairs.end(),
                       "not sewn anew: its seams did not close"),
            1);
  EXPECT_EQ(retargeted.garment.particle_of, s_skirt->particle_of);
  EXPECT_EQ(retargeted.garment.position.size(), s_skirt->position.size());
}

TEST_F(ASkirtOnAnotherFigure, relaxes_without_making_a_small_difference_of_its_placing_larger) {
  Garment one = placed(RetargetMode::KEEP_FABRIC).garment, other = one;
  Random random(1);
  for (Vec3& p : other.position)
    for (int k = 0; k < 3; ++k)
      p[k] += random.uniform(-1e-6, 1e-6);
  const auto rms = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < one.position.size(); ++i)
      sum += (one.position[i] - other.position[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(one.position.size()));
  };
  const double before = rms();
  DrapeReport report;
  for (Garment* garment : {&one, &other})
    EXPECT_EQ(relax_where_placed(*garment, s_to->body, preset_settings("standard"),
                                 silent_reporter(), report),
              "");
  EXPECT_LT(rms(), 20 * before) << "a drape on the given mesh alone: hundreds of times";
}

TEST_F(ASkirtOnAnotherFigure, is_not_relaxed_with_one_level_or_effects_of_its_own_choice) {
  Garment garment = placed(RetargetMode::KEEP_FABRIC).garment;
  const std::vector<Vec3> before = garment.position;
  DrapeReport report;
  DrapeSettings settings = preset_settings("standard");
  settings.levels = 1;
  EXPECT_NE(relax_where_placed(garment, s_to->body, settings, silent_reporter(), report), "");
  settings = preset_settings("standard");
  settings.effects = "auto,-friction";
  EXPECT_NE(relax_where_placed(garment, s_to->body, settings, silent_reporter(), report), "");
  EXPECT_EQ(garment.position, before);
}
