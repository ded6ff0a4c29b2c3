#pragma once
/// A body drawn in towards its bones, so that panels that begin inside it lie outside. It
/// is inflated again while the cloth gives way (simulate/phases/inflate.hpp).
#include <sloper/body/body.hpp>

namespace sloper::garment {

/// The skin with the point of its bones that each vertex is drawn towards.
class BodyShrink {
public:
  /// Finds for each skin vertex the nearest point on the bones of its own part. @throws Error INPUT
  /// when landmarks are missing
  explicit BodyShrink(const body::Body& body);
  /// Skin at scale s: b + s (p - b); 1 is the body itself, 0 the bones.
  std::vector<Vec3> positions(double s) const;
  /// Largest distance of a skin vertex from its bone point, m.
  double reach() const { return m_reach; }

private:
  std::vector<Vec3> m_skin, m_bone_point;
  double m_reach = 0;
};

} // namespace sloper::garment
