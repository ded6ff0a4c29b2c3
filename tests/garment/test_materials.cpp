/// Materials in layers, by direction, and as documents.
#include <support/scratch_folder.hpp>

#include <gtest/gtest.h>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/composite.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <cmath>

using namespace sloper;
using namespace sloper::garment;

TEST(Composite, loose_layers_add_and_fused_ones_bend_by_the_parallel_axis) {
  const Material face = material_preset("cotton-poplin"), fusible = material_preset("fusible");
  const Material loose = layered(face, {{fusible, 0, false}}),
                 fused = layered(face, {{fusible, 1, false}});
  EXPECT_NEAR(loose.density_kg_m2, face.density_kg_m2 + fusible.density_kg_m2, 1e-12);
  EXPECT_NEAR(loose.thickness_m, face.thickness_m + fusible.thickness_m, 1e-12);
  EXPECT_NEAR(loose.stretch_warp_n_m, face.stretch_warp_n_m + fusible.stretch_warp_n_m, 1e-9);
  EXPECT_NEAR(loose.bend_n_m, face.bend_n_m + fusible.bend_n_m, 1e-15);
  EXPECT_FALSE(cloth::bends_by_direction(loose));
  // Two sheets of tension E1, E2 at the distance d: E1 E2 / (E1 + E2) d^2 more.
  const double d = 0.5 * (face.thickness_m + fusible.thickness_m), e1 = face.stretch_warp_n_m,
               e2 = fusible.stretch_warp_n_m;
  EXPECT_NEAR(fused.bend_warp_n_m, loose.bend_n_m + e1 * e2 / (e1 + e2) * d * d, 1e-12);
  EXPECT_GT(fused.bend_n_m, 5 * loose.bend_n_m);
  EXPECT_LT(fused.bend_bias_n_m, fused.bend_weft_n_m) << "the bias gives way by shear";
}

TEST(Composite, three_fused_sheets_are_a_plate_of_their_thickness) {
  // Sheets without bending of their own, E over thickness h: the neutral axis is the middle one's,
  // and the outer two bring 2 E h^2.
  Material sheet = material_preset("canvas");
  sheet.bend_n_m = 0;
  const Material stack = layered(sheet, {{sheet, 1, false}, {sheet, 1, true}});
  EXPECT_NEAR(stack.bend_warp_n_m,
              2 * sheet.stretch_warp_n_m * sheet.thickness_m * sheet.thickness_m, 1e-12);
  const Material other = layered(sheet, {{sheet, 1, true}, {sheet, 1, false}});
  EXPECT_NEAR(other.bend_warp_n_m, stack.bend_warp_n_m, 1e-15) << "whichever comes first";
}

TEST(Composite, each_side_rubs_as_the_layer_that_lies_there) {
  Material face = material_preset("cotton-poplin"), shell = material_preset("silk"),
           lining = material_preset("silk");
  face.friction_body = 0.5;
  face.friction_self = 0.4;
  shell.friction_body = 0.25;
  shell.friction_self = 0.2;
  lining.friction_body = 0.15;
  lining.friction_self = 0.1;
  const Material lined = layered(face, {{lining, 0, false}}),
                 covered = layered(face, {{shell, 0, true}}),
                 both = layered(face, {{shell, 0, true}, {lining, 0, false}});
  EXPECT_EQ(lined.friction_body, 0.15);
  EXPECT_EQ(lined.friction_self, 0.4);
  EXPECT_EQ(covered.friction_body, 0.5);
  EXPECT_EQ(covered.friction_self, 0.2) << "the face is not what folds touch";
  EXPECT_EQ(both.friction_body, 0.15);
  EXPECT_EQ(both.friction_self, 0.2);
}

TEST(Composite, nothing_on_it_is_the_face_itself) {
  const Material face = material_preset("denim-orthotropic"), same = layered(face, {});
  EXPECT_EQ(same.name, face.name);
  EXPECT_EQ(same.bend_warp_n_m, face.bend_warp_n_m);
}

TEST(Materials, presets_by_direction_keep_the_mean_of_their_preset) {
  for (const char* name : {"silk", "cotton-poplin", "wool-suiting", "denim", "canvas"}) {
    const Material &plain = material_preset(name),
                   &directed = material_preset(std::string(name) + "-orthotropic");
    EXPECT_FALSE(cloth::bends_by_direction(plain)) << "documents of before bend as they did";
    EXPECT_NEAR(0.5 * (directed.bend_warp_n_m + directed.bend_weft_n_m), plain.bend_n_m, 1e-15);
    EXPECT_GE(directed.bend_bias_n_m,
              cloth::least_bias_rigidity(directed.bend_warp_n_m, directed.bend_weft_n_m));
    EXPECT_EQ(directed.density_kg_m2, plain.density_kg_m2);
    EXPECT_NE(directed.source.find("Feng"), std::string::npos);
  }
}

TEST(Materials, a_document_says_all_that_was_said) {
  const test::ScratchFolder folder;
  Material m = material_preset("wool-suiting-orthotropic");
  m.bend_soft_share = 0.3;
  m.bend_soft_radius_m = 0.004;
  io::Json document = io::new_document("material", 1, "test");
  document.update(material_json(m));
  io::write_json(folder / "wool.json", document);
  const Material read = material_from(folder / "wool.json");
  EXPECT_EQ(read.name, m.name);
  EXPECT_EQ(read.bend_warp_n_m, m.bend_warp_n_m);
  EXPECT_EQ(read.bend_bias_n_m, m.bend_bias_n_m);
  EXPECT_EQ(read.bend_soft_share, 0.3);
  EXPECT_EQ(read.bend_soft_radius_m, 0.004);
  EXPECT_EQ(material_json(material_preset("denim")).contains("bend_warp_n_m"), false);
}

