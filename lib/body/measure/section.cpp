#include <sloper/body/measure/section.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace sloper::body {

namespace {

struct Cut {
  std::uint64_t from, to; ///< mesh edges at the two ends
  Vec2 a, b;
};

std::uint64_t edge_key(int a, int b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b)),
             high = static_cast<std::uint64_t>(std::max(a, b));
  return low << 32 | high;
}

/// Numbers segments by loop: two segments that end on the same mesh edge belong together.
std::vector<int> loop_numbers(const std::vector<Cut>& cuts, std::vector<char>& is_open) {
  DisjointSets joined(cuts.size());
  struct End {
    std::uint64_t key;
    int first; ///< the segment that came first, -1: free
    bool shared;
  };
  std::size_t size = 16;
  while (size < 3 * cuts.size())
    size *= 2;
  std::vector<End> table(size,
                         {0, -1, false}); // at most two thirds full; nothing depends on its order
  auto join = [&](std::uint64_t key, int i) {
    std::size_t at = (key * 0x9E3779B97F4A7C15u >> 32) & (size - 1);
    while (table[at].first >= 0 && table[at].key != key)
      at = (at + 1) & (size - 1);
    End& end = table[at];
    if (end.first < 0) {
      end = {key, i, false};
      return;
    }
    end.shared = true;
    joined.unite(end.first, i);
  };
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    join(cuts[i].from, static_cast<int>(i));
    join(cuts[i].to, static_cast<int>(i));
  }
  std::vector<int> number = joined.numbers();
  const int count = number.empty() ? 0 : 1 + *std::max_element(number.begin(), number.end());
  is_open.assign(static_cast<std::size_t>(count), 0);
  for (const End& end : table) // an end that no other segment shares
    if (end.first >= 0 && !end.shared)
      is_open[number[end.first]] = 1;
  return number;
}

/// The triangle (corners at `p`, numbered `t`) in the plane, where it crosses it.
void cut_triangle(const Triangle& t, const std::array<const Vec3*, 3>& p, const Plane& plane,
                  const Vec3& n, double offset, std::vector<Cut>& cuts) {
  // Which corners lie above is random to the processor: numbers instead of branches.
  constexpr int LONE[8] = {0, 0, 1, 2,
                           2, 1, 0, 0}; // the corner alone on its side, by the bits of those above
  const double d[3] = {n.dot(*p[0]) - offset, n.dot(*p[1]) - offset, n.dot(*p[2]) - offset};
  const int above = (d[0] >= 0) | (d[1] >= 0) << 1 | (d[2] >= 0) << 2;
  if (above == 0 || above == 7)
    return;
  const int lone = LONE[above], two_above = above != 1 << lone;
  auto crossing = [&](int k) {
    const int swapped = t[lone] > t[k]; // the same bits from both triangles of an edge
    const int ends[3] = {lone, k, lone}, a = ends[swapped], b = ends[swapped + 1];
    const double w = d[a] / (d[a] - d[b]);
    return plane.flat(*p[a] + w * (*p[b] - *p[a]));
  };
  const int from = (lone + 1 + two_above) % 3, to = (lone + 2 - two_above) % 3;
  cuts.push_back(
      {edge_key(t[lone], t[from]), edge_key(t[lone], t[to]), crossing(from), crossing(to)});
}

/// The segments as loops, the one with the largest |area| first.
std::vector<Loop> joined(const std::vector<Cut>& cuts) {
  if (cuts.empty())
    return {};
  std::vector<char> is_open;
  const std::vector<int> number = loop_numbers(cuts, is_open);
  std::vector<Loop> loops(is_open.size());
  for (std::size_t k = 0; k < loops.size(); ++k)
    loops[k].closed = !is_open[k];
  std::vector<std::size_t> sizes(loops.size(), 0);
  for (const int loop : number)
    ++sizes[loop];
  for (std::size_t k = 0; k < loops.size(); ++k)
    loops[k].segments.reserve(sizes[k]);
  for (std::size_t i = 0; i < cuts.size(); ++i)
    loops[number[i]].segments.push_back({cuts[i].a, cuts[i].b});
  for (Loop& loop : loops)
    measure_loop(loop);
  std::erase_if(loops, [](const Loop& loop) { return std::abs(loop.area) < 1e-6; });
  std::stable_sort(loops.begin(), loops.end(), [](const Loop& a, const Loop& b) {
    return std::abs(a.area) > std::abs(b.area);
  });
  return loops;
}

} // namespace

