#include <pattern/surfaces/gore_tube.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

constexpr double GODET_GAP = 0.02; // m of half width over which the room beside a godet opens

GoreTube::GoreTube(const GoreRow& ring, const std::vector<Vec3>& skin) : m_ring(ring) {
  const std::size_t n = static_cast<std::size_t>(std::ceil((ring.top - ring.bottom) / STEP)) + 2;
  m_skin.assign(n, empty_ring());
  for (const Vec3& p : skin)
    if (p.y() < ring.top + 0.02 && p.y() > ring.bottom - 0.04)
      include(m_skin[static_cast<std::size_t>(
                  std::clamp((ring.top - p.y()) / STEP, 0.0, static_cast<double>(n) - 1))],
              Vec2(p.x(), p.z()));
  m_skin = joined(filled(m_skin), 2);
  for (std::size_t k = 1; k < n; ++k) // it must not come nearer than skin above that it has to pass
    for (std::size_t d = 0; d < RING_ANGLES; ++d)
      m_skin[k][d] = std::max(m_skin[k][d], m_skin[k - 1][d]);
  m_skin = smooth(m_skin, 2);
  const auto extent = [&](std::size_t quarter) { return m_skin.back()[quarter * RING_ANGLES / 4]; };
  m_center = 0.5 * Vec2(extent(1) - extent(3), extent(0) - extent(2));
}

/// Least room to the right of each gore.
std::vector<double> GoreTube::gaps(double height) const {
  const std::size_t n = m_ring.gores.size();
  std::vector<double> out;
  for (std::size_t k = 0; k < n; ++k) {
    double gap = PANEL_GAP;
    for (const Gore* g : {&m_ring.gores[k], &m_ring.gores[(k + 1) % n]})
      if (g->godet)
        gap = std::min(gap, 0.5 * PANEL_GAP *
                                (1 + std::clamp(g->half_width(height) / GODET_GAP, 0.0, 1.0)));
    out.push_back(gap);
  }
  return out;
}

void GoreTube::trace(Row& row, const Ring& radius, double out, double fold) const {
  constexpr int FINER = 3, FOLDS = 12;
  row.points.clear();
  row.s.clear();
  for (int k = 0; k <= FINER * RING_ANGLES; ++k) {
    const std::size_t a = static_cast<std::size_t>(k / FINER) % RING_ANGLES,
                      b = (a + 1) % RING_ANGLES;
    const double f = static_cast<double>(k % FINER) / FINER,
                 angle = 2 * units::PI * k / (FINER * RING_ANGLES);
    const double r =
        (1 - f) * radius[a] + f * radius[b] + out + fold * (1 - std::cos(FOLDS * angle));
    row.points.push_back(m_center + r * Vec2(std::sin(angle), std::cos(angle)));
    row.s.push_back(k ? row.s.back() +
                            (row.points[k] - row.points[static_cast<std::size_t>(k) - 1]).norm()
                      : 0);
  }
  row.length = row.s.back();
}

/// Where each gore goes on a row: what the curve is longer than the cloth opens the seams between
/// front and back, or those all around.
void GoreTube::spread(Row& row, double height) const {
  const std::size_t n = m_ring.gores.size();
  const std::vector<double> least = gaps(height);
  const auto main_from = [&](std::size_t k, std::size_t step) { // the next that is no godet
    do
      k = (k + step) % n;
    while (m_ring.gores[k].godet);
    return k;
  };
  std::vector<double> share(n, 0);
  double shares = 0, cloth = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Gore &a = m_ring.gores[k], &b = m_ring.gores[(k + 1) % n];
    const Gore &p = a.godet ? m_ring.gores[main_from(k, n - 1)] : a,
               &q = b.godet ? m_ring.gores[main_from(k, 1)] : b;
    if (p.side != q.side || p.side == Side::RING)
      share[k] = a.godet || b.godet ? 0.5 : 1;
    shares += share[k];
    cloth += 2 * a.half_width(height) + least[k];
  }
  if (shares == 0) {
    share.assign(n, 1);
    shares = static_cast<double>(n);
  }
  row.scale = std::min(1.0, row.length / cloth);
  const double open = std::max(row.length - cloth, 0.0) / shares;
  double s = 0;
  Vec2 off = Vec2::Zero(); // of where panels look from where they are
  row.middle.assign(n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Gore& g = m_ring.gores[k];
    const double half = row.scale * g.half_width(height);
    row.middle[k] = s + half;
    s += 2 * half + row.scale * least[k] + open * share[k];
    if (g.godet)
      continue;
    double wanted = g.theta;
    if (g.side == Side::FRONT)
      wanted = 0;
    if (g.side == Side::BACK)
      wanted = units::PI;
    const double is = wanted - 2 * units::PI * row.middle[k] / row.length;
    off += std::max(half, 1e-3) * Vec2(std::cos(is), std::sin(is));
  }
  const double turn = std::atan2(off.y(), off.x()) / (2 * units::PI) * row.length;
  for (double& m : row.middle)
    m += turn;
}

