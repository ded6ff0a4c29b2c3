#include <pattern/mesh/size_field.hpp>
#include <sloper/base/error.hpp>
#include <sloper/pattern/mesh/boundary.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr double SAME = 1e-9; ///< fractions nearer than this are one

/// One stretch of seam between two breaks, or of a free edge.
struct EdgePiece {
  int panel, edge;
  double from, to; ///< from < to, along the outline
  int n = 0;       ///< segments; 0 when merged away
  bool sewn = false;
  std::vector<double> inner; ///< fractions of the piece where it is cut, where they are not even
};

/// A stretch of seam: side a's piece and side b's, and whether each is walked against its outline.
struct Pair {
  Run a, b; ///< each within one edge; from > to against the outline
  int n = 0;
};

/// Walks one side of a seam by its normalised length.
class Side {
public:
  Side(const Pattern& pattern, const std::vector<Run>& runs) : m_runs(&runs) {
    const double total = std::max(side_length(pattern, runs), 1e-12);
    double sum = 0;
    m_corners.push_back(0);
    for (const Run& run : runs)
      m_corners.push_back((sum += run_length(pattern, run)) / total);
    m_corners.back() = 1;
  }
  const std::vector<double>& corners() const { return m_corners; } ///< 0, run ends, 1
  /// The stretch [u0, u1] of the side, which lies within one run.
  Run stretch(double u0, double u1) const {
    std::size_t k = 0;
    const double middle = 0.5 * (u0 + u1);
    while (k + 2 < m_corners.size() && m_corners[k + 1] < middle)
      ++k;
    Run run = (*m_runs)[k];
    const double span = m_corners[k + 1] - m_corners[k];
    const auto fraction = [&](double u) {
      double f = span > 0 ? (u - m_corners[k]) / span : 0;
      if (f < SAME)
        f = 0;
      if (f > 1 - SAME)
        f = 1;
      return run.from + f * (run.to - run.from);
    };
    const double from = fraction(u0), to = fraction(u1);
    run.from = from;
    run.to = to;
    return run;
  }

private:
  const std::vector<Run>* m_runs;
  std::vector<double> m_corners;
};

/// Matching breaks of both sides in order: (u on a, u on b). Corners that nearly face each other
/// are brought together; the others have their partner in the middle of the other side's edge.
std::vector<std::array<double, 2>> matched_breaks(const Side& a, const Side& b, double tolerance) {
  std::vector<std::array<double, 2>> knots = {{0, 0}};
  std::size_t j = 1;
  for (std::size_t i = 1; i + 1 < a.corners().size(); ++i) {
    const double u = a.corners()[i];
    while (j + 1 < b.corners().size() && b.corners()[j] < u - tolerance)
      ++j;
    if (j + 1 < b.corners().size() && std::abs(b.corners()[j] - u) <= tolerance &&
        b.corners()[j] > knots.back()[1]) {
      knots.push_back({u, b.corners()[j]});
      ++j;
    }
  }
  knots.push_back({1, 1});
  std::vector<std::array<double, 2>> breaks = {{0, 0}};
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const auto [a0, b0] = knots[k];
    const auto [a1, b1] = knots[k + 1];
    std::vector<std::array<double, 2>> inner;
    for (double u : a.corners())
      if (u > a0 + SAME && u < a1 - SAME)
        inner.push_back({u, b0 + (u - a0) / (a1 - a0) * (b1 - b0)});
    for (double u : b.corners())
      if (u > b0 + SAME && u < b1 - SAME)
        inner.push_back({a0 + (u - b0) / (b1 - b0) * (a1 - a0), u});
    std::sort(inner.begin(), inner.end());
    breaks.insert(breaks.end(), inner.begin(), inner.end());
    breaks.push_back(knots[k + 1]);
  }
  return breaks;
}

/// The finished vertices of one panel edge: fractions in order, and the loop vertex of each.
struct EdgeVertices {
  std::vector<double> at;
  std::vector<int> vertex;
  int find(double f) const {
    for (std::size_t k = 0; k < at.size(); ++k)
      if (std::abs(at[k] - f) < 1e-7)
        return static_cast<int>(k);
    return -1;
  }
};

