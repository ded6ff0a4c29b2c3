#include <garment/redrape/redrapes_json.hpp>

namespace sloper::garment {

using io::Json;
using io::Node;

namespace {

double not_negative(const Node& node) {
  const double x = node.number();
  if (x < 0)
    node.fail("json.out-of-range"_id, "a spread is negative");
  return x;
}

} // namespace

Json redrapes_json(const Redrapes& r, std::size_t n_particles) {
  Json j;
  j["count"] = r.count;
  if (r.spread_m.size() == n_particles)
    j["spread_m"] = r.spread_m;
  j["girths"] = Json::object();
  for (const auto& [name, row] : r.girths)
    j["girths"][name] = {{"ease_m", row.ease_m}, {"strain", row.strain}, {"gap_m", row.gap_m}};
  j["hems_m"] = Json::object();
  for (const auto& [name, sd] : r.hems_m)
    j["hems_m"][name] = sd;
  return j;
}

Redrapes read_redrapes(const Node& node, std::size_t n_particles) {
  Redrapes out;
  out.count = node.at("count").integer();
  if (out.count < 0)
    node.at("count").fail("json.out-of-range"_id, "a count is negative");
  if (node.has("spread_m")) {
    const Node spread = node.at("spread_m");
    if (spread.size() != n_particles)
      spread.fail("json.wrong-count"_id, "is not one number for each particle");
    for (std::size_t i = 0; i < n_particles; ++i)
      out.spread_m.push_back(not_negative(spread.at(i)));
  }
  if (node.has("girths"))
    for (const std::string& name : node.at("girths").keys()) {
      const Node row = node.at("girths").at(name);
      out.girths[name] = {not_negative(row.at("ease_m")), not_negative(row.at("strain")),
                          not_negative(row.at("gap_m"))};
    }
  if (node.has("hems_m"))
    for (const std::string& name : node.at("hems_m").keys())
      out.hems_m[name] = not_negative(node.at("hems_m").at(name));
  return out;
}

} // namespace sloper::garment
