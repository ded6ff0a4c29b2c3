#include <garment/drape/live_pattern.hpp>
#include <garment/retarget/state_transfer.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/place/place_panels.hpp>

namespace sloper::garment {

namespace {

constexpr double LEAST_ANGLE_DEG = 15; // a mesh that follows an edit is kept while it is no worse
constexpr double OFF_OUTLINE = 1e-4;   // m: vertices further off are not of this pattern

} // namespace

LivePattern::LivePattern(Garment& garment) : m_garment(garment) {
  if (garment.particle_of.empty())
    throw input_error("garment.not-sewn"_id, "", "", "the garment is not sewn yet",
                      "drape it first, then let it follow edits");
  if (!garment.panels.source)
    throw input_error("garment.no-pattern"_id, "", "",
                      "the garment does not know the pattern it was made from",
                      "mesh and drape the pattern again");
  m_pattern = *garment.panels.source;
  ready_follower();
  if (m_follower->off_outline() > OFF_OUTLINE)
    throw input_error("garment.no-pattern"_id, "", "",
                      "the panels are no longer those of the garment's pattern: a vertex lies " +
                          pattern::centimetres(m_follower->off_outline()) + " off its outline",
                      "edits can follow a garment that drape made, not one that was regraded");
  note_untaped();
  m_start = m_garment;
}

void LivePattern::note_untaped() {
  m_untaped = m_garment.rest_scale;
  const std::vector<std::array<double, 3>> scale = pattern::tape_scales(m_garment.panels);
  if (scale.empty())
    return;
  for (std::size_t f = 0; f < m_untaped.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      m_untaped[f][k] /= scale[f][k];
}

/// Elastic tapes on top of the rest lengths that the garment came with.
void LivePattern::tape() {
  std::vector<std::array<double, 3>> scale = pattern::tape_scales(m_garment.panels);
  if (scale.empty()) {
    scale = m_untaped;
  } else {
    for (std::size_t f = 0; f < m_untaped.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        scale[f][k] *= m_untaped[f][k];
  }
  m_garment.rest_scale = std::move(scale);
}

void LivePattern::ready_follower() {
  if (!m_follower)
    m_follower.emplace(m_pattern, m_garment.panels);
}

pattern::PanelMesh LivePattern::mesh_of(const pattern::Pattern& pattern) {
  const pattern::PanelMesh& now = m_garment.panels;
  return pattern::mesh_pattern(
      pattern, pattern::lengths_for_rolls(pattern, now.edge_length, now.seam_length), "edits",
      &m_memory);
}

void LivePattern::warm_up() {
  pattern::Pattern on_grid = m_pattern; // as after any edit
  pattern::apply_edits(
      on_grid, io::Json{{"format", "edits"}, {"length_unit", "m"}, {"edits", io::Json::array()}},
      "");
  mesh_of(on_grid);
}

bool LivePattern::adopt(pattern::Pattern next) {
  ready_follower();
  const bool follows = m_follower->follow(next, m_garment.panels, LEAST_ANGLE_DEG);
  if (!follows) {
    transfer_state(m_garment, mesh_of(next));
    m_follower.reset(); // made when there is time
    m_untaped.clear();  // it counted old triangles
  }
  m_pattern = std::move(next);
  m_garment.panels.source = std::make_shared<pattern::Pattern>(m_pattern);
  tape();
  return follows;
}

pattern::Pattern LivePattern::go_to_start() {
  pattern::Pattern last = std::move(m_pattern);
  m_garment = m_start;
  m_pattern = *m_start.panels.source;
  m_follower.reset();
  ready_follower();
  note_untaped();
  return last;
}

void LivePattern::make_panels(const pattern::Pattern& pattern, const body::Body& body) {
  if (!m_follower->follow(pattern, m_garment.panels, LEAST_ANGLE_DEG)) {
    m_garment.panels = mesh_of(pattern);
    m_untaped.clear();
  }
  m_garment.panels.source = std::make_shared<pattern::Pattern>(pattern);
  tape();
  pattern::place_panels(pattern, body, m_garment.panels);
  m_garment.particle_of.clear();
  m_garment.position.clear();
  m_garment.bind = {};
}

} // namespace sloper::garment
