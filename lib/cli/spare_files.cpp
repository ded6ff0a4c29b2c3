#include <cli/spare_files.hpp>

#include <CLI/CLI.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json_fwd.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace sloper::cli {

/// Whether an option has a check of that name: "input_file" where it is read, "output_file" or
/// "document_file" where it is written, the latter with a mesh beside it.
static bool has_validator(CLI::Option* option, const std::string& name) {
  try {
    return option->get_validator(name) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

bool is_written(CLI::Option* option) {
  return has_validator(option, "output_file") || has_validator(option, "document_file");
}

/// Whether a file that is read is a document by its name, and so has a mesh beside it. A scan
/// that is called anna.obj has none: anna.obj.obj belongs to an output called anna.obj.json.
static bool names_a_document(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  return ending.empty() || ending == ".json";
}

/// The regular files of an option, each with the mesh that a document has beside it.
template<typename HasMesh>
static std::vector<std::filesystem::path> files_of(CLI::Option* option, const HasMesh& has_mesh) {
  std::vector<std::filesystem::path> files;
  for (const std::string& path : option->results()) {
    std::error_code absent;
    if (path == "-" ||
        (std::filesystem::exists(path, absent) && !std::filesystem::is_regular_file(path, absent)))
      continue;
    files.emplace_back(path);
    if (has_mesh(path))
      files.emplace_back(io::mesh_path_beside(path));
  }
  return files;
}

static std::vector<std::filesystem::path> files_read(CLI::Option* option) {
  if (!has_validator(option, "input_file"))
    return {};
  return files_of(option, names_a_document);
}

static std::vector<std::filesystem::path> files_written(CLI::Option* option) {
  if (!is_written(option))
    return {};
  const bool document = has_validator(option, "document_file");
  return files_of(option, [document](const std::string&) { return document; });
}

void spare_files(CLI::App& app) {
  constexpr std::pair<const char*, const char*> GOES_ON[] = {{"--from", "--output"},
                                                             {"--from", "--checkpoint"},
                                                             {"--over", "--over-output"},
                                                             {"PATTERN", "--write-pattern"}};
  const auto same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code absent;
    return std::filesystem::equivalent(a, b, absent) ||
           std::filesystem::absolute(a, absent).lexically_normal() ==
               std::filesystem::absolute(b, absent).lexically_normal();
  };
  const auto options = app.get_options([](const CLI::Option*) { return true; });
  for (CLI::Option* writing : options)
    for (const std::filesystem::path& written : files_written(writing))
      for (CLI::Option* other : options) {
        const auto goes_on = [&](const auto& names) {
          return other->get_name(other->get_positional()) == names.first &&
                 writing->get_name() == names.second;
        };
        if (std::any_of(std::begin(GOES_ON), std::end(GOES_ON), goes_on))
          continue;
        for (const std::filesystem::path& read : files_read(other))
          if (same(written, read))
            throw Error(
                ErrorKind::USAGE, "file.would-overwrite-input"_id, written, writing->get_name(),
                "would be written over what " + other->get_name() + " reads" +
                    (written.extension() == ".obj" ? " (a mesh goes beside its document)" : ""),
                "name another output");
        if (other == writing)
          continue;
        for (const std::filesystem::path& twice : files_written(other))
          if (same(written, twice))
            throw Error(ErrorKind::USAGE, "file.written-twice"_id, written, writing->get_name(),
                        "would be written by " + other->get_name() + " too", "name two files");
      }
}

} // namespace sloper::cli
