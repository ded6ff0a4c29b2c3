#include <sloper/collision/untangle.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::collision {

namespace {

/// Where N and E are nearly at right angles the gradient has no bound; nothing is gained beyond
/// this.
constexpr double LEAST_COSINE = 0.05;

/// The paper's G for one edge through one face; zero where the faces are parallel or have no area.
Vec3 contour_gradient(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles,
                      const Topology& topology, const EdgeFaceIntersection& hit) {
  const auto [a, b] = topology.edges[hit.edge];
  const Triangle& face = triangles[hit.triangle];
  const Vec3 normal = area_normal(x[face[0]], x[face[1]], x[face[2]]).normalized(),
             along = (x[b] - x[a]).normalized();
  double cosine = along.dot(normal);
  if (std::abs(cosine) < LEAST_COSINE)
    cosine = cosine < 0 ? -LEAST_COSINE : LEAST_COSINE;
  Vec3 gradient = Vec3::Zero();
  for (int g : topology.triangles_of_edge(hit.edge)) {
    const Triangle& t = triangles[g];
    int opposite = t[0];
    for (int v : t)
      if (v != a && v != b)
        opposite = v;
    Vec3 contour = area_normal(x[t[0]], x[t[1]], x[t[2]]).normalized().cross(normal);
    const double length = contour.norm();
    if (!(length > 1e-9))
      continue;
    contour /= length;
    // into the triangle: to the side of the edge where its third corner is
    const Vec3 inward = x[opposite] - x[a];
    if (contour.dot(inward - inward.dot(along) * along) < 0)
      contour = -contour;
    gradient += contour - (2 * along.dot(contour) / cosine) * normal;
  }
  return gradient.allFinite() ? gradient : Vec3(Vec3::Zero());
}

/// Sets of points joined by contour segments, each with a side relative to the root of its set.
class Contours {
public:
  explicit Contours(std::size_t n) : m_parent(n), m_turned(n, 0), m_one_sided(n, 0) {
    for (std::size_t i = 0; i < n; ++i)
      m_parent[i] = static_cast<int>(i);
  }
  int root(int i) const {
    while (m_parent[i] != i)
      i = m_parent[i];
    return i;
  }
  bool turned(int i) const {
    bool turned = false;
    for (; m_parent[i] != i; i = m_parent[i])
      turned ^= m_turned[i];
    return turned;
  }
  bool one_sided(int i) const { return m_one_sided[root(i)]; }
  void join(int i, int j, bool opposite) {
    const int ri = root(i), rj = root(j);
    const bool turn = turned(i) ^ turned(j) ^ opposite;
    if (ri == rj) {
      if (turn)
        m_one_sided[ri] = 1;
      return;
    }
    const int low = std::min(ri, rj), high = std::max(ri, rj);
    m_parent[high] = low;
    m_turned[high] = turn;
    m_one_sided[low] |= m_one_sided[high];
  }

private:
  std::vector<int> m_parent;
  std::vector<char> m_turned, m_one_sided;
};

} // namespace

std::vector<UntanglePair> untangle_directions(const std::vector<Vec3>& x,
                                              const std::vector<Triangle>& triangles,
                                              const Topology& topology, const TriangleTree& tree) {
  std::vector<UntanglePair> pairs;
  for (const EdgeFaceIntersection& hit : edge_face_intersections(x, triangles, topology, tree))
    pairs.push_back({hit, contour_gradient(x, triangles, topology, hit), 0});

  // Two points lie on one contour segment if they are of the same two triangles.
  struct End {
    std::array<int, 2> triangles; ///< lower first
    int point;
    bool lower_has_edge;
  };
  std::vector<End> ends;
  for (int i = 0; i < std::ssize(pairs); ++i)
    for (int g : topology.triangles_of_edge(pairs[i].at.edge)) {
      const int f = pairs[i].at.triangle;
      ends.push_back({{std::min(f, g), std::max(f, g)}, i, g < f});
    }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const End& a, const End& b) { return a.triangles < b.triangles; });
  Contours contours(pairs.size());
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i].triangles == ends[i - 1].triangles)
      contours.join(ends[i - 1].point, ends[i].point,
                    ends[i - 1].lower_has_edge != ends[i].lower_has_edge);

  std::vector<int> number(pairs.size(), -1);
  int n_contours = 0;
  std::vector<Vec3> sum;
  for (int i = 0; i < std::ssize(pairs); ++i) {
    const int root = contours.root(i);
    if (number[root] < 0) {
      number[root] = n_contours++;
      sum.push_back(Vec3::Zero());
    }
    pairs[i].contour = number[root];
    sum[number[root]] += contours.turned(i) ? Vec3(-pairs[i].direction) : pairs[i].direction;
  }
  for (int i = 0; i < std::ssize(pairs); ++i) {
    Vec3 gradient = pairs[i].direction;
    if (!contours.one_sided(i))
      gradient = (contours.turned(i) ? -1.0 : 1.0) * sum[pairs[i].contour];
    pairs[i].direction = gradient / std::sqrt(gradient.squaredNorm() +
                                              0.01); // full length from a gradient of some tenths
  }
  return pairs;
}

std::vector<Vec3> untangle_displacements(const std::vector<UntanglePair>& pairs,
                                         const std::vector<Triangle>& triangles,
                                         const Topology& topology, std::size_t n_vertices,
                                         double step, const std::vector<double>& inverse_mass) {
  std::vector<Vec3> displacement(n_vertices, Vec3::Zero());
  std::vector<double> weight(n_vertices, 0);
  const auto mobility = [&](int v) { return inverse_mass.empty() ? 1.0 : inverse_mass[v]; };
  for (const UntanglePair& pair : pairs) {
    const auto& edge = topology.edges[pair.at.edge];
    const Triangle& face = triangles[pair.at.triangle];
    const double of_edge[2] = {1 - pair.at.t, pair.at.t};
    double edge_gives = 0, face_gives = 0;
    for (int k = 0; k < 2; ++k)
      edge_gives += of_edge[k] * mobility(edge[k]);
    for (int k = 0; k < 3; ++k)
      face_gives += pair.at.barycentric[k] * mobility(face[k]);
    const double total = edge_gives + face_gives;
    if (!(total > 0))
      continue;
    const auto push = [&](int v, double w, const Vec3& d) {
      if (mobility(v) <= 0)
        return;
      displacement[v] += w * d;
      weight[v] += w;
    };
    for (int k = 0; k < 2; ++k)
      push(edge[k], of_edge[k], step * edge_gives / total * pair.direction);
    for (int k = 0; k < 3; ++k)
      push(face[k], pair.at.barycentric[k], -step * face_gives / total * pair.direction);
  }
  for (std::size_t v = 0; v < n_vertices; ++v)
    if (weight[v] > 0)
      displacement[v] /= weight[v];
  return displacement;
}

} // namespace sloper::collision
