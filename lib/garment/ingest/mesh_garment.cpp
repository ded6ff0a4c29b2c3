#include <sloper/garment/ingest/mesh_garment.hpp>

#include <garment/bind/bind_frames.hpp>
#include <garment/bind/bind_weights.hpp>
#include <garment/ingest/carried_clearance.hpp>
#include <garment/ingest/flat_panels.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/number_text.hpp>
#include <sloper/base/text.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/io/json.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sloper::garment {

namespace {

constexpr double UNITS_M[] = {1, 0.01, 0.001, 0.0254};
constexpr double SMALLEST_M = 0.12, LARGEST_M = 4; // diagonal of a garment: a cuff, a train
constexpr double NEAR_M = 0.1;    // from the skin: cloth at e times this counts 1/e^e
constexpr double INSIDE_M = 0.01; // in the body: a garment of another unit lies within the legs
constexpr double LEAST_NEARNESS = 0.15;
constexpr double CLEARLY_NEARER = 1.05; // the scan's coordinates, where they are another's
constexpr std::size_t ASKED = 2000;     // vertices
constexpr double COARSE_M = 0.035; // mean edge: the drape cannot follow the body with longer ones

Mat4 scaled(double unit_m) {
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() *= unit_m;
  return m;
}

std::vector<Vec3> moved_by(const Mat4& m, const std::vector<Vec3>& points) {
  std::vector<Vec3> out;
  for (const Vec3& p : points)
    out.push_back((m * p.homogeneous()).head<3>());
  return out;
}

double nearness_of(const std::vector<Vec3>& points, const collision::BodyCollider& skin) {
  const double size = bounding_box(points).size().norm();
  if (!(size >= SMALLEST_M && size <= LARGEST_M))
    return 0;
  const std::size_t stride = points.size() / ASKED + 1;
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < points.size(); i += stride, ++n) {
    const double d = skin.signed_distance(points[i], 10 * NEAR_M).distance;
    if (!std::isfinite(d))
      continue;
    sum += d < -INSIDE_M ? -1 : std::exp(-std::abs(d) / NEAR_M);
  }
  return sum / static_cast<double>(n);
}

/// The most likely coordinates of a mesh.
WornFrame frame_of(const io::MeshFile& file, const body::Body& from,
                   const collision::BodyCollider& skin) {
  WornFrame best;
  for (const double unit : UNITS_M) {
    const double nearness = nearness_of(moved_by(scaled(unit), file.positions), skin);
    if (nearness > best.nearness)
      best = {false, unit, nearness};
  }
  const double in_scan = nearness_of(moved_by(from.scan_to_body, file.positions), skin);
  if (in_scan > CLEARLY_NEARER * best.nearness)
    best = {true, 1, in_scan};
  if (best.nearness >= LEAST_NEARNESS)
    return best;
  const Box3 box = bounding_box(file.positions);
  const Vec3 size = box.size();
  throw input_error("import.not-worn"_id, file.name, "",
                    "lies nowhere near the body, whatever its unit: it is " +
                        rounded_text(size.x()) + " x " + rounded_text(size.y()) + " x " +
                        rounded_text(size.z()) + " units large, around (" +
                        rounded_text(box.center().x()) + ", " + rounded_text(box.center().y()) +
                        ", " + rounded_text(box.center().z()) + ")",
                    "export it as that body wears it, in the coordinates of its scan or of its "
                    "body.obj");
}

/// Regions of the body, for panels that do not go from one to another.
struct Regions {
  std::vector<int> of_triangle;
  std::vector<Vec3> warp;
};

