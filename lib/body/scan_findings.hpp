#pragma once
/// What a user should know of a scan, good or bad: findings of the body document.
#include <body/surface/skin_surface.hpp>
#include <sloper/body/body.hpp>

#include <vector>

namespace sloper::body {

struct SegmentedScan; ///< body/ingest/segmentation.hpp

/// Up axis, roughness, floor, loose pieces and stance.
void add_findings(Body& body, const SegmentedScan& sorted, const SkinSurface& skin);

/// Where the scan's faces have holes: by the landmark that is nearest, and the place.
/// @param origin  what the body was moved by since the holes were found, m
void add_holes(Body& body, const std::vector<Hole>& holes, const Vec3& origin);

/// Names each landmark of the document that was not found and of which nothing says so yet.
void add_missing(Body& body);

/// Which unit was taken and how sure that is: the next guess where it is not much less likely, and
/// statures that few people have.
/// @param given  the unit was stated, not guessed
void add_unit_finding(Body& body, bool given);

} // namespace sloper::body
