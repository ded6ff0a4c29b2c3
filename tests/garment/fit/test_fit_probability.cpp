/// How likely it is that a garment fits: bounds with deviations, both kinds of doubt, unknown
/// strain.
#include <garment/fit/fit_probability.hpp>
#include <sloper/base/random.hpp>
#include <sloper/garment/fit/worn_policy.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace sloper::garment {

namespace {

/// A bust of 1 m, with an ease in m that is known to 1 cm, with the 4 mm that every girth has.
FitRow bust(double ease_m) {
  FitRow row;
  row.name = "bust";
  row.body_m = 1;
  row.rest_m = row.lying_m = 1 + ease_m;
  row.ease_m = ease_m;
  row.body_uncertainty_m = row.ease_uncertainty_m = std::sqrt(0.01 * 0.01 - 0.004 * 0.004);
  return row;
}

FitReport report_of(const FitRow& row, bool fits = true, const std::string& state = "at rest") {
  FitReport report;
  report.rows.push_back(row);
  report.fits = fits;
  report.state = state;
  report.verdict = fits ? FitVerdict::OK : FitVerdict::TOO_SMALL;
  return report;
}

FitProbability probability_of(FitReport report) {
  take_probability(standard_fit_policy(), {}, report.state == "at rest", report);
  return report.probability;
}

} // namespace

TEST(fit_probability, it_is_a_half_at_a_limit_and_has_long_tails_beside_it) {
  const FitLimits limits;
  const FitProbability at = probability_of(report_of(bust(limits.too_small_ease)));
  EXPECT_NEAR(at.fits, 0.5, 1e-9);
  EXPECT_EQ(at.girth, "bust");
  EXPECT_EQ(at.rule, "too_small_ease");
  EXPECT_NEAR(probability_of(report_of(bust(limits.too_small_ease + 0.01))).fits, 0.7887, 1e-3);
  EXPECT_NEAR(probability_of(report_of(bust(limits.too_small_ease - 0.01), false)).fits, 0.2113,
              1e-3);
  EXPECT_GT(probability_of(report_of(bust(0.1))).fits, 0.99);
}

TEST(fit_probability, of_people_whose_girth_is_as_uncertain_as_said_so_many_fit) {
  // Persons of whom each was measured with an error as the model has it: among those with a
  // probability of 0.6 to 0.8, and in other ranges, the share that truly fits is the probability.
  Random random(5);
  const FitLimits limits;
  const auto student = [&] { // of two degrees of freedom, by its inverse
    const double w = 2 * random.uniform() - 1;
    return std::sqrt(2.0) * w / std::sqrt(1 - w * w);
  };
  double said = 0, fit = 0;
  int people = 0;
  for (int i = 0; i < 20000; ++i) {
    const double truth = -0.06 + 0.06 * random.uniform(), measured = truth + 0.01 * student();
    const bool fits = measured >= limits.too_small_ease;
    const double p = probability_of(report_of(bust(measured), fits, "placed")).fits;
    if (p < 0.6 || p > 0.8)
      continue;
    ++people;
    said += p;
    fit += truth >= limits.too_small_ease;
  }
  ASSERT_GT(people, 500);
  EXPECT_NEAR(said / people, fit / people, 0.05);
}

TEST(fit_probability, it_agrees_with_the_verdict) {
  FitReport tight = report_of(bust(FitLimits().too_small_ease - 0.001));
  EXPECT_EQ(probability_of(tight).fits, 0.5) << "it fits, whatever its girths say";
  FitReport wide = report_of(bust(0.1), false);
  EXPECT_EQ(probability_of(wide).fits, 0.5) << "it was refused for another reason";
  wide.verdict = FitVerdict::IMPOSSIBLE;
  EXPECT_EQ(probability_of(wide).fits, 0);
}

TEST(fit_probability, strain_and_slip_count_at_rest_only) {
  FitReport report = report_of(bust(0.1));
  report.strain_p99 = 0.049;
  report.strain_max = 0.1;
  FitProbability p = probability_of(report);
  EXPECT_LT(p.fits, 0.65);
  EXPECT_EQ(p.rule, "strain_p99");
  report.state = "not at rest";
  EXPECT_GT(probability_of(report).fits, 0.99);
  report.state = "at rest";
  report.strain_p99 = 0.01;
  report.slip_m = 0.095;
  report.slip_borne_m = 0.10;
  p = probability_of(report);
  EXPECT_EQ(p.rule, "slip_m");
  EXPECT_LT(p.fits, 0.75);
}

TEST(fit_probability, loose_cloth_is_not_stretched_by_a_body_that_is_a_little_stouter) {
  FitRow neck = bust(0.2);
  neck.body_uncertainty_m = neck.ease_uncertainty_m = 0.08; // a hem on a slope: a vague girth
  const double loose = probability_of(report_of(neck)).fits;
  EXPECT_GT(loose, 0.93);
  neck.ease_m = 0;
  neck.strain_girth = 0.02;
  EXPECT_LT(probability_of(report_of(neck)).fits, loose - 0.1);
}

TEST(fit_probability, before_any_drape_it_falls_with_what_is_missing) {
  FitRow row = bust(-0.06);
  row.short_m = 0.001;
  const double little = probability_of(report_of(row, false, "placed")).fits;
  row.short_m = 0.03;
  const double much = probability_of(report_of(row, false, "placed")).fits;
  EXPECT_LT(little, 0.25) << "one deviation of the girth was conceded before it was refused";
  EXPECT_LT(much, 0.05);
  EXPECT_GT(little, much);
}

TEST(fit_probability, unknown_strain_lowers_it_where_cloth_lay_close) {
  const FitPolicy policy = standard_fit_policy();
  FitReport report = report_of(bust(0.01));
  report.strain_unknown = true;
  take_probability(policy, {{"level:bust", 1.0}}, true, report);
  ASSERT_TRUE(report.bears);
  // 0.97 m unstretched would be 3 % below the girth of 1 m.
  EXPECT_NEAR(*report.bears, 1.01 / 0.97 - 1, 1e-9);
  EXPECT_EQ(report.bears_at, "bust");
  EXPECT_EQ(report.probability.rule, "strain_unknown");
  EXPECT_LT(report.probability.fits, 0.8);
  EXPECT_NE(unknown_strain_text(report).find("at the bust by more than 4.1 %"), std::string::npos)
      << unknown_strain_text(report);
  report.strain_unknown = false;
  report.bears.reset();
  take_probability(policy, {{"level:bust", 1.0}}, true, report);
  EXPECT_GT(report.probability.fits, 0.95) << "its pattern says what it is unstretched";
  EXPECT_EQ(unknown_strain_text(report), "");
}

TEST(fit_probability, cloth_that_hung_free_was_not_stretched) {
  FitReport report = report_of(bust(0.02));
  report.strain_unknown = true;
  take_probability(standard_fit_policy(), {{"level:bust", 0.9}}, true, report);
  EXPECT_FALSE(report.bears);
  EXPECT_GT(report.probability.fits, 0.95);
  report.rows.front().name = "top_edge"; // whose girth there is not known
  take_probability(standard_fit_policy(), {{"level:bust", 0.9}}, true, report);
  EXPECT_TRUE(report.bears);
}

} // namespace sloper::garment
