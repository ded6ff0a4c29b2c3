#include <garment/sleeve_ends.hpp>

#include <body/section.hpp>
#include <geometry/triangle_mesh.hpp>

#include <algorithm>
#include <set>

namespace sloper::garment {

namespace {

constexpr double MAINLY = 0.5;      // of a particle's weights
constexpr double HELD = 0.03;       // m of a sleeve, from its end
constexpr double PAST_WRIST = 0.08; // m: the knuckles
constexpr double STIFFNESS = 1000;  // N/m, of each particle: 0.1 mm under a newton's tenth
constexpr double PUSHED = 0.01;     // m towards the fingers
constexpr double STRETCHED = 0.01;  // of a sleeve's edge
constexpr double SHORTENED = 0.97;  // area of the last centimetres as placed, of that of their cloth
constexpr double NARROWER = 0.87;   // of the girth of a spread hand: it gets through what is wider, with its thumb folded in

struct Sleeve {
  std::vector<int> forearm; // particles
  std::vector<int> end;     // of these
};

/// Those that end near a wrist.
std::vector<Sleeve> sleeves_of(const Bind& bind) {
  std::vector<Sleeve> sleeves;
  for (std::size_t k = 0; k < bind.frames.size(); ++k) {
    if (!bind.frames[k].starts_with("forearm")) continue;
    Sleeve sleeve;
    std::vector<double> height; // m from the wrist to the elbow
    double lowest = 1e300;
    for (std::size_t i = 0; i < bind.particles.size(); ++i)
      for (const BindWeight& w : bind.particles[i])
        if (w.frame == static_cast<int>(k) && w.weight >= MAINLY) {
          sleeve.forearm.push_back(static_cast<int>(i));
          height.push_back(w.z * bind.lengths_m[k]);
          lowest = std::min(lowest, height.back());
        }
    if (sleeve.forearm.empty() || lowest < -PAST_WRIST) continue;
    for (std::size_t i = 0; i < height.size(); ++i)
      if (height[i] < lowest + HELD) sleeve.end.push_back(sleeve.forearm[i]);
    sleeves.push_back(std::move(sleeve));
  }
  return sleeves;
}

Vec3 mean_of(const std::vector<Vec3>& x, const std::vector<int>& particles) {
  Vec3 sum = Vec3::Zero();
  for (int i : particles) sum += x[i];
  return sum / static_cast<double>(particles.size());
}

std::vector<char> flags_of(const std::vector<int>& particles, std::size_t n) {
  std::vector<char> flags(n, 0);
  for (int i : particles) flags[i] = 1;
  return flags;
}

/// m of the outlines between these vertices that no seam takes.
double end_girth(const pattern::PanelMesh& mesh, const std::vector<int>& vertices) {
  const std::vector<char> there = flags_of(vertices, mesh.pattern.size());
  std::set<std::pair<int, int>> sewn;
  for (const pattern::MeshSeam& seam : mesh.seams)
    for (const auto* side : {&seam.a, &seam.b})
      for (std::size_t k = 0; k + 1 < side->size(); ++k) sewn.insert(std::minmax((*side)[k], (*side)[k + 1]));
  double girth = 0;
  for (const pattern::PanelInfo& p : mesh.panels)
    for (std::size_t k = 0; k < p.outline.size(); ++k) {
      const int a = p.outline[k], b = p.outline[(k + 1) % p.outline.size()];
      if (there[a] && there[b] && !sewn.count(std::minmax(a, b))) girth += (mesh.pattern[a] - mesh.pattern[b]).norm();
    }
  return girth;
}

/// m around what is beyond the wrist, drawn tight over the spread thumb.
double hand_girth(const body::Body& body, body::Part arm, const Vec3& elbow, const Vec3& forearm) {
  const Vec3 down = forearm.normalized(), x = down.unitOrthogonal(), z = down.cross(x);
  std::vector<Vec2> shadow;
  for (std::size_t f = 0; f < body.skin.triangles.size(); ++f) {
    if (body.face_part[f] != arm) continue;
    for (int v : body.skin.triangles[f])
      if (const Vec3 p = body.skin.positions[v] - elbow; p.dot(down) > forearm.norm()) shadow.emplace_back(p.dot(x), p.dot(z));
  }
  return body::closed_length(body::convex_hull(shadow));
}

} // namespace

std::vector<cloth::Pin> hold_sleeve_ends(const Garment& garment) {
  std::vector<cloth::Pin> pins;
  for (const Sleeve& sleeve : sleeves_of(garment.bind))
    for (int i : sleeve.end) pins.push_back({i, garment.position[i], STIFFNESS, Vec3::Zero()});
  return pins;
}

std::vector<cloth::Attachment> tether_sleeve_ends(const pattern::PanelMesh& mesh, const body::Body& body) {
  std::vector<cloth::Attachment> cords;
  if (mesh.placed.empty()) return cords;
  for (const body::Part arm : {body::Part::ARM_L, body::Part::ARM_R}) {
    const std::string side = arm == body::Part::ARM_L ? "_l" : "_r";
    if (!body.has_landmark("elbow" + side) || !body.has_landmark("wrist" + side)) continue;
    const Vec3 elbow = body.landmark("elbow" + side), forearm = body.landmark("wrist" + side) - elbow, down = forearm.normalized();
    std::vector<char> on_arm(mesh.placed.size(), 0);
    double end = -1e300; // m from the elbow to the hand
    const auto along = [&](const Vec3& p) { return (p - elbow).dot(down); };
    for (const pattern::PanelInfo& p : mesh.panels)
      for (int v = p.first_vertex; p.part == "arm" + side && v < p.first_vertex + p.n_vertices; ++v) on_arm[v] = 1, end = std::max(end, along(mesh.placed[v]));
    std::vector<int> last; // vertices
    for (std::size_t v = 0; v < on_arm.size(); ++v)
      if (on_arm[v] && along(mesh.placed[v]) > end - HELD) last.push_back(static_cast<int>(v));
    double placed = 0, cloth = 0; // m2 of the last triangles
    for (const Triangle& t : mesh.triangles) {
      const Vec3 &p = mesh.placed[t[0]], &q = mesh.placed[t[1]], &r = mesh.placed[t[2]];
      if (!on_arm[t[0]] || along((p + q + r) / 3) < end - HELD) continue;
      placed += 0.5 * (q - p).cross(r - p).norm();
      const Vec2 a = mesh.pattern[t[1]] - mesh.pattern[t[0]], b = mesh.pattern[t[2]] - mesh.pattern[t[0]];
      cloth += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    }
    if (end < forearm.norm() || placed > SHORTENED * cloth || end_girth(mesh, last) > NARROWER * hand_girth(body, arm, elbow, forearm)) continue;
    for (int v : last) cords.push_back({v, elbow, forearm.norm() - (end - along(mesh.placed[v])), STIFFNESS});
  }
  return cords;
}

std::vector<int> ends_pushed_on_hands(const Garment& garment, const std::vector<Vec3>& placed, const std::vector<Vec3>& shape) {
  std::vector<int> pushed;
  for (const Sleeve& sleeve : sleeves_of(garment.bind)) {
    const Vec3 to_hand = (mean_of(placed, sleeve.end) - mean_of(placed, sleeve.forearm)).normalized();
    if ((mean_of(garment.position, sleeve.end) - mean_of(placed, sleeve.end)).dot(to_hand) < PUSHED) continue;
    const std::vector<char> of_end = flags_of(sleeve.end, placed.size());
    double length = 0, before = 0;
    for (const auto& [a, b] : free_edges_of(garment.particle_triangles()))
      if (of_end[a] && of_end[b]) length += (garment.position[a] - garment.position[b]).norm(), before += (shape[a] - shape[b]).norm();
    if (length > (1 + STRETCHED) * before) pushed.insert(pushed.end(), sleeve.end.begin(), sleeve.end.end());
  }
  return pushed;
}

} // namespace sloper::garment
