/// Every rule that a landmark or level can be found by is reached, and the spread says how far to
/// believe it.
#include <support/figures.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace sloper;
using namespace sloper::body;

namespace {

/// A mannequin with bumps or dimples: paraboloids on the skin near points of the front.
TriangleMesh with_relief(TriangleMesh mesh, const std::vector<std::pair<Vec3, double>>& marks,
                         double radius) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (const auto& [at, height] : marks) {
      const double d = std::hypot(mesh.positions[v].x() - at.x(), mesh.positions[v].y() - at.y());
      if (normals[v].z() > 0.3 && d < radius)
        mesh.positions[v].z() += height * (1 - d * d / (radius * radius));
    }
  return mesh;
}

TriangleMesh cloud_of(TriangleMesh mesh) {
  mesh.triangles.clear();
  return mesh;
}

TriangleMesh without(TriangleMesh mesh, const std::vector<Vec3>& holes, double radius) {
  std::vector<int> number(mesh.positions.size(), -1);
  TriangleMesh out;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    bool gone = false;
    for (const Vec3& hole : holes)
      gone |= (mesh.positions[v] - hole).norm() < radius;
    if (gone)
      continue;
    number[v] = static_cast<int>(out.positions.size());
    out.positions.push_back(mesh.positions[v]);
  }
  for (const Triangle& t : mesh.triangles)
    if (number[t[0]] >= 0 && number[t[1]] >= 0 && number[t[2]] >= 0)
      out.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return out;
}

using Leaf = std::pair<std::string, std::string>; ///< place and rule

/// The leaves that a decision path ends in: its lines are "PLACE[_l|_r]: RULE".
void collect(const std::vector<std::string>& trail, std::set<Leaf>& leaves) {
  static const Rules standard = Rules::standard();
  const auto& tree = standard.tree();
  for (const std::string& line : trail) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos)
      continue;
    std::string place = line.substr(0, colon);
    if (!tree.count(place) && place.size() > 2)
      place.resize(place.size() - 2);
    if (const auto it = tree.find(place); it != tree.end())
      for (const RuleChoice& rule : it->second)
        if (rule.name == line.substr(colon + 2))
          leaves.emplace(place, rule.name);
  }
}

/// A scarf: no turn from neck to shoulder; drawn over the throat no hollow either.
TriangleMesh with_scarf(TriangleMesh mesh, double s, bool over_throat) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    if (p.y() < 0.77 * s || p.y() > 0.90 * s || std::hypot(p.x(), p.z()) > 0.13 * s)
      continue;
    if (over_throat && normals[v].z() > 0.1)
      p.z() = std::max(p.z(), s * (0.09 - 0.3 * (p.y() / s - 0.78)));
    const double r = std::hypot(p.x(), p.z()), wanted = s * (0.055 + 0.9 * (0.90 - p.y() / s));
    if (p.y() > 0.79 * s && r < wanted && r > 1e-6) {
      p.x() *= wanted / r;
      p.z() *= wanted / r;
    }
  }
  return mesh;
}

/// Breeches that are full above the knee: no hollow behind it.
TriangleMesh with_breeches(TriangleMesh mesh, double s) {
  for (Vec3& p : mesh.positions)
    if (const double y = p.y() / s; y > 0.15 && y < 0.46 && p.z() < 0)
      p.z() -= 0.3 * s * std::min(y - 0.15, 2 * (0.46 - y));
  return mesh;
}

/// Wide sleeves cut in one with the trunk: skin under level arms from the trunk to the elbows, and
/// no arm pit. @param side 0 both, 1 the left one, -1 the right one
TriangleMesh with_bat_sleeves(TriangleMesh mesh, double s, double side = 0) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    const double x = std::abs(p.x()) / s;
    if (p.y() > 0.6 * s && x > 0.09 && x < 0.28 && normals[v].y() < -0.2 && side * p.x() >= 0)
      p.y() -= s * std::min(0.25, 1.6 * (0.28 - x));
  }
  return mesh;
}

/// Gauntlets: from the palm up no place is thinner, and nothing swells above the elbow.
TriangleMesh with_sleeves(TriangleMesh mesh, const Body& body) {
  for (const char* side : {"_l", "_r"}) {
    const Vec3 shoulder = test::in_scan(body, std::string("shoulder_joint") + side),
               wrist = test::in_scan(body, std::string("wrist") + side);
    const double length = (shoulder - wrist).norm();
    const Vec3 axis = (shoulder - wrist) / length;
    for (Vec3& p : mesh.positions) {
      const double along = (p - wrist).dot(axis);
      const Vec3 off = p - wrist - along * axis;
      const double r = off.norm(), wanted = 0.05;
      if (along > -0.03 && along < 0.25 && r < wanted && r > 1e-6)
        p += (wanted / r - 1) * off;
    }
  }
  return mesh;
}

