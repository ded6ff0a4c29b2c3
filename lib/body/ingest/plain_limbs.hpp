#pragma once
/// Plain legs and a plain head that complete a torso, so that rules of proportion run on it as on a
/// whole person. They carry no measurement. Test: tests/body/ingest/test_torso_only.cpp,
/// tests/body/ingest/test_headless_torso.cpp
#include <sloper/geometry/types.hpp>
#include <vector>
namespace sloper::body {

/// The scan upright along one of its axes: height, and two coordinates across, the file's unit.
struct Upright {
  int axis = 1;
  double sign = 1;
  double height(const Vec3& p) const { return sign * p[axis]; }
  Vec2 across(const Vec3& p) const { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }
  Vec3 point(const Vec2& a, double height) const {
    Vec3 p;
    p[axis] = sign * height;
    p[(axis + 1) % 3] = a.x();
    p[(axis + 2) % 3] = a.y();
    return p;
  }
};

/// Points of plain legs below a trunk of stature `s`, as (left, height above the floor, forward).
/// @param rim points of the trunk where it ends, (left, forward)
/// @param cut height at which it ends
std::vector<Vec3> plain_legs(const std::vector<Vec2>& rim, double cut, double s);

/// Points of a plain head, and of a neck up to it, over a neck that is cut off, in the same frame.
/// @param rim points of the neck where it ends, (left, forward)
/// @param cut height at which it ends
std::vector<Vec3> plain_head(const std::vector<Vec2>& rim, double cut, double s);

} // namespace sloper::body
