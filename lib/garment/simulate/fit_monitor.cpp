#include <sloper/base/statistics.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/simulate/fit_monitor.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double DECAY_RATIO = 0.5;         // of the change before: the change at this look
constexpr double NEGLIGIBLE_CHANGE = 0.005; // of the strain: too small to be compared
constexpr int TIGHT_LOOKS_AHEAD = 20;       // extrapolated, of a garment that is tight at a girth
constexpr int LOOSE_LOOKS_AHEAD =
    40; // extrapolated, with ease all around: sleeves slide along an arm, slowly
constexpr double LARGEST_IMBALANCE =
    0.03; // of the tension that goes with the strain of the bounds: the residual force
constexpr int STRAINED_STEPS =
    80; // of a tight garment that never gets calm, without a strain less by STRAIN_FALLS: it stays
constexpr double STRAIN_FALLS = 0.97;

} // namespace

bool FitMonitor::is_calm(const cloth::StepResult& last) const {
  const std::vector<double>& strains = m_state.strains;
  if (strains.size() < 3)
    return false;
  const auto newest = strains.rbegin();
  const double change = std::abs(newest[1] - newest[0]);
  const double before = std::abs(newest[2] - newest[1]);
  return change <= std::max(DECAY_RATIO * before, NEGLIGIBLE_CHANGE * newest[0]) &&
         last.residual_force_ratio <=
             LARGEST_IMBALANCE * m_bounds.strain_p99 * m_cloth.tension_ratio();
}

bool FitMonitor::slides(const std::vector<double>& start_height) {
  const std::vector<Vec3>& x = m_cloth.x();
  std::vector<double> sunk;
  for (std::size_t i = 0; i < x.size(); ++i)
    sunk.push_back(start_height[i] - x[i].y());
  const double slip = upper_median(sunk);
  const bool beyond = slip > m_bounds.slip_m && slip >= m_state.slip;
  m_state.slip = slip;
  return beyond;
}

bool FitMonitor::stays_stretched(const cloth::StepResult& last, int steps) {
  std::vector<Weighted> along;
  for (const TriangleStrain& s : triangle_strains(m_cloth.garment(), m_cloth.x()))
    if (s.area > 0)
      along.push_back({s.thread(), s.area});
  std::vector<double>& strains = m_state.strains;
  strains.push_back(area_quantile(along, 0.99));
  const double strain = strains.back();
  if (strain < STRAIN_FALLS * m_state.least_strain) {
    m_state.least_strain = strain;
    m_state.strain_fell_at = steps;
  }
  if (m_bounds.tight && strain > m_bounds.strain_p99 &&
      steps >= m_state.strain_fell_at + STRAINED_STEPS)
    return true;
  if (!is_calm(last))
    return false;
  const double change = std::abs(strains[strains.size() - 2] - strain);
  return strain - (m_bounds.tight ? TIGHT_LOOKS_AHEAD : LOOSE_LOOKS_AHEAD) * change >
         m_bounds.strain_p99;
}

Misfit FitMonitor::judge(const std::vector<double>& start_height, const cloth::StepResult& last,
                         int steps) {
  if (m_bounds.slip_m > 0 && slides(start_height))
    return Misfit::SLIDES_DOWN;
  if (m_bounds.strain_p99 > 0 && stays_stretched(last, steps))
    return Misfit::STAYS_STRETCHED;
  return Misfit::NONE;
}

} // namespace sloper::garment
