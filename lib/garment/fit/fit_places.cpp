#include <garment/fit/fit_places.hpp>
#include <sloper/body/measure/section.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace sloper::garment {

namespace {

constexpr double HEIGHT_ERROR = 0.005; // m, least uncertainty of a level's height
constexpr double NECK_REACH = 0.10;    // m above its base in which the neck's girth is
constexpr double STRIDE = 0.005;       // m between sections in search of a girth

bool is_arm(const std::string& frame) {
  return frame.find("arm") != std::string::npos;
}

/// Spread of the landmarks that a level's height comes from.
double level_spread(const body::Body& body, const std::string& level) {
  const auto spread = [&](const std::string& landmark) {
    return body.has_landmark(landmark) ? body.landmarks.at(landmark).spread_m : 0.0;
  };
  if (level == "bust")
    return std::max(spread("bust_point_l"), spread("bust_point_r"));
  if (level == "chest_axilla")
    return std::max(spread("axilla_l"), spread("axilla_r"));
  if (level == "hip")
    return spread("buttock_back");
  if (level == "abdomen")
    return spread("abdomen_front");
  return spread(level);
}

/// What a level's girth changes within the error of its height, by the slope to the next level.
double by_slope(const body::Body& body, const std::string& name, double height_error) {
  const body::Level& level = body.levels.at(name);
  double nearest = 1e300, slope = 0;
  for (const auto& [other_name, other] : body.levels) {
    const double distance = std::abs(other.y - level.y);
    if (other_name == name || !(other.girth_m > 0) || distance < 0.02 || distance > nearest)
      continue;
    nearest = distance;
    slope = std::abs(other.girth_m - level.girth_m) / distance;
  }
  return slope * height_error;
}

std::vector<int> faces_of(const body::Body& body, const std::vector<body::Part>& parts) {
  std::vector<int> faces;
  for (std::size_t f = 0; f < body.face_part.size(); ++f)
    if (std::find(parts.begin(), parts.end(), body.face_part[f]) != parts.end())
      faces.push_back(static_cast<int>(f));
  return faces;
}

/// Taut girth of the outline whose middle is nearest to the plane's origin, over all pieces where
/// other parts (arms that lie on the flanks) take some of it away; 0 where there is none.
double girth_in(const body::Body& body, const body::Plane& plane, const std::vector<int>& faces) {
  const std::vector<body::Loop> loops = body::cut(body.skin, plane, &faces);
  const body::Loop* best = nullptr;
  for (const body::Loop& loop : loops)
    if (loop.area > 0 && (!best || loop.centroid.norm() < best->centroid.norm()))
      best = &loop;
  if (!best)
    return 0;
  body::Loop whole = *best;
  for (const body::Loop& loop : loops)
    if (&loop != best && !best->closed && !loop.closed)
      whole.segments.insert(whole.segments.end(), loop.segments.begin(), loop.segments.end());
  return body::taut_girth(whole);
}

/// The trunk's girth at any height, as the body's own levels have it.
class TrunkGirth {
public:
  explicit TrunkGirth(const body::Body& body)
      : m_body(body),
        m_spheres(body.skin,
                  faces_of(body, {body::Part::TORSO, body::Part::LEG_L, body::Part::LEG_R})) {}
  double at(Vec3 center, double y) { ///< m; 0 where there is none
    center.y() = y;
    const body::Plane plane = body::cross_plane(center, Vec3::UnitY());
    return girth_in(m_body, plane, m_spheres.near(plane));
  }

private:
  const body::Body& m_body;
  body::TriangleSpheres m_spheres;
};

/// What a level's girth changes within the error of its height: on the skin above it, on the skin
/// below it, or by the slope to the next level, whichever is least, since beyond the crotch or an
/// arm pit the section is another one. Where the profile has its extremum, that is little, whatever
/// the next level's girth.
double level_girth_spread(const body::Body& body, const FitPlace& place, TrunkGirth& girth) {
  const body::Level& level = body.levels.at(place.name);
  const double y = level.y, here = girth.at(place.center, y);
  double change = by_slope(body, place.name, place.height_error_m);
  for (const double other : {y - place.height_error_m, y + place.height_error_m})
    if (const double there = girth.at(place.center, other); here > 0 && there > 0)
      change = std::min(change, std::abs(there - here));
  return std::hypot(std::max(LEAST_GIRTH_SPREAD, level.girth_spread_m), change);
}

/// Where the axis of a leg passes a height, above or below the leg too.
std::optional<Vec3> leg_point(const body::Body& body, const std::string& side, double y) {
  const auto frame = body.frames.find("leg_" + side);
  if (frame == body.frames.end())
    return std::nullopt;
  const PartFrame& f = frame->second.frame;
  return Vec3(f.lower + (f.upper - f.lower) * ((y - f.lower.y()) / (f.upper.y() - f.lower.y())));
}

/// The axes of both legs at a height that they reach: a line of cloth around one of them alone is
/// that of a leg.
std::vector<Vec3> legs_at(const body::Body& body, double y) {
  std::vector<Vec3> axes;
  for (const std::string side : {"l", "r"}) {
    const auto frame = body.frames.find("leg_" + side);
    if (frame != body.frames.end() && y < frame->second.frame.upper.y())
      axes.push_back(*leg_point(body, side, y));
  }
  return axes;
}

void add_levels(const body::Body& body, std::vector<FitPlace>& places) {
  const auto torso = body.frames.find("torso");
  TrunkGirth girth(body);
  for (const auto& [name, level] : body.levels) {
    if (!(level.girth_m > 0))
      continue;
    const double height_error = std::max(HEIGHT_ERROR, level_spread(body, name));
    FitPlace place{
        name, "level", Vec3(0, level.y, 0), Vec3::UnitY(), level.girth_m, 0, height_error, {}, {}};
    if (torso != body.frames.end()) {
      const PartFrame& f = torso->second.frame;
      place.center = f.lower + (f.upper - f.lower) * std::max(0.0, (level.y - f.lower.y()) /
                                                                       (f.upper.y() - f.lower.y()));
      place.center.y() = level.y;
    }
    place.inside = legs_at(body, level.y);
    place.body_spread_m = level_girth_spread(body, place, girth);
    places.push_back(place);
  }
}

/// How far along a line from `from` the section square to it is as long as `girth`, within a tenth:
/// of those the nearest in length.
std::optional<Vec3> like_girth(const body::Body& body, const std::vector<body::Part>& parts,
                               const Vec3& from, const Vec3& direction, double reach,
                               double girth) {
  const std::vector<int> faces = faces_of(body, parts);
  body::TriangleSpheres spheres(body.skin, faces);
  std::optional<Vec3> best;
  double least = 0.1 * girth;
  for (double distance = 0; distance <= reach; distance += STRIDE) {
    const Vec3 at = from + distance * direction.normalized();
    const body::Plane plane = body::cross_plane(at, direction);
    const double difference = std::abs(girth_in(body, plane, spheres.near(plane)) - girth);
    if (difference < least) {
      least = difference;
      best = at;
    }
  }
  return best;
}

void add_neck(const body::Body& body, std::vector<FitPlace>& places) {
  const auto girth = body.girths.find("neck_base");
  if (girth == body.girths.end() || !(girth->second.value_m > 0))
    return;
  for (const char* name : {"neck_front", "neck_back", "neck_side_l", "neck_side_r"})
    if (!body.has_landmark(name))
      return;
  const Vec3 front = body.landmark("neck_front"), back = body.landmark("neck_back"),
             left = body.landmark("neck_side_l"), right = body.landmark("neck_side_r");
  const Vec3 normal = (front - back).cross(left - right).normalized(); // z cross x: up
  if (!(normal.y() > 0.3))
    return; // landmarks that lie in no plane of a neck
  const Vec3 center = 0.25 * (front + back + left + right);
  places.push_back({"neck_base",
                    "neck",
                    center,
                    normal,
                    girth->second.value_m,
                    girth->second.spread_m,
                    HEIGHT_ERROR,
                    {},
                    {}});
  const auto neck = body.girths.find("neck");
  if (neck == body.girths.end() || !(neck->second.value_m > 0))
    return;
  // A neck leans forward, between the plane of its base and the head above it.
  const Vec3 up = body.has_landmark("head_tip")
                      ? Vec3((body.landmark("head_tip") - center).normalized())
                      : normal,
             axis = (normal + up).normalized();
  if (const auto at = like_girth(body, {body::Part::HEAD, body::Part::TORSO}, center, axis,
                                 NECK_REACH, neck->second.value_m))
    places.push_back({"neck",
                      "neck",
                      *at,
                      axis,
                      neck->second.value_m,
                      neck->second.spread_m,
                      HEIGHT_ERROR,
                      {},
                      {}});
}

} // namespace

