#pragma once
/// Measures that a tailor takes on the finished garment, computed from the flat pattern:
/// no body, no drape.
/// Test: tests/pattern/measure/test_measures.cpp
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/panel_mesh.hpp>
#include <sloper/pattern/pattern.hpp>
#include <sloper/pattern/seams/check_pattern.hpp>

namespace sloper::pattern {

/// An opening of the sewn garment: a hem, a waist, a neckline, an armhole without its sleeve.
struct Opening {
  std::vector<std::string> edges;      ///< "front: hem", in the order of the panels
  double length = 0;                   ///< m, around
  std::vector<std::array<int, 2>> rim; ///< sides of triangles of the mesh that it was measured on
};

/// A measure as a tailor names it.
struct NamedMeasure {
  std::string name; ///< such as "chest"; see measure_trunk()
  double value = 0; ///< m
  std::string how;  ///< where it was taken
};

/// All measures of one finished garment.
struct FinishedMeasures {
  /// Those of measure_trunk() that the garment has, in its order.
  std::vector<NamedMeasure> named;
  std::vector<Opening> openings;                     ///< longest first
  std::vector<std::pair<std::string, double>> seams; ///< name, m: the mean of both sides
  /// Every 5 cm: m below the garment's top along the cloth, and m of cloth around the
  /// trunk there.
  std::vector<std::array<double, 2>> around;
  double cloth_m2 = 0;                   ///< area of all panels inside their sew lines
  std::vector<PatternFinding> half_sewn; ///< see half_sewn()
};

/// Meshes the pattern coarsely and measures it.
/// @throws Error INPUT for a pattern that cannot be meshed
FinishedMeasures finished_measures(const Pattern& pattern, const std::string& file);

/// Measures of the cloth around the trunk.
struct TrunkMeasures {
  std::vector<NamedMeasure> named;           ///< as in FinishedMeasures
  std::vector<std::array<double, 2>> around; ///< as in FinishedMeasures
};

/// Measures of the cloth around the trunk, from a mesh of the pattern. Garments that hang
/// on the shoulders have shoulder, chest (2.5 cm below the armholes), waist (narrowest
/// from 10 to 25 cm below the chest), hip (widest from 15 to 25 cm below the waist),
/// length (highest point to hem), side_seam, neck (the collar's seam, or the neckline);
/// sleeves have sleeve (length), upper_arm (2.5 cm below the sleeve's seam) and cuff.
/// Garments that hang on the waist have waist (the top), hip (widest from 15 to 25 cm
/// below, of trousers at most to 7.5 cm above the crotch), length, side_seam (without a
/// waistband); trousers have rise (front), inseam, thigh (2.5 cm below the crotch) and
/// leg_hem. hem is the lowest opening. Seams count as a whole, on however many edges and
/// panels they are drawn; levels run through seams and darts, and one that is not closed,
/// as below a bodice's shorter front, is no girth.
/// @param mesh  of the pattern
/// @param openings  of the mesh
TrunkMeasures measure_trunk(const Pattern& pattern, const PanelMesh& mesh,
                            const std::vector<Opening>& openings);

/// For the findings document: {"named", "openings", "seams", "around", "cloth_m2"}, m.
io::Json measures_json(const FinishedMeasures& measures);

} // namespace sloper::pattern
