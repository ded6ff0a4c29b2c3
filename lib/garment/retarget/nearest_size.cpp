#include <sloper/garment/retarget/nearest_size.hpp>

#include <garment/fit/fit_places.hpp>
#include <garment/fit/garment_regions.hpp>
#include <garment/retarget/seat.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/fit/worn_policy.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/retarget/retarget.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace sloper::garment {

namespace {

constexpr double LEAST_SPREAD_M = 0.002; // of a girth: nothing is known better

/// Before the name of a level in Garment::body_girths_m.
const std::string LEVEL = "level:";

struct KnownGirth {
  double value_m, spread_m;
};

std::map<std::string, KnownGirth> girths_known(const body::Body& body) {
  std::map<std::string, KnownGirth> known;
  for (const auto& [name, girth] : body.girths)
    if (girth.value_m > 0)
      known[name] = {girth.value_m, std::max(girth.spread_m, LEAST_SPREAD_M)};
  for (const auto& [name, level] : body.levels)
    if (level.girth_m > 0)
      known[LEVEL + name] = {level.girth_m, std::max(level.girth_spread_m, LEAST_SPREAD_M)};
  return known;
}

using Girths = std::map<std::string, double>;

Girths girths_of_document(const std::string& file) {
  const io::Json document = io::read_document(file, "garment", GARMENT_VERSION);
  const io::Node root(document, file);
  Girths girths;
  if (root.has("body") && root.at("body").has("girths_m"))
    for (const std::string& name : root.at("body").at("girths_m").keys())
      girths[name] = root.at("body").at("girths_m").at(name).number();
  if (girths.empty())
    throw input_error("garment.no-girths"_id, file, "/body/girths_m",
                      "does not know the girths of the body it hangs on", "drape it again");
  return girths;
}

/// Those of the known girths that are compared; all where the documents know none of those.
std::map<std::string, KnownGirth> girths_to_compare(std::map<std::string, KnownGirth> known,
                                                    const std::vector<std::string>& files,
                                                    const std::set<std::string>& compared) {
  std::map<std::string, KnownGirth> chosen;
  const Girths of_first = girths_of_document(files.front());
  for (const auto& [name, girth] : known)
    if (compared.count(name) > 0 && of_first.count(name) > 0)
      chosen[name] = girth;
  return chosen.empty() ? known : chosen;
}

} // namespace

std::vector<std::string> sizes_beside(const std::string& garment) {
  namespace fs = std::filesystem;
  const std::string name = io::file_name(garment);
  const std::size_t at = name.find('@');
  if (at == std::string::npos)
    throw input_error("garment.no-size"_id, garment, "", "its name has no size",
                      "call its sizes NAME@SIZE.json");
  const std::string begin = name.substr(0, at + 1);
  std::vector<std::string> files;
  const fs::path folder = fs::path(garment).parent_path();
  std::error_code error;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error)) {
    const std::string other = entry.path().filename().string();
    if (other.rfind(begin, 0) == 0 && other.ends_with(".json"))
      files.push_back((folder / other).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::set<std::string> girths_covered(const Garment& garment, const body::Body& body) {
  if (garment.bind.empty() || !why_impossible(garment, body).empty())
    return {};
  Garment placed = garment;
  placed.position = place_garment(garment, body);
  const std::vector<Triangle> triangles = placed.particle_triangles();
  std::set<std::string> covered;
  for (const FitPlace& place : fit_places(body)) {
    const std::vector<char> takes_part = cloth_of(placed, place);
    const auto height = [&](int particle) {
      return place.normal.dot(placed.position[particle] - place.center);
    };
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      const auto& [a, b, c] = triangles[f];
      if (!takes_part[f] || std::min({height(a), height(b), height(c)}) > 0 ||
          std::max({height(a), height(b), height(c)}) < 0)
        continue;
      covered.insert(place.kind == "level" ? LEVEL + place.name : place.name);
      break;
    }
  }
  return covered;
}

SizeRanking rank_sizes(const std::vector<std::string>& files, const body::Body& body,
                       const std::set<std::string>& compared) {
  const auto known = girths_to_compare(girths_known(body), files, compared);
  struct Candidate {
    SizeRank rank;
    Girths girths;
  };
  std::vector<Candidate> candidates;
  for (const std::string& file : files) {
    Candidate c;
    c.girths = girths_of_document(file);
    c.rank.file = file;
    double sum = 0;
    for (const auto& [name, girth] : known) {
      const auto own = c.girths.find(name);
      if (own == c.girths.end())
        continue;
      const double share = (own->second - girth.value_m) / girth.value_m;
      sum += share * share;
      ++c.rank.girths;
    }
    if (c.rank.girths == 0)
      throw input_error("garment.no-girths"_id, file, "/body/girths_m",
                        "has no girth that the other body has");
    c.rank.distance = std::sqrt(sum / c.rank.girths);
    candidates.push_back(std::move(c));
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.rank.distance < b.rank.distance; });
  SizeRanking ranking;
  for (const auto& [name, girth] : known)
    if (candidates.front().girths.count(name) > 0)
      ranking.compared.push_back(name);
  for (const Candidate& c : candidates)
    ranking.sizes.push_back(c.rank);
  if (candidates.size() < 2)
    return ranking;
  // d2^2 - d1^2 is linear in the girths g of the body, up to the g^2 below: its change with g is
  // 2 (a1 - a2) / g^2 each.
  double lead = 0, variance = 0;
  for (const auto& [name, g] : known) {
    const auto first = candidates[0].girths.find(name), second = candidates[1].girths.find(name);
    if (first == candidates[0].girths.end() || second == candidates[1].girths.end())
      continue;
    const double a = first->second, b = second->second, square = g.value_m * g.value_m;
    lead += ((b - g.value_m) * (b - g.value_m) - (a - g.value_m) * (a - g.value_m)) / square;
    variance += std::pow(2 * (a - b) / square * g.spread_m, 2);
  }
  ranking.sureness = variance > 0 ? 0.5 * std::erfc(-lead / std::sqrt(2 * variance)) : 0.5;
  return ranking;
}

