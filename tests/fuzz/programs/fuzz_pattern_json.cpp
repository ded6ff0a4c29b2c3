/// Any bytes as a pattern JSON of each kind, and as edits and as a sidecar of a small pattern: read
/// or refused with an Error, never a crash.
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

#include <cstddef>
#include <cstdint>

namespace {

const char* TUBE =
    R"({"format": "pattern", "version": 1, "length_unit": "cm", "panels": [{"name": "p", "outline": [
  {"edge": "a", "path": [["M", 0, 0], ["L", 40, 0]]}, {"edge": "b", "path": [["Q", 45, 30, 40, 60]]}, {"edge": "c", "path": [["L", 0, 60]]},
  {"edge": "d", "path": [["L", 0, 0]]}]}], "seams": [{"name": "s", "a": [{"panel": "p", "edge": "b"}], "b": [{"panel": "p", "edge": "d"}]}]})";

template<class Read> void attempt(Read read) {
  try {
    sloper::pattern::Pattern pattern = read();
    sloper::pattern::finish_pattern(pattern, "fuzz");
    sloper::pattern::check_pattern(pattern);
  } catch (const sloper::Error&) {}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sloper;
  io::Json json;
  try {
    json = io::parse_json(std::string(reinterpret_cast<const char*>(data), size), "fuzz.json");
  } catch (const Error&) {
    return 0;
  }
  attempt([&] { return pattern::read_pattern_json(json, "fuzz.json"); });
  attempt([&] { return pattern::read_garmentcode(json, "fuzz.json"); });
  attempt([&] { return pattern::read_sewing_spec(json, "fuzz.json"); });
  attempt([&] {
    pattern::Pattern pattern = pattern::read_pattern_json(io::parse_json(TUBE, "tube"), "tube");
    pattern::read_sewing_seams(pattern, json, "fuzz.json");
    return pattern;
  });
  attempt([&] {
    pattern::Pattern pattern = pattern::read_pattern_json(io::parse_json(TUBE, "tube"), "tube");
    pattern::apply_edits(pattern, json, "fuzz.json");
    return pattern;
  });
  return 0;
}
