#pragma once
/// The mannequins of the tests. The build makes each once with make-mannequin
/// (tests/CMakeLists.txt), since hundreds of tests use them and each runs in a process of its own.
#include <mannequin.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/obj.hpp>

#include <filesystem>
#include <map>
#include <string>

namespace sloper::test {

/// What make-mannequin writes of a figure.
struct MadeFigure {
  TriangleMesh mesh;                ///< m
  std::vector<unsigned char> parts; ///< one per vertex, as MadeMannequin::parts
  io::Json truth;                   ///< landmarks, levels, girths_m
};

/// Edge lengths that the figures are made with, m.
enum class FigureEdges {
  FINE,  ///< 0.0125, as make-mannequin makes them by itself
  COARSE ///< 0.018
};

/// A figure of the family by name. It is made on the spot where the build has not made it.
/// @throws Error USAGE for a name that the family has not
inline MadeFigure made_figure(const std::string& preset, FigureEdges edges = FigureEdges::FINE) {
  const bool coarse = edges == FigureEdges::COARSE;
  const std::string stem =
      std::string(SLOPER_BINARY_DIR) + "/tests/figures/" + preset + (coarse ? "-coarse" : "");
  MadeFigure figure;
  if (!std::filesystem::exists(stem + ".obj")) {
    samples::Mannequin shape = samples::preset(preset);
    if (coarse)
      shape.cell_m = 0.018;
    samples::MadeMannequin made = samples::make_mannequin(shape);
    return {std::move(made.mesh), std::move(made.parts), std::move(made.truth)};
  }
  const io::ObjMesh file = io::read_obj(stem + ".obj");
  figure.mesh.positions = file.positions;
  figure.mesh.triangles = file.triangles;
  const std::string parts = io::read_file(stem + ".u8");
  figure.parts.assign(parts.begin(), parts.end());
  figure.truth = io::read_json(stem + ".truth.json");
  return figure;
}

/// The same, kept for the next call in this process.
inline const MadeFigure& mannequin(const std::string& preset) {
  static std::map<std::string, MadeFigure> kept;
  auto found = kept.find(preset);
  if (found == kept.end())
    found = kept.emplace(preset, made_figure(preset)).first;
  return found->second;
}

} // namespace sloper::test
