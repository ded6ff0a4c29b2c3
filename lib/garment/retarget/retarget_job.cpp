#include <sloper/garment/retarget/retarget_job.hpp>

#include <garment/retarget/keep_ease.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/judge_faults.hpp>
#include <sloper/garment/fit/fit.hpp>
#include <sloper/garment/fit/stretch.hpp>
#include <sloper/garment/retarget/drape_retargeted.hpp>

namespace sloper::garment {

namespace {

constexpr int MOST_GRADINGS = 4; // each takes a drape; what they do not fit is refused

/// The state of one retargeting, from the placed garment to the judged one.
class Retargeting {
public:
  Retargeting(const RetargetJob& job, Reporter& reporter) : m_job(job), m_reporter(reporter) {
    m_out.retargeted = retarget(job.source, job.body, job.skin, job.mode, reporter);
    garment().body_sha256 = job.skin_sha256;
    m_out.report.settings = job.settings;
    m_out.report.stop_reason = StopReason::PLACED_ONLY;
  }

  RetargetOutcome run() {
    if (m_job.no_drape) {
      bind_garment(garment(), m_job.body);
      m_out.fit = judge(garment(), m_out.report.misfit);
      m_out.fit.state = "placed";
      return std::move(m_out);
    }
    m_out.fit = fit_before_drape(garment(), m_job.source.position, m_job.body, m_job.policy);
    if (!m_out.fit.fits) {
      m_out.report.stop_reason = StopReason::NOT_DRAPED;
      m_out.report.stop_detail = m_out.fit.reason;
      bind_garment(garment(), m_job.body);
      return std::move(m_out);
    }
    drape_until_it_fits();
    if (const auto place = stretched_place(stretch_of(garment())))
      m_out.stretched_at = *place;
    if (m_job.mode == RetargetMode::KEEP_FIT)
      m_out.changed_ease = changed_ease_text(m_out.fit);
    refuse_what_is_stuck();
    fail_where_at_fault(garment(), m_out.report);
    return std::move(m_out);
  }

private:
  Garment& garment() { return m_out.retargeted.garment; }

  void drape_until_it_fits() {
    const DrapeRequest request{.bounds = early_termination_bounds(m_job.policy, m_out.fit),
                               .start = {.hold_ends = m_out.retargeted.folded}};
    DrapeSettings settings = m_job.settings;
    for (;;) {
      drape_once(settings, request);
      const std::string tight = why_too_tight();
      if (tight.empty() || m_out.retargeted.report.gradings == MOST_GRADINGS)
        return;
      if (settings.max_seconds > 0) {
        settings.max_seconds -= m_out.report.wall_s;
        if (settings.max_seconds <= 0)
          return;
      }
      m_reporter.info("the garment " + tight + ": let out there");
      widen_strained_pieces(m_out.retargeted, m_job.source, m_job.body);
    }
  }

  void drape_once(const DrapeSettings& settings, const DrapeRequest& request) {
    const auto is_worn_well = [&](const Garment& at_rest) {
      Garment worn = at_rest;
      bind_garment(worn, m_job.body);
      return judge(worn, Misfit::NONE).fits;
    };
    m_out.report = drape_retargeted(m_out.retargeted, {m_job.source, m_job.body, m_job.mode},
                                    settings, m_reporter, request, is_worn_well);
    bind_garment(garment(), m_job.body);
    m_out.fit = judge(garment(), m_out.report.misfit);
  }

  /// The fit of a garment that is bound to the body.
  /// @param misfit  of the drape that it comes from
  FitReport judge(const Garment& worn, Misfit misfit) const {
    const bool is_cut_anew = m_job.mode == RetargetMode::KEEP_FIT;
    const Garment& made = is_cut_anew ? m_out.retargeted.garment : m_job.source;
    return fit_garment(worn, m_job.body, m_job.skin, m_job.policy,
                       {.placed = &m_out.retargeted.placed,
                        .unfit = misfit_text(misfit),
                        .made_for = made.body_girths_m,
                        .source = &m_job.source.position,
                        .source_bind = m_job.source.converged ? &m_job.source.bind : nullptr,
                        .source_ease_m = m_out.retargeted.source_ease_m});
  }

  /// What keep-fit can mend by letting the garment out; else empty.
  std::string why_too_tight() {
    if (m_job.mode != RetargetMode::KEEP_FIT)
      return "";
    FitReport in_place = m_out.fit;
    if (m_out.report.stop_reason == StopReason::STEP_LIMIT) {
      // cloth that is too tight seldom comes to rest: it is judged as if it had
      Garment still = garment();
      still.converged = true;
      in_place = judge(still, m_out.report.misfit);
    }
    const bool too_tight = !in_place.fits && in_place.verdict == FitVerdict::TOO_SMALL;
    return too_tight ? in_place.reason : "";
  }

  void refuse_what_is_stuck() {
    if (!m_out.fit.fits || m_out.report.converged)
      return;
    const std::string why = why_stuck(garment(), m_job.body);
    if (why.empty())
      return;
    m_out.fit.fits = false;
    m_out.fit.verdict = FitVerdict::IMPOSSIBLE;
    m_out.fit.reason = why;
    m_out.fit.probability = {0, "", ""};
  }

  const RetargetJob& m_job;
  Reporter& m_reporter;
  RetargetOutcome m_out;
};

} // namespace

RetargetOutcome retarget_and_judge(const RetargetJob& job, Reporter& reporter) {
  return Retargeting(job, reporter).run();
}

} // namespace sloper::garment
