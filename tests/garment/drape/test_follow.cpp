#include <support/drape_scene.hpp>

#include <garment/drape/follow.hpp>
#include <garment/retarget/state_transfer.hpp>
#include <garment/simulate/audit.hpp>
#include <gtest/gtest.h>
#include <sloper/garment/garment_json.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/line_follower.hpp>
#include <sloper/pattern/edit/edits.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <filesystem>
#include <fstream>
#include <unistd.h>

using namespace sloper;
using namespace sloper::garment;

namespace {

const char* const HEAD = R"({"format": "edits", "version": 1, "length_unit": "cm"})";

/// A skirt of two rectangles with its pattern, draped on the pillar.
Garment draped_skirt(const body::Body& pillar, double edge_length = 0.03,
                     const io::Json& edits = {}, double friction = 0.3) {
  const std::string outline =
      R"("outline": [{"edge": "hem", "path": [["M", -19, 0], ["L", 19, 0]]}, {"edge": "left", "path": [["L", 19, 40]]},
      {"edge": "top", "path": [["L", -19, 40]]}, {"edge": "right", "path": [["L", -19, 0]]}])";
  const std::string text =
      R"({"format": "pattern", "version": 1, "length_unit": "cm", "name": "skirt", "panels": [{"name": "front", )" +
      outline + R"(}, {"name": "back", )" + outline + R"(}], "seams": [
      {"name": "left", "a": [{"panel": "front", "edge": "left"}], "b": [{"panel": "back", "edge": "right"}]},
      {"name": "right", "a": [{"panel": "back", "edge": "left"}], "b": [{"panel": "front", "edge": "right"}]}]})";
  const pattern::Pattern source =
      pattern::read_pattern_json(io::parse_json(text, "skirt"), "skirt");
  Garment skirt;
  skirt.panels = pattern::mesh_pattern(source, edge_length, "skirt");
  if (!edits.is_null()) {
    pattern::Pattern edited = source;
    pattern::apply_edits(edited, edits, "edits");
    EXPECT_TRUE(pattern::follow_edits(source, edited, skirt.panels, 15));
    skirt.panels.source = std::make_shared<pattern::Pattern>(edited);
  }
  for (const pattern::PanelInfo& p : skirt.panels.panels) {
    const double side = p.name == "back" ? -1 : 1;
    for (int v = p.first_vertex; v < p.first_vertex + p.n_vertices; ++v) {
      const Vec2 uv = skirt.panels.pattern[v];
      skirt.panels.placed[v] = Vec3(side * uv.x(), 0.65 + uv.y(), side * 0.2);
    }
  }
  skirt.materials[""].friction_body = friction;
  const DrapeReport report = drape(skirt, &pillar, {}, silent_reporter());
  EXPECT_TRUE(report.converged) << stop_text(report);
  return skirt;
}

/// The lines, and where they do not end the session, an end in the rest that the cloth comes to by
/// itself.
FollowReport play(Garment& garment, const body::Body& body, std::vector<std::string> lines,
                  std::vector<FollowFrame>* frames = nullptr, int max_steps = 1500) {
  if (std::none_of(lines.begin(), lines.end(), [](const std::string& line) {
        return line.find(R"("end")") != std::string::npos;
      }))
    lines.emplace_back(R"({"edit": "end", "finish": "warm"})");
  std::size_t at = 0;
  const FollowSession session{[&](int) {
                                return at < lines.size() ? std::optional<std::string>(lines[at++])
                                                         : std::nullopt;
                              },
                              [&] { return at == lines.size(); },
                              [&](const FollowFrame& f, const Garment&) {
                                if (frames)
                                  frames->push_back(f);
                              }};
  DrapeSettings settings;
  settings.max_steps = max_steps;
  return follow(garment, &body, settings, session, silent_reporter());
}

double lowest(const Garment& g) {
  double y = 1e300;
  for (const Vec3& p : g.position)
    y = std::min(y, p.y());
  return y;
}

/// To the highest point, m: friction holds a skirt on the pillar here or there, and that does not
/// change it.
double height(const Garment& g) {
  double y = -1e300;
  for (const Vec3& p : g.position)
    y = std::max(y, p.y());
  return y - lowest(g);
}

} // namespace

