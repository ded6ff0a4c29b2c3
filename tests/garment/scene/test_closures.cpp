/// Buttons, zips and roll lines.
#include <support/force_checks.hpp>
#include <support/hung_sheet.hpp>
#include <support/scratch_folder.hpp>

#include <garment/scene/crease_angles.hpp>
#include <garment/scene/scene_effects_json.hpp>
#include <gtest/gtest.h>
#include <sloper/cloth/forces/closures.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

SceneEffects parsed(const std::string& text) {
  const io::Json json = io::parse_json(text, "scene.json");
  return read_scene_effects(io::Node(json, "scene.json"));
}

const EffectReport& effect(const DrapeReport& report, const std::string& name) {
  for (const EffectReport& e : report.effects)
    if (e.name == name)
      return e;
  throw std::runtime_error(name);
}

} // namespace

TEST(Closures, force_is_minus_energy_gradient_within_reach_and_beyond) {
  const cloth::Grid g = cloth::make_grid(3, 0.1);
  cloth::ClosuresEffect near({{0, 4, 0.068, 500}, {1, 5, 0.066, 800}}), far({{0, 8, 0.02, 500}}),
      slack({{0, 4, 0.2, 500}});
  const auto x = cloth::jittered(g.x, 0.001, 3);
  cloth::expect_gradient(near, g.mesh, x);
  cloth::expect_gradient(far, g.mesh, x);
  cloth::expect_rigid_motion_invariance(near, g.mesh, x);
  cloth::expect_jacobian(near, g.mesh, x, 1e-5);
  EXPECT_EQ(slack.energy(x), 0) << "it pushed";
}

TEST(Closures, are_read_written_and_refused_where_they_mean_nothing) {
  const SceneEffects scene = parsed(
      R"({"closures": [{"panel": "a", "from": [0, 0], "to": [0, 1], "count": 7, "with": {"panel": "b", "from": [1, 0], "to": [1, 1]}},
                       {"kind": "zip", "panel": "a", "from": [0, 0], "to": [1, 0], "with": {"panel": "b", "from": [0, 0], "to": [1, 0]}}],
          "roll_lines": [{"panel": "collar", "from": [0, 0.5], "to": [1, 0.5]}]})");
  ASSERT_EQ(scene.closures.size(), 2u);
  EXPECT_EQ(scene.closures[0].count, 7);
  EXPECT_EQ(scene.closures[0].with.panel, "b");
  EXPECT_EQ(scene.closures[1].count, 0);
  ASSERT_EQ(scene.creases.size(), 1u);
  EXPECT_NEAR(scene.creases[0].angle_rad, -165 * M_PI / 180, 1e-12);
  const io::Json out = scene_effects_json(scene);
  const SceneEffects again = read_scene_effects(io::Node(out, "again"));
  EXPECT_EQ(scene_effects_json(again), out);
  EXPECT_THROW(parsed(R"({"closures": [{"panel": "a", "from": [0, 0], "to": [0, 1]}]})"), Error);
  EXPECT_THROW(
      parsed(
          R"({"closures": [{"kind": "zip", "count": 3, "panel": "a", "from": [0, 0], "to": [0, 1], "with": {"panel": "b", "from": [0, 0], "to": [0, 1]}}]})"),
      Error);
}

TEST(Scene, what_it_says_of_weights_and_closures_reaches_the_garment) {
  // Weights of a scene file were read and never applied.
  const test::ScratchFolder folder;
  io::write_file(
      folder / "scene.json",
      R"({"format": "scene", "version": 1, "weights": [{"panel": "sheet", "from": [0, 0], "to": [1, 0], "mass_kg": 0.05}],
          "closures": [{"panel": "sheet", "from": [0, 0], "to": [0, 1], "with": {"panel": "sheet", "from": [1, 0], "to": [1, 1]}}]})");
  Garment g = hung_sheet(4, 4, 0.05);
  apply_scene(read_scene(folder / "scene.json"), g);
  EXPECT_EQ(g.scene.weights.size(), 1u);
  EXPECT_EQ(g.scene.closures.size(), 1u);
}

