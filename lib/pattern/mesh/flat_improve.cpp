/// The parts of FlatDelaunay that raise quality: chords split, density evened, points moved.
#include <pattern/mesh/flat_delaunay.hpp>
#include <pattern/mesh/smallest_angle.hpp>
#include <sloper/base/units.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

bool FlatDelaunay::keeps_ear(int face, int k, const std::vector<char>& must_split) const {
  const Face& f = m_faces[face];
  if (f.next[(k + 1) % 3] >= 0 || f.next[(k + 2) % 3] >= 0)
    return false; // not an ear: the chord bounds more than a corner
  const int corner = f.v[k];
  if (must_split[corner])
    return false;
  const Vec2 a = m_points[f.v[(k + 1) % 3]] - m_points[corner];
  const Vec2 b = m_points[f.v[(k + 2) % 3]] - m_points[corner];
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)) < units::radians(50);
}

void FlatDelaunay::split_chords(const std::vector<char>& must_split) {
  for (int round = 0; round < 4; ++round) {
    int n_split = 0;
    for (int f = 0, n = static_cast<int>(m_faces.size()); f < n; ++f)
      for (int k = 0; k < 3; ++k) {
        const Face& face = m_faces[f];
        if (!face.alive || face.next[k] < 0)
          continue;
        const int a = face.v[(k + 1) % 3], b = face.v[(k + 2) % 3];
        if (!is_chord(a, b))
          continue;
        const int other = face.next[k];
        int j = 0;
        while (m_faces[other].next[j] != f)
          ++j;
        if (keeps_ear(f, k, must_split) || keeps_ear(other, j, must_split))
          continue;
        const Vec2 middle = 0.5 * (m_points[a] + m_points[b]);
        split_edge(f, k, add_point(middle));
        ++n_split;
      }
    if (n_split == 0)
      return;
  }
}

void FlatDelaunay::smooth() {
  std::vector<int> faces;
  for (int v = m_n_boundary; v < std::ssize(m_points); ++v) {
    if (m_dead[v] || m_pinned[v])
      continue;
    star(v, faces);
    Vec2 sum = Vec2::Zero();
    double weight = 0;
    for (int f :
         faces) { // optimal Delaunay smoothing (Chen and Xu 2004): circumcentres weighted by area
      const Face& face = m_faces[f];
      const Vec2 &a = m_points[face.v[0]], &b = m_points[face.v[1]], &c = m_points[face.v[2]];
      const Vec2 p = b - a, q = c - a;
      const double area2 = p.x() * q.y() - p.y() * q.x();
      if (!(area2 > 0))
        continue;
      const Vec2 center = a + Vec2(q.y() * p.squaredNorm() - p.y() * q.squaredNorm(),
                                   p.x() * q.squaredNorm() - q.x() * p.squaredNorm()) /
                                  (2 * area2);
      const Vec2 middle = (a + b + c) / 3;
      // The circumcentre of a sliver lies far away; never trust it beyond the triangle's own size.
      const double reach =
          std::sqrt(std::max({p.squaredNorm(), q.squaredNorm(), (p - q).squaredNorm()}));
      Vec2 away = center - middle;
      if (away.norm() > 0.5 * reach)
        away *= 0.5 * reach / away.norm();
      sum += area2 * (middle + away);
      weight += area2;
    }
    if (weight <= 0)
      continue;
    const Vec2 old = m_points[v], target = sum / weight;
    const double before = star_quality(faces, v, old);
    for (double step : {1.0, 0.5, 0.25}) {
      const Vec2 p = old + step * (target - old);
      const double after = star_quality(faces, v, p);
      if (after > std::min(before, units::radians(20))) {
        m_points[v] = p;
        break;
      }
    }
  }
  legalize_all();
}

