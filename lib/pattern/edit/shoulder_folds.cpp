#include <pattern/edit/edit_tools.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/edit/shoulder_folds.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sloper::pattern {
namespace {

/// A line through a panel, m.
struct FoldLine {
  Vec2 at, along; ///< `along` of unit length
  double side(const Vec2& p) const { return along.x() * (p - at).y() - along.y() * (p - at).x(); }
  double place(const Vec2& p) const { return along.dot(p - at); }
};

constexpr int SEAM_SAMPLES = 9;

std::vector<Vec2> sampled(const Pattern& pattern, const std::vector<Run>& side) {
  const double total = side_length(pattern, side);
  std::vector<Vec2> out;
  for (int k = 0; k < SEAM_SAMPLES; ++k) {
    double left = total * k / (SEAM_SAMPLES - 1);
    for (const Run& run : side) {
      const double here = run_length(pattern, run);
      if (left > here && &run != &side.back()) {
        left -= here;
        continue;
      }
      const ArcLength arc(pattern.panels[run.panel].edge(run.edge).path);
      const double f = here > 0 ? std::min(left / here, 1.0) : 0;
      out.push_back(arc.at((run.from + f * (run.to - run.from)) * arc.length()));
      break;
    }
  }
  return out;
}

bool on_panel(const std::vector<Run>& side, int p) {
  return std::all_of(side.begin(), side.end(), [&](const Run& r) { return r.panel == p; });
}

/// The line about which a seam sews a panel to its own mirror image, walking away from the line: so
/// does a side that goes over the shoulder. Both sides of a tube stay as far apart, those of a dart
/// meet.
struct FoldedSeam {
  FoldLine line; ///< `at`: the middle of the seam's two sides
  double growth; ///< of their distance over the seam's length: 2 at right angles to the fold
};
std::optional<FoldedSeam> folded_seam(const Pattern& pattern, const Seam& seam, int p) {
  constexpr double LEAST_APART = 0.04, OFF_SQUARE = 0.01, OFF_LINE = 0.03; // m
  constexpr double OFF_SHARE = 0.1; // of the distance of both sides
  if (seam.kind == "dart" || !on_panel(seam.a, p) || !on_panel(seam.b, p))
    return std::nullopt;
  const std::vector<Vec2> a = sampled(pattern, seam.a), b = sampled(pattern, seam.b);
  Vec2 across = Vec2::Zero(), middle = Vec2::Zero();
  double least = 1e300, most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    across += a[k] - b[k];
    middle += 0.5 * (a[k] + b[k]) / static_cast<double>(a.size());
    least = std::min(least, (a[k] - b[k]).norm());
    most = std::max(most, (a[k] - b[k]).norm());
  }
  if (!(least > LEAST_APART && across.norm() > LEAST_APART))
    return std::nullopt;
  across.normalize();
  const FoldLine line{middle, Vec2(across.y(), -across.x())};
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Vec2 d = a[k] - b[k];
    if (std::abs(line.along.dot(d)) > OFF_SQUARE + OFF_SHARE * d.norm())
      return std::nullopt;
    if (std::abs(line.side(0.5 * (a[k] + b[k]))) > OFF_LINE)
      return std::nullopt;
  }
  const double length = 0.5 * (side_length(pattern, seam.a) + side_length(pattern, seam.b));
  return FoldedSeam{line, (most - least) / length};
}

/// Whether a second panel is sewn to p on both sides of the line.
bool has_other_half(const Pattern& pattern, int p, const FoldLine& line) {
  constexpr double CLEAR = 0.05; // m off the fold
  for (int q = 0; q < std::ssize(pattern.panels); ++q) {
    bool sides[2] = {false, false};
    for (const Seam& seam : pattern.seams)
      for (const auto* own : {&seam.a, &seam.b}) {
        const auto& other = own == &seam.a ? seam.b : seam.a;
        if (q == p || !on_panel(*own, p) || !on_panel(other, q))
          continue;
        // Along the middle it goes away from the fold; along an armhole it goes over it.
        const std::vector<Vec2> points = sampled(pattern, *own);
        const double from = line.side(points.front()), to = line.side(points.back());
        if (std::abs(to - from) < CLEAR || from * to < -CLEAR * CLEAR)
          continue;
        sides[from + to > 0] = true;
      }
    if (sides[0] && sides[1])
      return true;
  }
  return false;
}

