#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>
namespace sloper {
using Vec2 = Eigen::Vector2d;        ///< pattern coordinates, m
using Vec3 = Eigen::Vector3d;        ///< world coordinates, m
using Mat3 = Eigen::Matrix3d;        ///< 3 by 3, column-major
using Mat4 = Eigen::Matrix4d;        ///< affine map of homogeneous coordinates
using Triangle = std::array<int, 3>; ///< vertex indices, counter-clockwise seen from outside
} // namespace sloper
