#include <geos_c.h>
#include <pattern/mesh/flat_delaunay.hpp>
#include <pattern/mesh/smallest_angle.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <map>
#include <memory>

namespace sloper::pattern {
namespace {

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Positive when d lies inside the circle through the counter-clockwise a, b, c.
double in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 p = a - d, q = b - d, r = c - d;
  return p.squaredNorm() * (q.x() * r.y() - q.y() * r.x()) -
         q.squaredNorm() * (p.x() * r.y() - p.y() * r.x()) +
         r.squaredNorm() * (p.x() * q.y() - p.y() * q.x());
}

/// GEOS handles, released in order.
struct Geos {
  GEOSContextHandle_t context = GEOS_init_r();
  std::string message;
  Geos() {
    GEOSContext_setErrorMessageHandler_r(
        context, [](const char* text, void* self) { static_cast<Geos*>(self)->message = text; },
        this);
  }
  ~Geos() { GEOS_finish_r(context); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;
};

GEOSGeometry* ring(Geos& geos, const std::vector<Vec2>& loop) {
  GEOSCoordSequence* points =
      GEOSCoordSeq_create_r(geos.context, static_cast<unsigned>(loop.size() + 1), 2);
  for (std::size_t k = 0; k <= loop.size(); ++k)
    GEOSCoordSeq_setXY_r(geos.context, points, static_cast<unsigned>(k), loop[k % loop.size()].x(),
                         loop[k % loop.size()].y());
  return GEOSGeom_createLinearRing_r(geos.context, points);
}

/// Corners of the triangles of the polygon, as GEOS finds them.
std::vector<std::array<Vec2, 3>> geos_triangles(const std::vector<std::vector<Vec2>>& loops,
                                                const std::string& panel) {
  Geos geos;
  const auto destroy = [&](GEOSGeometry* g) { GEOSGeom_destroy_r(geos.context, g); };
  using Handle = std::unique_ptr<GEOSGeometry, decltype(destroy)>;
  std::vector<GEOSGeometry*> holes;
  for (std::size_t k = 1; k < loops.size(); ++k)
    holes.push_back(ring(geos, loops[k]));
  const Handle polygon(GEOSGeom_createPolygon_r(geos.context, ring(geos, loops[0]), holes.data(),
                                                static_cast<unsigned>(holes.size())),
                       destroy);
  if (!polygon)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", panel,
                "no polygon: " + geos.message);
  if (GEOSisValid_r(geos.context, polygon.get()) != 1) {
    char* reason = GEOSisValidReason_r(geos.context, polygon.get());
    const std::string why = reason ? reason : "not valid";
    GEOSFree_r(geos.context, reason);
    throw input_error("pattern.outline-crosses"_id, "", panel,
                      "the outline crosses or touches itself (" + why + " m)",
                      "run pattern-mesh --check for the edges");
  }
  const Handle found(GEOSConstrainedDelaunayTriangulation_r(geos.context, polygon.get()), destroy);
  if (!found)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", panel,
                "no triangulation: " + geos.message);
  std::vector<std::array<Vec2, 3>> out;
  for (int k = 0, n = GEOSGetNumGeometries_r(geos.context, found.get()); k < n; ++k) {
    const GEOSGeometry* outer =
        GEOSGetExteriorRing_r(geos.context, GEOSGetGeometryN_r(geos.context, found.get(), k));
    const GEOSCoordSequence* points = GEOSGeom_getCoordSeq_r(geos.context, outer);
    std::array<Vec2, 3> corners;
    for (unsigned i = 0; i < 3; ++i)
      GEOSCoordSeq_getXY_r(geos.context, points, i, &corners[i].x(), &corners[i].y());
    out.push_back(corners);
  }
  return out;
}

} // namespace

FlatDelaunay::FlatDelaunay(const std::vector<std::vector<Vec2>>& loops, const std::string& panel) {
  std::map<std::pair<double, double>, int> number;
  for (const auto& loop : loops)
    for (const Vec2& p : loop)
      number.emplace(std::pair(p.x(), p.y()), add_point(p));
  m_n_boundary = static_cast<int>(m_points.size());
  std::map<std::pair<int, int>, std::pair<int, int>> open; // directed edge -> face, k
  for (const auto& corners : geos_triangles(loops, panel)) {
    Face face;
    for (int i = 0; i < 3; ++i) {
      const auto it = number.find({corners[i].x(), corners[i].y()});
      if (it == number.end())
        throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", panel,
                    "the triangulation has a point of its own");
      face.v[i] = it->second;
      face.next[i] = -1;
    }
    if (cross(m_points[face.v[0]], m_points[face.v[1]], m_points[face.v[2]]) < 0)
      std::swap(face.v[1], face.v[2]);
    const int f = std::ssize(m_faces);
    m_faces.push_back(face);
    for (int k = 0; k < 3; ++k) {
      const int a = face.v[(k + 1) % 3], b = face.v[(k + 2) % 3];
      m_face_of[face.v[k]] = f;
      const auto twin = open.find({b, a});
      if (twin == open.end())
        open[{a, b}] = {f, k};
      else
        link(f, k, twin->second.first, twin->second.second);
    }
  }
  legalize_all();
}

