#pragma once
/// Coarser meshes of the same shape, as users make them before they send a scan: edge collapse by
/// quadric error (Garland and Heckbert 1997), to the better of the two ends and of the middle.
#include <Eigen/Dense>
#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <queue>
#include <set>

namespace sloper::test {

class Decimator {
public:
  explicit Decimator(const TriangleMesh& mesh)
      : m_mesh(mesh), m_quadric(mesh.positions.size(), Quadric::Zero()),
        m_faces(mesh.positions.size()) {
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      const Vec3 n = area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
      if (n.norm() < 1e-15)
        continue;
      const Eigen::Vector4d plane(n.normalized().x(), n.normalized().y(), n.normalized().z(),
                                  -n.normalized().dot(mesh.positions[t[0]]));
      for (const int v : t) {
        m_quadric[v] += n.norm() * plane * plane.transpose();
        m_faces[v].insert(static_cast<int>(f));
      }
    }
    m_stamp.assign(mesh.positions.size(), 0);
    for (const auto& e : edges_of(mesh.triangles))
      push(e[0], e[1]);
  }

  TriangleMesh run(std::size_t wanted_vertices) {
    std::size_t left = m_mesh.positions.size();
    while (left > wanted_vertices && !m_queue.empty()) {
      const Collapse c = m_queue.top();
      m_queue.pop();
      if (m_stamp[c.a] + m_stamp[c.b] != c.stamp || m_faces[c.a].empty() || m_faces[c.b].empty())
        continue;
      if (collapse(c))
        --left;
    }
    return compact();
  }

private:
  using Quadric = Eigen::Matrix4d;
  struct Collapse {
    double cost;
    int a, b, stamp;
    Vec3 to;
    bool operator<(const Collapse& other) const {
      return cost != other.cost ? cost > other.cost : std::pair(a, b) > std::pair(other.a, other.b);
    }
  };

  void push(int a, int b) {
    const Quadric q = m_quadric[a] + m_quadric[b];
    Collapse c{1e300, a, b, m_stamp[a] + m_stamp[b], Vec3::Zero()};
    for (const double w : {0.5, 0.0, 1.0}) {
      const Vec3 p = (1 - w) * m_mesh.positions[a] + w * m_mesh.positions[b];
      const double cost = p.homogeneous().dot(q * p.homogeneous()) +
                          1e-9 * (m_mesh.positions[a] - m_mesh.positions[b]).squaredNorm();
      if (cost < c.cost) {
        c.cost = cost;
        c.to = p;
      }
    }
    m_queue.push(c);
  }

  std::set<int> neighbours(int v) const {
    std::set<int> all;
    for (const int f : m_faces[v])
      for (const int w : m_mesh.triangles[f])
        if (w != v)
          all.insert(w);
    return all;
  }

  bool collapse(const Collapse& c) {
    const std::set<int> of_a = neighbours(c.a), of_b = neighbours(c.b);
    int shared = 0;
    for (const int v : of_a)
      shared += of_b.count(v) != 0;
    if (shared != 2)
      return false; // would fold the surface
    for (const int end : {c.a, c.b})
      for (const int f : m_faces[end]) {
        Triangle t = m_mesh.triangles[f];
        if (std::count(t.begin(), t.end(), c.a) + std::count(t.begin(), t.end(), c.b) > 1)
          continue;
        const Vec3 before =
            area_normal(m_mesh.positions[t[0]], m_mesh.positions[t[1]], m_mesh.positions[t[2]]);
        std::array<Vec3, 3> p;
        for (int k = 0; k < 3; ++k)
          p[k] = t[k] == end ? c.to : m_mesh.positions[t[k]];
        if (before.dot(area_normal(p[0], p[1], p[2])) <= 0.2 * before.squaredNorm() * 0.1)
          return false;
      }
    m_mesh.positions[c.a] = c.to;
    m_quadric[c.a] += m_quadric[c.b];
    for (const int f : std::set<int>(m_faces[c.b])) {
      Triangle& t = m_mesh.triangles[f];
      if (std::count(t.begin(), t.end(), c.a)) {
        for (const int v : t)
          m_faces[v].erase(f);
        continue;
      }
      std::replace(t.begin(), t.end(), c.b, c.a);
      m_faces[c.a].insert(f);
    }
    m_faces[c.b].clear();
    ++m_stamp[c.a];
    for (const int v : neighbours(c.a))
      push(std::min(v, c.a), std::max(v, c.a));
    return true;
  }

  TriangleMesh compact() const {
    TriangleMesh out;
    std::vector<int> number(m_mesh.positions.size(), -1);
    std::set<int> faces;
    for (const auto& of_vertex : m_faces)
      faces.insert(of_vertex.begin(), of_vertex.end());
    for (const int f : faces) {
      Triangle t = m_mesh.triangles[f];
      for (int& v : t) {
        if (number[v] < 0) {
          number[v] = static_cast<int>(out.positions.size());
          out.positions.push_back(m_mesh.positions[v]);
        }
        v = number[v];
      }
      out.triangles.push_back(t);
    }
    return out;
  }

  TriangleMesh m_mesh;
  std::vector<Quadric> m_quadric;
  std::vector<std::set<int>> m_faces;
  std::vector<int> m_stamp;
  std::priority_queue<Collapse> m_queue;
};

inline TriangleMesh decimated(const TriangleMesh& mesh, double share) {
  return Decimator(mesh).run(
      static_cast<std::size_t>(share * static_cast<double>(mesh.positions.size())));
}

/// Every triangle split in four.
inline TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh out;
  out.positions = mesh.positions;
  const auto edges = edges_of(mesh.triangles);
  auto middle = [&](int a, int b) {
    const std::array<int, 2> e{std::min(a, b), std::max(a, b)};
    return static_cast<int>(
        mesh.positions.size() +
        static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), e) - edges.begin()));
  };
  for (const auto& e : edges)
    out.positions.push_back(0.5 * (mesh.positions[e[0]] + mesh.positions[e[1]]));
  for (const Triangle& t : mesh.triangles) {
    const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
    out.triangles.insert(out.triangles.end(),
                         {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
  }
  return out;
}

} // namespace sloper::test
