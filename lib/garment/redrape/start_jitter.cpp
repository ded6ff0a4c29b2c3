#include <sloper/base/error.hpp>
#include <sloper/base/number_text.hpp>
#include <sloper/base/random.hpp>
#include <sloper/base/units.hpp>
#include <sloper/garment/redrape/start_jitter.hpp>

#include <charconv>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr int N_WAVES = 6;

struct Wave {
  Vec3 along, number; // direction of the displacement; wave number, rad/m
  double phase;
};

Vec3 drawn_direction(Random& random) {
  const double height = random.uniform(-1, 1), turn = random.uniform(0, 2 * units::PI),
               level = std::sqrt(1 - height * height);
  return {level * std::cos(turn), height, level * std::sin(turn)};
}

} // namespace

void set_jitter(StartJitter& jitter, const std::string& assignment) {
  struct Bound {
    const char* name;
    double StartJitter::*field;
    double unit, most;
  };
  constexpr Bound BOUNDS[] = {{"turn_deg", &StartJitter::turn_rad, units::PI / 180, 30},
                              {"offset_mm", &StartJitter::offset_m, 1e-3, 50},
                              {"order_mm", &StartJitter::order_m, 1e-3, 20}};
  const auto equals = assignment.find('=');
  const std::string name = assignment.substr(0, equals), place = "--jitter " + assignment;
  for (const Bound& b : BOUNDS) {
    if (name != b.name || equals == std::string::npos)
      continue;
    double value = 0;
    const char* end = assignment.data() + assignment.size();
    const auto read = std::from_chars(assignment.data() + equals + 1, end, value);
    if (read.ec != std::errc() || read.ptr != end || !(value >= 0 && value <= b.most))
      throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", place,
                  "the value is no number in range", "give one from " + range_text(0, b.most));
    jitter.*b.field = value * b.unit;
    return;
  }
  throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", place,
              "is not NAME=VALUE" + did_you_mean(name, {"turn_deg", "offset_mm", "order_mm"}),
              "known are turn_deg, offset_mm, order_mm");
}

void jitter_start(std::vector<Vec3>& position, const StartJitter& jitter, std::uint64_t seed,
                  int index) {
  if (index == 0 || position.empty())
    return;
  Random random(seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(index));
  Vec3 middle = Vec3::Zero(), offset;
  for (const Vec3& p : position)
    middle += p / static_cast<double>(position.size());
  const double turn = random.uniform(-jitter.turn_rad, jitter.turn_rad), c = std::cos(turn),
               s = std::sin(turn);
  for (int k = 0; k < 3; ++k)
    offset[k] = random.uniform(-jitter.offset_m, jitter.offset_m);
  std::vector<Wave> waves;
  for (int w = 0; w < N_WAVES; ++w) {
    Wave wave;
    wave.along = drawn_direction(random);
    wave.number = drawn_direction(random);
    wave.number *= 2 * units::PI / (StartJitter::WAVE_M * random.uniform(1, 3));
    wave.phase = random.uniform(0, 2 * units::PI);
    waves.push_back(wave);
  }
  const double amplitude = jitter.order_m / std::sqrt(static_cast<double>(N_WAVES));
  for (Vec3& p : position) {
    const Vec3 d = p - middle;
    p = middle + offset + Vec3(c * d.x() + s * d.z(), d.y(), c * d.z() - s * d.x());
    for (const Wave& w : waves)
      p += amplitude * std::sin(w.number.dot(d) + w.phase) * w.along;
  }
}

} // namespace sloper::garment
