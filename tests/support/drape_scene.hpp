#pragma once
/// A scene made for tests: a round pillar that widens below its waist, a motion of it, and a
/// two-panel skirt around it.
#include <cmath>
#include <garment/drape/motion.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <support/shapes.hpp>

namespace sloper::garment {

/// Closed surface of revolution about y: radius 0.12 m at the waist (y = 1), 0.136 m at the hip (y
/// = 0.8), 0.13 m below.
inline body::Body make_pillar(int n_around = 64, int n_up = 60) {
  auto radius = [](double y) {
    if (y > 1.0)
      return 0.12 + 0.3 * (y - 1.0) * (y - 1.0);
    const double t = (1.0 - y) / 0.2;
    if (t >= 2)
      return 0.13;
    const double inwards = t > 1 ? 0.003 * (1 - std::cos(M_PI * (t - 1))) : 0;
    return 0.12 + 0.008 * (1 - std::cos(M_PI * std::min(t, 1.0))) - inwards;
  };
  std::vector<shapes::Ring> rings;
  for (int r = 0; r <= n_up; ++r) {
    const double y = 0.2 + 1.0 * r / n_up;
    rings.push_back({y, radius(y), 0.8 * radius(y)});
  }
  body::Body body;
  body.skin = shapes::revolve(n_around, rings);
  shapes::close_ends(body.skin, n_around, Vec3(0, 0.2, 0), Vec3(0, 1.2, 0));
  body.face_part.assign(body.skin.triangles.size(), body::Part::TORSO);
  return body;
}

/// One panel of nx by ny cells on the torso. `flat(c, r)` gives the pattern point of column c and
/// row r, `place` where a pattern point starts.
/// @return the panel's index
template<class Flat, class Place>
int add_panel(Garment& garment, const std::string& name, int nx, int ny, Flat flat, Place place) {
  pattern::PanelMesh& p = garment.panels;
  pattern::PanelInfo info;
  info.name = name;
  info.part = "torso";
  info.first_vertex = static_cast<int>(p.pattern.size());
  info.first_triangle = static_cast<int>(p.triangles.size());
  const int k = std::ssize(p.panels);
  for (int r = 0; r <= ny; ++r)
    for (int c = 0; c <= nx; ++c) {
      const Vec2 uv = flat(c, r);
      p.pattern.push_back(uv);
      p.placed.push_back(place(uv));
      p.ids.push_back({k, static_cast<double>(c) / nx, static_cast<double>(r) / ny});
    }
  auto id = [&](int r, int c) { return info.first_vertex + r * (nx + 1) + c; };
  for (int r = 0; r < ny; ++r)
    for (int c = 0; c < nx; ++c) {
      if ((r + c) % 2) {
        p.triangles.push_back({id(r, c), id(r, c + 1), id(r + 1, c)});
        p.triangles.push_back({id(r, c + 1), id(r + 1, c + 1), id(r + 1, c)});
      } else {
        p.triangles.push_back({id(r, c), id(r, c + 1), id(r + 1, c + 1)});
        p.triangles.push_back({id(r, c), id(r + 1, c + 1), id(r + 1, c)});
      }
    }
  info.n_vertices = static_cast<int>(p.pattern.size()) - info.first_vertex;
  info.n_triangles = static_cast<int>(p.triangles.size()) - info.first_triangle;
  p.panels.push_back(info);
  return k;
}

/// As if it was the sleeve of a forearm of 0.3 m with the wrist at a height.
inline Bind bind_as_sleeve(const Garment& garment, double wrist_y) {
  Bind bind;
  bind.frames = {"forearm_l"};
  bind.lengths_m = {0.3};
  bind.marks.resize(1);
  for (const Vec3& p : garment.position)
    bind.particles.push_back({{0, 1, 0, (p.y() - wrist_y) / 0.3, 0.003}});
  return bind;
}

/// Front and back rectangle, each half the girth wide, side seams open; `girth` at rest, m. @param
/// flare  width of the hem over that of the top
inline Garment make_skirt(double girth, double length, double edge, double top_y = 1.02,
                          double distance = 0.25, double flare = 1) {
  Garment garment;
  pattern::PanelMesh& p = garment.panels;
  p.name = "test skirt";
  p.edge_length = edge;
  const int nx = std::max(2, static_cast<int>(std::lround(0.5 * girth / edge))),
            ny = std::max(2, static_cast<int>(std::lround(length / edge)));
  for (int side = 0; side < 2; ++side)
    add_panel(
        garment, side ? "back" : "front", nx, ny,
        [&](int c, int r) {
          const double width = 0.5 * girth * (flare + (1 - flare) * r / ny);
          return Vec2(width * (static_cast<double>(c) / nx - 0.5), length * r / ny);
        },
        [&](const Vec2& uv) {
          return Vec3(side ? -uv.x() : uv.x(), top_y - length + uv.y(),
                      side ? -distance : distance);
        });
  const int back = p.panels[1].first_vertex;
  for (int end = 0; end < 2; ++end) {
    pattern::MeshSeam seam;
    seam.name = end ? "left" : "right";
    seam.kind = "seam";
    seam.length_a = seam.length_b = std::hypot(length, 0.25 * girth * (flare - 1));
    for (int r = 0; r <= ny; ++r) {
      seam.a.push_back(r * (nx + 1) + (end ? nx : 0));
      seam.b.push_back(back + r * (nx + 1) + (end ? 0 : nx));
    }
    p.seams.push_back(seam);
  }
  return garment;
}

/// The pillar swings to its side, by `distance` m at most, and turns, as hips do; 30 frames a
/// second. `body` outlives it.
inline BodyMoves swinging(const body::Body& body, std::size_t frames, double distance) {
  BodyMoves moves;
  moves.n_frames = frames;
  moves.skin = [&body, distance](std::size_t k) {
    const double t = (static_cast<double>(k) + 1) / 30;
    std::vector<Vec3> x = body.skin.positions;
    for (Vec3& p : x)
      p = Eigen::AngleAxisd(0.3 * std::sin(6 * t), Vec3::UnitY()) * p +
          Vec3(distance * std::sin(2 * M_PI * t), 0, 0);
    return x;
  };
  return moves;
}

} // namespace sloper::garment
