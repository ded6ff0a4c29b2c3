#include <cloth/body_contact.hpp>

#include <algorithm>
#include <cmath>

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

/// Of the longest carry: where the mean one is shorter, most of the cloth stays.
constexpr double MOST_STAYS = 0.25;
/// Skin whose longest edges have grown by this factor in a pose is still seen whole.
constexpr double STRETCHED_SKIN = 1.5;

std::vector<double> lengths_against(const Vec3& common, const std::vector<Vec3>& ways) {
  std::vector<double> l(ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) l[i] = (ways[i] - common).norm();
  return l;
}

} // namespace

Vec3 BodyContactEffect::common_way(const std::vector<Vec3>& carry) {
  Vec3 mean = Vec3::Zero(), median = Vec3::Zero();
  double longest = 0;
  for (const Vec3& c : carry) {
    mean += c / static_cast<double>(carry.size());
    longest = std::max(longest, c.norm());
  }
  if (mean.norm() <= MOST_STAYS * longest) return median;
  std::vector<double> part;
  for (int a = 0; a < 3; ++a) { // of what is carried at all: cloth that hangs free is not
    part.clear();
    for (const Vec3& c : carry)
      if (c != Vec3::Zero()) part.push_back(c[a]);
    const auto middle = part.begin() + static_cast<long>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end());
    median[a] = *middle;
  }
  return median;
}

/// The longest way of skin near cloth, against the common one, m: what stays out of all distances that are known may go as far as it likes.
double BodyContactEffect::longest_near(const Box3& cloth, const std::vector<Vec3>& way, const Vec3& common) const {
  const std::vector<Vec3>& skin = m_body.mesh().positions;
  const Vec3 margin = Vec3::Constant(std::max(FAR, m_options.gap_m + m_options.slack_m) + STRETCHED_SKIN * m_longest_body_edge);
  const Vec3 low = cloth.low - margin, high = cloth.high + margin;
  double longest2 = 0;
  for (std::size_t v = 0; v < way.size(); ++v) {
    const Vec3 goes = way[v] - common, to = skin[v] + goes;
    const bool near = (skin[v].cwiseMin(to).array() <= high.array()).all() && (skin[v].cwiseMax(to).array() >= low.array()).all();
    if (near) longest2 = std::max(longest2, goes.squaredNorm());
  }
  return std::sqrt(longest2);
}

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
  Box3 cloth = bounding_box(x);
  for (std::size_t i = 0; i < x.size(); ++i) cloth.add(x[i] + carry[i] - common);
  const double longest = longest_near(cloth, way, common);
  if (longest <= 0 && *std::max_element(cloth_goes.begin(), cloth_goes.end()) <= 0) return 1;
  begin_step(x, 0);
  const auto room = [&](std::size_t i) { return USED * m_reach_now[i] - m_body_moved - (x[i] - m_searched_at[i]).norm(); }; // m, to come nearer unseen
  bool enough = true;
  for (std::size_t i = 0; enough && i < x.size(); ++i) enough = room(i) >= 0.5 * USED * m_reach_now[i];
  if (!enough) search(x);
  double share = 1;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (const double nearer = longest + cloth_goes[i], left = room(i); share * nearer > left) share = left / nearer;
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
  m_nearing.clear();
  m_measured.clear();
  measure_way(x);
  const Vec3 common = common_way(carry);
  const std::vector<double> skin_goes = lengths_against(common, way);
  std::vector<double> cloth_goes = lengths_against(common, carry);
  for (const Pair& pair : m_pairs) {
    if (pair.crossed) continue;
    double skin = 0;
    for (int k = 0; k < pair.n_body; ++k) skin = std::max(skin, skin_goes[pair.body[k]]);
    m_nearing.push_back({&pair, skin, 0.5 * SKIN_APPROACH * (pair.clear - farthest(pair))});
  }
  const auto measure = [&](const Pair& pair) {
    Measured m = {closest(pair, x), 0};
    for (int k = 0; m.closest.valid && k < pair.n_body; ++k) m.skin_toward += m.closest.body_weight[k] * m.closest.normal.dot(way[pair.body[k]]);
    m_measured.push_back(m);
    return static_cast<int>(m_measured.size()) - 1;
  };
  for (int round = 0; round < CLEAR_ROUNDS; ++round) {
    bool more = false;
    for (Nearing& n : m_nearing) {
      double cloth = 0;
      for (int k = 0; k < n.pair->n; ++k) cloth = std::max(cloth, cloth_goes[n.pair->particle[k]]);
      if (n.skin_goes + cloth <= n.room || n.skin_goes + cloth <= 0) continue;
      if (n.measured < 0) n.measured = measure(*n.pair);
      const auto& [c, skin_toward] = m_measured[n.measured];
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

void BodyContactEffect::move_body(const std::vector<Vec3>& positions, const Vec3& common) {
  carry_anchors(positions);
  Box3 cloth = bounding_box(m_searched_at);
  std::vector<Vec3> way = m_body.mesh().positions;
  for (std::size_t v = 0; v < way.size(); ++v) way[v] = positions[v] - way[v];
  const double motion = longest_near(cloth, way, common);
  m_body.set_positions(positions);
  m_body_moved += motion;
  for (std::vector<Vec3>* seen : {&m_searched_at, &m_added_at})
    for (Vec3& p : *seen) p += common;
  for (Pair& pair : m_pairs) pair.clear -= motion;
  for (Clearance& c : m_clearance) {
    c.at += common;
    if (c.distance >= 0) c.distance = std::max(0.0, c.distance - motion);
  }
}

} // namespace sloper::cloth
