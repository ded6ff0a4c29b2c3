/// What a scene may ask for: found in scene.json, given a reason, placed on the right particles,
/// kept with the garment.
#include <support/drape_scene.hpp>
#include <support/scratch_folder.hpp>

#include <garment/scene/effects.hpp>
#include <garment/scene/panel_runs.hpp>
#include <garment/scene/scene_effects_json.hpp>
#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/cloth/forces/elastic_band.hpp>
#include <sloper/cloth/forces/pins.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/material_json.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// The skirt with outlines, unsewn or sewn.
Garment skirt(bool sewn) {
  Garment g = make_skirt(0.8, 0.4, 0.05);
  for (pattern::PanelInfo& p : g.panels.panels) {
    std::vector<int> bottom, top, left, right;
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v) {
      const auto& id = g.panels.ids[v];
      if (id.t == 0)
        bottom.push_back(v);
      else if (id.t == 1)
        top.push_back(v);
      else if (id.s == 0)
        left.push_back(v);
      else if (id.s == 1)
        right.push_back(v);
    }
    p.outline = bottom;
    p.outline.insert(p.outline.end(), right.begin(), right.end());
    p.outline.insert(p.outline.end(), top.rbegin(), top.rend());
    p.outline.insert(p.outline.end(), left.rbegin(), left.rend());
  }
  unsew(g);
  if (sewn) {
    std::vector<Vec3> x = g.panels.placed;
    weld(g, x);
  }
  return g;
}

bool active(const std::vector<EffectReport>& effects, const std::string& name) {
  return is_active(effects, name);
}
const std::string& why(const std::vector<EffectReport>& effects, const std::string& name) {
  for (const EffectReport& e : effects)
    if (e.name == name)
      return e.why;
  throw std::runtime_error(name);
}

SceneEffects parsed(const std::string& text) {
  const io::Json json = io::parse_json(text, "scene.json");
  return read_scene_effects(io::Node(json, "scene.json"));
}

const char* const FULL = R"({"membrane": "triangles", "bending": "dihedral",
  "pins": [{"panel": "front", "at": [0, 1]}, {"panel": "back", "from": [0, 1], "to": [1, 1], "target_m": [0, 1, 0], "stiffness_n_m": 500}],
  "bands": [{"panel": "front", "from": [0, 1], "to": [1, 1], "ratio": 0.8, "strength_n": 40}],
  "attachments": [{"panel": "front", "at": [0.5, 1], "landmark": "neck_center", "rest_length_m": 0.1, "stiffness_n_m": 30}],
  "shrink": [{"panel": "front", "from": [0, 0.8], "to": [1, 1], "weft": 0.9}],
  "creases": [{"panel": "front", "from": [0.5, 0], "to": [0.5, 1], "angle_deg": 90}],
  "wind_m_s": [0, 0, -3], "pressure_pa": 5})";

/// What a scene adds, and the models that it chooses.
void add_scene(cloth::ClothSolver& solver, const cloth::ClothMesh& mesh, const Garment& garment,
               const body::Body* body, const std::vector<EffectReport>& effects, bool open_seams) {
  const DrapeSettings settings;
  EffectHandles handles;
  EffectBuild build{.solver = solver,
                    .mesh = mesh,
                    .garment = garment,
                    .body = body,
                    .settings = settings,
                    .collider = nullptr,
                    .open_seams = open_seams,
                    .handles = handles};
  add_effects(EffectStage::MODEL, build, effects);
  add_effects(EffectStage::SCENE, build, effects);
}

} // namespace

TEST(SceneEffects, are_read_and_written_without_loss) {
  const SceneEffects scene = parsed(FULL);
  const std::string once = io::to_text(scene_effects_json(scene));
  EXPECT_EQ(io::to_text(scene_effects_json(parsed(once))), once);
  EXPECT_EQ(scene.bands.at(0).strength_n, 40);
  EXPECT_NEAR(scene.creases.at(0).angle_rad, M_PI / 2, 1e-12);
  EXPECT_TRUE(parsed("{}").empty());
}

TEST(SceneEffects, wrong_keys_and_values_are_refused_with_their_place) {
  for (const char* text :
       {R"({"membrane": "rubber"})",
        R"({"pins": [{"panel": "front", "at": [0, 1], "stifness_n_m": 3}]})",
        R"({"bands": [{"panel": "front", "from": [0, 1], "to": [1, 1], "ratio": -1}]})",
        R"({"pins": {"panel": "front"}})", R"({"attachments": [{"panel": "front", "at": [0, 1]}]})",
        R"({"wind_m_s": [0, 0, 1e5]})"}) {
    try {
      parsed(text);
      FAIL() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::INPUT) << text;
      EXPECT_NE(std::string(e.what()).find("scene.json"), std::string::npos) << e.what();
    }
  }
}

TEST(SceneEffects, travel_with_the_garment_document) {
  const test::ScratchFolder folder;
  Garment g = skirt(true);
  g.scene = parsed(FULL);
  write_garment((folder / "skirt.json"), g, "test");
  EXPECT_EQ(io::to_text(scene_effects_json(read_garment((folder / "skirt.json")).scene)),
            io::to_text(scene_effects_json(g.scene)));
}