TEST(Follow, edits_change_rest_lengths_in_place_and_the_cloth_comes_to_the_rest_of_a_cold_drape) {
  const body::Body pillar = make_pillar();
  Garment live = draped_skirt(pillar, 0.03, {}, 0);
  const double before = height(live);
  const std::vector<Triangle> triangles = live.panels.triangles;
  std::vector<FollowFrame> frames;
  const FollowReport report =
      play(live, pillar,
           {HEAD, R"({"edit": "move-edge", "panel": "front", "edge": "hem", "by": [0, -2]})", "",
            R"({"edit": "move-edge", "panel": "back", "edge": "hem", "by": [0, -2]})"},
           &frames);
  EXPECT_TRUE(report.drape.converged) << stop_text(report.drape);
  EXPECT_EQ(report.edits, 2);
  EXPECT_EQ(report.remeshed, 0);
  EXPECT_TRUE(report.refused.empty());
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].edits, 2);
  EXPECT_GE(frames[1].latency_ms, 0);
  EXPECT_EQ(live.panels.triangles, triangles);
  EXPECT_NEAR(height(live), before + 0.02, 0.004);
  const Garment cold = draped_skirt(pillar, 0.03, report.log, 0);
  ASSERT_EQ(cold.position.size(), live.position.size());
  for (std::size_t v = 0; v < cold.panels.pattern.size(); ++v)
    EXPECT_EQ(cold.panels.pattern[v], live.panels.pattern[v]) << "the log replays the same panels";
  // The pillar lets the skirt turn about it and sit a little higher or lower: its own shape is
  // compared, by distances from the middle.
  const auto middle = [](const Garment& g) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : g.position)
      sum += p;
    return Vec3(sum / static_cast<double>(g.position.size()));
  };
  double sum = 0;
  for (std::size_t i = 0; i < cold.position.size(); ++i)
    sum += std::pow(
        (cold.position[i] - middle(cold)).norm() - (live.position[i] - middle(live)).norm(), 2);
  EXPECT_LT(std::sqrt(sum / static_cast<double>(cold.position.size())), 0.004);
}

TEST(Follow, the_same_lines_give_the_same_bytes_and_no_edit_leaves_the_drape_where_it_is) {
  const body::Body pillar = make_pillar();
  const Garment start = draped_skirt(pillar);
  Garment none = start, one = start, two = start;
  play(none, pillar, {HEAD});
  double most = 0;
  for (std::size_t i = 0; i < none.position.size(); ++i)
    most = std::max(most, (none.position[i] - start.position[i]).norm());
  EXPECT_LT(most, 0.003);
  const std::vector<std::string> lines = {HEAD,
                                          R"({"edit": "take-in", "seam": "left", "by": 0.5})"};
  play(one, pillar, lines);
  play(two, pillar, lines);
  EXPECT_EQ(strict_hash(one), strict_hash(two));
}

namespace {

/// What pattern-mesh --edits and drape make of the pattern and a log.
Garment cold_drape(const Garment& start, const io::Json& log, const body::Body& body) {
  Garment cold;
  pattern::Pattern edited = *start.panels.source;
  cold.materials = start.materials;
  cold.panels = pattern::mesh_pattern(edited, start.panels.edge_length, "skirt");
  pattern::apply_edits(edited, log, "edits");
  if (!pattern::follow_edits(*start.panels.source, edited, cold.panels, 15))
    cold.panels = pattern::mesh_pattern(edited, start.panels.edge_length, "skirt");
  pattern::place_panels(edited, body, cold.panels);
  drape(cold, &body, {}, silent_reporter());
  return cold;
}

} // namespace

TEST(Follow, a_session_ends_in_the_bytes_of_a_cold_drape_of_the_edited_pattern) {
  const body::Body pillar = make_pillar();
  const Garment start = draped_skirt(pillar);
  const std::string
      hem = R"({"edit": "move-edge", "panel": "front", "edge": "hem", "by": [0, -1]})",
      side = R"({"edit": "take-in", "seam": "left", "by": 0.3})",
      open = R"({"edit": "open", "seam": "left"})", close = R"({"edit": "close", "seam": "left"})",
      split =
          R"({"edit": "split", "panel": "front", "from": [0, -1], "to": [0, 41], "names": ["west", "east"], "sew": true})",
      asked = R"({"edit": "end", "finish": "cold"})", end = R"({"edit": "end"})";
  // Asked for and by itself; in place, over another mesh, and over another mesh and back.
  for (const std::vector<std::string>& edits :
       {std::vector<std::string>{hem, side, asked, "never read"},
        {hem, side, end},
        {hem, split, end},
        {open, hem, close, side, end}}) {
    Garment live = start;
    std::vector<std::string> lines = {HEAD};
    lines.insert(lines.end(), edits.begin(), edits.end());
    const FollowReport report = play(live, pillar, lines);
    EXPECT_TRUE(report.drape.converged) << stop_text(report.drape);
    EXPECT_TRUE(report.refused.empty());
    const Garment cold = cold_drape(start, report.log, pillar);
    EXPECT_EQ(live.panels.pattern, cold.panels.pattern) << edits[1];
    EXPECT_EQ(strict_hash(live), strict_hash(cold)) << edits[1];
  }
  Garment other = start;
  EXPECT_EQ(play(other, pillar, {HEAD, R"({"edit": "end", "finish": "luke"})"}).refused.size(), 1u);
}

