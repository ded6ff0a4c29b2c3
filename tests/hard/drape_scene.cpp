/// Whole drapes: sewing, repairs, coming to rest, audit and report, as the program does them.
#include <support/drape_scene.hpp>

#include "scene_tools.hpp"

#include <garment/simulate/audit.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/sewing.hpp>

#include <cmath>

namespace sloper::hard {

namespace {

using garment::Garment;

/// One panel nx by ny cells about the origin, `place` gives the start of pattern point (u, v).
template<class Place>
int add_panel(Garment& g, const std::string& name, double width, double height, int nx, int ny,
              Place place) {
  return garment::add_panel(
      g, name, nx, ny,
      [&](int c, int r) {
        return Vec2(width * (static_cast<double>(c) / nx - 0.5),
                    height * (static_cast<double>(r) / ny - 0.5));
      },
      place);
}

void sew(Garment& g, const std::string& name, std::vector<int> a, std::vector<int> b) {
  pattern::MeshSeam seam;
  seam.name = name;
  seam.kind = "seam";
  seam.a = std::move(a);
  seam.b = std::move(b);
  for (std::size_t k = 1; k < seam.a.size(); ++k) {
    seam.length_a += (g.panels.pattern[seam.a[k]] - g.panels.pattern[seam.a[k - 1]]).norm();
    seam.length_b += (g.panels.pattern[seam.b[k]] - g.panels.pattern[seam.b[k - 1]]).norm();
  }
  g.panels.seams.push_back(seam);
}

Garment make_garment(const Parameters& p) {
  const std::string kind = p.text("garment", "skirt");
  const double edge = p.number("edge_m", 0.03), girth = p.number("girth_m", 0.75),
               length = p.number("length_m", 0.3);
  const double top = p.number("top_m", 1.02), away = p.number("away_m", 0.25);
  if (kind == "skirt")
    return garment::make_skirt(girth, length, edge, top, away);
  Garment g;
  g.panels.name = kind;
  g.panels.edge_length = edge;
  const int n = std::max(1, static_cast<int>(std::lround(length / edge)));
  const Vec3 at(p.number("x_m", 0), top, p.number("z_m", 0));
  if (kind == "patch") { // one flat panel
    add_panel(g, "patch", length, length, n, n,
              [&](const Vec2& uv) { return Vec3(at + Vec3(uv.x(), 0, -uv.y())); });
  } else if (kind == "triangle") {
    add_panel(g, "triangle", length, length, 1, 1,
              [&](const Vec2& uv) { return Vec3(at + Vec3(uv.x(), 0, -uv.y())); });
    g.panels.triangles.resize(1);
    g.panels.panels[0].n_triangles = 1;
    g.panels.panels[0].n_vertices = 3;
    const Triangle t = g.panels.triangles[0]; // its corners alone
    pattern::PanelMesh& m = g.panels;
    m.pattern = {m.pattern[t[0]], m.pattern[t[1]], m.pattern[t[2]]};
    m.placed = {m.placed[t[0]], m.placed[t[1]], m.placed[t[2]]};
    m.ids = {m.ids[t[0]], m.ids[t[1]], m.ids[t[2]]};
    m.triangles = {{0, 1, 2}};
  } else if (kind == "crossed") { // two sheets through each other
    add_panel(g, "one", length, length, n, n,
              [&](const Vec2& uv) { return Vec3(at + Vec3(uv.x(), 0, -uv.y())); });
    const double tilt = p.number("tilt_deg", 15) * M_PI / 180;
    add_panel(g, "two", length, length, n, n, [&](const Vec2& uv) {
      return Vec3(at + Vec3(0.013 + uv.x() * std::cos(tilt),
                            uv.x() * std::sin(tilt) + p.number("second_up_m", 0.001),
                            -uv.y() + 0.007));
    });
  } else if (kind == "gather") { // a long edge sewn to a short one
    const double ease = p.number("ease", 1.5);
    add_panel(g, "short", length, 0.5 * length, n, std::max(1, n / 2),
              [&](const Vec2& uv) { return Vec3(at + Vec3(uv.x(), uv.y() + 0.5 * length, 0)); });
    add_panel(g, "long", ease * length, 0.5 * length, n, std::max(1, n / 2),
              [&](const Vec2& uv) { return Vec3(at + Vec3(uv.x(), uv.y() - 0.1 * length, 0)); });
    const int second = g.panels.panels[1].first_vertex, top_row = std::max(1, n / 2) * (n + 1);
    std::vector<int> a, b;
    for (int c = 0; c <= n; ++c) {
      a.push_back(c);
      b.push_back(second + top_row + c);
    }
    sew(g, "gathered", a, b);
    g.scene.pins.push_back({{"short", Vec2(0, 1), Vec2(1, 1)}, false, Vec3::Zero(), 1e4});
  } else if (kind == "pillow") { // two squares sewn all around
    for (int side = 0; side < 2; ++side)
      add_panel(g, side ? "back" : "front", length, length, n, n, [&](const Vec2& uv) {
        return Vec3(at + Vec3(side ? -uv.x() : uv.x(), uv.y(), side ? -0.02 : 0.02));
      });
    const int back = g.panels.panels[1].first_vertex;
    auto id = [&](int r, int c) { return r * (n + 1) + c; };
    std::vector<int> a, b;
    for (int c = 0; c < n; ++c) {
      a.push_back(id(0, c));
      b.push_back(back + id(0, n - c));
    }
    for (int r = 0; r < n; ++r) {
      a.push_back(id(r, n));
      b.push_back(back + id(r, 0));
    }
    for (int c = n; c > 0; --c) {
      a.push_back(id(n, c));
      b.push_back(back + id(n, n - c));
    }
    for (int r = n; r >= 0; --r) {
      a.push_back(id(r, 0));
      b.push_back(back + id(r, n));
    }
    sew(g, "rim", a, b);
  } else if (kind == "empty") {
    g.panels.panels.push_back({});
  } else {
    throw input_error("hard.bad-scene"_id, "", "garment", kind + " is no garment of these scenes");
  }
  return g;
}

/// Things that are wrong with the garment itself.
void spoil(Garment& g, const std::string& what) {
  pattern::PanelMesh& m = g.panels;
  if (what == "none" || m.triangles.empty())
    return;
  const Triangle some = m.triangles[std::min<std::size_t>(3, m.triangles.size() - 1)];
  if (what == "nan_position")
    m.placed[m.placed.size() / 2].x() = std::nan("");
  else if (what == "infinite_position")
    m.placed[m.placed.size() / 2].x() = INFINITY;
  else if (what == "nan_pattern")
    m.pattern[m.pattern.size() / 2].x() = std::nan("");
  else if (what == "zero_triangle")
    m.pattern[some[0]] = m.pattern[some[1]];
  else if (what == "duplicate_face")
    m.triangles.push_back(some);
  else if (what == "fin") { // a third triangle on an edge
    m.pattern.push_back(m.pattern[some[0]] + Vec2(0, 0.02));
    m.placed.push_back(m.placed[some[0]] + Vec3(0, 0, 0.02));
    m.ids.push_back(m.ids.back());
    m.triangles.push_back({some[0], some[1], static_cast<int>(m.pattern.size()) - 1});
  } else if (what == "lone_vertex") {
    m.pattern.push_back(Vec2(0, 0));
    m.placed.push_back(Vec3(0, 1, 0.3));
    m.ids.push_back(m.ids.back());
  } else if (what == "bad_index")
    m.triangles.back()[1] = static_cast<int>(m.pattern.size()) + 5;
  else if (what == "nan_material")
    g.materials[""].stretch_warp_n_m = std::nan("");
  else if (what == "zero_density")
    g.materials[""].density_kg_m2 = 0;
  else if (what == "inverted") // every panel seen from the other side
    for (Triangle& t : m.triangles)
      std::swap(t[1], t[2]);
  else if (what == "coincident_seams")
    for (const pattern::MeshSeam& s : m.seams)
      for (std::size_t k = 0; k < s.a.size(); ++k)
        m.placed[s.b[k]] = m.placed[s.a[k]];
  else if (what == "flat_together") // all panels in one plane, in one place
    for (std::size_t v = 0; v < m.placed.size(); ++v)
      m.placed[v].z() = m.placed[0].z();
  else
    throw input_error("hard.bad-scene"_id, "", "spoil", what + " is no fault of these scenes");
}

void measure(Outcome& out, const Garment& g, const garment::DrapeReport& report,
             const collision::BodyCollider* body) {
  out.said = stop_text(report);
  for (const std::string& r : report.repairs)
    out.said += "; " + r;
  out.exit = report.converged ? 0 : 4;
  const cloth::ClothMesh mesh = garment::cloth_mesh_of(g);
  measure_cloth(out, mesh, g.position);
  if (out.value["finite"] == 0)
    return;
  const garment::Audit a = garment::audit(g, body);
  out.value["through"] = static_cast<double>(a.through.size());
  out.value["inside"] = static_cast<double>(a.inside.size());
  out.value["self"] = static_cast<double>(a.self.size());
  out.value["deepest_m"] = a.deepest_m;
  out.value["converged"] = report.converged;
  out.value["honest"] = !report.converged || a.clean();
  out.value["steps"] = report.steps;
  double top = -1e9, turned = 0;
  for (const Vec3& q : g.position)
    top = std::max(top, q.y());
  for (const Triangle& t : g.particle_triangles())
    turned +=
        (g.position[t[1]] - g.position[t[0]]).cross(g.position[t[2]] - g.position[t[0]]).norm() <
        1e-9;
  out.value["top_m"] = top;
  out.value["collapsed_faces"] = turned;
}

} // namespace

Outcome drape_scene(const Parameters& p, std::uint64_t seed) {
  const std::string shape = p.text("body", "pillar");
  TriangleMesh skin = shape == "figure" ? garment::make_pillar(48, 40).skin : make_body_mesh(p);
  if (const double size = p.number("body_scale", 1); size != 1)
    for (Vec3& q : skin.positions)
      q *= size;
  const TriangleMesh whole = skin;
  damage(skin, p.text("damage", "none"), seed);
  body::Body body = make_body(skin);

  Garment g = make_garment(p);
  garment::Material material = garment::material_preset(p.text("material", "cotton-poplin"));
  material.stretch_warp_n_m *= p.number("stretch_times", 1);
  material.stretch_weft_n_m *= p.number("stretch_times", 1) * p.number("weft_times", 1);
  material.bend_n_m = p.number("bend_n_m", material.bend_n_m);
  material.friction_body = p.number("friction", material.friction_body);
  material.damping_s = p.number("damping_s", material.damping_s);
  material.density_kg_m2 *= p.number("density_times", 1);
  g.materials[""] = material;
  if (const double unit = p.number("garment_scale", 1); unit != 1)
    for (std::size_t v = 0; v < g.panels.pattern.size(); ++v) {
      g.panels.pattern[v] *= unit;
      g.panels.placed[v] *= unit;
    }
  jitter(g.panels.placed, p.number("jitter_m", 1e-4), seed);
  spoil(g, p.text("spoil", "none"));
  g.scene.membrane = p.text("membrane", "");
  g.scene.bending = p.text("bending", "");
  if (const double wind = p.number("wind_m_s", 0); wind != 0) {
    g.scene.air = true;
    g.scene.wind_m_s = Vec3(0.3 * wind, 0, wind);
  }
  g.scene.pressure_pa = p.number("pressure_pa", 0);
  if (const double ratio = p.number("band_ratio", 0); ratio > 0)
    for (const pattern::PanelInfo& panel : g.panels.panels)
      g.scene.bands.push_back(
          {{panel.name, Vec2(0, 1), Vec2(1, 1)}, ratio, p.number("band_n", 30)});
  if (const double shrink = p.number("shrink", 1); shrink != 1)
    g.scene.shrink.push_back({"", shrink, shrink, Vec2(0, 0.3), Vec2(1, 0.6)});
  if (const double crease = p.number("crease_deg", 0); crease != 0)
    g.scene.creases.push_back(
        {{g.panels.panels[0].name, Vec2(0, 0.5), Vec2(1, 0.5)}, crease * M_PI / 180});

  garment::DrapeSettings settings = garment::preset_settings(p.text("accuracy", "draft"));
  settings.time_step_s = p.number("h", settings.time_step_s);
  settings.cg_tolerance = p.number("cg_tolerance", settings.cg_tolerance);
  settings.cg_max_iterations = p.whole("cg_max_iterations", settings.cg_max_iterations);
  settings.contact_gap_m = p.number("contact_gap_m", settings.contact_gap_m);
  settings.self_thickness_m = p.number("thickness_m", settings.self_thickness_m);
  settings.settle_force_ratio = p.number("settle_force_ratio", settings.settle_force_ratio);
  settings.settle_speed_m_s = p.number("settle_speed_m_s", settings.settle_speed_m_s);
  settings.gravity_m_s2 = p.number("gravity_m_s2", settings.gravity_m_s2);
  if (const int limit = p.whole("max_steps", 0); limit > 0)
    garment::set_knob(settings, "max_steps", limit);
  settings.effects = p.text("effects", "auto");

  const body::Body* on = skin.triangles.empty() && shape == "none" ? nullptr : &body;
  garment::DrapeReport report = garment::drape(g, on, settings, silent_reporter());
  Outcome out;
  const double edit = p.number("edit_times", 1);
  const double first_steps = report.steps;
  if (edit != 1) { // at rest: a quarter of the garment's edges get another rest length, all at once
    g.rest_scale.assign(g.panels.triangles.size(), {1, 1, 1});
    for (std::size_t f = 0; f < g.panels.triangles.size(); ++f) {
      const double t = g.panels.ids[g.panels.triangles[f][0]].t;
      if (t > 0.3 && t < 0.55)
        g.rest_scale[f] = {edit, edit, edit};
    }
    report = garment::drape(g, on, settings, silent_reporter());
  }
  collision::BodyCollider truth;
  if (on)
    truth = collision::BodyCollider(whole);
  measure(out, g, report, on ? &truth : nullptr);
  const std::string damage_kind = p.text("damage", "none");
  if (on && (damage_kind == "noise" ||
             damage_kind == "holes")) { // of skin that is off by noise or gone the drape can claim
                                        // nothing but what it was given
    const collision::BodyCollider given(skin);
    out.value["honest"] = !report.converged || garment::audit(g, &given).clean();
  }
  out.value["resettle"] = report.steps / std::max(first_steps, 1.0);
  fingerprint(out, g.position);
  return out;
}

} // namespace sloper::hard
