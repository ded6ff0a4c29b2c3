#pragma once
/// From a raw scan to a body: the whole of scan-landmarks(1) but its files.
/// Test: tests/body/test_measure_scan.cpp
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
#include <sloper/body/landmarks/rules.hpp>
namespace sloper::body {

/// How to read a scan; the defaults find everything from the scan itself.
struct ScanOptions {
  std::string unit = "auto";  ///< auto, m, cm, mm, dm, inch, foot
  double metres_per_unit = 0; ///< of the scan's coordinates, in place of a unit; 0: not given
  double stature_m = 0;    ///< of the person as the scan stands, in place of a unit; 0: not given
  std::string up = "auto"; ///< auto, x, y, z
  /// Accepts a scan without legs: landmarks that it shows are found, the others are left
  /// out.
  bool torso_only = false;
  /// Decision tree of the landmark rules.
  Rules rules = Rules::standard();
  const Corrections* corrections = &Corrections::standard(); ///< outlives the call
  /// Runs of the rules on a jittered skin that measure the spread; -1: 3 up to 80,000
  /// faces, else none.
  int jitter = -1;
};

/// A measured body and what only a program that explains itself needs beside it.
struct MeasuredScan {
  Body body;                      ///< complete: landmarks, girths, skin, frames, bones
  std::vector<Part> vertex_part;  ///< one per vertex of the scan, in its order
  std::vector<std::string> trail; ///< the decision path, for --explain
  /// Input of the corrections.
  ShapeFeatures features;
  /// Signs that the result is no standing person, each an error in body.scan.findings
  /// too.
  std::vector<Finding> doubts;
  std::vector<std::string> missing; ///< essential landmarks that were not found
};

/// Measures a scan: segments it, sets it upright, closes its skin, runs the landmark
/// rules, and builds parts, frames and bones. Under 1 s of one core for 280,000 triangles
/// (docs/performance.md).
/// @param scan  in the file's own unit and order; without triangles it is a point cloud
/// @param file  as the user wrote it, for messages and body.scan.file
/// @param sha256  of the file, for body.scan
/// @throws Error INPUT when the scan is no standing body (with torso_only: no head above
/// a trunk either)
MeasuredScan measure_scan(const TriangleMesh& scan, const std::string& file,
                          const std::string& sha256, const ScanOptions& options,
                          Reporter& reporter);

} // namespace sloper::body
