#include "measures.hpp"
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>
namespace sloper::samples {
namespace {

constexpr int BODY_VERSION = 1;      // newest that is read
constexpr double HALF_BAND = 0.0175; // m, of a waistband
constexpr const char* TRUNK_LEVELS[] = {
    "underbust", "waist_girth_min", "waist_semantic", "waist_width_min", "omphalion", "abdomen",
    "hip",       "hip_girth_max"};

/// What tailors and the body document call the measures otherwise.
const std::map<std::string, std::string> OTHER_NAMES = {{"height", "stature"},
                                                        {"chest", "bust"},
                                                        {"seat", "hip"},
                                                        {"hips", "hip"},
                                                        {"collar", "neck"},
                                                        {"bicep", "upper-arm"},
                                                        {"biceps", "upper-arm"},
                                                        {"back", "back-length"},
                                                        {"nape-to-waist", "back-length"},
                                                        {"rise", "body-rise"},
                                                        {"inseam", "inside-leg"},
                                                        {"inner-leg", "inside-leg"},
                                                        {"crotch", "crotch-length"},
                                                        {"crotch-depth", "body-rise"},
                                                        {"armhole-depth", "scye-depth"},
                                                        {"shoulder-length", "shoulder"},
                                                        {"sleeve", "arm-length"},
                                                        {"sleeve-length", "arm-length"}};

/// Landmark, level and girth by name; missing ones are nothing.
class Reader {
public:
  Reader(const io::Json& body, const std::string& file) : m_body(body, file) {}
  bool point(const std::string& name, Vec3& p) const {
    if (!m_body.has("landmarks") || !m_body.at("landmarks").has(name))
      return false;
    const io::Node entry = m_body.at("landmarks").at(name);
    if (!entry.has("p") || entry.at("p").is_null())
      return false;
    p = entry.at("p").vec3();
    return true;
  }
  bool level(const std::string& name, double& girth, double& y) const {
    if (!m_body.has("levels") || !m_body.at("levels").has(name))
      return false;
    const io::Node entry = m_body.at("levels").at(name);
    if (!entry.has("girth_m") || entry.at("girth_m").is_null())
      return false;
    girth = entry.at("girth_m").number();
    y = entry.at("y").number();
    return true;
  }
  /// Girth of the trunk at a height, m, between the levels of the document; nothing outside of
  /// them.
  std::optional<double> trunk_girth(double at) const {
    std::map<double, double> by_height;
    double y = 0, around = 0;
    for (const char* name : TRUNK_LEVELS)
      if (level(name, around, y))
        by_height[y] = around;
    const auto above = by_height.lower_bound(at);
    if (above == by_height.end() || above == by_height.begin())
      return std::nullopt;
    const auto below = std::prev(above);
    const double share = (at - below->first) / (above->first - below->first);
    return below->second + share * (above->second - below->second);
  }
  void girth(const std::string& name, double& value) const {
    if (!m_body.has("girths") && !m_body.has("girths_m"))
      return;
    const io::Node girths = m_body.at(m_body.has("girths") ? "girths" : "girths_m");
    if (!girths.has(name))
      return;
    const io::Node entry = girths.at(name);
    if (entry.is_number())
      value = entry.number();
    else if (entry.has("value_m"))
      value = entry.at("value_m").number();
  }

private:
  io::Node m_body;
};

} // namespace

std::vector<std::pair<std::string, double Measures::*>> measure_names() {
  return {{"stature", &Measures::stature},
          {"bust", &Measures::bust},
          {"waist", &Measures::waist},
          {"hip", &Measures::hip},
          {"neck", &Measures::neck},
          {"upper-arm", &Measures::upper_arm},
          {"wrist", &Measures::wrist},
          {"thigh", &Measures::thigh},
          {"knee", &Measures::knee},
          {"ankle", &Measures::ankle},
          {"back-length", &Measures::back_length},
          {"waist-to-hip", &Measures::waist_to_hip},
          {"body-rise", &Measures::body_rise},
          {"inside-leg", &Measures::inside_leg},
          {"crotch-length", &Measures::crotch_length},
          {"scye-depth", &Measures::scye_depth},
          {"shoulder", &Measures::shoulder},
          {"arm-length", &Measures::arm_length},
          {"neck-back-height", &Measures::neck_back_height},
          {"shoulder-height", &Measures::shoulder_height}};
}

Measures standard_measures(double stature) {
  Measures m;
  const double factor = stature / m.stature;
  for (const auto& [name, member] : measure_names())
    m.*member *= factor;
  return m;
}

void set_measure(Measures& m, const std::string& name, double value) {
  std::vector<std::string> names;
  for (const auto& [known, member] : measure_names()) {
    names.push_back(known);
    if (known == name) {
      if (!(value > 0.02 && value < 2.5))
        throw Error(ErrorKind::USAGE, "option.wrong-value"_id, "", "--measure " + name,
                    "is not a length of a person, in m");
      m.*member = value;
      return;
    }
  }
  const auto meant = OTHER_NAMES.find(name);
  const std::string guess = meant == OTHER_NAMES.end()
                                ? did_you_mean(name, names, "\"")
                                : " (did you mean \"" + meant->second + "\"?)";
  throw Error(ErrorKind::USAGE, "option.unknown-word"_id, "", "--measure",
              "there is no measure \"" + name + "\"" + guess, "see --help");
}

Measures measures_from_body(const io::Json& body, const std::string& file) {
  if (body.is_object() && body.contains("format"))
    io::check_envelope(body, file, "body", BODY_VERSION); // a mannequin's truth states none
  const Reader r(body, file);
  Vec3 p, q;
  if (!r.point("head_tip", p) || p.y() < 0.5)
    throw input_error("sample.no-stature"_id, file, "/landmarks/head_tip", "stature is not known",
                      "give a body document with a head_tip");
  Measures m = standard_measures(p.y());
  double y = 0, girth = 0, waist_y = m.waist_height();
  for (const char* name : {"waist_girth_min", "waist_semantic", "omphalion"})
    if (r.level(name, girth, y)) {
      m.waist = girth;
      waist_y = y;
      break;
    }
  // The narrowest girth may lie anywhere on a bellied body; garments hang at the modelled waist
  // there.
  double semantic_y = 0, semantic_girth = 0;
  if (r.level("waist_semantic", semantic_girth, semantic_y) &&
      std::abs(semantic_y - waist_y) > 0.04) {
    m.waist = semantic_girth;
    waist_y = semantic_y;
  }
  for (const double edge : {waist_y - HALF_BAND, waist_y + HALF_BAND})
    if (const auto around = r.trunk_girth(edge))
      m.waist = std::max(m.waist, *around);
  if (r.level("bust", girth, y))
    m.bust = girth;
  double hip_y = waist_y - m.waist_to_hip;
  if (r.level("hip", girth, y)) {
    m.hip = girth;
    hip_y = y;
  }
  if (r.level("hip_girth_max", girth, y))
    m.hip = std::max(m.hip, girth);
  m.waist_to_hip = std::max(0.10, waist_y - hip_y);
  if (r.point("neck_back", p))
    m.neck_back_height = p.y();
  m.back_length = m.neck_back_height - waist_y;
  if (r.point("crotch", p)) {
    m.body_rise = waist_y - p.y();
    m.inside_leg = p.y();
  }
  // measured to the modelled waist, in front and behind
  r.girth("crotch_length", m.crotch_length);
  if (m.crotch_length > 0 && semantic_y > 0)
    m.crotch_length += 2 * (waist_y - semantic_y);
  double deepest = 0; // of both arm pits
  for (const char* pit : {"axilla_l", "axilla_r"})
    if (r.point(pit, p))
      deepest = std::max(deepest, m.neck_back_height - p.y());
  if (deepest > 0)
    m.scye_depth = deepest;
  if (r.point("acromion_l", p)) {
    m.shoulder_height = p.y();
    if (r.point("neck_side_l", q))
      m.shoulder = (p - q).norm();
    Vec3 elbow, wrist;
    if (r.point("elbow_l", elbow) && r.point("wrist_l", wrist))
      m.arm_length = (elbow - p).norm() + (wrist - elbow).norm();
  }
  r.girth("neck", m.neck);
  r.girth("upper_arm_l", m.upper_arm);
  r.girth("wrist_l", m.wrist);
  r.girth("thigh_l", m.thigh);
  r.girth("knee_l", m.knee);
  r.girth("ankle_min_l", m.ankle);
  return m;
}

io::Json pattern_document(const Draft& draft) {
  const auto cm = [](double metres) { return std::round(metres * 1e6) / 1e4; }; // to a micrometre
  io::Json d = io::new_document("pattern", 1, "make-pattern");
  d["length_unit"] = "cm";
  d["name"] = draft.name;
  d["panels"] = io::Json::array();
  for (const DraftPanel& p : draft.panels) {
    io::Json panel = {{"name", p.name}, {"outline", io::Json::array()}};
    const std::size_t n = p.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 &a = p.points[i], &b = p.points[(i + 1) % n];
      io::Json path = io::Json::array();
      path.push_back({"M", cm(a.x()), cm(a.y())});
      const std::vector<Vec2>& c = p.edges[i].control;
      if (c.empty())
        path.push_back({"L", cm(b.x()), cm(b.y())});
      else
        path.push_back(
            {"C", cm(c[0].x()), cm(c[0].y()), cm(c[1].x()), cm(c[1].y()), cm(b.x()), cm(b.y())});
      if (p.edges[i].name == p.roll_edge)
        panel["lines"] = {{{"name", "roll"}, {"kind", "roll"}, {"path", path}}};
      panel["outline"].push_back({{"edge", p.edges[i].name}, {"path", path}});
    }
    panel["grain"] = {p.grain.x(), p.grain.y()};
    panel["place"] = {{"part", p.placement.part},
                      {"theta_deg", p.placement.theta_deg},
                      {"anchor", {cm(p.placement.anchor.x()), cm(p.placement.anchor.y())}}};
    if (p.placement.height > 0)
      panel["place"]["height"] = cm(p.placement.height);
    d["panels"].push_back(panel);
  }
  d["seams"] = io::Json::array();
  for (const DraftSeam& s : draft.seams) {
    io::Json a = {{"panel", s.panel_a}, {"edge", s.edge_a}},
             b = {{"panel", s.panel_b}, {"edge", s.edge_b}};
    if (s.same_direction) { // otherwise neighbours' outlines run against each other, which is the
                            // format's rule
      b["from"] = 0;
      b["to"] = 1;
    }
    io::Json seam = {{"name", s.name},
                     {"kind", s.kind},
                     {"a", io::Json::array({a})},
                     {"b", io::Json::array({b})}};
    if (s.ease != 0)
      seam["ease"] = "sleeve cap";
    d["seams"].push_back(seam);
  }
  return d;
}

} // namespace sloper::samples