TEST(Materials, what_no_sheet_can_bend_like_is_refused) {
  const test::ScratchFolder folder;
  for (
      const char* text :
      {R"({"format": "material", "version": 1, "bend_warp_n_m": 4e-5, "bend_weft_n_m": 1e-6, "bend_bias_n_m": 1e-6})",
       R"({"format": "material", "version": 1, "bend_soft_share": 1.5})",
       R"({"format": "material", "version": 1, "layers": [{"material": "fusible", "bond": 2}]})",
       R"({"format": "material", "version": 1, "layers": [{"material": "fusible", "side": "under"}]})",
       R"({"format": "material", "version": 1, "bend_warp_n_m": 1e-6})",
       R"({"format": "material", "version": 1, "bend_bias_n_m": 8e-6})",
       R"({"format": "material", "version": 1, "bend_wrap_n_m": 1e-6})"}) {
    io::write_file(folder / "m.json", text);
    try {
      material_from(folder / "m.json");
      FAIL() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::INPUT) << e.what();
    }
  }
}

TEST(Materials, a_refusal_names_the_range_in_plain_numbers_and_a_rigidity_that_is_accepted) {
  const test::ScratchFolder folder;
  const auto write = [&](const std::string& keys) {
    io::write_file(folder / "m.json", R"({"format": "material", "version": 1, )" + keys + "}");
  };
  const auto refusal = [&] {
    try {
      material_from(folder / "m.json");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  write(R"("bend_n_m": -1)");
  EXPECT_NE(refusal().find("give a value from 0 to 1000"), std::string::npos) << refusal();
  EXPECT_EQ(refusal().find(".000"), std::string::npos) << refusal();
  const std::string sides = R"("bend_warp_n_m": 4e-5, "bend_weft_n_m": 1.1e-6, )",
                    before = "(sqrt(warp) - sqrt(weft))^2 / 4 = ";
  write(sides + R"("bend_bias_n_m": 1e-6)");
  const std::string text = refusal();
  const std::size_t begin = text.find(before), end = text.find(" or more");
  ASSERT_TRUE(begin < end && end != std::string::npos) << text;
  const std::string asked = text.substr(begin + before.size(), end - begin - before.size());
  write(sides + R"("bend_bias_n_m": )" + asked);
  EXPECT_EQ(refusal(), "accepted") << asked;
}

TEST(Materials, a_single_rigidity_takes_the_place_of_a_preset_s_directions) {
  const test::ScratchFolder folder;
  io::write_file(
      folder / "m.json",
      R"({"format": "material", "version": 1, "preset": "denim-orthotropic", "bend_n_m": 1e-5})");
  const Material m = material_from(folder / "m.json");
  EXPECT_FALSE(cloth::bends_by_direction(m));
  EXPECT_EQ(m.bend_n_m, 1e-5);
}

TEST(Materials, one_direction_alone_needs_the_other_a_mean_or_a_preset_that_was_named) {
  const test::ScratchFolder folder;
  for (const char* rest :
       {R"("bend_weft_n_m": 4e-6)", R"("bend_n_m": 4e-6)", R"("preset": "denim")"}) {
    io::write_file(folder / "m.json",
                   std::string(R"({"format": "material", "version": 1, "bend_warp_n_m": 9e-6, )") +
                       rest + "}");
    EXPECT_EQ(material_from(folder / "m.json").bend_warp_n_m, 9e-6) << rest;
  }
  io::write_file(folder / "m.json",
                 R"({"format": "material", "version": 1, "bend_warp_n_m": 9e-6})");
  try {
    material_from(folder / "m.json");
    FAIL() << "the weft was taken from a preset that nobody named";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("no bend_weft_n_m"), std::string::npos) << e.what();
  }
}

TEST(Kes, bending_lengths_give_rigidities_by_direction) {
  const test::ScratchFolder folder;
  io::write_file(
      folder / "fast.csv",
      "property,unit,warp,weft,bias\nW,g/m2,210,210,\nC,mm,20,17,18\nEB5,%,3,3,\nT,mm,0.5,0.5,\n");
  const Material m = material_from(folder / "fast.csv");
  const double weight = 0.21 * 9.80665;
  EXPECT_NEAR(m.bend_warp_n_m, weight * std::pow(0.020, 3), 1e-12);
  EXPECT_NEAR(m.bend_weft_n_m, weight * std::pow(0.017, 3), 1e-12);
  EXPECT_NEAR(m.bend_bias_n_m,
              cloth::bias_of_strip(m.bend_warp_n_m, m.bend_weft_n_m, weight * std::pow(0.018, 3)),
              1e-15);
  EXPECT_NEAR(m.shear_n_m, 123.0 / 3, 1e-9);
  io::write_file(folder / "strip.csv", "property,unit,mean\nW,g/m2,120\nL,mm,40\n");
  const Material strip = material_from(folder / "strip.csv");
  EXPECT_NEAR(strip.bend_n_m, 0.12 * 9.80665 * std::pow(0.020, 3), 1e-12);
  EXPECT_FALSE(cloth::bends_by_direction(strip));
  io::write_file(folder / "wide.csv", "fabric,W,B-1,B-2,B-3\nserge,21,0.12,0.08,0.09\n");
  const Material wide = material_from(folder / "wide.csv");
  EXPECT_NEAR(wide.bend_bias_n_m, 0.09 * 9.80665e-5, 1e-12);
}
