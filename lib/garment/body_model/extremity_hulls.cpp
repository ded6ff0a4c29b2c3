#include <sloper/collision/predicates.hpp>
#include <sloper/garment/body_model/extremity_hulls.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace sloper::garment {

namespace {

constexpr double OFF_THE_SKIN = 0.001; // m: the shell does not touch the skin in it
constexpr double BESIDE = 0.15;        // m from the line through a hand or foot
constexpr double BALL = 0.6;           // of a foot, from heel to tip: toes part before it

struct Place {
  double along, beside; // m, of the line from root to tip
};

Place place_of(const Vec3& p, const Vec3& root, const Vec3& tip) {
  const Vec3 direction = (tip - root).normalized();
  const double along = (p - root).dot(direction);
  return {along, (p - root - along * direction).norm()};
}

bool sees(const std::vector<Vec3>& p, const Triangle& t, int v) {
  return collision::orientation(p[t[0]], p[t[1]], p[t[2]], p[v]) < 0;
}

} // namespace

std::vector<Triangle> convex_hull_of(const std::vector<Vec3>& p) {
  const int n = std::ssize(p);
  if (n < 4)
    return {};
  // a first tetrahedron of points far apart
  int a = 0, b = 0, c = 0, d = -1;
  for (int i = 0; i < n; ++i)
    if ((p[i] - p[a]).squaredNorm() > (p[b] - p[a]).squaredNorm())
      b = i;
  double widest = 0, highest = 0;
  for (int i = 0; i < n; ++i)
    if (const double area = (p[b] - p[a]).cross(p[i] - p[a]).squaredNorm(); area > widest) {
      widest = area;
      c = i;
    }
  if (!(widest > 0))
    return {};
  for (int i = 0; i < n; ++i)
    if (const double volume = std::abs((p[b] - p[a]).cross(p[c] - p[a]).dot(p[i] - p[a]));
        volume > highest) {
      highest = volume;
      d = i;
    }
  if (d < 0 || collision::orientation(p[a], p[b], p[c], p[d]) == 0)
    return {};
  std::vector<Triangle> hull = {{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}};
  const int inner[4] = {d, b, c, a};
  for (int f = 0; f < 4; ++f)
    if (sees(p, hull[f], inner[f]))
      std::swap(hull[f][1], hull[f][2]);
  for (int v = 0; v < n; ++v) {
    if (v == a || v == b || v == c || v == d)
      continue;
    std::vector<Triangle> kept;
    std::set<std::pair<int, int>> rim;
    for (const Triangle& t : hull) {
      if (!sees(p, t, v)) {
        kept.push_back(t);
        continue;
      }
      for (int k = 0; k < 3; ++k) // an edge between two seen faces comes twice, in both senses
        if (!rim.erase({t[(k + 1) % 3], t[k]}))
          rim.insert({t[k], t[(k + 1) % 3]});
    }
    if (rim.empty())
      continue;
    for (const auto& [from, to] : rim)
      kept.push_back({from, to, v});
    hull = std::move(kept);
  }
  return hull;
}

ExtremityHulls::ExtremityHulls(const body::Body& body, unsigned ends) : m_mesh(body.skin) {
  struct Candidate {
    Ends end;
    body::Part part;
    std::string root, tip;
    double from; // fraction of the length from the root to the tip
  };
  for (const Candidate& c : {Candidate{HANDS, body::Part::ARM_L, "wrist_l", "hand_tip_l", 0},
                             Candidate{HANDS, body::Part::ARM_R, "wrist_r", "hand_tip_r", 0},
                             Candidate{FEET, body::Part::LEG_L, "heel_l", "foot_tip_l", BALL},
                             Candidate{FEET, body::Part::LEG_R, "heel_r", "foot_tip_r", BALL}}) {
    if (!(ends & c.end) || !body.has_landmark(c.root) || !body.has_landmark(c.tip))
      continue;
    Shell shell{c.end, body.landmark(c.root), body.landmark(c.tip)};
    shell.root += c.from * (shell.tip - shell.root);
    std::vector<char> of_end(body.skin.positions.size(), 0);
    for (std::size_t f = 0; f < body.skin.triangles.size(); ++f)
      if (body.face_part[f] == c.part)
        for (int v : body.skin.triangles[f]) {
          const Place at = place_of(body.skin.positions[v], shell.root, shell.tip);
          of_end[v] = at.along > 0 && at.beside < BESIDE;
        }
    std::vector<int> source;
    std::vector<Vec3> points;
    Vec3 middle = Vec3::Zero();
    for (std::size_t v = 0; v < of_end.size(); ++v)
      if (of_end[v]) {
        source.push_back(static_cast<int>(v));
        points.push_back(body.skin.positions[v]);
        middle += points.back();
      }
    const std::vector<Triangle> hull = convex_hull_of(points);
    if (hull.empty())
      continue;
    middle /= static_cast<double>(points.size());
    std::vector<int> index(points.size(), -1);
    for (const Triangle& t : hull)
      for (int v : t) {
        if (index[v] >= 0)
          continue;
        index[v] = static_cast<int>(body.skin.positions.size() + m_source.size());
        m_source.push_back(source[v]);
        m_outward.push_back(OFF_THE_SKIN * (points[v] - middle).normalized());
      }
    for (const Triangle& t : hull)
      m_mesh.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
    m_shells.push_back(shell);
  }
  m_mesh.positions = positions(body.skin.positions);
}

std::vector<Vec3> ExtremityHulls::positions(const std::vector<Vec3>& skin) const {
  std::vector<Vec3> all = skin;
  for (std::size_t i = 0; i < m_source.size(); ++i)
    all.push_back(skin[m_source[i]] + m_outward[i]);
  return all;
}

unsigned ExtremityHulls::concerned(const std::vector<Vec3>& points) const {
  unsigned ends = 0;
  for (const Shell& shell : m_shells)
    for (const Vec3& p : points) {
      const Place at = place_of(p, shell.root, shell.tip);
      if (at.along > -0.02 && at.along < 2 * (shell.tip - shell.root).norm() && at.beside < BESIDE)
        ends |= shell.end;
    }
  return ends;
}

} // namespace sloper::garment
