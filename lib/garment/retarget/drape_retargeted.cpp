#include <sloper/garment/retarget/drape_retargeted.hpp>

#include <garment/levels/coarse_start.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/place/place_panels.hpp>

#include <memory>

namespace sloper::garment {

namespace {

constexpr double OFF_OUTLINE = 1e-4; // m: vertices further off are not of this pattern

/// Whether the other start may do better: it does not for cloth that is too small.
bool is_worth_another_start(const DrapeReport& report, RetargetMode mode) {
  switch (report.stop_reason) {
  case StopReason::AT_REST_UNCLEAN:
  case StopReason::STUCK:
  case StopReason::STALLED:
  case StopReason::NOT_FINITE: return true;
  // keep-fit is let out where it is too tight to come to rest
  case StopReason::STEP_LIMIT: return mode == RetargetMode::KEEP_FABRIC;
  default: return false;
  }
}

/// The pattern that the garment's mesh is one of.
std::string find_pattern(const Garment& garment, const Garment& source, RetargetMode mode,
                         pattern::Pattern& found) {
  if (!source.panels.source)
    return "it does not know its pattern";
  if (mode == RetargetMode::KEEP_FIT) {
    found = pattern_of(garment, source);
    return found.findings.empty() ? "" : found.findings.front().text;
  }
  found = *source.panels.source;
  if (pattern::MeshFollower(found, garment.panels).off_outline() > OFF_OUTLINE)
    return "its panels are not those of its pattern";
  return "";
}

/// One drape of two starts.
class TwoStarts {
public:
  TwoStarts(Retargeted& retargeted, const Garment& source, const body::Body& body,
            RetargetMode mode, const DrapeSettings& settings)
      : m_retargeted(retargeted), m_source(source), m_body(body), m_mode(mode),
        m_settings(settings) {}

  DrapeReport run(Reporter& reporter, const DrapeRequest& request) {
    const Garment placed = m_retargeted.garment;
    const bool anew_first = m_retargeted.is_tangled;
    m_retargeted.is_tangled = false;
    if (anew_first)
      if (const std::string why = make_panels(placed); why.empty()) {
        DrapeReport report =
            sew_anew(reporter, request, "the placed garment crosses body or cloth");
        if (!is_worth_another_start(report, m_mode) || is_out_of_time(report))
          return report;
        Garment sewn = std::move(m_retargeted.garment);
        m_retargeted.garment = placed;
        return better(std::move(report), std::move(sewn), drape_placed(reporter, request));
      }
    DrapeReport report = drape_placed(reporter, request);
    if (anew_first || !is_worth_another_start(report, m_mode) || is_out_of_time(report))
      return report;
    Garment hung = std::move(m_retargeted.garment);
    if (const std::string why = make_panels(placed); !why.empty()) {
      m_retargeted.garment = std::move(hung);
      report.repairs.push_back("not sewn anew: " + why);
      return report;
    }
    DrapeReport anew = sew_anew(reporter, request, stop_text(report));
    return better(std::move(report), std::move(hung), std::move(anew));
  }

private:
  DrapeReport drape_placed(Reporter& reporter, const DrapeRequest& request) {
    return drape(m_retargeted.garment, &m_body, settings_left(), reporter, request);
  }

  std::string make_panels(const Garment& placed) {
    return panels_anew(placed, m_source, m_body, m_mode, m_settings, m_retargeted.garment);
  }

  DrapeReport sew_anew(Reporter& reporter, const DrapeRequest& request, const std::string& why) {
    const std::string text = "sewn anew around the body from its panels: " + why;
    reporter.info(text);
    DrapeReport report = drape(m_retargeted.garment, &m_body, settings_left(), reporter,
                               {.bounds = request.bounds, .checkpoints = request.checkpoints});
    report.repairs.insert(report.repairs.begin(), text);
    return report;
  }

  /// The second of two drapes where it came to rest clean, or the first did not either.
  DrapeReport better(DrapeReport first, Garment of_first, DrapeReport second) {
    const bool same_particles =
        m_retargeted.garment.particle_of == weld_classes(m_retargeted.garment.panels);
    if ((second.converged || !first.converged) && same_particles) {
      add_earlier(first, second);
      return second;
    }
    m_retargeted.garment = std::move(of_first);
    add_earlier(second, first);
    return first;
  }

  bool is_out_of_time(const DrapeReport& report) {
    m_used_s += report.wall_s;
    return m_settings.max_seconds > 0 && m_used_s >= m_settings.max_seconds;
  }

  DrapeSettings settings_left() const {
    DrapeSettings left = m_settings;
    if (left.max_seconds > 0)
      left.max_seconds -= m_used_s;
    return left;
  }

  Retargeted& m_retargeted;
  const Garment& m_source;
  const body::Body& m_body;
  RetargetMode m_mode;
  const DrapeSettings& m_settings;
  double m_used_s = 0;
};

} // namespace

std::string panels_anew(const Garment& garment, const Garment& source, const body::Body& body,
                        RetargetMode mode, const DrapeSettings& settings, Garment& panels) {
  if (settings.levels < 2)
    return "it is to be draped on the given mesh alone";
  pattern::Pattern pattern;
  if (const std::string why = find_pattern(garment, source, mode, pattern); !why.empty())
    return why;
  Garment unsewn = garment;
  if (weld_classes(unsewn.panels) != garment.particle_of)
    return "it is not sewn as its panels are";
  unsewn.panels.source = std::make_shared<pattern::Pattern>(pattern);
  try {
    const pattern::PlacementReport placement = pattern::place_panels(pattern, body, unsewn.panels);
    if (!placement.impossible.empty())
      return placement.impossible.front();
    if (placement.is_guess)
      return "the roles of its panels are not known";
  } catch (const Error& e) {
    return e.what(); // the body lacks what a panel needs
  }
  unsewn.particle_of.clear();
  unsewn.position.clear();
  unsewn.bind = {};
  unsewn.converged = false;
  if (std::string why = refusal_of_levels(unsewn, &body, settings); !why.empty())
    return why;
  panels = std::move(unsewn);
  return "";
}

DrapeReport drape_retargeted(Retargeted& retargeted, const Garment& source, const body::Body& body,
                             RetargetMode mode, const DrapeSettings& settings, Reporter& reporter,
                             const DrapeRequest& request) {
  return TwoStarts(retargeted, source, body, mode, settings).run(reporter, request);
}

} // namespace sloper::garment