int FlatDelaunay::add_point(const Vec2& p) {
  m_points.push_back(p);
  m_dead.push_back(0);
  m_pinned.push_back(0);
  m_face_of.push_back(-1);
  return static_cast<int>(m_points.size()) - 1;
}

void FlatDelaunay::link(int face, int k, int other, int other_k) {
  m_faces[face].next[k] = other;
  if (other >= 0)
    m_faces[other].next[other_k] = face;
}

int FlatDelaunay::index_in(int face, int vertex) const {
  const Face& f = m_faces[face];
  if (f.v[0] == vertex)
    return 0;
  return f.v[1] == vertex ? 1 : 2;
}

int FlatDelaunay::locate(const Vec2& p) const {
  const auto outside = [&](int f, int k) {
    const Face& face = m_faces[f];
    return cross(m_points[face.v[(k + 1) % 3]], m_points[face.v[(k + 2) % 3]], p) < 0;
  };
  int f = m_last;
  for (std::size_t steps = 0; steps < 200 && f >= 0 && m_faces[f].alive; ++steps) {
    int side = -1;
    for (int k = 0; k < 3 && side < 0; ++k)
      if (outside(f, k))
        side = k;
    if (side < 0)
      return m_last = f;
    f = m_faces[f].next[side];
  }
  // The straight walk left the polygon: look at every face.
  for (f = 0; f < std::ssize(m_faces); ++f)
    if (m_faces[f].alive && !outside(f, 0) && !outside(f, 1) && !outside(f, 2))
      return m_last = f;
  return -1;
}

int FlatDelaunay::insert(const Vec2& p, bool pinned) {
  const int f = locate(p);
  if (f < 0)
    return -1;
  for (int k = 0; pinned && k < 3; ++k) {
    // Lattice points are kept clear of lines; points of lines may meet others, and flips do not
    // mend a face without area whose long edge is of a line or of the outline.
    constexpr double NEAR = 0.02; // of the edge; a line is bent by at most 0.3 mm on a 15 mm mesh
    const Face& face = m_faces[f];
    const int a = face.v[(k + 1) % 3], b = face.v[(k + 2) % 3];
    const double edge = (m_points[b] - m_points[a]).norm();
    if ((p - m_points[a]).norm() < NEAR * edge)
      return a;
    if (cross(m_points[a], m_points[b], p) > NEAR * edge * edge ||
        !(face.next[k] < 0 || is_kept(a, b)))
      continue;
    if ((p - m_points[b]).norm() < NEAR * edge)
      return b;
    if (face.next[k] < 0)
      return -1;
    const int v = add_point(p);
    split_edge(f, k, v);
    return v;
  }
  const int v = add_point(p);
  m_pinned.back() = pinned;
  split_face(f, v);
  return v;
}

bool FlatDelaunay::connected(int a, int b) const {
  std::vector<int> faces;
  star(a, faces);
  return std::any_of(faces.begin(), faces.end(), [&](int f) {
    const Face& face = m_faces[f];
    return face.v[0] == b || face.v[1] == b || face.v[2] == b;
  });
}

void FlatDelaunay::keep(int a, int b, int depth) {
  if (connected(a, b)) {
    m_kept.insert({std::min(a, b), std::max(a, b)});
    return;
  }
  if (depth == 0)
    return;
  const int middle = insert(0.5 * (m_points[a] + m_points[b]), true);
  if (middle < 0 || middle == a || middle == b)
    return;
  keep(a, middle, depth - 1);
  keep(middle, b, depth - 1);
}

void FlatDelaunay::add_line(const std::vector<Vec2>& points) {
  std::vector<int> ids;
  for (const Vec2& p : points) {
    const auto end = m_points.begin() + m_n_boundary;
    const auto on = std::find_if(m_points.begin(), end,
                                 [&](const Vec2& q) { return (p - q).squaredNorm() < 1e-18; });
    if (on != end)
      ids.push_back(static_cast<int>(on - m_points.begin()));
    else
      ids.push_back(insert(p, true)); // the point of a line that is met again is used again
  }
  for (std::size_t k = 0; k + 1 < ids.size(); ++k)
    if (ids[k] >= 0 && ids[k + 1] >= 0 && ids[k] != ids[k + 1])
      keep(ids[k], ids[k + 1], 2);
}

