/// Panels draped through a coarse mesh: how cloth is sewn there so that starts that differ a little
/// end alike, and how it comes to the given mesh.
#include <garment/levels/coarse_start.hpp>
#include <garment/levels/drape_levels.hpp>
#include <garment/levels/finer_mesh.hpp>
#include <garment/levels/soft_sewing.hpp>
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <measures.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/garment/body_model/collision_body.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/materials.hpp>
#include <sloper/garment/redrape/spread.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/garment/sewing.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/garment/simulate/temporary_supports.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <support/drape_scene.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <unistd.h>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// Two pieces, 40 x 30 cm or narrower, sewn at their sides: one of them with a curved hem.
/// @param half  of their width, cm
pattern::PanelMesh two_pieces(double edge, double half = 20) {
  std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "two", "panels": [
    {"name": "front", "outline": [{"edge": "hem", "path": [["M", -HALF, 0], ["Q", 0, -6, HALF, 0]]}, {"edge": "left", "path": [["L", HALF, 30]]},
      {"edge": "top", "path": [["L", -HALF, 30]]}, {"edge": "right", "path": [["L", -HALF, 0]]}]},
    {"name": "back", "outline": [{"edge": "hem", "path": [["M", -HALF, 0], ["L", HALF, 0]]}, {"edge": "left", "path": [["L", HALF, 30]]},
      {"edge": "top", "path": [["L", -HALF, 30]]}, {"edge": "right", "path": [["L", -HALF, 0]]}]}],
    "seams": [{"name": "left", "a": [{"panel": "front", "edge": "left"}], "b": [{"panel": "back", "edge": "right"}]},
              {"name": "right", "a": [{"panel": "front", "edge": "right"}], "b": [{"panel": "back", "edge": "left"}]}]})";
  for (std::size_t at; (at = text.find("HALF")) != std::string::npos;)
    text.replace(at, 4, std::to_string(half));
  const pattern::Pattern source = pattern::read_pattern_json(io::parse_json(text, "two"), "two");
  pattern::PanelMesh mesh = pattern::mesh_pattern(source, edge, "two");
  mesh.source = std::make_shared<pattern::Pattern>(source);
  for (const pattern::PanelInfo& panel : mesh.panels)
    for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
      const Vec2& p = mesh.pattern[v];
      const bool front = panel.name == "front";
      mesh.placed[v] = Vec3(front ? p.x() : -p.x(), 0.7 + p.y(), front ? 0.25 : -0.25);
    }
  return mesh;
}

/// A shirt drafted for a figure, placed around it on the coarse mesh.
struct PlacedShirt {
  body::Body body;
  Garment garment;

  explicit PlacedShirt(const samples::Mannequin& figure) {
    const samples::MadeMannequin made = samples::make_mannequin(figure);
    body = body::measure_scan(made.mesh, "figure", "", {}, silent_reporter()).body;
    samples::Draft draft = samples::draft_shirt(samples::measures_from_body(made.truth, "figure"));
    draft.remove("collar");
    const pattern::Pattern source =
        pattern::read_pattern_json(samples::pattern_document(draft), "shirt");
    garment.panels = pattern::mesh_pattern(source, 0.048, "shirt");
    pattern::place_panels(source, body, garment.panels);
  }
  /// m, the mean over the stitches by which sleeves close on themselves.
  double sleeve_gap() const {
    double sum = 0;
    int n = 0;
    for (const pattern::MeshSeam& seam : garment.panels.seams)
      for (std::size_t k = 0; k < seam.a.size(); ++k) {
        if (seam.name.find("under_front") == std::string::npos)
          continue;
        sum += (garment.panels.placed[seam.a[k]] - garment.panels.placed[seam.b[k]]).norm();
        ++n;
      }
    return n ? sum / n : 1e300;
  }
};

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

} // namespace

TEST(FinerMesh, interpolation_keeps_flat_panels_also_beyond_the_coarse_outline) {
  const pattern::PanelMesh coarse = two_pieces(0.06), fine = two_pieces(0.015);
  EXPECT_LT(largest_difference(interpolate(coarse, coarse.placed, fine), fine.placed), 1e-12);
}

