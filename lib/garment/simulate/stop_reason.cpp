#include <sloper/garment/simulate/stop_reason.hpp>

namespace sloper::garment {

std::string misfit_text(Misfit misfit) {
  switch (misfit) {
  case Misfit::NONE: return "";
  case Misfit::SLIDES_DOWN: return "slides down";
  case Misfit::STAYS_STRETCHED: return "stays stretched";
  }
  return "";
}

} // namespace sloper::garment
