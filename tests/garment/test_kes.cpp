/// Tables of measured fabrics.
#include <support/scratch_folder.hpp>

#include <garment/kes.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/material_json.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// The message with which a table is refused; empty where it is read.
std::string refusal(const std::string& text, const std::string& fabric = {}) {
  const test::ScratchFolder folder;
  io::write_file(folder / "cloth.csv", text);
  try {
    material_from((folder / "cloth.csv") + fabric);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_NE(e.file(), "") << e.what();
    EXPECT_NE(e.place(), "") << e.what();
    EXPECT_NE(e.next_step(), "") << e.what();
    return std::string(e.what()).substr(e.file().size() + 2);
  }
  return {};
}

Material read(const std::string& text) {
  const test::ScratchFolder folder;
  io::write_file(folder / "cloth.csv", text);
  return material_from(folder / "cloth.csv");
}

const std::string LONG = "property,unit,warp,weft\nW,g/m2,121,121\nB,uN.m,9,7\n";

} // namespace

TEST(Kes, one_property_per_row_in_kes_units) {
  const test::ScratchFolder folder;
  io::write_file(
      (folder / "poplin.csv"),
      "property,unit,warp,weft\nW,mg/cm2,12.1,12.1\nB,gf.cm2/cm,0.1,0.06\n2HB,gf.cm/cm,0.05,0.04\n"
      "G,gf/cm.deg,1.2,1.0\nEMT,%,2,8\nLT,,0.8,0.7\nMIU,,0.15,0.17\nT0,mm,0.4,0.4\n");
  const Material m = material_from((folder / "poplin.csv"));
  EXPECT_NEAR(m.density_kg_m2, 0.121, 1e-9);
  EXPECT_NEAR(m.bend_n_m, 0.08 * 9.80665e-5, 1e-12);
  EXPECT_NEAR(m.shear_n_m, 1.1 * 0.980665 * 180 / M_PI, 1e-6);
  EXPECT_NEAR(m.stretch_warp_n_m, 50 / (0.02 * std::pow(50 / 490.3325, 1 / 1.5)), 1e-6);
  EXPECT_NEAR(m.stretch_weft_n_m, 50 / (0.08 * std::pow(50 / 490.3325, 0.7 / 1.3)), 1e-6);
  EXPECT_NEAR(m.friction_self, 0.16, 1e-12);
  EXPECT_NEAR(m.thickness_m, 0.0004, 1e-12);
  EXPECT_EQ(m.source, "measured: poplin.csv");
}

TEST(Kes, one_fabric_per_row_is_picked_by_name) {
  const test::ScratchFolder folder;
  io::write_file(
      (folder / "set.csv"),
      "fabric;W [g/m2];B-1 [uN.m];B-2 [uN.m];G "
      "[N/m];E100-1;E100-2;T0\r\nserge;210;9,5;7,5;35;2,5;5;0,6\r\ntwill;300;20;15;60;2;3;0,8\r\n");
  const Material m = material_from((folder / "set.csv") + "#serge");
  EXPECT_EQ(m.name, "serge");
  EXPECT_NEAR(m.density_kg_m2, 0.21, 1e-12);
  EXPECT_NEAR(m.bend_n_m, 8.5e-6, 1e-15);
  EXPECT_NEAR(m.stretch_warp_n_m, 98.0665 / 0.025, 1e-6);
  EXPECT_THROW(material_from((folder / "set.csv")), Error) << "two fabrics";
  EXPECT_THROW(material_from((folder / "set.csv") + "#tweed"), Error);
}

