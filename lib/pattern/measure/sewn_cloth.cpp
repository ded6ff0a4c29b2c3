#include <pattern/measure/sewn_cloth.hpp>
#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/geometry/sparse_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

namespace sloper::pattern {
namespace {

constexpr double HOLD_HEIGHT = 1e-9; // 1: weight of the wanted height beside its slope; enough to
                                     // hold pieces that nothing joins
constexpr double ENDS_UPRIGHT =
    0.8; // rise per length of a free edge at which a level may end: steeper than hems are cut
constexpr double PART_OF_TRUNK =
    0.3; // of the most cloth that is sewn together: what is less is another thing
constexpr double AWAY = std::numeric_limits<double>::quiet_NaN();

/// Least of f(x) + |c - x| over the side from a to b, along which f goes linearly from fa to fb.
double length_across(const Vec2& a, const Vec2& b, const Vec2& c, double fa, double fb) {
  const double best = std::min(fa + (c - a).norm(), fb + (c - b).norm()), length = (b - a).norm();
  if (length < 1e-12 || std::abs(fb - fa) >= length)
    return best;
  // Where the path meets the side at the angle that the slope along it asks for.
  const Vec2 along = (b - a) / length;
  const double slope = (fb - fa) / length, at = (c - a).dot(along),
               off = std::abs(along.x() * (c - a).y() - along.y() * (c - a).x());
  const double from = at - off * slope / std::sqrt(1 - slope * slope);
  if (from <= 0 || from >= length)
    return best;
  return std::min(best, fa + slope * from + std::hypot(at - from, off));
}

} // namespace

SewnCloth::SewnCloth(const PanelMesh& mesh, std::vector<bool> panels)
    : m_mesh(mesh), m_panels(std::move(panels)), m_weld(mesh.pattern.size()) {
  DisjointSets sewn(m_weld.size());
  for (const MeshSeam& s : mesh.seams)
    for (std::size_t k = 0; k < s.a.size(); ++k)
      sewn.unite(s.a[k], s.b[k]);
  for (std::size_t v = 0; v < m_weld.size(); ++v)
    m_weld[v] = sewn.find(static_cast<int>(v));
}

/// visit(panel, corners, welded corners) of every triangle that has three corners left.
template<class F> void SewnCloth::each_triangle(const F& visit) const {
  for (std::size_t p = 0; p < m_mesh.panels.size(); ++p) {
    if (!m_panels[p])
      continue;
    const PanelInfo& info = m_mesh.panels[p];
    for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t) {
      const Triangle& corners = m_mesh.triangles[t];
      const Triangle w = {welded(corners[0]), welded(corners[1]), welded(corners[2])};
      if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0])
        visit(p, corners, w);
    }
  }
}

Field SewnCloth::height(const std::vector<PanelRole>& roles, const Field& wanted,
                        const std::function<double(int)>& weight) const {
  const long n = static_cast<long>(m_weld.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  std::vector<bool> there(m_weld.size(), false);
  each_triangle([&](std::size_t panel, const Triangle& corners, const Triangle& w) {
    const Vec2 up = roles[panel].turn.row(1).transpose();
    std::array<Vec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = m_mesh.pattern[corners[k]];
      there[w[k]] = true;
    }
    const double twice =
        (p[1] - p[0]).x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
    if (std::abs(twice) < 1e-12)
      return;
    std::array<Vec2, 3> slope;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 side = p[(k + 2) % 3] - p[(k + 1) % 3];
      slope[k] = Vec2(-side.y(), side.x()) / twice;
    }
    const double area = 0.5 * std::abs(twice) * (weight ? weight(static_cast<int>(panel)) : 1);
    for (std::size_t i = 0; i < 3; ++i) {
      right(w[i]) += area * slope[i].dot(up);
      for (std::size_t j = 0; j < 3; ++j)
        entries.emplace_back(w[i], w[j], area * slope[i].dot(slope[j]));
    }
  });
  for (long v = 0; v < n; ++v) {
    const double held = there[v] ? HOLD_HEIGHT : 1;
    entries.emplace_back(v, v, held);
    right(v) += held * wanted[v];
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solved = SparseSolver(matrix).solve(right);
  Field field(m_weld.size(), AWAY);
  for (std::size_t v = 0; v < field.size(); ++v)
    if (there[m_weld[v]])
      field[v] = solved(m_weld[v]);
  return field;
}

