#include <body/surface/head_sacs.hpp>

#include <body/surface/mesh_repair.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace sloper::body {

namespace {

constexpr double MAP_CELL = 0.002;   // m, of a depth map
constexpr double BEHIND = 0.002;     // m: skin so little behind the foremost is seen
constexpr double LEAST_SAC = 0.001;  // m2, of a sac
constexpr double LARGEST_HEAD = 0.6; // m: what is larger is no head, and its maps would be large

double area_of(const TriangleMesh& mesh, int face) {
  const Triangle& t = mesh.triangles[face];
  return 0.5 * area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]).norm();
}

/// The head, apart from the rest of the body.
struct Head {
  TriangleMesh mesh; ///< its faces, then triangles across the neck: else one would look in there
  std::vector<int> face; ///< of the skin, of each face of the head

  int faces() const { return std::ssize(face); }
};

/// What one direction sees of the head.
class DepthMap {
public:
  DepthMap(const Head& head, const Vec3& towards) : m_head(head) {
    const Vec3 back = towards.normalized();
    const Vec3 off = std::abs(back.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
    Eigen::Matrix3d axes; // right, up, towards the viewer
    axes.row(0) = off.cross(back).normalized().transpose();
    axes.row(1) = back.cross(Vec3(axes.row(0).transpose())).transpose();
    axes.row(2) = back.transpose();
    Box3 box;
    for (const Vec3& p : head.mesh.positions) {
      m_points.push_back(axes * p / MAP_CELL);
      box.add(m_points.back());
    }
    for (Vec3& p : m_points)
      p -= box.low;
    m_columns = static_cast<int>(box.size().x()) + 1;
    m_rows = static_cast<int>(box.size().y()) + 1;
    m_depth.assign(static_cast<std::size_t>(m_columns) * m_rows, NOTHING);
    for (int f = 0; f < std::ssize(head.mesh.triangles); ++f)
      if (double_area(f) > 0 || f >= head.faces())
        draw(f);
  }

  bool sees(int face) const {
    const Vec3 middle = middle_of(face);
    return double_area(face) > 0 &&
           middle.z() >= m_depth[cell(static_cast<int>(middle.x()), static_cast<int>(middle.y()))] -
                             BEHIND / MAP_CELL;
  }

private:
  static double cross(const Vec3& u, const Vec3& v) { return u.x() * v.y() - u.y() * v.x(); }
  std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * m_columns + column;
  }
  const Vec3& corner(int face, int k) const { return m_points[m_head.mesh.triangles[face][k]]; }
  /// As the viewer sees it; negative from behind.
  double double_area(int face) const {
    return cross(corner(face, 1) - corner(face, 0), corner(face, 2) - corner(face, 0));
  }
  Vec3 middle_of(int face) const {
    return (corner(face, 0) + corner(face, 1) + corner(face, 2)) / 3;
  }
  void put(int column, int row, double depth) {
    double& most = m_depth[cell(column, row)];
    most = std::max(most, depth);
  }

  /// Cells whose middle the triangle covers, and the one that its own middle lies in.
  void draw(int face) {
    const Vec3 &a = corner(face, 0), &b = corner(face, 1), &c = corner(face, 2);
    const Vec3 middle = middle_of(face), low = a.cwiseMin(b).cwiseMin(c),
               high = a.cwiseMax(b).cwiseMax(c), depth(a.z(), b.z(), c.z());
    put(static_cast<int>(middle.x()), static_cast<int>(middle.y()), middle.z());
    const double whole = double_area(face);
    if (whole == 0)
      return;
    // cells whose middle lies between low and high
    const int first = static_cast<int>(low.x() + 0.5), last = static_cast<int>(high.x() - 0.5);
    for (int row = static_cast<int>(low.y() + 0.5); row <= static_cast<int>(high.y() - 0.5); ++row)
      for (int column = first; column <= last; ++column) {
        const Vec3 p(column + 0.5, row + 0.5, 0);
        const Vec3 share =
            Vec3(cross(b - p, c - p), cross(c - p, a - p), cross(a - p, b - p)) / whole;
        if (share.minCoeff() >= 0)
          put(column, row, share.dot(depth));
      }
  }