TEST(FinerMesh, a_mesh_interpolated_to_itself_is_the_same) {
  const pattern::PanelMesh mesh = two_pieces(0.03);
  EXPECT_LT(largest_difference(interpolate(mesh, mesh.placed, mesh), mesh.placed), 1e-12);
}

TEST(FinerMesh, another_mesh_takes_over_what_only_the_given_one_knows) {
  pattern::PanelMesh given = two_pieces(0.06);
  given.body_sha256 = "skin";
  given.panels[1].material = "interfaced";
  given.panels[1].layer = 2;
  given.panels[1].part = "torso";
  pattern::PanelMesh mesh = two_pieces(0.03);
  take_over(given, mesh);
  EXPECT_EQ(mesh.body_sha256, "skin");
  EXPECT_EQ(mesh.panels[1].material, "interfaced") << "coarse cloth was as soft as without";
  EXPECT_EQ(mesh.panels[1].layer, 2);
  EXPECT_EQ(mesh.panels[1].part, "torso");
  EXPECT_EQ(mesh.panels[0].material, given.panels[0].material);
}

TEST(FinerMesh, cloth_around_a_cylinder_is_rounder_than_its_coarse_triangles) {
  const double radius = 0.8 / (2 * M_PI); // m: both pieces go around it
  Garment coarse;
  coarse.panels = two_pieces(0.06);
  const auto around = [&](const pattern::PanelMesh& mesh) {
    std::vector<Vec3> x(mesh.pattern.size());
    for (const pattern::PanelInfo& panel : mesh.panels)
      for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
        const Vec2& p = mesh.pattern[v];
        const double angle = p.x() / radius + (panel.name == "front" ? 0 : M_PI);
        x[v] = Vec3(radius * std::sin(angle), p.y(), radius * std::cos(angle));
      }
    return x;
  };
  const std::vector<Vec3> corners = around(coarse.panels);
  unsew(coarse);
  coarse.position = corners;
  weld(coarse, corners);
  const pattern::PanelMesh mesh = two_pieces(0.015);
  const Garment fine = on_finer_mesh(coarse, mesh);
  const std::vector<Vec3> flat = interpolate(coarse.panels, corners, mesh), truth = around(mesh);
  const auto off = [&](const auto& at) {
    double sum = 0;
    for (std::size_t v = 0; v < truth.size(); ++v)
      sum += std::abs(std::hypot(at(v).x(), at(v).z()) - radius);
    return sum / static_cast<double>(truth.size());
  };
  const double rounded = off([&](std::size_t v) { return fine.position[fine.particle_of[v]]; });
  EXPECT_LT(rounded, 0.6 * off([&](std::size_t v) { return flat[v]; }));
  EXPECT_LT(fine.position.size(), mesh.pattern.size()) << "what is sewn stays sewn";
}

TEST(SoftSewing, starts_a_micrometre_apart_end_micrometres_apart_where_no_body_holds_the_cloth) {
  CollisionBody nothing(nullptr, 0, silent_reporter());
  std::array<Garment, 2> ends;
  for (std::size_t k = 0; k < 2; ++k) {
    ends[k].panels = two_pieces(0.048);
    if (k == 1)
      for (std::size_t v = 0; v < ends[k].panels.placed.size(); ++v)
        ends[k].panels.placed[v].z() += v % 3 == 0 ? 1e-6 : 0;
    const SoftSewing sewing = sew_softly(ends[k], nothing, silent_reporter());
    EXPECT_TRUE(sewing.finite);
    EXPECT_LT(sewing.widest_gap_m, 0.002);
  }
  EXPECT_LT(largest_difference(ends[0].position, ends[1].position), 2e-5);
}