TEST(SceneEffects, a_run_follows_the_outline_the_shorter_way_or_the_mesh) {
  const Garment g = skirt(false);
  const auto top = run_vertices(g, {"front", Vec2(0, 1), Vec2(1, 1)});
  ASSERT_EQ(top.size(), 9u);
  for (int v : top)
    EXPECT_EQ(g.panels.ids[v].t, 1);
  const auto middle = run_vertices(g, {"back", Vec2(0.5, 0.25), Vec2(0.5, 0.75)});
  for (int v : middle)
    EXPECT_EQ(g.panels.ids[v].panel, 1);
  EXPECT_EQ(middle.size(), 5u);
  EXPECT_EQ(run_vertices(g, {"front", Vec2(0.5, 1), Vec2(0.5, 1)}).size(), 1u);
  EXPECT_THROW(run_vertices(g, {"frnt", Vec2(0, 0), Vec2(0, 0)}), Error);
}

TEST(SceneEffects, auto_finds_the_reason_for_each) {
  Garment g = skirt(true);
  auto effects = choose_effects(g, nullptr, {});
  for (const char* off : {"triangle_stretch", "membrane", "dihedral_bending", "pins", "attachments",
                          "elastic_bands", "wind", "pressure"}) {
    EXPECT_FALSE(active(effects, off)) << off;
    EXPECT_FALSE(why(effects, off).empty()) << off;
  }
  EXPECT_TRUE(active(effects, "edge_springs"));
  g.scene = parsed(FULL);
  effects = choose_effects(g, nullptr, {});
  for (const char* on : {"triangle_stretch", "dihedral_bending", "pins", "attachments",
                         "elastic_bands", "wind", "pressure"})
    EXPECT_TRUE(active(effects, on)) << on;
  for (const char* off : {"edge_springs", "bending", "membrane"})
    EXPECT_FALSE(active(effects, off)) << off;
  for (const EffectReport& e : effects)
    EXPECT_FALSE(e.why.empty()) << e.name;
}

TEST(SceneEffects, a_list_may_change_what_auto_finds) {
  const Garment g = skirt(true);
  DrapeSettings settings;
  settings.effects = "auto,membrane,-self_contact";
  const auto effects = choose_effects(g, nullptr, settings);
  EXPECT_TRUE(active(effects, "membrane") && active(effects, "bending") &&
              active(effects, "gravity"));
  EXPECT_FALSE(active(effects, "edge_springs") || active(effects, "shear") ||
               active(effects, "self_contact"));
  EXPECT_EQ(why(effects, "edge_springs"), "membrane takes its place");
  settings.effects = "edge_springs,membrane";
  EXPECT_THROW(choose_effects(g, nullptr, settings), Error);
  settings.effects = "auto,wnd";
  EXPECT_THROW(choose_effects(g, nullptr, settings), Error);
}

TEST(SceneEffects, are_built_when_active_and_only_then) {
  Garment g = skirt(true);
  g.scene = parsed(FULL);
  body::Body body;
  body.landmarks["neck_center"].p = Vec3(0, 1.4, 0);
  const cloth::ClothMesh mesh = cloth_mesh_of(g);
  auto names = [&](const std::string& list, bool sewing) {
    DrapeSettings settings;
    settings.effects = list;
    cloth::ClothSolver solver(mesh, g.position);
    add_scene(solver, mesh, g, &body, choose_effects(g, &body, settings), sewing);
    std::string out;
    for (const auto& e : solver.effects())
      out += std::string(e->name()) + " ";
    return out;
  };
  EXPECT_EQ(names("auto", false),
            "triangle_stretch dihedral_bending pins attachments elastic_bands wind pressure ");
  EXPECT_EQ(names("auto", true), "triangle_stretch dihedral_bending pins ");
  EXPECT_EQ(names("gravity", false), "");
  Garment plain = skirt(true);
  cloth::ClothSolver solver(mesh, g.position);
  add_scene(solver, mesh, plain, nullptr, choose_effects(plain, nullptr, {}), false);
  EXPECT_TRUE(solver.effects().empty());
}

TEST(SceneEffects, a_band_of_two_panels_is_one_ring_over_welded_seams) {
  Garment g = skirt(true);
  g.scene = parsed(
      R"({"bands": [{"panel": "front", "from": [0, 1], "to": [1, 1], "ratio": 0.8, "strength_n": 40},
                                {"panel": "back", "from": [0, 1], "to": [1, 1], "ratio": 0.8, "strength_n": 40}]})");
  const cloth::ClothMesh mesh = cloth_mesh_of(g);
  cloth::ClothSolver solver(mesh, g.position);
  add_scene(solver, mesh, g, nullptr, choose_effects(g, nullptr, {}), false);
  const auto& band = dynamic_cast<const cloth::ElasticBandEffect&>(*solver.effects().at(0));
  std::map<int, int> links_at;
  double length = 0;
  for (const cloth::BandLink& l : band.links()) {
    ++links_at[l.i];
    ++links_at[l.j];
    length += l.rest_length;
  }
  for (const auto& [particle, n] : links_at)
    EXPECT_EQ(n, 2) << particle;
  EXPECT_NEAR(length, 0.8 * 0.8, 1e-9);
}

