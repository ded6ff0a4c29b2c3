#include <sloper/garment/body_model/under_arms.hpp>

#include <sloper/collision/triangle_tree.hpp>
#include <sloper/garment/body_model/extremity_hulls.hpp>

#include <algorithm>
#include <string>

namespace sloper::garment {

namespace {

constexpr double ON_ARM = 0.05;   // of a particle's weights: it goes with the arm
constexpr double REACH = 0.5;     // m from trunk or leg that such cloth may lie
constexpr double DRAWN_IN = 0.02; // of its size: no forearm, and no triangle without an area
constexpr double PAST_END = 0.02; // m of a forearm beyond the end of its sleeve

bool overlap(const Box3& a, const Box3& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

} // namespace

Forearms::Forearms(const body::Body& body) : m_skin(body.skin.positions) {
  for (const body::Part part : {body::Part::ARM_L, body::Part::ARM_R}) {
    const std::string suffix = part == body::Part::ARM_L ? "_l" : "_r";
    const std::string shoulder = "shoulder_joint" + suffix, elbow = "elbow" + suffix,
                      wrist = "wrist" + suffix;
    if (!body.has_landmark(shoulder) || !body.has_landmark(elbow) || !body.has_landmark(wrist))
      continue;
    Arm arm{part,
            body.landmark(elbow),
            body.landmark(wrist) - body.landmark(elbow),
            (body.landmark(elbow) - body.landmark(shoulder)).norm(),
            0,
            {},
            {}};
    std::vector<char> beyond(body.skin.positions.size(), 0);
    for (std::size_t f = 0; f < body.skin.triangles.size(); ++f) {
      if (body.face_part[f] != part)
        continue;
      const Triangle& t = body.skin.triangles[f];
      bool all = true;
      for (int v : t) {
        const bool is_beyond = (body.skin.positions[v] - arm.elbow).dot(arm.down) > 0;
        if (is_beyond)
          beyond[v] = 1;
        all &= is_beyond;
      }
      if (all)
        m_triangles.push_back(t);
    }
    for (std::size_t v = 0; v < beyond.size(); ++v) {
      if (!beyond[v])
        continue;
      arm.vertices.push_back(static_cast<int>(v));
      arm.box.add(body.skin.positions[v]);
    }
    m_arms.push_back(std::move(arm));
  }
}

bool Forearms::are_near(const std::vector<Vec3>& points) const {
  if (points.empty())
    return false;
  const Box3 box = bounding_box(points);
  return std::any_of(m_arms.begin(), m_arms.end(),
                     [&](const Arm& arm) { return !arm.box.empty() && overlap(box, arm.box); });
}

double Forearms::length_on(const Arm& arm, const std::vector<Vec3>& sleeve) {
  if (sleeve.empty())
    return -arm.upper_length;
  double low = 1e300, high = -1e300; // m along the forearm
  for (const Vec3& p : sleeve) {
    const double along = (p - arm.elbow).dot(arm.down.normalized());
    low = std::min(low, along);
    high = std::max(high, along);
  }
  return high - low - arm.upper_length;
}

bool Forearms::is_covered(body::Part part, const std::vector<Vec3>& sleeve) const {
  return std::any_of(m_arms.begin(), m_arms.end(), [&](const Arm& arm) {
    return arm.part == part && length_on(arm, sleeve) > 0.5 * arm.down.norm();
  });
}

void Forearms::leave_in(body::Part part, const std::vector<Vec3>& sleeve) {
  for (Arm& arm : m_arms) {
    const double covered = length_on(arm, sleeve);
    if (arm.part != part || covered <= 0)
      continue;
    arm.begins = covered + PAST_END;
    arm.vertices.erase(std::remove_if(arm.vertices.begin(), arm.vertices.end(),
                                      [&](int v) {
                                        return (m_skin[v] - arm.elbow).dot(arm.down.normalized()) <
                                               arm.begins;
                                      }),
                       arm.vertices.end());
  }
}

std::vector<Vec3> Forearms::drawn_in(std::vector<Vec3> skin) const {
  for (const Arm& arm : m_arms) {
    const Vec3 end = arm.elbow + arm.begins * arm.down.normalized();
    for (int v : arm.vertices)
      skin[v] = end + DRAWN_IN * (skin[v] - end);
  }
  return skin;
}

std::vector<char> hanging_on_arms(const Bind& bind) {
  std::vector<char> on_arms(bind.particles.size(), 0);
  for (std::size_t i = 0; i < on_arms.size(); ++i) {
    double weight = 0;
    for (const BindWeight& w : bind.particles[i])
      if (bind.frames[w.frame].find("arm") != std::string::npos)
        weight += w.weight;
    on_arms[i] = weight > ON_ARM;
  }
  return on_arms;
}

std::size_t bring_under_arms(std::vector<Vec3>& positions, const std::vector<char>& on_arms,
                             const body::Body& body, double gap) {
  std::vector<std::size_t> hanging; // on trunk and legs alone
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!on_arms[i]) {
      hanging.push_back(i);
      points.push_back(positions[i]);
    }
  const Forearms forearms(body);
  if (hanging.empty() || !forearms.are_near(points))
    return 0;
  const ExtremityHulls covered(body, ExtremityHulls::HANDS);
  std::vector<Triangle> outer = forearms.triangles(), inner;
  for (std::size_t f = 0; f < covered.mesh().triangles.size(); ++f) {
    const Triangle& t = covered.mesh().triangles[f];
    if (f >= body.skin.triangles.size())
      outer.push_back(t); // a mitten
    else if (const body::Part p = body.face_part[f];
             p == body::Part::TORSO || p == body::Part::LEG_L || p == body::Part::LEG_R)
      inner.push_back(t);
  }
  const collision::TriangleTree arms(covered.mesh().positions, outer),
      within(covered.mesh().positions, inner);
  std::size_t moved = 0;
  for (std::size_t i : hanging) {
    const collision::ClosestPoint from = within.closest_point(positions[i], REACH);
    if (from.triangle < 0)
      continue;
    const Vec3 line = positions[i] - from.point;
    const double length = line.norm();
    if (length <= 0)
      continue;
    const double seen = length + gap,
                 hit = seen * arms.first_hit(from.point, from.point + seen / length * line);
    if (!(hit < seen))
      continue;
    positions[i] = from.point + std::max(hit - gap, 0.5 * hit) / length * line;
    ++moved;
  }
  return moved;
}

} // namespace sloper::garment