Regions regions_of(const Garment& cloth, const body::Body& body) {
  const BindFrames frames = make_bind_frames(body);
  const auto weights = bind_weights(cloth, body, frames);
  Regions regions;
  std::map<std::string, int> number;
  const auto region_of = [&](int frame) {
    const BindFrame& f = frames.frames[frame];
    std::string name = f.name == "head" ? "torso" : f.name;
    if (name.rfind("forearm", 0) == 0)
      name = "upper_arm" + name.substr(7);
    const auto [found, is_new] = number.try_emplace(name, static_cast<int>(number.size()));
    if (is_new)
      regions.warp.push_back((f.frame.upper - f.frame.lower).normalized());
    return found->second;
  };
  for (const Triangle& t : cloth.panels.triangles) {
    std::map<int, double> share;
    for (const int v : t)
      for (const auto& [frame, weight] : weights[v])
        share[region_of(frame)] += weight;
    regions.of_triangle.push_back(
        std::max_element(share.begin(), share.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->first);
  }
  return regions;
}

/// Rigid parts by place: those of one piece are one part.
std::vector<int> rigid_places(const MeshSurface& s, const ClothRoles& roles) {
  std::vector<int> rigid(s.position.size(), -1);
  std::map<int, int> number;
  for (std::size_t f = 0; f < s.triangles.size(); ++f)
    if (roles.of_triangle[f] == ClothRole::RIGID)
      for (const int v : s.triangles[f])
        rigid[v] =
            number.try_emplace(s.component[f], static_cast<int>(number.size())).first->second;
  return rigid;
}

std::string counted(int n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

void tell(const MeshGarment& m, Reporter& reporter) {
  const MeshSurface& s = m.surface;
  reporter.info(
      m.file.name + ": " +
      counted(static_cast<int>(m.file.positions.size()), "vertex", "vertices") + " in " +
      (m.frame.in_scan
           ? "the scan's coordinates"
           : "the body's coordinates, a unit of " + rounded_text(m.frame.unit_m) + " m") +
      "; " + counted(static_cast<int>(m.garment.panels.triangles.size()), "triangle", "triangles") +
      " of cloth in " + counted(m.panels, "panel", "panels") + ", rest shape from " +
      (m.rest_from_texture ? "its texture coordinates" : "the mesh") + "; " +
      counted(m.roles.shells, "shell", "shells") + ", " +
      counted(m.roles.patches, "patch", "patches") + ", " +
      counted(m.roles.rigid_parts, "rigid part", "rigid parts") +
      "; left out: " + std::to_string(s.degenerate) + " triangles without area, " +
      std::to_string(s.duplicates) + " that stand twice");
}

void find_doubts(MeshGarment& m) {
  const std::string name = io::file_name(m.file.name);
  for (const std::string& finding : m.file.findings)
    m.findings.push_back({"import.cannot-follow"_id, name + ": " + finding});
  if (m.crossings > 0)
    m.findings.push_back({"import.crosses-itself"_id, name + " crosses itself in " +
                                                          counted(m.crossings, "pair", "pairs") +
                                                          " of faces, as it came"});
  if (m.faces_through > 0)
    m.findings.push_back(
        {"import.through-body"_id, name + " has " + counted(m.faces_through, "face", "faces") +
                                       " through the body that it comes from, as it came"});
  if (!m.rest_from_texture)
    m.findings.push_back(
        {"import.strain-unknown"_id,
         name + " has no flat pattern in its texture coordinates: its shape as worn counts as "
                "unstretched, so a garment that is tight there is judged too kindly"});
  if (m.garment.panels.edge_length > COARSE_M)
    m.findings.push_back(
        {"import.coarse"_id, name + " is coarse: its edges are " +
                                 centimetres(m.garment.panels.edge_length) +
                                 " long in the mean, and the cloth bends at them alone"});
}

} // namespace

MeshGarment read_mesh_garment(const std::string& path, const body::Body& from,
                              const collision::BodyCollider& skin, const std::string& skin_sha256,
                              const std::string& fabric, Reporter& reporter) {
  MeshGarment m;
  m.file = io::read_mesh_file(path);
  m.frame = frame_of(m.file, from, skin);
  m.file_to_body = m.frame.in_scan ? from.scan_to_body : scaled(m.frame.unit_m);
  m.surface = make_surface(m.file, moved_by(m.file_to_body, m.file.positions));
  const MeshSurface& s = m.surface;
  if (s.triangles.empty())
    throw input_error("import.no-faces"_id, path, "", "has no face with an area",
                      "a garment is a surface");
  m.roles = cloth_roles(s, skin);

  // The cloth: what is simulated, its places numbered anew.
  std::vector<int> particle(s.position.size(), -1);
  Garment& g = m.garment;
  CurvedSurface curved;
  std::vector<Triangle> cloth, texture;
  for (std::size_t f = 0; f < s.triangles.size(); ++f) {
    if (m.roles.of_triangle[f] != ClothRole::CLOTH)
      continue;
    cloth.push_back(s.triangles[f]);
    if (!s.texture.empty())
      texture.push_back(s.texture[f]);
  }
  for (const Triangle& t : cloth)
    for (const int v : t)
      particle[v] = 0;
  std::vector<Vec3> outward(s.position.size(), Vec3::Zero());
  for (std::size_t v = 0; v < particle.size(); ++v) {
    if (particle[v] < 0)
      continue;
    outward[v] =
        skin.signed_distance(s.position[v], std::numeric_limits<double>::infinity()).normal;
    particle[v] = static_cast<int>(curved.position.size());
    curved.position.push_back(s.position[v]);
  }
  face_outward(s.position, outward, cloth, texture);
  for (const Triangle& t : cloth)
    curved.triangles.push_back({particle[t[0]], particle[t[1]], particle[t[2]]});

  Garment provisional;
  provisional.panels.triangles = curved.triangles;
  provisional.position = curved.position;
  Regions regions = regions_of(provisional, from);
  curved.region = std::move(regions.of_triangle);
  curved.warp_of_region = std::move(regions.warp);
  const TextureIsometry isometry = texture_isometry(curved, m.file.texture, texture);
  m.texture_share = isometry.share;
  m.rest_from_texture = isometry.is_pattern;
  FlatPanels flat = isometry.is_pattern ? texture_panels(curved, m.file.texture, texture, isometry)
                                        : unrolled_panels(curved);
  g.panels = std::move(flat.panels);
  g.panels.name = io::file_name(path);
  g.particle_of = std::move(flat.particle_of);
  g.rest_scale = std::move(flat.rest_scale);
  g.position = curved.position;
  for (const int p : g.particle_of)
    g.panels.placed.push_back(g.position[p]);
  g.materials[""] = material_preset(fabric);
  g.offset_m = DrapeSettings().contact_gap_m; // as of any drape
  g.converged = true;
  g.strain_unknown = !m.rest_from_texture;
  g.body_sha256 = skin_sha256;
  m.panels = static_cast<int>(g.panels.panels.size());
  check_garment(g);
  bind_garment(g, from);
  m.carried = carry_on(s.position, std::move(particle), rigid_places(s, m.roles), g.position,
                       g.particle_triangles());

  const std::vector<Triangle> all = all_triangles(m.file, s);
  m.crossing_pairs =
      collision::self_intersections(s.position, all, collision::TriangleTree(s.position, all));
  m.crossings = static_cast<int>(m.crossing_pairs.size());
  m.faces_through = static_cast<int>(skin.faces_through(s.position, all).size());
  for (const int place : s.place_of)
    m.vertices_inside += skin.signed_distance(s.position[place], NEAR_M).distance < 0;
  tell(m, reporter);
  find_doubts(m);
  return m;
}

DressedMesh dressed_mesh(const MeshGarment& mesh, const Garment& worn, const body::Body& to,
                         const collision::BodyCollider& skin) {
  const std::vector<Triangle> cloth = worn.particle_triangles();
  const std::vector<Triangle> all = all_triangles(mesh.file, mesh.surface);
  Moved moved = carry_along(mesh.carried, mesh.garment.position, worn.position, cloth, &skin);
  const CrossingPairs crossing =
      keep_carried_clear(mesh.carried, worn.position, cloth, all, mesh.crossing_pairs, moved);
  const Mat4 back = (mesh.frame.in_scan ? to.scan_to_body : mesh.file_to_body).inverse();
  const Mat3 out = mesh.file_to_body.topLeftCorner<3, 3>(), in = back.topLeftCorner<3, 3>();
  const double scale = std::cbrt(std::abs((in * out).determinant()));
  std::vector<Vec3> positions;
  std::vector<Mat3> turned;
  for (std::size_t v = 0; v < mesh.file.positions.size(); ++v) {
    const int place = mesh.surface.place_of[v];
    const Vec3 own = (mesh.file_to_body * mesh.file.positions[v].homogeneous()).head<3>();
    const Vec3 x = moved.place[place] + moved.turned[place] * (own - mesh.surface.position[place]);
    positions.emplace_back((back * x.homogeneous()).head<3>());
    turned.push_back(in * moved.turned[place] * out / scale);
  }
  DressedMesh dressed;
  dressed.bytes = io::moved_mesh_file(mesh.file, positions, turned);
  dressed.crossings = static_cast<int>(crossing.size());
  dressed.faces_through = static_cast<int>(skin.faces_through(moved.place, all).size());
  return dressed;
}

io::Json mesh_json(const MeshGarment& m, const DressedMesh* dressed) {
  io::Json j = {{"file", io::file_name(m.file.name)},
                {"format", m.file.format},
                {"coordinates", m.frame.in_scan ? "scan" : "body"},
                {"vertices", m.file.positions.size()},
                {"faces", m.file.faces.size()},
                {"cloth_triangles", m.garment.panels.triangles.size()},
                {"panels", m.panels},
                {"rest_shape", m.rest_from_texture ? "texture" : "mesh"},
                {"texture_isometric_share", m.texture_share},
                {"shells", m.roles.shells},
                {"thickness_m", m.roles.thickness_m},
                {"patches", m.roles.patches},
                {"rigid_parts", m.roles.rigid_parts},
                {"degenerate_triangles", m.surface.degenerate},
                {"duplicate_triangles", m.surface.duplicates},
                {"non_manifold_edges", m.surface.non_manifold_edges}};
  if (!m.frame.in_scan)
    j["unit_m"] = m.frame.unit_m;
  j["before"] = {{"crossing_pairs", m.crossings}, {"faces_through_body", m.faces_through}};
  if (dressed)
    j["after"] = {{"crossing_pairs", dressed->crossings},
                  {"faces_through_body", dressed->faces_through}};
  return j;
}

} // namespace sloper::garment