/// Upper arms that swell above the elbow, as muscles do: a mannequin's arms are cones.
TriangleMesh with_muscles(TriangleMesh mesh, const Body& body) {
  for (const char* side : {"_l", "_r"}) {
    const Vec3 shoulder = test::in_scan(body, std::string("shoulder_joint") + side),
               elbow = test::in_scan(body, std::string("elbow") + side);
    const double length = (shoulder - elbow).norm();
    const Vec3 axis = (shoulder - elbow) / length;
    for (Vec3& p : mesh.positions) {
      const double along = (p - elbow).dot(axis);
      const Vec3 off = p - elbow - along * axis;
      if (along < 0 || along > 0.8 * length || off.norm() > 0.08)
        continue;
      p += 0.35 * std::clamp(along / 0.05, 0.0, 1.0) *
           std::clamp((0.8 * length - along) / 0.1, 0.0, 1.0) * off;
    }
  }
  return mesh;
}

} // namespace

TEST(RuleLeaves, every_rule_of_the_tree_is_reached) {
  std::set<Leaf> reached;
  auto visit = [&](const TriangleMesh& mesh) { collect(test::measure(mesh).trail, reached); };
  for (const char* name : {"f-165-a", "m-185-t", "m-170-stout", "f-178-slim"})
    visit(test::mannequin(name).mesh);
  const TriangleMesh &woman = test::mannequin("f-165-a").mesh,
                     &man = test::mannequin("m-178-a").mesh;
  const double f = 1.65, m = 1.78;
  const Body whole = test::measure(woman).body;
  const Vec3 foremost = test::in_scan(whole, "bust_prominent_l");
  // nipples and a navel
  visit(with_relief(woman,
                    {{foremost, 0.012},
                     {Vec3(-foremost.x(), foremost.y(), 0), 0.012},
                     {Vec3(0, 0.60 * f, 0), -0.012}},
                    0.022));
  // a flat chest with muscles
  visit(with_relief(
      man, {{Vec3(0.07 * m, 0.72 * m, 0), 0.006}, {Vec3(-0.07 * m, 0.72 * m, 0), 0.006}}, 0.03));
  // bare points with a hole at the crotch, of a figure that the rest tells and of one unlike others
  const TriangleMesh hidden = cloud_of(without(woman, {test::in_scan(whole, "crotch")}, 0.05));
  visit(hidden);
  ScanOptions nothing_learned;
  nothing_learned.corrections = &Corrections::none();
  collect(test::measure(hidden, nothing_learned).trail, reached);
  visit(with_relief(with_scarf(woman, f, false), {{Vec3(0, 0.85 * f, 0), -0.04}},
                    0.03));                         // open at the throat
  visit(cloud_of(test::mannequin("m-185-t").mesh)); // level arms and rebuilt skin
  visit(with_scarf(woman, f, true));
  visit(with_breeches(woman, f));
  visit(with_bat_sleeves(test::mannequin("m-185-t").mesh, 1.85));
  visit(with_bat_sleeves(test::mannequin("m-185-t").mesh, 1.85, 1));
  samples::Mannequin pressed; // arms that touch the trunk far down
  pressed.sex = "m";
  pressed.stature_m = 1.64;
  pressed.bmi = 31;
  pressed.arm_deg = 16;
  visit(samples::make_mannequin(pressed).mesh);
  visit(with_sleeves(woman, whole));
  visit(with_muscles(woman, whole));
  const Rules standard = Rules::standard();
  for (const auto& [place, rules] : standard.tree())
    for (const RuleChoice& rule : rules)
      EXPECT_TRUE(reached.count({place, rule.name}))
          << place << " was never found by " << rule.name;
}

