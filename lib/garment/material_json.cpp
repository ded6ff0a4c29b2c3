#include <garment/kes.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/number_text.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/composite.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <cmath>

namespace sloper::garment {

namespace {

struct MaterialKey {
  const char* name;
  double Material::*field;
  double low, high;
  const char* measured = ""; ///< column of a table of measurements that it follows from
};
/// Keys that stand in each material.
constexpr MaterialKey MATERIAL_KEYS[] = {
    {"density_kg_m2", &Material::density_kg_m2, 1e-3, 100, "W"},
    {"stretch_warp_n_m", &Material::stretch_warp_n_m, 1e-3, 1e9, "EMT"},
    {"stretch_weft_n_m", &Material::stretch_weft_n_m, 1e-3, 1e9, "EMT"},
    {"shear_n_m", &Material::shear_n_m, 0, 1e9, "G"},
    {"bend_n_m", &Material::bend_n_m, 0, 1e3, "B"},
    {"friction_body", &Material::friction_body, 0, 10},
    {"friction_self", &Material::friction_self, 0, 10, "MIU"},
    {"damping_s", &Material::damping_s, 0, 10},
    {"thickness_m", &Material::thickness_m, 0, 0.05, "T0"},
    {"poisson", &Material::poisson, 0, 0.95},
};
/// Those that stand where they are not 0.
constexpr MaterialKey DIRECTION_KEYS[] = {
    {"bend_warp_n_m", &Material::bend_warp_n_m, 0, 1e3},
    {"bend_weft_n_m", &Material::bend_weft_n_m, 0, 1e3},
    {"bend_bias_n_m", &Material::bend_bias_n_m, 0, 1e3},
    {"bend_soft_share", &Material::bend_soft_share, 0, 1},
};
/// Of a rigidity that a message asks for, rounded up: 1 / (N m).
constexpr double ASKED_STEPS = 1e9;
constexpr MaterialKey SOFT_RADIUS = {"bend_soft_radius_m", &Material::bend_soft_radius_m, 1e-4, 10};

void read_key(const io::Node& node, const MaterialKey& key, Material& m) {
  if (!node.has(key.name))
    return;
  m.*key.field = node.at(key.name).number();
  if (m.*key.field < key.low || m.*key.field > key.high)
    node.at(key.name).fail("json.out-of-range"_id, "is out of range",
                           "give a value from " + range_text(key.low, key.high));
}

Material named_material(const io::Node& node) {
  try {
    const std::string name = node.string();
    const bool is_file = name.find(".csv") != std::string::npos || io::ending_of(name) == ".json";
    return material_from(is_file ? io::path_beside(node.file(), name) : name);
  } catch (const Error& e) { // the material's own file and line stay in the text
    node.fail(e.id(), e.what());
  }
}

/// A measured fabric is held to the ranges of a written one.
Material measured_material(const std::string& path) {
  const Material m = read_kes(path);
  for (const MaterialKey& key : MATERIAL_KEYS)
    if (!(m.*key.field >= key.low && m.*key.field <= key.high))
      throw input_error("kes.malformed"_id, path, "property " + std::string(key.measured),
                        "its values give a " + std::string(key.name) + " of " +
                            rounded_text(m.*key.field) + ", out of range",
                        "it lies between " + number_text(key.low) + " and " +
                            number_text(key.high) + "; check the units");
  return m;
}

/// The other direction of a fabric is not that of the default preset, which nobody named.
void require_both_directions(const io::Node& node) {
  const bool warp = node.has("bend_warp_n_m"), weft = node.has("bend_weft_n_m");
  const bool any = warp || weft || node.has("bend_bias_n_m");
  if (!any || (warp && weft) || node.has("bend_n_m") || node.has("preset"))
    return;
  node.fail("material.direction-missing"_id,
            std::string("has a rigidity by direction, but no ") +
                (warp ? "bend_weft_n_m" : "bend_warp_n_m"),
            "give bend_warp_n_m and bend_weft_n_m both, or a bend_n_m or preset for the rest");
}

/// What a fabric was measured to bend by replaces what a preset says of its directions.
void settle_bending(const io::Node& node, Material& m) {
  require_both_directions(node);
  const bool directions =
      node.has("bend_warp_n_m") || node.has("bend_weft_n_m") || node.has("bend_bias_n_m");
  if (node.has("bend_n_m") && !directions)
    m.bend_warp_n_m = m.bend_weft_n_m = m.bend_bias_n_m = 0;
  if (directions && !node.has("bend_n_m")) {
    const cloth::PlateRigidity plate = cloth::plate_rigidity(m);
    m.bend_n_m = 0.5 * (plate.warp + plate.weft);
  }
  if (!(m.bend_bias_n_m > 0))
    return;
  const cloth::PlateRigidity plate = cloth::plate_rigidity(m);
  const double least = cloth::least_bias_rigidity(plate.warp, plate.weft);
  if (m.bend_bias_n_m < (1 - 1e-9) * least)
    node.fail("material.bias-too-soft"_id, "the bias bends more easily than warp and weft allow",
              "give a bend_bias_n_m of (sqrt(warp) - sqrt(weft))^2 / 4 = " +
                  number_text(std::ceil(ASKED_STEPS * least) / ASKED_STEPS) + " or more");
}

std::vector<ClothLayer> read_layers(const io::Node& node) {
  std::vector<ClothLayer> layers;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const io::Node item = node.at(k);
    item.allow_only({"material", "bond", "side"});
    layers.push_back(read_cloth_layer(item));
  }
  return layers;
}

Material material_object(const io::Node& node) {
  Material m = material_preset(node.string("preset", material_presets().front().name));
  for (const MaterialKey& key : MATERIAL_KEYS)
    read_key(node, key, m);
  for (const MaterialKey& key : DIRECTION_KEYS)
    read_key(node, key, m);
  read_key(node, SOFT_RADIUS, m);
  settle_bending(node, m);
  m.source = node.string("source", m.source);
  return node.has("layers") ? layered(m, read_layers(node.at("layers"))) : m;
}

} // namespace

