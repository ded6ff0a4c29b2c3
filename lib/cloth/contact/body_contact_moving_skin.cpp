#include <sloper/base/parallel.hpp>
#include <sloper/cloth/contact/body_contact.hpp>

#include <algorithm>
#include <cmath>

/// Contact with skin that moves: how far it may go before it would pass cloth, and what it takes
/// along.
namespace sloper::cloth {

namespace {

/// In one substep skin uses at most this share of its distance to cloth in front of it. One
/// step of the cloth at most doubles a distance that is short (Newton's step into the barrier):
/// with half, cloth would never be left the distance that it had.
constexpr double SKIN_APPROACH = 1.0 / 3;
/// Carried cloth that the skin would come too near to is pushed away by at most this much at a
/// time, m, in so many rounds: a twist of the skin under taut cloth is met, a wall that comes is
/// not.
constexpr double MOST_CLEARED = 0.002;
constexpr int CLEAR_ROUNDS = 12;

/// Where it stands still, nothing is carried.
const Vec3& predicted(const std::vector<Vec3>& predictor, std::size_t i) {
  static const Vec3 none = Vec3::Zero();
  return predictor.empty() ? none : predictor[i];
}

} // namespace

/// Decides for which particles the last contact search is still valid: those whose distance to the
/// skin, measured against its planned displacement, cannot fall below the search radius. Asks, for
/// each particle, about the skin within twice its element's activation distance, the element's size
/// and the fastest displacement; distances known from elsewhere count from there.
void BodyContactEffect::measure_against(const std::vector<Vec3>& x,
                                        const std::vector<Vec3>& displacement,
                                        const std::vector<Vec3>& predictor) {
  m_against.assign(x.size(), 0);
  if (m_reach_now.size() != x.size())
    return; // nothing is known
  std::vector<double> radius(x.size());
  for (const Triangle& t : m_triangles) {
    double reach = 0, size = 0;
    for (int k = 0; k < 3; ++k) {
      reach = std::max(reach, m_reach_now[t[k]]);
      size = std::max(size, (x[t[k]] - x[t[(k + 1) % 3]]).norm());
    }
    for (int i : t)
      radius[i] = std::max(radius[i], 2 * reach + size);
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    radius[i] = std::max(radius[i], m_clearance[i].distance + (x[i] - m_clearance[i].at).norm());

  const auto fastest = [&](const Box3& bounds) {
    double most = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      most =
          std::max(most, collision::DisplacementBounds::farthest(bounds, predicted(predictor, i)));
    return most;
  };
  const double anywhere = fastest(bounding_box(displacement));
  const auto [least, widest] = std::minmax_element(radius.begin(), radius.end());
  const Vec3 margin = Vec3::Constant(*widest + anywhere);
  const Box3 cloth = bounding_box(x);
  m_displacement_bounds.build(m_body.mesh(), displacement,
                              {cloth.low - margin, cloth.high + margin}, *least + anywhere);
  const double most = fastest(m_displacement_bounds.all());
  if (most <= 0)
    return;
  parallel_for(x.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      m_against[i] = m_displacement_bounds.max_relative_displacement(predicted(predictor, i), x[i],
                                                                     radius[i] + most);
  });
}

/// How far a pair's ends go against each other at most, m.
double BodyContactEffect::against(const Pair& pair, const std::vector<Vec3>& displacement,
                                  const std::vector<Vec3>& predictor) {
  double most2 = 0;
  for (int k = 0; k < pair.n; ++k)
    for (int b = 0; b < pair.n_body; ++b)
      most2 = std::max(
          most2,
          (displacement[pair.body[b]] - predicted(predictor, pair.particle[k])).squaredNorm());
  return std::sqrt(most2);
}

std::vector<double> BodyContactEffect::max_safe_skin_displacement(const std::vector<Vec3>& x) {
  search(x);
  std::vector<double> room(m_body.mesh().positions.size(),
                           0.5 * (EDGE_REACH * m_options.gap_m + m_options.slack_m));
  for (const Pair& pair : m_pairs) {
    if (pair.crossed)
      continue;
    const double half = 0.5 * closest(pair, x).distance;
    for (int k = 0; k < pair.n_body; ++k)
      room[pair.body[k]] = std::min(room[pair.body[k]], half);
  }
  return room;
}

double BodyContactEffect::collision_free_step_fraction(const std::vector<Vec3>& x,
                                                       const std::vector<Vec3>& displacement,
                                                       const std::vector<Vec3>& predictor) {
  if (m_edge_slot.empty())
    return 0; // not bound yet: there was no step
  const auto stays = [](const std::vector<Vec3>& displacements) {
    return std::all_of(displacements.begin(), displacements.end(),
                       [](const Vec3& w) { return w == Vec3::Zero(); });
  };
  if (stays(displacement) && stays(predictor))
    return 1;
  begin_step(x, 0);
  const auto room = [&](std::size_t i) {
    return USED * m_reach_now[i] - m_skin_moved[i] - (x[i] - m_searched_at[i]).norm();
  }; // m, to come nearer unseen
  bool enough = true;
  for (std::size_t i = 0; enough && i < x.size(); ++i)
    enough = room(i) >= 0.5 * USED * m_reach_now[i];
  if (!enough)
    search(x);
  measure_against(x, displacement, predictor);
  double share = 1;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (const double left = room(i); share * m_against[i] > left)
      share = left / m_against[i];
  measure_moved(x);
  for (const Pair& pair : m_pairs) {
    if (pair.crossed)
      continue;
    const double nearer_at_most = against(pair, displacement, predictor);
    if (share * nearer_at_most <= SKIN_APPROACH * (pair.clear - farthest(pair)))
      continue;
    const Closest c = closest(pair, x);
    if (!c.valid)
      continue;
    // At the closest points: what turns with the skin, as carried cloth does, comes no nearer by
    // turning.
    double skin_toward = 0, cloth_away = 0;
    for (int k = 0; k < pair.n_body; ++k)
      skin_toward += c.body_weight[k] * c.normal.dot(displacement[pair.body[k]]);
    for (int k = 0; k < pair.n; ++k)
      cloth_away += c.weight[k] * c.normal.dot(predictor[pair.particle[k]]);
    if (const double nearer = skin_toward - cloth_away; nearer > 0)
      share = std::min(share, SKIN_APPROACH * c.distance / nearer);
  }
  return share;
}

void BodyContactEffect::push_predictor_off_skin(const std::vector<Vec3>& x,
                                                const std::vector<Vec3>& displacement,
                                                std::vector<Vec3>& predictor) {
  if (m_edge_slot.empty())
    return;
  begin_step(x, 0);
  m_nearing.clear();
  m_measured.clear();
  measure_moved(x);
  for (const Pair& pair : m_pairs)
    if (!pair.crossed)
      m_nearing.push_back({&pair, 0.5 * SKIN_APPROACH * (pair.clear - farthest(pair))});
  const auto measure = [&](const Pair& pair) {
    Measured m = {closest(pair, x), 0};
    for (int k = 0; m.closest.valid && k < pair.n_body; ++k)
      m.skin_toward += m.closest.body_weight[k] * m.closest.normal.dot(displacement[pair.body[k]]);
    m_measured.push_back(m);
    return static_cast<int>(m_measured.size()) - 1;
  };
  for (int round = 0; round < CLEAR_ROUNDS; ++round) {
    bool more = false;
    for (Nearing& n : m_nearing) {
      if (const double nearer_at_most = against(*n.pair, displacement, predictor);
          nearer_at_most <= n.room || nearer_at_most <= 0)
        continue;
      if (n.measured < 0)
        n.measured = measure(*n.pair);
      const auto& [c, skin_toward] = m_measured[n.measured];
      if (!c.valid)
        continue;
      double away = 0, share = 0;
      for (int k = 0; k < n.pair->n; ++k) {
        away += c.weight[k] * c.normal.dot(predictor[n.pair->particle[k]]);
        share += c.weight[k] * c.weight[k];
      }
      const double lack = skin_toward - away - 0.5 * SKIN_APPROACH * c.distance;
      if (lack <= 0 || lack > MOST_CLEARED)
        continue;
      for (int k = 0; k < n.pair->n; ++k) {
        const int i = n.pair->particle[k];
        predictor[i] += c.weight[k] / share * lack * c.normal;
      }
      more = true;
    }
    if (!more)
      return;
  }
}

/// Anchors go with the nearest skin: it moves as its triangle does, in the barycentric coordinates
/// of the anchor.
void BodyContactEffect::carry_anchors(const std::vector<Vec3>& positions) {
  const TriangleMesh& skin = m_body.mesh();
  for (std::size_t i = 0; i < m_anchor.size(); ++i) {
    if (!m_has_anchor[i])
      continue;
    const int f = m_clearance[i].triangle;
    if (f < 0) {
      m_has_anchor[i] = 0;
      continue;
    }
    const Triangle& t = skin.triangles[f];
    const auto near = collision::point_triangle(m_anchor[i], skin.positions[t[0]],
                                                skin.positions[t[1]], skin.positions[t[2]]);
    Vec3 displacement = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      displacement += near.barycentric[k] * (positions[t[k]] - skin.positions[t[k]]);
    m_anchor[i] += displacement;
    m_carried[i] += displacement;
  }
}

void BodyContactEffect::move_body(const std::vector<Vec3>& positions, const std::vector<Vec3>& x,
                                  const std::vector<Vec3>& predictor) {
  carry_anchors(positions);
  std::vector<Vec3> displacement = m_body.mesh().positions;
  for (std::size_t v = 0; v < displacement.size(); ++v)
    displacement[v] = positions[v] - displacement[v];
  measure_against(x, displacement, predictor);
  m_body.set_positions(positions);
  m_skin_moved.resize(x.size(), 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    m_skin_moved[i] += m_against[i];
    Clearance& c = m_clearance[i];
    if (c.distance >= 0)
      c.distance = std::max(0.0, c.distance - m_against[i]);
    c.at += predicted(predictor, i);
    for (std::vector<Vec3>* seen : {&m_searched_at, &m_added_at})
      if (seen->size() == x.size())
        (*seen)[i] += predicted(predictor, i);
  }
  for (Pair& pair : m_pairs)
    pair.clear -= against(pair, displacement, predictor);
}

} // namespace sloper::cloth
