#include <support/has.hpp>
#include <support/scratch_folder.hpp>

#include <sloper/io/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace sloper;
using namespace sloper::test;
using io::Json;
using io::Node;

/// The message with which some text is refused; empty when it is taken.
static std::string complaint(const std::string& text) {
  try {
    io::parse_json(text, "a.json");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_EQ(e.file(), "a.json");
    return e.what();
  }
  return {};
}

static std::string complaint(const std::function<void()>& deed, ErrorKind kind = ErrorKind::INPUT) {
  try {
    deed();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind);
    return e.what();
  }
  return {};
}

TEST(Json, names_what_is_no_number_with_line_and_column) {
  EXPECT_TRUE(has(complaint("{\n \"a\": [1, NaN]}"), "line 2, column 11: 'NaN' is not a number"));
  EXPECT_TRUE(has(complaint("[1, nan]"), "line 1, column 5: 'nan'"));
  EXPECT_TRUE(has(complaint("[-Infinity]"), "line 1, column 2: '-Infinity'"));
  EXPECT_TRUE(has(complaint("[1, x]"), "not valid JSON"));
}

TEST(Json, refuses_a_key_that_stands_twice_in_one_object_and_names_it) {
  EXPECT_TRUE(has(complaint(R"({"a": 1, "bcd": 2, "a": 3})"), "\"a\""));
  EXPECT_TRUE(has(complaint(R"({"x": [{"k": 1, "k": 1}]})"), "\"k\""));
  EXPECT_EQ(complaint(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})"), "");
}

TEST(Json, refuses_what_is_not_a_finite_number) {
  for (const char* text : {"[NaN]", "[nan]", "[Infinity]", "[-inf]", "[1e400]", "[-1e999]"})
    EXPECT_NE(complaint(text), "") << text;
  EXPECT_EQ(complaint("[1e308, 1e-400, -0]"), "");
}

TEST(Json, refuses_empty_truncated_binary_and_trailing_text) {
  for (const std::string& text :
       {std::string(), std::string(" \n\t"), std::string("{\"a\": 1"), std::string("{\"a\": [1, 2"),
        std::string("{} {}"), std::string("{}x"), std::string("\x89PNG\r\n\x1a\n\0", 9),
        std::string("{\"a\": \"\xff\"}"), std::string("{'a': 1}"), std::string("{\"a\": 1,}")})
    EXPECT_NE(complaint(text), "") << text;
}

TEST(Json, names_the_line_of_a_syntax_error) {
  EXPECT_TRUE(has(complaint("{\n\"a\": 1,\n\"b\" 2\n}"), "line 3"));
}

TEST(Json, takes_a_very_deep_document_without_a_crash) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  EXPECT_EQ(complaint(deep), "");
  EXPECT_NE(complaint(std::string(200000, '[')), "");
}

TEST(Json, never_writes_a_number_that_is_not_finite) {
  for (const double x : {std::nan(""), std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity()}) {
    const Json document = {{"outer", {{"list", Json::array({1.0, x})}}}};
    const std::string message = complaint([&] { io::to_text(document); }, ErrorKind::INTERNAL);
    EXPECT_TRUE(has(message, "/outer/list/1")) << message;
  }
}

TEST(Json, writes_numbers_that_read_back_to_the_same_bits) {
  const std::vector<double> numbers = {
      0.1, 1.0 / 3, 1e-300, 5e-324, 1.7976931348623157e308, 123456789.125, -2.5e-7, 1e22};
  Json document;
  document["numbers"] = numbers;
  const Json again = io::parse_json(io::to_text(document), "x");
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_EQ(again["numbers"][i].get<double>(), numbers[i]);
}

TEST(Json, writes_the_same_bytes_after_reading_its_own_text) {
  const Json document = {
      {"zebra", 1},
      {"apple", {{"b", 0.5}, {"a", Json::array({Json::array({1, 2}), Json::array()})}}},
      {"text", "q\"\\\n\xc3\xa9"},
      {"none", nullptr},
      {"empty", Json::object()}};
  const std::string text = io::to_text(document);
  EXPECT_EQ(io::to_text(io::parse_json(text, "x")), text);
  EXPECT_LT(text.find("zebra"), text.find("apple")) << "keys keep their order";
  EXPECT_EQ(text.back(), '\n');
}

TEST(Json, writes_no_negative_zero) {
  EXPECT_EQ(io::to_text(Json::array({-0.0, 0.0})), "[0, 0]\n");
}

TEST(Document, of_a_newer_version_is_refused_and_both_versions_are_named) {
  const ScratchFolder folder;
  put(folder / "b.json", R"({"format": "body", "version": 7})");
  const std::string message = complaint([&] { io::read_document(folder / "b.json", "body", 3); });
  EXPECT_TRUE(has(message, "b.json") && has(message, "version 7") && has(message, "version 3"))
      << message;
}

TEST(Document, of_an_older_or_the_same_version_is_read) {
  const ScratchFolder folder;
  for (const char* version : {"1", "2", "3"}) {
    put(folder / "b.json",
        std::string(R"({"format": "body", "later": 1, "version": )") + version + "}");
    EXPECT_EQ(complaint([&] { io::read_document(folder / "b.json", "body", 3); }), "");
  }
}