TEST(Follow, a_garment_read_from_its_document_ends_in_the_same_bytes) { // the pattern within is
                                                                        // kept to the last bit
  const body::Body pillar = make_pillar();
  Garment start = draped_skirt(pillar);
  auto source = std::make_shared<pattern::Pattern>(*start.panels.source);
  source->panels[0].hint.rigid = Mat4(Mat4::Identity() * 1.0);
  (*source->panels[0].hint.rigid)(2, 3) = 0.2 / 3;
  source->panels[1].hint.part = "torso";
  source->panels[1].hint.theta = std::acos(-1.0) / 3;
  source->panels[1].hint.height = 1.0 / 3;
  source->panels[1].grain = Vec2(1, 3).normalized();
  start.panels.source = source;
  const auto folder =
      std::filesystem::temp_directory_path() / ("sloper_exact_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  write_garment((folder / "skirt.json").string(), start, "test");
  const Garment back = read_garment((folder / "skirt.json").string());
  std::filesystem::remove_all(folder);
  const pattern::Pattern &a = *start.panels.source, &b = *back.panels.source;
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_EQ(a.panels[p].grain, b.panels[p].grain);
    EXPECT_EQ(a.panels[p].hint.theta, b.panels[p].hint.theta);
    EXPECT_EQ(a.panels[p].hint.height, b.panels[p].hint.height);
    ASSERT_EQ(a.panels[p].hint.rigid.has_value(), b.panels[p].hint.rigid.has_value());
    if (p == 0) {
      EXPECT_EQ(*a.panels[p].hint.rigid, *b.panels[p].hint.rigid);
    }
    for (int e = 0; e < a.panels[p].n_edges(); ++e)
      for (std::size_t s = 0; s < a.panels[p].edge(e).path.size(); ++s)
        for (std::size_t k : {0, 3})
          EXPECT_EQ(a.panels[p].edge(e).path[s].p[k], b.panels[p].edge(e).path[s].p[k]);
  }
}

TEST(Follow, a_replay_ends_in_the_same_bytes_whatever_came_between) {
  const body::Body pillar = make_pillar();
  const Garment start = draped_skirt(pillar);
  const std::string hem =
                        R"({"edit": "move-edge", "panel": "front", "edge": "hem", "by": [0, -1]})",
                    end = R"({"edit": "end", "finish": "replay"})",
                    there = R"({"edit": "take-in", "seam": "left", "by": 0.3})",
                    back = R"({"edit": "let-out", "seam": "left", "by": 0.3})";
  Garment one = start, two = start, three = start, none = start;
  EXPECT_TRUE(play(one, pillar, {HEAD, hem, end}).drape.converged);
  play(two, pillar, {HEAD, there, hem, back, end});
  EXPECT_EQ(strict_hash(one), strict_hash(two));
  // Over a mesh of its own and back, too.
  play(three, pillar,
       {HEAD, R"({"edit": "open", "seam": "left"})", hem, R"({"edit": "close", "seam": "left"})",
        end});
  EXPECT_EQ(strict_hash(one), strict_hash(three));
  play(none, pillar, {HEAD, there, back, end});
  double most = 0;
  for (std::size_t i = 0; i < none.position.size(); ++i)
    most = std::max(most, (none.position[i] - start.position[i]).norm());
  EXPECT_LT(most, 0.003) << "no edit leaves the drape where it is";
}