ClothLayer read_cloth_layer(const io::Node& node) {
  ClothLayer layer;
  layer.material = read_material(node.at("material"));
  layer.bond = node.number("bond", 0);
  if (layer.bond < 0 || layer.bond > 1)
    node.at("bond").fail("json.out-of-range"_id, "is out of range",
                         "give a share from 0 (loose) to 1 (fused)");
  const std::string side = node.string("side", "inside");
  if (side != "inside" && side != "outside")
    node.at("side").fail("json.unknown-word"_id, "is no side of cloth",
                         "known are inside, outside");
  layer.outside = side == "outside";
  return layer;
}

Material read_material(const io::Node& node) {
  if (node.is_string())
    return named_material(node);
  node.allow_only({"preset", "density_kg_m2", "stretch_warp_n_m", "stretch_weft_n_m", "shear_n_m",
                   "bend_n_m", "bend_warp_n_m", "bend_weft_n_m", "bend_bias_n_m", "bend_soft_share",
                   "bend_soft_radius_m", "friction_body", "friction_self", "damping_s",
                   "thickness_m", "poisson", "layers", "source"});
  return material_object(node);
}

Material read_material_file(const std::string& path) {
  const io::Json document = io::read_document(path, "material", MATERIAL_VERSION);
  const io::Node root(document, path);
  root.allow_only({"format",
                   "version",
                   "generator",
                   "length_unit",
                   "name",
                   "preset",
                   "density_kg_m2",
                   "stretch_warp_n_m",
                   "stretch_weft_n_m",
                   "shear_n_m",
                   "bend_n_m",
                   "bend_warp_n_m",
                   "bend_weft_n_m",
                   "bend_bias_n_m",
                   "bend_soft_share",
                   "bend_soft_radius_m",
                   "friction_body",
                   "friction_self",
                   "damping_s",
                   "thickness_m",
                   "poisson",
                   "layers",
                   "source",
                   "fit"});
  Material m = material_object(root);
  m.name = root.string("name", m.name);
  return m;
}

io::Json material_json(const Material& material) {
  io::Json j;
  j["name"] = material.name;
  for (const MaterialKey& key : MATERIAL_KEYS)
    j[key.name] = material.*key.field;
  for (const MaterialKey& key : DIRECTION_KEYS)
    if (material.*key.field > 0)
      j[key.name] = material.*key.field;
  if (material.bend_soft_share > 0)
    j[SOFT_RADIUS.name] = material.bend_soft_radius_m;
  j["source"] = material.source;
  return j;
}

Material material_from(const std::string& name_or_path) {
  const std::string file = name_or_path.substr(0, name_or_path.rfind('#'));
  if (io::ending_of(file) == ".csv")
    return measured_material(name_or_path);
  if (io::ending_of(name_or_path) == ".json")
    return read_material_file(name_or_path);
  return material_preset(name_or_path);
}

} // namespace sloper::garment
