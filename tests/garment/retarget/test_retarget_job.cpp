/// The whole of a retargeting: what is draped, what is let out, what is refused before a drape.
#include "worn_skirt.hpp"

#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/retarget/nearest_size.hpp>
#include <sloper/garment/retarget/retarget_job.hpp>

#include <support/scratch_folder.hpp>

using namespace sloper;
using namespace sloper::garment;

class ARetargetedSkirt : public testing::Test {
protected:
  static void SetUpTestSuite() {
    s_from = new Figure("f-165-a");
    s_skirt = new Garment(worn_skirt(*s_from, 0.035));
  }
  static void TearDownTestSuite() {
    delete s_skirt;
    delete s_from;
  }

  struct Wish {
    RetargetMode mode = RetargetMode::KEEP_FIT;
    FitPolicy policy = standard_fit_policy();
    bool no_drape = false;
    double max_seconds = 0;
  };

  static RetargetOutcome on(const Figure& figure, const Wish& wish) {
    const collision::BodyCollider skin(figure.body.skin);
    DrapeSettings settings = preset_settings("standard");
    settings.max_seconds = wish.max_seconds;
    return retarget_and_judge({.source = *s_skirt,
                               .body = figure.body,
                               .skin = skin,
                               .skin_sha256 = "of the other",
                               .mode = wish.mode,
                               .settings = settings,
                               .policy = wish.policy,
                               .no_drape = wish.no_drape},
                              silent_reporter());
  }

  inline static Figure* s_from = nullptr;
  inline static Garment* s_skirt = nullptr;
};

TEST_F(ARetargetedSkirt, that_is_cut_anew_is_at_rest_and_fits) {
  const RetargetOutcome outcome = on(Figure("f-160-a"), {});
  EXPECT_TRUE(outcome.was_draped());
  EXPECT_TRUE(outcome.report.converged) << stop_text(outcome.report);
  EXPECT_TRUE(outcome.fit.fits) << outcome.fit.reason;
  EXPECT_EQ(outcome.retargeted.garment.body_sha256, "of the other");
  EXPECT_EQ(outcome.retargeted.report.gradings, 1);
  const auto hip = std::find_if(outcome.fit.rows.begin(), outcome.fit.rows.end(),
                                [](const FitRow& row) { return row.name == "hip"; });
  ASSERT_NE(hip, outcome.fit.rows.end());
  ASSERT_TRUE(hip->source_ease_m);
  EXPECT_NEAR(hip->ease_m, *hip->source_ease_m, 0.02);
}

TEST_F(ARetargetedSkirt, that_is_too_tight_by_the_policy_is_let_out_and_draped_again) {
  Wish wish;
  wish.policy.own.all.strain_max = 0.001; // any skirt that hangs is stretched by more
  const RetargetOutcome outcome = on(Figure("f-160-a"), wish);
  EXPECT_GT(outcome.retargeted.report.gradings, 1);
}

TEST_F(ARetargetedSkirt, whose_cloth_does_not_reach_round_is_not_draped) {
  const RetargetOutcome outcome = on(Figure("f-165-plus"), {.mode = RetargetMode::KEEP_FABRIC});
  EXPECT_FALSE(outcome.was_draped());
  EXPECT_FALSE(outcome.fit.fits);
  EXPECT_EQ(outcome.fit.verdict, FitVerdict::TOO_SMALL);
  EXPECT_EQ(outcome.report.stop_reason, StopReason::NOT_DRAPED);
  EXPECT_EQ(outcome.report.stop_detail, outcome.fit.reason);
}

TEST_F(ARetargetedSkirt, that_is_only_placed_says_so) {
  const RetargetOutcome outcome =
      on(Figure("f-160-a"), {.mode = RetargetMode::KEEP_FABRIC, .no_drape = true});
  EXPECT_FALSE(outcome.was_draped());
  EXPECT_EQ(outcome.report.stop_reason, StopReason::PLACED_ONLY);
  EXPECT_EQ(outcome.fit.state, "placed");
}