double skin_girth(const body::Body& body, const std::vector<body::Part>& parts, const Vec3& center,
                  const Vec3& normal) {
  return girth_in(body, body::cross_plane(center, normal), faces_of(body, parts));
}

std::vector<FitPlace> fit_places(const body::Body& body) {
  std::vector<FitPlace> places;
  add_levels(body, places);
  add_neck(body, places);
  for (const std::string side : {"l", "r"}) {
    const std::string other = side == "l" ? "r" : "l";
    const auto add = [&](const std::string& name, const Vec3& center, const Vec3& normal,
                         std::vector<std::string> frames, std::vector<Vec3> outside) {
      const auto found = body.girths.find(name + "_" + side);
      if (found == body.girths.end() || !(found->second.value_m > 0))
        return;
      places.push_back({name + "_" + side, "limb", center, normal, found->second.value_m,
                        found->second.spread_m, HEIGHT_ERROR, std::move(frames),
                        std::move(outside)});
    };
    const auto has = [&](const std::string& name) { return body.has_landmark(name + "_" + side); };
    const auto at = [&](const std::string& name) { return body.landmark(name + "_" + side); };
    const std::vector<std::string> arm = {"upper_arm_" + side, "forearm_" + side};
    if (has("shoulder_joint") && has("elbow"))
      add("upper_arm", 0.5 * (at("shoulder_joint") + at("elbow")),
          (at("shoulder_joint") - at("elbow")).normalized(), arm, {});
    if (has("wrist") && has("elbow"))
      add("wrist", at("wrist"), (at("elbow") - at("wrist")).normalized(), arm, {});
    // Legs are cut level, as the body's are; their cloth hangs on a leg or on the torso above it.
    const auto add_leg = [&](const std::string& name, double y) {
      const auto here = leg_point(body, side, y), there = leg_point(body, other, y);
      if (here)
        add(name, *here, Vec3::UnitY(), {},
            there ? std::vector<Vec3>{*there} : std::vector<Vec3>{});
    };
    if (body.has_landmark("crotch"))
      add_leg("thigh", body.landmark("crotch").y() - 0.01);
    if (has("knee"))
      add_leg("knee", at("knee").y());
    if (!has("knee") || !has("ankle"))
      continue;
    const body::Part leg = side == "l" ? body::Part::LEG_L : body::Part::LEG_R;
    for (const char* name : {"calf", "ankle_min"}) {
      const auto girth = body.girths.find(name + std::string("_") + side);
      if (girth == body.girths.end())
        continue;
      const Vec3 knee = at("knee"), ankle = at("ankle");
      if (const auto there = like_girth(body, {leg}, ankle, Vec3::UnitY(), knee.y() - ankle.y(),
                                        girth->second.value_m))
        add_leg(name, there->y());
    }
  }
  return places;
}

