#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/base/text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/cloth/bending_plates.hpp>
#include <sloper/garment/drapemeter/material_fit.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sloper::garment {

namespace {

constexpr double LEAST_BENDING = 1e-8, MOST_BENDING = 1e-2; // N m: between silk gauze and board
constexpr int MOST_FOLDS = 50;                              // of a rim: silk on a large disc has 12
/// Rigidities at which the model is draped at most, and drapes at each.
constexpr int ROUNDS = 7, DRAPES = 4;
constexpr double LARGEST_STEP = 0.5; // decades from one round to the next
constexpr double NEAR = 0.3;         // decades: drapes that the regression uses
constexpr double CLOSE = 0.03;       // decades: a round that moves less is the last
/// Coefficient for a decade of rigidity below which cloth hangs or stands whatever it is made of;
/// in the middle it is 0.41 (tests/validation/test_cusick.cpp).
constexpr double LEAST_SLOPE = 0.1;
constexpr double STANDING_OUT =
    0.85; // coefficient above which stiffer cloth drapes no differently;
          // the softest cotton of shear 60 N/m comes to 0.5 at least
constexpr double USELESS_DECADES = 0.3; // a factor of two
/// Least error of the model's mesh, decades: 5 % of the rigidity, by which it was off on three
/// fabrics whose silhouettes came from a finer one (test_drapemeter.cpp).
constexpr double MESH_DECADES = 0.02;
/// Edges of the mesh beside which the model's is held: an error of second order is their
/// difference over the square of this less 1.
constexpr double COARSER = 4.0 / 3;
constexpr double CONTRADICTION = 3;    // standard errors
constexpr double WEIGHT_OF_LENGTH = 3; // B goes with the third power
constexpr const char* DIRECTION_NAMES[] = {"warp", "weft", "bias"};

struct Sample {
  double decade;      // log10 of B
  double coefficient; // 0..1
  double folds;
};

double mean_of(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v)
    sum += x;
  return sum / static_cast<double>(v.size());
}
double sd_of(const std::vector<double>& v) {
  double sum = 0;
  const double mean = mean_of(v);
  for (double x : v)
    sum += (x - mean) * (x - mean);
  return v.size() > 1 ? std::sqrt(sum / static_cast<double>(v.size() - 1)) : 0;
}

struct Line {
  double at = 0, slope = 0; // value at the middle, per decade
  double middle = 0, scatter = 0;
  int n = 0;
};
/// Least squares of the coefficient over the decades near `decade`.
Line regression(const std::vector<Sample>& samples, double decade) {
  Line line;
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  std::vector<Sample> use;
  for (const Sample& s : samples)
    if (std::abs(s.decade - decade) <= NEAR)
      use.push_back(s);
  line.n = static_cast<int>(use.size());
  if (line.n == 0)
    return line;
  for (const Sample& s : use) {
    sx += s.decade / line.n;
    sy += s.coefficient / line.n;
  }
  for (const Sample& s : use) {
    sxx += (s.decade - sx) * (s.decade - sx);
    sxy += (s.decade - sx) * (s.coefficient - sy);
  }
  line.middle = sx;
  line.at = sy;
  line.slope = sxx > 1e-6 ? sxy / sxx : 0;
  double left = 0;
  for (const Sample& s : use) {
    const double off = s.coefficient - sy - line.slope * (s.decade - sx);
    left += off * off;
  }
  line.scatter = line.n > 2 ? std::sqrt(left / (line.n - 2)) : 0;
  return line;
}

/// The base with its bending scaled to this mean, directions kept in proportion.
Material with_bending(const Material& base, double bending) {
  Material m = base;
  const double factor = bending / base.bend_n_m;
  m.bend_n_m = bending;
  m.bend_warp_n_m *= factor;
  m.bend_weft_n_m *= factor;
  m.bend_bias_n_m *= factor;
  return m;
}

/// Drapes the model at one rigidity. @param first  seed
std::vector<Sample> drape_at(const Material& base, const DrapemeterSetup& setup, double decade,
                             std::uint64_t first) {
  const Material material = with_bending(base, std::pow(10, decade));
  std::vector<DrapemeterResult> results(DRAPES);
  run_alone(DRAPES, [&](std::size_t k) {
    results[k] = drape_specimen(material, setup, first + static_cast<std::uint64_t>(k));
  });
  std::vector<Sample> samples;
  for (const DrapemeterResult& r : results)
    if (r.at_rest)
      samples.push_back({decade, r.coefficient, static_cast<double>(r.folds)});
  return samples;
}

double mean_coefficient(const std::vector<Sample>& samples) {
  double sum = 0;
  for (const Sample& s : samples)
    sum += s.coefficient / static_cast<double>(samples.size());
  return sum;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}