  static constexpr double NOTHING = std::numeric_limits<double>::lowest();
  const Head& m_head;
  std::vector<Vec3> m_points; // in cells: right, up, towards the viewer
  int m_columns = 0, m_rows = 0;
  std::vector<double> m_depth;
};

/// The faces of the skin that no direction sees; none where they would be no sac.
std::vector<char> unseen_faces(const TriangleMesh& skin, const Head& head) {
  std::vector<char> unseen(skin.triangles.size(), 0);
  std::vector<int> left(head.face.size());
  std::iota(left.begin(), left.end(), 0);
  // the sides of a cube, then its corners, then its edges
  for (const int nonzero : {1, 3, 2})
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (x * x + y * y + z * z != nonzero)
            continue;
          const DepthMap map(head, Vec3(x, y, z));
          std::erase_if(left, [&](int f) { return map.sees(f); });
          double area = 0;
          for (const int f : left)
            area += area_of(head.mesh, f);
          if (area < LEAST_SAC)
            return unseen;
        }
  for (const int f : left)
    unseen[head.face[f]] = 1;
  return unseen;
}

/// Sets of faces that neighbour over an edge and are alike in `kind`.
DisjointSets alike_pieces(const std::vector<HalfEdge>& edges, const std::vector<char>& kind) {
  DisjointSets pieces(kind.size());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    if (edges[i].key == edges[i + 1].key && kind[edges[i].face] == kind[edges[i + 1].face])
      pieces.unite(edges[i].face, edges[i + 1].face);
  return pieces;
}

/// Edges between a sac and the skin that stays, in the direction of the sac's face. Sorted.
std::vector<std::array<int, 2>> rim_of(const std::vector<HalfEdge>& edges,
                                       const std::vector<char>& is_sac) {
  std::vector<std::array<int, 2>> rim;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (edges[i].key != edges[i + 1].key || is_sac[edges[i].face] == is_sac[edges[i + 1].face])
      continue;
    const HalfEdge& of_sac = is_sac[edges[i].face] ? edges[i] : edges[i + 1];
    const int low = static_cast<int>(of_sac.key >> 32),
              high = static_cast<int>(of_sac.key & 0xffffffffu);
    rim.push_back(of_sac.forward ? std::array<int, 2>{low, high} : std::array<int, 2>{high, low});
  }
  std::sort(rim.begin(), rim.end());
  return rim;
}

/// The faces of the head, and a fan across the neck where they end.
Head head_of(const TriangleMesh& skin, const std::vector<Part>& face_part) {
  Head head;
  std::vector<char> is_below(skin.positions.size(), 0);
  std::vector<int> number(skin.positions.size(), -1);
  for (std::size_t f = 0; f < skin.triangles.size(); ++f) {
    if (face_part[f] != Part::HEAD) {
      for (const int v : skin.triangles[f])
        is_below[v] = 1;
      continue;
    }
    head.face.push_back(static_cast<int>(f));
    Triangle local;
    for (int k = 0; k < 3; ++k) {
      const int v = skin.triangles[f][k];
      if (number[v] < 0) {
        number[v] = std::ssize(head.mesh.positions);
        head.mesh.positions.push_back(skin.positions[v]);
      }
      local[k] = number[v];
    }
    head.mesh.triangles.push_back(local);
  }
  const int hub = std::ssize(head.mesh.positions);
  Vec3 middle = Vec3::Zero();
  for (const int f : head.face)
    for (int k = 0; k < 3; ++k) {
      const int a = skin.triangles[f][k], b = skin.triangles[f][(k + 1) % 3];
      if (!is_below[a] || !is_below[b])
        continue;
      head.mesh.triangles.push_back({number[a], number[b], hub});
      middle += 0.5 * (skin.positions[a] + skin.positions[b]);
    }
  if (const std::size_t cut = head.mesh.triangles.size() - head.face.size(); cut > 0)
    head.mesh.positions.push_back(middle / static_cast<double>(cut));
  return head;
}

