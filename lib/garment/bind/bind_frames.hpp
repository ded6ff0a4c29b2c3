#pragma once
/// The frames that garments are bound to and the smooth skin radius R(theta, z) of each.
///
/// Torso, head and legs use the body's own part frames (paper Table 2). An arm is two frames,
/// upper_arm and forearm, because the straight axis from hand_tip to acromion passes through the
/// skin at the shoulder, where theta would be singular, and leaves the arm where the elbow bends.
/// "lower_body" is the joint frame of both legs, for what wraps them together.
#include <sloper/body/body.hpp>
#include <sloper/geometry/part_frame.hpp>

#include <map>
#include <string>
#include <vector>

namespace sloper::garment {

using Marks = std::map<std::string, double>; ///< z of named heights on a body

/// One frame of a body, with the skin around it and the heights that all bodies share.
struct BindFrame {
  std::string name; ///< torso, head, upper_arm_l, forearm_l, ..., leg_l, leg_r, lower_body
  PartFrame frame;
  std::vector<body::Part> parts; ///< whose skin is around it
  double z_low, z_high;          ///< of that skin
  body::SkinProfile profile; ///< smooth over about 1.5 cm; filled where the part has no skin; empty
                             ///< until fit_profiles()
  Marks marks;
};

/// All frames that a body has.
struct BindFrames {
  std::vector<BindFrame> frames;
  std::vector<int> frame_of_face; ///< #F of the skin, index into frames, -1 for what is not body;
                                  ///< legs are leg_l and leg_r
  int index(const std::string& name) const; ///< -1 when the body lacks it
};

/// All frames that the body's landmarks and skin allow, without profiles.
/// @throws Error INPUT when there is not even a torso
BindFrames make_bind_frames(const body::Body& body);

/// Fits the profiles of those frames that are needed. Cost: 1 to 15 ms a frame of a body of 27k
/// triangles.
/// @param needed  of each frame
void fit_profiles(BindFrames& frames, const body::Body& body, const std::vector<char>& needed);

/// Smooth R(theta, z) through the outermost of `points`: minimises the squared misfit plus sigma^2
/// times the squared gradient, so that cells without points are filled harmonically. n_theta
/// columns, rows of about `row_height`.
/// @param sigma m, smoothing length
body::SkinProfile fit_skin_profile(const PartFrame& frame, const std::vector<Vec3>& points,
                                   double z_low, double z_high, double sigma);

/// Up to three rules give a waist, by proportion and where girth or width is least: 1 to 2 cm
/// apart, in an order that varies between bodies. As marks they would lie closer than cloth can
/// follow. They become one mark "waist": the mean of the rules that both bodies have, weighted by
/// confidence.
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
