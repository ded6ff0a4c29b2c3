#include "dressed.hpp"

#include <support/skin_garment.hpp>

#include <garment/fit/fit_places.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/io/json.hpp>

#include <gtest/gtest.h>

#include <fstream>

namespace sloper::garment {

namespace {

std::string policy_file(const std::string& text) {
  const std::string path = testing::TempDir() + "policy.json";
  std::ofstream(path) << R"({"format": "fit-policy", "version": 1, )" << text << "}";
  return path;
}

} // namespace

TEST(FitPolicy, what_is_borne_on_its_own_body_is_borne_on_another) {
  FitPolicy policy = standard_fit_policy();
  const FitLimits limits = policy.limits("bust", "top");
  EXPECT_EQ(policy.too_small_ease(limits, -0.06, "bust", "top", ""), limits.too_small_ease)
      << "nothing is known of it";
  EXPECT_EQ(policy.strain_p99("top", ""), 0.05);
  policy.worn_p99 = 0.07;
  policy.worn_max = 0.1;
  EXPECT_NEAR(policy.strain_p99("top", ""), 0.077, 1e-12);
  EXPECT_EQ(policy.strain_max("top", ""), 0.30) << "what any cloth bears stays";
  EXPECT_NEAR(policy.too_small_ease(limits, -0.06, "bust", "top", ""), -0.07, 1e-12);
  EXPECT_EQ(policy.too_small_ease(limits, 0.2, "bust", "top", ""), limits.too_small_ease)
      << "it was not tight";
  policy.own.all.standard.too_small_ease = -0.02;
  EXPECT_EQ(policy.too_small_ease(policy.limits("bust", "top"), -0.06, "bust", "top", ""), -0.02)
      << "a document says so";
}

TEST(fit_policy, a_girth_goes_before_the_default_and_a_fabric_before_a_class) {
  const FitPolicy p = read_fit_policy(
      policy_file(R"("name": "shop", "refuse": ["tight"], "default": {"tight_ease": 0.02},
    "girths": {"wrist": {"loose_ease": 1.0}}, "classes": {"skirt": {"default": {"loose_ease": 2.0}}},
    "fabrics": {"jersey": {"default": {"too_small_ease": -0.2, "tight_ease": -0.1}, "strain_p99": 0.25}})"));
  EXPECT_TRUE(p.refuse_tight);
  EXPECT_DOUBLE_EQ(p.limits("bust").tight_ease, 0.02);
  EXPECT_DOUBLE_EQ(p.limits("bust").loose_ease, 0.5);
  EXPECT_DOUBLE_EQ(p.limits("wrist_l").loose_ease, 1.0);
  EXPECT_DOUBLE_EQ(p.limits("hip", "skirt").loose_ease, 2.0);
  EXPECT_DOUBLE_EQ(p.limits("hip", "skirt", "jersey").tight_ease, -0.1);
  EXPECT_DOUBLE_EQ(p.strain_p99("skirt", "jersey"), 0.25);
  EXPECT_DOUBLE_EQ(p.strain_p99("skirt", "poplin"), 0.05);
}

TEST(fit_policy, what_hangs_from_the_waist_may_not_be_far_wider_than_it) {
  const FitPolicy woven = standard_fit_policy();
  EXPECT_LT(woven.limits("waist_semantic", "trousers").too_large_ease, 0.42);
  EXPECT_LT(woven.limits("top_edge", "skirt").too_large_ease, 0.42);
  EXPECT_LT(woven.limits("waist_semantic", "top").loose_ease, 0.42);
  EXPECT_GT(woven.limits("hip", "skirt").loose_ease, 1);
  EXPECT_TRUE(std::isinf(woven.limits("hip", "skirt").too_large_ease));
  EXPECT_TRUE(std::isinf(
      woven.limits("omphalion", "skirt").too_large_ease)); // it may flare from its top edge on
}

TEST(fit_policy, a_limit_that_is_said_pushes_those_that_are_not) {
  const FitPolicy p = read_fit_policy(policy_file(
      R"("default": {"too_large_ease": 0.1}, "girths": {"bust": {"loose_ease": 0.9}})"));
  EXPECT_DOUBLE_EQ(p.limits("waist_semantic", "top").too_large_ease,
                   0.1); // before the standard policy's own word on the waist
  EXPECT_DOUBLE_EQ(p.limits("waist_semantic", "top").loose_ease, 0.1);
  EXPECT_DOUBLE_EQ(p.limits("bust", "top").loose_ease, 0.9);
  EXPECT_DOUBLE_EQ(p.limits("bust", "top").too_large_ease, 0.9);
  EXPECT_THROW(
      read_fit_policy(policy_file(R"("default": {"loose_ease": 0.5, "too_large_ease": 0.1})")),
      Error);
}

TEST(fit_policy, a_girth_above_its_limit_is_too_large_and_refused) {
  const body::Body body = measured("f-165-a");
  FitPolicy policy = read_fit_policy(
      policy_file(R"("girths": {"bust": {"loose_ease": 0.01, "too_large_ease": 0.02}})"));
  const Dressed d = dressed(body, skin_shirt(body, 0.01), policy);
  EXPECT_FALSE(d.report.fits);
  EXPECT_EQ(d.report.verdict, FitVerdict::TOO_LARGE);
  EXPECT_EQ(d.report.reason.rfind("is too large at the bust: ", 0), 0u) << d.report.reason;
  const io::Json document = fit_json(d.report, "test");
  EXPECT_NEAR(document["girths"]["bust"]["limits_percent"]["too_large"].get<double>(), 2, 1e-9);
  EXPECT_NE(fit_page(d.report, "a", "b").find("class=\"limit\""), std::string::npos);
}

TEST(fit_policy, a_girth_with_less_ease_than_is_asked_for_is_not_told_as_one_that_does_not_close) {
  const body::Body body = measured("f-165-a");
  const FitPolicy policy = read_fit_policy(
      policy_file(R"("girths": {"bust": {"too_small_ease": 0.4, "tight_ease": 0.4}})"));
  const Dressed d = dressed(body, skin_shirt(body, 0.01), policy);
  EXPECT_EQ(d.report.verdict, FitVerdict::TOO_SMALL);
  EXPECT_EQ(d.report.reason.rfind("has too little ease at the bust: ", 0), 0u) << d.report.reason;
}

TEST(fit_policy, what_was_cut_wide_is_not_too_large_for_being_wide) {
  FitPolicy policy = standard_fit_policy();
  const FitLimits limits = policy.limits("waist_semantic", "top");
  const double limit = limits.too_large_ease;
  EXPECT_EQ(policy.too_large_ease(limits, 0.1, "waist_semantic", "top", ""), limit);
  EXPECT_DOUBLE_EQ(policy.too_large_ease(limits, 0.9, "waist_semantic", "top", ""),
                   1.9 * (1 + 0.5 * limit) - 1);
  policy.own.classes["top"].girths["waist_semantic"].too_large_ease = 0.3;
  EXPECT_EQ(policy.too_large_ease(policy.limits("waist_semantic", "top"), 0.9, "waist_semantic",
                                  "top", ""),
            0.3)
      << "said is said";

  const body::Body body = measured("f-165-a");
  Garment tent = skin_shirt(body, 0.12);
  bind_garment(tent, body);
  const collision::BodyCollider skin(body.skin);
  std::map<std::string, double> stouter = tent.body_girths_m;
  EXPECT_EQ(fit_garment(tent, body, skin, standard_fit_policy()).verdict, FitVerdict::TOO_LARGE);
  EXPECT_TRUE(
      fit_garment(tent, body, skin, standard_fit_policy(), {.made_for = tent.body_girths_m}).fits);
  for (auto& [name, girth] : stouter)
    girth *= 1.6; // cut for a much stouter person
  const FitReport report =
      fit_garment(tent, body, skin, standard_fit_policy(), {.made_for = stouter});
  EXPECT_EQ(report.verdict, FitVerdict::TOO_LARGE) << report.reason;
}

TEST(fit_policy, what_it_does_not_know_is_refused) {
  EXPECT_THROW(read_fit_policy(policy_file(R"("defualt": {})")), Error);
  EXPECT_THROW(read_fit_policy(policy_file(R"("default": {"tight": 1})")), Error);
  EXPECT_THROW(read_fit_policy(policy_file(R"("default": {"tight_ease": 0.5, "loose_ease": 0.1})")),
               Error);
  EXPECT_THROW(read_fit_policy(policy_file(R"("refuse": ["ugly"])")), Error);
  EXPECT_THROW(read_fit_policy(policy_file(R"("classes": {"hat": {}})")), Error);
}

namespace {

/// What a policy is refused with; empty where it is read.
std::string refusal(const std::string& text) {
  try {
    read_fit_policy(policy_file(text));
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_NE(e.file(), "");
    EXPECT_NE(e.next_step(), "");
    return e.id().string() + " " + e.place() + ": " + e.fact() + "; " + e.next_step();
  }
  return {};
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST(fit_policy, a_girth_that_no_report_has_is_refused) {
  const std::string waist = refusal(R"("girths": {"waist": {"loose_ease": 0.1}})");
  EXPECT_TRUE(says(waist, "policy.unknown-girth /girths: \"waist\"")) << waist;
  EXPECT_TRUE(says(waist, "did you mean \"waist_semantic\"?")) << waist;
  EXPECT_TRUE(says(refusal(R"("classes": {"top": {"girths": {"navel": {}}}})"), "omphalion\"?"));
  EXPECT_TRUE(says(refusal(R"("fabrics": {"wool": {"girths": {"sleeve": {}}}})"), "sleeve_hem\"?"));
  EXPECT_TRUE(says(refusal(R"("girths": {"hipp": {}})"), "did you mean \"hip\"?"));
  EXPECT_TRUE(says(refusal(R"("girths": {"bust_l": {}})"), "policy.unknown-girth"));
  EXPECT_EQ(refusal(R"("girths": {"wrist": {}, "wrist_l": {}, "top_edge": {}, "leg_hem_r": {}})"),
            "");
}

TEST(fit_policy, every_girth_that_is_measured_may_be_named) {
  const body::Body body = measured("f-165-a");
  const Dressed d = dressed(body, skin_shirt(body, 0.01));
  std::string rows;
  for (const FitPlace& place : fit_places(body))
    rows += (rows.empty() ? "\"" : ", \"") + place.name + "\": {}";
  for (const FitRow& row : d.report.rows)
    if (row.kind == "edge")
      rows += ", \"" + row.name + "\": {}";
  EXPECT_TRUE(says(rows, "bust") && says(rows, "thigh_l") && says(rows, "_edge")) << rows;
  EXPECT_EQ(refusal("\"girths\": {" + rows + "}"), "");
  for (const auto& [name, rules] : standard_fit_policy().standard.classes)
    for (const auto& [girth, limits] : rules.girths)
      EXPECT_EQ(refusal("\"girths\": {\"" + girth + "\": {}}"), "") << name;
}

TEST(fit_policy, limits_in_per_cent_are_told) {
  const Garment garment;
  const auto doubts = [&](const std::string& text) {
    return policy_doubts(read_fit_policy(policy_file(text)), garment, "policy.json");
  };
  const std::vector<Message> loose = doubts(R"("default": {"loose_ease": 35})");
  ASSERT_EQ(loose.size(), 1u);
  EXPECT_EQ(loose[0].id, "policy.not-a-share");
  EXPECT_TRUE(says(loose[0].text, "policy.json: /default/loose_ease: 35")) << loose[0].text;
  EXPECT_TRUE(says(loose[0].text, "shares, not per cent: 0.35?")) << loose[0].text;
  EXPECT_EQ(doubts(R"("girths": {"hip": {"too_small_ease": -5}})").size(), 1u);
  EXPECT_EQ(doubts(R"("strain_p99": 5)").size(), 1u);
  EXPECT_EQ(doubts(R"("fabrics": {"x": {"strain_max": 30}})").size(), 1u);
  EXPECT_TRUE(
      doubts(R"("default": {"loose_ease": 3, "too_large_ease": 1e9}, "strain_max": 1000)").empty());
}

TEST(fit_policy, a_fabric_almost_called_like_one_that_there_is_is_told) {
  const body::Body body = measured("f-165-a");
  Garment shirt = skin_shirt(body, 0.01);
  shirt.materials[""].name = "mill-0471";
  const FitPolicy policy = read_fit_policy(policy_file(
      R"("fabrics": {"jersy": {}, "mill-0417": {}, "mill-0471": {}, "denim": {}, "brocade": {}})"));
  const std::vector<Message> doubts = policy_doubts(policy, shirt, "policy.json");
  ASSERT_EQ(doubts.size(), 2u);
  EXPECT_EQ(doubts[0].id, "policy.unknown-fabric");
  EXPECT_TRUE(says(doubts[0].text, "policy.json: /fabrics: \"jersy\"")) << doubts[0].text;
  EXPECT_TRUE(says(doubts[0].text, "did you mean \"jersey\"?")) << doubts[0].text;
  EXPECT_TRUE(says(doubts[1].text, "did you mean \"mill-0471\"?")) << doubts[1].text;
}

} // namespace sloper::garment
