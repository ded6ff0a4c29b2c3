#include <pattern/mesh/flat_delaunay.hpp>
#include <pattern/mesh/smallest_angle.hpp>
#include <pattern/mesh/triangulate.hpp>
#include <sloper/base/error.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace sloper::pattern {
namespace {

/// Segments of boundary and inner lines in square cells of size h, for distances up to h.
class SegmentGrid {
public:
  SegmentGrid(const std::vector<std::vector<Vec2>>& loops,
              const std::vector<std::vector<Vec2>>& lines, double h)
      : m_h(h) {
    for (const auto& loop : loops)
      for (std::size_t k = 0; k < loop.size(); ++k)
        m_segments.push_back({loop[k], loop[(k + 1) % loop.size()]});
    for (const auto& line : lines)
      for (std::size_t k = 0; k + 1 < line.size(); ++k)
        m_segments.push_back({line[k], line[k + 1]});
    m_low = Vec2::Constant(1e300);
    Vec2 high = Vec2::Constant(-1e300);
    for (const auto& s : m_segments) {
      m_low = m_low.cwiseMin(s[0]);
      high = high.cwiseMax(s[0]);
    }
    m_nx = static_cast<int>((high.x() - m_low.x()) / h) + 1;
    m_ny = static_cast<int>((high.y() - m_low.y()) / h) + 1;
    m_cells.resize(static_cast<std::size_t>(m_nx) * static_cast<std::size_t>(m_ny));
    for (std::size_t k = 0; k < m_segments.size(); ++k) {
      const auto& s = m_segments[k];
      const int x0 = column(std::min(s[0].x(), s[1].x())),
                x1 = column(std::max(s[0].x(), s[1].x()));
      const int y0 = row(std::min(s[0].y(), s[1].y())), y1 = row(std::max(s[0].y(), s[1].y()));
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          m_cells[cell(x, y)].push_back(static_cast<int>(k));
    }
  }
  /// Whether some segment is nearer than d <= h.
  bool nearer(const Vec2& p, double d) const {
    const int cx = column(p.x()), cy = row(p.y());
    for (int y = std::max(0, cy - 1); y <= std::min(m_ny - 1, cy + 1); ++y)
      for (int x = std::max(0, cx - 1); x <= std::min(m_nx - 1, cx + 1); ++x)
        for (int k : m_cells[cell(x, y)]) {
          const auto& s = m_segments[k];
          const Vec2 along = s[1] - s[0];
          const double t = std::clamp((p - s[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
          if ((p - s[0] - t * along).squaredNorm() < d * d)
            return true;
        }
    return false;
  }

private:
  int column(double x) const {
    return std::clamp(static_cast<int>((x - m_low.x()) / m_h), 0, m_nx - 1);
  }
  int row(double y) const {
    return std::clamp(static_cast<int>((y - m_low.y()) / m_h), 0, m_ny - 1);
  }
  std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(m_nx) +
           static_cast<std::size_t>(x);
  }
  double m_h;
  Vec2 m_low;
  int m_nx = 0, m_ny = 0;
  std::vector<std::array<Vec2, 2>> m_segments;
  std::vector<std::vector<int>> m_cells;
};

/// Points of a hexagonal lattice inside the polygon and not nearer than `clearance` to its
/// boundary, row by row, to and fro.
std::vector<Vec2> lattice(const std::vector<std::vector<Vec2>>& loops,
                          const std::vector<std::vector<Vec2>>& lines, double h, double clearance) {
  Vec2 low = Vec2::Constant(1e300), high = Vec2::Constant(-1e300);
  for (const Vec2& p : loops[0]) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const SegmentGrid grid(loops, lines, h);
  const double step_y = h * std::sqrt(0.75);
  const int rows = static_cast<int>((high.y() - low.y()) / step_y) + 1;
  const double first_y = 0.5 * (low.y() + high.y() - (rows - 1) * step_y),
               middle = 0.5 * (low.x() + high.x());
  std::vector<Vec2> points;
  std::vector<double> crossings;
  for (int r = 0; r < rows; ++r) {
    const double y = first_y + r * step_y;
    crossings.clear();
    for (const auto& loop : loops)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2 &a = loop[k], &b = loop[(k + 1) % loop.size()];
        if ((a.y() <= y) != (b.y() <= y))
          crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
    std::sort(crossings.begin(), crossings.end());
    const std::size_t row_start = points.size();
    const double shift = middle + (r % 2 ? 0.5 * h : 0.0);
    for (std::size_t c = 0; c + 1 < crossings.size(); c += 2)
      for (long i = static_cast<long>(std::ceil((crossings[c] - shift) / h));
           shift + static_cast<double>(i) * h < crossings[c + 1]; ++i) {
        const Vec2 p(shift + static_cast<double>(i) * h, y);
        if (!grid.nearer(p, clearance))
          points.push_back(p);
      }
    if (r % 2)
      std::reverse(points.begin() + static_cast<long>(row_start), points.end());
  }
  return points;
}

/// The same for edge lengths that vary: points of the finest lattice, each taken where those taken
/// before leave it room.
std::vector<Vec2> graded_lattice(const std::vector<std::vector<Vec2>>& loops,
                                 const std::vector<std::vector<Vec2>>& lines,
                                 const SizeField& size) {
  constexpr double ROOM = 0.8,
                   CLEARANCE = 0.62; // of the local length; the former gives a lattice's density
  const double cell = size.usual();
  const SegmentGrid grid(loops, lines, cell);
  Vec2 low = loops[0][0];
  for (const Vec2& p : loops[0])
    low = low.cwiseMin(p);
  std::map<std::pair<long, long>, std::vector<Vec2>> taken;
  std::vector<Vec2> points;
  for (const Vec2& p : lattice(loops, lines, size.fine(), CLEARANCE * size.fine())) {
    const double h = size.at(p);
    if (grid.nearer(p, CLEARANCE * h))
      continue;
    const long x = static_cast<long>((p.x() - low.x()) / cell),
               y = static_cast<long>((p.y() - low.y()) / cell);
    bool room = true;
    for (long i = x - 1; i <= x + 1 && room; ++i)
      for (long j = y - 1; j <= y + 1 && room; ++j)
        if (const auto near = taken.find({i, j}); near != taken.end())
          room = std::none_of(near->second.begin(), near->second.end(),
                              [&](const Vec2& q) { return (p - q).norm() < ROOM * h; });
    if (room) {
      taken[{x, y}].push_back(p);
      points.push_back(p);
    }
  }
  return points;
}

/// Where two edges that meet in a corner are sewn to each other, the corner needs three faces or
/// more: two would be welded onto one another. Points on a circle about the corner, nearer than all
/// others, are its Delaunay neighbours.
std::vector<Vec2> fan_points(const std::vector<std::vector<Vec2>>& loops,
                             const std::vector<char>& must_split) {
  std::vector<Vec2> out;
  std::size_t first = 0;
  for (const auto& loop : loops) {
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < n; ++k) {
      if (!must_split[first + k])
        continue;
      const Vec2 corner = loop[k], a = loop[(k + 1) % n] - corner,
                 b = loop[(k + n - 1) % n] - corner;
      double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
      if (angle <= 0)
        continue; // a tip that points inwards has faces enough
      const int count = std::max(2, static_cast<int>(std::ceil(angle * 3 / 3.14159265358979)) - 1);
      const double radius = 0.85 * std::min(a.norm(), b.norm()), start = std::atan2(a.y(), a.x());
      for (int i = 1; i <= count; ++i) {
        const double t = start + angle * i / (count + 1);
        out.push_back(corner + radius * Vec2(std::cos(t), std::sin(t)));
      }
    }
    first += n;
  }
  return out;
}

/// Triangles below 25 degrees that are not a sharp corner's own.
int n_small(const FlatMesh& mesh) {
  int n = 0;
  for (const Triangle& t : mesh.triangles) {
    const bool ear = t[0] < mesh.n_boundary && t[1] < mesh.n_boundary && t[2] < mesh.n_boundary;
    n += !ear && smallest_angle(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]) <
                     25 * 3.14159265358979 / 180;
  }
  return n;
}

/// @param spacing of the lattice of interior points, in edge lengths
FlatMesh attempt(const std::vector<std::vector<Vec2>>& loops,
                 const std::vector<std::vector<Vec2>>& lines, const SizeField& size, double spacing,
                 const std::vector<char>& must_split, const std::string& panel) {
  FlatDelaunay mesh(loops, panel);
  const std::vector<Vec2> fans = fan_points(loops, must_split);
  for (const auto& line : lines)
    mesh.add_line(line);
  for (const Vec2& p : fans)
    mesh.insert(p, true);
  const double h = size.usual();
  for (const Vec2& p : size.uniform() ? lattice(loops, lines, spacing * h, 0.62 * spacing * h)
                                      : graded_lattice(loops, lines, size))
    if (std::none_of(fans.begin(), fans.end(),
                     [&](const Vec2& q) { return (p - q).norm() < 0.7 * size.at(q); }))
      mesh.insert(p);
  mesh.split_chords(must_split);
  for (int round = 0; round < 8; ++round)
    mesh.smooth();
  mesh.split_chords(must_split);
  mesh.fix_density(size);
  for (int round = 0; round < 6; ++round)
    mesh.smooth();
  mesh.split_chords(must_split);
  for (int round = 0; round < 12 && mesh.improve_worst(32 * 3.14159265358979 / 180); ++round) {}
  FlatMesh out;
  out.n_boundary = mesh.n_boundary();
  mesh.take(out.points, out.triangles);
  return out;
}

} // namespace

FlatMesh triangulate(const std::vector<std::vector<Vec2>>& loops, const SizeField& size,
                     const std::vector<char>& must_split, const std::string& panel,
                     const std::vector<std::vector<Vec2>>& lines) {
  FlatMesh best = attempt(loops, lines, size, 1, must_split, panel);
  int least = n_small(best);
  // Strips a row or two wide may not go with the lattice: another spacing often does.
  for (double spacing : {0.9, 0.8, 1.1, 0.7}) {
    if (least == 0 || !size.uniform())
      break;
    FlatMesh other = attempt(loops, lines, size, spacing, must_split, panel);
    if (const int n = n_small(other); n < least) {
      best = std::move(other);
      least = n;
    }
  }
  return best;
}

} // namespace sloper::pattern
