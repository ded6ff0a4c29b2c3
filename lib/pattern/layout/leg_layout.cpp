#include <pattern/layout/leg_layout.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double TOP_ZONE = 0.06;    // m below a panel's top where its waist may slant
constexpr double BOTTOM_ZONE = 0.03; // m above its end where the hem may
constexpr double SLANT = 1.5;        // across per up: what leans more is an end and no side

double middle_height(const PanelMesh& mesh, const PanelRole& role, const PanelSpot& spot,
                     std::size_t panel) {
  const auto b = laid_bounds(mesh, role, spot, static_cast<int>(panel));
  return 0.5 * (b[0].y() + b[1].y());
}

/// Rows between a leg and its cuff go over from the one to the other.
void bridge(std::vector<LegRow>& rows, LegRow::Span LegRow::*span) {
  const auto there = [&](std::size_t k) { return (rows[k].*span).width() > 0; };
  std::size_t last = rows.size();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!there(k))
      continue;
    for (std::size_t j = last + 1; last < rows.size() && j < k; ++j) {
      const double t = static_cast<double>(j - last) / static_cast<double>(k - last);
      const LegRow::Span &a = rows[last].*span, &b = rows[k].*span;
      (rows[j].*span).in = (1 - t) * a.in + t * b.in;
      (rows[j].*span).out = (1 - t) * a.out + t * b.out;
    }
    last = k;
  }
}

/// Where the sides end in a zone, they go on straight up (or down).
void carry_on(std::vector<LegRow>& rows, LegRow::Span LegRow::*span, double step, bool top) {
  const int n = static_cast<int>(rows.size()),
            zone = static_cast<int>(std::lround((top ? TOP_ZONE : BOTTOM_ZONE) / step));
  const auto at = [&](int k) -> LegRow::Span& { return rows[top ? k : n - 1 - k].*span; };
  int first = 0; // first row that is there
  while (first < n && at(first).width() <= 0)
    ++first;
  if (first + zone >= n)
    return;
  for (const bool in : {true, false}) {
    const auto value = [&](int k) -> double& { return in ? at(k).in : at(k).out; };
    bool held = false;
    for (int k = first + zone - 1; k >= 0; --k) {
      const double inwards = (value(k) - value(k + 1)) * (in ? 1 : -1);
      held = held || k < first || inwards > SLANT * step;
      if (held)
        value(k) = value(k + 1);
    }
  }
}

} // namespace

void level_trunk(const PanelMesh& mesh, const SeamGraph& graph, const std::vector<PanelRole>& roles,
                 std::vector<PanelSpot>& spots) {
  const long n = static_cast<long>(roles.size());
  Eigen::MatrixXd normal = 1e-6 * Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  const auto v = [&](std::size_t p, int vertex) { return laid(mesh, roles[p], spots[p], vertex); };
  for (std::size_t p = 0; p < roles.size(); ++p)
    for (int neighbour : graph.neighbours(static_cast<int>(p))) {
      const std::size_t q = static_cast<std::size_t>(neighbour);
      if (mesh.panels[p].layer != mesh.panels[q].layer)
        continue;
      if (q < p || roles[p].region != Region::TRUNK || roles[q].region != Region::TRUNK)
        continue;
      for (const auto& seam : graph.between(static_cast<int>(p), neighbour)) {
        const Vec2 along = (v(p, seam.back()[0]) - v(p, seam.front()[0])).cwiseAbs();
        double mean = 0, least = 1e300, own = 0, other = 0;
        for (const auto& s : seam) {
          const double a = v(p, s[0]).y(), b = v(q, s[1]).y();
          mean += a - b;
          own += a;
          other += b;
        }
        const double count = static_cast<double>(seam.size());
        mean /= count;
        double wanted = 0;
        if (along.x() > along.y()) { // a level seam: the panel that has it at its bottom lies above
          const bool above = own / count - middle_height(mesh, roles[p], spots[p], p) <
                             other / count - middle_height(mesh, roles[q], spots[q], q);
          for (const auto& s : seam)
            least = std::min(least, (above ? 1 : -1) * (v(p, s[0]).y() - v(q, s[1]).y()));
          wanted = (above ? 1 : -1) * (PANEL_GAP - least) + mean;
        }
        const long i = static_cast<long>(p), j = static_cast<long>(q);
        const double off = wanted - mean; // of x_i - x_j
        normal(i, i) += count;
        normal(j, j) += count;
        normal(i, j) -= count;
        normal(j, i) -= count;
        right(i) += count * off;
        right(j) -= count * off;
      }
    }
  const Eigen::VectorXd shift = normal.ldlt().solve(right);
  for (std::size_t p = 0; p < roles.size(); ++p)
    if (roles[p].region == Region::TRUNK)
      spots[p].offset.y() += shift(static_cast<long>(p));
}

std::optional<double> legs_part(const PanelMesh& mesh, const SeamGraph& graph,
                                const std::vector<PanelRole>& roles,
                                const std::vector<PanelSpot>& spots) {
  std::optional<double> low;
  for (std::size_t p = 0; p < roles.size(); ++p)
    for (int q : graph.neighbours(static_cast<int>(p))) {
      const PanelRole& other = roles[q];
      if (!is_leg(roles[p]) || !is_leg(other) || roles[p].part == other.part ||
          roles[p].side != other.side)
        continue;
      for (const auto& seam : graph.between(static_cast<int>(p), q))
        for (const auto& s : seam)
          low = std::min(low.value_or(1e300), laid(mesh, roles[p], spots[p], s[0]).y());
    }
  return low;
}

std::vector<LegRow> leg_rows(const PanelMesh& mesh, const std::vector<PanelRole>& roles,
                             const std::vector<PanelSpot>& spots, const LegGrid& grid) {
  std::vector<LegRow> rows(grid.n_rows);
  const auto row_at = [&](double height) { return (grid.top_m - height) / grid.step_m; };
  for (std::size_t p : grid.panels) {
    const Side side = roles[p].side;
    const double sign = (grid.left ? 1 : -1) * (side == Side::BACK ? -1 : 1);
    auto span = &LegRow::ring;
    if (side == Side::FRONT)
      span = &LegRow::front;
    if (side == Side::BACK)
      span = &LegRow::back;
    const auto& outline = mesh.panels[p].outline;
    const auto take = [&](double row, double t) {
      if (row < -0.5 || row > static_cast<double>(grid.n_rows) - 0.5)
        return;
      LegRow::Span& s = rows[static_cast<std::size_t>(std::lround(row))].*span;
      s.in = std::min(s.in, t);
      s.out = std::max(s.out, t);
    };
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = laid(mesh, roles[p], spots[p], outline[k]),
                 b = laid(mesh, roles[p], spots[p], outline[(k + 1) % outline.size()]);
      const double ra = row_at(a.y()), rb = row_at(b.y());
      for (double row = std::ceil(std::min(ra, rb));
           row <= std::floor(std::max(ra, rb)) && std::abs(ra - rb) > 1e-12; ++row)
        take(row, sign * (a.x() + (row - ra) / (rb - ra) * (b.x() - a.x())));
    }
  }
  for (const auto span : {&LegRow::front, &LegRow::back, &LegRow::ring})
    bridge(rows, span);
  for (const auto span : {&LegRow::front, &LegRow::back, &LegRow::ring}) {
    carry_on(rows, span, grid.step_m, true);
    carry_on(rows, span, grid.step_m, false);
  }
  return rows;
}

} // namespace sloper::pattern