/// A strip of 32 x 12 cm whose middle is a loop that its ends cross: one and a fifth turns.
Garment looped_strip() {
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "strip", "panels": [
    {"name": "strip", "outline": [{"edge": "low", "path": [["M", 0, 0], ["L", 32, 0]]}, {"edge": "end", "path": [["L", 32, 12]]},
      {"edge": "high", "path": [["L", 0, 12]]}, {"edge": "start", "path": [["L", 0, 0]]}]}]})";
  Garment garment;
  garment.panels = pattern::mesh_pattern(
      pattern::read_pattern_json(io::parse_json(text, "strip"), "strip"), 0.015, "strip");
  const double straight = 0.07, radius = (0.32 - 2 * straight) / (2.4 * M_PI);
  std::vector<Vec3> at;
  for (const Vec2& p : garment.panels.pattern) {
    Vec2 q = Vec2::Zero(), along = Vec2::UnitX();
    for (double s = 0, step = 1e-3; s < p.x(); s += step) {
      const bool turns = s > straight && s < 0.32 - straight;
      q += std::min(step, p.x() - s) * along;
      if (turns)
        along = Eigen::Rotation2Dd(step / radius) * along;
    }
    at.emplace_back(q.x(), p.y(), q.y());
  }
  unsew(garment);
  garment.position = at;
  weld(garment, at);
  return garment;
}

TEST(SoftSewing, a_loop_that_crosses_itself_springs_flat_where_it_is_stiff) {
  CollisionBody nothing(nullptr, 0, silent_reporter());
  const auto crossing_after = [&](double bending) {
    Garment strip = looped_strip();
    StiffRegion stiff{.particles = near_crossings(strip.position, strip.particle_triangles(), 4),
                      .bending = bending};
    EXPECT_FALSE(stiff.particles.empty());
    const SoftRelaxing how{.steps = 40, .bending = 1, .cg_tolerance = 1e-3};
    EXPECT_TRUE(spring_softly(strip, nothing, how, stiff, 0).finite);
    return !near_crossings(strip.position, strip.particle_triangles(), 0).empty();
  };
  EXPECT_TRUE(crossing_after(1)) << "it is flat without being stiff, and the test shows nothing";
  EXPECT_FALSE(crossing_after(3e4));
}

TEST(SoftSewing, cloth_that_was_placed_in_folds_keeps_them) {
  constexpr double WAVE = 0.2, DEPTH = 0.02; // m
  const auto depth_after = [&](bool in_folds) {
    Garment garment;
    garment.panels = two_pieces(0.03);
    for (pattern::PanelInfo& panel : garment.panels.panels)
      panel.in_folds = in_folds;
    for (Vec3& p : garment.panels.placed)
      p.z() += DEPTH * std::cos(2 * units::PI * p.x() / WAVE);
    CollisionBody nothing(nullptr, 0, silent_reporter());
    sew_softly(garment, nothing, silent_reporter());
    relax_softly(garment, nothing, {}, 0, silent_reporter());
    double low = 1e300, high = -1e300; // of the front
    const pattern::PanelInfo& front = garment.panels.panels[0];
    for (int v = front.first_vertex; v < front.first_vertex + front.n_vertices; ++v) {
      const double z = garment.position[garment.particle_of[v]].z();
      low = std::min(low, z);
      high = std::max(high, z);
    }
    return high - low;
  };
  const double kept = depth_after(true), flat = depth_after(false);
  EXPECT_GT(kept, 1.5 * flat);
}

TEST(SoftSewing, coarse_cloth_bends_by_direction) {
  // A board three times as stiff along warp, and one as stiff along weft, hang otherwise; fabrics
  // of the same mean did not.
  std::vector<std::vector<Vec3>> ends;
  for (const double warp : {1.5e-3, 0.5e-3}) {
    Garment garment;
    garment.panels = two_pieces(0.048);
    Material material = material_preset("cotton-poplin");
    material.bend_n_m = 1e-3;
    material.bend_warp_n_m = warp;
    material.bend_weft_n_m = 2e-3 - warp;
    garment.materials[""] = material;
    CollisionBody nothing(nullptr, 0, silent_reporter());
    sew_softly(garment, nothing, silent_reporter());
    relax_softly(garment, nothing, {}, 0, silent_reporter());
    ends.push_back(garment.position);
  }
  EXPECT_GT(largest_difference(ends[0], ends[1]), 1e-4);
}

TEST(SoftSewing, sleeves_close_around_the_arms_before_they_are_sewn_in) {
  samples::Mannequin tall; // an arm left the sleeve by its open seam: gaps of 20 mm
  tall.sex = "m";
  tall.stature_m = 1.85;
  PlacedShirt shirt(tall);
  CollisionBody met(&shirt.body, 1e-3, silent_reporter());
  met.prepare(met.ends_near(shirt.garment.panels.placed));
  const SoftSewing sewing = sew_softly(shirt.garment, met, silent_reporter());
  EXPECT_TRUE(sewing.finite);
  EXPECT_LT(sewing.widest_gap_m, 0.012);
}

