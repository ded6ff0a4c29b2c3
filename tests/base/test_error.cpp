#include <sloper/base/error.hpp>
#include <sloper/base/version.hpp>

#include <gtest/gtest.h>

#include <vector>

using namespace sloper;

TEST(Error, says_file_place_fact_and_next_step_in_that_order) {
  const Error e = input_error("test.fact"_id, "pattern.json", "/panels/2",
                              "seam refers to panel \"sleve\"", "name a panel of this pattern");
  EXPECT_STREQ(
      e.what(),
      "pattern.json: /panels/2: seam refers to panel \"sleve\"; name a panel of this pattern");
}

TEST(Error, leaves_out_what_is_empty) {
  EXPECT_STREQ(input_error("test.fact"_id, "", "", "is empty").what(), "is empty");
  EXPECT_STREQ(input_error("test.fact"_id, "a.obj", "", "is empty").what(), "a.obj: is empty");
  EXPECT_STREQ(input_error("test.fact"_id, "", "line 3", "is empty", "mend it").what(),
               "line 3: is empty; mend it");
}

TEST(Error, has_the_exit_code_of_its_kind) {
  EXPECT_EQ(Error(ErrorKind::USAGE, "test.fact"_id, "", "", "x").exit_code(), 2);
  EXPECT_EQ(input_error("test.fact"_id, "", "", "x").exit_code(), 3);
  EXPECT_EQ(Error(ErrorKind::FAILED, "test.fact"_id, "", "", "x").exit_code(), 4);
  EXPECT_EQ(Error(ErrorKind::OUTPUT, "test.fact"_id, "", "", "x").exit_code(), 5);
  EXPECT_EQ(Error(ErrorKind::INTERNAL, "test.fact"_id, "", "", "x").exit_code(), 70);
}

TEST(Error, names_the_option_and_the_nearest_word) {
  const Error e = unknown_word("--view", "fromt", {"front", "back"}, "known are front and back");
  EXPECT_EQ(e.exit_code(), 2);
  EXPECT_STREQ(e.what(),
               "--view fromt: is not known (did you mean 'front'?); known are front and back");
}

TEST(DidYouMean, names_the_nearest_of_the_known_words) {
  const std::vector<std::string> words = {"--accuracy", "--body", "--panels"};
  EXPECT_EQ(did_you_mean("--accurcy", words), " (did you mean '--accuracy'?)");
  EXPECT_EQ(did_you_mean("--boddy", words, ""), " (did you mean --body?)");
  EXPECT_EQ(did_you_mean("--panel", words, "\""), " (did you mean \"--panels\"?)");
}

TEST(DidYouMean, is_empty_when_nothing_is_near) {
  EXPECT_EQ(did_you_mean("--turntable", {"--body", "--set"}), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
}

TEST(DidYouMean, takes_the_first_of_two_equally_near) {
  EXPECT_EQ(did_you_mean("cat", {"bat", "rat"}), " (did you mean 'bat'?)");
}

TEST(Version, stamps_a_document_with_tool_and_version) {
  EXPECT_EQ(generator_stamp("drape"), std::string("drape ") + SLOPER_VERSION);
}

TEST(Error, has_a_lasting_id_that_is_no_part_of_its_words) {
  const Error e =
      input_error("pattern.outline-open"_id, "a.json", "/panels/0", "is open", "close it");
  EXPECT_EQ(e.id(), "pattern.outline-open"_id);
  EXPECT_EQ(e.next_step(), "close it");
  EXPECT_STREQ(e.what(), "a.json: /panels/0: is open; close it");
  EXPECT_EQ(unknown_word("--view", "x", {}, "").id(), "option.unknown-word"_id);
}

TEST(MessageId, is_a_topic_and_a_fact_in_small_letters) {
  for (const char* good : {"a.b", "pattern.outline-open", "json.x3", "a.b-c-d"})
    EXPECT_TRUE(is_message_id(good)) << good;
  for (const char* bad : {"", "a", ".", "a.", ".b", "a.b.c", "a.-b", "a.b-", "a.b--c", "A.b", "a.B",
                          "a-b.c", "a1.b", "a. b", "a.b_c"})
    EXPECT_FALSE(is_message_id(bad)) << bad;
}

TEST(Message, keeps_the_id_that_a_document_has) {
  EXPECT_EQ(Message::read("a.b", "words"), Message("a.b"_id, "words"));
  EXPECT_EQ(Message::read("", "words").id, "");
}
