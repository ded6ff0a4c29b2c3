#pragma once
/// The pattern of a draped garment while it is edited: the garment's panels keep their mesh as long
/// as it can follow, and get another one else.
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace sloper::garment {

/// The pattern and the mesh that stands for it at present.
class LivePattern {
public:
  /// @param garment  sewn, with the pattern that it was meshed from; outlives this
  /// @throws Error INPUT for a garment without its pattern, or whose panels are no longer its
  /// pattern's
  explicit LivePattern(Garment& garment);

  const pattern::Pattern& pattern() const { return m_pattern; }
  /// The garment has this pattern from now on. Positions stay, or are carried to the new mesh.
  /// @return whether particles are as before
  bool adopt(pattern::Pattern next);
  /// Gives the garment back as it came. @return the last pattern
  pattern::Pattern go_to_start();
  /// The garment's panels, placed around the body and unsewn, for a pattern: those of the first
  /// mesh while it can follow, else meshed anew.
  void make_panels(const pattern::Pattern& pattern, const body::Body& body);
  /// Does what the next edit would do first: meshes the pattern that stands, and makes what meshes
  /// follow by.
  void warm_up();
  void ready_follower();

private:
  void note_untaped();
  void tape();
  pattern::PanelMesh mesh_of(const pattern::Pattern& pattern);

  Garment& m_garment;
  Garment m_start; // as it came
  pattern::Pattern m_pattern;
  std::optional<pattern::MeshFollower> m_follower; // none: of m_pattern and the panels as they are
  pattern::MeshMemory m_memory;
  std::vector<std::array<double, 3>> m_untaped; // rest_scale without the tapes, or empty
};

} // namespace sloper::garment