TEST_F(ARetargetedSkirt, that_does_not_close_at_the_waist_comes_after_a_size_that_does) {
  const Figure other("f-165-plus");
  const test::ScratchFolder folder;
  Garment wide = *s_skirt;
  for (Vec3& p : wide.position)
    p = Vec3(1.4 * p.x(), p.y(), 1.4 * p.z());
  write_garment(folder / "skirt@S.json", *s_skirt, "test");
  write_garment(folder / "skirt@L.json", wide, "test");
  SizeRanking ranking;
  ranking.sizes = {{.file = folder / "skirt@S.json", .distance = 0.01, .girths = 1},
                   {.file = folder / "skirt@L.json", .distance = 0.02, .girths = 1}};
  const SizeRanking by_distance = ranking;
  put_closing_sizes_first(ranking, other.body, standard_fit_policy());
  EXPECT_EQ(ranking.sizes[0].file, by_distance.sizes[1].file);
  EXPECT_GT(ranking.sizes[1].short_share, 0.03);
  EXPECT_LE(ranking.sizes[0].short_share, 0.03);
  EXPECT_DOUBLE_EQ(ranking.sizes[0].bearable_share, 0.03);
  EXPECT_NE(ranking_text(ranking).find("is the nearest that closes at the waist"),
            std::string::npos);

  ranking = by_distance; // on a slimmer body both close
  put_closing_sizes_first(ranking, Figure("f-160-a").body, standard_fit_policy());
  EXPECT_EQ(ranking.sizes[0].file, by_distance.sizes[0].file);

  ranking = by_distance; // a policy that bears as much
  FitPolicy elastic = standard_fit_policy();
  elastic.own.all.girths["top_edge"].too_small_ease = -0.9;
  put_closing_sizes_first(ranking, other.body, elastic);
  EXPECT_EQ(ranking.sizes[0].file, by_distance.sizes[0].file);
  EXPECT_DOUBLE_EQ(ranking.sizes[0].bearable_share, 0.9);

  ranking = by_distance; // a knit bears more than a woven cloth
  Garment knit = *s_skirt;
  for (pattern::PanelInfo& panel : knit.panels.panels)
    panel.material = "jersey";
  write_garment(folder / "skirt@S.json", knit, "test");
  put_closing_sizes_first(ranking, other.body, standard_fit_policy());
  for (const SizeRank& size : ranking.sizes)
    if (size.file == by_distance.sizes[0].file) {
      EXPECT_GT(size.bearable_share, 0.05);
    }
}

TEST_F(ARetargetedSkirt, is_chosen_by_the_girths_that_it_goes_round) {
  const Figure other("f-160-a");
  const std::set<std::string> covered = girths_covered(*s_skirt, other.body);
  EXPECT_TRUE(covered.count("level:hip"));
  EXPECT_TRUE(covered.count("level:abdomen"));
  for (const char* far : {"neck", "level:bust", "upper_arm_l", "wrist_r", "ankle_min_l"})
    EXPECT_FALSE(covered.count(far)) << far;

  // a wide hip on a body that is slim elsewhere: of all girths the small size is nearer
  const test::ScratchFolder folder;
  const auto write = [&](const std::string& size, double elsewhere, double below) {
    io::Json girths = io::Json::object();
    for (const auto& [name, girth] : other.body.girths)
      girths[name] = elsewhere * girth.value_m;
    for (const auto& [name, level] : other.body.levels)
      if (level.girth_m > 0)
        girths["level:" + name] =
            (covered.count("level:" + name) > 0 ? below : elsewhere) * level.girth_m;
    io::Json document = io::new_document("garment", 1, "test");
    document["body"] = {{"sha256", ""}, {"girths_m", girths}};
    io::write_json(folder / ("skirt@" + size + ".json"), document);
  };
  write("S", 1.0, 0.9);
  write("L", 1.15, 1.0);
  const auto files = sizes_beside(folder / "skirt@S.json");
  EXPECT_EQ(io::file_name(rank_sizes(files, other.body).sizes[0].file), "skirt@S.json");
  const SizeRanking ranking = rank_sizes(files, other.body, covered);
  EXPECT_EQ(io::file_name(ranking.sizes[0].file), "skirt@L.json");
  EXPECT_EQ(ranking.compared.size(), static_cast<std::size_t>(ranking.sizes[0].girths));
  EXPECT_EQ(rank_sizes(files, other.body, {"no such girth"}).compared,
            rank_sizes(files, other.body).compared);
}
