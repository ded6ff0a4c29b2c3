#include <sloper/body/export/exports.hpp>

#include <cstdio>

namespace sloper::body {

namespace {

/// Our names and those of ISO 8559-1:2017, where the standard has the measurement.
constexpr std::pair<const char*, const char*> ISO_NAMES[] = {
    {"neck", "neck girth"},
    {"neck_base", "neck base girth"},
    {"crotch_length", "total crotch length"},
    {"thigh", "thigh girth"},
    {"knee", "knee girth"},
    {"calf", "calf girth"},
    {"ankle_min", "minimum leg girth"},
    {"upper_arm", "upper-arm girth"},
    {"wrist", "wrist girth"},
    {"bust", "bust girth"},
    {"chest_axilla", "upper chest girth"},
    {"underbust", "under-bust girth"},
    {"waist_semantic", "waist girth"},
    {"abdomen", "maximum abdominal girth"},
    {"hip", "hip girth"},
    {"crotch", "inside leg height"},
};

std::string iso_name(std::string name) {
  if (name.size() > 2 && (name.ends_with("_l") || name.ends_with("_r")))
    name.resize(name.size() - 2);
  for (const auto& [ours, iso] : ISO_NAMES)
    if (name == ours)
      return iso;
  return "";
}

void row(std::string& out, const std::string& kind, const std::string& name, double value,
         double spread, const std::string& iso) {
  char text[200];
  std::snprintf(text, sizeof text, "%s,%s,%.4f,%.4f,%s\n", kind.c_str(), name.c_str(), value,
                spread, iso.c_str());
  out += text;
}

} // namespace

std::string measurements_csv(const Body& body) {
  std::string out = "kind,name,value_m,spread_m,iso_8559_1\n";
  row(out, "height", "stature", body.scan.stature_m,
      body.has_landmark("head_tip") ? body.landmarks.at("head_tip").spread_m : 0, "stature");
  for (const auto& [name, girth] : body.girths)
    row(out, "girth", name, girth.value_m, girth.spread_m, iso_name(name));
  for (const auto& [name, level] : body.levels) {
    row(out, "level_height", name, level.y, level.y_spread_m,
        name == "crotch" ? iso_name(name) : std::string());
    row(out, "level_girth", name, level.girth_m, level.girth_spread_m,
        name == "crotch" ? std::string() : iso_name(name));
  }
  return out;
}

std::string skeleton_obj(const Body& body) {
  std::string out = "# bones as lines, m, body frame\n";
  char text[200];
  int vertex = 0;
  for (const Bone& bone : body.bones) {
    std::snprintf(text, sizeof text, "o %s\nv %.6f %.6f %.6f\nv %.6f %.6f %.6f\nl %d %d\n",
                  bone.name.c_str(), bone.head.x(), bone.head.y(), bone.head.z(), bone.tail.x(),
                  bone.tail.y(), bone.tail.z(), vertex + 1, vertex + 2);
    out += text;
    vertex += 2;
  }
  return out;
}

void anonymise(Body& body) {
  body.skin = {};
  body.face_part.clear();
  body.scan.file.clear();
  body.scan.sha256.clear();
}

} // namespace sloper::body
