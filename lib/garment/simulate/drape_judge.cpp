/// Whether a garment that is not yet at rest can still fit: the part of a drape that ends it early.
#include <garment/fit/cloth_strain.hpp>
#include <garment/simulate/drape_run.hpp>

#include <base/units.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sloper::garment {

namespace {

// Cloth that is laid on a body too stretched relaxes along its threads within some tens of steps, each look nearer to where it stays by a factor
// of two or more, and then slides slowly or not at all. What a garment would still lose, if it went on losing as much as at its last look, is taken off
// its strain before it is judged; that it only begins to relax, or is kept from it, shows in forces that are no small part of the tension.
constexpr double CALMING = 0.5;          // of the change before: the change at this look
constexpr double CALM = 0.005;           // of the strain: a change too small to be compared
constexpr int TIGHT_AHEAD = 20;          // looks, of a garment that is tight at a girth
constexpr int LOOSE_AHEAD = 40;          // looks, of one with ease all around: sleeves slide along an arm, slowly
constexpr double LEFT_UNBALANCED = 0.03; // of the tension that goes with the strain of the bounds: the residual force

constexpr int STRAINED_STEPS = 80; // of a tight garment that never gets calm, without a strain that is less by STRAIN_FALLS: it stays
constexpr double STRAIN_FALLS = 0.97;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

/// Force in an edge that is stretched by a strain of one, over the weight of a particle: means of all.
double DrapeRun::tension_ratio() const {
  double pull = 0;
  for (const cloth::EdgeSpring& s : m_cloth->springs) pull += s.stiffness * s.rest_length;
  const double mass = std::accumulate(m_cloth->mass.begin(), m_cloth->mass.end(), 0.0);
  return pull / static_cast<double>(m_cloth->springs.size()) / (mass * units::GRAVITY / m_cloth->n_particles);
}

bool DrapeRun::is_calm() const {
  if (m_strains.size() < 3) return false;
  const auto last = m_strains.rbegin();
  const double change = std::abs(last[1] - last[0]), before = std::abs(last[2] - last[1]);
  return change <= std::max(CALMING * before, CALM * last[0]) && m_at.last.residual_force_ratio <= LEFT_UNBALANCED * m_bounds.strain_p99 * tension_ratio();
}

void DrapeRun::judge_fit() {
  const std::vector<Vec3>& x = m_solver->x();
  if (m_bounds.slip_m > 0) {
    std::vector<double> sunk;
    for (std::size_t i = 0; i < x.size(); ++i) sunk.push_back(m_at.start_height[i] - x[i].y());
    const double slip = median(std::move(sunk));
    if (slip > m_bounds.slip_m && slip >= m_slip) m_report.unfit = "slides down";
    m_slip = slip;
  }
  if (m_bounds.strain_p99 > 0 && m_report.unfit.empty()) {
    std::vector<Weighted> along;
    for (const TriangleStrain& s : triangle_strains(m_garment, x))
      if (s.area > 0) along.push_back({s.thread(), s.area});
    m_strains.push_back(area_quantile(along, 0.99));
    const double strain = m_strains.back();
    if (strain < STRAIN_FALLS * m_least_strain) m_least_strain = strain, m_strain_fell_at = m_report.steps;
    if (m_bounds.tight && strain > m_bounds.strain_p99 && m_report.steps >= m_strain_fell_at + STRAINED_STEPS) {
      m_report.unfit = "stays stretched";
    } else if (is_calm()) {
      const double change = std::abs(m_strains[m_strains.size() - 2] - strain);
      if (strain - (m_bounds.tight ? TIGHT_AHEAD : LOOSE_AHEAD) * change > m_bounds.strain_p99) m_report.unfit = "stays stretched";
    }
  }
  if (m_report.unfit.empty()) return;
  m_stopped = true;
  m_report.stop_reason = "the garment " + m_report.unfit + " too far to fit";
}

} // namespace sloper::garment
