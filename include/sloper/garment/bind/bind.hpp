#pragma once
/// Binding: a garment in body-relative coordinates, and placing it from them on a body (Sul et al.
/// 2010, section 2.2).
///
/// A particle at x is kept as sum over its frames k of w_k (theta_k, z_k, gap_k) with gap_k = r_k -
/// R_k(theta_k, z_k), and placed on a body as x' = sum_k w_k F'_k(theta_k, m_k(z_k), R'_k(theta_k,
/// m_k(z_k)) + gap_k); F'_k is PartFrame::point of the other body's frame, m_k the piecewise linear
/// map that brings the marks of the first body (hip, waist, bust, ...) to their like. On the body
/// it was bound to every F_k gives x itself, so that placing there is the identity to rounding
/// whatever the weights are.
/// Test: tests/garment/bind/test_bind.cpp
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Fills garment.bind, body_girths_m (girths and level girths of the body, "level:NAME" for a
/// level) from a garment that hangs on `body`.
/// @throws Error INPUT when the garment is not sewn or the body has none of the frames it would
/// hang on
void bind_garment(Garment& garment, const body::Body& body);

/// Which height of the other body the waist of a garment is mapped to.
enum class Waist {
  /// Level waist_semantic to the same level: cloth slides from there to where it is held.
  SEMANTIC,
  /// Weighted mean of all levels that both bodies have for a waist: for graded cloth,
  /// whose girth is taken where it is placed.
  OF_ALL
};

/// Positions of the particles on `body`, #P by 3, m. Pure geometry: collisions and strain
/// are not considered.
/// @param waist  height that the waist is mapped to
/// @param lower_m  m by which the whole garment is placed lower, its gap to the skin kept
/// @throws Error INPUT when the garment is not bound or hangs on a part that `body` lacks
std::vector<Vec3> place_garment(const Garment& garment, const body::Body& body,
                                Waist waist = Waist::SEMANTIC, double lower_m = 0);

} // namespace sloper::garment
