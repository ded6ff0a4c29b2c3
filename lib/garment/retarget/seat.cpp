#include <garment/retarget/seat.hpp>

#include <garment/fit/fit_measure.hpp>
#include <garment/fit/garment_regions.hpp>
#include <sloper/base/units.hpp>
#include <sloper/garment/fit/fit_lines.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

constexpr double SEAT_REACH = 0.10;   // m: as far as what hangs from the waist may sink by the fit
constexpr double SEAT_STRIDE = 0.005; // m between sections of the skin
constexpr double WORTH_LOWERING = 0.01; // of the girth: less is within its error

/// Length of a closed line of particles, m.
double closed_length(const std::vector<Vec3>& position, const std::vector<int>& line) {
  double length = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
    length += (position[line[i]] - position[line[(i + 1) % line.size()]]).norm();
  return length;
}

/// A level at which an edge is worn.
struct Level {
  double below_m, girth_m; ///< from its place; of the body there
};

/// The level below an edge at which it is worn.
Level level_below(const EdgeLine& edge, double closes_at, const body::Body& body) {
  Level seat{0, edge.place.body_m};
  if (edge.place.body_m <= closes_at)
    return seat;
  const double worth_it = (1 - WORTH_LOWERING) * edge.place.body_m;
  for (double below = SEAT_STRIDE; below <= SEAT_REACH; below += SEAT_STRIDE) {
    const Vec3 center = edge.place.center - below * edge.place.normal;
    const double girth = skin_girth(body, edge.parts, center, edge.place.normal);
    if (!(girth > 0))
      return seat;
    if (girth < std::min(seat.girth_m, worth_it))
      seat = {below, girth};
    if (girth <= closes_at)
      return {below, girth};
  }
  return seat;
}

} // namespace

Seat seat_of_waist(const Garment& placed, const std::vector<Vec3>& source, const body::Body& to) {
  const std::string garment_class = class_of(regions_of(placed, to));
  if (garment_class != "skirt" && garment_class != "trousers")
    return {};
  for (const FitHem& hem : fit_lines(placed, to).hems) {
    if (hem.name != "top")
      continue;
    std::string why;
    const auto edge = edge_line(placed, to, hem, why);
    if (!edge)
      continue;
    // Cloth lies off the skin by its offset, so a ring around it is that much longer.
    const double closes_at = std::max(edge->line.rest, closed_length(source, edge->particles)) -
                             2 * units::PI * placed.offset_m;
    const Level level = level_below(*edge, closes_at, to);
    return {level.below_m, std::max(0.0, 1 - closes_at / level.girth_m), edge->particles};
  }
  return {};
}

} // namespace sloper::garment
