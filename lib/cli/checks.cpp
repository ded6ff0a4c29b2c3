#include <sloper/base/error.hpp>
#include <sloper/base/number_text.hpp>
#include <sloper/cli/options.hpp>

#include <sys/stat.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace sloper::cli {

/// ".obj" of out.OBJ; empty where there is none.
static std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

Check finite_in(double low, double high, const std::string& unit) {
  const std::string tail = unit.empty() ? "" : " " + unit;
  std::string range;
  if (low > -1e300 && high < 1e300)
    range = range_text(low, high) + tail;
  else if (low > -1e300)
    range = "at least " + number_text(low) + tail;
  else if (high < 1e300)
    range = "at most " + number_text(high) + tail;
  else
    range = "any finite number" + (unit.empty() ? "" : " of " + unit);
  auto check = [low, high, range](const std::string& text) -> std::string {
    const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
    const char* end = text.data() + text.size();
    double value = 0;
    const auto [stop, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc() || stop != end || !std::isfinite(value))
      return "'" + text + "' is not a plain finite number (expected " + range + ")";
    if (value < low || value > high)
      return text + " is out of range (expected " + range + ")";
    return {};
  };
  return {"finite_in", range, check};
}

Check input_file() {
  auto check = [](const std::string& path) -> std::string {
    struct stat info {};
    if (path == "-")
      return {};
    if (stat(path.c_str(), &info) != 0)
      throw input_error("file.not-found"_id, path, "", "no such file", "check the path");
    if (S_ISDIR(info.st_mode))
      throw input_error("file.is-folder"_id, path, "", "is a folder, not a file",
                        "name the file inside it");
    return {};
  };
  return {"input_file", "FILE", check};
}

Check output_file() {
  auto check = [](const std::string& path) -> std::string {
    return path.empty() ? "an empty file name" : "";
  };
  return {"output_file", "FILE", check};
}

Check output_file_of(const std::string& ending) {
  auto check = [ending](const std::string& path) -> std::string {
    if (path.empty())
      return "an empty file name";
    if (ending_of(path).empty() || ending_of(path) == ending)
      return "";
    return path + " does not end in " + ending + ", and nothing else is written; name " +
           std::filesystem::path(path).replace_extension(ending).string();
  };
  return {"output_file", "FILE", check};
}

Check document_file() {
  auto check = [](const std::string& path) -> std::string {
    if (path.empty())
      return "an empty file name";
    if (path == "-")
      return "the document has a mesh beside it and cannot go to standard output; name a file";
    for (const char* mesh : {".obj", ".ply", ".glb", ".stl"})
      if (ending_of(path) == mesh)
        return path + " is the name of a mesh; name the document: " +
               std::filesystem::path(path).replace_extension(".json").string() +
               ", the mesh is written beside it";
    return "";
  };
  return {"document_file", "FILE", check};
}

Check document_or_mesh_file() {
  auto check = [](const std::string& path) -> std::string {
    if (path.empty())
      return "an empty file name";
    if (path == "-")
      return "a mesh cannot go to standard output; name a file";
    return "";
  };
  return {"document_file", "FILE", check};
}

Check one_of(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words)
    joined += (joined.empty() ? "" : "|") + word;
  auto check = [words](const std::string& text) -> std::string {
    std::string list;
    for (const std::string& word : words) {
      if (word == text)
        return {};
      list += (list.empty() ? "" : ", ") + word;
    }
    return "'" + text + "' is not one of " + list + did_you_mean(text, words);
  };
  return {"one_of", joined, check};
}

void refuse_together(const Given& one, std::initializer_list<Given> others) {
  if (!one.second)
    return;
  for (const auto& [name, given] : others)
    if (given)
      throw Error(ErrorKind::USAGE, "option.conflict"_id, "", one.first,
                  std::string("cannot be combined with ") + name, "leave one of them out");
}

} // namespace sloper::cli
