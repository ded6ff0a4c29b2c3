#include <sloper/garment/retarget/drape_retargeted.hpp>

#include <garment/levels/coarse_start.hpp>
#include <garment/simulate/sleeve_ends.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/retarget/retarget_pattern.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/place/place_panels.hpp>

#include <memory>
#include <utility>

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
std::string find_pattern(const Garment& garment, const RetargetedFrom& from,
                         pattern::Pattern& found) {
  const Garment& source = from.source;
  if (!source.panels.source)
    return "it does not know its pattern";
  if (from.mode == RetargetMode::KEEP_FIT) {
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
  TwoStarts(Retargeted& retargeted, const RetargetedFrom& from, const DrapeSettings& settings,
            Reporter& reporter, const DrapeRequest& request,
            const std::function<bool(const Garment&)>& is_worn_well)
      : m_retargeted(retargeted), m_from(from), m_settings(settings), m_reporter(reporter),
        m_request(request), m_is_worn_well(is_worn_well) {}

  DrapeReport run() {
    const Garment placed = m_retargeted.garment;
    const bool tangled = m_retargeted.is_tangled;
    m_retargeted.is_tangled = false;
    DrapeReport relaxing;
    if (relax(relaxing)) {
      DrapeReport report = drape_relaxed(relaxing);
      const bool enough = is_enough(report, tangled);
      if (report.misfit != Misfit::NONE && !is_out_of_time()) { // relaxing may have led to it
        Garment of_first = std::exchange(m_retargeted.garment, placed);
        return better(std::move(report), std::move(of_first), drape_placed(), false);
      }
      return enough ? report : start_again(placed, std::move(report), true);
    }
    if (tangled && m_retargeted.folded == LimbEnds::NONE && make_panels(placed).empty()) {
      DrapeReport report = sew_anew(placed, "the placed garment crosses body or cloth");
      if (is_enough(report, tangled))
        return report;
      Garment of_first = std::exchange(m_retargeted.garment, placed);
      return better(std::move(report), std::move(of_first), drape_placed(), true);
    }
    DrapeReport report = drape_placed();
    return is_enough(report, tangled) ? report : start_again(placed, std::move(report), false);
  }

private:
  /// @return false where the garment is not relaxed softly, and is as it was placed
  bool relax(DrapeReport& report) {
    Garment& garment = m_retargeted.garment;
    const Garment& source = m_from.source;
    const bool hangs_there = !source.body_sha256.empty() &&
                             source.body_sha256 == garment.body_sha256 &&
                             m_from.mode == RetargetMode::KEEP_FABRIC;
    // ends of sleeves that are held at the wrists would creep over the hands
    if (hangs_there || m_retargeted.folded != LimbEnds::NONE)
      return false;
    const Garment placed = garment;
    if (!relax_where_placed(garment, m_from.body, m_settings, m_reporter, report).empty())
      return false;
    if (ends_pushed_on_hands(garment, placed.position, source.position).empty())
      return true;
    garment = placed;
    return false;
  }

  bool is_enough(const DrapeReport& report, bool tangled) {
    m_used_s = report.wall_s;
    return is_done(report, tangled) || is_out_of_time();
  }

  /// The second start after one from where the garment was placed: sewn anew from its panels; where
  /// that cannot be, as it was placed if the first was relaxed.
  DrapeReport start_again(const Garment& placed, DrapeReport first, bool was_relaxed) {
    Garment of_first = std::move(m_retargeted.garment);
    const std::string why = make_panels(placed);
    if (why.empty()) {
      DrapeReport anew =
          sew_anew(placed, first.converged ? "the placed garment does not fit" : stop_text(first));
      return better(std::move(first), std::move(of_first), std::move(anew), false);
    }
    first.repairs.push_back("not sewn anew: " + why);
    if (!was_relaxed) {
      m_retargeted.garment = std::move(of_first);
      return first;
    }
    m_retargeted.garment = placed;
    return better(std::move(first), std::move(of_first), drape_placed(), false);
  }

  DrapeReport drape_placed() {
    return drape(m_retargeted.garment, &m_from.body, settings_left(), m_reporter, m_request);
  }

  /// @param relaxing  what brought the garment near its rest
  DrapeReport drape_relaxed(const DrapeReport& relaxing) {
    DrapeRequest request = m_request;
    request.carried = true;
    request.start.around_body = true;
    DrapeReport report =
        drape(m_retargeted.garment, &m_from.body, settings_left(), m_reporter, request);
    add_earlier(relaxing, report);
    return report;
  }

  std::string make_panels(const Garment& placed) {
    return panels_anew(placed, m_from, m_settings, m_retargeted.garment);
  }

  /// Where the seams do not all close, the garment is left as it was placed: its particles would be
  /// others than those of its source.
  DrapeReport sew_anew(const Garment& placed, const std::string& why) {
    const std::string text = "sewn anew around the body from its panels: " + why;
    m_reporter.info(text);
    DrapeReport report = drape(m_retargeted.garment, &m_from.body, settings_left(), m_reporter,
                               {.bounds = m_request.bounds, .checkpoints = m_request.checkpoints});
    report.repairs.insert(report.repairs.begin(), text);
    if (m_retargeted.garment.particle_of != placed.particle_of) {
      m_retargeted.garment = placed;
      report.converged = false;
      report.repairs.push_back("not sewn anew: its seams did not close");
    }
    return report;
  }

  bool is_worn_well(const DrapeReport& report) const {
    return report.converged && (!m_is_worn_well || m_is_worn_well(m_retargeted.garment));
  }

  /// Whether the other start can do no better.
  bool is_done(const DrapeReport& report, bool tangled) const {
    const bool by_its_start = tangled && m_from.mode == RetargetMode::KEEP_FABRIC;
    if (by_its_start && (report.converged || report.misfit != Misfit::NONE))
      return is_worn_well(report);
    return !is_worth_another_start(report, m_from.mode);
  }

  /// The better of two drapes, the last of which the garment is of now: the one that is worn well,
  /// else the one at rest, else the one from where the garment was placed.
  DrapeReport better(DrapeReport first, Garment of_first, DrapeReport last, bool last_is_placed) {
    const bool prefer_last = first.converged == last.converged ? last_is_placed : last.converged;
    if (is_worn_well(last) || prefer_last) {
      add_earlier(first, last);
      return last;
    }
    m_retargeted.garment = std::move(of_first);
    add_earlier(last, first);
    return first;
  }

  bool is_out_of_time() const {
    return m_settings.max_seconds > 0 && m_used_s >= m_settings.max_seconds;
  }

  DrapeSettings settings_left() const {
    DrapeSettings left = m_settings;
    if (left.max_seconds > 0)
      left.max_seconds -= m_used_s;
    return left;
  }

  Retargeted& m_retargeted;
  const RetargetedFrom& m_from;
  const DrapeSettings& m_settings;
  Reporter& m_reporter;
  const DrapeRequest& m_request;
  const std::function<bool(const Garment&)>& m_is_worn_well;
  double m_used_s = 0; // of the first drape
};

} // namespace

std::string panels_anew(const Garment& garment, const RetargetedFrom& from,
                        const DrapeSettings& settings, Garment& panels) {
  if (settings.levels < 2)
    return "it is to be draped on the given mesh alone";
  pattern::Pattern pattern;
  if (const std::string why = find_pattern(garment, from, pattern); !why.empty())
    return why;
  Garment unsewn = garment;
  if (weld_classes(unsewn.panels) != garment.particle_of)
    return "it is not sewn as its panels are";
  unsewn.panels.source = std::make_shared<pattern::Pattern>(pattern);
  try {
    const pattern::PlacementReport placement =
        pattern::place_panels(pattern, from.body, unsewn.panels);
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
  if (std::string why = refusal_of_levels(unsewn, &from.body, settings); !why.empty())
    return why;
  panels = std::move(unsewn);
  return "";
}

DrapeReport drape_retargeted(Retargeted& retargeted, const RetargetedFrom& from,
                             const DrapeSettings& settings, Reporter& reporter,
                             const DrapeRequest& request,
                             const std::function<bool(const Garment&)>& is_worn_well) {
  return TwoStarts(retargeted, from, settings, reporter, request, is_worn_well).run();
}

} // namespace sloper::garment
