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

} // namespace

RedrapeSet redrape(const Garment& start, const body::Body* body, const DrapeSettings& settings,
                   const RedrapeRequest& request, Reporter& reporter) {
  const auto n = static_cast<std::size_t>(request.count);
  RedrapeSet set;
  set.garments.assign(n, start);
  set.reports.resize(n);
  run_alone(n, [&](std::size_t k) {
    Garment& garment = set.garments[k];
    // A start of loose panels stands in the panel mesh, one of a sewn garment in its particles.
    jitter_start(garment.particle_of.empty() ? garment.panels.placed : garment.position,
                 request.jitter, request.seed, static_cast<int>(k));
    body::Body own;
    if (body)
      own = *body;
    if (k > 0)
      own.skin_cache = nullptr; // a cache is for one thread
    StopOnly quiet(reporter);
    Reporter& speaks = k == 0 ? reporter : quiet;
    set.reports[k] = drape(garment, body ? &own : nullptr, settings, speaks);
    garment.panels.placed = start.panels.placed;
    if (body)
      bind_garment(garment, *body);
  });
  return set;
}

io::Json redrape_costs(const RedrapeSet& set) {
  io::Json rows = io::Json::array();
  for (const DrapeReport& r : set.reports)
    rows.push_back({{"converged", r.converged}, {"steps", r.steps}, {"wall_s", r.wall_s}});
  return rows;
}

} // namespace sloper::garment
