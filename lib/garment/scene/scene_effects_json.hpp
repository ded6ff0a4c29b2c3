#pragma once
/// The keys of a scene that describe effects, at the root of scene.json and under "scene" of a
/// garment document:
///   "membrane": "springs" | "triangles" | "fem", "bending": "isometric" | "dihedral"
///   "pins":        [{PLACE, "target_m": [x, y, z], "stiffness_n_m"}]           without a target:
///   held where it was placed "bands":       [{PLACE, "ratio", "strength_n"}] elastic sewn along a
///   line "attachments": [{PLACE, "anchor_m": [x, y, z] or "landmark": NAME, "rest_length_m",
///   "stiffness_n_m"}] "shrink":      [{"panel", "from": [s, t], "to": [s, t], "warp", "weft"}] b_v
///   and b_u; no panel: all, no region: the whole panel "creases":     [{PLACE, "angle_deg"}] rest
///   angle, positive folds away from the outside; "roll_lines": the same, 165 degrees and firm;
///   "closures":
///   [{"kind": "buttons" | "zip", "panel", "from", "to", "with": PLACE, "count", "stiffness_n_m"}];
///   "wind_m_s": [x, y, z]; [0, 0, 0] is still air "pressure_pa": number
/// PLACE is "panel" with "at": [s, t], or with "from" and "to" for a line.
#include <sloper/garment/scene/effect_inputs.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// Keys that are absent keep their default. @throws Error INPUT with file and place
SceneEffects read_scene_effects(const io::Node& node);
/// Only what differs from the default.
io::Json scene_effects_json(const SceneEffects& scene);

} // namespace sloper::garment