TEST(Scene, interfacing_of_no_panel_is_refused) {
  // It was taken, and the cloth was draped without it.
  const test::ScratchFolder folder;
  io::write_file(folder / "scene.json", R"({"format": "scene", "version": 1,
          "interfacing": [{"panels": [], "material": "fusible"}]})");
  try {
    read_scene(folder / "scene.json");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_EQ(e.place(), "/interfacing/0/panels");
  }
}

TEST(Scene, a_panel_that_the_garment_lacks_is_named_with_file_and_place) {
  // The message had neither, and for closures it came after sewing.
  const std::string line = R"("from": [0, 0], "to": [1, 0])",
                    there = R"("panel": "sheet", )" + line, wrong = R"("panel": "sheat", )" + line;
  for (const auto& [text, place] : std::vector<std::pair<std::string, std::string>>{
           {R"("closures": [{)" + wrong + R"(, "with": {)" + there + "}}]", "/closures/0/panel"},
           {R"("closures": [{)" + there + R"(, "with": {)" + wrong + "}}]",
            "/closures/0/with/panel"},
           {R"("closures": [{"kind": "zip", )" + wrong + R"(, "with": {)" + there + "}}]",
            "/closures/0/panel"},
           {R"("roll_lines": [{)" + there + "}, {" + wrong + "}]", "/roll_lines/1/panel"},
           {R"("creases": [{)" + wrong + R"(, "angle_deg": 90}])", "/creases/0/panel"},
           {R"("weights": [{)" + wrong + "}]", "/weights/0/panel"},
           {R"("shrink": [{)" + wrong + "}]", "/shrink/0/panel"},
           {R"("pins": [{)" + wrong + "}]", "/pins/0/panel"},
           {R"("bands": [{)" + wrong + "}]", "/bands/0/panel"},
           {R"("attachments": [{)" + wrong + R"(, "anchor_m": [0, 1, 0]}])",
            "/attachments/0/panel"},
           {R"("interfacing": [{"panels": ["sheet", "sheat"], "material": "fusible"}])",
            "/interfacing/0/panels/1"}}) {
    const test::ScratchFolder folder;
    io::write_file(folder / "scene.json", R"({"format": "scene", "version": 1, )" + text + "}");
    Garment g = hung_sheet(4, 4, 0.05);
    try {
      apply_scene(read_scene(folder / "scene.json"), g);
      FAIL() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.file(), folder / "scene.json");
      EXPECT_EQ(e.place(), place);
      EXPECT_NE(e.fact().find("did you mean 'sheet'"), std::string::npos) << e.what();
      EXPECT_EQ(e.next_step(), "panels are sheet");
    }
  }
}

TEST(Scene, a_material_that_no_panel_is_of_is_told) {
  // Such a garment was draped of the default, in silence.
  const test::ScratchFolder folder;
  io::write_file(
      folder / "scene.json",
      R"({"format": "scene", "version": 1, "materials": {"default": "denim", "cottn": "silk"}})");
  const Scene scene = read_scene(folder / "scene.json");
  Garment g = hung_sheet(4, 4, 0.05);
  const std::vector<Message> none = unused_materials(scene, "scene.json", g);
  ASSERT_EQ(none.size(), 1u);
  EXPECT_NE(none[0].text.find("/materials/cottn: no panel is of this material; panels name none"),
            std::string::npos)
      << none[0].text;
  g.panels.panels[0].material = "cotton";
  const std::vector<Message> near = unused_materials(scene, "scene.json", g);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_NE(near[0].text.find("did you mean 'cotton'"), std::string::npos) << near[0].text;
  g.panels.panels[0].material = "cottn";
  EXPECT_TRUE(unused_materials(scene, "scene.json", g).empty());
}

