#include <pattern/place/tight_rings.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/measure/section.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sloper::pattern {
namespace {

constexpr double RING_GOES_ON = 30; // degrees by which the outline of one panel turns within a ring
constexpr std::size_t MOST_EDGES = 32; // of a ring
constexpr int RING_SAMPLES = 8;        // of an edge
constexpr double MOST_RING_STRETCH = 0.15;
constexpr double LEVEL_RING = 0.9; // of a ring's normal, upwards: rings about the trunk

using RingEdgeId = std::array<int, 2>; // panel, edge

RingEdgeId edge_after(const Pattern& pattern, const RingEdgeId& e) {
  int begin = 0;
  for (const auto& loop : pattern.panels[e[0]].loops) {
    const int n = static_cast<int>(loop.size());
    if (e[1] < begin + n)
      return {e[0], begin + (e[1] - begin + 1) % n};
    begin += n;
  }
  return e;
}

double turn_after(const Pattern& pattern, const RingEdgeId& e) {
  const RingEdgeId next = edge_after(pattern, e);
  const ArcLength in(pattern.panels[e[0]].edge(e[1]).path),
      out(pattern.panels[next[0]].edge(next[1]).path);
  const Vec2 u = in.tangent(in.length()), v = out.tangent(0);
  return units::degrees(std::abs(std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v))));
}

/// The partner of each edge that is sewn whole to one whole edge.
std::map<RingEdgeId, RingEdgeId> whole_partners(const Pattern& pattern) {
  std::map<RingEdgeId, RingEdgeId> out;
  for (const Seam& seam : pattern.seams) {
    if (seam.a.size() != seam.b.size() || seam.kind == "pleat")
      continue;
    for (std::size_t k = 0; k < seam.a.size(); ++k) {
      const Run &a = seam.a[k], &b = seam.b[k];
      if (std::abs(a.to - a.from) < 1 || std::abs(b.to - b.from) < 1)
        continue;
      out[{a.panel, a.edge}] = {b.panel, b.edge};
      out[{b.panel, b.edge}] = {a.panel, a.edge};
    }
  }
  return out;
}

/// The ring's edges where it starts, in order, on the mesh.
std::vector<Vec3> placed_ring(const Pattern& pattern, const PanelMesh& mesh,
                              const ClothRing& ring) {
  std::vector<Vec3> out;
  for (const auto& [p, e] : ring.edges) {
    const ArcLength arc(pattern.panels[p].edge(e).path);
    for (int k = 0; k < RING_SAMPLES; ++k) {
      const Vec2 at = arc.at(arc.length() * (k + 0.5) / RING_SAMPLES);
      const std::vector<int>& outline = mesh.panels[p].outline;
      const auto nearest = std::min_element(outline.begin(), outline.end(), [&](int v, int w) {
        return (mesh.pattern[v] - at).squaredNorm() < (mesh.pattern[w] - at).squaredNorm();
      });
      if (nearest != outline.end())
        out.push_back(mesh.placed[*nearest]);
    }
  }
  return out;
}

struct RingPlane {
  Vec3 middle = Vec3::Zero(), normal = Vec3::Zero(), right, up;
  Vec2 at(const Vec3& p) const { return {(p - middle).dot(right), (p - middle).dot(up)}; }
};

/// Newell's normal: that of the area which the ring encloses.
RingPlane plane_of(const std::vector<Vec3>& ring) {
  RingPlane plane;
  for (const Vec3& p : ring)
    plane.middle += p / static_cast<double>(ring.size());
  for (std::size_t k = 0; k < ring.size(); ++k)
    plane.normal += (ring[k] - plane.middle).cross(ring[(k + 1) % ring.size()] - plane.middle);
  plane.normal.normalize();
  const Vec3 other = std::abs(plane.normal.y()) > LEVEL_RING ? Vec3::UnitX() : Vec3::UnitY();
  plane.right = other.cross(plane.normal).normalized();
  plane.up = plane.normal.cross(plane.right);
  return plane;
}

bool encloses(const Vec2& p, const std::vector<Vec2>& polygon) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

struct LimbInside {
  double girth = 0; ///< m, taut
  const char* name = "";
};

/// The limb that the ring goes round, with its girth in the ring's plane.
LimbInside limb_in(const RingPlane& plane, const std::vector<Vec2>& ring, const BodySpace& space) {
  constexpr std::array<std::pair<body::Part, const char*>, 4> LIMBS = {
      std::pair{body::Part::ARM_L, "left arm"}, std::pair{body::Part::ARM_R, "right arm"},
      std::pair{body::Part::LEG_L, "left leg"}, std::pair{body::Part::LEG_R, "right leg"}};
  const auto& skin = space.body().skin;
  LimbInside found;
  int limbs = 0;
  for (const auto& [part, name] : LIMBS) {
    std::vector<Vec2> section;
    Vec2 middle = Vec2::Zero();
    for (const Triangle& t : skin.triangles) {
      if (space.parts()[t[0]] != part || space.parts()[t[1]] != part || space.parts()[t[2]] != part)
        continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = skin.positions[t[k]], &b = skin.positions[t[(k + 1) % 3]];
        const double from = (a - plane.middle).dot(plane.normal),
                     to = (b - plane.middle).dot(plane.normal);
        if ((from < 0) == (to < 0))
          continue;
        section.push_back(plane.at(a + from / (from - to) * (b - a)));
        middle += section.back();
      }
    }
    if (section.size() < 3)
      continue;
    middle /= static_cast<double>(section.size());
    if (!encloses(middle, ring))
      continue;
    ++limbs;
    found = {body::closed_length(body::convex_hull(std::move(section))), name};
  }
  return limbs == 1 ? found : LimbInside{};
}

