#include <io/files.hpp>
#include <pattern/read_pattern.hpp>

#include <filesystem>

namespace sloper::pattern {

Pattern read_pattern(const std::string& path, const std::string& /*sewing*/) {
  const io::Json json = io::read_json(path);
  Pattern pattern;
  if (json.is_object() && json.contains("pattern")) pattern = read_garmentcode(json, path);
  else throw input_error(path, "", "this is no pattern that is known", "give a pattern JSON, a GarmentCode specification, a sewing-spec JSON or a DXF");
  if (pattern.name.empty()) pattern.name = path == "-" ? "pattern" : std::filesystem::path(path).stem().string();
  return pattern;
}

} // namespace sloper::pattern
