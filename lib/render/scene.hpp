#pragma once
/// What is drawn: meshes with a colour per vertex, collected from documents and OBJ files.
#include <body/body.hpp>
#include <garment/garment.hpp>
#include <optional>
#include <string>

namespace sloper::render {

/// A linear-light colour per vertex; vertices of different panels are not shared, so that panels keep sharp colours.
struct DrawMesh {
  std::vector<Vec3> positions; ///< m
  std::vector<Vec3> normals;   ///< unit; smooth over welded seams
  std::vector<Vec3> colors;    ///< linear RGB, 0..1
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> lines; ///< seams and hems, drawn darker
  bool is_cloth = false;
};

struct Scene {
  std::optional<body::Body> body;
  std::vector<garment::Garment> garments;
  std::vector<DrawMesh> meshes;   ///< in the order of the documents
  std::vector<std::string> names; ///< file names, for the PNG's text chunk
};

enum class Map { NONE, STRAIN, GAP, PARTS };

/// The range and name of a map, for its colour bar.
struct Legend {
  std::string title, unit;
  double low = 0, high = 0;
  double p50 = 0, p99 = 0, largest = 0;
  bool diverging = false;
};

/// Reads body.json, shirt.json, panels.json (by their "format") and bare OBJ files. @throws Error INPUT
Scene read_scene(const std::vector<std::string>& paths);

/// Colours the scene by a map and says its legend. @throws Error USAGE when the scene lacks what the map needs
Legend apply_map(Scene& scene, Map map);

/// Colour of a value scaled to 0..1 (or -1..1 for diverging), linear RGB; scales that colour-blind people can read.
Vec3 scale_color(double t, bool diverging);

} // namespace sloper::render
