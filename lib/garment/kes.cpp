#include <garment/kes.hpp>
#include <garment/measurements.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/json_fwd.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double FULL_LOAD = 500;   // gf/cm: end of the KES-F1 tensile test
constexpr double WEARING_LOAD = 50; // N/m
constexpr double FAST_SHEAR = 123;  // N/m times per cent: De Boos and Tester 1994

/// B from bending lengths, where it was not measured itself: W g C^3, with C = L / 2 of an
/// overhang.
void bend_by_lengths(Values& values) {
  const double weight = values["W"].mean() * units::GRAVITY;
  auto fill = [&](double Value::*direction) {
    double length = values["C"].*direction;
    if (std::isnan(length))
      length = 0.5 * (values["L"].*direction);
    if (std::isnan(values["B"].*direction))
      values["B"].*direction = weight * length * length * length;
  };
  const bool bias_was_measured = !std::isnan(values["B"].bias);
  for (double Value::*direction : {&Value::warp, &Value::weft, &Value::bias})
    fill(direction);
  Value& b = values["B"];
  if (!bias_was_measured && b.bias > 0 && b.warp > 0 && b.weft > 0)
    b.bias = std::max(cloth::bias_of_strip(b.warp, b.weft, b.bias),
                      cloth::least_bias_rigidity(b.warp, b.weft));
}

/// Rigidities by direction, where what was measured differs.
void set_bending(const Value& b, const std::string& file, const std::string& place, Material& m) {
  m.bend_n_m = b.mean();
  const bool differ = b.warp > 0 && b.weft > 0 && b.warp != b.weft;
  if (!differ && !(b.bias > 0))
    return;
  m.bend_warp_n_m = std::isnan(b.warp) ? b.weft : b.warp;
  m.bend_weft_n_m = std::isnan(b.weft) ? b.warp : b.weft;
  if (!(b.bias > 0))
    return;
  m.bend_bias_n_m = b.bias;
  if (b.bias < cloth::least_bias_rigidity(m.bend_warp_n_m, m.bend_weft_n_m))
    throw input_error("material.bias-too-soft"_id, file, place,
                      "the bias bends more easily than warp and weft allow",
                      "measure the strip at 45 degrees again");
}

/// Tension per width at unit strain, secant at WEARING_LOAD; 0 when nothing was measured.
double stretch(double emt, double lt, const Values& values, double Value::*direction) {
  if (emt > 0) {
    const double p = 2 / (lt > 0 ? lt : 1) - 1;
    return WEARING_LOAD / (emt * std::pow(WEARING_LOAD / (FULL_LOAD * GF_CM), 1 / p));
  }
  double nearest = 1e300, stiffness = 0;
  for (const auto& [name, load] : {std::pair{"E5", 5.0}, {"E20", 20.0}, {"E100", 100.0}}) {
    const auto found = values.find(name);
    if (found == values.end() || !(found->second.*direction > 0))
      continue;
    const double off = std::abs(std::log(load * GF_CM / WEARING_LOAD));
    if (off < nearest) {
      nearest = off;
      stiffness = load * GF_CM / (found->second.*direction);
    }
  }
  return stiffness;
}

} // namespace

Material read_kes(const std::string& path) {
  auto [file, chosen, place, values] = read_measurements(path);
  bend_by_lengths(values);
  Material m;
  m.name = chosen.empty() ? io::file_name(file) : chosen;
  m.density_kg_m2 = values["W"].mean();
  set_bending(values["B"], file, place, m);
  if (values["G"].given())
    m.shear_n_m = values["G"].mean();
  else if (values["EB5"].mean() > 0)
    m.shear_n_m = FAST_SHEAR / (100 * values["EB5"].mean());
  const double warp = stretch(values["EMT"].warp, values["LT"].warp, values, &Value::warp);
  const double weft = stretch(values["EMT"].weft, values["LT"].weft, values, &Value::weft);
  if (warp > 0)
    m.stretch_warp_n_m = warp;
  if (weft > 0)
    m.stretch_weft_n_m = weft;
  if (values["MIU"].given())
    m.friction_self = values["MIU"].mean();
  if (values["T0"].given())
    m.thickness_m = values["T0"].mean();
  else if (values["T"].given())
    m.thickness_m = values["T"].mean();
  m.source = "measured: " + io::file_name(file);
  return m;
}

} // namespace sloper::garment
