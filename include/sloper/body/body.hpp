#pragma once
/// A scanned person as every later stage sees one: landmarks, levels, girths, six parts,
/// bones, part frames and the skin. Names and definitions of landmarks, levels and girths
/// are those of the body document, body.json(5).
#include <map>
#include <memory>
#include <optional>
#include <sloper/base/message.hpp>
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
/// Number of parts without NONE: values of Part below it index arrays.
inline constexpr int N_PARTS = 6;
/// "head", "torso", "arm_l", "arm_r", "leg_l", "leg_r"; "none" for NONE.
const char* part_name(Part part);
/// Inverse of part_name(); empty for any other text.
std::optional<Part> part_from_name(const std::string&);

/// A named place on the skin, or a joint inside the body, with how it was found.
struct Landmark {
  Vec3 p; ///< body frame, m
  /// 1 terminal point of the surface, 2 point found from a profile or other landmarks.
  int step = 1;
  std::string rule;      ///< name of the rule that found it
  double confidence = 0; ///< 0..1; below 0.5 it is an estimate
  /// Root mean square distance it moves when the rules run again on jittered skins; without
  /// such runs the usual spread of its rule.
  double spread_m = 0;
  std::vector<Vec3> alternatives; ///< m; what other rules gave, where more than 1 mm away
};

/// A height at which the trunk is measured, such as "waist".
struct Level {
  /// Height, then taut girth and x and z extents of the trunk section there, without
  /// arms; m.
  double y = 0, girth_m = 0, width_m = 0, depth_m = 0;
  std::string rule; ///< name of the rule that found it
  /// As Landmark::spread_m.
  double y_spread_m = 0, girth_spread_m = 0;
};

/// Taut (convex) length around a limb or the neck, and its spread as Landmark::spread_m.
struct Girth {
  double value_m = 0, spread_m = 0; ///< m
};

/// Skin radius R(theta, z) of a part in its frame: n_theta columns from -pi, n_z rows
/// over [z_low, z_high], row-major by z.
struct SkinProfile {
  int n_theta = 0, n_z = 0; ///< columns and rows; 0: no profile
  /// Range of the rows along the frame's axis: 0 at L, 1 at U.
  double z_low = 0, z_high = 1;
  /// n_z * n_theta radii, m; every entry positive (gaps in the scan are filled).
  std::vector<double> radius;
  /// Bilinear in both, periodic in theta (rad), clamped in z.
  /// @return m; 0 without a profile
  double at(double theta, double z) const;
};

/// The coordinate frame of a part with the skin in it (Sul et al. 2010, section 2.2).
struct BodyFrame {
  PartFrame frame;     ///< axis and origin of theta
  SkinProfile profile; ///< radius of the skin in that frame
};

/// A line between two joints; parents come before their children.
struct Bone {
  std::string name, parent; ///< parent empty for the root
  Vec3 head, tail;          ///< m
};

/// Something about a scan that its user should know.
struct Finding {
  Finding() = default;
  /// @param how_severe  "info" or "warning"
  /// @param where  landmark, part or point; may be empty
  Finding(MessageId message, std::string how_severe, std::string fact, std::string where)
      : id(message.text()), severity(std::move(how_severe)), what(std::move(fact)),
        place(std::move(where)) {}
  std::string id;       ///< as docs/messages.md lists it; empty where an older document has none
  std::string severity; ///< "info", "warning", "error"
  /// The fact; landmark, part or point that it concerns, may be empty.
  std::string what, place;
};

/// The scan a body was measured from, and how it was understood.
struct ScanInfo {
  /// File name without folder, its hash, unit; axes of the scan that are up and front.
  std::string file, sha256, unit, up, front;
  int vertices = 0, faces = 0;   ///< of the file; a point cloud has no faces
  double stature_m = 0;          ///< crown above soles, as the scan stands
  std::vector<Finding> findings; ///< what was odd, estimated or missing
};

/// A measured person in the body frame: m, y up, facing +z, +x the body's left, soles at
/// y = 0. Contents of body.json(5) and its OBJ.
struct Body {
  ScanInfo scan; ///< where it comes from
  /// Brings scan coordinates, in the scan's unit, into the body frame.
  Mat4 scan_to_body = Mat4::Identity();
  std::string stance_class;                  ///< "T", "A" or "I": stance_of()
  double arm_l_deg = 0, arm_r_deg = 0;       ///< angle of the arm from hanging down
  std::map<std::string, Landmark> landmarks; ///< by name; only what was found
  std::map<std::string, Level> levels;       ///< by name: "waist", "bust", "hip", ...
  std::map<std::string, Girth> girths;       ///< of limbs and neck, by name: "upper_arm_l", ...
  /// By part name; "lower_body" is the joint frame of both legs.
  std::map<std::string, BodyFrame> frames;
  std::vector<Bone> bones;                 ///< parents first
  std::string body_class;                  ///< proportions that the rules expected
  std::vector<std::string> body_class_why; ///< reasons for body_class
  TriangleMesh skin;                       ///< body frame, m; outward faces
  std::vector<Part> face_part;             ///< one per triangle of skin
  /// Warnings of reading: a skin that is not the one written. Not part of the document.
  std::vector<Message> file_findings;
  /// Keeps the prepared skin for contact (collision/skin_cache.hpp); null: it is prepared
  /// anew each time. Not part of the document.
  std::shared_ptr<collision::SkinCache> skin_cache;

  /// Position of a landmark, m.
  /// @throws Error INPUT naming the landmark when it was not found
  const Vec3& landmark(const std::string& name) const;
  /// Whether the landmark was found.
  bool has_landmark(const std::string& name) const { return landmarks.count(name) != 0; }
};

/// The stance of a body whose arms are `arms_deg` from hanging down, on average of both: "T" beyond
/// 70 degrees, "A" beyond 15, else "I".
std::string stance_of(double arms_deg);

} // namespace sloper::body
