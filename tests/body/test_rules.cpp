#include <base/error.hpp>
#include <body/rules.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace sloper;
using namespace sloper::body;

namespace {

std::string write_temporary(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("sloper-rules-" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << text;
  return path.string();
}

} // namespace

TEST(Rules, a_file_replaces_numbers_by_name) {
  const std::string path = write_temporary(R"({"format": "landmark-rules", "version": 1, "numbers": {"neck_back.height": {"value": 0.9}}})");
  const Rules rules = Rules::read(path);
  EXPECT_EQ(rules.number("neck_back.height"), 0.9);
  EXPECT_EQ(rules.number("elbow.of_arm"), Rules::standard().number("elbow.of_arm"));
  std::filesystem::remove(path);
}

TEST(Rules, an_unknown_name_is_refused_with_a_suggestion) {
  const std::string path = write_temporary(R"({"format": "landmark-rules", "version": 1, "numbers": {"neck_back.heigth": 0.9}})");
  try {
    Rules::read(path);
    FAIL() << "was read";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("neck_back.height"), std::string::npos) << e.what();
  }
  std::filesystem::remove(path);
}

TEST(Rules, every_built_in_number_is_finite) {
  const Rules rules = Rules::standard();
  for (const auto& [name, value] : rules.numbers()) EXPECT_TRUE(std::isfinite(value)) << name;
}
