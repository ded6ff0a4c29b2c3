/// run-hard: every case over its sweep and seeds; prints the table, writes it as Markdown; exit 1
/// when something breaks that is not listed as failing, or something listed holds. --hashes keeps
/// each point's final state as two hashes, to compare builds. --kept keeps each run as it ends and
/// does not do it again.
#include "hard_case.hpp"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <sloper/base/error.hpp>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

using namespace sloper;
using namespace sloper::hard;

namespace {

struct Options {
  std::string cases = SLOPER_SOURCE_DIR "/tests/hard/cases", only, table, hashes, kept;
  int seeds = 0, jobs = 1;
  bool verbose = false;
};

/// One point over all its seeds.
struct Result {
  int runs = 0, held = 0;
  bool same_bytes = true, has_bytes = false;
  std::string broken; ///< of the first seed that broke
  double cpu_s = 0;   ///< the longest
  std::string hashes; ///< of the first seed: strict, quantised
};

/// Runs that were done before, by case, point and seed; new ones are added to the file as they end,
/// so that a run can be broken off.
class Kept {
public:
  explicit Kept(const std::string& path) : m_path(path) {
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);)
      if (const io::Json j = io::Json::parse(line, nullptr, false); !j.is_discarded())
        m_runs[j["run"].get<std::string>()] = j;
  }
  const io::Json* find(const std::string& key) const {
    const auto found = m_runs.find(key);
    return found == m_runs.end() ? nullptr : &found->second;
  }
  void add(const io::Json& run) const {
    if (!m_path.empty())
      std::ofstream(m_path, std::ios::app)
          << run.dump(-1, ' ', true, io::Json::error_handler_t::replace) + "\n"
          << std::flush;
  }

private:
  std::string m_path;
  std::map<std::string, io::Json> m_runs;
};

/// One run, and for the first seed the same again with two threads.
io::Json run_once(const Case& c, const Point& point, int seed, const std::string& key,
                  bool verbose) {
  const Verdict v = run_point(c, point, static_cast<std::uint64_t>(seed));
  if (verbose) {
    std::string text;
    for (const auto& [name, value] : v.outcome.value)
      text += " " + name + "=" + std::to_string(value);
    std::fprintf(stderr, "  %s [%s] seed %d: %s exit %d%s said \"%s\" %s\n", c.file.c_str(),
                 point.name.c_str(), seed, v.broken.empty() ? "holds" : "BREAKS", v.outcome.exit,
                 text.c_str(), v.outcome.said.c_str(), v.broken.c_str());
  }
  const auto cpu = v.outcome.value.find("cpu_s");
  io::Json out = {{"run", key},
                  {"broken", v.broken},
                  {"cpu", cpu == v.outcome.value.end() ? 0.0 : cpu->second},
                  {"hash", v.outcome.hash},
                  {"quantised", v.outcome.quantised}};
  if (seed == 0 && !v.outcome.hash.empty())
    out["same"] = run_point(c, point, 0, 2).outcome.hash == v.outcome.hash;
  return out;
}

Result run(const Case& c, const Point& point, int seeds, bool verbose, const Kept& kept) {
  Result r;
  for (int seed = 0; seed < seeds; ++seed) {
    const std::string key = c.file + " [" + point.name + "] " + std::to_string(seed);
    io::Json one;
    if (const io::Json* before = kept.find(key)) {
      one = *before;
    } else {
      one = run_once(c, point, seed, key, verbose);
      kept.add(one);
    }
    const std::string broken = one["broken"];
    ++r.runs;
    r.held += broken.empty();
    if (!broken.empty() && r.broken.empty())
      r.broken = "seed " + std::to_string(seed) + ": " + broken;
    r.cpu_s = std::max(r.cpu_s, one["cpu"].get<double>());
    if (one.contains("same")) { // the same bytes again, with two threads
      r.has_bytes = true;
      r.hashes = one["hash"].get<std::string>() + " " + one["quantised"].get<std::string>();
      r.same_bytes = one["same"];
    }
  }
  return r;
}

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string a = argv[i];
    auto next = [&] {
      if (i + 1 == argc)
        throw Error(ErrorKind::USAGE, "hard.option"_id, "", a, "needs a value");
      return std::string(argv[++i]);
    };
    if (a == "--cases")
      o.cases = next();
    else if (a == "--only")
      o.only = next();
    else if (a == "--seeds")
      o.seeds = std::stoi(next());
    else if (a == "--jobs")
      o.jobs = std::stoi(next());
    else if (a == "--table")
      o.table = next();
    else if (a == "--hashes")
      o.hashes = next();
    else if (a == "--kept")
      o.kept = next();
    else if (a == "-v")
      o.verbose = true;
    else
      throw Error(ErrorKind::USAGE, "hard.option"_id, "", a, "is not known",
                  "run-hard [--cases DIR] [--only NAME] [--seeds N] [--jobs N] [--table FILE] "
                  "[--hashes FILE] [--kept FILE] [-v]");
  }
  return o;
}

std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\\|");
  for (char& ch : text)
    if (ch == '\n')
      ch = ' ';
  return text;
}