class Sampler {
public:
  Sampler(const Pattern& pattern, double h, double seam_h, const std::string& file,
          const std::vector<double>& of_panel)
      : m_pattern(pattern), m_h(of_panel), m_seam_h(seam_h), m_file(file) {
    m_h.resize(pattern.panels.size(), h);
  }

  Boundary run() {
    m_pieces.resize(m_pattern.panels.size());
    for (std::size_t p = 0; p < m_pattern.panels.size(); ++p)
      m_pieces[p].resize(static_cast<std::size_t>(m_pattern.panels[p].n_edges()));
    for (std::size_t p = 0; p < m_pattern.panels.size(); ++p)
      m_chord.push_back(chord_limit(m_pattern.panels[p], m_h[p]));
    m_pairs.resize(m_pattern.seams.size());
    for (std::size_t s = 0; s < m_pattern.seams.size(); ++s)
      if (m_pattern.seams[s].kind != "pleat")
        cut_seam(s);
    for (std::size_t s = 0; s < m_pattern.seams.size();
         ++s) // their upper layers may be sewn already
      if (m_pattern.seams[s].kind == "pleat")
        cut_pleat(s);
    for (std::size_t p = 0; p < m_pattern.panels.size(); ++p) {
      fill_free(static_cast<int>(p));
      sample_panel(static_cast<int>(p));
    }
    for (std::size_t s = 0; s < m_pattern.seams.size(); ++s)
      stitch(s);
    return std::move(m_out);
  }

private:
  double piece_length(const Run& run) const { return run_length(m_pattern, run); }

  /// Longest chord on curves for which all chords together cut off less than 0.05 % of the panel:
  /// an arc that turns by T in chords of length c loses T c^2 / 12.
  static double chord_limit(const Panel& panel, double h) {
    double turn = 0, area = 0;
    for (const auto& loop : panel.loops) {
      std::vector<Path> paths;
      for (const PanelEdge& e : loop) {
        const ArcLength arc(e.path);
        turn += turning(arc, 0, arc.length());
        paths.push_back(e.path);
      }
      area += signed_area(paths);
    }
    return std::max(turn > 0 ? std::sqrt(12 * 5e-4 * std::abs(area) / turn) : h, h / 3);
  }

  /// Edge length between two runs that are sewn to each other, m: the finer panel's.
  double seam_length(const Run& a, const Run& b) const {
    return std::min({m_seam_h, m_h[a.panel], m_h[b.panel]});
  }

  /// Of the panels of a seam, m.
  double least_length(const Seam& seam) const {
    double least = m_h[seam.a[0].panel];
    for (const auto* side : {&seam.a, &seam.b})
      for (const Run& run : *side)
        least = std::min(least, m_h[run.panel]);
    return least;
  }

  /// Segments that a run needs on account of its bends.
  int segments_for_bends(const Run& run) const {
    const double limit = m_chord[run.panel], h = m_h[run.panel];
    if (limit >= h)
      return 0;
    const ArcLength arc(m_pattern.panels[run.panel].edge(run.edge).path);
    const double s0 = std::min(run.from, run.to) * arc.length(),
                 s1 = std::max(run.from, run.to) * arc.length();
    if (turning(arc, s0, s1) * (s1 - s0) < 0.3 * h)
      return 0; // bends gently: shorter chords would gain next to nothing
    return static_cast<int>(std::ceil((s1 - s0) / limit));
  }

  static int segments_for(double length_a, double length_b, double h) {
    if (std::max(length_a, length_b) < 0.2 * h)
      return 0;
    return std::max(1, static_cast<int>(std::lround(std::sqrt(length_a * length_b) / h)));
  }

  void add_piece(const Run& run, int n) {
    auto& pieces = m_pieces[run.panel][run.edge];
    const EdgePiece piece{
        run.panel, run.edge, std::min(run.from, run.to), std::max(run.from, run.to), n, true, {}};
    for (const EdgePiece& other : pieces)
      if (piece.from < other.to - 1e-7 && other.from < piece.to - 1e-7)
        throw input_error(
            "pattern.sewn-twice"_id, m_file, place_of(m_pattern, run),
            centimetres((std::min(piece.to, other.to) - std::max(piece.from, other.from)) *
                        length(m_pattern.panels[run.panel].edge(run.edge).path)) +
                " of this edge are sewn twice",
            "let every stretch of an edge be in one seam only");
    pieces.push_back(piece);
  }