TEST(Scene, a_place_beyond_its_panel_is_refused) {
  // It was moved to the panel's corner in silence.
  for (const char* text : {R"({"pins": [{"panel": "a", "at": [0.5, 100]}]})",
                           R"({"creases": [{"panel": "a", "from": [-0.2, 0], "to": [1, 1]}]})",
                           R"({"shrink": [{"panel": "a", "to": [1, 2]}]})"})
    EXPECT_THROW(parsed(text), Error) << text;
  EXPECT_NO_THROW(parsed(R"({"pins": [{"panel": "a", "at": [1, 0]}]})"));
}

TEST(Closures, buttons_close_a_sheet_to_a_tube_and_cost_nothing_where_there_are_none) {
  Garment open = hung_sheet(12, 10, 0.02);
  open.scene.pins.push_back({{"sheet", Vec2(0.5, 1), Vec2(0.5, 1)}, false, Vec3::Zero(), 1e4});
  Garment closed = open;
  closed.scene.closures.push_back(
      {{"sheet", Vec2(0, 0), Vec2(0, 1)}, {"sheet", Vec2(1, 0), Vec2(1, 1)}, 4, 2000});
  const DrapeSettings settings = preset_settings("draft");
  const DrapeReport without = drape(open, nullptr, settings, silent_reporter()),
                    with = drape(closed, nullptr, settings, silent_reporter());
  EXPECT_FALSE(effect(without, "closures").active);
  EXPECT_EQ(effect(without, "closures").calls, 0);
  EXPECT_GT(effect(with, "closures").calls, 0);
  for (int row : {0, 10}) { // the outermost buttons
    const Vec3 &a = closed.position[closed.particle_of[row * 13]],
               &b = closed.position[closed.particle_of[row * 13 + 12]];
    EXPECT_LT((a - b).norm(), 2 * settings.self_thickness_m + 0.002) << "row " << row;
  }
  EXPECT_TRUE(with.converged);
}

TEST(Crease, goes_through_the_panel_from_edge_to_edge_and_is_refused_where_nothing_folds) {
  // A line whose ends both lie on the outline followed it, where there is no hinge.
  Garment g = hung_sheet(4, 4, 0.05);
  g.scene.creases = {{{"sheet", Vec2(0.5, 0), Vec2(0.5, 1)}, 2.0, 1}};
  g.particle_of.resize(25);
  for (int v = 0; v < 25; ++v)
    g.particle_of[v] = v;
  g.position = g.panels.placed;
  const cloth::ClothMesh mesh = cloth_mesh_of(g);
  const std::vector<double> angles = crease_angles(mesh, g, false);
  EXPECT_EQ(std::count_if(angles.begin(), angles.end(), [](double a) { return a != 0; }), 4);
  g.scene.creases[0].run = {"sheet", Vec2(0, 1), Vec2(1, 1)};
  EXPECT_THROW(crease_angles(mesh, g, false), Error);
}

TEST(RollLine, folds_a_standing_collar_over) {
  // A strip of 6 cm stands on its seam; its roll line runs 2 cm above that.
  for (const char* cloth : {"cotton-poplin", "cotton-poplin-orthotropic"}) {
    Garment collar = hung_sheet(24, 6, 0.01, 0.0005);
    collar.materials[""] = material_preset(cloth);
    for (double t : {0.0, 1.0 / 6})
      collar.scene.pins.push_back({{"sheet", Vec2(0, t), Vec2(1, t)}, false, Vec3::Zero(), 1e4});
    const auto roll = parsed(
        R"({"roll_lines": [{"panel": "sheet", "from": [0, 0.33333333], "to": [1, 0.33333333]}]})");
    collar.scene.creases = roll.creases;
    const DrapeReport report = drape(collar, nullptr, preset_settings("draft"), silent_reporter());
    double top = 0, front = 0;
    for (int c = 0; c <= 24; ++c) {
      const Vec3& p = collar.position[collar.particle_of[6 * 25 + c]];
      top += p.y() / 25;
      front += p.z() / 25;
    }
    EXPECT_TRUE(report.converged) << cloth;
    EXPECT_LT(top, 1.02 - 0.02) << cloth << ": the fall does not lie below the roll line";
    EXPECT_GT(front, 0) << cloth << ": it does not fold to the outside";
  }
}