bool FlatDelaunay::remove(int vertex) {
  // Only corners of three or four faces are taken out: the hole is one triangle, or two.
  std::vector<int> faces;
  star(vertex, faces);
  if (faces.size() == 4) {
    for (int f : faces) { // flip one spoke so that three faces are left
      const int k = (index_in(f, vertex) + 1) % 3, other = m_faces[f].next[k];
      const Face &g = m_faces[f], &o = m_faces[other];
      int j = 0;
      while (o.next[j] != f || o.v[(j + 1) % 3] != g.v[(k + 2) % 3])
        ++j;
      const int p = g.v[k], q = o.v[j], a = g.v[(k + 1) % 3], b = g.v[(k + 2) % 3];
      if (is_chord(p, q) || is_kept(a, b))
        continue;
      if (std::min(smallest_angle(m_points[p], m_points[a], m_points[q]),
                   smallest_angle(m_points[p], m_points[q], m_points[b])) <= 1e-3)
        continue;
      flip(f, k);
      star(vertex, faces);
      break;
    }
  }
  if (faces.size() != 3)
    return false;
  const int f0 = faces[0];
  int ring[3], outer[3];
  for (int i = 0; i < 3; ++i) {
    const Face& g = m_faces[faces[i]];
    const int k = index_in(faces[i], vertex);
    ring[i] = g.v[(k + 1) % 3];
    outer[i] = g.next[k];
  }
  // Faces run counter-clockwise, so the new face is ring[0], ring[1], ring[2]; edge ring[i] -
  // ring[i+1] was outer[i].
  for (int i = 1; i < 3; ++i)
    m_faces[faces[i]].alive = false;
  Face& g = m_faces[f0];
  for (int i = 0; i < 3; ++i) {
    g.v[i] = ring[i];
    g.next[(i + 2) % 3] = outer[i];
    m_face_of[ring[i]] = f0;
    if (outer[i] >= 0) {
      Face& n = m_faces[outer[i]];
      for (int j = 0; j < 3; ++j)
        if (n.v[(j + 1) % 3] == ring[(i + 1) % 3] && n.v[(j + 2) % 3] == ring[i])
          n.next[j] = f0;
    }
  }
  m_dead[vertex] = 1;
  m_last = f0;
  return true;
}

void FlatDelaunay::fix_density(const SizeField& size) {
  std::vector<int> faces;
  for (int v = m_n_boundary; v < std::ssize(m_points); ++v) {
    if (m_dead[v] || m_pinned[v])
      continue;
    star(v, faces);
    if (faces.size() > 4)
      continue; // a corner of three or four faces has angles of 90 degrees and more around it
    bool bridge = false; // taking it out may make a boundary-to-boundary edge
    int n_boundary_ring = 0;
    for (int f : faces)
      n_boundary_ring += on_boundary(m_faces[f].v[(index_in(f, v) + 1) % 3]);
    bridge = n_boundary_ring >= 2;
    if (!bridge)
      remove(v);
  }
  // Edges much longer than asked for, where the lattice left a gap.
  for (int f = 0, n = static_cast<int>(m_faces.size()); f < n; ++f)
    for (int k = 0; k < 3; ++k) {
      const Face& face = m_faces[f];
      if (!face.alive || face.next[k] < 0)
        continue;
      const Vec2 &a = m_points[face.v[(k + 1) % 3]], &b = m_points[face.v[(k + 2) % 3]];
      if ((a - b).norm() > 1.75 * size.at(0.5 * (a + b)))
        split_edge(f, k, add_point(0.5 * (a + b)));
    }
  legalize_all();
}

bool FlatDelaunay::improve_worst(double good_angle) {
  std::vector<int> faces;
  std::vector<char> look(m_points.size(), 0);
  bool any = false, gained = false;
  for (const Face& f : m_faces)
    if (f.alive &&
        smallest_angle(m_points[f.v[0]], m_points[f.v[1]], m_points[f.v[2]]) < good_angle)
      for (int v : f.v)
        if (!on_boundary(v)) {
          look[v] = 1;
          any = true;
        }
  if (!any)
    return false;
  for (int v = m_n_boundary; v < std::ssize(m_points); ++v) {
    if (!look[v] || m_dead[v] || m_pinned[v])
      continue;
    star(v, faces);
    Vec2 best = m_points[v];
    double quality = star_quality(faces, v, best);
    double size = 0;
    for (int f : faces)
      size = std::max(size, (m_points[m_faces[f].v[(index_in(f, v) + 1) % 3]] - best).norm());
    for (double step = 0.25 * size; step > 0.01 * size;) {
      bool moved = false;
      for (int d = 0; d < 8; ++d) {
        const double angle = d * units::PI / 4;
        const Vec2 p = best + step * Vec2(std::cos(angle), std::sin(angle));
        const double q = star_quality(faces, v, p);
        if (q > quality + 1e-6) {
          best = p;
          quality = q;
          moved = gained = true;
        }
      }
      if (!moved)
        step *= 0.5;
    }
    m_points[v] = best;
  }
  legalize_all();
  return gained;
}

} // namespace sloper::pattern