  void cut_seam(std::size_t s) {
    const Seam& seam = m_pattern.seams[s];
    const Side a(m_pattern, seam.a), b(m_pattern, seam.b);
    const double length_a = side_length(m_pattern, seam.a),
                 length_b = side_length(m_pattern, seam.b),
                 shorter = std::max(std::min(length_a, length_b), 1e-9);
    const auto breaks = matched_breaks(a, b, std::max(0.5 * least_length(seam) / shorter, 0.01));
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
      Pair pair{a.stretch(breaks[k][0], breaks[k + 1][0]),
                b.stretch(breaks[k][1], breaks[k + 1][1])};
      const double h = seam_length(pair.a, pair.b);
      pair.n = segments_for(piece_length(pair.a), piece_length(pair.b), h);
      if (pair.n > 0)
        pair.n = std::max({pair.n, segments_for_bends(pair.a), segments_for_bends(pair.b)});
      if (pair.n == 0)
        m_out.findings.push_back(
            {"mesh.stretch-merged"_id,
             place_of(m_pattern, pair.a) + " and " + place_of(m_pattern, pair.b) +
                 ": a stretch of " + centimetres(piece_length(pair.a)) +
                 " is merged into its neighbours (edge length " + centimetres(h) + ")"});
      add_piece(pair.a, pair.n);
      add_piece(pair.b, pair.n);
      m_pairs[s].push_back(pair);
    }
  }

  /// A layer of a pleat takes the cuts of the upper layer, one whole edge of another.
  void cut_pleat(std::size_t s) {
    const Run &layer = m_pattern.seams[s].a[0], &upper = m_pattern.seams[s].b[0];
    auto& pieces = m_pieces[upper.panel][upper.edge];
    std::sort(pieces.begin(), pieces.end(),
              [](const EdgePiece& x, const EdgePiece& y) { return x.from < y.from; });
    const double total = length(m_pattern.panels[upper.panel].edge(upper.edge).path);
    std::vector<std::pair<double, double>> gaps;
    double at = 0;
    for (const EdgePiece& piece : pieces) {
      if (piece.from - at > 1e-7)
        gaps.push_back({at, piece.from});
      at = piece.to;
    }
    if (1 - at > 1e-7)
      gaps.push_back({at, 1});
    for (const auto& [from, to] : gaps)
      pieces.push_back({upper.panel,
                        upper.edge,
                        from,
                        to,
                        std::max(1, segments_for((to - from) * total, (to - from) * total,
                                                 seam_length(layer, upper))),
                        true,
                        {}});
    std::sort(pieces.begin(), pieces.end(),
              [](const EdgePiece& x, const EdgePiece& y) { return x.from < y.from; });
    const bool turned = (layer.from < layer.to) != (upper.from < upper.to);
    for (const EdgePiece& piece : std::vector<EdgePiece>(pieces)) {
      Run a{layer.panel, layer.edge, turned ? 1 - piece.from : piece.from,
            turned ? 1 - piece.to : piece.to};
      m_pairs[s].push_back({a, {upper.panel, upper.edge, piece.from, piece.to}, piece.n});
      add_piece(a, piece.n);
    }
    if (upper.from > upper.to) { // walked as the seam says
      std::reverse(m_pairs[s].begin(), m_pairs[s].end());
      for (Pair& pair : m_pairs[s]) {
        std::swap(pair.a.from, pair.a.to);
        std::swap(pair.b.from, pair.b.to);
      }
    }
  }

  void fill_free(int p) {
    auto& edges = m_pieces[p];
    for (std::size_t e = 0; e < edges.size(); ++e) {
      auto& pieces = edges[e];
      const double total = length(m_pattern.panels[p].edge(static_cast<int>(e)).path);
      std::sort(pieces.begin(), pieces.end(),
                [](const EdgePiece& x, const EdgePiece& y) { return x.from < y.from; });
      std::vector<EdgePiece> all;
      double at = 0;
      const auto free_to = [&](double to) {
        if (to - at < 1e-7)
          return;
        EdgePiece piece{p,
                        static_cast<int>(e),
                        at,
                        to,
                        segments_for((to - at) * total, (to - at) * total, m_h[p]),
                        false,
                        {}};
        if (piece.n > 0)
          piece.n = std::max(piece.n, segments_for_bends({p, static_cast<int>(e), at, to}));
        if (piece.n > 0 && m_seam_h < m_h[p])
          grade(piece, (to - at) * total);
        if (piece.n == 0)
          m_out.findings.push_back({"mesh.stretch-merged"_id,
                                    place_of(m_pattern, {p, static_cast<int>(e)}) +
                                        ": a free stretch of " + centimetres((to - at) * total) +
                                        " is merged into its neighbours"});
        all.push_back(piece);
      };
      for (const EdgePiece& piece : pieces) {
        free_to(piece.from);
        all.push_back(piece);
        at = piece.to;
      }
      free_to(1);
      pieces = all;
    }
  }

  /// Whether a seam ends where this piece begins (or begins where it ends).
  bool meets_seam(const EdgePiece& piece, bool at_start) const {
    const Panel& panel = m_pattern.panels[piece.panel];
    int edge = piece.edge, first = 0;
    if (at_start ? piece.from > 1e-7 : piece.to < 1 - 1e-7)
      return true; // free stretches end within an edge only where a seam begins
    for (const auto& loop : panel.loops) {
      const int n = std::ssize(loop);
      if (edge < first + n) {
        edge = first + (edge - first + (at_start ? n - 1 : 1)) % n;
        break;
      }
      first += n;
    }
    const auto& pieces = m_pieces[piece.panel][edge];
    return std::any_of(pieces.begin(), pieces.end(), [&](const EdgePiece& o) {
      return o.sewn && (at_start ? o.to > 1 - 1e-7 : o.from < 1e-7);
    });
  }

  /// Edges of a free piece grow away from the seams at its ends, if that makes more of them than
  /// its bends ask for.
  void grade(EdgePiece& piece, double piece_length) const {
    const bool start = meets_seam(piece, true), end = meets_seam(piece, false);
    if (!start && !end)
      return;
    std::vector<double> inner =
        graded_fractions(piece_length, m_h[piece.panel], m_seam_h, start, end);
    if (static_cast<int>(inner.size()) + 1 < piece.n)
      return;
    piece.n = static_cast<int>(inner.size()) + 1;
    piece.inner = std::move(inner);
  }

  /// Whether anything is sewn to the edges [first, end) of panel p.
  bool sewn(int p, int first, int end) const {
    const auto& edges = m_pieces[p];
    return std::any_of(edges.begin() + first, edges.begin() + end,
                       [](const std::vector<EdgePiece>& pieces) {
                         return std::any_of(pieces.begin(), pieces.end(),
                                            [](const EdgePiece& o) { return o.sewn; });
                       });
  }

  void sample_panel(int p) {
    const Panel& panel = m_pattern.panels[p];
    Boundary::PanelBoundary out;
    m_vertices.emplace_back(static_cast<std::size_t>(panel.n_edges()));
    auto& vertices = m_vertices.back();
    int e = 0, first_of_loop = 0;
    for (const auto& loop : panel.loops) {
      std::vector<Vec2> points;
      const int first_edge = e;
      bool merged = false; // the last vertex stands for the next edge's start as well
      for (const PanelEdge& edge : loop) {
        const ArcLength arc(edge.path);
        EdgeVertices& ev = vertices[e];
        const auto put = [&](double f) {
          if (!merged) {
            points.push_back(arc.at(f * arc.length()));
            out.edge_of.push_back(e);
          }
          ev.at.push_back(f);
          ev.vertex.push_back(first_of_loop + static_cast<int>(points.size()) - 1);
        };
        for (const EdgePiece& piece : m_pieces[p][e]) {
          if (ev.at.empty() || !merged)
            put(piece.from);
          else {
            ev.at.push_back(piece.from);
            ev.vertex.push_back(ev.vertex.back());
          }
          merged = piece.n == 0;
          for (int k = 1; k < piece.n; ++k)
            put(piece.from +
                (piece.to - piece.from) *
                    (piece.inner.empty() ? static_cast<double>(k) / piece.n : piece.inner[k - 1]));
        }
        ++e;
      }
      const int n = static_cast<int>(points.size()), n_kept = n - (merged ? 1 : 0);
      if (n_kept < 3) {
        if (first_edge == 0 || sewn(p, first_edge, e))
          throw input_error("mesh.outline-too-small"_id, m_file, panel.name,
                            "the outline is too small: " + std::to_string(n_kept) +
                                " vertices at an edge length of " + centimetres(m_h[p]),
                            "give a smaller --edge-length");
        // An eyelet or a drill hole that the mesh is too coarse for; nothing is sewn to it.
        m_out.findings.push_back({"mesh.hole-left-out"_id,
                                  panel.name + ": the hole at " + loop.front().name +
                                      " is smaller than the mesh's edges (" + centimetres(m_h[p]) +
                                      ") and is left out; a smaller --edge-length keeps it"});
        out.edge_of.resize(out.edge_of.size() - points.size());
        continue;
      }
      // Ends: the end of each edge is the start of the next; the last edge ends at the loop's first
      // vertex.
      for (int k = first_edge; k < e; ++k) {
        EdgeVertices& ev = vertices[k];
        ev.at.push_back(1);
        ev.vertex.push_back(k + 1 < e ? vertices[k + 1].vertex.front() : first_of_loop);
      }
      if (merged) { // the loop's last stretch was merged: its vertex and the first are one
        const int last = first_of_loop + n - 1;
        points.pop_back();
        out.edge_of.pop_back();
        for (int k = first_edge; k < e; ++k)
          for (int& v : vertices[k].vertex)
            if (v == last)
              v = first_of_loop;
      }
      first_of_loop += static_cast<int>(points.size());
      out.loops.push_back(std::move(points));
    }
    out.must_split.assign(static_cast<std::size_t>(first_of_loop), 0);
    m_out.panels.push_back(std::move(out));
  }

  void stitch(std::size_t s) {
    Boundary::SeamStitches out;
    for (const Pair& pair : m_pairs[s])
      for (int k = 0; k <= pair.n; ++k) {
        const double t = pair.n == 0 ? 0.0 : static_cast<double>(k) / pair.n;
        const std::array<int, 2> va = vertex_at(pair.a, t), vb = vertex_at(pair.b, t);
        if (!out.a.empty() && out.a.back() == va && out.b.back() == vb)
          continue;
        out.a.push_back(va);
        out.b.push_back(vb);
      }
    // A corner both of whose edges are in this seam, sewn to each other: a cone's or a dart's tip.
    for (std::size_t k = 0; k < out.a.size(); ++k)
      if (out.a[k] == out.b[k])
        m_out.panels[out.a[k][0]].must_split[out.a[k][1]] = 1;
    // So is the line along which a pleat is folded back: both layers under it are sewn to the same
    // stretch.
    if (m_pattern.seams[s].kind == "pleat" && !out.a.empty())
      m_out.panels[out.a.back()[0]].must_split[out.a.back()[1]] = 1;
    m_out.seams.push_back(std::move(out));
  }

  std::array<int, 2> vertex_at(const Run& run, double t) const {
    const EdgeVertices& ev = m_vertices[run.panel][run.edge];
    const int k = ev.find(run.from + (run.to - run.from) * t);
    if (k < 0)
      throw Error(ErrorKind::INTERNAL, "general.internal"_id, m_file, place_of(m_pattern, run),
                  "a stitch has no vertex");
    return {run.panel, ev.vertex[k]};
  }

  const Pattern& m_pattern;
  std::vector<double> m_h; ///< by panel, m
  double m_seam_h;
  std::string m_file;
  std::vector<std::vector<std::vector<EdgePiece>>> m_pieces; ///< by panel, edge
  std::vector<std::vector<Pair>> m_pairs;                    ///< by seam
  std::vector<std::vector<EdgeVertices>> m_vertices;         ///< by panel, edge
  std::vector<double> m_chord;                               ///< by panel, m
  Boundary m_out;
};

} // namespace

Boundary sample_boundary(const Pattern& pattern, double h, const std::string& file, double seam_h,
                         const std::vector<double>& of_panel) {
  return Sampler(pattern, h, seam_h > 0 ? std::min(seam_h, h) : h, file, of_panel).run();
}

} // namespace sloper::pattern