TEST(Document, without_a_sound_envelope_is_refused) {
  const ScratchFolder folder;
  for (const char* text :
       {"[]", "3", "\"body\"", "{}", R"({"version": 1})", R"({"format": "body"})",
        R"({"format": "panels", "version": 1})", R"({"format": 3, "version": 1})",
        R"({"format": "body", "version": 0})", R"({"format": "body", "version": 1.5})",
        R"({"format": "body", "version": "1"})"}) {
    put(folder / "b.json", text);
    EXPECT_TRUE(has(complaint([&] { io::read_document(folder / "b.json", "body", 3); }), "b.json"))
        << text;
  }
}

TEST(Document, of_another_kind_is_refused_by_both_names) {
  const ScratchFolder folder;
  put(folder / "b.json", R"({"format": "panels", "version": 1})");
  const std::string message = complaint([&] { io::read_document(folder / "b.json", "body", 1); });
  EXPECT_TRUE(has(message, "panels") && has(message, "body")) << message;
}

TEST(Document, starts_with_its_envelope) {
  const Json document = io::new_document("body", 1, "scan-landmarks");
  EXPECT_EQ(document.dump(),
            R"({"format":"body","version":1,"generator":"scan-landmarks )" SLOPER_VERSION
            R"(","length_unit":"m"})");
}

TEST(Node, says_file_and_pointer_of_what_is_wrong) {
  const Json value =
      io::parse_json(R"({"a": [{"b": "x"}], "n": 1.5, "v": [1, 2], "big": 3e9})", "s.json");
  const Node node(value, "s.json");
  EXPECT_EQ(complaint([&] { node.at("a").at(std::size_t{0}).at("b").number(); }),
            "s.json: /a/0/b: expected a number");
  EXPECT_TRUE(has(complaint([&] { node.at("c"); }), "\"c\" is missing; add it"));
  EXPECT_TRUE(has(complaint([&] { node.at("a").at(std::size_t{1}); }), "/a"));
  EXPECT_NE(complaint([&] { node.at("n").integer(); }), "");
  EXPECT_NE(complaint([&] { node.at("big").integer(); }), "");
  EXPECT_NE(complaint([&] { node.at("v").vec3(); }), "");
  EXPECT_NE(complaint([&] { node.at("n").string(); }), "");
  EXPECT_NE(complaint([&] { node.at("n").boolean(); }), "");
  EXPECT_NE(complaint([&] { node.at("n").at("x"); }), "");
  EXPECT_NE(complaint([&] { node.at("n").at(std::size_t{0}); }), "");
  EXPECT_NE(complaint([&] { node.at("v").keys(); }), "");
  EXPECT_EQ(node.at("v").vec2(), Vec2(1, 2));
}

TEST(Node, gives_the_fallback_only_where_the_key_is_absent) {
  const Json value = io::parse_json(R"({"n": 2, "s": "t", "b": true, "wrong": "x"})", "s.json");
  const Node node(value, "s.json");
  EXPECT_EQ(node.number("n", 5), 2);
  EXPECT_EQ(node.number("m", 5), 5);
  EXPECT_EQ(node.integer("m", 7), 7);
  EXPECT_EQ(node.string("s", ""), "t");
  EXPECT_TRUE(node.boolean("b", false));
  EXPECT_NE(complaint([&] { node.number("wrong", 5); }), "");
}

TEST(Node, suggests_the_key_that_was_meant) {
  const Json value = io::parse_json(R"({"efects": 1})", "scene.json");
  const std::string message = complaint([&] {
    Node(value, "scene.json").allow_only({"effects", "materials"});
  });
  EXPECT_TRUE(has(message, "efects") && has(message, "\"effects\"")) << message;
}

TEST(Paths, of_a_mesh_stand_beside_the_document) {
  EXPECT_EQ(io::mesh_path_beside("out/a.body.json"), "out/a.body.obj");
  EXPECT_EQ(io::mesh_path_beside("a"), "a.obj");
  EXPECT_EQ(io::file_name("x/y/z.json"), "z.json");
  EXPECT_EQ(io::path_beside("x/y/z.json", "w.obj"), "x/y/w.obj");
  EXPECT_EQ(io::path_beside("z.json", "w.obj"), "w.obj");
  EXPECT_EQ(io::path_beside("x/z.json", "/w.obj"), "/w.obj");
}

TEST(Json, a_file_that_is_not_beside_its_document_is_told_by_document_place_and_path) {
  const io::Json document = io::parse_json(R"({"mesh": "gone.obj"})", "somewhere/shirt.json");
  try {
    io::file_beside(io::Node(document, "somewhere/shirt.json").at("mesh"));
    FAIL() << "it was found";
  } catch (const Error& e) {
    const std::string text = e.what();
    for (const char* part : {"somewhere/shirt.json", "mesh", "somewhere/gone.obj"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(Findings, have_their_ids_beside_them_and_may_lack_them) {
  const std::vector<Message> findings = {{"dxf.unit-assumed"_id, "inches are assumed"},
                                         {"dxf.slits"_id, "two slits"}};
  Json document;
  io::put_findings(document, findings);
  EXPECT_EQ(document["finding_ids"], Json::array({"dxf.unit-assumed", "dxf.slits"}));
  EXPECT_EQ(io::read_findings({document, "a.json"}), findings);
  document.erase("finding_ids"); // of before
  EXPECT_EQ(io::read_findings({document, "a.json"})[1], Message::read("", "two slits"));
  document["finding_ids"] = Json::array({"dxf.slits"});
  EXPECT_THROW(io::read_findings({document, "a.json"}), Error);
  Json empty;
  io::put_findings(empty, {});
  EXPECT_EQ(empty, Json({{"findings", Json::array()}}));
}
