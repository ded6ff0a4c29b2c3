/// Creases and roll lines of a scene on meshes that have no edges along them.
#include <garment/scene/crease_angles.hpp>
#include <garment/scene/fold_edges.hpp>
#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/scene/scene_folds.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A strip of 24 by 6 cm that curves, on an unstructured mesh, upright at a height of 1 m, pinned
/// along its lower edge. The lines of the panel in `lines`.
Garment strip(const std::string& lines = "") {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "strip", "panels": [
      {"name": "strip", "outline": [{"edge": "low", "path": [["M", -12, 0], ["Q", 0, 3, 12, 0]]},
        {"edge": "r", "path": [["L", 12, 6]]}, {"edge": "free", "path": [["Q", 0, 9, -12, 6]]},
        {"edge": "l", "path": [["L", -12, 0]]}])" +
      lines + R"(}], "seams": []})";
  Garment garment;
  garment.panels = pattern::mesh_pattern(
      pattern::read_pattern_json(io::parse_json(text, "strip"), "strip"), 0.012, "strip");
  for (std::size_t v = 0; v < garment.panels.pattern.size(); ++v)
    garment.panels.placed[v] =
        Vec3(garment.panels.pattern[v].x(), 1 + garment.panels.pattern[v].y(), 0);
  garment.materials[""] = material_preset("cotton-poplin");
  return garment;
}

/// A fold 2 cm above the lower edge, over which the cloth is folded to the outside.
SceneCrease roll() {
  SceneCrease crease;
  crease.run = {"strip", Vec2(0, 2 / 7.5), Vec2(1, 2 / 7.5)};
  crease.via = {Vec2(0.5, 3.5 / 7.5)};
  crease.angle_rad = -165 * M_PI / 180;
  crease.firmness = 30;
  return crease;
}

/// Largest distance of a fold's vertices from its line, m.
double farthest_from_line(const Garment& garment, const SceneCrease& crease) {
  const pattern::Path path = fold_path(garment, crease);
  const pattern::ArcLength arc(path);
  double most = 0;
  for (const auto& edge : fold_edges(garment, crease))
    for (int v : edge) {
      double least = 1;
      for (int k = 0; k <= 1000; ++k)
        least =
            std::min(least, (arc.at(arc.length() * k / 1000) - garment.panels.pattern[v]).norm());
      most = std::max(most, least);
    }
  return most;
}

} // namespace

TEST(SceneFolds, LoosePanelsGetEdgesAlongALineThatTheirMeshLacks) {
  Garment garment = strip();
  garment.scene.creases = {roll()};
  EXPECT_FALSE(is_meshed(garment, roll()));
  EXPECT_GT(farthest_from_line(garment, roll()), 0.002) << "a zigzag";
  EXPECT_TRUE(mesh_along_folds(garment, nullptr, "", "scene.json").empty());
  EXPECT_TRUE(is_meshed(garment, roll()));
  EXPECT_LT(farthest_from_line(garment, roll()), 2e-4);
  for (std::size_t v = 0; v < garment.panels.placed.size(); ++v) // where the given panels lay
    EXPECT_NEAR(garment.panels.placed[v].y(), 1 + garment.panels.pattern[v].y(), 1e-3);
  const std::vector<Vec2> once = garment.panels.pattern;
  mesh_along_folds(garment, nullptr, "", "scene.json");
  EXPECT_EQ(garment.panels.pattern, once) << "they have them now";
}

TEST(SceneFolds, ASceneMeshesAsAPatternThatDrawsTheLine) {
  Garment drawn = strip(
      R"(, "lines": [{"name": "scene-creases-0", "kind": "fold", "path": [["M", -12, 2], ["L", 12, 5]]}])");
  Garment garment = strip();
  SceneCrease crease;
  crease.run = {"strip", Vec2(0, 2 / 7.5), Vec2(1, 5 / 7.5)};
  crease.angle_rad = 1;
  garment.scene.creases = drawn.scene.creases = {crease};
  mesh_along_folds(garment, nullptr, "", "scene.json");
  mesh_along_folds(drawn, nullptr, "", "scene.json");
  ASSERT_EQ(garment.panels.pattern.size(), drawn.panels.pattern.size());
  for (std::size_t v = 0; v < drawn.panels.pattern.size(); ++v)
    EXPECT_LT((garment.panels.pattern[v] - drawn.panels.pattern[v]).norm(), 1e-6);
}