/// Without the faces of the sacs and the vertices that only they have.
void leave_out(TriangleMesh& skin, std::vector<Part>& face_part, const std::vector<char>& is_sac) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < skin.triangles.size(); ++f)
    if (f >= is_sac.size() || !is_sac[f]) {
      skin.triangles[kept] = skin.triangles[f];
      face_part[kept] = face_part[f];
      ++kept;
    }
  skin.triangles.resize(kept);
  face_part.resize(kept);
  std::vector<int> number(skin.positions.size(), -1);
  for (const Triangle& t : skin.triangles)
    for (const int v : t)
      number[v] = 0;
  int count = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      skin.positions[count] = skin.positions[v];
      number[v] = count++;
    }
  skin.positions.resize(count);
  for (Triangle& t : skin.triangles)
    for (int& v : t)
      v = number[v];
}

} // namespace

ClosedSacs close_head_sacs(TriangleMesh& skin, std::vector<Part>& face_part) {
  ClosedSacs closed;
  const Head head = head_of(skin, face_part);
  Box3 box;
  for (const Vec3& p : head.mesh.positions)
    box.add(p);
  if (head.face.empty() || box.size().maxCoeff() > LARGEST_HEAD)
    return closed;
  std::vector<char> is_sac = unseen_faces(skin, head);
  if (std::find(is_sac.begin(), is_sac.end(), 1) == is_sac.end())
    return closed;
  const std::vector<HalfEdge> edges = half_edges(skin);
  const auto by_area = [&](const DisjointSets& pieces, char kind) {
    std::vector<double> area(is_sac.size(), 0);
    for (std::size_t f = 0; f < is_sac.size(); ++f)
      if (is_sac[f] == kind)
        area[pieces.find(static_cast<int>(f))] += area_of(skin, static_cast<int>(f));
    return area;
  };
  const DisjointSets unseen = alike_pieces(edges, is_sac);
  const std::vector<double> unseen_area = by_area(unseen, 1);
  int largest = -1;
  for (std::size_t f = 0; f < is_sac.size(); ++f) {
    const int piece = unseen.find(static_cast<int>(f));
    is_sac[f] = is_sac[f] && unseen_area[piece] >= LEAST_SAC;
    if (is_sac[f] && (largest < 0 || unseen_area[piece] > unseen_area[largest]))
      largest = piece;
    closed.sacs += is_sac[f] && piece == static_cast<int>(f);
  }
  if (closed.sacs == 0)
    return closed;
  // what is seen through the lips hangs on the sac alone, and goes with it
  const DisjointSets seen = alike_pieces(edges, is_sac);
  const std::vector<double> seen_area = by_area(seen, 0);
  for (const int f : head.face)
    if (!is_sac[f] && seen_area[seen.find(f)] < LEAST_SAC)
      is_sac[f] = 1;

  const std::vector<std::array<int, 2>> rim = rim_of(edges, is_sac);
  const std::vector<std::vector<int>> loops = border_loops(rim);
  if (loops.empty() && !rim.empty())
    return {};
  double weight = 0;
  for (std::size_t f = 0; f < is_sac.size(); ++f) {
    if (!is_sac[f])
      continue;
    const double area = area_of(skin, static_cast<int>(f));
    closed.area_m2 += area;
    ++closed.faces;
    if (unseen.find(static_cast<int>(f)) != largest)
      continue;
    for (const int v : skin.triangles[f])
      closed.place += area / 3 * skin.positions[v];
    weight += area;
  }
  closed.place /= weight;
  for (const std::vector<int>& loop : loops) {
    Vec3 middle = Vec3::Zero();
    for (const int v : loop)
      middle += skin.positions[v] / static_cast<double>(loop.size());
    const int hub = std::ssize(skin.positions);
    skin.positions.push_back(middle);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      skin.triangles.push_back({loop[k], loop[(k + 1) % loop.size()], hub});
      face_part.push_back(Part::HEAD);
    }
  }
  leave_out(skin, face_part, is_sac);
  return closed;
}

} // namespace sloper::body