std::optional<FoldLine> fold_of(const Pattern& pattern, int p) {
  constexpr double GOES_AWAY = 1.2, ALONE_GOES_AWAY = 1.5;             // growth
  constexpr double SAME_WAY = 0.99, SAME_LINE = 0.03, FAR_APART = 0.2; // cosine; m
  const Panel& panel = pattern.panels[p];
  for (const InnerLine& line : panel.lines)
    if (line.kind == "fold" && line.name.rfind("shoulder", 0) == 0) {
      const Vec2 from = line.path.front().p[0], to = line.path.back().p[3];
      return FoldLine{from, (to - from).normalized()};
    }
  std::vector<FoldedSeam> folded;
  for (const Seam& seam : pattern.seams)
    if (const auto found = folded_seam(pattern, seam, p); found && found->growth > GOES_AWAY)
      folded.push_back(*found);
  for (std::size_t i = 0; i < folded.size(); ++i)
    for (std::size_t j = i + 1; j < folded.size(); ++j) {
      const FoldLine &a = folded[i].line, &b = folded[j].line;
      if (std::abs(a.along.dot(b.along)) > SAME_WAY && std::abs(a.side(b.at)) < SAME_LINE &&
          std::abs(a.place(b.at)) > FAR_APART)
        return FoldLine{0.5 * (a.at + b.at), (b.at - a.at).normalized()};
    }
  for (const FoldedSeam& f : folded)
    if (f.growth > ALONE_GOES_AWAY && has_other_half(pattern, p, f.line))
      return f.line;
  return std::nullopt;
}

/// All loops of a panel, with corners where the line crosses them.
class CutLoops {
public:
  CutLoops(const Panel& panel, const FoldLine& line) : m_line(line) {
    int first = 0;
    for (const auto& loop : panel.loops) {
      std::vector<Piece> pieces;
      for (const PanelEdge& edge : loop)
        pieces.push_back({edge, {first++, 0, 1}});
      for (std::size_t k = 0; k < pieces.size(); ++k)
        if (const double at = crossing(pieces[k]); at > 0)
          corner_at(pieces, k, at); // what is left, which may cross again, is the next piece
      m_loops.push_back(std::move(pieces));
    }
    for (std::size_t l = 0; l < m_loops.size(); ++l)
      for (std::size_t k = 0; k < m_loops[l].size(); ++k)
        if (side_of(m_loops[l][k]) != side_of(next(l, k)))
          m_hits.push_back({l, k});
    std::sort(m_hits.begin(), m_hits.end(), [&](const auto& a, const auto& b) {
      return m_line.place(end_of(at(a))) < m_line.place(end_of(at(b)));
    });
  }

  /// The half on one side, its cuts named fold_1, fold_2 from `along`'s start on; nothing where it
  /// is not in one piece.
  std::optional<Rebuilt> half(const Panel& like, int side) const {
    if (m_hits.empty() || m_hits.size() % 2)
      return std::nullopt;
    std::vector<std::vector<Piece>> loops;
    std::vector<std::vector<char>> done;
    for (const auto& loop : m_loops)
      done.emplace_back(loop.size(), 0);
    for (std::size_t l = 0; l < m_loops.size(); ++l)
      for (std::size_t k = 0; k < m_loops[l].size(); ++k) {
        if (done[l][k] || side_of(m_loops[l][k]) != side)
          continue;
        loops.emplace_back();
        for (std::pair<std::size_t, std::size_t> i = {l, k}; !done[i.first][i.second];) {
          done[i.first][i.second] = 1;
          loops.back().push_back(at(i));
          const auto following = std::pair(i.first, (i.second + 1) % m_loops[i.first].size());
          if (side_of(at(following)) == side) {
            i = following;
            continue;
          }
          const std::size_t hit =
              static_cast<std::size_t>(std::find(m_hits.begin(), m_hits.end(), i) - m_hits.begin());
          const auto partner = m_hits[hit ^ 1];
          loops.back().push_back(
              straight("fold_" + std::to_string(hit / 2 + 1), end_of(at(i)), end_of(at(partner))));
          i = {partner.first, (partner.second + 1) % m_loops[partner.first].size()};
        }
      }
    Rebuilt out;
    out.panel = like;
    out.panel.loops.clear();
    out.panel.notches.clear();
    int outer = 0;
    const auto area = [](const std::vector<Piece>& loop) {
      std::vector<Path> paths;
      for (const Piece& piece : loop)
        paths.push_back(piece.edge.path);
      return signed_area(paths);
    };
    std::stable_sort(loops.begin(), loops.end(),
                     [&](const auto& a, const auto& b) { return area(a) > area(b); });
    for (const auto& loop : loops) {
      outer += area(loop) > 0;
      std::vector<PanelEdge> edges;
      for (const Piece& piece : loop) {
        edges.push_back(piece.edge);
        if (out.panel.find_edge(piece.edge.name) >= 0)
          edges.back().name = free_edge_name(out.panel, piece.edge.name + "_");
        out.origin.push_back(piece.origin);
      }
      out.panel.loops.push_back(std::move(edges));
    }
    if (outer != 1)
      return std::nullopt;
    return out;
  }
  int n_cuts() const { return static_cast<int>(m_hits.size() / 2); }

private:
  using Place = std::pair<std::size_t, std::size_t>;
  const Piece& at(const Place& i) const { return m_loops[i.first][i.second]; }
  const Piece& next(std::size_t l, std::size_t k) const {
    return m_loops[l][(k + 1) % m_loops[l].size()];
  }
  /// 1 to the left of the line.
  int side_of(const Piece& piece) const {
    double most = 0;
    const ArcLength arc(piece.edge.path);
    for (int k = 0; k <= SEAM_SAMPLES; ++k) {
      const double side = m_line.side(arc.at(arc.length() * k / SEAM_SAMPLES));
      if (std::abs(side) > std::abs(most))
        most = side;
    }
    return most > 0;
  }
  /// The first place, as a fraction of its length, where a piece crosses the line; 0 for none.
  double crossing(const Piece& piece) const {
    constexpr int STRETCHES = 64, HALVINGS = 50;
    const ArcLength arc(piece.edge.path);
    const auto side = [&](double f) { return m_line.side(arc.at(f * arc.length())); };
    for (int k = 0; k < STRETCHES; ++k) {
      double low = static_cast<double>(k) / STRETCHES, high = (k + 1.0) / STRETCHES;
      const bool left = side(low) > 0;
      if ((side(high) > 0) == left)
        continue;
      for (int turn = 0; turn < HALVINGS; ++turn) {
        const double middle = 0.5 * (low + high);
        ((side(middle) > 0) == left ? low : high) = middle;
      }
      if (std::min(low, 1 - low) * arc.length() > AT_CORNER)
        return low;
    }
    return 0;
  }