void measure_loop(Loop& loop) {
  if (loop.segments.empty())
    return;
  const Vec2 o = loop.segments.front()[0];
  Vec2 moment = Vec2::Zero();
  double twice = 0;
  for (const auto& s : loop.segments) {
    const Vec2 a = s[0] - o, b = s[1] - o;
    const double c = a.x() * b.y() - a.y() * b.x();
    twice += c;
    moment += c * (a + b);
    loop.low = loop.low.cwiseMin(s[0]).cwiseMin(s[1]);
    loop.high = loop.high.cwiseMax(s[0]).cwiseMax(s[1]);
  }
  loop.area = 0.5 * twice;
  loop.centroid = std::abs(twice) > 1e-12 ? Vec2(o + moment / (3 * twice)) : loop.center();
  loop.centroid =
      loop.centroid.cwiseMax(loop.low).cwiseMin(loop.high); // an open outline can throw it far off
}

Plane level_plane(double height) {
  // (x, z) has the normal -y; cut() keeps the body on the left of a segment all the same
  return {Vec3(0, height, 0), Vec3::UnitX(), Vec3::UnitZ()};
}

Plane cross_plane(const Vec3& origin, const Vec3& axis) {
  const Vec3 n = axis.normalized();
  Vec3 u = Vec3::UnitY().cross(n);
  if (u.norm() < 1e-3)
    u = Vec3::UnitX() - n.x() * n;
  u.normalize();
  return {origin, u, n.cross(u)};
}

std::vector<Loop> cut(const TriangleMesh& mesh, const Plane& plane,
                      const std::vector<int>* subset) {
  const Vec3 n = plane.normal();
  const double offset = n.dot(plane.origin);
  std::vector<Cut> cuts;
  cuts.reserve(512);
  const std::size_t total = subset ? subset->size() : mesh.triangles.size();
  for (std::size_t i = 0; i < total; ++i) {
    const Triangle& t = mesh.triangles[subset ? (*subset)[i] : i];
    cut_triangle(t, {&mesh.positions[t[0]], &mesh.positions[t[1]], &mesh.positions[t[2]]}, plane, n,
                 offset, cuts);
  }
  return joined(cuts);
}

TriangleSpheres::TriangleSpheres(const TriangleMesh& mesh, const std::vector<int>& subset) {
  m_spheres.reserve(subset.size());
  for (const int t : subset) {
    const Vec3 &a = mesh.positions[mesh.triangles[t][0]], &b = mesh.positions[mesh.triangles[t][1]],
               &c = mesh.positions[mesh.triangles[t][2]];
    const Vec3 center = (a + b + c) / 3;
    const double squared = std::max(
        {(a - center).squaredNorm(), (b - center).squaredNorm(), (c - center).squaredNorm()});
    m_spheres.push_back({center, 1.000001 * std::sqrt(squared) + 1e-9, t});
  }
}

const std::vector<int>& TriangleSpheres::near(const Plane& plane) {
  const Vec3 n = plane.normal();
  const double offset = n.dot(plane.origin);
  m_near.clear();
  for (const Sphere& s : m_spheres)
    if (std::abs(n.dot(s.center) - offset) <= s.radius)
      m_near.push_back(s.triangle);
  return m_near;
}

LevelledMesh::LevelledMesh(const TriangleMesh& mesh, double y0, double dy, int count)
    : m_first(static_cast<std::size_t>(count) + 2, 0) {
  constexpr float OUTWARDS = 1e-6f; // m: more than what a float rounds at the height of a person
  auto band_of = [&](double y) {
    return std::clamp(static_cast<int>(std::floor((y - y0) / dy)), 0, count - 1);
  };
  std::vector<std::size_t> first(static_cast<std::size_t>(count) + 1, 0);
  for (const Vec3& p : mesh.positions)
    ++first[static_cast<std::size_t>(band_of(p.y())) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  m_vertices.resize(mesh.positions.size());
  std::vector<int> place(mesh.positions.size());
  for (std::size_t v = 0; v < place.size(); ++v) {
    const std::size_t at = first[static_cast<std::size_t>(band_of(mesh.positions[v].y()))]++;
    m_vertices[at] = {mesh.positions[v], static_cast<int>(v)};
    place[v] = static_cast<int>(at);
  }
  struct Bands {
    float low, high; // m, outwards
    int from, to;
  };
  std::vector<Bands> bands;
  bands.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const double a = mesh.positions[t[0]].y(), b = mesh.positions[t[1]].y(),
                 c = mesh.positions[t[2]].y();
    const double low = std::min({a, b, c}), high = std::max({a, b, c});
    const int from = std::max(0, static_cast<int>(std::floor((low - y0) / dy)));
    const int to = std::min(count - 1, static_cast<int>(std::ceil((high - y0) / dy)));
    bands.push_back(
        {static_cast<float>(low) - OUTWARDS, static_cast<float>(high) + OUTWARDS, from, to});
    for (int k = from; k <= to; ++k)
      ++m_first[static_cast<std::size_t>(k) + 2];
  }
  std::partial_sum(m_first.begin(), m_first.end(), m_first.begin());
  m_reaches.resize(m_first.back());
  // a band's first place is counted on in the entry after it, which then is the next one's first
  for (std::size_t f = 0; f < bands.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    for (int k = bands[f].from; k <= bands[f].to; ++k)
      m_reaches[m_first[static_cast<std::size_t>(k) + 1]++] = {
          bands[f].low, bands[f].high, {place[t[0]], place[t[1]], place[t[2]]}};
  }
  m_first.pop_back();
}

