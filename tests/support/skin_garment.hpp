#pragma once
/// Garments made for tests from a body's own skin: the faces of some parts between two heights,
/// held off by a gap. They need no drape, fit exactly and are smooth, so what binding and fitting
/// say of them is known.
#include <sloper/body/measure_scan.hpp>
#include <sloper/garment/garment.hpp>
#include <support/made_figure.hpp>

#include <cmath>
#include <map>
#include <set>

namespace sloper::garment {

inline body::Body measured(samples::Mannequin shape) {
  shape.cell_m = 0.018;
  return body::measure_scan(samples::make_mannequin(shape).mesh, "figure.obj", "", {},
                            silent_reporter())
      .body;
}
inline body::Body measured(const std::string& preset) {
  return body::measure_scan(test::made_figure(preset, test::FigureEdges::COARSE).mesh, "figure.obj",
                            "", {}, silent_reporter())
      .body;
}

/// One panel over some faces; rest lengths are those of `position` times (1 - strain).
inline Garment sheet(const std::vector<Vec3>& position, const std::vector<Triangle>& faces,
                     double strain = 0) {
  Garment g;
  std::map<int, int> number;
  for (const Triangle& t : faces)
    for (const int v : t)
      number.emplace(v, 0);
  pattern::PanelInfo panel;
  panel.name = "sheet";
  for (auto& [v, n] : number) {
    n = static_cast<int>(g.position.size());
    g.particle_of.push_back(n);
    g.position.push_back(position[v]);
    g.panels.pattern.push_back(
        Vec2(position[v].x() + 0.3 * position[v].z(), position[v].y() + 0.2 * position[v].z()));
    g.panels.ids.push_back({0, 0.0, 0.0});
  }
  for (const Triangle& t : faces) {
    const Triangle f{number[t[0]], number[t[1]], number[t[2]]};
    g.panels.triangles.push_back(f);
    std::array<double, 3> scale;
    for (int k = 0; k < 3; ++k) {
      const int a = f[k], b = f[(k + 1) % 3];
      scale[k] = (g.position[b] - g.position[a]).norm() * (1 - strain) /
                 std::max((g.panels.pattern[b] - g.panels.pattern[a]).norm(), 1e-6);
    }
    g.rest_scale.push_back(scale);
  }
  panel.n_vertices = static_cast<int>(g.position.size());
  panel.n_triangles = static_cast<int>(faces.size());
  g.panels.panels.push_back(panel);
  g.panels.placed = g.position;
  g.converged = true;
  return g;
}

/// The skin of some parts between two heights, `gap` off the skin.
inline Garment skin_garment(const body::Body& body, const std::set<body::Part>& parts, double low,
                            double high, double gap, double strain = 0) {
  const std::vector<Vec3> normals = vertex_normals(body.skin);
  std::vector<Vec3> position = body.skin.positions;
  for (std::size_t i = 0; i < position.size(); ++i)
    position[i] += gap * normals[i];
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < body.skin.triangles.size(); ++f) {
    const Triangle& t = body.skin.triangles[f];
    const double y = (body.skin.positions[t[0]].y() + body.skin.positions[t[1]].y() +
                      body.skin.positions[t[2]].y()) /
                     3;
    if (parts.count(body.face_part[f]) && y > low && y < high)
      faces.push_back(t);
  }
  return sheet(position, faces, strain);
}

/// Torso and arms down to the wrists.
inline Garment skin_shirt(const body::Body& body, double gap = 0.01, double strain = 0) {
  using body::Part;
  const double hip = body.levels.at("hip").y;
  Garment g = skin_garment(body, {Part::TORSO, Part::ARM_L, Part::ARM_R}, -1,
                           body.landmark("neck_back").y(), gap, strain);
  // Hands and what is below the hip come off again.
  std::vector<Triangle> faces;
  const auto beyond_wrist = [&](const Vec3& p) {
    for (const std::string side : {"_l", "_r"}) {
      const Vec3 wrist = body.landmark("wrist" + side),
                 along = wrist - body.landmark("elbow" + side);
      if ((p - wrist).dot(along) > 0 && (p - wrist).norm() < 0.3)
        return true;
    }
    return false;
  };
  for (const Triangle& t : g.panels.triangles) {
    const Vec3 p = (g.position[t[0]] + g.position[t[1]] + g.position[t[2]]) / 3;
    const bool trunk = std::abs(p.x()) < std::abs(body.landmark("acromion_l").x());
    if (!beyond_wrist(p) && !(trunk && p.y() < hip))
      faces.push_back(t);
  }
  return sheet(g.position, faces, strain);
}

inline Garment skin_trousers(const body::Body& body, double gap = 0.01, double strain = 0) {
  using body::Part;
  return skin_garment(body, {Part::TORSO, Part::LEG_L, Part::LEG_R},
                      body.landmark("ankle_l").y() + 0.03, body.levels.at("waist_semantic").y, gap,
                      strain);
}

/// A tube around both legs from the waist to the knees, elliptic, `ease` wider than the hips;
/// `depth` is half its depth in radii.
inline Garment tube_skirt(const body::Body& body, double ease = 0.06, double depth = 0.83) {
  const int n = 72, rows = 30;
  const double top = body.levels.at("waist_semantic").y, bottom = body.landmark("knee_l").y();
  const double girth =
      std::max(body.levels.at("hip").girth_m, body.levels.at("hip_girth_max").girth_m) + ease;
  const double z = body.landmark("hip_center").z(), radius = girth / (2 * M_PI);
  std::vector<Vec3> position;
  std::vector<Triangle> faces;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c < n; ++c) {
      const double a = 2 * M_PI * c / n;
      position.emplace_back(1.15 * radius * std::sin(a), bottom + (top - bottom) * r / rows,
                            z + depth * radius * std::cos(a));
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * n + c, b = r * n + (c + 1) % n;
      faces.push_back({a, b, b + n});
      faces.push_back({a, b + n, a + n});
    }
  return sheet(position, faces);
}

/// The same body after its arms were lost, as a dress form stands.
inline body::Body without_arms(body::Body body) {
  std::vector<Triangle> faces;
  std::vector<body::Part> parts;
  for (std::size_t f = 0; f < body.skin.triangles.size(); ++f)
    if (body.face_part[f] != body::Part::ARM_L && body.face_part[f] != body::Part::ARM_R) {
      faces.push_back(body.skin.triangles[f]);
      parts.push_back(body.face_part[f]);
    }
  body.skin.triangles = faces;
  body.face_part = parts;
  for (const char* name : {"hand_tip", "hand_extreme", "wrist", "elbow", "olecranon"})
    for (const char* side : {"_l", "_r"})
      body.landmarks.erase(std::string(name) + side);
  for (const char* name : {"arm_l", "arm_r"})
    body.frames.erase(name);
  return body;
}

/// Longest and shortest ratio of edge lengths b / a, without the extreme thousandth.
inline std::pair<double, double> edge_ratios(const Garment& garment, const std::vector<Vec3>& a,
                                             const std::vector<Vec3>& b) {
  std::vector<double> ratios;
  for (const auto& [i, j] : edges_of(garment.particle_triangles()))
    if ((a[i] - a[j]).norm() > 1e-3)
      ratios.push_back((b[i] - b[j]).norm() / (a[i] - a[j]).norm());
  std::sort(ratios.begin(), ratios.end());
  const std::size_t cut = ratios.size() / 1000;
  return {ratios[cut], ratios[ratios.size() - 1 - cut]};
}

} // namespace sloper::garment