void fit_overhangs(const FabricTests& tests, MaterialFit& fit) {
  const double weight = tests.base.density_kg_m2 * units::GRAVITY;
  for (int k = 0; k < 3; ++k) {
    const std::vector<double>& lengths = tests.overhang_m[k];
    if (lengths.empty())
      continue;
    const double length = mean_of(lengths), n = static_cast<double>(lengths.size());
    const double one = lengths.size() > 2 ? std::max(sd_of(lengths), 1e-4) : tests.length_error_m;
    const double value = weight * std::pow(0.5 * length, 3);
    fit.from_overhang[k] = {value, WEIGHT_OF_LENGTH * value * one / (std::sqrt(n) * length)};
  }
}

/// Sets the directions that were measured; the mean is theirs.
void set_directions(MaterialFit& fit) {
  Material& m = fit.material;
  const auto& [warp, weft, bias] = fit.from_overhang;
  if (!warp && !weft)
    return;
  m.bend_warp_n_m = warp ? warp->value : weft->value;
  m.bend_weft_n_m = weft ? weft->value : warp->value;
  m.bend_bias_n_m = bias ? cloth::bias_of_strip(m.bend_warp_n_m, m.bend_weft_n_m, bias->value) : 0;
  m.bend_n_m = 0.5 * (m.bend_warp_n_m + m.bend_weft_n_m);
  const double least = cloth::least_bias_rigidity(m.bend_warp_n_m, m.bend_weft_n_m);
  if (bias && m.bend_bias_n_m < least) {
    m.bend_bias_n_m = least;
    fit.cannot_tell.push_back("bias: softer than warp and weft allow; the softest is taken");
  }
  // One direction that stands for both is known no better by being counted twice.
  const double sd_of_one = (warp ? warp : weft)->sd;
  const double mean_sd = warp && weft ? 0.5 * std::hypot(warp->sd, weft->sd) : sd_of_one;
  fit.mean = FittedValue{m.bend_n_m, mean_sd};
}

class DrapeFit {
public:
  DrapeFit(const FabricTests& tests, MaterialFit& fit, Reporter& reporter)
      : m_tests(tests), m_fit(fit), m_reporter(reporter) {}

  void run() {
    const double target = mean_of(m_tests.coefficient),
                 n = static_cast<double>(m_tests.coefficient.size());
    double decade = std::log10(m_fit.material.bend_n_m);
    Line line;
    for (int round = 0; round < ROUNDS && !m_reporter.stop_requested(); ++round) {
      m_reporter.progress("fit", static_cast<double>(round) / (ROUNDS + 1));
      add(drape_at(m_fit.material, m_tests.setup, decade,
                   1 + 100 * static_cast<std::uint64_t>(round)));
      if (m_samples.empty() || is_at_end(decade, target))
        break;
      line = regression(m_samples, decade);
      const double slope = line.slope > LEAST_SLOPE ? line.slope : TYPICAL_SLOPE;
      const double found = line.middle + (target - line.at) / slope;
      const double step = std::clamp(found - decade, -LARGEST_STEP, LARGEST_STEP);
      if (round > 1 && std::abs(step) < CLOSE && line.n >= 2 * DRAPES) {
        decade += step;
        break;
      }
      // The next round stands off a little, so that there is a slope to be seen.
      const double aside = round == 0 && std::abs(step) < 2 * CLOSE ? 0.15 : 0;
      decade =
          std::clamp(decade + step + aside, std::log10(LEAST_BENDING), std::log10(MOST_BENDING));
    }
    const double last = line.at;
    line = regression(m_samples, decade);
    if (line.n == 0)
      line.at = last; // the last step led away from all drapes
    conclude(target, n, decade, line);
  }

private:
  static constexpr double TYPICAL_SLOPE = 0.41;

  void add(const std::vector<Sample>& samples) {
    m_samples.insert(m_samples.end(), samples.begin(), samples.end());
    m_fit.simulations += DRAPES;
  }

  /// Whether the last round went softer, or stiffer, to no effect, and the target lies farther that
  /// way: cloth hangs or stands whatever it is made of, and more rounds would show no other.
  bool is_at_end(double decade, double target) {
    const std::optional<Round> before = m_last;
    const Line now = regression(m_samples, decade);
    m_last = Round{decade, now.at};
    char text[80];
    std::snprintf(text, sizeof text, "bending %.3g uN m drapes to a coefficient of %.1f %%",
                  1e6 * std::pow(10, decade), 100 * now.at);
    m_reporter.info(text);
    if (!before || std::abs(decade - before->decade) < NEAR)
      return false;
    const double slope = (now.at - before->coefficient) / (decade - before->decade);
    const bool hangs = decade < before->decade && target < now.at && now.at < STANDING_OUT;
    const bool stands = decade > before->decade && target > now.at && now.at > STANDING_OUT;
    return slope < LEAST_SLOPE && (hangs || stands);
  }

