/// What a population says: of bodies alike alone, and no more than it has seen.
#include <body/landmarks/made_up_skin.hpp>
#include <body/landmarks/second_opinion.hpp>
#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/body/landmarks/corrections.hpp>

#include <cmath>

using namespace sloper;
using namespace sloper::body;

namespace {

/// A document over the program's features in which the first one counts alone; two makes, of which
/// the second stands 20 deviations off.
std::string document(const std::string& points) {
  const std::size_t n = shape_feature_names().size();
  auto row = [&](const std::string& first) {
    std::string text = "[" + first;
    for (std::size_t k = 1; k < n; ++k)
      text += ",0";
    return text + "]";
  };
  std::string text = R"({"format": "landmark-corrections", "version": 1, "features": [)";
  for (std::size_t k = 0; k < n; ++k)
    text += std::string(k ? "," : "") + "[\"" + shape_feature_names()[k] + "\", 0, 1]";
  text += R"(], "makes": [{"name": "a", "limit": 1, "mean": )" + row("0") +
          R"(}, {"name": "b", "limit": 1, "mean": )" + row("20000") +
          R"(}], "basis": [{"sd": 1, "direction": )" + row("1000") +
          R"(}], "outside": 1, "points": {)" + points +
          "}, \"expected\": {\"knee\": {\"sd\": 500, \"y\": [28000, " + row("1000").substr(1) +
          "}, \"axilla_by_shoulders\": {\"sd\": 500, \"y\": [75000, " + row("0").substr(1) + "}}}";
  return text;
}

std::string weights(const std::string& bias, const std::string& first) {
  std::string text = "[" + bias + "," + first;
  for (std::size_t k = 1; k < shape_feature_names().size(); ++k)
    text += ",0";
  return text + "]";
}

ShapeFeatures shape(double first) {
  ShapeFeatures features;
  for (auto& side : features.side) {
    side.assign(shape_feature_names().size(), 0);
    side[0] = first;
  }
  return features;
}

} // namespace

TEST(Corrections, hold_for_bodies_alike_fade_out_and_are_bounded) {
  const Corrections learned =
      Corrections::parse(document("\"knee\": {\"makes\": [0], \"x\": " + weights("100", "200") +
                                  ", \"y\": " + weights("9000", "0") + "}"),
                         "test");
  EXPECT_NEAR(learned.offset("knee", shape(1), 0).x(), 0.003, 1e-12);
  EXPECT_NEAR(learned.offset("knee", shape(1), 0).y(), 0.03, 1e-12); // no more than that
  EXPECT_NEAR(learned.offset("knee", shape(1.1), 0).y(), 0.015, 1e-9);
  EXPECT_EQ(learned.offset("knee", shape(1.3), 0), Vec3(Vec3::Zero()));
  EXPECT_EQ(learned.offset("knee", shape(6), 0), Vec3(Vec3::Zero()));
  EXPECT_EQ(learned.offset("elbow", shape(0), 0), Vec3(Vec3::Zero()));
  EXPECT_EQ(learned.likeness(shape(0)), 1);
  EXPECT_EQ(Corrections::none().likeness(shape(0)), 0);
}

/// One of 62 fresh bodies in natural stances had the back of its neck 51 mm off by its rule, where
/// the rest of the body was off by 16.
TEST(Corrections, an_expected_height_counts_the_more_the_farther_a_rule_is_from_it) {
  const Corrections::Expected expected{0.84, 0.002};
  EXPECT_EQ(expected.weight(0.84), 0);
  EXPECT_NEAR(expected.weight(0.842), 0.5, 1e-9);
  EXPECT_NEAR(expected.weight(0.838), 0.5, 1e-9);
  EXPECT_GT(expected.weight(0.82), 0.98);
  double last = 0;
  for (double y = 0.84; y < 0.87; y += 0.0005) { // nothing jumps
    const double drawn = y + expected.weight(y) * (expected.height - y);
    EXPECT_LT(std::abs(drawn - expected.height), 0.0011) << y;
    EXPECT_LT(std::abs(expected.weight(y) - last), 0.2) << y;
    last = expected.weight(y);
  }
}

TEST(MadeUpSkin, arm_pits_as_high_as_the_shoulders_let_expect_are_confirmed) {
  const Corrections learned = Corrections::parse(document(""), "test");
  Body body;
  body.scan.stature_m = 2; // a deviation is 1 cm
  body.landmarks["axilla_l"] = {Vec3(0.2, 1.49, 0), 1, "gap_closes", 0.7, 0.004, {}};
  body.landmarks["axilla_r"] = {Vec3(-0.2, 1.46, 0), 1, "gap_closes", 0.7, 0.004, {}};
  EXPECT_EQ(confirmed_pits(body, learned, shape(0)),
            (std::vector<std::string>{"axilla_l", "axilla_front_l", "axilla_back_l"}));
  EXPECT_TRUE(confirmed_pits(body, learned, shape(5)).empty()); // another kind of body
}

TEST(MadeUpSkin, arm_pits_are_low_where_both_together_are) {
  const Corrections learned = Corrections::parse(document(""), "test");
  Body body;
  body.scan.stature_m = 2; // a deviation is 1 cm, and pits are expected at 1.5 m
  auto are_low = [&](double left, double right) {
    body.landmarks["axilla_l"] = {Vec3(0.2, left, 0), 1, "gap_closes", 0.7, 0.004, {}};
    body.landmarks["axilla_r"] = {Vec3(-0.2, right, 0), 1, "gap_closes", 0.7, 0.004, {}};
    return pits_are_low(body, learned, shape(0));
  };
  EXPECT_FALSE(are_low(1.50, 1.495));
  EXPECT_FALSE(are_low(1.51, 1.485)); // one of them alone
  EXPECT_TRUE(are_low(1.49, 1.495));
  body.landmarks.erase("axilla_r");
  EXPECT_FALSE(pits_are_low(body, learned, shape(0)));
}

