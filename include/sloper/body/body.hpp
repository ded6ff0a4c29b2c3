#pragma once
/// A scanned person as the rest of Sloper sees one: landmarks, levels, girths, six parts, bones,
/// part frames and the skin. Names and definitions of landmarks, levels and girths are those of the
/// body document (man 5 body.json).
#include <map>
#include <memory>
#include <optional>
#include <sloper/geometry/part_frame.hpp>
#include <sloper/geometry/triangle_mesh.hpp>
#include <string>
#include <vector>

namespace sloper::collision {
class SkinCache;
}

namespace sloper::body {

/// The six parts of the paper; NONE is what does not belong to the body (floor, pole, debris).
enum class Part : unsigned char {
  HEAD = 0,
  TORSO = 1,
  ARM_L = 2,
  ARM_R = 3,
  LEG_L = 4,
  LEG_R = 5,
  NONE = 255
};
inline constexpr int N_PARTS = 6;
const char* part_name(Part part);                       ///< "head", "torso", "arm_l", ...
std::optional<Part> part_from_name(const std::string&); ///< inverse of part_name

struct Landmark {
  Vec3 p;                         ///< body frame, m
  int step = 1;                   ///< 1 terminal point, 2 curvature point
  std::string rule;               ///< name of the rule that found it
  double confidence = 0;          ///< 0..1
  double spread_m = 0;            ///< spread over slice offset, noise and rotation jitter
  std::vector<Vec3> alternatives; ///< what other rules gave
};

struct Level {
  double y = 0, girth_m = 0, width_m = 0,
         depth_m = 0; ///< taut girth, x extent, z extent of the trunk section
  std::string rule;
  double y_spread_m = 0, girth_spread_m = 0; ///< over slice offset, noise and rotation jitter
};

struct Girth {
  double value_m = 0, spread_m = 0;
};

/// Skin radius R(theta, z) of a part in its frame: n_theta columns from -pi, n_z rows over [z_low,
/// z_high], row-major by z.
struct SkinProfile {
  int n_theta = 0, n_z = 0;
  double z_low = 0, z_high = 1;
  std::vector<double>
      radius; ///< n_z * n_theta, m; every entry positive (gaps in the scan are filled)
  /// Bilinear, periodic in theta, clamped in z.
  double at(double theta, double z) const;
};

struct BodyFrame {
  PartFrame frame;
  SkinProfile profile;
};

struct Bone {
  std::string name, parent; ///< parent empty for the root
  Vec3 head, tail;          ///< m
};

struct Finding {
  std::string severity; ///< "info", "warning", "error"
  std::string what, place;
};

struct ScanInfo {
  std::string file, sha256, unit, up, front;
  int vertices = 0, faces = 0;
  double stature_m = 0;
  std::vector<Finding> findings;
};

struct Body {
  ScanInfo scan;
  Mat4 scan_to_body = Mat4::Identity();
  std::string stance_class;                  ///< "T", "A" or "I"
  double arm_l_deg = 0, arm_r_deg = 0;       ///< angle of the arm from hanging down
  std::map<std::string, Landmark> landmarks; ///< only what was found
  std::map<std::string, Level> levels;
  std::map<std::string, Girth> girths;
  std::map<std::string, BodyFrame>
      frames; ///< by part name; "lower_body" is the joint frame of both legs
  std::vector<Bone> bones;
  std::string body_class; ///< what the decision tree said
  std::vector<std::string> body_class_why;
  TriangleMesh skin;           ///< body frame, m; outward faces
  std::vector<Part> face_part; ///< one per triangle of skin
  /// Where what contact finds out about this skin is kept (collision/skin_cache.hpp); null: it is
  /// found out each time. Not of the document
  std::shared_ptr<collision::SkinCache> skin_cache;

  /// @throws Error INPUT naming the landmark when it was not found
  const Vec3& landmark(const std::string& name) const;
  bool has_landmark(const std::string& name) const { return landmarks.count(name) != 0; }
};

} // namespace sloper::body
