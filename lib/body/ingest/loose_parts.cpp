#include <body/ingest/loose_parts.hpp>
#include <body/ingest/segmentation.hpp>
#include <body/surface/mesh_repair.hpp>

#include <algorithm>
#include <cstdio>
#include <map>

namespace sloper::body {

namespace {

// shares of the body's height
constexpr double AROUND = 0.12; ///< a loose part lies within the body's box widened by this
constexpr double SMALL_GAP =
    0.09; ///< widest hole of a body that is whole by itself: eye sockets, a mouth
constexpr double LEAST_STICK_OUT = 0.003;  ///< above the crown or below the soles
constexpr double FEET = 0.12, HEAD = 0.85; ///< below: at the feet; above: at the head
/// Share of the area of all shells that the largest has at least, or it is one piece of many.
constexpr double LEAST_BODY_AREA = 0.3;

struct Shell {
  double area = 0; ///< twice, in the scan's unit
  Box3 box;
  bool is_loose = false; ///< beside the body, within or close around it
};

/// Component of every vertex, with vertices at one place joined: texture seams and STL.
std::vector<int> shells_of(const TriangleMesh& scan) {
  std::vector<int> shell = connected_components(scan.positions.size(), scan.triangles);
  if (shell.empty() || *std::max_element(shell.begin(), shell.end()) == 0)
    return shell;
  TriangleMesh joined = scan;
  std::vector<int> place(scan.positions.size());
  for (std::size_t v = 0; v < place.size(); ++v)
    place[v] = static_cast<int>(v);
  if (!weld(joined, place))
    return shell;
  const std::vector<int> of_place = connected_components(joined.positions.size(), joined.triangles);
  for (std::size_t v = 0; v < shell.size(); ++v)
    shell[v] = of_place[place[v]];
  return shell;
}

/// @param shell  of every vertex
std::vector<Shell> measured(const TriangleMesh& scan, const std::vector<int>& shell) {
  std::vector<Shell> shells(
      static_cast<std::size_t>(*std::max_element(shell.begin(), shell.end())) + 1);
  for (std::size_t v = 0; v < shell.size(); ++v)
    shells[shell[v]].box.add(scan.positions[v]);
  for (const Triangle& t : scan.triangles)
    shells[shell[t[0]]].area +=
        area_normal(scan.positions[t[0]], scan.positions[t[1]], scan.positions[t[2]]).norm();
  return shells;
}

TriangleMesh part_of(const TriangleMesh& scan, const std::vector<int>& shell, int which) {
  TriangleMesh part;
  std::vector<int> number(scan.positions.size(), -1);
  for (std::size_t v = 0; v < scan.positions.size(); ++v)
    if (shell[v] == which) {
      number[v] = static_cast<int>(part.positions.size());
      part.positions.push_back(scan.positions[v]);
    }
  for (const Triangle& t : scan.triangles)
    if (shell[t[0]] == which)
      part.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return part;
}

/// Closed but for small holes: nothing of it is left to another shell.
bool is_whole(TriangleMesh part, double height) {
  std::vector<int> unused;
  weld(part, unused);
  const std::vector<HalfEdge> list = half_edges(part);
  const std::vector<Hole> holes = holes_of(part, list, SMALL_GAP * height, 1);
  return holes.empty();
}

/// @param low, high heights of a loose part, of the body's
const char* where_of(double low, double high) {
  if (0.5 * (low + high) < FEET)
    return "at the feet";
  return high > HEAD ? "at the head" : "on the body";
}

struct Group {
  int shells = 0;
  Box3 box;
};

std::string described(const Group& group, const char* where, double height, const Vec3& up) {
  char text[200];
  const Vec3 size = group.box.size() / height;
  const double tall = std::abs(size.dot(up));
  std::snprintf(text, sizeof text, "%d loose %s %s, %.0f %% of the stature high and %.0f %% broad",
                group.shells, group.shells == 1 ? "part" : "parts", where, 100 * tall,
                100 * (size - tall * up.cwiseAbs()).maxCoeff());
  return text;
}

} // namespace

LooseParts find_loose_parts(const TriangleMesh& scan, const std::string& up_axis) {
  LooseParts parts;
  if (scan.triangles.empty())
    return parts;
  const std::vector<int> shell = shells_of(scan);
  std::vector<Shell> shells = measured(scan, shell);
  if (shells.size() == 1)
    return parts;
  const auto by_area = [](const Shell& a, const Shell& b) { return a.area < b.area; };
  const int largest =
      static_cast<int>(std::max_element(shells.begin(), shells.end(), by_area) - shells.begin());
  double all = 0;
  for (const Shell& each : shells)
    all += each.area;
  if (shells[largest].area < LEAST_BODY_AREA * all)
    return parts;
  const TriangleMesh body = part_of(scan, shell, largest);
  const SegmentedScan alone = segment_scan(body, up_axis);
  if (!shows_a_person(alone))
    return parts;
  const double height = alone.high - alone.low;
  const Box3& box = shells[largest].box;
  Box3 around = box;
  around.low -= Vec3::Constant(AROUND * height);
  around.high += Vec3::Constant(AROUND * height);
  const bool whole = is_whole(body, height);
  std::map<std::string, Group> groups;
  for (std::size_t k = 0; k < shells.size(); ++k) {
    Shell& other = shells[k];
    const bool is_near = (other.box.low - around.low).minCoeff() >= 0 &&
                         (around.high - other.box.high).minCoeff() >= 0;
    other.is_loose = static_cast<int>(k) != largest && other.area > 0 && is_near;
    if (!other.is_loose)
      continue;
    const double low = std::min(other.box.low.dot(alone.up), other.box.high.dot(alone.up)),
                 high = std::max(other.box.low.dot(alone.up), other.box.high.dot(alone.up));
    const bool sticks_out =
        high > alone.high + LEAST_STICK_OUT * height || low < alone.low - LEAST_STICK_OUT * height;
    if (!whole && !sticks_out)
      continue;
    Group& group = groups[where_of((low - alone.low) / height, (high - alone.low) / height)];
    ++group.shells;
    group.box.add(other.box.low);
    group.box.add(other.box.high);
  }
  for (const auto& [where, group] : groups) {
    const std::string what = described(group, where.c_str(), height, alone.up);
    if (whole)
      parts.findings.push_back(
          {"scan.loose-part"_id, "info", what + ": left out, the body is whole without", "scan"});
    else
      parts.findings.push_back(
          {"scan.loose-part-kept"_id, "warning",
           what + ", beyond the largest one, which is not whole without: part of the stature",
           "head_tip"});
  }
  if (!whole || groups.empty())
    return parts;
  parts.is_extra.resize(shell.size());
  for (std::size_t v = 0; v < shell.size(); ++v)
    parts.is_extra[v] = shells[shell[v]].is_loose;
  return parts;
}

} // namespace sloper::body