TEST(Kes, a_name_that_is_not_known_is_named_with_its_line_and_the_known_ones) {
  // It was passed over, and then "the weight (W) is missing".
  for (const auto& [text, place, fact] :
       {std::tuple{"fabric,weight,B-1,B-2\npoplin,12.1,0.09,0.07\n", "line 1",
                   "column \"weight\" is not known"},
        {"# a comment\n\nfabric,W,B1,B-2\npoplin,12.1,0.09,0.07\n", "line 3",
         "column \"B1\" is not known (did you mean 'B'?)"},
        {"fabric,W,B,G1\npoplin,12.1,0.09,0.7\n", "line 1", "column \"G1\" is not known"},
        {"fabric,weight,bending\npoplin,12.1,0.09\n", "line 1",
         "none of its columns is known: fabric, weight, bending"},
        {"property,unit,wrap,weft\nW,g/m2,121,121\nB,uN.m,9,7\n", "line 1",
         "column \"wrap\" is not known"},
        {"property,unit,warp,weft\nW,g/m2,121,121\nbending,uN.m,9,7\n", "line 3",
         "property \"bending\" is not known"},
        {"W,g/m2,121,121\nB,uN.m,9,7\n", "line 1", "stands where a column of names should"}}) {
    const std::string message = refusal(text);
    EXPECT_EQ(message.rfind(place, 0), 0u) << message;
    EXPECT_NE(message.find(fact), std::string::npos) << message;
    const bool columns = message.find("unit, warp, weft") != std::string::npos;
    EXPECT_TRUE(columns || message.find("W, B") != std::string::npos ||
                message.find("property,unit,warp,weft") != std::string::npos)
        << message;
  }
}

TEST(Kes, what_is_wrong_is_named_with_its_line) {
  for (const auto& [text, place, fact] :
       {std::tuple{std::string(), "line 1", "no values in the file"},
        {"property,unit,warp,weft\n", "line 1", "nothing was measured below the header"},
        {"fabric,W,B\n", "line 1", "nothing was measured below the header"},
        {"property,unit,warp,weft\nW,mg/cm2,12,12\n", "lines 1 to 2",
         "the bending rigidity (B) or length (C, L) is missing"},
        {"fabric,W,B\npoplin,,0.09\n", "lines 1 to 2", "the weight (W) is missing"},
        {"property,unit,warp,weft\nW,stone,12,12\n", "line 2", "unit \"stone\" of W"},
        {"fabric,W [stone],B\npoplin,12,0.09\n", "line 1, column \"W [stone]\"", "is not known"},
        {"property,unit,warp,weft\nW,mg/cm2,12,12\nB,gf.cm2/cm,much,1\n", "line 3, column \"warp\"",
         "\"much\" is not a number"},
        {"fabric,W,B\npoplin,12.1,stiff\n", "line 2, column \"B\"", "\"stiff\" is not a number"},
        {LONG + "MIU,,nan,0.2\n", "line 4, column \"warp\"", "\"nan\" is not a number"},
        {LONG + "MIU,,-0.1,0.2\n", "line 4, column \"warp\"", "\"-0.1\" is not a number"},
        {LONG + "B,uN.m,8,6\n", "line 4, property \"B\"", "is there twice"},
        {"property,unit,warp,warp\nW,g/m2,121,121\n", "line 1, column \"warp\"", "is there twice"},
        {"fabric,W,B-1,B-1\npoplin,12.1,0.09,0.07\n", "line 1, column \"B-1\"", "is there twice"},
        {"fabric,W,B\npoplin,12,1,0,09\n", "line 2", "has 5 cells, the header 3"},
        {"property,unit,warp,weft\nW,g/m2,0,0\nB,uN.m,9,7\n", "lines 1 to 3", "is 0"},
        {LONG + "LT,,2,2\n", "lines 1 to 4", "the linearity (LT) is 2 or more"},
        {"property,unit,warp,weft\nW,kg/m2,121,121\nB,uN.m,9,7\n", "line 2, property \"W\"",
         "the weight W is 121000.0 g/m2, which no cloth has"}, // g/m2 were meant
        {"property,unit,warp,weft,bias\nW,g/m2,121,121,\nB,uN.m,9,1,0.1\n", "lines 1 to 3",
         "the bias bends more easily"},
        {"\x01\x02W,B\n1,2\n", "line 1", "is not text"}}) {
    const std::string message = refusal(text);
    EXPECT_EQ(message.rfind(place, 0), 0u) << message << "\n" << text;
    EXPECT_NE(message.find(fact), std::string::npos) << message << "\n" << text;
  }
  EXPECT_NE(refusal("fabric,W,B\na,12,0.1\na,13,0.2\n", "#a").find("twice"), std::string::npos);
  EXPECT_NE(refusal(LONG, "#poplin").find("a property per row"), std::string::npos);
}