std::vector<char> cloth_of(const Garment& garment, const FitPlace& place) {
  std::vector<double> share(garment.position.size(), 0);
  for (std::size_t i = 0; i < share.size(); ++i)
    for (const BindWeight& w : garment.bind.particles[i]) {
      const std::string& frame = garment.bind.frames[w.frame];
      const bool belongs =
          place.frames.empty()
              ? !is_arm(frame)
              : std::find(place.frames.begin(), place.frames.end(), frame) != place.frames.end();
      if (belongs)
        share[i] += w.weight;
    }
  std::vector<char> use(garment.panels.triangles.size(), 0);
  for (std::size_t f = 0; f < use.size(); ++f) {
    double sum = 0;
    for (const int v : garment.panels.triangles[f])
      sum += share[garment.particle_of[v]];
    use[f] = sum > 1.5;
  }
  return use;
}

const std::vector<std::string>& fit_row_names() {
  static const std::vector<std::string> NAMES = {
      "bust",      "chest_axilla", "underbust", "omphalion", "waist_semantic",  "waist_girth_min",
      "abdomen",   "hip",          "crotch",    "neck",      "waist_width_min", "hip_girth_max",
      "neck_base", "neck_edge",    "top_edge",  "upper_arm", "wrist",           "sleeve_hem",
      "thigh",     "knee",         "calf",      "ankle_min", "leg_hem"};
  return NAMES;
}

bool has_sides(const std::string& row) {
  static const std::vector<std::string> LIMBS = {"upper_arm", "wrist", "sleeve_hem", "thigh",
                                                 "knee",      "calf",  "ankle_min",  "leg_hem"};
  return std::find(LIMBS.begin(), LIMBS.end(), row) != LIMBS.end();
}

std::string spoken_girth(const std::string& girth) {
  static const std::map<std::string, std::string> SPOKEN = {
      {"waist_semantic", "waist"},
      {"waist_girth_min", "narrowest waist"},
      {"waist_width_min", "waist seen from the front"},
      {"omphalion", "navel"},
      {"chest_axilla", "chest under the arms"},
      {"hip_girth_max", "widest hip"},
      {"ankle_min", "ankle"},
  };
  std::string name = girth, side;
  if (name.ends_with("_l"))
    side = "left ";
  else if (name.ends_with("_r"))
    side = "right ";
  if (!side.empty())
    name.resize(name.size() - 2);
  if (const auto spoken = SPOKEN.find(name); spoken != SPOKEN.end())
    return side + spoken->second;
  std::replace(name.begin(), name.end(), '_', ' ');
  return side + name;
}

} // namespace sloper::garment
