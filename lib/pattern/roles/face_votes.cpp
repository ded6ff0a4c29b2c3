#include <pattern/roles/face_votes.hpp>
#include <pattern/roles/shape_parts.hpp>
#include <pattern/seams/seam_sides.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {
namespace {

constexpr int SAMPLES = 8;                                 // of an edge
constexpr double NEAR_TOP = 0.6, UPPER = 0.7, LOWER = 0.3; // of a panel's height

/// A difference of which a fiftieth of the scale is half a vote: what is drafted differs by more
/// than rounding, and how much says little.
double vote(double difference, double scale) {
  constexpr double HALF_A_VOTE = 0.02;
  return difference / (std::abs(difference) + HALF_A_VOTE * scale);
}
double ratio_vote(double a, double b) {
  constexpr double NOTHING = 1e-4; // m
  return a > NOTHING && b > NOTHING ? vote(std::log(a / b), 1) : 0;
}

} // namespace

FaceWitness::FaceWitness(const Pattern& pattern) : m_panels(pattern.panels.size()) {
  const auto mirrors = panel_mirrors(pattern);
  for (std::size_t p = 0; p < m_panels.size(); ++p) {
    Seen& own = m_panels[p];
    const Panel& panel = pattern.panels[p];
    own.symmetric = std::any_of(mirrors[p].begin(), mirrors[p].end(), [&](const PanelMirror& m) {
      return static_cast<std::size_t>(m.panel) == p;
    });
    own.low = Vec2::Constant(1e300);
    own.high = -own.low;
    for (const PanelEdge& e : panel.loops[0]) {
      const ArcLength arc(e.path);
      std::vector<Vec2>& line = own.outline.emplace_back();
      for (int k = 0; k <= SAMPLES; ++k) {
        const Vec2 v = arc.at(arc.length() * k / SAMPLES);
        line.push_back({panel.grain.y() * v.x() - panel.grain.x() * v.y(), v.dot(panel.grain)});
        own.low = own.low.cwiseMin(line.back());
        own.high = own.high.cwiseMax(line.back());
      }
      Edge& edge = own.edges.emplace_back();
      edge.length = arc.length();
      const Vec2 chord = line.back() - line.front();
      edge.across = std::abs(chord.x());
      edge.level = edge.across > std::abs(chord.y());
      const double size = std::max(chord.squaredNorm(), 1e-12);
      for (const Vec2& v : line)
        edge.bulge +=
            (chord.x() * (v - line.front()).y() - chord.y() * (v - line.front()).x()) / size;
      edge.bulge /= SAMPLES + 1;
    }
    own.width = own.high.x() - own.low.x();
    own.height = own.high.y() - own.low.y();
    for (std::size_t k = 0; k < own.edges.size(); ++k) {
      double sum = 0;
      for (const Vec2& v : own.outline[k])
        sum += v.y();
      own.edges[k].height = (sum / (SAMPLES + 1) - own.low.y()) / std::max(own.height, 1e-6);
    }
  }
  for (const Seam& seam : pattern.seams)
    for (const auto& [runs, others] : {std::pair{&seam.a, &seam.b}, std::pair{&seam.b, &seam.a}})
      for (const Run& run : *runs) {
        Seen& own = m_panels[run.panel];
        const std::size_t n = own.edges.size(), e = static_cast<std::size_t>(run.edge);
        if (e >= n)
          continue; // of an inner loop
        own.edges[e].other = others->front().panel;
        const std::size_t next = (e + 1) % n;
        if (others->front().panel == run.panel &&
            static_cast<std::size_t>(others->front().edge) == next)
          own.edges[e].dart = (own.outline[next].back() - own.outline[e].front()).norm();
      }
}

