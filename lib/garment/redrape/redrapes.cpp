#include <sloper/base/parallel.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/redrape/redrapes.hpp>

namespace sloper::garment {

namespace {

/// Says nothing but that the user asked to stop.
class StopOnly : public Reporter {
public:
  explicit StopOnly(Reporter& of) : m_of(of) {}
  bool stop_requested() const override { return m_of.stop_requested(); }

private:
  Reporter& m_of;
};

/// A drape that went on from an earlier one has the report of both.
void add_first(const DrapeReport& first, DrapeReport& report) {
  const MeshLevels levels = first.levels;
  add_earlier(first, report);
  report.levels = levels;
}

/// One drape after another of the same request, each on its own.
class Redraping {
public:
  Redraping(const Garment& start, const body::Body* body, const DrapeSettings& settings,
            const RedrapeRequest& request, Reporter& reporter)
      : m_start(start), m_body(body), m_settings(settings), m_request(request),
        m_reporter(reporter) {}

  /// Start number k, draped.
  DrapeReport run(std::size_t k, Garment& garment) const {
    // A start of loose panels stands in the panel mesh, one of a sewn garment in its particles.
    jitter_start(garment.particle_of.empty() ? garment.panels.placed : garment.position,
                 m_request.jitter, m_request.seed, static_cast<int>(k));
    body::Body own;
    if (m_body)
      own = *m_body;
    if (k > 0)
      own.skin_cache = nullptr; // a cache is for one thread
    StopOnly quiet(m_reporter);
    Reporter& speaks = k == 0 ? m_reporter : quiet;
    DrapeReport report = drape(garment, m_body ? &own : nullptr, m_settings, speaks);
    garment.panels.placed = m_start.panels.placed;
    if (m_body)
      bind_garment(garment, *m_body);
    return report;
  }

private:
  const Garment& m_start;
  const body::Body* m_body;
  const DrapeSettings& m_settings;
  const RedrapeRequest& m_request;
  Reporter& m_reporter;
};

} // namespace

RedrapeSet redrape(const Garment& start, const body::Body* body, const DrapeSettings& settings,
                   const RedrapeRequest& request, Reporter& reporter) {
  const auto n = static_cast<std::size_t>(request.count);
  const Redraping redraping(start, body, settings, request, reporter);
  RedrapeSet set;
  set.garments.assign(n, start);
  set.reports.resize(n);
  std::size_t done = 0;
  if (start.particle_of.empty()) {
    set.reports[0] = redraping.run(0, set.garments[0]);
    done = 1;
    if (set.reports[0].levels.meshes > 1) { // sewn so, unlike starts are drawn together
      set.sewn = set.reports[0];
      set.garments.assign(n, Garment(set.garments[0]));
      done = 0;
    }
  }
  run_alone(n - done, [&](std::size_t k) {
    set.reports[k + done] = redraping.run(k + done, set.garments[k + done]);
  });
  if (set.sewn)
    add_first(*set.sewn, set.reports[0]);
  return set;
}

DrapeReport whole_report(const RedrapeSet& set, std::size_t number) {
  DrapeReport report = set.reports[number];
  if (set.sewn && number > 0)
    add_first(*set.sewn, report);
  return report;
}

io::Json redrape_costs(const RedrapeSet& set) {
  io::Json rows = io::Json::array();
  for (const DrapeReport& r : set.reports)
    rows.push_back({{"converged", r.converged}, {"steps", r.steps}, {"wall_s", r.wall_s}});
  return rows;
}

} // namespace sloper::garment
