/// run-soak: random scenes, bodies, garments, materials, settings and edits, each from its number;
/// what fails is made as small as it can be and kept as a case file. Scene k is the same on every
/// machine, so slices of any size cover 10,000 together.
#include "hard_case.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sloper/base/error.hpp>
#include <sloper/base/random.hpp>

using namespace sloper;
using namespace sloper::hard;

namespace {

struct Choice {
  const char* parameter;
  std::vector<io::Json> values;
};

/// What a scene of each kind may differ by. Ranges are wide but physical; what is refused on
/// purpose has hard cases of its own.
const std::vector<Choice>& choices(const std::string& scene) {
  static const std::vector<Choice> sheet = {
      {"cells_x", {1, 3, 6, 12}},
      {"cells_y", {2, 6, 12}},
      {"width_m", {0.05, 0.3, 1}},
      {"stretch_n_m", {1, 50, 1e3, 1e4, 1e6}},
      {"weft_ratio", {0.01, 0.5, 1}},
      {"bend_n_m", {0, 1e-7, 1e-5, 1e-3, 1}},
      {"shear_n_m", {0, 10, 1e3}},
      {"density_kg_m2", {0.01, 0.12, 2}},
      {"damping_s", {0, 0.02, 1}},
      {"poisson", {0, 0.25, 0.9}},
      {"membrane", {"springs", "triangles", "fem"}},
      {"bending", {"isometric", "dihedral", "none"}},
      {"plane", {"flat", "hanging"}},
      {"pins", {"none", "top", "corners", "left", "conflict"}},
      {"pin_pull_m", {0.01, 0.2}},
      {"scale", {0.3, 0.9, 1.2, 3}},
      {"crumple_m", {1e-4, 0.01, 0.2}},
      {"start", {"mirrored", "point", "far"}},
      {"mass_ratio", {10, 1e5}},
      {"load_n", {0.1, 10}},
      {"thin_cell_m", {1e-4, 1e-2}},
      {"wind_m_s", {1, 30}},
      {"pressure_pa", {1, 500}},
      {"self_contact", {1}},
      {"h", {0.001, 0.01, 0.1, 0.5}},
      {"cg_tolerance", {0.1, 1e-6}},
      {"gravity_m_s2", {0, 1.6, 30}},
  };
  static const std::vector<Choice> contact = {
      {"body", {"sphere", "spheres", "ridge", "spike", "plate", "triangle"}},
      {"fineness", {5, 10, 30}},
      {"damage",
       {"holes", "noise", "flipped", "inside_out", "duplicates", "fins", "cracks", "zero_area"}},
      {"cells", {2, 6, 12}},
      {"layers", {2, 3}},
      {"height_m", {0.05, 0.09, 0.101, 0.15}},
      {"turn_deg", {13, 45}},
      {"stretch_n_m", {50, 1e4}},
      {"bend_n_m", {0, 1e-3}},
      {"friction", {0, 1, 5}},
      {"contact_gap_m", {0.001, 0.006}},
      {"thickness_m", {0.0005, 0.004}},
      {"membrane", {"triangles", "fem"}},
      {"h", {0.005, 0.1}},
      {"motion", {"shake"}},
      {"body_speed_m_s", {0.05, 2}},
      {"body_way_m", {0.01, 0.05}},
  };
  static const std::vector<Choice> drape = {
      {"body", {"none", "sphere", "arm", "pillar"}},
      {"garment", {"patch", "crossed", "gather", "pillow", "triangle"}},
      {"edge_m", {0.06, 0.09}},
      {"girth_m", {0.5, 0.7, 0.9, 1.3}},
      {"length_m", {0.1, 0.2, 0.4}},
      {"top_m", {0.8, 1.1}},
      {"away_m", {0.1, 0.4}},
      {"material", {"denim", "silk", "wool-suiting", "jersey", "canvas", "table1"}},
      {"stretch_times", {0.1, 10}},
      {"bend_n_m", {1e-7, 1e-3}},
      {"friction", {0, 2}},
      {"damping_s", {0, 1}},
      {"density_times", {0.1, 5}},
      {"membrane", {"triangles", "fem"}},
      {"bending", {"dihedral"}},
      {"wind_m_s", {2, 20}},
      {"pressure_pa", {1, 50}},
      {"band_ratio", {0.5, 0.9}},
      {"crease_deg", {30, 150}},
      {"accuracy", {"standard", "fine"}},
      {"h", {0.005, 0.2}},
      {"cg_tolerance", {0.3, 1e-6}},
      {"contact_gap_m", {0.001, 0.008}},
      {"thickness_m", {0.0005, 0.005}},
      {"gravity_m_s2", {0, 3}},
      {"edit_times", {0.5, 0.9, 1.5}},
      {"damage", {"holes", "noise", "flipped", "debris", "cracks"}},
      {"spoil", {"inverted", "coincident_seams", "duplicate_face"}},
      {"garment_scale", {0.2, 3}},
  };
  if (scene == "sheet")
    return sheet;
  return scene == "contact" ? contact : drape;
}

Case make_scene(std::uint64_t number) {
  Random random(1000003 * number + 17);
  Case c;
  const double kind = random.uniform();
  c.scene = kind < 0.7 ? "contact" : "drape";
  if (kind < 0.45)
    c.scene = "sheet";
  c.file = "soak-" + std::to_string(number);
  c.name = "Random scene " + std::to_string(number);
  c.parameters = io::Json::object();
  for (const Choice& choice : choices(c.scene))
    if (random.uniform() < 0.25)
      c.parameters[choice.parameter] = choice.values[random.next() % choice.values.size()];
  if (c.scene == "sheet")
    c.parameters["steps"] = 25;
  if (c.scene == "contact")
    c.parameters["duration_s"] = 0.5;
  if (c.scene == "drape") {
    c.parameters["max_steps"] = 300;
    if (!c.parameters.contains("body"))
      c.parameters["body"] = "figure";
    if (!c.parameters.contains("edge_m"))
      c.parameters["edge_m"] = 0.06;
  }
  c.pass = {{"exit", {0, 3, 4}}, {"says", "."}};
  if (c.scene == "drape")
    c.pass["honest"] = 1;
  if (c.scene == "sheet")
    c.pass["indefinite"] = 0;
  c.cpu_s = 60;
  c.points = {{io::Json::object(), "", ""}};
  return c;
}

std::string fails(const Case& c, std::uint64_t seed) {
  return run_point(c, c.points[0], seed).broken;
}

/// Parameters are left out one by one while the scene still fails.
Case minimise(Case c, std::uint64_t seed) {
  for (bool smaller = true; smaller;) {
    smaller = false;
    const io::Json all = c.parameters;
    for (const auto& [key, value] : all.items()) {
      Case less = c;
      less.parameters.erase(key);
      if (key == "steps" || key == "max_steps" || key == "duration_s" || fails(less, seed).empty())
        continue;
      c = less;
      smaller = true;
    }
  }
  return c;
}

void keep(const Case& c, const std::string& broken, const std::string& folder) {
  std::filesystem::create_directories(folder);
  const io::Json document = {{"format", "hard-case"},
                             {"version", 1},
                             {"name", c.name},
                             {"elsewhere", "found by run-soak"},
                             {"invariant", broken},
                             {"scene", c.scene},
                             {"parameters", c.parameters},
                             {"pass", c.pass},
                             {"cpu_s", c.cpu_s}};
  io::write_json((std::filesystem::path(folder) / (c.file + ".json")).string(), document);
}

int main_of(int argc, char** argv) {
  std::uint64_t from = 0, count = 100;
  std::string out;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string a = argv[i];
    if (a == "--from")
      from = std::stoull(argv[i + 1]);
    else if (a == "--count")
      count = std::stoull(argv[i + 1]);
    else if (a == "--out")
      out = argv[i + 1];
    else
      throw Error(ErrorKind::USAGE, "hard.option"_id, "", a, "is not known",
                  "run-soak [--from K] [--count N] [--out DIR]");
  }
  std::uint64_t failed = 0, refused = 0, unfinished = 0, other_bytes = 0;
  double longest = 0;
  for (std::uint64_t k = from; k < from + count; ++k) {
    const Case c = make_scene(k);
    const Verdict v = run_point(c, c.points[0], k);
    refused += v.outcome.exit == 3;
    unfinished += v.outcome.exit == 4;
    if (const auto cpu = v.outcome.value.find("cpu_s"); cpu != v.outcome.value.end())
      longest = std::max(longest, cpu->second);
    if (v.broken.empty() && k % 10 == 0 &&
        run_point(c, c.points[0], k, 2).outcome.hash != v.outcome.hash) {
      ++other_bytes;
      std::printf("scene %llu: other bytes with two threads\n", static_cast<unsigned long long>(k));
    }
    if ((k + 1 - from) % 100 == 0) {
      std::printf("%llu scenes done: %llu fail\n", static_cast<unsigned long long>(k + 1 - from),
                  static_cast<unsigned long long>(failed));
      std::fflush(stdout);
    }
    if (v.broken.empty())
      continue;
    ++failed;
    const Case small = minimise(c, k);
    std::printf("scene %llu fails: %s\n  %s %s\n", static_cast<unsigned long long>(k),
                v.broken.c_str(), small.scene.c_str(), small.parameters.dump().c_str());
    std::fflush(stdout);
    if (!out.empty())
      keep(small, v.broken, out);
  }
  std::printf("%llu scenes from %llu: %llu fail, %llu differ with two threads; %llu refused (exit "
              "3), %llu not at rest within their steps (exit 4); longest "
              "%.1f CPU s\n",
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(from),
              static_cast<unsigned long long>(failed), static_cast<unsigned long long>(other_bytes),
              static_cast<unsigned long long>(refused), static_cast<unsigned long long>(unfinished),
              longest);
  return failed + other_bytes > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return main_of(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "run-soak: %s\n", e.what());
    return 2;
  }
}
