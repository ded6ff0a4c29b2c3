#include <sloper/base/error.hpp>
#include <sloper/garment/materials.hpp>

#include <algorithm>
#include <map>

namespace sloper::garment {

// Behind the name: friction on the body, on cloth, thickness (m), source. Tensile values are
// secants of KES-F1 curves at wearing loads (about 50 N/m), not at the 490 N/m end of the test;
// shear G and bending B are KES-F1 and KES-F2 means of warp and weft. Where no one fabric is named,
// values lie in the middle of those of the class in Kawabata, The Standardization and Analysis of
// Hand Evaluation, 1980. What ties them to cloth as it hangs is the drape coefficient (Cusick, BS
// 5058): tests/validation/test_cusick.cpp drapes each and compares.
static std::vector<Material> measured_alike() {
  return {
      {{.density_kg_m2 = 0.120,
        .stretch_warp_n_m = 2000,
        .stretch_weft_n_m = 1400,
        .shear_n_m = 60,
        .bend_n_m = 8e-6,
        .damping_s = 0.02,
        .poisson = 0.243},
       "cotton-poplin",
       0.40,
       0.30,
       0.0004,
       "KES-F class means for shirting (Kawabata 1980); Poisson's ratio of plain cotton: Penava et "
       "al. 2014, table 3; drape coefficient "
       "against Gan, Ly and Steven 1991 (68.4 %)"},
      {{.density_kg_m2 = 0.400,
        .stretch_warp_n_m = 5000,
        .stretch_weft_n_m = 3000,
        .shear_n_m = 150,
        .bend_n_m = 6e-5,
        .damping_s = 0.02,
        .poisson = 0.25},
       "denim",
       0.45,
       0.40,
       0.0010,
       "KES-F class means for 12 oz cotton twill (after Lam and Postle 2006); drape coefficient of "
       "heavy twills, 70-90 %"},
      {{.density_kg_m2 = 0.080,
        .stretch_warp_n_m = 1500,
        .stretch_weft_n_m = 1200,
        .shear_n_m = 14,
        .bend_n_m = 1e-6,
        .damping_s = 0.02,
        .poisson = 0.25},
       "silk",
       0.25,
       0.20,
       0.0002,
       "KES-F class means for dress silk, crepe de Chine of 19 momme; drape coefficient against "
       "Matsudaira and Yang 2003 (20-40 %)"},
      {{.density_kg_m2 = 0.235,
        .stretch_warp_n_m = 2500,
        .stretch_weft_n_m = 1600,
        .shear_n_m = 50,
        .bend_n_m = 1.2e-5,
        .damping_s = 0.02,
        .poisson = 0.277},
       "wool-suiting",
       0.35,
       0.30,
       0.00057,
       "weight, thickness and Poisson's ratio of wool: Penava et al. 2014, tables 1 and 3; else "
       "KES-F class means for worsted suiting "
       "(Kawabata 1980); drape coefficient of worsteds, 40-70 %"},
      {{.density_kg_m2 = 0.160,
        .stretch_warp_n_m = 500,
        .stretch_weft_n_m = 250,
        .shear_n_m = 60,
        .bend_n_m = 4e-6,
        .damping_s = 0.03,
        .poisson = 0.35},
       "jersey",
       0.40,
       0.35,
       0.0006,
       "KES-F class means for single-jersey outerwear knits (Kawabata 1980)"},
      {{.density_kg_m2 = 0.350,
        .stretch_warp_n_m = 6000,
        .stretch_weft_n_m = 5000,
        .shear_n_m = 200,
        .bend_n_m = 1e-4,
        .damping_s = 0.02,
        .poisson = 0.20},
       "canvas",
       0.45,
       0.40,
       0.0008,
       "KES-F class means for plain cotton canvas of 10 oz; no drape coefficient published"},
      {{.density_kg_m2 = 1.0,
        .stretch_warp_n_m = 980665,
        .stretch_weft_n_m = 980665,
        .shear_n_m = 98066.5,
        .bend_n_m = 9.80665e-7,
        .damping_s = 0.02,
        .poisson = 0.25},
       "table1",
       0.40,
       0.30,
       0.0005,
       "Sul, Han, Nam, Park 2010, Table 1, as printed"},
      {{.density_kg_m2 = 0.055,
        .stretch_warp_n_m = 1200,
        .stretch_weft_n_m = 700,
        .shear_n_m = 80,
        .bend_n_m = 5e-6,
        .damping_s = 0.02,
        .poisson = 0.2},
       "fusible",
       0.40,
       0.30,
       0.0003,
       "a light woven fusible interlining: the middle of what makers' sheets say, no one fabric"},
      {{.density_kg_m2 = 0.070,
        .stretch_warp_n_m = 1500,
        .stretch_weft_n_m = 1000,
        .shear_n_m = 25,
        .bend_n_m = 3e-6,
        .damping_s = 0.02,
        .poisson = 0.25},
       "lining",
       0.20,
       0.20,
       0.00015,
       "KES-F ranges of acetate and viscose lining (Kawabata 1980), their middle"},
  };
}

namespace {

/// How the rigidities of fabrics of like weight differ by direction: medians of measured fabrics.
struct Directions {
  const char* preset;
  double warp_over_weft, bias_over_mean;
  int fabrics;
};
// Feng, Huang, Xu and Wang 2022 ("Learning-based bending stiffness parameter estimation by a drape
// tester"), cantilever lengths of 618 fabrics along warp, weft and diagonal: within 0.06-0.10,
// 0.10-0.14, 0.20-0.27, 0.33-0.47 and 0.30-0.40 kg/m2.
constexpr Directions DIRECTIONS[] = {
    {"silk", 1.15, 0.90, 84},  {"cotton-poplin", 1.51, 0.96, 73}, {"wool-suiting", 1.76, 1.02, 127},
    {"denim", 1.67, 0.82, 80}, {"canvas", 1.42, 1.06, 71},
};

/// The preset with its mean rigidity, by direction.
Material by_direction(Material m, const Directions& d) {
  m.bend_weft_n_m = 2 * m.bend_n_m / (1 + d.warp_over_weft);
  m.bend_warp_n_m = d.warp_over_weft * m.bend_weft_n_m;
  m.bend_bias_n_m = d.bias_over_mean * m.bend_n_m;
  m.name += "-orthotropic";
  m.source += "; bending by direction: medians of " + std::to_string(d.fabrics) +
              " fabrics of like weight, Feng et al. 2022";
  return m;
}

} // namespace

const std::vector<Material>& material_presets() {
  static const std::vector<Material> presets = [] {
    std::vector<Material> all = measured_alike();
    const std::size_t n = all.size();
    for (const Directions& d : DIRECTIONS)
      for (std::size_t k = 0; k < n; ++k)
        if (all[k].name == d.preset)
          all.push_back(by_direction(all[k], d));
    return all;
  }();
  return presets;
}

const Material& material_preset(const std::string& name) {
  std::string names;
  std::vector<std::string> words;
  for (const Material& m : material_presets()) {
    if (m.name == name)
      return m;
    words.push_back(m.name);
    names += (names.empty() ? "" : ", ") + m.name;
  }
  throw input_error("material.unknown"_id, "", "material \"" + name + "\"",
                    "is not known" + did_you_mean(name, words), "known are " + names);
}

const Material& material_of(const Garment& garment, const std::string& name) {
  if (const auto found = garment.materials.find(name); found != garment.materials.end())
    return found->second;
  if (!name.empty())
    return material_preset(name);
  return material_presets().front();
}

std::string main_material(const Garment& garment) {
  std::map<std::string, int> triangles;
  for (const pattern::PanelInfo& panel : garment.panels.panels) {
    const auto own = garment.materials.find(
        panel.material); // a panel not yet draped may name one that only a scene knows
    const std::string& name = own != garment.materials.end() ? own->second.name : panel.material;
    triangles[name.empty() ? material_presets().front().name : name] += panel.n_triangles;
  }
  if (triangles.empty())
    return {};
  return std::max_element(triangles.begin(), triangles.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

} // namespace sloper::garment
