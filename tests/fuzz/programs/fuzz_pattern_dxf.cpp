/// Any bytes as a DXF and as its grade rule table: read or refused with an Error, never a crash, never without end.
#include <base/error.hpp>
#include <pattern/check_pattern.hpp>
#include <pattern/infer_seams.hpp>
#include <pattern/read_pattern.hpp>

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sloper;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    pattern::parse_grade_rules(text, "fuzz.rul");
  } catch (const Error&) {}
  try {
    pattern::Pattern pattern = pattern::read_dxf(text, "fuzz.dxf");
    pattern::finish_pattern(pattern, "fuzz.dxf");
    pattern::check_pattern(pattern);
    pattern::infer_seams(pattern);
  } catch (const Error&) {}
  return 0;
}