void FlatDelaunay::split_face(int face, int vertex) {
  const Face old = m_faces[face];
  const int f[3] = {face, static_cast<int>(m_faces.size()), static_cast<int>(m_faces.size()) + 1};
  m_faces.resize(m_faces.size() + 2);
  std::vector<std::pair<int, int>> stack;
  for (int k = 0; k < 3; ++k) { // face k keeps the edge opposite old corner k
    Face& g = m_faces[f[k]];
    g.v[0] = vertex;
    g.v[1] = old.v[(k + 1) % 3];
    g.v[2] = old.v[(k + 2) % 3];
    g.next[0] = old.next[k];
    g.next[1] = f[(k + 1) % 3];
    g.next[2] = f[(k + 2) % 3];
    g.alive = true;
    m_face_of[g.v[1]] = f[k];
    stack.push_back({f[k], 0});
  }
  for (int k = 0; k < 3; ++k)
    if (old.next[k] >= 0) {
      Face& n = m_faces[old.next[k]];
      for (int i = 0; i < 3; ++i)
        if (n.next[i] == face && n.v[i] != old.v[0] && n.v[i] != old.v[1] && n.v[i] != old.v[2] &&
            n.v[(i + 1) % 3] == old.v[(k + 2) % 3])
          n.next[i] = f[k];
    }
  m_face_of[vertex] = face;
  legalize(stack);
}

void FlatDelaunay::split_edge(int face, int k, int vertex) {
  const int other = m_faces[face].next[k];
  const Face old = m_faces[face], twin = m_faces[other];
  int j = 0;
  while (twin.next[j] != face || twin.v[(j + 1) % 3] != old.v[(k + 2) % 3])
    ++j;
  const int apex = old.v[k], a = old.v[(k + 1) % 3], b = old.v[(k + 2) % 3], below = twin.v[j];
  if (is_kept(a, b)) { // in two from now on
    m_kept.erase({std::min(a, b), std::max(a, b)});
    m_kept.insert({std::min(a, vertex), std::max(a, vertex)});
    m_kept.insert({std::min(b, vertex), std::max(b, vertex)});
    m_pinned[vertex] = 1;
  }
  const int f2 = static_cast<int>(m_faces.size()), f3 = f2 + 1;
  m_faces.resize(m_faces.size() + 2);
  const auto set = [&](int f, int v0, int v1, int v2, int n0, int n1, int n2) {
    m_faces[f] = Face{{v0, v1, v2}, {n0, n1, n2}, true};
    for (int v : {v0, v1, v2})
      m_face_of[v] = f;
  };
  const auto relink = [&](int neighbour, int from, int to, int v1, int v2) {
    if (neighbour < 0)
      return;
    Face& n = m_faces[neighbour];
    for (int i = 0; i < 3; ++i)
      if (n.next[i] == from && n.v[(i + 1) % 3] == v1 && n.v[(i + 2) % 3] == v2)
        n.next[i] = to;
  };
  const int n_bA = old.next[(k + 1) % 3], n_Aa = old.next[(k + 2) % 3]; // across b-apex and apex-a
  const int n_aB = twin.next[(j + 1) % 3],
            n_Bb = twin.next[(j + 2) % 3]; // twin corners: below, b, a; across a-below and below-b
  set(face, apex, a, vertex, other, f2, n_Aa);
  set(f2, apex, vertex, b, f3, n_bA, face);
  set(other, below, vertex, a, face, n_aB, f3);
  set(f3, below, b, vertex, f2, other, n_Bb);
  relink(n_bA, face, f2, apex, b);
  relink(n_Bb, other, f3, b, below);
  std::vector<std::pair<int, int>> stack = {{face, 2}, {f2, 1}, {other, 1}, {f3, 2}};
  legalize(stack);
}

bool FlatDelaunay::wants_flip(int face, int k) const {
  const Face& f = m_faces[face];
  const int other = f.next[k];
  if (other < 0)
    return false;
  const Face& g = m_faces[other];
  int j = 0;
  while (j < 3 && (g.next[j] != face || g.v[(j + 1) % 3] != f.v[(k + 2) % 3]))
    ++j;
  if (j == 3)
    return false;
  const int p = f.v[k], a = f.v[(k + 1) % 3], b = f.v[(k + 2) % 3], q = g.v[j];
  if (is_kept(a, b))
    return false;
  if (is_chord(p, q) && !is_chord(a, b))
    return false; // never make a boundary-to-boundary edge where there was none
  const Vec2 &P = m_points[p], &A = m_points[a], &B = m_points[b], &Q = m_points[q];
  const double scale = (A - B).squaredNorm();
  if (cross(P, A, Q) <= 1e-9 * scale || cross(P, Q, B) <= 1e-9 * scale)
    return false; // not convex
  return in_circle(P, A, B, Q) > 1e-9 * scale * scale;
}

