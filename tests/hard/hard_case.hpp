#pragma once
/// A hard case: one file of cases/, a scene with parameters, a sweep, jittered inputs, and the
/// invariant that must hold on all of them.
///
/// {"format": "hard-case", "version": 1, "name", "elsewhere": what goes wrong in other programs,
/// "invariant": in words,
///  "scene": one of scenes(), "parameters": {...}, "sweep": {PARAMETER: [values...]} (every
///  combination is a point), "pass": {MEASURE: number | {"min", "max"}, "says": pattern, "exit":
///  [codes]}, "reference": {...}: parameters of a run that MEASURE/reference compares with,
///  "seeds": how many, "ci": {"seeds", "points"}, "cpu_s": limit of a run, "failing": [{"at":
///  {PARAMETER: value...}, "why"}]: points that do not hold yet}
/// Seed 0 is the scene as it is; others move its points at random (parameter jitter_m).
#include <map>
#include <set>
#include <sloper/io/json.hpp>
#include <string>
#include <vector>

namespace sloper::hard {

/// A scene's parameters; one that no scene asks for is a mistake in the file.
class Parameters {
public:
  explicit Parameters(io::Json values) : m_values(std::move(values)) {}
  double number(const std::string& key, double fallback) const;
  int whole(const std::string& key, int fallback) const {
    return static_cast<int>(number(key, fallback));
  }
  bool flag(const std::string& key, bool fallback) const { return number(key, fallback) != 0; }
  std::string text(const std::string& key, const std::string& fallback) const;
  /// Keys that were never asked for.
  std::vector<std::string> unused() const;

private:
  io::Json m_values;
  mutable std::set<std::string> m_used;
};

/// What a run came to.
struct Outcome {
  std::map<std::string, double> value; ///< by measure
  std::string said;      ///< all that was reported: stop reason, repairs, message of an error
  int exit = 0;          ///< what the program would end with
  std::string hash;      ///< of the final state's bytes
  std::string quantised; ///< of its cells of 10 um, to compare compilers
};
using Scene = Outcome (*)(const Parameters&, std::uint64_t seed);
const std::map<std::string, Scene>& scenes();

struct Point {
  io::Json overrides;  ///< of the parameters
  std::string name;    ///< "h=0.1 scale=0.5"; empty without a sweep
  std::string failing; ///< why it does not hold yet; empty when it must hold
};

struct Case {
  std::string file, name, elsewhere, invariant, scene;
  io::Json parameters, pass, reference;
  std::vector<Point> points;
  int seeds = 20, ci_seeds = 1;
  std::vector<std::size_t> ci_points;
  double cpu_s = 60;
};

Case read_case(const std::string& path);
/// All of a folder, by file name.
std::vector<Case> read_cases(const std::string& folder);

struct Verdict {
  std::string broken; ///< which bounds broke, by how much; empty: it holds
  Outcome outcome;
};

/// Runs a point in a process of its own: a crash and a run beyond its CPU seconds are results.
/// @param threads of the library
Verdict run_point(const Case& c, const Point& point, std::uint64_t seed, int threads = 1);

} // namespace sloper::hard