TEST(Kes, a_number_without_a_unit_that_is_not_in_the_unit_of_kes_is_refused) {
  for (const auto& [text, place, fact] :
       {std::tuple{"fabric,W,B-1,B-2\npoplin,121,0.09,0.07\n", "line 2, column \"W\"",
                   "the weight W is 1210.0 g/m2"},
        {"property,warp,weft\nW,121,121\nB,0.09,0.07\n", "line 2, property \"W\"",
         "the weight W is 1210.0 g/m2"},
        {"fabric,W,B-1,B-2\npoplin,12.1,9,7\n", "line 2, column \"B-1\"",
         "the bending rigidity is 0.000883 N m, a bending length of 90.6 mm"}, // uN m
        {"fabric,W [g/m2],B-1 [uN.m],B-2\npoplin,121,9,7\n", "line 2, column \"B-2\"",
         "the bending rigidity is 0.000686 N m"},
        {"fabric,W [g/m2],L\npoplin,121,4.2\n", "line 2, column \"L\"",
         "a bending length of 2.1 mm"}}) { // cm
    const std::string message = refusal(text);
    EXPECT_EQ(message.rfind(place, 0), 0u) << message << "\n" << text;
    EXPECT_NE(message.find(fact), std::string::npos) << message << "\n" << text;
    EXPECT_NE(message.find("add a unit"), std::string::npos) << message << "\n" << text;
  }
  EXPECT_NE(refusal("fabric,W,B\npoplin,0.121,0.09\n").find("W is 1.2 g/m2, which no cloth has"),
            std::string::npos); // kg/m2
  EXPECT_NE(refusal("fabric,W [g/m2],B [N.m]\npoplin,121,9\n").find("9 N m"), std::string::npos);
}

TEST(Kes, what_few_fabrics_have_is_taken_with_its_unit) {
  const Material heavy = read("fabric,W [mg/cm2],B [gf.cm2/cm]\nfelt,121,9\n");
  EXPECT_NEAR(heavy.density_kg_m2, 1.21, 1e-12);
  EXPECT_NEAR(heavy.bend_n_m, 9 * 9.80665e-5, 1e-12);
  for (const char* usual : {"gauze,1.2,0.002", "jersey,16,0.01", "canvas,35,1.0", "coating,90,0.8"})
    EXPECT_EQ(refusal(std::string("fabric,W,B\n") + usual + "\n"), "") << usual;
}

TEST(Kes, other_measured_values_texts_and_columns_with_a_hash_are_passed_over) {
  const Material plain = read(LONG);
  for (const std::string& text :
       {LONG + "2HB,,0.05,0.04\nRS,%,1,2\nsource,,ours,\n#year,,2024,2024\n",
        std::string("fabric,W [g/m2],B-1 [uN.m],B-2 [uN.m],2HB-1,source,#year\n"
                    "cloth.csv,121,9,7,0.05,ours,2024\n"),
        "\xef\xbb\xbf" + LONG}) {
    const Material m = read(text);
    EXPECT_EQ(material_json(m), material_json(plain)) << text;
  }
}

TEST(Kes, directions_win_over_their_mean_in_any_order) {
  for (const char* columns : {"B,B-1,B-2", "B-1,B-2,B"}) {
    const bool first = columns[1] == ',';
    const Material m = read(std::string("fabric,W,") + columns + "\npoplin,12.1," +
                            (first ? "0.5,0.09,0.07" : "0.09,0.07,0.5") + "\n");
    EXPECT_NEAR(m.bend_n_m, 0.08 * 9.80665e-5, 1e-12) << columns;
  }
}

TEST(Kes, a_scene_that_names_a_bad_table_says_where_both_stand) {
  const test::ScratchFolder folder;
  io::write_file(folder / "cloth.csv", "fabric,weight,B\npoplin,12.1,0.09\n");
  const io::Json json =
      io::parse_json(R"({"materials": {"cotton": "cloth.csv"}})", folder / "scene.json");
  const io::Node root(json, folder / "scene.json");
  try {
    read_material(root.at("materials").at("cotton"));
    FAIL();
  } catch (const Error& e) {
    const std::string message = e.what();
    EXPECT_NE(message.find("scene.json: /materials/cotton: "), std::string::npos) << message;
    EXPECT_NE(message.find("cloth.csv: line 1: column \"weight\""), std::string::npos) << message;
  }
}