bool FlatDelaunay::flip(int face, int k) {
  Face& f = m_faces[face];
  const int other = f.next[k];
  Face& g = m_faces[other];
  int j = 0;
  while (g.next[j] != face || g.v[(j + 1) % 3] != f.v[(k + 2) % 3])
    ++j;
  const int p = f.v[k], a = f.v[(k + 1) % 3], b = f.v[(k + 2) % 3], q = g.v[j];
  const int n_bp = f.next[(k + 1) % 3], n_pa = f.next[(k + 2) % 3]; // across b-p, p-a
  const int n_aq = g.next[(j + 1) % 3], n_qb = g.next[(j + 2) % 3]; // g: q, b, a; across a-q, q-b
  const auto relink = [&](int neighbour, int from, int to, int v1, int v2) {
    if (neighbour < 0)
      return;
    Face& n = m_faces[neighbour];
    for (int i = 0; i < 3; ++i)
      if (n.next[i] == from && n.v[(i + 1) % 3] == v1 && n.v[(i + 2) % 3] == v2)
        n.next[i] = to;
  };
  f = Face{{p, a, q}, {n_aq, other, n_pa}, true};
  g = Face{{p, q, b}, {n_qb, n_bp, face}, true};
  relink(n_aq, other, face, q, a);
  relink(n_bp, face, other, p, b);
  m_face_of[p] = face;
  m_face_of[a] = face;
  m_face_of[q] = face;
  m_face_of[b] = other;
  return true;
}

void FlatDelaunay::legalize(std::vector<std::pair<int, int>>& stack) {
  std::size_t budget =
      64 * m_faces.size() +
      1000; // Lawson's flips end by themselves; chord rules must not make them circle
  while (!stack.empty() && budget-- > 0) {
    const auto [face, k] = stack.back();
    stack.pop_back();
    if (!m_faces[face].alive || !wants_flip(face, k))
      continue;
    const int other = m_faces[face].next[k];
    flip(face, k);
    stack.push_back({face, 0});
    stack.push_back({face, 2});
    stack.push_back({other, 0});
    stack.push_back({other, 1});
  }
}

void FlatDelaunay::legalize_all() {
  std::vector<std::pair<int, int>> stack;
  for (int f = static_cast<int>(m_faces.size()) - 1; f >= 0; --f)
    if (m_faces[f].alive)
      for (int k = 0; k < 3; ++k)
        if (wants_flip(f, k))
          stack.push_back({f, k});
  legalize(stack);
}

void FlatDelaunay::star(int vertex, std::vector<int>& faces) const {
  faces.clear();
  const int start = m_face_of[vertex];
  int f = start;
  do { // counter-clockwise; on the boundary it stops at an open edge and the other side is added
       // below
    faces.push_back(f);
    f = m_faces[f].next[(index_in(f, vertex) + 1) % 3];
  } while (f >= 0 && f != start);
  if (f == start)
    return;
  for (f = m_faces[start].next[(index_in(start, vertex) + 2) % 3]; f >= 0;
       f = m_faces[f].next[(index_in(f, vertex) + 2) % 3])
    faces.push_back(f);
}

double FlatDelaunay::star_quality(const std::vector<int>& faces, int vertex, const Vec2& at) const {
  double worst = 10;
  for (int f : faces) {
    const Face& face = m_faces[f];
    const int k = index_in(f, vertex);
    worst = std::min(
        worst, smallest_angle(at, m_points[face.v[(k + 1) % 3]], m_points[face.v[(k + 2) % 3]]));
  }
  return worst;
}

void FlatDelaunay::take(std::vector<Vec2>& points, std::vector<Triangle>& triangles) {
  std::vector<int> number(m_points.size(), -1);
  points.clear();
  triangles.clear();
  for (std::size_t k = 0; k < m_points.size(); ++k)
    if (!m_dead[k]) {
      number[k] = static_cast<int>(points.size());
      points.push_back(m_points[k]);
    }
  for (const Face& f : m_faces)
    if (f.alive)
      triangles.push_back({number[f.v[0]], number[f.v[1]], number[f.v[2]]});
}

} // namespace sloper::pattern
