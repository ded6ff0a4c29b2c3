#pragma once
/// A body for other programs: a table of measurements, files of pattern programs, a
/// skeleton, and the body without its skin.
/// Test: tests/body/export/test_pattern_exports.cpp
#include <sloper/body/body.hpp>
namespace sloper::body {

/// CSV with a heading: kind,name,value_m,spread_m,iso_8559_1. Stature, girths, level heights and
/// level girths.
std::string measurements_csv(const Body& body);
/// Individual measurements for Valentina (.vit, XML, cm), by the names of its measurement table.
/// Needs the skin.
std::string valentina_measurements(const Body& body);
/// A body file for GarmentCode (YAML, cm and degrees). Needs the skin; arm_pose_angle is measured
/// down from level.
std::string garmentcode_body(const Body& body);
/// OBJ text of the bones as lines, in the body frame, for viewers.
std::string skeleton_obj(const Body& body);
/// Removes the skin and all data that identify the scan, so that nobody can be
/// recognised; keeps landmarks, levels, girths, frames and bones.
void anonymise(Body& body);

} // namespace sloper::body