/// Measures how a size closes at the waist, and what the policy and its fabric bear there.
static void measure_waist(SizeRank& size, const body::Body& body, FitPolicy policy) {
  const Garment garment = read_garment(size.file);
  if (garment.bind.empty() || !why_impossible(garment, body).empty())
    return;
  Garment placed = garment;
  placed.position = place_garment(garment, body, Waist::SEMANTIC);
  size.short_share = seat_of_waist(placed, garment.position, body).short_share;
  follow_fabric(garment, policy);
  const FitLimits limits =
      policy.limits("top_edge", class_of(regions_of(placed, body)), main_material(garment));
  size.bearable_share = std::max(0.0, -limits.too_small_ease);
}

/// By how much more a size is too short at the waist than the policy bears.
static double unbearable_share(const SizeRank& size) {
  return std::max(0.0, size.short_share - size.bearable_share);
}

/// Standard deviation of a waist girth, a share of it.
static double waist_spread(const body::Body& body) {
  const auto known = girths_known(body);
  const auto waist = known.find(LEVEL + "waist_semantic");
  return waist == known.end() ? 0 : waist->second.spread_m / waist->second.value_m;
}

void put_closing_sizes_first(SizeRanking& ranking, const body::Body& body,
                             const FitPolicy& policy) {
  if (ranking.sizes.size() < 2)
    return;
  for (SizeRank& size : ranking.sizes)
    measure_waist(size, body, policy);
  const std::string nearest = ranking.sizes.front().file;
  std::stable_sort(ranking.sizes.begin(), ranking.sizes.end(),
                   [](const SizeRank& a, const SizeRank& b) {
                     return unbearable_share(a) < unbearable_share(b);
                   });
  if (ranking.sizes.front().file == nearest)
    return;
  const auto passed_over = std::find_if(ranking.sizes.begin(), ranking.sizes.end(),
                                        [&](const SizeRank& size) { return size.file == nearest; });
  const double beyond = passed_over->short_share - passed_over->bearable_share;
  const double spread = waist_spread(body);
  ranking.sureness = spread > 0 ? 0.5 * std::erfc(-beyond / (spread * std::sqrt(2.0))) : 1;
}

static std::string why_first(const SizeRanking& ranking) {
  const SizeRank& first = ranking.sizes.front();
  const bool is_nearest =
      std::none_of(ranking.sizes.begin(), ranking.sizes.end(),
                   [&](const SizeRank& size) { return size.distance < first.distance; });
  if (is_nearest)
    return " is nearest";
  return unbearable_share(first) > 0 ? " is the least short at the waist"
                                     : " is the nearest that closes at the waist";
}

std::string ranking_text(const SizeRanking& ranking) {
  const auto one = [&](const SizeRank& size) {
    return io::file_name(size.file) + " (" + percent(size.distance) + " off" +
           (size.short_share > 0 ? ", too short at the waist by " + percent(size.short_share)
                                 : "") +
           ")";
  };
  std::string text = "of " + std::to_string(ranking.sizes.size()) + " sizes " +
                     one(ranking.sizes.front()) + why_first(ranking);
  if (ranking.sizes.size() > 1)
    text += ", with a probability of " + whole_percent(ranking.sureness) + "; then";
  for (std::size_t i = 1; i < ranking.sizes.size(); ++i)
    text += " " + one(ranking.sizes[i]);
  return text;
}

io::Json ranking_json(const SizeRanking& ranking) {
  io::Json j = {{"sureness", ranking.sureness},
                {"compared", ranking.compared},
                {"nearest_first", io::Json::array()}};
  for (const SizeRank& size : ranking.sizes)
    j["nearest_first"].push_back({{"file", io::file_name(size.file)},
                                  {"distance", size.distance},
                                  {"girths", size.girths},
                                  {"short_share", size.short_share},
                                  {"bearable_share", size.bearable_share}});
  return j;
}

} // namespace sloper::garment
