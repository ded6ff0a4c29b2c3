#pragma once
/// What the rest of the body says of a landmark: where the two disagree by more than the bodies
/// that were learned from do, one of them is wrong, and that is told.
#include <body/body.hpp>
#include <body/landmarks/corrections.hpp>
namespace sloper::body {

/// Compares the height y of each landmark with its expected height e (Corrections::expected, of
/// standard deviation d): their agreement exp(-((y - e) / d)^2 / 2 / 4) is a factor of the
/// confidence, and beyond 4.5 d the landmark is named in the findings, with the other height as an
/// alternative. Bodies unlike those learned from are not judged.
/// @param features of the same body
/// @param trail what each of the two said, a line a landmark that is judged
/// @return findings of severity "warning"
std::vector<Finding> second_opinions(Body& body, const Corrections& corrections,
                                     const ShapeFeatures& features,
                                     std::vector<std::string>& trail);

} // namespace sloper::body
