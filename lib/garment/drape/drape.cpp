#include <garment/levels/drape_levels.hpp>
#include <garment/simulate/session.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/drape/drape.hpp>

namespace sloper::garment {

DrapeReport drape(Garment& garment, const body::Body* body, const DrapeSettings& settings,
                  Reporter& reporter, const DrapeRequest& request) {
  if (settings.levels > 1 && garment.particle_of.empty())
    return drape_through_levels(garment, body, settings, reporter, request);
  return DrapeSession({.garment = garment, .body = body, .request = request}, settings, reporter)
      .run();
}

DrapeReport resume_drape(const DrapeCheckpoint& from, Garment& garment, const body::Body* body,
                         Reporter& reporter, const Checkpoints& checkpoints) {
  if (from.levels)
    return resume_through_levels(from, garment, body, reporter, checkpoints);
  const DrapeRequest request{.checkpoints = checkpoints};
  return DrapeSession({.garment = garment, .body = body, .request = request}, from, reporter).run();
}

DrapeReport resume_drape(const std::string& file, Garment& garment, const body::Body* body,
                         Reporter& reporter, const std::string& next_file) {
  const DrapeCheckpoint from = read_checkpoint(file);
  if (from.motion || from.layers)
    throw input_error("checkpoint.other-run"_id, file, "",
                      from.motion ? "is a checkpoint of a run with --motion"
                                  : "is a checkpoint of a run with --over");
  from.check_body(body, garment.body_sha256);
  return resume_drape(from, garment, body, reporter, Checkpoints{.file = next_file});
}

} // namespace sloper::garment