void GoreTube::shape(double gap, double upright_to) {
  constexpr double SLOPE = 0.45, DEEPEST = 0.3,
                   SHALLOW = 0.03; // sine of the angle to the vertical; m; of the row's length
  const std::size_t n = m_skin.size();
  m_rows.assign(n, Row{});
  std::vector<Ring> radius;
  std::vector<double> mean(n), out(n);
  for (std::size_t j = 0; j < n; ++j) {
    Row& row = m_rows[j];
    radius.push_back(radii(m_skin[j], m_center, gap));
    trace(row, radius[j], 0, 0);
    for (std::size_t k = 0; k < m_ring.gores.size(); ++k)
      row.cloth += 2 * m_ring.gores[k].half_width(height(j));
    for (double g : gaps(height(j)))
      row.cloth += g;
    mean[j] = row.length / (2 * units::PI);
    out[j] = std::max(0.0, (row.cloth - row.length) / (2 * units::PI));
  }
  // No steeper than a skirt hangs, seen from either end.
  for (std::size_t j = 1; j < n; ++j)
    out[j] = std::min(out[j], std::max(out[j - 1] + mean[j - 1] + SLOPE * STEP - mean[j], 0.0));
  for (std::size_t j = n - 1; j-- > 0;)
    out[j] = std::min(out[j], std::max(out[j + 1] + mean[j + 1] + SLOPE * STEP - mean[j], 0.0));
  out = averaged(out, 3);
  m_in_folds = false;
  for (std::size_t j = 0; j < n; ++j) {
    Row& row = m_rows[j];
    trace(row, radius[j], out[j], 0);
    if (row.length <
        row.cloth) { // what is little wider makes the row wider: even shallow folds would show
      out[j] += std::min(row.cloth - row.length, SHALLOW * row.cloth) / (2 * units::PI);
      trace(row, radius[j], out[j], 0);
    }
    if (row.length < row.cloth) {
      m_in_folds = true;
      double low = 0, high = DEEPEST;
      for (int halving = 0; halving < 10; ++halving) {
        const double fold = 0.5 * (low + high);
        trace(row, radius[j], out[j], fold);
        (row.length < row.cloth ? low : high) = fold;
      }
      trace(row, radius[j], out[j], high);
    }
    const double grown = j > 0 ? mean[j] + out[j] - mean[j - 1] - out[j - 1] : 0;
    if (j == 0)
      row.y = m_ring.top;
    else if (height(j) >= upright_to)
      row.y = height(j);
    else
      row.y = m_rows[j - 1].y - std::sqrt(std::max(STEP * STEP - grown * grown, 0.3 * STEP * STEP));
    spread(row, height(j));
  }
}

Vec2 GoreTube::on(const Row& row, std::size_t gore, double along, double out) const {
  double s = row.middle[gore] + row.scale * along;
  s -= std::floor(s / row.length) * row.length;
  const std::size_t k = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::upper_bound(row.s.begin(), row.s.end(), s) - row.s.begin()), 1,
      row.s.size() - 1);
  const double span = row.s[k] - row.s[k - 1];
  const Vec2 p = row.points[k - 1] +
                 (span > 0 ? (s - row.s[k - 1]) / span : 0.0) * (row.points[k] - row.points[k - 1]);
  return out != 0 ? Vec2(p + out * (p - m_center).normalized()) : p;
}

Vec3 GoreTube::at(std::size_t gore, const Gore::Place& place, double out) const {
  const double x =
      std::clamp((m_ring.top - place.row) / STEP, 0.0, static_cast<double>(m_rows.size()) - 1.001);
  const std::size_t k = static_cast<std::size_t>(x);
  const double f = x - static_cast<double>(k);
  const Row &a = m_rows[k], &b = m_rows[k + 1];
  const Vec2 p = (1 - f) * on(a, gore, place.along, out) + f * on(b, gore, place.along, out);
  return {p.x(), (1 - f) * a.y + f * b.y, p.y()};
}

double GoreTube::across(std::size_t gore, const Gore::Place& place) const {
  const double x =
      std::clamp((m_ring.top - place.row) / STEP, 0.0, static_cast<double>(m_rows.size()) - 1.001);
  const std::size_t k = static_cast<std::size_t>(x);
  double sum = 0;
  for (std::size_t j : {k, k + 1}) {
    const Row& row = m_rows[j];
    const double from = m_ring.gores[gore].side == Side::BACK ? 0.5 * row.length : 0;
    const double f = j == k ? 1 - (x - static_cast<double>(k)) : x - static_cast<double>(k);
    sum += f * std::remainder(row.middle[gore] + row.scale * place.along - from, row.length);
  }
  return sum;
}

double GoreTube::reach(Side side, double above) const {
  double most = 0;
  for (std::size_t j = 0; j < m_rows.size() && height(j) >= above; ++j)
    for (std::size_t k = 0; k < m_ring.gores.size(); ++k)
      if (const Gore& g = m_ring.gores[k]; g.side == side)
        for (double end : {-1.0, 1.0})
          most = std::max(most, std::abs(across(k, {height(j), end * g.half_width(height(j))})));
  return most;
}

} // namespace sloper::pattern
