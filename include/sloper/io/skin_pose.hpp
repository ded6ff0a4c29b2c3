#pragma once
/// The two poses of a mesh that joints move.
/// Test: tests/body/ingest/test_scan_reader.cpp
namespace sloper::io {

/// Which of the two poses of a mesh with a skin is read; other meshes have one.
enum class SkinPose {
  AS_SHOWN, ///< that of its joints' nodes, as viewers show it
  BIND      ///< that in which the mesh was bound to its joints: mostly a T or an A
};

} // namespace sloper::io
