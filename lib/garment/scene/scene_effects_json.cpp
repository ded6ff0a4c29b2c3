#include <garment/scene/scene_effects_json.hpp>
#include <sloper/base/number_text.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>

#include <cmath>

namespace sloper::garment {

namespace {

using io::Json;
using io::Node;

constexpr double DEGREE = units::PI / 180;
/// A collar folded over to its outside and pressed: nearly back on itself, held there by its seams
/// and pressing as by a cord. A crease's angle has the other sign.
constexpr double ROLL_ANGLE = 165, ROLL_FIRMNESS = 30;
constexpr double SAME_PLACE = 1e-6; // in (s, t)

double in_range(const Node& node, const char* key, double fallback, double low, double high) {
  if (!node.has(key))
    return fallback;
  const double value = node.at(key).number();
  if (!(value >= low && value <= high))
    node.at(key).fail("json.out-of-range"_id, "is out of range",
                      "give a value from " + range_text(low, high));
  return value;
}

std::string one_of(const Node& node, const char* key, std::initializer_list<const char*> names) {
  if (!node.has(key))
    return {};
  const std::string value = node.at(key).string();
  std::string list;
  for (const char* name : names) {
    if (value == name)
      return value;
    list += (list.empty() ? "" : ", ") + std::string(name);
  }
  node.at(key).fail("json.unknown-word"_id, "\"" + value + "\" is not known", "known are " + list);
}

/// (s, t) on a panel.
Vec2 read_place(const Node& node) {
  constexpr double ROUNDING = 1e-6;
  const Vec2 at = node.vec2();
  if (at.minCoeff() < -ROUNDING || at.maxCoeff() > 1 + ROUNDING)
    node.fail("json.out-of-range"_id, "lies outside of the panel",
              "s and t go from 0 to 1 over the panel's bounding box");
  return at;
}

PanelRun read_run(const Node& node) {
  PanelRun run;
  run.panel = node.at("panel").string();
  if (node.has("at")) {
    if (node.has("from") || node.has("to"))
      node.fail("scene.bad-effect"_id, "names both a point (at) and a line (from, to)");
    run.from = run.to = read_place(node.at("at"));
  } else {
    run.from = read_place(node.at("from"));
    run.to = read_place(node.at("to"));
  }
  return run;
}

/// A crease or roll line but for its angle.
SceneCrease read_fold(const Node& node, double firmness) {
  node.allow_only({"panel", "from", "to", "via", "angle_deg", "firmness"});
  SceneCrease crease;
  crease.run = read_run(node);
  crease.firmness = in_range(node, "firmness", firmness, 1, 1000);
  Vec2 before = crease.run.from;
  const auto go_to = [&](const Node& at, const Vec2& place) {
    if ((place - before).norm() < SAME_PLACE)
      at.fail("scene.bad-effect"_id, "is the place before it again", "give places that differ");
    before = place;
  };
  if (node.has("via"))
    for (std::size_t k = 0; k < node.at("via").size(); ++k) {
      const Node at = node.at("via").at(k);
      crease.via.push_back(read_place(at));
      go_to(at, crease.via.back());
    }
  go_to(node.at("to"), crease.run.to);
  return crease;
}

Json run_json(const PanelRun& run) {
  Json j;
  j["panel"] = run.panel;
  if (run.from == run.to) {
    j["at"] = io::to_json(run.from);
  } else {
    j["from"] = io::to_json(run.from);
    j["to"] = io::to_json(run.to);
  }
  return j;
}

template<class Item, class Read>
void read_list(const Node& node, const char* key, std::vector<Item>& list, Read read) {
  if (!node.has(key))
    return;
  const Node items = node.at(key);
  if (!items.is_array())
    items.fail("json.wrong-type"_id, "expected a list");
  for (std::size_t k = 0; k < items.size(); ++k)
    list.push_back(read(items.at(k)));
}

template<class Item, class Write>
void write_list(Json& out, const char* key, const std::vector<Item>& list, Write write) {
  if (list.empty())
    return;
  out[key] = Json::array();
  for (const Item& item : list)
    out[key].push_back(write(item));
}

} // namespace

SceneEffects read_scene_effects(const Node& node) {
  SceneEffects scene;
  scene.membrane = one_of(node, "membrane", {"springs", "triangles", "fem"});
  scene.bending = one_of(node, "bending", {"isometric", "dihedral"});
  read_list(node, "pins", scene.pins, [](const Node& n) {
    n.allow_only({"panel", "at", "from", "to", "target_m", "stiffness_n_m"});
    ScenePin pin;
    pin.run = read_run(n);
    pin.has_target = n.has("target_m");
    if (pin.has_target)
      pin.target = n.at("target_m").vec3();
    pin.stiffness_n_m = in_range(n, "stiffness_n_m", pin.stiffness_n_m, 1e-3, 1e7);
    return pin;
  });
  read_list(node, "bands", scene.bands, [](const Node& n) {
    n.allow_only({"panel", "at", "from", "to", "ratio", "strength_n"});
    SceneBand band;
    band.run = read_run(n);
    band.ratio = in_range(n, "ratio", band.ratio, 0.05, 1.5);
    band.strength_n = in_range(n, "strength_n", band.strength_n, 1e-3, 1e5);
    return band;
  });
  read_list(node, "attachments", scene.attachments, [](const Node& n) {
    n.allow_only(
        {"panel", "at", "from", "to", "anchor_m", "landmark", "rest_length_m", "stiffness_n_m"});
    SceneAttachment a;
    a.run = read_run(n);
    if (n.has("anchor_m") == n.has("landmark"))
      n.fail("json.missing-key"_id, "needs either anchor_m or landmark");
    if (n.has("anchor_m"))
      a.anchor = n.at("anchor_m").vec3();
    a.landmark = n.string("landmark", "");
    a.rest_length_m = in_range(n, "rest_length_m", a.rest_length_m, 0, 10);
    a.stiffness_n_m = in_range(n, "stiffness_n_m", a.stiffness_n_m, 1e-3, 1e7);
    return a;
  });
  read_list(node, "shrink", scene.shrink, [](const Node& n) {
    n.allow_only({"panel", "from", "to", "warp", "weft"});
    SceneShrink s;
    s.panel = n.string("panel", "");
    if (n.has("from"))
      s.low = read_place(n.at("from"));
    if (n.has("to"))
      s.high = read_place(n.at("to"));
    s.warp = in_range(n, "warp", 1, 0.05, 3);
    s.weft = in_range(n, "weft", 1, 0.05, 3);
    return s;
  });
  read_list(node, "creases", scene.creases, [](const Node& n) {
    SceneCrease crease = read_fold(n, 1);
    crease.angle_rad = in_range(n, "angle_deg", 0, -175, 175) * DEGREE;
    return crease;
  });
  read_list(node, "roll_lines", scene.creases, [](const Node& n) {
    SceneCrease crease = read_fold(n, ROLL_FIRMNESS);
    crease.angle_rad = -in_range(n, "angle_deg", ROLL_ANGLE, -175, 175) * DEGREE;
    crease.turns = true;
    return crease;
  });
  read_list(node, "closures", scene.closures, [](const Node& n) {
    n.allow_only({"kind", "panel", "from", "to", "with", "count", "stiffness_n_m"});
    SceneClosure closure;
    closure.run = read_run(n);
    const Node with = n.at("with");
    with.allow_only({"panel", "from", "to"});
    closure.with = read_run(with);
    const std::string kind = one_of(n, "kind", {"buttons", "zip"});
    if (kind == "zip" && n.has("count"))
      n.at("count").fail("scene.bad-effect"_id, "a zip is not counted");
    if (kind != "zip")
      closure.count = static_cast<int>(in_range(n, "count", 5, 1, 200));
    closure.stiffness_n_m = in_range(n, "stiffness_n_m", closure.stiffness_n_m, 1, 1e6);
    return closure;
  });
  read_list(node, "weights", scene.weights, [](const Node& n) {
    n.allow_only({"panel", "at", "from", "to", "mass_kg"});
    SceneWeight weight;
    weight.run = read_run(n);
    weight.mass_kg = in_range(n, "mass_kg", weight.mass_kg, 1e-6, 100);
    return weight;
  });
  scene.air = node.has("wind_m_s");
  if (scene.air)
    scene.wind_m_s = node.at("wind_m_s").vec3();
  if (scene.wind_m_s.norm() > 100)
    node.at("wind_m_s").fail("json.out-of-range"_id, "is beyond 100 m/s");
  scene.pressure_pa = in_range(node, "pressure_pa", 0, -1e5, 1e5);
  return scene;
}

Json scene_effects_json(const SceneEffects& scene) {
  Json out = Json::object();
  if (!scene.membrane.empty())
    out["membrane"] = scene.membrane;
  if (!scene.bending.empty())
    out["bending"] = scene.bending;
  write_list(out, "pins", scene.pins, [](const ScenePin& pin) {
    Json j = run_json(pin.run);
    if (pin.has_target)
      j["target_m"] = io::to_json(pin.target);
    j["stiffness_n_m"] = pin.stiffness_n_m;
    return j;
  });
  write_list(out, "bands", scene.bands, [](const SceneBand& band) {
    Json j = run_json(band.run);
    j["ratio"] = band.ratio;
    j["strength_n"] = band.strength_n;
    return j;
  });
  write_list(out, "attachments", scene.attachments, [](const SceneAttachment& a) {
    Json j = run_json(a.run);
    if (a.landmark.empty())
      j["anchor_m"] = io::to_json(a.anchor);
    else
      j["landmark"] = a.landmark;
    j["rest_length_m"] = a.rest_length_m;
    j["stiffness_n_m"] = a.stiffness_n_m;
    return j;
  });
  write_list(out, "shrink", scene.shrink, [](const SceneShrink& s) {
    Json j;
    if (!s.panel.empty())
      j["panel"] = s.panel;
    j["from"] = io::to_json(s.low);
    j["to"] = io::to_json(s.high);
    j["warp"] = s.warp;
    j["weft"] = s.weft;
    return j;
  });
  write_list(out, "creases", scene.creases, [](const SceneCrease& crease) {
    Json j = run_json(crease.run);
    j["angle_deg"] = crease.angle_rad / DEGREE;
    if (crease.firmness != 1)
      j["firmness"] = crease.firmness;
    for (const Vec2& place : crease.via)
      j["via"].push_back(io::to_json(place));
    return j;
  });
  write_list(out, "weights", scene.weights, [](const SceneWeight& weight) {
    Json j = run_json(weight.run);
    j["mass_kg"] = weight.mass_kg;
    return j;
  });
  write_list(out, "closures", scene.closures, [](const SceneClosure& closure) {
    Json j;
    j["kind"] = closure.count > 0 ? "buttons" : "zip";
    j.update(run_json(closure.run));
    j["with"] = run_json(closure.with);
    if (closure.count > 0)
      j["count"] = closure.count;
    j["stiffness_n_m"] = closure.stiffness_n_m;
    return j;
  });
  if (scene.air)
    out["wind_m_s"] = io::to_json(scene.wind_m_s);
  if (scene.pressure_pa != 0)
    out["pressure_pa"] = scene.pressure_pa;
  return out;
}

} // namespace sloper::garment
