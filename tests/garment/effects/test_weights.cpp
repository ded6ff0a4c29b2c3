/// Weights sewn to a garment.
#include <support/drape_scene.hpp>

#include <garment/scene/effects.hpp>
#include <garment/scene/scene_effects_json.hpp>
#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/json.hpp>

#include <numeric>

using namespace sloper;
using namespace sloper::garment;

namespace {

SceneEffects parsed(const std::string& text) {
  const io::Json json = io::parse_json(text, "scene");
  return read_scene_effects(io::Node(json, "scene"));
}

Garment hung_tube(const std::string& scene) {
  Garment g = make_skirt(0.8, 0.4, 0.05);
  unsew(g);
  weld(g, g.position);
  g.scene = parsed(scene);
  return g;
}

double mass_of(const cloth::ClothMesh& mesh) {
  return std::accumulate(mesh.mass.begin(), mesh.mass.end(), 0.0);
}

const char* const PINNED =
    R"("pins": [{"panel": "front", "from": [0, 1], "to": [1, 1], "stiffness_n_m": 1000},
                                      {"panel": "back", "from": [0, 1], "to": [1, 1], "stiffness_n_m": 1000}])";
const char* const WEIGHTED =
    R"("weights": [{"panel": "front", "from": [0, 0], "to": [1, 0], "mass_kg": 0.06}, {"panel": "back", "at": [0.5, 0], "mass_kg": 0.04}])";

/// What pins at the top of a tube carry at rest, N.
double carried(const std::string& scene) {
  Garment g = hung_tube(scene);
  const std::vector<Vec3> start = g.position;
  const DrapeReport report = drape(g, nullptr, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  double top = -1, force = 0;
  for (const Vec3& p : start)
    top = std::max(top, p.y());
  for (std::size_t i = 0; i < start.size(); ++i)
    if (start[i].y() > top - 1e-9)
      force += 1000 * (start[i].y() - g.position[i].y());
  return force;
}

} // namespace

TEST(Weights, add_their_mass_to_the_particles_of_their_run) {
  const Garment g = hung_tube(std::string("{") + WEIGHTED + "}");
  cloth::ClothMesh plain = cloth_mesh_of(g), weighted = plain;
  prepare_mesh(weighted, g, choose_effects(g, nullptr, {}));
  EXPECT_NEAR(mass_of(weighted) - mass_of(plain), 0.1, 1e-12);
  double heaviest = 0;
  for (std::size_t i = 0; i < plain.mass.size(); ++i)
    heaviest = std::max(heaviest, weighted.mass[i] - plain.mass[i]);
  EXPECT_NEAR(heaviest, 0.04, 1e-12) << "a point gets all of its weight";
  DrapeSettings off;
  off.effects = "auto,-weights";
  weighted = plain;
  prepare_mesh(weighted, g, choose_effects(g, nullptr, off));
  EXPECT_EQ(weighted.mass, plain.mass);
}

TEST(Weights, hang_from_what_the_cloth_hangs_from) {
  const double plain = carried(std::string("{") + PINNED + "}"),
               weighted = carried(std::string("{") + PINNED + ", " + WEIGHTED + "}");
  EXPECT_NEAR(weighted - plain, 0.1 * units::GRAVITY, 0.02 * 0.1 * units::GRAVITY);
}

TEST(Weights, are_read_and_written_and_refused_where_they_are_none) {
  const SceneEffects scene = parsed(std::string("{") + WEIGHTED + "}");
  ASSERT_EQ(scene.weights.size(), 2u);
  EXPECT_FALSE(scene.empty());
  EXPECT_EQ(scene_effects_json(parsed(scene_effects_json(scene).dump())),
            scene_effects_json(scene));
  EXPECT_THROW(parsed(R"({"weights": [{"panel": "front", "at": [0, 0], "mass_kg": -1}]})"), Error);
  EXPECT_THROW(parsed(R"({"weights": [{"panel": "front", "at": [0, 0], "mass": 1}]})"), Error);
}
