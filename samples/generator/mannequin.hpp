#pragma once
/// A mannequin family of our own: a person's shape from proportions, girths and a stance.
///
/// Heights and breadths are fractions of stature after the averages of Drillis and Contini (1966,
/// as printed in Winter, Biomechanics and Motor Control of Human Movement) and the means of the US
/// Army survey ANSUR II (2012); girths default to ANSUR II means at a body mass index of about 24
/// and grow with the square root of the index, since at one stature a cross-section's area grows
/// with mass. Frame: m, y up, the figure faces +z, +x is its left, feet at y = 0, origin below the
/// middle of the hip joints.
#include <map>
#include <sloper/geometry/triangle_mesh.hpp>
#include <sloper/io/json.hpp>
#include <string>
#include <vector>
namespace sloper::samples {

struct Mannequin {
  std::string sex = "f";   ///< "f" or "m"
  double stature_m = 1.65; ///< 1.2 .. 2.1
  double bmi = 23;         ///< kg/m2, 15 .. 45; decides the girths that are not given
  double arm_deg = 40;     ///< angle of the arms from hanging down, 10 .. 90
  double leg_deg = 5;      ///< angle of each leg from vertical, 0 .. 15
  double cell_m = 0.0125;  ///< edge length of the mesh
  /// m; names: neck, bust, underbust, waist, abdomen, hip, thigh, knee, calf, ankle, upper_arm,
  /// forearm, wrist. Missing ones are filled in.
  std::map<std::string, double> girths_m;
};

/// What the generator makes: the mesh and everything that is known about it by construction.
struct MadeMannequin {
  TriangleMesh mesh;
  std::vector<unsigned char>
      parts;      ///< one per vertex: 0 head, 1 torso, 2 arm_l, 3 arm_r, 4 leg_l, 5 leg_r
  io::Json truth; ///< landmarks, levels, girths_m under the names of the body document
  /// m, as the figure came out, under the names of Mannequin::girths_m and measured as they are
  /// meant there. The document's thigh, abdomen and underbust are taken elsewhere.
  std::map<std::string, double> girths_m;
};

/// Girths of a figure of that sex, stature and body mass index, m.
std::map<std::string, double> default_girths(const Mannequin& shape);

/// A figure of the family by name, as "f-165-a"; the names are listed by preset_names().
/// @throws Error USAGE with the nearest name
Mannequin preset(const std::string& name);
std::vector<std::string> preset_names();

/// Makes the figure. The same parameters give the same bytes.
/// @throws Error USAGE for a parameter outside its range, FAILED when the girths cannot be had
/// together (arms inside the hips)
MadeMannequin make_mannequin(const Mannequin& shape);

} // namespace sloper::samples