double FaceWitness::neck_depth(std::size_t panel, double middle) const {
  const Seen& own = m_panels[panel];
  double top = -1e300;
  for (const std::vector<Vec2>& line : own.outline)
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Vec2 &a = line[k], &b = line[k + 1];
      constexpr double TOUCHES = 1e-6; // m
      if (std::min(a.x(), b.x()) - TOUCHES > middle || std::max(a.x(), b.x()) + TOUCHES < middle)
        continue;
      const double run = b.x() - a.x();
      top =
          std::max(top, std::abs(run) < TOUCHES ? std::max(a.y(), b.y())
                                                : a.y() + (b.y() - a.y()) * (middle - a.x()) / run);
    }
  return top > -1e300 ? own.high.y() - top : 0;
}

FaceWitness::Sum FaceWitness::sum_of(const std::vector<std::size_t>& part,
                                     const std::vector<int>& face, std::size_t which,
                                     int side) const {
  Sum sum;
  for (std::size_t p = 0; p < m_panels.size(); ++p) {
    if (part[p] != which || face[p] != side)
      continue;
    const Seen& own = m_panels[p];
    ++sum.panels;
    sum.width += own.width;
    sum.height += own.height;
    double middle = 0.5 * (own.low.x() + own.high.x()), joined = 0;
    for (std::size_t k = 0; k < own.edges.size(); ++k) {
      const Edge& e = own.edges[k];
      const std::size_t q = static_cast<std::size_t>(std::max(e.other, 0));
      const bool sewn = e.other >= 0;
      if (e.level && e.height < LOWER)
        sum.hem += e.length;
      if (e.level && e.height > UPPER)
        sum.top += e.length;
      if ((!sewn || part[q] == NECK_PART) && e.height > NEAR_TOP)
        sum.neck += e.length;
      sum.darts += e.dart;
      if (sewn && part[q] == ARM_PART) {
        sum.armhole += e.length;
        sum.bulge += e.bulge;
      }
      if (!sewn || q == p || part[q] != which || face[q] != side)
        continue;
      sum.middle += e.length;
      sum.lean += e.across;
      if (e.length > joined && !own.symmetric) {
        joined = e.length;
        const std::vector<Vec2>& line = own.outline[k];
        middle = line[line.front().y() > line.back().y() ? 0 : line.size() - 1].x();
      }
    }
    sum.depth += neck_depth(p, middle);
  }
  return sum;
}

FaceVotes FaceWitness::compare(const std::vector<std::size_t>& part,
                               const std::vector<int>& face) const {
  constexpr double DEEP = 0.1, HOLLOW = 0.2, DART = 0.05; // m, of the length, m
  FaceVotes out{};
  const auto both = [&](std::size_t which, const auto& visit) {
    const Sum a = sum_of(part, face, which, 1), b = sum_of(part, face, which, -1);
    if (a.panels > 0 && b.panels > 0)
      visit(a, b);
  };
  const auto mean = [](const Sum& s, double x) { return x / s.panels; };
  both(TORSO_PART, [&](const Sum& a, const Sum& b) {
    out[0] = ratio_vote(a.width, b.width);
    out[1] = ratio_vote(a.hem, b.hem);
    out[2] = ratio_vote(mean(a, a.height), mean(b, b.height));
    out[3] = vote(mean(a, a.depth) - mean(b, b.depth), DEEP);
    out[4] = ratio_vote(a.neck, b.neck);
    out[5] = ratio_vote(a.middle, b.middle);
    out[6] = ratio_vote(a.armhole, b.armhole);
    out[7] = vote(a.bulge - b.bulge, HOLLOW);
    out[8] = vote(a.darts - b.darts, DART);
  });
  both(LOWER_BODY_PART, [&](const Sum& a, const Sum& b) {
    out[9] = ratio_vote(a.width, b.width);
    out[10] = ratio_vote(a.top, b.top);
    out[11] = ratio_vote(mean(a, a.height), mean(b, b.height));
    out[12] = ratio_vote(a.middle, b.middle);
    out[13] = vote(a.darts - b.darts, DART);
  });
  both(LEG_PART, [&](const Sum& a, const Sum& b) {
    out[14] = ratio_vote(a.width, b.width);
    out[15] = ratio_vote(a.middle, b.middle);
    out[16] = vote(a.lean - b.lean, DEEP);
    out[17] = vote(a.darts - b.darts, DART);
  });
  return out;
}

} // namespace sloper::pattern
