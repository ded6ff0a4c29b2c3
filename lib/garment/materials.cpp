#include <base/error.hpp>
#include <garment/materials.hpp>

namespace sloper::garment {

// Tensile values are secants of KES-F tensile curves at wearing loads (about 50 N/m), not at the 490 N/m end of the test;
// shear G and bending B are KES-F2 and KES-F1 means of warp and weft; densities are shop weights.
static constexpr const char* KES = "typical KES-F values for the class of fabric, after Kawabata, The Standardization and Analysis of Hand Evaluation, 1980";

const std::vector<Material>& material_presets() {
  static const std::vector<Material> presets = {
      {"cotton-poplin", 0.120, 2000, 1400, 60, 8e-6, 0.40, 0.30, 0.02, 0.0004, 0.25, KES},
      {"denim", 0.400, 5000, 3000, 150, 6e-5, 0.45, 0.40, 0.02, 0.0010, 0.25, KES},
      {"silk", 0.060, 1500, 1200, 25, 3e-6, 0.25, 0.20, 0.02, 0.0002, 0.25, KES},
      {"wool-suiting", 0.250, 2500, 1600, 50, 1.2e-5, 0.35, 0.30, 0.02, 0.0007, 0.25, KES},
      {"jersey", 0.160, 500, 250, 60, 4e-6, 0.40, 0.35, 0.03, 0.0006, 0.25, KES},
      {"canvas", 0.350, 6000, 5000, 200, 1e-4, 0.45, 0.40, 0.02, 0.0008, 0.25, KES},
      {"table1", 1.0, 980665, 980665, 98066.5, 9.80665e-7, 0.40, 0.30, 0.02, 0.0005, 0.25, "Sul, Han, Nam, Park 2010, Table 1, as printed"},
  };
  return presets;
}

const Material& material_preset(const std::string& name) {
  std::string names;
  std::vector<std::string> words;
  for (const Material& m : material_presets()) {
    if (m.name == name) return m;
    words.push_back(m.name);
    names += (names.empty() ? "" : ", ") + m.name;
  }
  const std::string near = nearest_word(name, words.data(), words.data() + words.size());
  throw input_error("", "material \"" + name + "\"", "is not known" + (near.empty() ? "" : " (did you mean \"" + near + "\"?)"), "known are " + names);
}

const Material& material_of(const Garment& garment, const std::string& name) {
  if (const auto found = garment.materials.find(name); found != garment.materials.end()) return found->second;
  if (!name.empty()) return material_preset(name);
  return material_presets().front();
}

} // namespace sloper::garment
