#include "hard_case.hpp"

#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sloper::hard {

double Parameters::number(const std::string& key, double fallback) const {
  m_used.insert(key);
  return m_values.contains(key) ? m_values[key].get<double>() : fallback;
}

std::string Parameters::text(const std::string& key, const std::string& fallback) const {
  m_used.insert(key);
  return m_values.contains(key) ? m_values[key].get<std::string>() : fallback;
}

std::vector<std::string> Parameters::unused() const {
  std::vector<std::string> out;
  for (const auto& [key, value] : m_values.items())
    if (!m_used.count(key))
      out.push_back(key);
  return out;
}

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double SLOWER = 30; // than a release: limits and times are those of one
#else
constexpr double SLOWER = 1;
#endif

std::string short_text(const io::Json& value) {
  if (value.is_string())
    return value.get<std::string>();
  char text[32];
  std::snprintf(text, sizeof text, "%g", value.get<double>());
  return text;
}

std::vector<Point> make_points(const io::Json& sweep) {
  std::vector<Point> points{{io::Json::object(), "", ""}};
  for (const auto& [key, values] : sweep.items()) {
    std::vector<Point> more;
    for (const Point& p : points)
      for (const io::Json& value : values) {
        Point q = p;
        q.overrides[key] = value;
        q.name += (q.name.empty() ? "" : " ") + key + "=" + short_text(value);
        more.push_back(q);
      }
    points = more;
  }
  return points;
}

io::Json merged(io::Json base, const io::Json& overrides) {
  for (const auto& [key, value] : overrides.items())
    base[key] = value;
  return base;
}

io::Json to_json(const Outcome& o) {
  io::Json values = io::Json::object();
  for (const auto& [name, v] : o.value)
    values[name] = std::isfinite(v) ? io::Json(v) : io::Json("not finite");
  return {{"values", values},
          {"said", o.said},
          {"exit", o.exit},
          {"hash", o.hash},
          {"quantised", o.quantised}};
}

Outcome from_json(const io::Json& json) {
  Outcome o;
  for (const auto& [name, v] : json["values"].items())
    o.value[name] = v.is_number() ? v.get<double>() : std::nan("");
  o.said = json["said"];
  o.exit = json["exit"];
  o.hash = json["hash"];
  o.quantised = json["quantised"];
  return o;
}

Outcome run_scene(const Case& c, const io::Json& parameters, std::uint64_t seed) {
  const Parameters p(parameters);
  Outcome o;
  try {
    o = scenes().at(c.scene)(p, seed);
  } catch (const Error& e) {
    o.said = e.what();
    o.exit = e.exit_code();
    return o;
  }
  for (const std::string& key : p.unused())
    throw std::runtime_error(c.file + ": the scene " + c.scene + " knows no parameter " + key);
  return o;
}

/// In the child: the outcome as text, to the pipe.
[[noreturn]] void work_in_child(const Case& c, const io::Json& parameters, std::uint64_t seed,
                                int threads, int pipe) {
  const auto seconds = static_cast<rlim_t>(std::ceil(SLOWER * c.cpu_s * threads));
  const rlimit limit{seconds, seconds + 2};
  setrlimit(RLIMIT_CPU, &limit);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  std::string text;
  try {
    set_thread_count(threads);
    Outcome o = run_scene(c, parameters, seed);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    o.value["cpu_s"] = (static_cast<double>(usage.ru_utime.tv_sec) +
                        1e-6 * static_cast<double>(usage.ru_utime.tv_usec)) /
                       SLOWER;
    text = to_json(o).dump(-1, ' ', true, io::Json::error_handler_t::replace);
  } catch (const std::exception& e) {
    text = to_json({{}, std::string("exception: ") + e.what(), 70, "", ""})
               .dump(-1, ' ', true, io::Json::error_handler_t::replace);
  }
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(pipe, text.data() + done, text.size() - done);
    if (n <= 0)
      break;
    done += static_cast<std::size_t>(n);
  }
  _exit(0);
}

Outcome run_apart(const Case& c, const io::Json& parameters, std::uint64_t seed, int threads,
                  std::string& died) {
  int ends[2];
  if (pipe(ends) != 0)
    throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0)
    throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    work_in_child(c, parameters, seed, threads, ends[1]);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    died = signal == SIGXCPU || signal == SIGKILL
               ? "did not end within " + short_text(c.cpu_s) + " CPU s"
               : std::string("crashed: ") + strsignal(signal);
  } else if (WEXITSTATUS(status) != 0 || text.empty()) {
    died = "ended without a result, exit " + std::to_string(WEXITSTATUS(status));
  }
  return text.empty() ? Outcome{} : from_json(io::Json::parse(text));
}

