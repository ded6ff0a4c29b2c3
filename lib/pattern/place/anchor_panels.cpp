#include <pattern/layout/leg_layout.hpp>
#include <pattern/place/placer.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sloper::pattern {

constexpr double SHOULDER_RAISE =
    0.02; // m above the shoulders, so that the shoulder seam closes downwards
constexpr double MOST_YOKE = 0.2;   // m that a yoke reaches over the shoulder
constexpr double WIDE_SPREAD = 2.4; // rad between the sides of a panel: laid on a cylinder, a skirt
                                    // that is wider reaches beyond the arms

constexpr double FAR_BELOW = 0.1; // m that a circle skirt is laid out below what it hangs from, at
                                  // least, for all to be hung anew
constexpr double RING_TOLERANCE = 0.25; // of a ring's area, and of the radius of its waist

constexpr double ANY_RING = 0.6; // of its area, where the hem is no arc about the tip: skirts of
                                 // 11 random designs differ by 0.42 at most, a gore by 9

static double area_of(const std::vector<Vec2>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &p = outline[i], &q = outline[(i + 1) % outline.size()];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return 0.5 * std::abs(twice);
}

/// Whether cloth begins at the radius of the waist straight below the tip, as that of a ring does
/// whose hem is longer or shorter in the middle than at its sides. What narrows downwards lies
/// above the tip.
static bool passes_below(const std::vector<Vec2>& outline, const Vec2& tip, double inner) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 &p = outline[i], &q = outline[(i + 1) % outline.size()];
    if ((p.x() <= tip.x()) == (q.x() <= tip.x()))
      continue;
    const double share = (tip.x() - p.x()) / (q.x() - p.x());
    const double down = tip.y() - (p.y() + share * (q.y() - p.y()));
    if (down > 0)
      nearest = std::min(nearest, down);
  }
  return std::abs(nearest - inner) < RING_TOLERANCE * inner;
}

std::array<Vec2, 2> Placer::bounds(const PanelGroup& group) const {
  std::array<Vec2, 2> all = {Vec2::Constant(1e300), Vec2::Constant(-1e300)};
  for (std::size_t k : group.panels) {
    const auto b = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
    all[0] = all[0].cwiseMin(b[0]);
    all[1] = all[1].cwiseMax(b[1]);
  }
  return all;
}

std::optional<Sector> Placer::sector_of(std::size_t k) const {
  if (m_roles[k].part != "lower_body" || is_leg(m_roles[k]))
    return std::nullopt;
  return sector_by_shape(k);
}

std::optional<Sector> Placer::sector_by_shape(std::size_t k) const {
  std::vector<std::array<Vec2, 2>> sides; // from the waist to the hem
  for (int q : m_graph.neighbours(static_cast<int>(k)))
    if (const PanelRole& other = m_roles[q];
        other.part == m_roles[k].part && other.side != m_roles[k].side)
      for (const auto& seam : m_graph.between(static_cast<int>(k), q))
        sides.push_back({uv(k, seam.front()[0]), uv(k, seam.back()[0])});
  if (sides.size() != 2)
    return std::nullopt;
  const std::vector<std::array<Vec2, 2>> as_sewn = sides;
  for (std::size_t i : {0, 1}) { // the waist's ends are nearer to each other than those of the hem;
                                 // of a band the upper ones
    const auto away = [&](const Vec2& end) {
      return std::min((end - as_sewn[1 - i][0]).norm(), (end - as_sewn[1 - i][1]).norm());
    };
    auto& [in, out] = sides[i];
    const double wider = away(out) - away(in);
    if (std::abs(wider) < 0.2 * (out - in).norm() ? in.y() < out.y() : wider < 0)
      std::swap(in, out);
  }
  if (sides[0][0].x() > sides[1][0].x())
    std::swap(sides[0], sides[1]);
  // Where the lines of the sides meet; of lines that are all but one, between their upper ends.
  Eigen::Matrix2d a = 1e-3 * Eigen::Matrix2d::Identity();
  Vec2 c = 0.5e-3 * (sides[0][0] + sides[1][0]);
  double spread = 0;
  for (const auto& [in, out] : sides) {
    const Vec2 along = (out - in).normalized(), across(-along.y(), along.x());
    a += across * across.transpose();
    c += across.dot(in) * across;
    spread +=
        std::atan2((&in == &sides[0][0] ? -1 : 1) * along.x(), -along.y()); // from straight down
  }
  if (!(spread > WIDE_SPREAD))
    return std::nullopt;
  const Vec2 tip = a.ldlt().solve(c);
  const auto reach = [&](std::size_t end) {
    return 0.5 * ((sides[0][end] - tip).norm() + (sides[1][end] - tip).norm());
  };
  const double inner = reach(0), outer = reach(1);
  std::vector<Vec2> outline;
  for (int v : m_mesh.panels[k].outline)
    outline.push_back(uv(k, v));
  const double ring = 0.5 * spread * (outer * outer - inner * inner);
  const double off = std::abs(area_of(outline) - ring) / ring;
  if (off > RING_TOLERANCE && (off > ANY_RING || !passes_below(outline, tip, inner)))
    return std::nullopt;
  return Sector{tip, spread, inner, outer - inner};
}

