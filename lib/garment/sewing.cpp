#include <sloper/base/error.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/geometry/disjoint_sets.hpp>
#include <sloper/pattern/mesh/folds.hpp>

#include <algorithm>
#include <numeric>

namespace sloper::garment {

std::vector<int> weld_classes(const pattern::PanelMesh& panels) {
  DisjointSets welded(panels.pattern.size());
  for (const pattern::MeshSeam& seam : panels.seams)
    for (std::size_t k = 0; k < seam.a.size() && !seam.open; ++k)
      welded.unite(seam.a[k], seam.b[k]);
  return welded.numbers();
}

void unsew(Garment& garment) {
  garment.particle_of.resize(garment.panels.pattern.size());
  std::iota(garment.particle_of.begin(), garment.particle_of.end(), 0);
  garment.position = garment.panels.placed;
}

void weld(Garment& garment, const std::vector<Vec3>& position) {
  garment.particle_of = weld_classes(garment.panels);
  const int n = garment.particle_of.empty()
                    ? 0
                    : 1 + *std::max_element(garment.particle_of.begin(), garment.particle_of.end());
  std::vector<Vec3> sum(n, Vec3::Zero());
  std::vector<int> count(n, 0);
  for (std::size_t v = 0; v < position.size(); ++v) {
    sum[garment.particle_of[v]] += position[v];
    ++count[garment.particle_of[v]];
  }
  for (int i = 0; i < n; ++i)
    sum[i] /= count[i];
  garment.position = std::move(sum);
}

std::vector<std::array<int, 2>> open_stitches(const Garment& garment) {
  std::vector<std::array<int, 2>> stitches;
  for (const pattern::MeshSeam& seam : garment.panels.seams)
    for (std::size_t k = 0; k < seam.a.size() && !seam.open; ++k) {
      const int a = garment.particle_of[seam.a[k]], b = garment.particle_of[seam.b[k]];
      if (a != b)
        stitches.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(stitches.begin(), stitches.end());
  stitches.erase(std::unique(stitches.begin(), stitches.end()), stitches.end());
  return stitches;
}

std::vector<int> seam_classes(const Garment& garment) {
  const std::vector<int> classes = weld_classes(garment.panels);
  std::vector<int> members(classes.size(), 0), of(garment.position.size(), -1);
  for (int c : classes)
    ++members[c];
  for (std::size_t v = 0; v < classes.size(); ++v)
    if (members[classes[v]] > 1)
      of[garment.particle_of[v]] = classes[v];
  return of;
}

namespace {

// Shorter over longer side, below which a seam is a gather: pattern makers gather by 1 to 1.5 and
// more. What is less is ease, which the cloth takes in without folds: at 0.95 sleeve caps and
// waistbands with ease changed, and tight trousers no longer came to rest (one of 12).
constexpr double GATHERED = 0.8;
constexpr double GATHER_REACH = 2; // mesh edges beside a gather within which cloth cannot fold

/// Springs by their particles.
class SpringFinder {
public:
  explicit SpringFinder(cloth::ClothMesh& mesh) : m_mesh(mesh) {}
  /// -1 where there is none.
  long operator()(int a, int b) const {
    const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(m_mesh.edges.begin(), m_mesh.edges.end(), edge);
    return found != m_mesh.edges.end() && *found == edge ? found - m_mesh.edges.begin() : -1;
  }

private:
  cloth::ClothMesh& m_mesh;
};

/// A stretch of the longer side of a gather, in pattern coordinates.
struct Gather {
  Vec2 from, to;
  double share; ///< of its length that the shorter side has
};

double distance_to(const Gather& g, const Vec2& p) {
  const Vec2 along = g.to - g.from;
  const double t =
      std::clamp((p - g.from).dot(along) / std::max(along.squaredNorm(), 1e-18), 0.0, 1.0);
  return (p - g.from - t * along).norm();
}

/// Cloth beside a gather lies in folds finer than the mesh: within a mesh edge or two it cannot
/// fold, and its springs, pressed together, would stretch what it is gathered into. There they are
/// as long along the seam as the folds leave room for.
void ease_gathers(const Garment& garment, const std::vector<std::vector<Gather>>& gathers,
                  std::vector<char>& done, cloth::ClothMesh& mesh) {
  const pattern::PanelMesh& panels = garment.panels;
  const SpringFinder spring(mesh);
  for (std::size_t p = 0; p < gathers.size(); ++p) {
    if (gathers[p].empty())
      continue;
    const pattern::PanelInfo& panel = panels.panels[p];
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const int v = panels.triangles[f][k], w = panels.triangles[f][(k + 1) % 3];
        const long at = spring(garment.particle_of[v], garment.particle_of[w]);
        if (at < 0 || done[at])
          continue;
        done[at] = 1;
        const Vec2 middle = 0.5 * (panels.pattern[v] + panels.pattern[w]);
        const Gather* nearest = nullptr;
        double least = 1e300;
        for (const Gather& g : gathers[p])
          if (const double d = distance_to(g, middle); d < least) {
            least = d;
            nearest = &g;
          }
        const Vec2 along = nearest->to - nearest->from;
        const double near = 1 - least / (GATHER_REACH * along.norm());
        if (near <= 0)
          continue;
        const Vec2 edge = panels.pattern[w] - panels.pattern[v], unit = along.normalized();
        const double share = 1 - near * (1 - nearest->share), level = edge.dot(unit) * share,
                     across = edge.x() * unit.y() - edge.y() * unit.x();
        mesh.springs[at].rest_length *= std::hypot(level, across) / std::max(edge.norm(), 1e-9);
      }
  }
}

} // namespace

/// Along a seam of unequal lengths the shorter side decides (the longer one is gathered into it):
/// its length holds for both.
static void gather_seams(const Garment& garment, cloth::ClothMesh& mesh) {
  const SpringFinder spring(mesh);
  const auto& pattern = garment.panels.pattern;
  std::vector<std::vector<Gather>> gathers(garment.panels.panels.size());
  const auto panel_of = [&](int v) {
    std::size_t p = 0;
    while (v >= garment.panels.panels[p].first_vertex + garment.panels.panels[p].n_vertices)
      ++p;
    return p;
  };
  std::vector<char> done(mesh.springs.size(), 0);
  bool any = false;
  for (const pattern::MeshSeam& seam : garment.panels.seams)
    for (std::size_t k = 0; k + 1 < seam.a.size() && !seam.open; ++k) {
      const long a = spring(garment.particle_of[seam.a[k]], garment.particle_of[seam.a[k + 1]]),
                 b = spring(garment.particle_of[seam.b[k]], garment.particle_of[seam.b[k + 1]]);
      if (a < 0 || b < 0)
        continue;
      const double length_a = (pattern[seam.a[k + 1]] - pattern[seam.a[k]]).norm(),
                   length_b = (pattern[seam.b[k + 1]] - pattern[seam.b[k]]).norm();
      const double shorter = std::min(length_a, length_b);
      if (a == b) {
        mesh.springs[a].rest_length *=
            shorter / (0.5 * (length_a + length_b)); // welded: it had the mean, edits included
      } else {
        mesh.springs[a].rest_length *= shorter / length_a;
        mesh.springs[b].rest_length *= shorter / length_b;
      }
      done[a] = done[b] = 1;
      if (shorter >= GATHERED * std::max(length_a, length_b))
        continue;
      const auto& longer = length_a > length_b ? seam.a : seam.b;
      gathers[panel_of(longer[k])].push_back(
          {pattern[longer[k]], pattern[longer[k + 1]], shorter / std::max(length_a, length_b)});
      any = true;
    }
  if (any)
    ease_gathers(garment, gathers, done, mesh);
}

/// A pleat is pressed: along its folds cloth does not spring back to flat. Where the scene has
/// creases, these say how folds are pressed.
static void press_pleats(const Garment& garment, cloth::ClothMesh& mesh) {
  if (!garment.scene.creases.empty())
    return;
  std::vector<std::array<int, 2>> folds;
  for (const auto& [a, b] : pattern::pleat_edges(garment.panels)) {
    const int i = garment.particle_of[a], j = garment.particle_of[b];
    folds.push_back({std::min(i, j), std::max(i, j)});
  }
  if (folds.empty())
    return;
  std::sort(folds.begin(), folds.end());
  for (cloth::Hinge& hinge : mesh.hinges)
    if (std::binary_search(folds.begin(), folds.end(),
                           std::array{std::min(hinge.particle[0], hinge.particle[1]),
                                      std::max(hinge.particle[0], hinge.particle[1])})) {
      hinge.stiffness = 0;
      hinge.pressed = true;
    }
}

cloth::ClothMesh cloth_mesh_of(const Garment& garment) {
  const pattern::PanelMesh& panels = garment.panels;
  std::vector<cloth::RestTriangle> triangles(panels.triangles.size());
  std::vector<cloth::Fabric> fabrics;
  for (const pattern::PanelInfo& panel : panels.panels) {
    fabrics.push_back(material_of(garment, panel.material));
    const Vec2 warp = panel.grain.normalized(), weft(warp.y(), -warp.x());
    for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
      cloth::RestTriangle& t = triangles[f];
      for (int k = 0; k < 3; ++k) {
        const int v = panels.triangles[f][k];
        t.particle[k] = garment.particle_of[v];
        t.flat[k] = Vec2(panels.pattern[v].dot(weft), panels.pattern[v].dot(warp));
      }
      if (t.particle[0] == t.particle[1] || t.particle[1] == t.particle[2] ||
          t.particle[2] == t.particle[0])
        throw input_error(
            "mesh.seam-too-coarse"_id, "",
            "panel " + panel.name + ", triangle " + std::to_string(f - panel.first_triangle),
            "a seam welds two corners of one triangle together", "use a smaller --edge-length");
      t.fabric = static_cast<int>(fabrics.size()) - 1;
    }
  }
  cloth::ClothMesh mesh =
      cloth::make_cloth_mesh(static_cast<int>(garment.position.size()), std::move(triangles),
                             std::move(fabrics), garment.rest_scale);
  gather_seams(garment, mesh);
  press_pleats(garment, mesh);
  return mesh;
}

} // namespace sloper::garment
