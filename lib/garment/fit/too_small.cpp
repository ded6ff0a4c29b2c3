#include <sloper/garment/fit/too_small.hpp>

#include <garment/fit/fit_places.hpp>
#include <sloper/base/text.hpp>
#include <sloper/collision/skin_cache.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/files.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double REACHING_TENSION = 100;         // N/m, as Stretch::bound has it
const std::string BY_DIRECTION = "-orthotropic"; // presets with the threads of another one
const std::string INTERFACING = "fusible";       // is glued to cloth, and worn alone by nobody

/// How far a fabric is stretched by the tension, along one of its threads.
double reach_of(const Material& fabric, const std::string& direction) {
  return REACHING_TENSION /
         (direction == "warp" ? fabric.stretch_warp_n_m : fabric.stretch_weft_n_m);
}

/// The stretch that cloth needs to go round the body, of its own length.
double stretch_to_close(const FitRow& row) {
  const double cloth = row.rest_m - row.bridged_m;
  return cloth > 0 ? -row.ease_m / cloth : 0;
}

/// The girth of which cloth lacks most; nullptr where it lacks none.
const FitRow* tightest_girth(const FitReport& fit) {
  const FitRow* tightest = nullptr;
  double most = 0;
  for (const FitRow& row : fit.rows) {
    const bool is_girth = row.kind == "level" || row.kind == "limb";
    if (!is_girth || row.gathered || stretch_to_close(row) <= most)
      continue;
    tightest = &row;
    most = stretch_to_close(row);
  }
  return tightest;
}

const Material& fabric_named(const Garment& garment, const std::string& name) {
  for (const auto& [panel_material, fabric] : garment.materials)
    if (fabric.name == name)
      return fabric;
  return material_of(garment, name);
}

/// The presets that are stretched so far by the tension, or else the one that is stretched most.
std::string fabrics_that_reach(double stretch, const std::string& direction) {
  std::string enough, most;
  double reach = 0;
  for (const Material& preset : material_presets()) {
    if (preset.name.find(BY_DIRECTION) != std::string::npos || preset.name == INTERFACING)
      continue;
    const double own = reach_of(preset, direction);
    const std::string text = preset.name + " (" + whole_percent(own) + ")";
    if (own >= stretch)
      enough += (enough.empty() ? "" : ", ") + text;
    if (own <= reach)
      continue;
    most = text;
    reach = own;
  }
  return enough.empty() ? "no preset reaches so far, --material " + most +
                              " comes nearest; else take a softer knit, or a larger size"
                        : "--material " + enough + " reaches so far; or take a larger size";
}

} // namespace

void judge_too_small(const Garment& garment, const body::Body& body, const DrapeReport& report,
                     const Start& start, std::vector<Message>& findings, Reporter& reporter) {
  if (report.converged || start.body.empty() || garment.particle_of.empty())
    return;
  const Stretch now = stretch_of(garment);
  if (now.p99 <= now.bound)
    return;
  Garment worn = garment;
  bind_garment(worn, body);
  const FitReport fit =
      fit_garment(worn, body, collision::make_collider(body.skin, body.skin_cache.get()),
                  standard_fit_policy());
  const FitRow* row = tightest_girth(fit);
  if (!row)
    return;
  const Material& fabric = fabric_named(garment, fit.fabric);
  const double needed = stretch_to_close(*row), reached = reach_of(fabric, row->strain_direction);
  if (needed <= reached)
    return;
  findings.push_back(
      {"drape.cloth-too-small"_id,
       io::file_name(start.file) + " on " + io::file_name(start.body) +
           ": the cloth does not come to rest, and a hundredth of it is stretched by " +
           whole_percent(now.p99) + " or more; at the " + spoken_girth(row->name) +
           " the body is " + centimetres(-row->ease_m) +
           " wider than the cloth, which closes only stretched by " + whole_percent(needed) +
           ", where " + fabric.name + " reaches " + whole_percent(reached) + " at 100 N/m; " +
           fabrics_that_reach(needed, row->strain_direction)});
  reporter.warning(findings.back());
}

} // namespace sloper::garment
