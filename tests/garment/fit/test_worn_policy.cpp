#include <support/skin_garment.hpp>

#include <sloper/base/random.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/fit/worn_policy.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/retarget/nearest_size.hpp>
#include <sloper/io/json.hpp>
#include <support/scratch_folder.hpp>

#include <gtest/gtest.h>

namespace sloper::garment {

namespace {

const body::Body& wearer() {
  static const body::Body body = measured("f-165-a");
  return body;
}

FitReport on_its_own_body(const Garment& garment, const FitPolicy& policy) {
  const collision::BodyCollider skin(wearer().skin);
  return fit_garment(garment, wearer(), skin, policy,
                     {.placed = &garment.position,
                      .made_for = garment.body_girths_m,
                      .source = &garment.position});
}

FitPolicy policy_for(const Garment& garment, const std::string& body_sha256 = "own") {
  FitPolicy policy = standard_fit_policy();
  follow_fabric(garment, policy);
  follow_worn(garment, wearer(), collision::BodyCollider(wearer().skin), body_sha256, policy);
  return policy;
}

Garment of_fabric(Garment garment, const Material& material) {
  garment.materials[""] = material;
  garment.body_sha256 = "own";
  bind_garment(garment, wearer());
  return garment;
}

} // namespace

TEST(worn_policy, a_garment_fits_the_body_on_which_it_came_to_rest_without_a_finding) {
  // Any cut, from skin tight to a tent, of any fabric, stretched as far as is no finding.
  Random random(7);
  for (int k = 0; k < 12; ++k) {
    const std::vector<Material>& presets = material_presets();
    Material fabric = presets[static_cast<std::size_t>(random.uniform() *
                                                       static_cast<double>(presets.size() - 1))];
    if (k % 3 == 0) {
      fabric = material_preset("jersey");
      fabric.stretch_weft_n_m = 40;
      fabric.name = "knit";
    }
    const double gap = k % 2 ? 0.004 : 0.004 + 0.14 * random.uniform();
    Garment g;
    const double bound =
        std::max(0.1, 100 / std::min(fabric.stretch_warp_n_m, fabric.stretch_weft_n_m));
    const double strain = gap > 0.01 ? 0 : 0.95 * bound / (1 + bound) * random.uniform();
    if (k % 4 < 2)
      g = skin_shirt(wearer(), gap, strain);
    else if (k % 4 == 2)
      g = skin_trousers(wearer(), gap, strain);
    else
      g = tube_skirt(wearer(), 0.02 + 0.5 * random.uniform());
    g = of_fabric(std::move(g), fabric);
    const Stretch worn = stretch_of(g);
    if (worn.p99 > worn.bound)
      continue;
    const FitReport report = on_its_own_body(g, policy_for(g));
    EXPECT_TRUE(report.fits) << k << ' ' << fabric.name << " gap " << gap << " strain " << strain
                             << ": " << report.reason;
  }
}

TEST(worn_policy, the_same_cut_of_cloth_that_gives_little_is_refused_elsewhere) {
  const Material knit = [] {
    Material m = material_preset("jersey");
    m.stretch_warp_n_m = 60;
    m.stretch_weft_n_m = 40;
    m.name = "knit";
    return m;
  }();
  const Garment stretched = of_fabric(skin_shirt(wearer(), 0.004, 0.2), knit),
                poplin =
                    of_fabric(skin_shirt(wearer(), 0.004, 0.2), material_preset("cotton-poplin"));
  const auto fits =
      [](const Garment& g) { // as one that comes from another body, and hung loose there
        FitPolicy policy = standard_fit_policy();
        follow_fabric(g, policy);
        const collision::BodyCollider skin(wearer().skin);
        return fit_garment(g, wearer(), skin, policy);
      };
  EXPECT_TRUE(fits(stretched).fits) << fits(stretched).reason;
  const FitReport refused = fits(poplin);
  EXPECT_FALSE(refused.fits);
  EXPECT_EQ(refused.rule.key, "too_small_ease");
  EXPECT_EQ(rule_text(refused.rule, refused.policy), "too_small_ease of policy woven, -3.0 %");
  EXPECT_EQ(fit_json(refused, "test")["rule"]["key"], "too_small_ease");
}

TEST(worn_policy, a_document_goes_before_what_the_fabric_bears) {
  FitPolicy policy = standard_fit_policy();
  policy.own.all.standard.too_small_ease = -0.01;
  policy.own.all.strain_p99 = 0.02;
  const Garment g = of_fabric(skin_shirt(wearer(), 0.004), material_preset("jersey"));
  follow_fabric(g, policy);
  EXPECT_EQ(policy.limits("bust", "top", "jersey").too_small_ease, -0.01);
  EXPECT_EQ(policy.strain_p99("top", "jersey"), 0.02);
  EXPECT_NEAR(standard_fit_policy().limits("bust", "top", "jersey").too_small_ease, -0.03, 1e-12);
}

TEST(worn_policy, woven_presets_keep_the_rules_of_woven_cloth) {
  for (const Material& m : material_presets()) {
    const FitRules rules = elastic_fabric_rules(std::min(m.stretch_warp_n_m, m.stretch_weft_n_m));
    EXPECT_EQ(rules.standard.too_small_ease.has_value(),
              std::min(m.stretch_warp_n_m, m.stretch_weft_n_m) < 1000)
        << m.name;
    if (m.name == "cotton-poplin" || m.name == "denim" || m.name == "wool-suiting") {
      EXPECT_FALSE(rules.strain_p99.has_value()) << m.name;
    }
  }
}

TEST(worn_policy, gathered_cloth_is_as_wide_as_it_lies) {
  // A skirt whose top rows hold four times their length of cloth.
  Garment skirt = tube_skirt(wearer());
  for (std::size_t f = 0; f < skirt.panels.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = skirt.position[skirt.panels.triangles[f][k]],
                 &b = skirt.position[skirt.panels.triangles[f][(k + 1) % 3]];
      const double up = a.y() - b.y(), level = std::hypot(a.x() - b.x(), a.z() - b.z());
      skirt.rest_scale[f][k] *= std::hypot(4 * level, up) / std::hypot(level, up);
    }
  skirt = of_fabric(std::move(skirt), Material());
  const FitReport report = on_its_own_body(skirt, standard_fit_policy());
  int gathered = 0;
  for (const FitRow& row : report.rows) {
    if (row.kind != "level")
      continue;
    gathered += row.gathered;
    EXPECT_LT(row.ease_m, 0.6) << row.name;
    EXPECT_NEAR(row.ease_m, row.lying_m - row.body_m, 1e-9) << row.name;
  }
  EXPECT_GT(gathered, 0);
}

TEST(nearest_size, is_the_one_whose_body_is_most_like_and_says_how_sure) {
  const test::ScratchFolder folder;
  body::Body body;
  body.girths["bust"] = {0.92, 0.004};
  body.levels["hip"].girth_m = 1.0;
  body.levels["hip"].girth_spread_m = 0.004;
  const auto write = [&](const std::string& size, double bust, double hip) {
    io::Json document = io::new_document("garment", 1, "test");
    document["body"] = {{"sha256", ""}, {"girths_m", {{"bust", bust}, {"level:hip", hip}}}};
    io::write_json(folder / ("shirt@" + size + ".json"), document);
  };
  write("S", 0.84, 0.92);
  write("M", 0.92, 1.01);
  write("L", 1.0, 1.08);
  const auto files = sizes_beside(folder / "shirt@L.json");
  ASSERT_EQ(files.size(), 3u);
  const SizeRanking clear = rank_sizes(files, body);
  EXPECT_EQ(io::file_name(clear.sizes[0].file), "shirt@M.json");
  EXPECT_EQ(clear.sizes[0].girths, 2);
  EXPECT_GT(clear.sureness, 0.99);
  body.girths["bust"].value_m = 0.96;
  body.levels["hip"].girth_m = 1.0455; // half way
  const double close = rank_sizes(files, body).sureness;
  EXPECT_GE(close, 0.5);
  EXPECT_LT(close, 0.75);
  EXPECT_THROW(sizes_beside(folder / "shirt.json"), Error);
}

} // namespace sloper::garment