std::string check_bounds(const Case& c, const Outcome& o, const Outcome& reference) {
  std::string broken;
  auto add = [&](const std::string& text) { broken += (broken.empty() ? "" : "; ") + text; };
  auto value_of = [&](const std::string& name, double& v) {
    const std::string suffix = "/reference";
    const bool relative = name.size() > suffix.size() &&
                          name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
    const std::string plain = relative ? name.substr(0, name.size() - suffix.size()) : name;
    const auto found = o.value.find(plain);
    if (found == o.value.end())
      return false;
    v = found->second;
    if (relative)
      v /= reference.value.at(plain);
    return true;
  };
  if (o.exit == 70)
    add("our own mistake: " + o.said);
  if (const auto found = o.value.find("finite"); found != o.value.end() && found->second != 1)
    add("not finite");
  bool exit_named = false;
  for (const auto& [name, bound] : c.pass.items()) {
    if (name == "exit") {
      exit_named = true;
      if (std::find(bound.begin(), bound.end(), io::Json(o.exit)) == bound.end())
        add("exit " + std::to_string(o.exit) + (o.said.empty() ? "" : " (" + o.said + ")"));
      continue;
    }
    if (name == "says") {
      if (o.exit != 0 && !std::regex_search(o.said, std::regex(bound.get<std::string>())))
        add("says \"" + o.said + "\"");
      continue;
    }
    double v = 0;
    if (!value_of(name, v)) {
      if (o.exit != 3)
        add("no " + name); // refused input measures nothing
      continue;
    }
    const double low = bound.is_number() ? bound.get<double>() : bound.value("min", -1e300);
    const double high = bound.is_number() ? bound.get<double>() : bound.value("max", 1e300);
    if (!(v >= low && v <= high))
      add(name + " " + short_text(v));
  }
  if (!exit_named && o.exit != 0)
    add("exit " + std::to_string(o.exit) + " (" + o.said + ")");
  return broken;
}

} // namespace

Case read_case(const std::string& path) {
  const io::Json json = io::read_document(path, "hard-case", 1);
  const io::Node node(json, path);
  node.allow_only({"format", "version", "name", "elsewhere", "invariant", "scene", "parameters",
                   "sweep", "pass", "reference", "seeds", "ci", "cpu_s", "failing"});
  Case c;
  c.file = std::filesystem::path(path).stem().string();
  c.name = node.at("name").string();
  c.elsewhere = node.at("elsewhere").string();
  c.invariant = node.at("invariant").string();
  c.scene = node.at("scene").string();
  if (!scenes().count(c.scene))
    node.at("scene").fail("hard.bad-scene"_id, "is no scene");
  c.parameters = json.value("parameters", io::Json::object());
  c.pass = json.value("pass", io::Json::object());
  c.reference = json.value("reference", io::Json());
  c.points = make_points(json.value("sweep", io::Json::object()));
  c.seeds = node.integer("seeds", 20);
  c.cpu_s = node.number("cpu_s", 60);
  const io::Json ci = json.value("ci", io::Json::object());
  c.ci_seeds = ci.value("seeds", 1);
  if (ci.contains("points"))
    c.ci_points = ci["points"].get<std::vector<std::size_t>>();
  else
    c.ci_points = {0};
  for (std::size_t k : c.ci_points)
    if (k >= c.points.size())
      node.at("ci").fail("hard.bad-scene"_id, "names a point that the sweep does not have");
  for (const io::Json& f : json.value("failing", io::Json::array())) {
    bool met = false;
    for (Point& p : c.points) {
      const io::Json at = f.value("at", io::Json::object());
      const bool same = std::all_of(at.items().begin(), at.items().end(), [&](const auto& item) {
        return p.overrides.value(item.key(), io::Json()) == item.value();
      });
      if (same)
        p.failing = f.at("why").get<std::string>();
      met |= same;
    }
    if (!met)
      node.at("failing").fail("hard.bad-scene"_id, "names no point of the sweep");
  }
  return c;
}

std::vector<Case> read_cases(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".json")
      paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  std::vector<Case> cases;
  for (const std::string& path : paths)
    cases.push_back(read_case(path));
  return cases;
}

Verdict run_point(const Case& c, const Point& point, std::uint64_t seed, int threads) {
  Verdict v;
  const io::Json parameters = merged(c.parameters, point.overrides);
  v.outcome = run_apart(c, parameters, seed, threads, v.broken);
  Outcome reference;
  if (v.broken.empty() && !c.reference.is_null())
    reference = run_apart(c, merged(parameters, c.reference), seed, threads, v.broken);
  if (v.broken.empty())
    v.broken = check_bounds(c, v.outcome, reference);
  return v;
}

} // namespace sloper::hard