std::optional<double> Placer::hanging_height(std::size_t k, const Sector& sector) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (int neighbour : m_graph.neighbours(static_cast<int>(k))) {
    const std::size_t q = static_cast<std::size_t>(neighbour);
    if (m_roles[q].region != Region::TRUNK || m_roles[q].side != m_roles[k].side ||
        m_mesh.panels[q].layer != m_mesh.panels[k].layer)
      continue;
    const auto above = sector_of(q);
    for (const auto& seam : m_graph.between(static_cast<int>(k), neighbour))
      for (const auto& [here, there] : seam) {
        if ((uv(k, here) - sector.tip).norm() > sector.inner + 0.5 * sector.length)
          continue; // its hem: what hangs from it
        const Vec2 p = uv(q, there);
        lowest =
            std::min(lowest, above ? above->height((p - above->tip).norm() - above->inner) : p.y());
      }
  }
  if (!std::isfinite(lowest))
    return std::nullopt;
  return lowest - PANEL_GAP;
}

void Placer::find_stated_skirts() {
  constexpr double BELOW_CHEST = 0.72; // of the stature: arm pits; capes start at the shoulders
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    const PanelRole& role = m_roles[k];
    if (m_pattern.panels[k].hint.part != "torso" || role.region != Region::TRUNK || !role.dv)
      continue;
    const auto sector = sector_by_shape(k);
    const double stated = *role.dv - m_spots[k].offset.y(); // of the height 0 of its spot
    if (sector && sector->top() + stated < BELOW_CHEST * m_space.stature())
      found.push_back(k);
  }
  for (std::size_t k : found)
    m_roles[k].part = "lower_body";
  if (!found.empty())
    m_spots = lay_out(m_pattern, m_mesh, m_graph, m_roles);
}

void Placer::hang_sectors() {
  bool far = false;
  for (std::size_t k = 0; k < m_roles.size(); ++k)
    if (const auto sector = sector_of(k))
      far = far || hanging_height(k, *sector).value_or(-1e300) > sector->top() + FAR_BELOW;
  for (std::size_t tier = 0; far && tier < m_roles.size(); ++tier) // each hangs from the one above
    for (std::size_t k = 0; k < m_roles.size(); ++k)
      if (const auto sector = sector_of(k))
        m_spots[k].offset.y() += hanging_height(k, *sector).value_or(sector->top()) - sector->top();
}

bool Placer::hangs_on_shoulders(double top) const {
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    if (m_roles[k].region != Region::TRUNK)
      return true;
    if (m_roles[k].side != Side::FRONT || m_roles[k].part == "lower_body")
      continue; // the sides of a circle skirt may be drawn level
    for (int q : m_graph.neighbours(static_cast<int>(k))) {
      const PanelRole& other = m_roles[q];
      if (other.side != Side::BACK || other.part == "lower_body")
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(k), q)) { // a level seam at the top
        const Vec2 a = uv(k, seam.front()[0]), b = uv(k, seam.back()[0]);
        if (std::abs(a.x() - b.x()) > std::abs(a.y() - b.y()) &&
            std::min(a.y(), b.y()) > top - MOST_YOKE)
          return true;
      }
    }
  }
  return false;
}

double Placer::strapless_height(double top) const {
  constexpr double USUAL_STATURE = 1.7, ABOVE_WAIST = 1.12; // m
  bool stated = true, named = false;
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    stated = stated && m_roles[k].dv.has_value();
    for (const char* word : {"bodice", "bust", "corset", "bandeau", "tubetop", "tube_top"})
      named = named || m_pattern.panels[k].name.find(word) != std::string::npos;
  }
  const double chest =
      std::min(m_space.level("chest_axilla", 0.76), top / USUAL_STATURE * m_space.stature());
  if (stated)
    return top > ABOVE_WAIST ? chest : 0;
  return named ? m_space.level("chest_axilla", 0.76) : 0;
}