int main_of(const Options& o) {
  std::vector<Case> cases;
  for (Case& c : read_cases(o.cases))
    if (o.only.empty() || c.file.find(o.only) != std::string::npos)
      cases.push_back(std::move(c));
  std::vector<std::pair<const Case*, const Point*>> points;
  for (const Case& c : cases)
    for (const Point& p : c.points)
      points.emplace_back(&c, &p);

  const Kept kept(o.kept);
  // Workers take every jobs-th point and leave their results in a file each.
  std::vector<FILE*> files;
  std::vector<pid_t> workers;
  for (int w = 0; w < o.jobs; ++w) {
    files.push_back(std::tmpfile());
    const pid_t pid = fork();
    if (pid == 0) {
      for (std::size_t i = static_cast<std::size_t>(w); i < points.size();
           i += static_cast<std::size_t>(o.jobs)) {
        const auto& [c, p] = points[i];
        const Result r =
            run(*c, *p, o.seeds > 0 ? std::min(o.seeds, c->seeds) : c->seeds, o.verbose, kept);
        const io::Json line = {{"i", i},
                               {"runs", r.runs},
                               {"held", r.held},
                               {"same", r.same_bytes},
                               {"bytes", r.has_bytes},
                               {"broken", r.broken},
                               {"cpu", r.cpu_s},
                               {"hashes", r.hashes}};
        std::fprintf(files[w], "%s\n",
                     line.dump(-1, ' ', true, io::Json::error_handler_t::replace).c_str());
        std::fprintf(stderr, "%zu/%zu %s [%s]: %d of %d%s\n", i + 1, points.size(), c->file.c_str(),
                     p->name.c_str(), r.held, r.runs,
                     r.broken.empty() ? "" : (", " + r.broken).c_str());
      }
      std::fflush(files[w]);
      _exit(0);
    }
    workers.push_back(pid);
  }
  std::vector<Result> results(points.size());
  for (std::size_t w = 0; w < workers.size(); ++w) {
    waitpid(workers[w], nullptr, 0);
    std::rewind(files[w]);
    std::string text;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, files[w])) > 0;)
      text.append(buffer, n);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const io::Json j = io::Json::parse(line);
      Result& r = results[j["i"].get<std::size_t>()];
      r = {j["runs"], j["held"], j["same"], j["bytes"], j["broken"], j["cpu"], j["hashes"]};
    }
  }

  std::ostringstream table, failing;
  table << "| case | goes wrong elsewhere | what must hold | held | same bytes, 1 and 2 threads | "
           "most CPU s |\n|---|---|---|---|---|---|\n";
  int wrong = 0, whole = 0, runs = 0, held = 0;
  for (std::size_t i = 0; i < points.size();) {
    const Case& c = *points[i].first;
    int n = 0, good = 0;
    bool same = true, bytes = false;
    double cpu = 0;
    for (; i < points.size() && points[i].first == &c; ++i) {
      const Result& r = results[i];
      const Point& p = *points[i].second;
      n += r.runs;
      good += r.held;
      same = same && r.same_bytes;
      bytes = bytes || r.has_bytes;
      cpu = std::max(cpu, r.cpu_s);
      const bool breaks = r.held < r.runs || r.runs == 0;
      if (breaks) {
        failing << "- **" << c.name << "**" << (p.name.empty() ? "" : " at " + p.name) << ": "
                << r.held << " of " << r.runs << " hold; " << cell(r.broken)
                << (p.failing.empty() ? " **(not listed)**" : ". " + p.failing) << "\n";
        if (p.failing.empty())
          ++wrong;
      } else if (!p.failing.empty()) {
        std::printf("%s [%s] is listed as failing and holds: take it off the list\n",
                    c.file.c_str(), p.name.c_str());
        if (o.seeds == 0)
          ++wrong;
      }
      if (!r.same_bytes) {
        std::printf("%s [%s]: other bytes with two threads\n", c.file.c_str(), p.name.c_str());
        ++wrong;
      }
    }
    runs += n;
    held += good;
    whole += good == n;
    char seconds[16];
    std::snprintf(seconds, sizeof seconds, "%.1f", cpu);
    std::string same_bytes = "-";
    if (bytes)
      same_bytes = same ? "yes" : "**no**";
    table << "| " << cell(c.name) << " | " << cell(c.elsewhere) << " | " << cell(c.invariant)
          << " | " << good << " of " << n << " | " << same_bytes << " | " << seconds << " |\n";
  }
  std::ostringstream head;
  head << cases.size() << " cases, " << points.size() << " points, " << runs << " runs: " << held
       << " hold; " << whole << " cases hold throughout.";
  const std::string tail =
      failing.str().empty() ? "" : "\n## What does not hold yet\n\n" + failing.str();
  std::printf("%s\n\n%s%s", head.str().c_str(), table.str().c_str(), tail.c_str());
  if (!o.hashes.empty()) {
    std::ofstream out(o.hashes);
    for (std::size_t i = 0; i < points.size(); ++i)
      out << points[i].first->file << " [" << points[i].second->name << "] " << results[i].hashes
          << "\n";
  }
  if (!o.table.empty()) {
    std::ofstream out(o.table);
    out << "# Hard cases\n\nMade by `make hard` from `tests/hard/cases`: every case over its "
           "sweep, each point from 20 jittered starts (fewer where said by "
           "the\n"
           "count), each run in a process of its own with a limit of CPU time. A case holds when "
           "the state is finite, the exit code is right, the\n"
           "report says what happened, and what stands under \"must hold\" is within its "
           "bounds.\n\n**"
        << head.str() << "**\n\n"
        << table.str() << tail;
  }
  return wrong ? 1 : 0;
}

} // namespace

int main(int argc, char** argv) {
  try {
    return main_of(parse(argc, argv));
  } catch (const Error& e) {
    std::fprintf(stderr, "run-hard: %s\n", e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    std::fprintf(stderr, "run-hard: %s\n", e.what());
    return 70;
  }
}
