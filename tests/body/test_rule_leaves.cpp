/// Every rule that a landmark or level can be found by is reached, and the spread says how far to believe it.
#include "figures.hpp"

#include <gtest/gtest.h>
#include <io/scan_reader.hpp>

#include <cstdlib>
#include <filesystem>

using namespace sloper;
using namespace sloper::body;

namespace {

/// A mannequin with bumps or dimples: paraboloids on the skin near points of the front.
TriangleMesh with_relief(TriangleMesh mesh, const std::vector<std::pair<Vec3, double>>& marks, double radius) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (const auto& [at, height] : marks) {
      const double d = std::hypot(mesh.positions[v].x() - at.x(), mesh.positions[v].y() - at.y());
      if (normals[v].z() > 0.3 && d < radius) mesh.positions[v].z() += height * (1 - d * d / (radius * radius));
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
    for (const Vec3& hole : holes) gone |= (mesh.positions[v] - hole).norm() < radius;
    if (gone) continue;
    number[v] = static_cast<int>(out.positions.size());
    out.positions.push_back(mesh.positions[v]);
  }
  for (const Triangle& t : mesh.triangles)
    if (number[t[0]] >= 0 && number[t[1]] >= 0 && number[t[2]] >= 0) out.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return out;
}

void collect(const Body& body, std::set<std::string>& rules) {
  for (const auto& [name, landmark] : body.landmarks) rules.insert(landmark.rule);
  for (const auto& [name, level] : body.levels) rules.insert(level.rule);
}

} // namespace

TEST(RuleLeaves, every_rule_is_reached) {
  std::set<std::string> reached;
  for (const char* name : {"f-165-a", "m-185-t", "m-170-stout", "f-178-slim"}) collect(test::measure(test::mannequin(name).mesh).body, reached);
  const TriangleMesh& woman = test::mannequin("f-165-a").mesh;
  const TriangleMesh& man = test::mannequin("m-178-a").mesh;
  const double f = 1.65, m = 1.78;
  // nipples and a navel
  collect(
      test::measure(with_relief(woman, {{Vec3(0.07 * f, 0.715 * f, 0), 0.012}, {Vec3(-0.07 * f, 0.715 * f, 0), 0.012}, {Vec3(0, 0.60 * f, 0), -0.012}}, 0.022))
          .body,
      reached);
  // a flat chest with muscles
  collect(test::measure(with_relief(man, {{Vec3(0.07 * m, 0.72 * m, 0), 0.006}, {Vec3(-0.07 * m, 0.72 * m, 0), 0.006}}, 0.03)).body, reached);
  // a hole at the crotch
  const Body whole = test::measure(woman).body;
  collect(test::measure(cloud_of(without(woman, {test::in_scan(whole, "crotch")}, 0.05))).body, reached);
  // our mannequins' arms are cones: only a real shape has a swell above the elbow
  bool swell = true;
  if (const char* shared = std::getenv("SLOPER_SHARED"))
    if (const auto path = std::filesystem::path(shared) / "data" / "bodies" / "plain" / "body_003.obj"; std::filesystem::exists(path)) {
      collect(test::measure(io::read_scan(path.string()).mesh).body, reached);
      swell = reached.count("upper_arm_swells") != 0;
    }
  EXPECT_TRUE(swell) << "upper_arm_swells was not reached";
  const std::set<std::string> leaves = {"highest_point",
                                        "farthest_over_the_skin",
                                        "farthest_from_shoulder",
                                        "foremost_of_foot",
                                        "rearmost_of_foot",
                                        "leg_sections_merge",
                                        "below_buttocks",
                                        "gap_closes",
                                        "level_sections_merge",
                                        "beside_arm_pit",
                                        "between_arm_pit_and_shoulder",
                                        "above_shoulder_joint",
                                        "least_girth_after_hand",

                                        "rearmost_at_elbow",
                                        "section_under_crotch",
                                        "above_leg_top",
                                        "middle_of_hip_joints",
                                        "height_ratio",
                                        "outermost_at_ankle",
                                        "foremost_at_knee",
                                        "hollow_of_throat",
                                        "neck_meets_shoulders",
                                        "middle_of_neck_ring",
                                        "bump_of_chest",
                                        "proportion",
                                        "foremost_of_chest",
                                        "dimple",
                                        "trunk_ratio",
                                        "foremost_below_waist",
                                        "rearmost_below_waist",
                                        "section_at_hip",
                                        "smallest_girth",
                                        "smallest_width",
                                        "largest_girth",
                                        "axilla_folds"};
  for (const std::string& leaf : leaves) EXPECT_TRUE(reached.count(leaf)) << leaf << " was not reached";
  for (const std::string& rule : reached) RecordProperty(rule, "reached");
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
  for (const auto& [name, girth] : body.girths) EXPECT_LT(girth.spread_m, 0.03) << name;
}

TEST(Spread, is_the_same_on_every_run) {
  ScanOptions options;
  options.jitter = 2;
  const Body a = test::measure(test::mannequin("f-165-a").mesh, options).body, b = test::measure(test::mannequin("f-165-a").mesh, options).body;
  for (const auto& [name, landmark] : a.landmarks) EXPECT_EQ(landmark.spread_m, b.landmarks.at(name).spread_m) << name;
}
