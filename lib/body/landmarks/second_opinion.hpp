#pragma once
/// Compares the height of a landmark with the one that the rest of the body predicts. Where they
/// differ by more than on the bodies that were learned from, one is wrong, and a warning says so.
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
namespace sloper::body {

/// Compares the height y of each landmark with its expected height e (Corrections::expected, of
/// standard deviation d): their agreement exp(-((y - e) / d)^2 / 2 / 4) is a factor of the
/// confidence, and beyond 4.5 d, of a rebuilt skin 3 d, the landmark is named in the findings, with
/// the other height as an alternative. Bodies unlike those learned from are not judged, and
/// of those that are only a little like them not the crotch that the skin shows.
/// @param features of the same body
/// @param rebuilt the skin is not the scan's own
/// @param trail what each of the two said, a line a landmark that is judged
/// @return findings of severity "warning"
std::vector<Finding> second_opinions(Body& body, const Corrections& corrections,
                                     const ShapeFeatures& features, bool rebuilt,
                                     std::vector<std::string>& trail);

} // namespace sloper::body
