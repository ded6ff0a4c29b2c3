#pragma once
/// The frames that garments are bound to and the smooth skin radius R(theta, z) of each.
///
/// Torso, head and legs use the body's own part frames (paper Table 2). An arm is two frames,
/// upper_arm and forearm, because the straight axis from hand_tip to acromion passes through the
/// skin at the shoulder, where theta would be singular, and leaves the arm where the elbow bends.
/// "lower_body" is the joint frame of both legs, for what wraps them together.
#include <body/body.hpp>
#include <geometry/part_frame.hpp>

#include <map>
#include <string>
#include <vector>

namespace sloper::garment {

using Marks = std::map<std::string, double>; ///< z of named heights on a body

struct BindFrame {
  std::string name; ///< torso, head, upper_arm_l, forearm_l, ..., leg_l, leg_r, lower_body
  PartFrame frame;
  body::SkinProfile profile; ///< smooth over about 1.5 cm; filled where the part has no skin
  Marks marks;
};

struct BindFrames {
  std::vector<BindFrame> frames;
  std::vector<int> frame_of_face; ///< #F of the skin, index into frames, -1 for what is not body;
                                  ///< legs are leg_l and leg_r
  int index(const std::string& name) const; ///< -1 when the body lacks it
};

/// All frames that the body's landmarks and skin allow. Cost: one pass over the skin, about 50 ms
/// for 27k triangles.
/// @throws Error INPUT when there is not even a torso
BindFrames make_bind_frames(const body::Body& body);

/// Smooth R(theta, z) through the outermost of `points`: minimises the squared misfit plus sigma^2
/// times the squared gradient, so that cells without points are filled harmonically. n_theta
/// columns, rows of about `row_height`.
/// @param sigma m, smoothing length
body::SkinProfile fit_skin_profile(const PartFrame& frame, const std::vector<Vec3>& points,
                                   double z_low, double z_high, double sigma);

/// A waist is told in up to three ways, by proportion and where girth or width is least, each off
/// by a centimetre or two, so that they lie closer than cloth can follow and one above the other on
/// one body as on no other: "waist" becomes where they lie on average, by how sure they are, of
/// those that both bodies have.
std::pair<Marks, Marks> with_one_waist(Marks from, Marks to);

/// Monotone cubic map of z from one body to another through marks of the same name (Fritsch and
/// Carlson 1980); beyond the outermost marks lengths in metres stay. Marks out of order or closer
/// than 4 cm are left out, the less telling first.
class MarkMap {
public:
  MarkMap(const Marks& from, double from_length, const Marks& to, double to_length);
  double operator()(double z) const;

private:
  std::vector<double> m_x, m_y, m_slope;
  double m_outside_slope; ///< from_length / to_length
};

} // namespace sloper::garment