TEST(Follow, the_frame_that_answers_an_edit_has_a_fixed_budget_however_large_the_edit) {
  const body::Body pillar = make_pillar();
  Garment skirt = draped_skirt(pillar);
  std::vector<FollowFrame> frames;
  const FollowReport report =
      play(skirt, pillar,
           {HEAD, R"({"edit": "take-in", "seam": "left", "by": 4})",
            R"({"edit": "move-edge", "panel": "front", "edge": "hem", "by": [0, -4]})"},
           &frames);
  ASSERT_EQ(frames.size(), 2u);
  for (const FollowFrame& f : frames) {
    EXPECT_GT(f.cg_iterations, 0);
    EXPECT_LE(f.cg_iterations, FOLLOW_ANSWER_ITERATIONS);
    EXPECT_GT(f.speed_m_s, 0.05) << "the cloth answers at once";
  }
  EXPECT_TRUE(report.drape.converged)
      << "what the budget left over is solved on the way to rest: " << stop_text(report.drape);
}

TEST(Follow, an_edit_that_asks_for_another_mesh_carries_the_draped_state_across) {
  const body::Body pillar = make_pillar();
  Garment skirt = draped_skirt(pillar);
  const double before = lowest(skirt);
  std::vector<FollowFrame> frames;
  const FollowReport report = play(
      skirt, pillar,
      {HEAD,
       R"({"edit": "split", "panel": "front", "from": [0, -1], "to": [0, 41], "names": ["west", "east"], "sew": true})",
       R"({"edit": "move-edge", "panel": "back", "edge": "hem", "by": [0, -1]})"},
      &frames);
  EXPECT_TRUE(report.drape.converged) << stop_text(report.drape);
  EXPECT_EQ(report.remeshed, 1);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_TRUE(frames[0].remeshed);
  EXPECT_EQ(frames[0].speed_m_s, 0) << "the new mesh is shown at once, where the cloth hung";
  EXPECT_GE(frames[0].latency_ms, 0);
  EXPECT_FALSE(frames[1].remeshed);
  EXPECT_LT(frames[1].latency_ms, 0) << "and goes on from there";
  EXPECT_LT(frames[1].speed_m_s, 0.3);
  EXPECT_EQ(frames[2].edits, 2);
  EXPECT_EQ(skirt.panels.panels.size(), 3u);
  EXPECT_EQ(report.drape.quality["faces_through_body"], 0);
  EXPECT_EQ(report.drape.quality["self_intersections"], 0);
  EXPECT_NEAR(lowest(skirt), before - 0.005, 0.02);
  // Joined again, it is one panel that hangs where it hung.
  const FollowReport joined =
      play(skirt, pillar,
           {HEAD, R"({"edit": "join", "seam": ")" + skirt.panels.seams.back().name + R"("})"},
           nullptr, 150);
  EXPECT_EQ(joined.remeshed, 1) << (joined.refused.empty() ? "" : joined.refused[0]);
  EXPECT_EQ(skirt.panels.panels.size(), 2u);
  EXPECT_EQ(joined.drape.quality["faces_through_body"], 0);
}

TEST(Follow, a_closure_opens_and_closes_while_the_cloth_hangs) {
  const body::Body pillar = make_pillar();
  Garment skirt = draped_skirt(pillar);
  const std::size_t closed = skirt.position.size();
  const FollowReport opened =
      play(skirt, pillar, {HEAD, R"({"edit": "open", "seam": "left"})"}, nullptr, 250);
  EXPECT_EQ(opened.edits, 1) << (opened.refused.empty() ? "" : opened.refused[0]);
  ASSERT_EQ(skirt.panels.seams.size(), 2u);
  EXPECT_TRUE(skirt.panels.seams[0].open);
  EXPECT_EQ(skirt.position.size(), closed + skirt.panels.seams[0].a.size())
      << "each side of the opening has its own particles";
  EXPECT_EQ(opened.drape.quality["faces_through_body"], 0);
  EXPECT_EQ(opened.drape.quality["self_intersections"], 0);
  const FollowReport twice =
      play(skirt, pillar,
           {HEAD, R"({"edit": "open", "seam": "left"})", R"({"edit": "close", "seam": "left"})"},
           nullptr, 250);
  ASSERT_EQ(twice.refused.size(), 1u);
  EXPECT_NE(twice.refused[0].find("already open"), std::string::npos) << twice.refused[0];
  EXPECT_EQ(skirt.position.size(), closed);
}

