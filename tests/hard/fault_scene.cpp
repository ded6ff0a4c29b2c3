/// Faults on purpose: the runner must tell each apart.
#include "scene_tools.hpp"

#include <csignal>

namespace sloper::hard {

Outcome fault_scene(const Parameters& p, std::uint64_t) {
  const std::string kind = p.text("kind", "none");
  Outcome out;
  out.value["finite"] = kind != "not_finite";
  out.value["strain_p99"] = 0.5;
  if (kind == "crash")
    std::raise(SIGSEGV);
  if (kind == "exception")
    throw std::runtime_error("unforeseen");
  if (kind == "refused")
    throw input_error("hard.bad-scene"_id, "some.json", "/place", "is wrong");
  volatile double x = 1;
  while (kind == "endless")
    x = x * 1.0000001;
  return out;
}

} // namespace sloper::hard