TEST(RuleLeaves, a_file_reorders_the_tree_and_turns_rules_off) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("sloper-tree-" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << R"({"format": "landmark-rules", "version": 1,
    "tree": {"wrist": ["arm_ratio", "least_girth_after_hand"], "olecranon": [], "knee": [{"rule": "leg_ratio", "when": {"figure": "male"}}]}})";
  ScanOptions options;
  options.rules = Rules::read(path.string());
  std::filesystem::remove(path);
  const Body body = test::measure(test::mannequin("f-165-a").mesh, options).body;
  EXPECT_EQ(body.landmarks.at("wrist_l").rule, "arm_ratio");
  EXPECT_FALSE(body.has_landmark("olecranon_l"));
  EXPECT_FALSE(body.has_landmark("knee_l")) << "that rule is for male figures";
  EXPECT_TRUE(body.has_landmark("elbow_l"));
}

TEST(Spread, grows_where_the_scan_says_little) {
  ScanOptions options;
  options.jitter = 4;
  const Body body = test::measure(test::mannequin("f-165-a").mesh, options).body;
  for (const auto& [name, landmark] : body.landmarks) {
    EXPECT_GT(landmark.spread_m, 0) << name;
    EXPECT_LT(landmark.spread_m, 0.05) << name;
    EXPECT_GE(landmark.confidence, 0);
    EXPECT_LE(landmark.confidence, 1);
  }
  EXPECT_LT(body.landmarks.at("leg_top_l").spread_m, 0.004) << "a centroid is sure";
  for (const auto& [name, girth] : body.girths)
    EXPECT_LT(girth.spread_m, 0.03) << name;
}

TEST(Spread, is_the_same_on_every_run) {
  ScanOptions options;
  options.jitter = 2;
  const Body a = test::measure(test::mannequin("f-165-a").mesh, options).body,
             b = test::measure(test::mannequin("f-165-a").mesh, options).body;
  for (const auto& [name, landmark] : a.landmarks)
    EXPECT_EQ(landmark.spread_m, b.landmarks.at(name).spread_m) << name;
}

/// The chest's foremost place is the chest's where a belly below it rises little, the belly's where
/// it rises far, and told to be either in between.
TEST(Belly, that_competes_with_the_chest_is_told) {
  const TriangleMesh& plain = test::mannequin("m-178-a").mesh;
  const double s = 1.78;
  const Body before = test::measure(plain).body;
  const Vec3 bust = test::in_scan(before, "bust_point_l");
  auto with_belly = [&](double rise, double top) {
    TriangleMesh mesh = plain;
    const std::vector<Vec3> normals = vertex_normals(mesh);
    auto bulge = [&](double y, double middle, double half) {
      return std::exp(-std::pow((y - bust.y() - middle * s) / (half * s), 2));
    };
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (Vec3& p = mesh.positions[v]; normals[v].z() > 0.3 && std::abs(p.x()) < 0.1 * s)
        p.z() += 0.02 * bulge(p.y(), 0.02, 0.015) + rise * bulge(p.y(), top, 0.03);
    return test::measure(mesh).body;
  };
  auto is_told = [](const Body& body) {
    for (const Finding& finding : body.scan.findings)
      if (finding.severity == "warning" && finding.place == "bust_prominent_l")
        return true;
    return false;
  };
  auto above_bust = [](const Body& body) {
    return body.landmark("bust_prominent_l").y() - body.landmark("bust_point_l").y();
  };
  const Body chest = with_belly(0.03, -0.05), either = with_belly(0.058, -0.05),
             belly = with_belly(0.06, -0.03);
  EXPECT_GT(above_bust(chest), 0);
  EXPECT_FALSE(is_told(chest));
  EXPECT_TRUE(is_told(either));
  EXPECT_LT(above_bust(belly), 0);
  EXPECT_FALSE(is_told(belly));
}

TEST(Bust, that_hangs_below_where_it_is_looked_for_is_told) {
  const TriangleMesh& plain = test::mannequin("f-165-plus").mesh;
  const double s = 1.65;
  const Vec3 bust = test::in_scan(test::measure(plain).body, "bust_point_l");
  auto is_told = [&](double rise) {
    TriangleMesh mesh = plain;
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (Vec3& p = mesh.positions[v]; normals[v].z() > 0.3 && std::abs(p.x()) < 0.1 * s)
        p.z() += rise * std::exp(-std::pow((p.y() - bust.y() + 0.06 * s) / (0.02 * s), 2));
    const Body body = test::measure(mesh).body;
    for (const Finding& finding : body.scan.findings)
      if (finding.severity == "warning" && finding.place == "bust_point_l")
        return true;
    return false;
  };
  EXPECT_FALSE(is_told(0));
  EXPECT_TRUE(is_told(0.07));
}
