#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/composite.hpp>

namespace sloper::garment {

namespace {

/// Directions in which a stack bends: warp, weft, bias.
constexpr int N_BENDS = 3;
using ByDirection = std::array<double, N_BENDS>;

ByDirection tensions_along(const Material& m) {
  const double compliance = 1 / m.stretch_warp_n_m + 1 / m.stretch_weft_n_m,
               bias = m.shear_n_m > 0 ? 4 / (compliance + 1 / m.shear_n_m) : 0;
  return {m.stretch_warp_n_m, m.stretch_weft_n_m, bias};
}

ByDirection bending_along(const Material& m) {
  const cloth::PlateRigidity plate = cloth::plate_rigidity(m);
  return {plate.warp, plate.weft,
          0.25 * (plate.warp + plate.weft) + 0.5 * plate.coupling + plate.twist};
}

} // namespace

Material layered(const Material& face, const std::vector<ClothLayer>& layers) {
  if (layers.empty())
    return face;
  Material out = face;
  ByDirection bending = bending_along(face), tension = tensions_along(face), axis{};
  double top = 0.5 * face.thickness_m, bottom = -top; // of the stack, from the middle of the face
  bool by_direction = cloth::bends_by_direction(face);
  for (const ClothLayer& layer : layers) {
    const Material& m = layer.material;
    const ByDirection own = bending_along(m), pull = tensions_along(m);
    const double middle = layer.outside ? top + 0.5 * m.thickness_m : bottom - 0.5 * m.thickness_m;
    for (int k = 0; k < N_BENDS; ++k) {
      const double bonded = layer.bond * pull[k], sum = tension[k] + bonded,
                   distance = middle - axis[k];
      bending[k] += own[k];
      if (sum <= 0)
        continue;
      bending[k] += tension[k] * bonded / sum * distance * distance;
      axis[k] += bonded / sum * distance;
      tension[k] = sum;
    }
    (layer.outside ? top : bottom) += layer.outside ? m.thickness_m : -m.thickness_m;
    if (layer.outside)
      out.friction_self = m.friction_self;
    else
      out.friction_body = m.friction_body;
    const double warp = out.stretch_warp_n_m + m.stretch_warp_n_m;
    out.poisson = (out.poisson * out.stretch_warp_n_m + m.poisson * m.stretch_warp_n_m) / warp;
    out.stretch_warp_n_m = warp;
    out.stretch_weft_n_m += m.stretch_weft_n_m;
    out.shear_n_m += m.shear_n_m;
    out.density_kg_m2 += m.density_kg_m2;
    out.thickness_m += m.thickness_m;
    out.name += "+" + m.name;
    if (!m.source.empty())
      out.source += "; with " + m.name + ": " + m.source;
    by_direction |= layer.bond > 0 || cloth::bends_by_direction(m);
  }
  out.bend_n_m = 0.5 * (bending[0] + bending[1]);
  if (by_direction) {
    out.bend_warp_n_m = bending[0];
    out.bend_weft_n_m = bending[1];
    out.bend_bias_n_m = std::max(bending[2], cloth::least_bias_rigidity(bending[0], bending[1]));
  }
  return out;
}

} // namespace sloper::garment