std::vector<Loop> LevelledMesh::cut(int band, double y) const {
  const Plane plane = level_plane(y);
  const Vec3 n = plane.normal();
  const double offset = n.dot(plane.origin);
  const float level = static_cast<float>(y);
  std::vector<Cut> cuts;
  cuts.reserve(512);
  for (std::size_t i = m_first[band]; i < m_first[static_cast<std::size_t>(band) + 1]; ++i) {
    const Reach& r = m_reaches[i];
    if (r.low > level || r.high < level)
      continue;
    const Vertex &a = m_vertices[r.vertices[0]], &b = m_vertices[r.vertices[1]],
                 &c = m_vertices[r.vertices[2]];
    cut_triangle({a.number, b.number, c.number}, {&a.position, &b.position, &c.position}, plane, n,
                 offset, cuts);
  }
  return joined(cuts);
}

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  if (points.size() < 3)
    return points;
  std::vector<Vec2> hull(2 * points.size());
  std::size_t k = 0;
  auto turn = [](const Vec2& o, const Vec2& a, const Vec2& b) {
    return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
  };
  for (const Vec2& p : points) {
    while (k >= 2 && turn(hull[k - 2], hull[k - 1], p) <= 0)
      --k;
    hull[k++] = p;
  }
  const std::size_t lower = k + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    while (k >= lower && turn(hull[k - 2], hull[k - 1], points[i]) <= 0)
      --k;
    hull[k++] = points[i];
  }
  hull.resize(k - 1);
  return hull;
}

double closed_length(const std::vector<Vec2>& polygon) {
  double length = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    length += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  return length;
}

double taut_girth(const Loop& loop) {
  std::vector<Vec2> points;
  points.reserve(loop.segments.size());
  for (const auto& s : loop.segments)
    points.push_back(s[0]);
  return closed_length(convex_hull(std::move(points)));
}

std::optional<std::array<Vec2, 2>> clipped(const std::array<Vec2, 2>& segment, int axis, double low,
                                           double high) {
  const double a = segment[0][axis], b = segment[1][axis];
  if (std::max(a, b) < low || std::min(a, b) > high)
    return std::nullopt;
  auto at = [&](double end, const Vec2& q) {
    const double to = std::clamp(end, low, high);
    return to == end ? q : Vec2(segment[0] + (to - a) / (b - a) * (segment[1] - segment[0]));
  };
  return std::array<Vec2, 2>{at(a, segment[0]), at(b, segment[1])};
}

Vec2 outermost(const Loop& loop, const Vec2& direction, double flat) {
  double most = -1e300;
  for (const auto& segment : loop.segments)
    most = std::max(most, direction.dot(segment[0]));
  Vec2 sum = Vec2::Zero();
  double weight = 0;
  for (const auto& segment : loop.segments) {
    const double a = direction.dot(segment[0]) - most + flat,
                 b = direction.dot(segment[1]) - most + flat;
    if (a <= 0 && b <= 0)
      continue;
    const double length = (segment[1] - segment[0]).norm();
    constexpr int PIECES = 8; // a segment of a coarse mesh may be longer than the flat part
    for (int k = 0; k < PIECES; ++k) {
      const double t = (k + 0.5) / PIECES, w = ((1 - t) * a + t * b) * length;
      if (w > 0) {
        sum += w * ((1 - t) * segment[0] + t * segment[1]);
        weight += w;
      }
    }
  }
  if (weight <= 0)
    return loop.centroid;
  const Vec2 middle = sum / weight;
  return middle + (most - direction.dot(middle)) * direction;
}

bool encloses(const Loop& loop, const Vec2& q) {
  if ((q - loop.low).minCoeff() < 0 || (loop.high - q).minCoeff() < 0)
    return false;
  int winding = 0;
  for (const auto& s : loop.segments) {
    const Vec2 a = s[0] - q, b = s[1] - q;
    const double c = a.x() * b.y() - a.y() * b.x();
    if (a.y() <= 0 && b.y() > 0 && c > 0)
      ++winding;
    if (a.y() > 0 && b.y() <= 0 && c < 0)
      --winding;
  }
  return winding != 0;
}

} // namespace sloper::body