/// Where a ring no longer goes round the waist: above it are necklines.
double top_of_waist(const BodySpace& space) {
  constexpr double UNDERBUST = 0.66; // of the stature
  return space.level("underbust", UNDERBUST);
}

/// Between hips and bust: what goes round the trunk slides to where it is narrow.
LimbInside narrowest_trunk(const BodySpace& space) {
  constexpr double STEP = 0.01, HIP = 0.51; // m, of the stature
  LimbInside found{0, "waist"};
  const double high = top_of_waist(space);
  for (double y = space.level("hip", HIP); y < high; y += STEP)
    if (const double girth = space.girth(y); girth > 0 && (found.girth <= 0 || girth < found.girth))
      found.girth = girth;
  return found;
}

std::string panels_of_ring(const Pattern& pattern, const ClothRing& ring) {
  std::string out;
  std::set<int> seen;
  for (const auto& [p, e] : ring.edges)
    if (seen.insert(p).second)
      out += (out.empty() ? "" : ", ") + pattern.panels[p].name;
  return out;
}

} // namespace

std::vector<ClothRing> cloth_rings(const Pattern& pattern) {
  const std::map<RingEdgeId, RingEdgeId> sewn = whole_partners(pattern);
  std::set<RingEdgeId> seen;
  std::vector<ClothRing> out;
  const auto next_of = [&](const RingEdgeId& e) -> RingEdgeId {
    if (turn_after(pattern, e) < RING_GOES_ON)
      return edge_after(pattern, e);
    const auto across = sewn.find(edge_after(pattern, e));
    return across == sewn.end() ? RingEdgeId{-1, -1} : edge_after(pattern, across->second);
  };
  for (int p = 0; p < std::ssize(pattern.panels); ++p)
    for (int e = 0; e < pattern.panels[p].n_edges(); ++e) {
      const RingEdgeId start{p, e};
      if (seen.count(start))
        continue;
      ClothRing ring;
      RingEdgeId at = start;
      do {
        const double own = length(pattern.panels[at[0]].edge(at[1]).path);
        const auto partner = sewn.find(at);
        ring.length +=
            partner == sewn.end()
                ? own
                : std::min(
                      own,
                      length(pattern.panels[partner->second[0]].edge(partner->second[1]).path));
        ring.edges.push_back(at);
        at = next_of(at);
      } while (at[0] >= 0 && at != start && ring.edges.size() < MOST_EDGES);
      if (at != start)
        continue;
      seen.insert(ring.edges.begin(), ring.edges.end());
      std::set<int> panels;
      for (const RingEdgeId& edge : ring.edges)
        panels.insert(edge[0]);
      const bool alone = panels.size() == 1 && ring.edges.size() > 1; // may be an outline
      if (!alone)
        out.push_back(std::move(ring));
    }
  return out;
}

std::vector<std::string> tight_rings(const Pattern& pattern, const PanelMesh& mesh,
                                     const BodySpace& space) {
  std::map<std::pair<std::string, long>, std::pair<double, std::string>> tightest; // by limb and mm
  for (const ClothRing& ring : cloth_rings(pattern)) {
    const std::vector<Vec3> points = placed_ring(pattern, mesh, ring);
    if (points.size() < 3)
      continue;
    const RingPlane plane = plane_of(points);
    std::vector<Vec2> outline;
    for (const Vec3& p : points)
      outline.push_back(plane.at(p));
    const std::string& part = mesh.panels[ring.edges[0][0]].part;
    LimbInside inside = limb_in(plane, outline, space);
    if (part == "torso" && std::abs(plane.normal.y()) > LEVEL_RING && inside.girth <= 0 &&
        plane.middle.y() < top_of_waist(space))
      inside = narrowest_trunk(space);
    const double stretch = inside.girth / ring.length - 1;
    if (!(stretch > MOST_RING_STRETCH))
      continue;
    // Two rings that are sewn together are one.
    auto& worst = tightest[{inside.name, std::lround(ring.length / units::MM)}];
    if (stretch > worst.first)
      worst = {stretch, panels_of_ring(pattern, ring) + ": " + centimetres(ring.length) +
                            " around, on a " + inside.name + " of " + centimetres(inside.girth) +
                            " there: it closes only stretched by " + whole_percent(stretch)};
  }
  std::vector<std::string> out;
  for (auto& [key, worst] : tightest)
    out.push_back(std::move(worst.second));
  return out;
}

} // namespace sloper::pattern