Field SewnCloth::distance_from(const Field& start) const {
  std::vector<std::vector<std::array<int, 3>>> fan(
      m_weld.size()); // corners of the mesh, by the welded first
  each_triangle([&](std::size_t, const Triangle& c, const Triangle& w) {
    for (std::size_t k = 0; k < 3; ++k)
      fan[w[k]].push_back({c[k], c[(k + 1) % 3], c[(k + 2) % 3]});
  });
  std::vector<double> best(m_weld.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<bool> fixed(m_weld.size(), false);
  const auto at = [&](int v) -> double& { return best[welded(v)]; };
  for (std::size_t v = 0; v < start.size(); ++v)
    if (!std::isnan(start[v]) && start[v] < at(static_cast<int>(v))) {
      at(static_cast<int>(v)) = start[v];
      fixed[m_weld[v]] = true;
      queue.emplace(start[v], m_weld[v]);
    }
  const auto drawn = [&](int v) -> const Vec2& { return m_mesh.pattern[v]; };
  while (!queue.empty()) { // a vertex comes again whenever a shorter path to it is found
    const auto [value, v] = queue.top();
    queue.pop();
    if (value > best[v])
      continue;
    for (const auto& [a, b, c] : fan[v])
      for (const auto& [from, other, to] :
           {std::array<int, 3>{a, c, b}, std::array<int, 3>{a, b, c}}) {
        if (fixed[welded(to)])
          continue;
        double length = at(from) + (drawn(to) - drawn(from)).norm();
        if (std::isfinite(at(other)))
          length = std::min(
              length, length_across(drawn(from), drawn(other), drawn(to), at(from), at(other)));
        if (length < at(to) - 1e-12) {
          at(to) = length;
          queue.emplace(length, welded(to));
        }
      }
  }
  Field field(m_weld.size(), AWAY);
  for (std::size_t v = 0; v < field.size(); ++v)
    if (const double d = best[m_weld[v]]; std::isfinite(d))
      field[v] = d;
  return field;
}

SewnCloth::Ring SewnCloth::around(const Field& field, double level,
                                  const std::function<bool(int)>& panel) const {
  struct Crossed {
    int n = 0, a = 0, b = 0;
  };
  std::map<std::pair<int, int>, Crossed> crossed; // sides of triangles, by welded ends
  Ring ring;
  each_triangle([&](std::size_t p, const Triangle& corners, const Triangle& w) {
    if (panel && !panel(static_cast<int>(p)))
      return;
    std::vector<Vec2> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = static_cast<std::size_t>(corners[k]),
                        j = static_cast<std::size_t>(corners[(k + 1) % 3]);
      if (std::isnan(field[i]) || std::isnan(field[j]) ||
          (field[i] <= level) == (field[j] <= level))
        continue;
      ends.push_back(m_mesh.pattern[i] + (level - field[i]) / (field[j] - field[i]) *
                                             (m_mesh.pattern[j] - m_mesh.pattern[i]));
      Crossed& side = crossed[{std::min(w[k], w[(k + 1) % 3]), std::max(w[k], w[(k + 1) % 3])}];
      ++side.n;
      side.a = corners[k];
      side.b = corners[(k + 1) % 3];
    }
    if (ends.size() == 2)
      ring.length += (ends[1] - ends[0]).norm();
  });
  ring.whole = ring.length > 0;
  for (const auto& [ends, side] : crossed)
    if (side.n == 1) {
      const std::size_t a = static_cast<std::size_t>(side.a), b = static_cast<std::size_t>(side.b);
      ring.whole = ring.whole && std::abs(field[a] - field[b]) >
                                     ENDS_UPRIGHT * (m_mesh.pattern[a] - m_mesh.pattern[b]).norm();
    }
  return ring;
}

std::vector<bool> trunk_cloth(const PanelMesh& mesh, const SeamGraph& graph,
                              const std::vector<PanelRole>& roles) {
  std::vector<double> area(roles.size(), 0);
  std::map<int, double> of_layer;
  for (std::size_t k = 0; k < roles.size(); ++k) {
    if (roles[k].region != Region::TRUNK)
      continue;
    const PanelInfo& info = mesh.panels[k];
    for (int t = info.first_triangle; t < info.first_triangle + info.n_triangles; ++t) {
      std::array<Vec2, 3> p;
      for (std::size_t i = 0; i < 3; ++i)
        p[i] = mesh.pattern[mesh.triangles[t][i]];
      area[k] += 0.5 * std::abs((p[1] - p[0]).x() * (p[2] - p[0]).y() -
                                (p[1] - p[0]).y() * (p[2] - p[0]).x());
    }
    of_layer[info.layer] += area[k];
  }
  std::vector<int> piece(roles.size());
  std::iota(piece.begin(), piece.end(), 0);
  for (std::size_t round = 0; round < piece.size(); ++round)
    for (std::size_t k = 0; k < piece.size(); ++k)
      for (int q : graph.neighbours(static_cast<int>(k)))
        piece[k] = std::min(piece[k], piece[q]);
  std::map<int, double> of_piece;
  for (std::size_t k = 0; k < area.size(); ++k)
    of_piece[piece[k]] += area[k];
  const auto more = [](const auto& a, const auto& b) { return a.second < b.second; };
  std::vector<bool> out(roles.size(), false);
  if (of_layer.empty())
    return out;
  const int layer = std::max_element(of_layer.begin(), of_layer.end(), more)->first;
  const double most = std::max_element(of_piece.begin(), of_piece.end(), more)->second;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = roles[k].region == Region::TRUNK && mesh.panels[k].layer == layer &&
             (mesh.seams.empty() || of_piece[piece[k]] > PART_OF_TRUNK * most);
  return out;
}

} // namespace sloper::pattern
