#include <garment/kes.hpp>
#include <garment/measurements.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/io/json_fwd.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr double FULL_LOAD = 500;   // gf/cm: end of the KES-F1 tensile test
constexpr double WEARING_LOAD = 50; // N/m
constexpr double FAST_SHEAR = 123;  // N/m times per cent: De Boos and Tester 1994

// What any cloth weighs, as material-fit has it: silk gauze has some 10 g/m2, felt of a centimetre
// and coated canvas have less than 5 kg/m2.
constexpr double LEAST_WEIGHT = 0.005, MOST_WEIGHT = 5; // kg/m2
// What any sheet that is sewn bends by: a B of 0.001 gf cm2/cm, ten times less than the limpest
// knits, and leather of 3 mm (a modulus of 50 MPa gives 50e6 0.003^3 / 12).
constexpr double LEAST_RIGIDITY = 1e-8, MOST_RIGIDITY = 0.1; // N m
// Beyond these a number without a unit was hardly in the unit of KES-F. The heaviest cloth of
// clothes, for winter coats, has some 900 g/m2.
constexpr double MOST_WORN_WEIGHT = 1; // kg/m2
// Bending lengths, (B / (W g))^(1/3): those of the presets of fabrics are 11 to 31 mm. A unit that
// is wrong by a hundred changes them 4.6 times.
constexpr double LEAST_WORN_LENGTH = 0.005, MOST_WORN_LENGTH = 0.05; // m

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

std::string newton_metres(double rigidity) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3g N m", rigidity);
  return text;
}

void refuse_value(const std::string& file, const Value& v, const std::string& fact,
                  bool unit_is_meant) {
  if (unit_is_meant && !v.without_unit.empty())
    throw input_error("kes.unit-needed"_id, file, v.without_unit, fact + " in the unit of KES-F",
                      "add a unit: the same value is taken with it");
  if (!unit_is_meant)
    throw input_error("kes.malformed"_id, file, v.place, fact + ", which no cloth has",
                      v.without_unit.empty() ? "check value and unit" : "add a unit");
}

/// Refuses a weight and a rigidity that no cloth has, and those that cloth of clothes does not have
/// where their unit was not said. @param values  with B from bending lengths
void refuse_unlikely(const std::string& file, Values& values) {
  const Value& w = values["W"];
  const double weight = w.mean();
  const std::string weighs = "the weight W is " + decimals(1e3 * weight, 1) + " g/m2";
  if (weight < LEAST_WEIGHT || weight > MOST_WEIGHT)
    refuse_value(file, w, weighs, false);
  if (weight > MOST_WORN_WEIGHT)
    refuse_value(file, w, weighs, true);
  const char* measured = "L";
  for (const char* property : {"C", "B"})
    if (!values[property].place.empty())
      measured = property;
  const Value& b = values["B"];
  const Value& given = values[measured];
  for (const double rigidity : {b.warp, b.weft, b.bias}) {
    if (!(rigidity > 0))
      continue;
    const double length = std::cbrt(rigidity / (weight * units::GRAVITY));
    const std::string bends = "the bending rigidity is " + newton_metres(rigidity) +
                              ", a bending length of " + millimetres(length);
    if (rigidity < LEAST_RIGIDITY || rigidity > MOST_RIGIDITY)
      refuse_value(file, given, bends, false);
    if (length < LEAST_WORN_LENGTH || length > MOST_WORN_LENGTH)
      refuse_value(file, given, bends, true);
  }
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
  refuse_unlikely(file, values);
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
