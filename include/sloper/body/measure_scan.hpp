#pragma once
/// From a raw scan to a body: the whole of scan-landmarks.
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
#include <sloper/body/landmarks/rules.hpp>
namespace sloper::body {

struct ScanOptions {
  std::string unit = "auto";  ///< auto, m, cm, mm, dm, inch, foot
  double metres_per_unit = 0; ///< of the scan's coordinates, in place of a unit; 0: not given
  double stature_m = 0;    ///< of the person as the scan stands, in place of a unit; 0: not given
  std::string up = "auto"; ///< auto, x, y, z
  bool torso_only =
      false; ///< a scan without legs is taken too: what it shows is found, the rest is not
  Rules rules = Rules::standard();
  const Corrections* corrections = &Corrections::standard(); ///< lives longer than the call
  int jitter = -1; ///< runs of the rules on a jittered skin that measure the spread; -1: 3 up to
                   ///< 80,000 faces, else none
};

struct MeasuredScan {
  Body body;
  std::vector<Part> vertex_part;  ///< one per vertex of the scan, in its order
  std::vector<std::string> trail; ///< the decision path, for --explain
  ShapeFeatures features;         ///< what the corrections looked at
  std::vector<Finding>
      doubts; ///< what is no standing person's, each an error in body.scan.findings too
  std::vector<std::string> missing; ///< essential landmarks that were not found
};

/// @param scan in the file's own unit and order
/// @param file as the user wrote it, for messages and body.scan.file
/// @throws Error INPUT when the scan is no standing body (with torso_only: no head above a trunk
/// either)
MeasuredScan measure_scan(const TriangleMesh& scan, const std::string& file,
                          const std::string& sha256, const ScanOptions& options,
                          Reporter& reporter);

} // namespace sloper::body