TEST(Follow, an_elastic_tape_draws_the_cloth_in_along_it_and_nowhere_else) {
  const body::Body pillar = make_pillar();
  Garment skirt = draped_skirt(pillar);
  const auto stretch = [&](double low,
                           double high) { // of level edges of the front between two heights of the
                                          // pattern: length to that of the pattern
    double now = 0, flat = 0;
    for (int f = 0; f < skirt.panels.panels[0].n_triangles; ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& t = skirt.panels.triangles[f];
        const auto a = static_cast<std::size_t>(t[k]), b = static_cast<std::size_t>(t[(k + 1) % 3]);
        const Vec2 p = skirt.panels.pattern[a], q = skirt.panels.pattern[b];
        if (std::abs((q - p).normalized().x()) < 0.95 || std::min(p.y(), q.y()) < low ||
            std::max(p.y(), q.y()) > high)
          continue;
        now += (skirt.position[skirt.particle_of[a]] - skirt.position[skirt.particle_of[b]]).norm();
        flat += (q - p).norm();
      }
    return now / flat;
  };
  const double before = stretch(0.06, 0.14);
  const std::vector<Vec2> pattern = skirt.panels.pattern;
  const FollowReport report = play(
      skirt, pillar,
      {HEAD,
       R"({"edit": "shrink", "panel": "front", "curve": [["M", -19, 10], ["L", 19, 10]], "factor": 0.7, "width": 6})"},
      nullptr, 150);
  EXPECT_EQ(report.edits, 1) << (report.refused.empty() ? "" : report.refused[0]);
  EXPECT_EQ(report.remeshed, 0);
  for (std::size_t v = 0; v < pattern.size(); ++v)
    EXPECT_LT((skirt.panels.pattern[v] - pattern[v]).norm(), 1e-8);
  EXPECT_LT(stretch(0.06, 0.14), before - 0.05) << "the cloth beside the tape holds against it";
  EXPECT_GT(stretch(0.25, 0.40), 0.96);
}

TEST(Follow, lines_that_are_no_edits_are_refused_with_their_number_and_change_nothing) {
  const body::Body pillar = make_pillar();
  Garment skirt = draped_skirt(pillar);
  const std::vector<Vec2> pattern = skirt.panels.pattern;
  const FollowReport report =
      play(skirt, pillar,
           {R"({"edit": "move-edge", "panel": "front", "edge": "hem", "by": [0, -2]})", HEAD, "{",
            R"({"edit": "move-edge", "panel": "frnt", "edge": "hem", "by": [0, -2]})",
            R"({"edit": "move-edge", "panel": "front", "edge": "hem", "by": [0, 60]})",
            R"({"edit": "end"})", "never read"});
  ASSERT_EQ(report.refused.size(), 4u);
  EXPECT_NE(report.refused[0].find("line 1"), std::string::npos) << report.refused[0];
  EXPECT_NE(report.refused[0].find("head"), std::string::npos) << report.refused[0];
  EXPECT_NE(report.refused[1].find("line 3"), std::string::npos) << report.refused[1];
  EXPECT_NE(report.refused[2].find("did you mean"), std::string::npos) << report.refused[2];
  EXPECT_EQ(report.edits, 0);
  EXPECT_EQ(skirt.panels.pattern, pattern);
}

TEST(Follow, a_garment_keeps_its_pattern_in_its_document_and_one_without_is_refused) {
  const body::Body pillar = make_pillar();
  Garment skirt = draped_skirt(pillar);
  const auto folder =
      std::filesystem::temp_directory_path() / ("sloper_follow_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  write_garment((folder / "skirt.json").string(), skirt, "test");
  Garment back = read_garment((folder / "skirt.json").string());
  std::filesystem::remove_all(folder);
  EXPECT_EQ(play(back, pillar, {HEAD, R"({"edit": "let-out", "seam": "left", "by": 0.2})"}).edits,
            1);
  skirt.panels.source.reset();
  EXPECT_THROW(play(skirt, pillar, {HEAD}), Error);
}

TEST(Follow, a_growing_file_gives_whole_lines_as_they_come) {
  const auto path =
      std::filesystem::temp_directory_path() / ("sloper_lines_" + std::to_string(::getpid()));
  std::ofstream file(path);
  io::LineFollower lines(path.string());
  EXPECT_FALSE(lines.next(0));
  file << "one\r\ntw" << std::flush;
  EXPECT_EQ(lines.next(0).value_or("none"), "one");
  EXPECT_FALSE(lines.next(10)) << "half a line is none";
  file << "o\n\nthree\n" << std::flush;
  EXPECT_EQ(lines.next(0).value_or("none"), "two");
  EXPECT_EQ(lines.next(0).value_or("none"), "");
  EXPECT_EQ(lines.next(0).value_or("none"), "three");
  EXPECT_EQ(lines.line(), 4);
  EXPECT_FALSE(lines.ended());
  std::filesystem::remove(path);
}
