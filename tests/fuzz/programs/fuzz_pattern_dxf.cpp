/// Any bytes as a DXF, as its grade rule table, and as both, one after the other: read or refused
/// with an Error, never a crash, never without end.
#include <sloper/base/error.hpp>
#include <sloper/pattern/read/grade_rules.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>
#include <sloper/pattern/seams/infer_seams.hpp>

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sloper;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    pattern::parse_grade_rules(text, "fuzz.rul");
  } catch (const Error&) {}
  try { // with a table of grade rules behind it, in its largest size
    const std::size_t end = text.find("EOF\n");
    if (end != std::string::npos && end + 4 < text.size()) {
      const pattern::GradeRules rules =
          pattern::parse_grade_rules(text.substr(end + 4), "fuzz.rul");
      pattern::Pattern pattern =
          pattern::read_dxf(text.substr(0, end + 4), "fuzz.dxf", {rules.sizes.back(), &rules});
      pattern::finish_pattern(pattern, "fuzz.dxf");
      pattern::check_pattern(pattern);
    }
  } catch (const Error&) {}
  try {
    pattern::Pattern pattern = pattern::read_dxf(text, "fuzz.dxf");
    pattern::finish_pattern(pattern, "fuzz.dxf");
    pattern::check_pattern(pattern);
    pattern::infer_seams(pattern);
  } catch (const Error&) {}
  return 0;
}