TEST(SceneFolds, IdsOfAnEditedPanelStay) {
  Garment garment = strip();
  for (pattern::StableId& id : garment.panels.ids)
    id.s = 0.25 + 0.5 * id.s; // the drawing was twice as wide before
  SceneCrease crease = roll();
  crease.run.from.x() = 0.25;
  crease.run.to.x() = 0.75;
  garment.scene.creases = {crease};
  mesh_along_folds(garment, nullptr, "", "scene.json");
  EXPECT_LT(farthest_from_line(garment, crease), 2e-4);
  for (std::size_t v = 0; v < garment.panels.ids.size(); ++v)
    EXPECT_NEAR(garment.panels.ids[v].s, 0.5 + 0.5 * garment.panels.pattern[v].x() / 0.24, 1e-9);
}

TEST(SceneFolds, ALineThatTheMeshHasNoRoomForIsTold) {
  Garment garment = strip();
  SceneCrease crease = roll();
  crease.run = {"strip", Vec2(0, 0.4 / 7.5), Vec2(1, 0.4 / 7.5)};
  crease.via = {Vec2(0.5, 1.9 / 7.5)};
  garment.scene.creases = {crease};
  const std::vector<Message> findings = mesh_along_folds(garment, nullptr, "", "scene.json");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].id, "scene.fold-left-out");
  EXPECT_NE(findings[0].text.find(
                "scene.json: /creases/0: the mesh of panel strip has no edges along some"),
            std::string::npos)
      << findings[0].text;
  for (const Message& finding : garment.panels.findings)
    EXPECT_NE(finding.id, "mesh.line-left-out") << finding.text;
}

TEST(SceneFolds, ARollLineNearTheOutlineGetsAFinerPanel) {
  Garment garment = strip();
  SceneCrease crease = roll();
  crease.run = {"strip", Vec2(0, 0.6 / 7.5), Vec2(1, 0.6 / 7.5)};
  crease.via = {Vec2(0.5, 2.1 / 7.5)};
  crease.turns = true;
  garment.scene.creases = {crease};
  EXPECT_TRUE(mesh_along_folds(garment, nullptr, "", "scene.json").empty());
  EXPECT_TRUE(is_meshed(garment, crease));
}

TEST(SceneFolds, ASewnGarmentKeepsItsMeshAndItIsTold) {
  Garment garment = strip();
  garment.scene.creases = {roll()};
  unsew(garment);
  const std::vector<Vec2> before = garment.panels.pattern;
  const std::vector<Message> findings = mesh_along_folds(garment, nullptr, "", "scene.json");
  EXPECT_EQ(garment.panels.pattern, before);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].text.find("scene.json: /creases/0: the mesh of panel strip has no edges"),
            std::string::npos)
      << findings[0].text;
}

TEST(SceneFolds, ALineOnAnUnstructuredMeshFoldsTheClothOver) {
  // Along the shortest way over edges the cloth ended 21 to 67 mm from its mirror image.
  constexpr double LINE = 0.032; // m above the lowest point of the panel
  Garment garment = strip();
  SceneCrease crease = roll();
  crease.run = {"strip", Vec2(0, LINE / 0.075), Vec2(1, LINE / 0.075)};
  crease.via.clear();
  garment.scene.creases = {crease};
  for (double t : {0.0, 1.0 / 7.5})
    garment.scene.pins.push_back({{"strip", Vec2(0, t), Vec2(1, t)}, false, Vec3::Zero(), 1e4});
  mesh_along_folds(garment, nullptr, "", "scene.json");
  const DrapeReport report = drape(garment, nullptr, preset_settings("draft"), silent_reporter());
  EXPECT_TRUE(report.converged);
  for (std::size_t v = 0; v < garment.panels.pattern.size(); ++v) {
    const Vec2& p = garment.panels.pattern[v];
    if (p.y() > LINE + 0.01) {
      EXPECT_NEAR(garment.position[garment.particle_of[v]].y(), 1 + 2 * LINE - p.y(), 0.004);
    }
  }
}