  FoldLine m_line;
  std::vector<std::vector<Piece>> m_loops;
  std::vector<Place> m_hits; ///< pieces that end on the line where the side changes, along it
};

double area_of(const Panel& panel) {
  double sum = 0;
  for (const auto& loop : panel.loops) {
    std::vector<Path> paths;
    for (const PanelEdge& edge : loop)
      paths.push_back(edge.path);
    sum += signed_area(paths);
  }
  return sum;
}

/// Turns a half so that the fold is its top.
void stand_up(Panel& panel, const Vec2& up) {
  const Eigen::Matrix2d turn =
      Eigen::Rotation2Dd(units::PI / 2 - std::atan2(up.y(), up.x())).toRotationMatrix();
  const auto path = [&](Path& p) {
    for (Segment& s : p)
      for (Vec2& x : s.p)
        x = snapped(turn * x);
  };
  for (auto& loop : panel.loops)
    for (PanelEdge& edge : loop)
      path(edge.path);
  for (InnerLine& line : panel.lines)
    path(line.path);
  panel.grain = (turn * panel.grain).normalized();
}

bool cut_at(Pattern& pattern, int p, const FoldLine& line) {
  constexpr double SAME_AREA = 1e-3; // of a half: necks as deep
  const Panel panel = pattern.panels[p];
  const CutLoops loops(panel, line);
  auto left = loops.half(panel, 1), right = loops.half(panel, 0);
  if (!left || !right)
    return false;
  const double larger = area_of(left->panel) - area_of(right->panel);
  const bool level = std::abs(larger) < SAME_AREA * area_of(panel);
  const bool left_in_front = level ? line.along.x() < 0 : larger < 0; // as drawn, the lower one
  std::vector<Rebuilt> halves;
  for (const bool front : {true, false}) {
    const bool is_left = front == left_in_front;
    Rebuilt half = is_left ? *left : *right;
    keep_lines(half.panel, [&](const InnerLine& inner) {
      const ArcLength arc(inner.path);
      for (int k = 0; k <= SEAM_SAMPLES; ++k) {
        const double side = line.side(arc.at(arc.length() * k / SEAM_SAMPLES));
        if ((is_left ? side : -side) < LINE_ON_EDGE)
          return false;
      }
      return true;
    });
    half.panel.name = (front ? "front_" : "back_") + panel.name;
    half.panel.hint = {};
    half.panel.hint.part = "torso";
    half.panel.hint.theta = front ? 0 : units::PI;
    const Vec2 to_left(-line.along.y(), line.along.x());
    stand_up(half.panel, is_left ? Vec2(-to_left) : to_left);
    halves.push_back(std::move(half));
  }
  const std::string names[2] = {halves[0].panel.name, halves[1].panel.name};
  static const io::Json NOTHING;
  const int other = std::ssize(pattern.panels);
  replace_panel(pattern, p, std::move(halves), io::Node(NOTHING, panel.name));
  for (int k = 1; k <= loops.n_cuts(); ++k) {
    const std::string edge = "fold_" + std::to_string(k);
    const int a = pattern.panels[p].find_edge(edge), b = pattern.panels[other].find_edge(edge);
    pattern.seams.push_back(
        {panel.name + "-" + edge, "seam", {{p, a, 0, 1}}, {{other, b, 1, 0}}, ""});
  }
  pattern.findings.push_back(
      {"placement.cut-at-fold"_id, panel.name +
                                       " is front and back in one, folded over the "
                                       "shoulders: placed and joined there as " +
                                       names[0] + " and " + names[1]});
  return true;
}

} // namespace

int cut_shoulder_folds(Pattern& pattern) {
  int cut = 0;
  for (int p = 0, n = static_cast<int>(pattern.panels.size()); p < n; ++p)
    if (const auto line = fold_of(pattern, p))
      cut += cut_at(pattern, p, *line);
  return cut;
}

} // namespace sloper::pattern
