#include <cloth/body_contact.hpp>

#include <algorithm>

/// Contact with skin that moves: how far it may go before it would pass cloth, and what it takes along.
namespace sloper::cloth {

namespace {

/// In one part of its way skin uses at most this share of its distance to cloth in front of it. One step of the cloth at most doubles a
/// distance that is short (Newton's step into the barrier): with half, cloth would never be left the distance that it had.
constexpr double SKIN_APPROACH = 1.0 / 3;
/// Carried cloth that the skin would come too near to is pushed away by at most this much at a time, m, in so many rounds: a twist of the
/// skin under taut cloth is met, a wall that comes is not.
constexpr double MOST_CLEARED = 0.002;
constexpr int CLEAR_ROUNDS = 12;

/// The way that skin and cloth have in common when a body walks, against which ways are counted; 0 where most of the cloth stays: skin that holds
/// still is then left alone.
Vec3 common_way(const std::vector<Vec3>& carry) {
  Vec3 mean = Vec3::Zero();
  double longest = 0;
  for (const Vec3& c : carry) {
    mean += c / static_cast<double>(carry.size());
    longest = std::max(longest, c.norm());
  }
  return mean.norm() > 0.25 * longest ? mean : Vec3::Zero();
}

std::vector<double> lengths_against(const Vec3& common, const std::vector<Vec3>& ways) {
  std::vector<double> l(ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) l[i] = (ways[i] - common).norm();
  return l;
}

} // namespace

/// How much nearer a pair's ends come at most, m.
double BodyContactEffect::approach(const Pair& pair, const std::vector<double>& skin_goes, const std::vector<double>& cloth_goes) {
  double skin = 0, cloth = 0;
  for (int k = 0; k < pair.n_body; ++k) skin = std::max(skin, skin_goes[pair.body[k]]);
  for (int k = 0; k < pair.n; ++k) cloth = std::max(cloth, cloth_goes[pair.particle[k]]);
  return skin + cloth;
}

std::vector<double> BodyContactEffect::skin_room(const std::vector<Vec3>& x) {
  search(x);
  std::vector<double> room(m_body.mesh().positions.size(), 0.5 * (EDGE_REACH * m_options.gap_m + m_options.slack_m));
  for (const Pair& pair : m_pairs) {
    if (pair.crossed) continue;
    const double half = 0.5 * closest(pair, x).distance;
    for (int k = 0; k < pair.n_body; ++k) room[pair.body[k]] = std::min(room[pair.body[k]], half);
  }
  return room;
}

double BodyContactEffect::free_share(const std::vector<Vec3>& x, const std::vector<Vec3>& way, const std::vector<Vec3>& carry) {
  if (m_edge_slot.empty()) return 0; // not bound yet: there was no step
  const Vec3 common = common_way(carry);
  const std::vector<double> skin_goes = lengths_against(common, way), cloth_goes = lengths_against(common, carry);
  double longest = 0, carried = 0;
  for (const double d : cloth_goes) carried = std::max(carried, d);
  Vec3 low = Vec3::Constant(1e300), high = -low; // skin that no cloth is near may go as far as it likes
  const double reach = m_options.gap_m + m_options.slack_m;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const Vec3& p : {x[i], Vec3(x[i] + carry[i])}) {
      low = low.cwiseMin(p - Vec3::Constant(reach));
      high = high.cwiseMax(p + Vec3::Constant(reach));
    }
  const std::vector<Vec3>& skin = m_body.mesh().positions;
  for (std::size_t v = 0; v < way.size(); ++v) {
    const Vec3 to = skin[v] + way[v];
    const bool near = (skin[v].cwiseMin(to).array() <= high.array()).all() && (skin[v].cwiseMax(to).array() >= low.array()).all();
    if (near) longest = std::max(longest, skin_goes[v]);
  }
  if (longest <= 0 && carried <= 0) return 1;
  const double seen = USED * (EDGE_REACH * m_options.gap_m + m_options.slack_m);
  begin_step(x, 0);
  double moved = m_body_moved;
  for (std::size_t i = 0; i < x.size(); ++i) moved = std::max(moved, m_body_moved + (x[i] - m_searched_at[i]).norm());
  if (moved > 0.5 * seen) {
    search(x);
    moved = 0;
  }
  double share = std::min(1.0, (seen - moved) / (longest + carried));
  measure_way(x);
  for (const Pair& pair : m_pairs) {
    const double nearer_at_most = approach(pair, skin_goes, cloth_goes);
    if (pair.crossed || nearer_at_most <= 0 || share * nearer_at_most <= SKIN_APPROACH * (pair.clear - farthest(pair))) continue;
    const Closest c = closest(pair, x);
    if (!c.valid) continue;
    // At the closest points: what turns with the skin, as carried cloth does, comes no nearer by turning.
    double skin_toward = 0, cloth_away = 0;
    for (int k = 0; k < pair.n_body; ++k) skin_toward += c.body_weight[k] * c.normal.dot(way[pair.body[k]]);
    for (int k = 0; k < pair.n; ++k) cloth_away += c.weight[k] * c.normal.dot(carry[pair.particle[k]]);
    if (const double nearer = skin_toward - cloth_away; nearer > 0) {
      share = std::min(share, SKIN_APPROACH * c.distance / nearer);
    }
  }
  return share;
}

