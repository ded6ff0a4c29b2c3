#pragma once
/// What a drape is asked for: accuracy presets, knobs by name, and the scene document that people
/// write.
#include <sloper/garment/composite.hpp>
#include <sloper/garment/scene/effect_report.hpp>
#include <sloper/garment/scene/settings.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

inline constexpr int SCENE_VERSION = 1;

/// scene.json: {"format": "scene", "version": 1, "body", "panels", "accuracy", "effects",
/// "materials", "settings"} and the keys of scene_effects_json.hpp; every key but the first two is
/// optional, an unknown one is an error. Paths are relative to the scene's folder. A material is a
/// preset's name, a CSV file of measurements (kes.hpp), or {"preset", "density_kg_m2", ...}.
struct Scene {
  std::string body, panels; ///< resolved paths, empty when not named
  std::string accuracy;     ///< empty when not named
  std::string effects;      ///< "auto" or names joined by ","; empty when not named
  std::map<std::string, Material>
      materials; ///< by panel material name; "" is the garment's default
  std::vector<std::pair<std::string, double>> settings; ///< knob, value; checked by set_knob
  SceneEffects extras;                                  ///< pins, elastic bands, wind ...
  /// "interfacing": layers that are put on some panels, whatever these are of.
  struct Interfacing {
    std::vector<std::string> panels;
    ClothLayer layer;
  };
  std::vector<Interfacing> interfacing;
};

/// @throws Error INPUT
Scene read_scene(const std::string& path);

/// Gives the garment the scene's materials and effects; what the scene does not name stays as it
/// is.
void apply_scene(const Scene& scene, Garment& garment);

/// Puts the scene's interfacing on its panels, once all materials are known: each gets a material
/// of its own, layered() on the one that it had, under a name such as "cotton-poplin+fusible".
/// @throws Error INPUT for a panel that is not there
void apply_interfacing(const Scene& scene, Garment& garment);

/// The settings of a preset: draft, standard, fine, reference. @throws Error USAGE
DrapeSettings preset_settings(const std::string& accuracy);
std::vector<std::string> accuracy_names();

/// Sets one knob by its name in report.json's `settings`. @throws Error USAGE naming the knobs, or
/// the range
void set_knob(DrapeSettings& settings, const std::string& name, double value);
/// From a document. @throws Error INPUT at the value
void set_knob(DrapeSettings& settings, const std::string& name, const io::Node& value);
/// "name=value"
void set_knob(DrapeSettings& settings, const std::string& assignment);

/// All resolved settings, for the report.
io::Json settings_json(const DrapeSettings& settings);

} // namespace sloper::garment