  /// How far the result moves when shear and stretch are off by their errors, and by its mesh, all
  /// in decades. Cloth that hardly stretches locks where it folds finely: on a mesh that is too
  /// coarse for it each of the latter two may come to a third of the rigidity.
  double model_decades(double decade, const Line& line) {
    const auto plain = drape_at(m_fit.material, m_tests.setup, decade, 1);
    m_fit.simulations += DRAPES;
    if (plain.size() < DRAPES)
      return 0;
    const auto moved = [&](const Material& material, const DrapemeterSetup& setup) {
      const auto other = drape_at(material, setup, decade, 1);
      m_fit.simulations += DRAPES;
      if (other.size() < DRAPES)
        return 0.0;
      return (mean_coefficient(other) - mean_coefficient(plain)) / line.slope;
    };
    Material shear = m_fit.material, stretch = m_fit.material;
    shear.shear_n_m *= 1 + m_tests.shear_error;
    stretch.stretch_warp_n_m *= 1 + m_tests.stretch_error;
    stretch.stretch_weft_n_m *= 1 + m_tests.stretch_error;
    DrapemeterSetup coarser = m_tests.setup;
    coarser.edge_m *= COARSER;
    const double by_shear =
                     shear.shear_n_m > m_fit.material.shear_n_m ? moved(shear, m_tests.setup) : 0,
                 by_stretch = m_tests.stretch_error > 0 ? moved(stretch, m_tests.setup) : 0,
                 by_mesh = moved(m_fit.material, coarser) / (COARSER * COARSER - 1);
    return std::sqrt(by_shear * by_shear + by_stretch * by_stretch + by_mesh * by_mesh);
  }

  void conclude(double target, double n, double decade, const Line& line) {
    if (line.n < DRAPES || !(line.slope > LEAST_SLOPE)) {
      m_fit.cannot_tell.push_back(
          "bending from the drape: a coefficient of " + percent(target) +
          (target > line.at
               ? " is that of any cloth that stands out nearly straight; take a larger specimen or "
                 "a smaller disc"
               : " is below what any cloth of this weight, stretch and shear comes to on the "
                 "model's mesh; measure overhangs or the shear, or take a larger disc"));
      return;
    }
    const double one =
        n > 2 ? sd_of(m_tests.coefficient) : std::max(m_tests.coefficient_error, line.scatter);
    m_reporter.progress("fit", static_cast<double>(ROUNDS) / (ROUNDS + 1));
    const double measured = one / std::sqrt(n) / line.slope,
                 model = line.scatter / std::sqrt(static_cast<double>(line.n)) / line.slope,
                 others = model_decades(decade, line);
    const double sd = std::sqrt(measured * measured + model * model + others * others +
                                MESH_DECADES * MESH_DECADES);
    m_fit.coefficient = line.at + line.slope * (decade - line.middle);
    m_fit.coefficient_sd = line.scatter;
    int near = 0;
    for (const Sample& s : m_samples)
      if (std::abs(s.decade - decade) <= NEAR) {
        m_fit.folds += s.folds;
        ++near;
      }
    m_fit.folds /= std::max(near, 1);
    const double value = std::pow(10, decade);
    m_fit.from_drape = FittedValue{value, value * std::log(10.0) * sd};
    if (sd > USELESS_DECADES)
      m_fit.cannot_tell.push_back("bending from the drape: its error is more than a factor of two; "
                                  "drape the specimen more often");
    if (!m_tests.folds.empty())
      compare_folds();
  }

  void compare_folds() {
    double mean = 0;
    for (int f : m_tests.folds)
      mean += f / static_cast<double>(m_tests.folds.size());
    if (std::abs(mean - m_fit.folds) > 2.5) {
      char text[120];
      std::snprintf(text, sizeof text,
                    "folds: the model has %.1f, the cloth %.1f; its shear or weight may be another",
                    m_fit.folds, mean);
      m_fit.cannot_tell.push_back(text);
    }
  }

  /// A rigidity, and the coefficient of its drapes.
  struct Round {
    double decade, coefficient;
  };
  const FabricTests& m_tests;
  MaterialFit& m_fit;
  Reporter& m_reporter;
  std::vector<Sample> m_samples;
  std::optional<Round> m_last;
};