void BodyContactEffect::clear_carry(const std::vector<Vec3>& x, const std::vector<Vec3>& way, std::vector<Vec3>& carry) {
  if (m_edge_slot.empty()) return;
  begin_step(x, 0);
  struct Near {
    const Pair* pair;
    double skin_goes, room; // m: at most; ends that come no nearer than that are left alone
    int measured = -1;
  };
  struct Measured {
    Closest c;
    double skin_toward; // m
  };
  std::vector<Near> near;
  std::vector<Measured> measured; // few pairs ever need it
  measure_way(x);
  const Vec3 common = common_way(carry);
  const std::vector<double> skin_goes = lengths_against(common, way);
  std::vector<double> cloth_goes = lengths_against(common, carry);
  for (const Pair& pair : m_pairs) {
    if (pair.crossed) continue;
    double skin = 0;
    for (int k = 0; k < pair.n_body; ++k) skin = std::max(skin, skin_goes[pair.body[k]]);
    near.push_back({&pair, skin, 0.5 * SKIN_APPROACH * (pair.clear - farthest(pair))});
  }
  const auto measure = [&](const Pair& pair) {
    Measured m = {closest(pair, x), 0};
    for (int k = 0; m.c.valid && k < pair.n_body; ++k) m.skin_toward += m.c.body_weight[k] * m.c.normal.dot(way[pair.body[k]]);
    measured.push_back(m);
    return static_cast<int>(measured.size()) - 1;
  };
  for (int round = 0; round < CLEAR_ROUNDS; ++round) {
    bool more = false;
    for (Near& n : near) {
      double cloth = 0;
      for (int k = 0; k < n.pair->n; ++k) cloth = std::max(cloth, cloth_goes[n.pair->particle[k]]);
      if (n.skin_goes + cloth <= n.room || n.skin_goes + cloth <= 0) continue;
      if (n.measured < 0) n.measured = measure(*n.pair);
      const auto& [c, skin_toward] = measured[n.measured];
      if (!c.valid) continue;
      double away = 0, share = 0;
      for (int k = 0; k < n.pair->n; ++k) {
        away += c.weight[k] * c.normal.dot(carry[n.pair->particle[k]]);
        share += c.weight[k] * c.weight[k];
      }
      const double lack = skin_toward - away - 0.5 * SKIN_APPROACH * c.distance;
      if (lack <= 0 || lack > MOST_CLEARED) continue;
      for (int k = 0; k < n.pair->n; ++k) {
        const int i = n.pair->particle[k];
        carry[i] += c.weight[k] / share * lack * c.normal;
        cloth_goes[i] = (carry[i] - common).norm();
      }
      more = true;
    }
    if (!more) return;
  }
}

/// Anchors go with the nearest skin: it moves as its triangle does, in the barycentric coordinates of the anchor.
void BodyContactEffect::carry_anchors(const std::vector<Vec3>& positions) {
  const TriangleMesh& skin = m_body.mesh();
  for (std::size_t i = 0; i < m_anchor.size(); ++i) {
    if (!m_has_anchor[i]) continue;
    const int f = m_clearance[i].triangle;
    if (f < 0) {
      m_has_anchor[i] = 0;
      continue;
    }
    const Triangle& t = skin.triangles[f];
    const auto near = collision::point_triangle(m_anchor[i], skin.positions[t[0]], skin.positions[t[1]], skin.positions[t[2]]);
    Vec3 way = Vec3::Zero();
    for (int k = 0; k < 3; ++k) way += near.barycentric[k] * (positions[t[k]] - skin.positions[t[k]]);
    m_anchor[i] += way;
    m_carried[i] += way;
  }
}

void BodyContactEffect::move_body(const std::vector<Vec3>& positions) {
  double motion = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) motion = std::max(motion, (positions[i] - m_body.mesh().positions[i]).squaredNorm());
  motion = std::sqrt(motion);
  m_body_moved += motion;
  carry_anchors(positions);
  m_body.set_positions(positions);
  for (Pair& pair : m_pairs) pair.clear -= motion;
  for (Clearance& c : m_clearance)
    if (c.distance >= 0) c.distance = std::max(0.0, c.distance - motion);
}

} // namespace sloper::cloth
