#pragma once
/// The request of a drape: accuracy presets, knobs by name, and the scene document that
/// people write.
/// Test: tests/garment/scene/test_scene_effects.cpp
#include <sloper/garment/composite.hpp>
#include <sloper/garment/scene/effect_report.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// Version of the scene document.
inline constexpr int SCENE_VERSION = 1;

/// scene.json: {"format": "scene", "version": 1, "body", "panels", "accuracy", "effects",
/// "materials", "settings"} and keys for additions (effect_inputs.hpp); every key but the
/// first two is optional, an unknown one is an error. Paths are relative to the scene's
/// folder. A material is a preset's name, a CSV file of measurements, or {"preset",
/// "density_kg_m2", ...}. scene.schema.json has all keys.
struct Scene {
  std::string body, panels; ///< resolved paths, empty when not named
  std::string accuracy;     ///< empty when not named
  std::string effects;      ///< "auto" or names joined by ","; empty when not named
  /// By panel material name; "" is the garment's default.
  std::map<std::string, Material> materials;
  std::vector<std::pair<std::string, double>> settings; ///< knob, value; checked by set_knob
  SceneEffects extras;                                  ///< pins, elastic bands, wind ...
  /// "interfacing": layers that are put on some panels, whatever these are of.
  struct Interfacing {
    std::vector<std::string> panels; ///< names
    /// Layer that is put on each of them.
    ClothLayer layer;
  };
  std::vector<Interfacing> interfacing; ///< in the order of the document
  /// A panel that the document names, for the message where the garment has none of that name.
  struct PanelMention {
    std::string panel, file, place; ///< name, document, JSON pointer
  };
  std::vector<PanelMention> mentions; ///< all of them
};

/// Reads a scene document.
/// @throws Error INPUT with its place
Scene read_scene(const std::string& path);

/// Gives the garment the scene's materials and effects; parts that the scene does not
/// name stay unchanged.
/// @throws Error INPUT with the scene's file and place for a panel that the garment lacks
void apply_scene(const Scene& scene, Garment& garment);

/// Materials of the scene that no panel is of, each named with those that panels are of: a warning,
/// since a scene may serve several garments.
/// @param path  of the scene
std::vector<Message> unused_materials(const Scene& scene, const std::string& path,
                                      const Garment& garment);

/// Puts the scene's interfacing on its panels, once all materials are known: each of them
/// gets a material of its own, layered() on the present one, under a name such as
/// "cotton-poplin+fusible".
/// @throws Error INPUT for a panel that the garment lacks
void apply_interfacing(const Scene& scene, Garment& garment);

/// The settings of a preset.
/// @param accuracy  draft, standard, fine or reference
/// @throws Error USAGE
DrapeSettings preset_settings(const std::string& accuracy);
/// Names of the presets from coarse to fine.
std::vector<std::string> accuracy_names();

/// Names of all knobs, in the order of report.json's `settings`.
std::vector<std::string> knob_names();

/// Sets one knob by its name in report.json's `settings`.
/// @param value  in the unit of the name
/// @throws Error USAGE naming the knobs, or the range
void set_knob(DrapeSettings& settings, const std::string& name, double value);
/// The same from a document.
/// @throws Error INPUT at the value
void set_knob(DrapeSettings& settings, const std::string& name, const io::Node& value);
/// The same from "name=value".
/// @throws Error USAGE
void set_knob(DrapeSettings& settings, const std::string& assignment);

/// All resolved settings, for the report.
io::Json settings_json(const DrapeSettings& settings);

} // namespace sloper::garment
