/// Pleats as cloth: pressed along their folds, and sewn with their layers on each other.
#include <gtest/gtest.h>
#include <sloper/base/progress.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/folds.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <algorithm>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// 30 x 24 cm with a knife pleat of 4 cm, sewn along the top to a band of 22 cm; it starts folded,
/// as around a body.
Garment pleated_piece() {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "piece", "panels": [
    {"name": "piece", "outline": [{"edge": "hem", "path": [["M", -15, 0], ["L", 15, 0]]}, {"edge": "left", "path": [["L", 15, 24]]},
      {"edge": "top", "path": [["L", -15, 24]]}, {"edge": "right", "path": [["L", -15, 0]]}],
     "lines": [{"name": "target", "kind": "mark", "path": [["M", -6, 0], ["L", -6, 24]]}, {"name": "fold", "kind": "fold", "path": [["M", 2, 0], ["L", 2, 24]]}],
     "pleats": [{"name": "knife", "fold": "fold", "target": "target", "edges": ["top"]}]},
    {"name": "band", "outline": [{"edge": "low", "path": [["M", -11, 0], ["L", 11, 0]]}, {"edge": "left", "path": [["L", 11, 4]]},
      {"edge": "up", "path": [["L", -11, 4]]}, {"edge": "right", "path": [["L", -11, 0]]}]}],
    "seams": [{"name": "top", "a": [{"panel": "piece", "edge": "top"}], "b": [{"panel": "band", "edge": "low"}]}]})";
  const pattern::Pattern source =
      pattern::read_pattern_json(io::parse_json(text, "piece"), "piece");
  Garment garment;
  garment.panels = pattern::mesh_pattern(source, 0.0125, "piece");
  const pattern::Folding folding = pattern::fold_panels(source, garment.panels);
  const pattern::PanelInfo& band = garment.panels.panels[1];
  for (std::size_t v = 0; v < garment.panels.pattern.size(); ++v) {
    const Vec2 flat = garment.panels.pattern[v] + folding.shift[v];
    const bool of_band = static_cast<int>(v) >= band.first_vertex;
    garment.panels.placed[v] =
        Vec3(flat.x() - (of_band ? 0.04 : 0), flat.y() + (of_band ? 0.26 : 0), -folding.depth[v]);
  }
  return garment;
}

/// Hinges along the folds with bending stiffness and without, and others without.
struct Pressed {
  int stiff = 0, soft = 0, soft_elsewhere = 0;
};
Pressed count_pressed(const Garment& garment) {
  const cloth::ClothMesh mesh = cloth_mesh_of(garment);
  const auto folds = pattern::pleat_edges(garment.panels);
  Pressed count;
  for (const cloth::Hinge& h : mesh.hinges) { // particles are vertices while nothing is sewn
    const std::array<int, 2> edge{std::min(h.particle[0], h.particle[1]),
                                  std::max(h.particle[0], h.particle[1])};
    const bool on_fold = std::binary_search(folds.begin(), folds.end(), edge);
    count.stiff += on_fold && h.stiffness > 0;
    count.soft += on_fold && h.stiffness == 0;
    count.soft_elsewhere += !on_fold && h.stiffness == 0;
  }
  return count;
}

TEST(Pleats, CloseAlongTheirSeamsAndLieFoldedDownToTheHem) {
  Garment garment = pleated_piece();
  DrapeSettings settings;
  settings.gravity_m_s2 = 0;
  const DrapeReport report = drape(garment, nullptr, settings, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  for (const std::string& repair : report.repairs)
    EXPECT_EQ(repair.find("open"), std::string::npos) << repair;
  // The fold still lies on its target; sprung back to flat it would be 8 cm from it.
  const auto hem_at = [&](double x) {
    for (std::size_t v = 0; v < garment.panels.pattern.size(); ++v)
      if ((garment.panels.pattern[v] - Vec2(x, 0)).norm() < 1e-6)
        return garment.position[garment.particle_of[v]];
    ADD_FAILURE() << "no vertex of the hem at " << x;
    return Vec3(0, 0, 0);
  };
  EXPECT_LT((hem_at(0.02) - hem_at(-0.06)).norm(), 0.03);
}

TEST(Pleats, ArePressedUnlessTheSceneSaysHowFoldsLie) {
  Garment garment = pleated_piece();
  unsew(garment);
  Pressed pressed = count_pressed(garment);
  EXPECT_EQ(pressed.stiff, 0);
  EXPECT_GT(pressed.soft, 20);
  EXPECT_EQ(pressed.soft_elsewhere, 0);
  garment.scene.creases.push_back({});
  pressed = count_pressed(garment);
  EXPECT_EQ(pressed.soft, 0);
  EXPECT_GT(pressed.stiff, 20);
}

} // namespace