TEST(SoftSewing, a_sleeve_that_would_start_in_the_trunk_starts_farther_out_and_is_not_opened) {
  samples::Mannequin stout; // sides of its sleeves started 20 cm apart
  stout.bmi = 28;
  stout.arm_deg = 20;
  EXPECT_LT(PlacedShirt(stout).sleeve_gap(), 0.13);
}

TEST(DrapeLevels, panels_without_their_pattern_are_draped_on_their_own_mesh_to_the_same_bytes) {
  const body::Body pillar = make_pillar();
  Garment once = make_skirt(0.76, 0.28, 0.03), through = once;
  DrapeSettings settings = preset_settings("draft");
  set_knob(settings, "max_steps", 20);
  settings.levels = 1;
  drape(once, &pillar, settings, silent_reporter());
  settings.levels = 2;
  const DrapeReport report = drape(through, &pillar, settings, silent_reporter());
  EXPECT_EQ(largest_difference(once.position, through.position), 0);
  EXPECT_EQ(report.levels.meshes, 1);
  EXPECT_EQ(report.levels.why, "the panels do not name their pattern");
  EXPECT_TRUE(report.repairs.empty());
}

TEST(DrapeLevels, a_body_without_bones_is_no_error) {
  const body::Body pillar = make_pillar();
  Garment garment;
  garment.panels = two_pieces(0.03);
  DrapeSettings settings = preset_settings("draft");
  set_knob(settings, "max_steps", 3);
  const DrapeReport report = drape(garment, &pillar, settings, silent_reporter());
  EXPECT_EQ(report.levels.meshes, 1);
  EXPECT_FALSE(report.levels.why.empty());
}

/// A skirt of two pieces around a pillar that can be drawn in.
struct Tube {
  body::Body body = make_pillar();
  Garment garment;

  explicit Tube(double edge = 0.03, double half_cm = 18.2) {
    body.landmarks["hip_center"].p = Vec3(0, 0.2, 0);
    body.landmarks["neck_center"].p = Vec3(0, 1.2, 0);
    garment.panels = two_pieces(edge, half_cm);
  }
  DrapeReport drape_to(const std::string& accuracy, const DrapeRequest& request = {},
                       Reporter& reporter = silent_reporter()) {
    return drape(garment, &body, preset_settings(accuracy), reporter, request);
  }
};

TEST(DrapeLevels, draft_ends_where_the_coarse_rest_is_clear_and_finer_presets_go_on_from_there) {
  Tube draft, standard;
  const DrapeReport report = draft.drape_to("draft");
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.stop_reason, StopReason::AT_REST_COARSE) << stop_text(report);
  EXPECT_EQ(report.levels.meshes, 2) << report.levels.why;
  EXPECT_GT(report.levels.coarse_particles, 50);
  EXPECT_EQ(report.settings.accuracy, "draft");
  EXPECT_EQ(report.quality["faces_through_body"], 0);
  EXPECT_EQ(standard.drape_to("standard").stop_reason, StopReason::AT_REST);
  Garment on = draft.garment;
  const DrapeReport climbed =
      drape(on, &draft.body, preset_settings("standard"), silent_reporter(), {.carried = true});
  EXPECT_TRUE(climbed.converged);
  EXPECT_EQ(largest_difference(on.position, standard.garment.position), 0) << "the same ladder";
}