void Placer::anchor_trunk() {
  double top = -1e300;
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    if (m_roles[k].region != Region::TRUNK)
      continue;
    const auto sector = sector_of(k); // its sides may be drawn upwards
    top = std::max(
        top, sector ? sector->top()
                    : laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k))[1].y());
  }
  if (top < -1e299)
    return;
  double shift = 0;
  if (hangs_on_shoulders(top)) {
    // The highest point is the neck end of the shoulder seam: it goes to the skin's height there.
    double x = 0;
    for (const PanelGroup& g : m_groups)
      if (g.region == Region::TRUNK)
        for (std::size_t k : g.panels)
          for (int v : m_mesh.panels[k].outline)
            if (const Vec2 p = uv(k, v); p.y() > top - 0.005)
              x = std::max(x, std::abs(p.x()));
    shift = m_space.shoulder_height(std::clamp(x, 0.05, 0.12)) + SHOULDER_RAISE - top;
  } else if (const double chest = strapless_height(top); chest > 0) {
    shift = chest - top;
  } else {
    const auto [around, edge] = hanging_lengths(top);
    const double crotch = m_space.body().has_landmark("crotch")
                              ? m_space.body().landmark("crotch").y()
                              : 0.47 * m_space.stature();
    shift =
        m_space.hang_height(
            around, crotch + edge - legs_part(m_mesh, m_graph, m_roles, m_spots).value_or(-1e3)) -
        edge;
  }
  for (std::size_t k = 0; k < m_roles.size(); ++k)
    if (m_roles[k].region == Region::TRUNK)
      m_spots[k].offset.y() += shift;
}

std::vector<std::vector<std::size_t>> Placer::hanging_pieces() const {
  std::vector<std::vector<std::size_t>> pieces;
  std::vector<char> met(m_roles.size(), 0);
  for (std::size_t first = 0; first < m_roles.size(); ++first) {
    if (met[first])
      continue;
    std::vector<std::size_t> sewn_together = {first};
    met[first] = 1;
    for (std::size_t at = 0; at < sewn_together.size(); ++at)
      for (int q : m_graph.neighbours(static_cast<int>(sewn_together[at])))
        if (const auto k = static_cast<std::size_t>(q); !met[k]) {
          met[k] = 1;
          sewn_together.push_back(k);
        }
    pieces.emplace_back();
    for (std::size_t k : sewn_together)
      if (m_roles[k].region == Region::TRUNK && m_mesh.panels[k].layer == m_innermost)
        pieces.back().push_back(k);
  }
  return pieces;
}

std::pair<std::vector<double>, double> Placer::hanging_lengths(double top) {
  std::pair<std::vector<double>, double> narrowest{{}, top};
  for (const std::vector<std::size_t>& piece : hanging_pieces()) {
    auto lengths = lengths_around(piece, top);
    if (!lengths.first.empty() &&
        (narrowest.first.empty() || lengths.first[0] < narrowest.first[0]))
      narrowest = std::move(lengths);
  }
  return narrowest;
}

std::pair<std::vector<double>, double> Placer::lengths_around(const std::vector<std::size_t>& piece,
                                                              double top) {
  // The top edge: boundary within 6 cm of the top on the way round, as far as it is level and not
  // sewn. It may be an arc.
  double length = 0, height = 0, dip = top;
  for (std::size_t k : piece) {
    const auto& outline = m_mesh.panels[k].outline;
    if (const auto sector =
            sector_of(k)) { // as it hangs, not as it is drawn; with a waistband, that is the top
      const double waist = sector->spread * sector->inner;
      const bool band = std::any_of(outline.begin(), outline.end(), [&](int v) {
        return sewn(v) && std::abs(uv(k, v).x() - sector->tip.x()) < 0.2 * waist &&
               (uv(k, v) - sector->tip).norm() < sector->inner + 0.02;
      });
      if (!band && sector->top() > top - 0.06) {
        length += waist;
        height += waist * sector->top();
        dip = std::min(dip, sector->top());
      }
      continue;
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const int a = outline[i], b = outline[(i + 1) % outline.size()];
      const Vec2 p = uv(k, a), q = uv(k, b);
      if (std::min(p.y(), q.y()) > top - 0.06 &&
          std::abs(p.x() - q.x()) > std::abs(p.y() - q.y()) && !(sewn(a) && sewn(b))) {
        length += (p - q).norm();
        height += 0.5 * (p - q).norm() * (p.y() + q.y());
        dip = std::min({dip, p.y(), q.y()});
      }
    }
  }
  if (!(length > 0.1))
    return {{}, top};
  const double edge = height / length;
  std::vector<double> around = {length};
  for (int row = 1; row <= 15; ++row) {
    const double line = edge - 0.01 * row;
    double widest = 0; // rows of panels are laid a little apart: look around the gap
    for (double off : {-0.012, -0.006, 0.0, 0.006, 0.012})
      widest = std::max(widest, covered(piece, line + off));
    around.push_back(line > dip - 0.002 ? std::max(length, widest) : widest);
  }
  return {around, edge};
}

