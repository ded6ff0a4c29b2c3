#pragma once
/// Level sections of the trunk and its front, as the landmarks of bust, waist, belly and seat read
/// them.
#include <body/landmarks/landmark_finder.hpp>
#include <body/measure/foremost.hpp>
namespace sloper::body {

constexpr double FRONT_HALF_WIDTH = 0.006; ///< of stature, over which the front is read
constexpr double LEVEL_STEP_M = 0.002;     ///< between levels of a girth's curve
constexpr double ABOVE_CROTCH_M = 0.004;   ///< the first level that is the trunk's
constexpr double PEAKED = 0.00018;         ///< of stature: as far out as the top of what has one

/// Height above which an arm is part of the trunk's outline, m: where the sections of both meet,
/// which may lie below the pit, in its middle. An arm that touches hangs on the trunk below its pit
/// too. @param arm  with a pit   @param stature  m
double arm_joins(const ArmTrace& arm, double stature);
/// The trunk's outline at height y, m, without arms that hang on it: clipped at the arm pits.
/// @return nothing where there is no trunk
std::optional<Level> measure_level(const Finder& f, double y);
/// An arm that touches the trunk below the pit is part of the outline at height y, m, which tells
/// no breadth of the trunk then.
bool arm_hangs_on(const Finder& f, double y);
/// The level `name` at height y, m, where there is a trunk.
void put_level(const Finder& f, const std::string& name, double y, const std::string& rule);
/// The level `name` by the first rule of the tree that finds it.
void find_level(const Finder& f, const std::string& name,
                std::initializer_list<LandmarkRule<Level>> rules);
/// Foremost skin of the trunk's section at (x, y), m.
std::optional<Vec3> front_at(const Finder& f, double x, double y, double half_width);
std::optional<Vec3> place_of(const std::optional<Foremost>& foremost);

} // namespace sloper::body