TEST(SceneEffects, an_elastic_waistband_draws_the_skirt_in_to_the_balance_of_band_and_cloth) {
  Garment g = skirt(true);
  g.materials[""] = material_preset("cotton-poplin");
  g.scene = parsed(
      R"({"membrane": "fem", "bands": [{"panel": "front", "from": [0, 1], "to": [1, 1], "ratio": 0.5, "strength_n": 40},
                                {"panel": "back", "from": [0, 1], "to": [1, 1], "ratio": 0.5, "strength_n": 40}]})");
  const cloth::ClothMesh mesh = cloth_mesh_of(g);
  cloth::ClothSolver solver(mesh, g.position);
  add_scene(solver, mesh, g, nullptr, choose_effects(g, nullptr, {}), false);
  const auto& band = dynamic_cast<const cloth::ElasticBandEffect&>(*solver.effects().back());
  auto girth = [&] {
    double sum = 0;
    for (const cloth::BandLink& l : band.links())
      sum += (solver.x()[l.j] - solver.x()[l.i]).norm();
    return sum;
  };
  cloth::StepOptions options;
  options.h = 0.1;
  options.cg_tolerance = 1e-4;
  for (int k = 0; k < 150; ++k)
    solver.step(options);
  EXPECT_LT(girth(), 0.75 * 0.8)
      << "cloth without bending gathers under the band"; // rest girth of the cloth 0.8, of the band
                                                         // 0.4
  EXPECT_GT(girth(), 0.39);
}

TEST(SceneEffects, a_drape_runs_what_the_scene_asks_for_and_reports_it) {
  auto hem = [&](const char* text, DrapeReport& report) {
    Garment g = skirt(true); // sewn, held along its upper edge, no body
    g.scene = parsed(text);
    g.scene.pins.push_back({{"front", Vec2(0, 1), Vec2(1, 1)}});
    g.scene.pins.push_back({{"back", Vec2(0, 1), Vec2(1, 1)}});
    report = drape(g, nullptr, {}, silent_reporter());
    Vec3 sum = Vec3::Zero();
    int n = 0;
    for (std::size_t v = 0; v < g.panels.ids.size(); ++v)
      if (g.panels.ids[v].t == 0) {
        sum += g.position[g.particle_of[v]];
        ++n;
      }
    return Vec3(sum / n);
  };
  DrapeReport still, blown;
  const Vec3 before = hem(R"({})", still);
  const Vec3 after = hem(
      R"({"membrane": "fem", "wind_m_s": [0, 0, 6], "bands": [{"panel": "front", "from": [0, 1], "to": [1, 1]}]})",
      blown);
  EXPECT_GT(after.z(), before.z() + 0.02) << "the wind blows the hem along +z";
  auto calls = [](const DrapeReport& report, const std::string& name) {
    for (const EffectReport& e : report.effects)
      if (e.name == name)
        return e.calls;
    return -1L;
  };
  for (const char* name : {"membrane", "wind", "elastic_bands"}) {
    EXPECT_EQ(calls(still, name), 0) << name;
    EXPECT_GT(calls(blown, name), 0) << name;
  }
  EXPECT_EQ(calls(blown, "edge_springs"), 0);
  EXPECT_GT(calls(still, "edge_springs"), 0);
  EXPECT_GT(calls(still, "pins"), 0);
}

TEST(Materials, table1_is_the_paper_s_table_as_printed) {
  const Material& m = material_preset("table1");
  EXPECT_NEAR(m.density_kg_m2, 0.1 * 10, 1e-12);          // 0.1 g/cm2
  EXPECT_NEAR(m.stretch_warp_n_m, 1e6 * 0.980665, 1e-6);  // 1e6 gf/cm
  EXPECT_NEAR(m.shear_n_m, 1e5 * 0.980665, 1e-6);         // 1e5 gf/cm
  EXPECT_NEAR(m.bend_n_m, 0.01 * 0.980665 * 1e-4, 1e-15); // 0.01 gf cm2/cm
}

TEST(Materials, every_panel_may_have_its_own_and_every_preset_names_its_source) {
  Garment g = skirt(true);
  g.panels.panels[0].material = "denim";
  g.panels.panels[1].material = "silk";
  const cloth::ClothMesh mesh = cloth_mesh_of(g);
  EXPECT_EQ(mesh.fabrics[mesh.triangles.front().fabric].density_kg_m2,
            material_preset("denim").density_kg_m2);
  EXPECT_EQ(mesh.fabrics[mesh.triangles.back().fabric].density_kg_m2,
            material_preset("silk").density_kg_m2);
  for (const Material& m : material_presets())
    EXPECT_FALSE(m.source.empty()) << m.name;
}