double Placer::covered(const std::vector<std::size_t>& piece, double v) const {
  double sum = 0;
  for (std::size_t k : piece) {
    const auto sector = sector_of(k);
    const double down = sector ? sector->top() - v : 0;
    if (!sector)
      sum += pattern::covered(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k), v);
    else if (down >= 0 && down <= sector->length)
      sum += sector->spread * (sector->inner + down);
  }
  return sum;
}

bool Placer::sewn(int vertex) {
  if (m_sewn.empty()) {
    m_sewn.assign(m_mesh.pattern.size(), 0);
    for (const MeshSeam& s : m_mesh.seams)
      for (std::size_t k = 0; k < s.a.size(); ++k)
        m_sewn[s.a[k]] = m_sewn[s.b[k]] = 1;
  }
  return m_sewn[vertex] != 0;
}

void Placer::face_neck() {
  constexpr double AROUND = 0.4, HALF_WIDTH = 0.075; // m, of a neck
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    const PlacementHint& hint = m_pattern.panels[k].hint;
    if (m_roles[k].region != Region::NECK || hint.rigid || !hint.part.empty())
      continue;
    const auto own = laid_bounds(m_mesh, m_roles[k], m_spots[k], static_cast<int>(k));
    Vec2 sum = Vec2::Zero();
    double stitches = 0;
    for (int q : m_graph.neighbours(static_cast<int>(k))) {
      const auto trunk = static_cast<std::size_t>(q);
      if (m_roles[trunk].region != Region::TRUNK || m_roles[trunk].side == Side::RING)
        continue;
      for (const auto& seam : m_graph.between(static_cast<int>(k), q))
        for (const auto& [here, there] : seam) {
          const double aside = std::asin(std::clamp(uv(trunk, there).x() / HALF_WIDTH, -1.0,
                                                    1.0)); // u of a back runs to the right
          const double at = m_roles[trunk].side == Side::FRONT ? aside : units::PI + aside;
          const double middle =
              at - 2 * units::PI * (uv(k, here).x() - 0.5 * (own[0].x() + own[1].x())) / AROUND;
          sum += Vec2(std::cos(middle), std::sin(middle));
          ++stitches;
        }
    }
    if (stitches > 0 && sum.norm() > 0.3 * stitches)
      m_roles[k].theta =
          std::round(std::atan2(sum.y(), sum.x()) / (units::PI / 4)) * (units::PI / 4);
  }
}

void Placer::level_neck() {
  std::vector<std::optional<double>> raise(m_roles.size());
  double lowest = 1e300;
  for (std::size_t k = 0; k < m_roles.size(); ++k) {
    double sum = 0, stitches = 0;
    for (int q : m_graph.neighbours(static_cast<int>(k)))
      if (m_roles[k].region == Region::NECK && m_roles[q].region == Region::TRUNK)
        for (const auto& seam : m_graph.between(static_cast<int>(k), q))
          for (const auto& s : seam) {
            sum += uv(k, s[0]).y();
            ++stitches;
          }
    if (stitches == 0)
      continue;
    raise[k] = -sum / stitches;
    lowest = std::min(lowest, sum / stitches);
  }
  const std::vector<std::optional<double>> of_sewn_on = raise;
  for (std::size_t k = 0; k < m_roles.size(); ++k) { // a leaf goes with its stand
    if (m_roles[k].region != Region::NECK)
      continue;
    for (int q : m_graph.neighbours(static_cast<int>(k)))
      if (!raise[k])
        raise[k] = of_sewn_on[q];
    if (raise[k])
      m_spots[k].offset.y() += *raise[k] + lowest;
  }
}

void Placer::anchor_neck() {
  face_neck();
  level_neck();
  for (const PanelGroup& g : m_groups) {
    if (g.region != Region::NECK)
      continue;
    const auto b = bounds(g);
    const double neck =
        std::max(m_space.shoulder_height(0.06), m_space.body().has_landmark("neck_side_l")
                                                    ? m_space.body().landmark("neck_side_l").y()
                                                    : 0.0);
    for (std::size_t k : g.panels)
      m_spots[k].offset.y() += neck + 0.005 - b[0].y();
  }
}

} // namespace sloper::pattern
