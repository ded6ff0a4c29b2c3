#include <sloper/base/text.hpp>
#include <sloper/garment/fit/fit_lines.hpp>
#include <sloper/geometry/disjoint_sets.hpp>

#include <sloper/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr double SHORTEST_HEM = 0.08; // m: a shorter loop is a button hole or a slit's end

/// Loops of edges that one triangle has: groups of edges that share particles.
std::vector<std::vector<std::array<int, 2>>> free_loops(const std::vector<Triangle>& triangles,
                                                        std::size_t n_particles) {
  const std::vector<std::array<int, 2>> free = free_edges_of(triangles);
  DisjointSets joined(n_particles);
  for (const auto& [a, b] : free)
    joined.unite(a, b);
  std::map<int, std::vector<std::array<int, 2>>> loops;
  for (const auto& e : free)
    loops[joined.find(e[0])].push_back(e);
  std::vector<std::vector<std::array<int, 2>>> result;
  for (auto& [first, edges] : loops)
    result.push_back(std::move(edges));
  return result;
}

/// Share of a loop's particles' weight by frame name without side, and the side.
std::string owner(const Garment& garment, const std::vector<std::array<int, 2>>& loop) {
  std::map<std::string, double> share;
  for (const auto& e : loop)
    for (const BindWeight& w : garment.bind.particles[e[0]]) {
      std::string name = garment.bind.frames[w.frame];
      if (name.find("arm_") != std::string::npos)
        name = name.back() == 'l' ? "left sleeve" : "right sleeve";
      else if (name.rfind("leg_", 0) == 0)
        name = name.back() == 'l' ? "left leg" : "right leg";
      share[name] += w.weight;
    }
  return std::max_element(share.begin(), share.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

FitHem measure_hem(const Garment& garment, const std::vector<std::array<int, 2>>& loop,
                   const Vec3& axis) {
  FitHem hem;
  hem.lowest_m = 1e300;
  hem.highest_m = -1e300;
  double sum = 0, half[4] = {}, half_length[4] = {}; // front, back, left, right
  for (const auto& e : loop) {
    const Vec3 &a = garment.position[e[0]], &b = garment.position[e[1]], middle = 0.5 * (a + b);
    const double length = (b - a).norm();
    hem.length_m += length;
    sum += length * middle.y();
    hem.lowest_m = std::min({hem.lowest_m, a.y(), b.y()});
    hem.highest_m = std::max({hem.highest_m, a.y(), b.y()});
    const int which[2] = {middle.z() > axis.z() ? 0 : 1, middle.x() > axis.x() ? 2 : 3};
    for (const int w : which) {
      half[w] += length * middle.y();
      half_length[w] += length;
    }
  }
  hem.height_m = sum / hem.length_m;
  if (half_length[0] > 0 && half_length[1] > 0)
    hem.front_minus_back_m = half[0] / half_length[0] - half[1] / half_length[1];
  if (half_length[2] > 0 && half_length[3] > 0)
    hem.left_minus_right_m = half[2] / half_length[2] - half[3] / half_length[3];
  hem.uncertainty_m = 0.5 * hem.length_m / static_cast<double>(loop.size());
  return hem;
}

/// How far down a limb a loop lies: length along the line of landmarks from the first one, and the
/// whole line's.
void cover(const body::Body& body, const std::vector<std::string>& names, const Vec3& at,
           const std::string& key, FitLines& lines) {
  double best = 1e300, covered = 0, whole = 0;
  for (const std::string& name : names)
    if (!body.has_landmark(name))
      return;
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    const Vec3 a = body.landmark(names[i]), b = body.landmark(names[i + 1]), d = b - a;
    const double free = (at - a).dot(d) / d.squaredNorm();
    const double t = i + 2 == names.size()
                         ? std::max(0.0, free)
                         : std::clamp(free, 0.0, 1.0); // may reach over the hand or the floor
    if (const double distance = (a + t * d - at).norm(); distance < best) {
      best = distance;
      covered = whole + t * d.norm();
    }
    whole += d.norm();
  }
  if (whole <= 0)
    return;
  lines.coverage_m[key] = covered;
  lines.coverage[key] = covered / whole;
}

/// Difference of lengths that a tailor would see, m. The same as for the ease of a close girth
/// (keep_ease.cpp).
constexpr double SEEN = 0.02;

/// A joint or level that an edge may end at, and its height above the joint that the frames share.
struct LimbPlace {
  std::string name; ///< "wrist", "knee", "hip"
  double at_m;
};

/// A limb as the binding knows it: coordinates in metres along it.
class Limb {
public:
  Limb(const Bind& bind, const std::string& kind, const std::string& side)
      : m_bind(bind), m_zero(bind.frames.size()) {
    if (kind == "sleeve")
      add_arm(side);
    else
      add_trunk_and_legs(side);
  }

  const std::vector<LimbPlace>& places() const { return m_places; }

  /// Mean over the particles of an edge, each of them once; nothing where none is on the limb.
  std::optional<double> at(const std::vector<int>& particles) const {
    double sum = 0;
    int count = 0;
    for (const int particle : particles) {
      double along = 0, weight = 0;
      for (const BindWeight& w : m_bind.particles[particle]) {
        if (!m_zero[w.frame])
          continue;
        along += w.weight * (w.z * m_bind.lengths_m[w.frame] - *m_zero[w.frame]);
        weight += w.weight;
      }
      if (weight <= 0)
        continue;
      sum += along / weight;
      ++count;
    }
    if (count == 0)
      return std::nullopt;
    return sum / count;
  }

private:
  int index(const std::string& frame) const {
    const auto found = std::find(m_bind.frames.begin(), m_bind.frames.end(), frame);
    return found == m_bind.frames.end() ? -1 : static_cast<int>(found - m_bind.frames.begin());
  }

  /// Forearms reach from the wrist to the elbow, upper arms from there to the shoulder.
  void add_arm(const std::string& side) {
    const int forearm = index("forearm_" + side), upper_arm = index("upper_arm_" + side);
    if (forearm < 0)
      return;
    m_zero[forearm] = 0;
    m_places.push_back({"wrist", 0});
    m_places.push_back({"elbow", m_bind.lengths_m[forearm]});
    if (upper_arm >= 0)
      m_zero[upper_arm] = -m_bind.lengths_m[forearm];
  }

  /// All frames below the chest know the height of the crotch.
  /// @param side  of a trouser leg; empty: both legs
  void add_trunk_and_legs(const std::string& side) {
    for (std::size_t k = 0; k < m_bind.frames.size(); ++k) {
      const std::string& name = m_bind.frames[k];
      const bool leg = name.rfind("leg_", 0) == 0;
      const auto crotch = m_bind.marks[k].find("crotch");
      if (crotch == m_bind.marks[k].end() || (leg && !side.empty() && name != "leg_" + side))
        continue;
      const double length = m_bind.lengths_m[k];
      m_zero[k] = crotch->second * length;
      add_place("crotch", 0);
      if (leg)
        add_place("ankle", -*m_zero[k]);
      for (const char* mark : {"knee", "hip", "waist"})
        if (const auto found = m_bind.marks[k].find(mark); found != m_bind.marks[k].end())
          add_place(mark, found->second * length - *m_zero[k]);
    }
  }

  /// The first frame that knows a place has it: a skirt takes the knee of the first leg.
  void add_place(const std::string& name, double at_m) {
    for (const LimbPlace& known : m_places)
      if (known.name == name)
        return;
    m_places.push_back({name, at_m});
  }

  const Bind& m_bind;
  std::vector<std::optional<double>> m_zero; // by frame, m: its coordinate of the shared joint
  std::vector<LimbPlace> m_places;
};

std::vector<int> particles_of(const FitHem& hem) {
  std::vector<int> particles;
  for (const auto& edge : hem.edges)
    particles.insert(particles.end(), edge.begin(), edge.end());
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

/// Spread of a landmark that a place of a limb comes from, m; 0 where it is not known.
double spread_of(const body::Body& body, const std::string& place, const std::string& side) {
  const std::string of_side = place + "_" + (side.empty() ? "l" : side);
  for (const std::string& name : {of_side, place})
    if (body.has_landmark(name))
      return body.landmarks.at(name).spread_m;
  return 0;
}

std::optional<double> height_of(const Limb& limb, const std::string& place) {
  for (const LimbPlace& known : limb.places())
    if (known.name == place)
      return known.at_m;
  return std::nullopt;
}

const LimbPlace* nearest_place(const Limb& limb, double at) {
  const LimbPlace* nearest = nullptr;
  for (const LimbPlace& place : limb.places())
    if (!nearest || std::abs(place.at_m - at) < std::abs(nearest->at_m - at))
      nearest = &place;
  return nearest;
}

/// How far above a place the edge ended on the first body, where that is known.
std::optional<double> source_above(const Bind* source, const std::string& kind,
                                   const std::string& side, const std::vector<int>& particles,
                                   const std::string& place) {
  if (!source)
    return std::nullopt;
  const Limb limb(*source, kind, side);
  const auto at = limb.at(particles), height = height_of(limb, place);
  if (!at || !height)
    return std::nullopt;
  return *at - *height;
}

/// "sleeve" and "l" of "left sleeve"; "hem" and nothing of "hem"; no kind for other edges.
std::pair<std::string, std::string> limb_of_edge(const std::string& edge) {
  if (edge == "hem")
    return {"hem", ""};
  for (const std::string kind : {"sleeve", "leg"})
    for (const std::string side : {"left", "right"})
      if (edge == side + " " + kind)
        return {kind, side.substr(0, 1)};
  return {};
}

} // namespace

bool lies_on_turned_leaf(const Garment& garment, const FitHem& hem,
                         const std::vector<RollLineState>& rolled) {
  if (hem.name != "neck" || rolled.empty())
    return false;
  std::set<std::string> turned;
  for (const RollLineState& line : rolled)
    if (line.is_turned())
      turned.insert(line.panel);
  std::vector<char> on_leaf(garment.position.size(), 0);
  for (std::size_t v = 0; v < garment.panels.ids.size(); ++v)
    if (turned.count(garment.panels.panels[garment.panels.ids[v].panel].name))
      on_leaf[garment.particle_of[v]] = 1;
  const auto on_both_ends = [&](const std::array<int, 2>& edge) {
    return on_leaf[edge[0]] && on_leaf[edge[1]];
  };
  return 2 * std::count_if(hem.edges.begin(), hem.edges.end(), on_both_ends) >
         std::ssize(hem.edges);
}

FitLines fit_lines(const Garment& garment, const body::Body& body) {
  FitLines lines;
  double low = 1e300, high = -1e300;
  for (const Vec3& p : garment.position) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  std::map<std::string, int> seen;
  for (const auto& loop : free_loops(garment.particle_triangles(), garment.position.size())) {
    Vec3 center = Vec3::Zero();
    for (const auto& e : loop)
      center += garment.position[e[0]] / static_cast<double>(loop.size());
    FitHem hem = measure_hem(garment, loop, center);
    hem.edges = loop;
    if (hem.length_m < SHORTEST_HEM)
      continue;
    hem.name = owner(garment, loop);
    if (hem.name == "head")
      hem.name = "neck";
    if (hem.name == "torso" || hem.name == "lower_body") {
      const bool up = hem.height_m > 0.5 * (low + high);
      const bool neck =
          body.has_landmark("axilla_l") && hem.height_m > body.landmark("axilla_l").y();
      hem.name = neck ? "neck" : "top";
      if (!up)
        hem.name = "hem";
    }
    const std::string side = hem.name.rfind("left", 0) == 0 ? "_l" : "_r";
    if (hem.name.find("sleeve") != std::string::npos)
      cover(body, {"shoulder_joint" + side, "elbow" + side, "wrist" + side}, center,
            "sleeve" + side, lines);
    if (hem.name.find("leg") != std::string::npos && body.has_landmark("crotch") &&
        body.has_landmark("ankle" + side)) {
      const double crotch = body.landmark("crotch").y(), ankle = body.landmark("ankle" + side).y();
      lines.coverage_m["inseam" + side] = crotch - hem.height_m;
      lines.coverage["inseam" + side] = (crotch - hem.height_m) / (crotch - ankle);
    }
    if (const int n = ++seen[hem.name]; n > 1)
      hem.name += " " + std::to_string(n);
    lines.hems.push_back(std::move(hem));
  }
  return lines;
}

std::vector<FitLength> fit_lengths(const std::vector<FitHem>& hems, const Bind& bind,
                                   const Bind* source, const body::Body& body,
                                   double convergence_m) {
  if (source && source->particles.size() != bind.particles.size())
    source = nullptr;
  std::vector<FitLength> lengths;
  for (const FitHem& hem : hems) {
    const auto [kind, side] = limb_of_edge(hem.name);
    if (kind.empty())
      continue;
    const std::vector<int> particles = particles_of(hem);
    const Limb limb(bind, kind, side);
    const auto at = limb.at(particles);
    if (!at || limb.places().empty())
      continue;
    const LimbPlace& place = *nearest_place(limb, *at);
    FitLength length;
    length.name = side.empty() ? kind : std::string(kind).append("_").append(side);
    length.place = place.name;
    length.above_m = *at - place.at_m;
    length.uncertainty_m =
        std::hypot(hem.uncertainty_m, spread_of(body, place.name, side)) + convergence_m;
    length.source_above_m = source_above(source, kind, side, particles, place.name);
    if (length.source_above_m) {
      const double shorter = length.above_m - *length.source_above_m;
      const bool differs = std::abs(shorter) > std::max(SEEN, length.uncertainty_m);
      if (!differs)
        length.verdict = "same";
      else
        length.verdict = shorter > 0 ? "shorter" : "longer";
    }
    lengths.push_back(std::move(length));
  }
  return lengths;
}

std::string length_text(const FitLength& length) {
  const auto where = [&](double above_m) {
    return centimetres(std::abs(above_m)) + (above_m < 0 ? " below the " : " above the ") +
           length.place;
  };
  std::string text = "ends " + where(length.above_m);
  if (!length.source_above_m)
    return text;
  const double shorter = length.above_m - *length.source_above_m;
  if (length.verdict == "same")
    return text + ", as on the body that it comes from";
  return text + ", " + centimetres(std::abs(shorter)) + (shorter > 0 ? " higher" : " lower") +
         " than on the body that it comes from";
}

} // namespace sloper::garment