/// Both kinds of test, weighted by their relative errors.
void combine(MaterialFit& fit) {
  const bool drape_counts =
      fit.from_drape &&
      fit.from_drape->sd < std::log(10.0) * USELESS_DECADES * fit.from_drape->value;
  if (!drape_counts)
    return;
  if (!fit.mean) {
    fit.mean = fit.from_drape;
  } else {
    const double a = std::log(fit.mean->value), b = std::log(fit.from_drape->value),
                 va = std::pow(fit.mean->sd / fit.mean->value, 2),
                 vb = std::pow(fit.from_drape->sd / fit.from_drape->value, 2);
    if (std::abs(a - b) > CONTRADICTION * std::sqrt(va + vb)) {
      fit.contradiction = "bending: overhang and drape contradict each other; measure again";
      fit.cannot_tell.push_back(fit.contradiction);
      return;
    }
    const double value = std::exp((a * vb + b * va) / (va + vb));
    fit.mean = FittedValue{value, value * std::sqrt(va * vb / (va + vb))};
  }
  fit.material = with_bending(fit.material, fit.mean->value);
}

constexpr double STRIP_LENGTH = 0.2;     // m: of the test, material-fit(1)
constexpr double LEAST_OVERHANG = 0.005; // m

void check_overhang(double length) {
  if (length > LEAST_OVERHANG && length <= STRIP_LENGTH)
    return;
  const bool is_long = length > STRIP_LENGTH;
  throw input_error("drapemeter.out-of-range"_id, "", "overhang of " + millimetres(length),
                    is_long ? "is longer than the strip of 200 mm" : "is that of no cloth",
                    "give what hangs over the edge, in mm, from 5 to 200");
}

void check(const FabricTests& tests) {
  if (!(tests.base.density_kg_m2 > 0.005) || tests.base.density_kg_m2 > 5)
    throw input_error("drapemeter.out-of-range"_id, "", "weight", "is that of no cloth",
                      "give it in g/m2, from 5 to 5000");
  for (const auto& lengths : tests.overhang_m)
    for (const double length : lengths)
      check_overhang(length);
  for (double c : tests.coefficient)
    if (!(c > 0) || c > 1)
      throw input_error("drapemeter.out-of-range"_id, "", "drape coefficient", "is out of range",
                        "give it in %, up to 100");
  for (int folds : tests.folds)
    if (folds < 0 || folds > MOST_FOLDS)
      throw input_error("drapemeter.out-of-range"_id, "", "folds", "are those of no drape",
                        "count them, from 0 to " + std::to_string(MOST_FOLDS));
  const bool any =
      !tests.coefficient.empty() || !tests.overhang_m[0].empty() || !tests.overhang_m[1].empty();
  if (!any)
    throw input_error("drapemeter.nothing-measured"_id, "", "",
                      "nothing was measured that bending follows from",
                      "give a silhouette, a drape coefficient, or overhangs along warp or weft");
}

} // namespace

MaterialFit fit_material(const FabricTests& tests, Reporter& reporter) {
  check(tests);
  MaterialFit fit;
  fit.material = tests.base;
  fit_overhangs(tests, fit);
  set_directions(fit);
  const bool has_ratio = fit.from_overhang[0] && fit.from_overhang[1];
  if (!has_ratio) {
    fit.cannot_tell.push_back("warp against weft: a drape has the mean of both; measure overhangs "
                              "along both");
    if (!fit.mean)
      fit.material.bend_warp_n_m = fit.material.bend_weft_n_m = fit.material.bend_bias_n_m = 0;
  }
  if (!tests.coefficient.empty()) {
    DrapeFit(tests, fit, reporter).run();
    combine(fit);
  }
  return fit;
}

io::Json material_fit_json(const MaterialFit& fit, const FabricTests& tests,
                           const std::string& tool) {
  io::Json document = io::new_document("material", MATERIAL_VERSION, tool);
  document.update(material_json(fit.material));
  io::Json j = io::Json::object();
  const auto value = [](const FittedValue& v) {
    return io::Json{{"value", v.value}, {"sd", v.sd}};
  };
  if (fit.mean)
    j["bend_n_m"] = value(*fit.mean);
  for (int k = 0; k < 3; ++k)
    if (fit.from_overhang[k])
      j["overhang"][DIRECTION_NAMES[k]] = value(*fit.from_overhang[k]);
  if (fit.from_drape)
    j["drape"] = value(*fit.from_drape);
  if (!tests.coefficient.empty()) {
    j["coefficient_percent"] = {{"measured", 100 * mean_of(tests.coefficient)},
                                {"drapes", tests.coefficient.size()}};
    if (fit.from_drape) { // otherwise there is no result at which the model would be draped
      j["coefficient_percent"]["model"] = 100 * fit.coefficient;
      j["coefficient_percent"]["model_sd"] = 100 * fit.coefficient_sd;
      j["folds"]["model"] = fit.folds;
    }
    if (!tests.folds.empty()) {
      double mean = 0;
      for (int f : tests.folds)
        mean += f / static_cast<double>(tests.folds.size());
      j["folds"]["measured"] = mean;
    }
  }
  j["simulations"] = fit.simulations;
  j["cannot_tell"] = fit.cannot_tell;
  document["fit"] = j;
  return document;
}

} // namespace sloper::garment