TEST(DrapeLevels, small_changes_make_small_changes) {
  Tube first, jittered, threads, finer(0.03 * 0.99), edited(0.03, 18.205); // 0.1 mm wider
  for (std::size_t v = 0; v < jittered.garment.panels.placed.size(); ++v)
    jittered.garment.panels.placed[v].z() += v % 3 == 0 ? 1e-6 : 0;
  EXPECT_TRUE(first.drape_to("standard").converged);
  EXPECT_TRUE(jittered.drape_to("standard").converged);
  EXPECT_TRUE(finer.drape_to("standard").converged);
  EXPECT_TRUE(edited.drape_to("standard").converged);
  set_thread_count(2);
  EXPECT_TRUE(threads.drape_to("standard").converged);
  set_thread_count(1);
  EXPECT_EQ(largest_difference(first.garment.position, threads.garment.position), 0);
  const auto of_vertices = [](const Garment& g) {
    std::vector<Vec3> x;
    for (int particle : g.particle_of)
      x.push_back(g.position[particle]);
    return x;
  };
  const auto rms = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
  };
  EXPECT_LT(rms(of_vertices(first.garment), of_vertices(jittered.garment)), 0.001);
  const auto seen = [&](const Tube& other) {
    return interpolate(other.garment.panels, of_vertices(other.garment), first.garment.panels);
  };
  EXPECT_LT(rms(of_vertices(first.garment), seen(finer)), 0.004) << "edges 1 % shorter";
  EXPECT_LT(rms(of_vertices(first.garment), seen(edited)), 0.004) << "panels 0.1 mm wider";
}

TEST(DrapeLevels, killed_on_any_rung_it_goes_on_to_the_bytes_of_one_that_was_not) {
  class Killer : public Reporter {
  public:
    explicit Killer(int at) : m_at(at) {}
    bool stop_requested() const override { return ++m_asked > m_at; }
    int asked() const { return m_asked; }

  private:
    int m_at;
    mutable int m_asked = 0;
  };
  const std::string file = (std::filesystem::temp_directory_path() /
                            ("sloper-levels-" + std::to_string(::getpid()) + ".json"))
                               .string();
  Killer nobody(1 << 30);
  Tube whole;
  const DrapeReport undisturbed = whole.drape_to("fine", {.checkpoints = {file, 3}}, nobody);
  EXPECT_TRUE(undisturbed.converged) << stop_text(undisturbed);
  std::set<std::string> rungs; // where it was killed
  for (int left : {2, 10, 25, 40}) {
    Tube killed;
    Killer killer(nobody.asked() - left);
    killed.drape_to("fine", {.checkpoints = {file, 3}}, killer);
    const DrapeCheckpoint c = read_checkpoint(file);
    ASSERT_TRUE(c.levels);
    rungs.insert(c.levels->rung);
    SCOPED_TRACE(c.levels->rung + ", killed " + std::to_string(left) + " of " +
                 std::to_string(nobody.asked()) + " before its end");
    Garment resumed;
    set_thread_count(1 + left % 2);
    const DrapeReport report = resume_drape(file, resumed, &killed.body, silent_reporter());
    set_thread_count(1);
    EXPECT_EQ(largest_difference(resumed.position, whole.garment.position), 0) << left;
    EXPECT_EQ(report.steps, undisturbed.steps);
    EXPECT_EQ(report.repairs, undisturbed.repairs);
    EXPECT_EQ(report.quality, undisturbed.quality);
    EXPECT_EQ(report.levels.coarse_particles, undisturbed.levels.coarse_particles);
    EXPECT_EQ(report.settings.accuracy, "fine");
  }
  EXPECT_GT(rungs.size(), 1U);
  std::filesystem::remove(file);
}

TEST(DrapeLevels, redrapes_hang_the_sewn_garment_again_and_so_differ_as_hands_do) {
  // Panels of a shirt that were placed otherwise and sewn again lay 0.08 mm apart in place of 2:
  // sewing on the coarse mesh draws starts together.
  const Tube tube;
  RedrapeRequest request;
  request.count = 4;
  const RedrapeSet set =
      redrape(tube.garment, &tube.body, preset_settings("draft"), request, silent_reporter());
  const Spread spread = measure_spread(set, &tube.body);
  EXPECT_EQ(spread.at_rest, 4);
  ASSERT_TRUE(set.sewn);
  EXPECT_GT(spread.pairs.at("rms_mm").mean, 1);
  const DrapeReport whole = whole_report(set, 2);
  EXPECT_EQ(whole.levels.meshes, 2);
  EXPECT_GT(whole.steps, set.reports[2].steps) << "its sewing is not counted";
  EXPECT_EQ(whole_report(set, 0).steps, set.reports[0].steps);
}