TEST(Corrections, of_another_make_say_nothing) {
  const Corrections learned = Corrections::parse(
      document("\"knee\": {\"makes\": [1], \"x\": " + weights("100", "0") + "}"), "test");
  EXPECT_EQ(learned.offset("knee", shape(0), 0), Vec3(Vec3::Zero()));
}

/// A mannequin is within the limit of MakeHuman's bodies and nearer to other mannequins: what only
/// the former teach, such as where a crotch lies, is nothing to it.
TEST(Corrections, what_one_make_teaches_holds_for_bodies_that_are_nearest_to_it) {
  std::string text = document("");
  text.replace(text.find("\"sd\": 500"), 9, "\"sd\": 500, \"makes\": [0]");
  text.replace(text.find("\"points\""), 0, "\"crotch_at_an_end\": [1], ");
  const std::string far = "20000", near = "500"; // 1e-3 deviations
  text.replace(text.find(far), far.size(), near);
  const Corrections learned = Corrections::parse(text, "test");
  EXPECT_EQ(learned.membership("knee", shape(0)), 1); // of a, b is at 0.5
  EXPECT_EQ(learned.membership("knee", shape(0.6)), 0);
  EXPECT_NEAR(learned.membership("knee", shape(0.225)), 0.5, 1e-9);
  EXPECT_EQ(learned.membership("elbow", shape(0)), 0);
  EXPECT_EQ(learned.crotch_at_an_end(shape(0)), 0);
  EXPECT_EQ(learned.crotch_at_an_end(shape(0.6)), 1);
  EXPECT_EQ(Corrections::parse(document(""), "test").crotch_at_an_end(shape(0)), 0);
  text.replace(text.find("\"crotch_at_an_end\": [1]"), 23, "\"crotch_at_an_end\": [2]");
  EXPECT_THROW(Corrections::parse(text, "test"), Error);
}

TEST(Corrections, a_document_that_does_not_say_which_bodies_are_alike_is_refused) {
  std::string text = document("\"knee\": {\"x\": " + weights("100", "0") + "}");
  const std::size_t from = text.find("\"makes\": [{"), to = text.find("\"outside\"");
  text.erase(from, to - from);
  EXPECT_THROW(Corrections::parse(text, "test"), Error);
}

TEST(SecondOpinion, names_what_the_rest_of_the_body_contradicts) {
  const Corrections learned = Corrections::parse(document(""), "test");
  Body body;
  body.scan.stature_m = 2;
  std::vector<std::string> trail;
  for (const double off : {0.0, 0.02, 0.06}) { // a deviation is 1 cm: 0, 2 and 6 of them
    body.landmarks["knee_l"] = {Vec3(0, 0.57 + off, 0), 2, "leg_ratio", 0.6, 0.01, {}};
    const auto doubts = second_opinions(body, learned, shape(0.5), false, trail);
    EXPECT_EQ(doubts.size(), off > 0.05 ? 1u : 0u) << off;
    EXPECT_LE(body.landmarks["knee_l"].confidence, 0.6);
    EXPECT_GE(body.landmarks["knee_l"].confidence, 0.17);
  }
  EXPECT_EQ(trail.size(), 3u);
  EXPECT_TRUE(
      second_opinions(body, learned, shape(5), false, trail).empty()); // another kind of body
  EXPECT_EQ(trail.size(), 3u);
}

TEST(SecondOpinion, names_more_on_a_skin_that_was_rebuilt) {
  const Corrections learned = Corrections::parse(document(""), "test");
  Body body;
  body.scan.stature_m = 2;
  std::vector<std::string> trail;
  body.landmarks["knee_l"] = {Vec3(0, 0.57 + 0.035, 0), 2, "leg_ratio", 0.6, 0.01, {}};
  EXPECT_EQ(second_opinions(body, learned, shape(0.5), false, trail).size(), 0u);
  EXPECT_EQ(second_opinions(body, learned, shape(0.5), true, trail).size(), 1u);
}

/// The height of a crotch below fused thighs was 54 mm too high, and with it hips and leg tops, of
/// which nothing warned: by what was measured from there the rest of the body let expect it 1.6
/// deviations lower.
TEST(SecondOpinion, names_a_crotch_by_the_rest_of_the_body_that_does_not_agree_with_itself) {
  std::string text = document("");
  text.replace(text.find("\"knee\": {\"sd\""), 6, "\"crotch\"");
  const Corrections learned = Corrections::parse(text, "test");
  Body body;
  body.scan.stature_m = 2;
  std::vector<std::string> trail;
  auto doubts = [&](const char* rule, double off) {
    body.landmarks["crotch"] = {Vec3(0, 0.57 + off, 0), 1, rule, 0.4, 0.013, {}};
    return second_opinions(body, learned, shape(0.5), false, trail).size();
  };
  EXPECT_EQ(doubts("by_rest_of_body", 0.012), 0u); // a deviation is 1 cm
  EXPECT_EQ(doubts("by_rest_of_body", 0.018), 1u);
  EXPECT_EQ(doubts("by_rest_of_body", -0.018), 1u);
  EXPECT_EQ(doubts("leg_sections_merge", 0.018), 0u); // what the skin shows
}
