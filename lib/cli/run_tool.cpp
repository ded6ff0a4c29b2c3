#include <sloper/cli/run_tool.hpp>

#include <CLI/CLI.hpp>
#include <cli/option_table.hpp>
#include <cli/tool_reporter.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/base/version.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json_fwd.hpp>

#include <sched.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>

namespace sloper::cli {

static constexpr int MOST_DEFAULT_THREADS =
    8; // a garment of some thousand vertices has no work for more

struct Tool::Impl {
  std::string name, summary, reads, writes;
  CLI::App app;
  std::vector<Example> examples;
  ToolReporter reporter;
  bool no_progress = false;
  bool version_asked = false, man_asked = false,
       json_usage_asked = false; ///< declared for the table; check_words() answers them
  std::string shell_asked;
  int threads = -1; ///< -1: not given
  Impl(const std::string& n, const std::string& s) : name(n), summary(s), app(s, n), reporter(n) {}
  ToolDescription description() const {
    return {name, summary, reads, writes, option_rows(app), examples};
  }
};

int available_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  int n = sched_getaffinity(0, sizeof set, &set) == 0
              ? CPU_COUNT(&set)
              : static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  std::string quota;
  double period = 0;
  if (std::ifstream("/sys/fs/cgroup/cpu.max") >> quota >> period && quota != "max" && period > 0)
    n = std::min(n, static_cast<int>(std::ceil(std::atof(quota.c_str()) / period)));
  return std::max(1, n);
}

Tool::Tool(const std::string& name, const std::string& summary)
    : m_impl(std::make_unique<Impl>(name, summary)) {
  Impl& m = *m_impl;
  const char* common = "Common options";
  m.app.set_help_flag("-h,--help", "show this help")->group(common);
  m.app.add_flag("-q,--quiet", m.reporter.quiet, "errors only")->group(common);
  m.app
      .add_flag("-v,--verbose", m.reporter.verbose,
                "say what is done, the options as resolved, time and memory")
      ->group(common);
  m.app.add_flag("-V,--version", m.version_asked, "show the version and the formats")
      ->group(common);
  m.app
      .add_flag("--no-progress", m.no_progress,
                "no progress line (there is none when stderr is not a terminal)")
      ->group(common);
  m.app
      .add_flag("--json-usage", m.json_usage_asked,
                "this help as JSON, for programs: options, values, ranges, exit statuses")
      ->group(common);
  CLI::Option* threads = m.app.add_option("--threads", m.threads,
                                          "threads, 0 for all processors; results do not depend on "
                                          "it (default: the processors, at most 8)");
  Option(threads->group(common)).check(finite_in(0, 1024, ""));
  m.app.add_flag("--generate-man", m.man_asked)->group("");
  m.app.add_option("--generate-completion", m.shell_asked)->group("");
}

Tool::~Tool() = default;
Option Tool::option(const std::string& names, std::string& value, const std::string& what) {
  return Option(m_impl->app.add_option(names, value, what));
}
Option Tool::option(const std::string& names, std::vector<std::string>& value,
                    const std::string& what) {
  return Option(m_impl->app.add_option(names, value, what));
}
Option Tool::option(const std::string& names, double& value, const std::string& what) {
  return Option(m_impl->app.add_option(names, value, what));
}
Option Tool::option(const std::string& names, int& value, const std::string& what) {
  return Option(m_impl->app.add_option(names, value, what));
}
Option Tool::flag(const std::string& names, bool& value, const std::string& what) {
  return Option(m_impl->app.add_flag(names, value, what));
}
Reporter& Tool::reporter() { return m_impl->reporter; }
const std::string& Tool::name() const { return m_impl->name; }
void Tool::example(const std::string& command_line, const std::string& what) {
  m_impl->examples.push_back({command_line, what});
}
void Tool::formats(const std::string& read, const std::string& written) {
  m_impl->reads = read;
  m_impl->writes = written;
}

static Error usage_error(const std::string& fact) { return {ErrorKind::USAGE, "", "", fact}; }

static Error unknown_option(const CLI::App& app, const std::string& given) {
  std::vector<std::string> known;
  for (const OptionRow& row : option_rows(app))
    for (const std::string& l : row.longs) known.push_back("--" + l);
  return usage_error("unknown option " + given +
                     (given.rfind("--", 0) == 0 ? did_you_mean(given, known, "") : ""));
}

/// What the command line asks for besides the tool's work: the first of these that is named wins
/// over all other options.
struct Request {
  std::string option; ///< "help", "version", "json-usage", "generate-man", "generate-completion" or
                      ///< empty
  std::string value;
};

/// Walks the words as getopt would, before CLI11 does: it reports an unknown option last and by
/// other names, and takes the value of a misspelt option for an operand.
static Request check_words(const CLI::App& app, const std::vector<std::string>& words) {
  Request request;
  auto takes_value = [](const CLI::Option* option) { return option->get_items_expected_max() > 0; };
  auto note = [&](const CLI::Option* option, const std::string& value) {
    if (!request.option.empty() || option->get_lnames().empty()) return;
    const std::string& name = option->get_lnames().front();
    for (const char* special :
         {"help", "version", "json-usage", "generate-man", "generate-completion"})
      if (name == special) request = {name, value};
  };
  std::string failure;
  auto fail = [&](const Error& error) {
    if (failure.empty()) failure = error.fact();
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--") break;
    if (word.size() < 2 || word[0] != '-') continue;
    if (word[1] == '-') {
      const std::size_t equals = word.find('=');
      const std::string name = word.substr(0, equals);
      const CLI::Option* option = app.get_option_no_throw(name);
      if (!option) fail(unknown_option(app, name));
      else if (!takes_value(option)) note(option, "");
      else if (equals != std::string::npos) note(option, word.substr(equals + 1));
      else if (++i < words.size()) note(option, words[i]);
      else fail(usage_error(name + " needs a value"));
      continue;
    }
    for (std::size_t k = 1; k < word.size(); ++k) {
      const std::string name = std::string("-") + word[k];
      const CLI::Option* option = app.get_option_no_throw(name);
      if (!option) {
        fail(unknown_option(app, name));
        break;
      }
      note(option, "");
      if (!takes_value(option)) continue;
      if (k + 1 == word.size() && ++i == words.size()) fail(usage_error(name + " needs a value"));
      break;
    }
  }
  if (request.option.empty() && !failure.empty()) throw usage_error(failure);
  return request;
}

/// What CLI11 does by default and we do not want: options that swallow the operands after them,
/// numbers that are not numbers.
static void tighten(CLI::App& app) {
  for (CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    if (!option->get_positional() && option->get_items_expected_max() > 1)
      option->allow_extra_args(false);
    const std::string type = option->get_type_name();
    const std::string plain = type.substr(0, type.find(':'));
    if ((plain == "FLOAT" || plain == "INT" || plain == "UINT") && type == plain) {
      Check finite = finite_in(-1e308, 1e308, "");
      finite.words.clear();
      Option(option).check(finite);
    }
  }
}

static bool has_validator(CLI::Option* option, const std::string& name) {
  try {
    return option->get_validator(name) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

/// Minutes of work must not end in a folder that does not exist.
static void check_outputs(CLI::App& app) {
  for (CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    const auto& longs = option->get_lnames();
    const bool output = has_validator(option, "output_file") ||
                        std::find(longs.begin(), longs.end(), "output") != longs.end();
    if (!output) continue;
    for (const std::string& path : option->results()) {
      if (path == "-") continue;
      struct stat info {};
      if (stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode))
        throw Error(ErrorKind::OUTPUT, path, "", "is a folder, not a file", "name a file");
      const std::size_t slash = path.rfind('/');
      const std::string folder = slash == std::string::npos ? "."
                                 : slash == 0               ? "/"
                                                            : path.substr(0, slash);
      if (stat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode))
        throw Error(ErrorKind::OUTPUT, path, "", "cannot write: there is no folder " + folder,
                    "make it first");
      if (access(folder.c_str(), W_OK) != 0)
        throw Error(ErrorKind::OUTPUT, path, "",
                    "cannot write in folder " + folder + ": " + std::strerror(errno));
    }
  }
}

/// The files of an option that is read ("input_file") or written ("output_file"), each with the
/// mesh that a document has beside it.
static std::vector<std::filesystem::path> files_of(CLI::Option* option,
                                                   const std::string& validator) {
  std::vector<std::filesystem::path> files;
  if (!has_validator(option, validator)) return files;
  for (const std::string& path : option->results()) {
    std::error_code absent;
    if (path == "-" ||
        (std::filesystem::exists(path, absent) && !std::filesystem::is_regular_file(path, absent)))
      continue;
    files.emplace_back(path);
    files.emplace_back(io::mesh_path_beside(path));
  }
  return files;
}

/// Nothing that is read is written over, and nothing is written twice. What goes on from a document
/// may take its place.
static void spare_files(CLI::App& app) {
  constexpr std::pair<const char*, const char*> GOES_ON[] = {{"--from", "--output"},
                                                             {"--from", "--checkpoint"},
                                                             {"--over", "--over-output"},
                                                             {"PATTERN", "--write-pattern"}};
  const auto same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code absent;
    return std::filesystem::equivalent(a, b, absent) ||
           std::filesystem::absolute(a, absent).lexically_normal() ==
               std::filesystem::absolute(b, absent).lexically_normal();
  };
  const auto options = app.get_options([](const CLI::Option*) { return true; });
  for (CLI::Option* writing : options)
    for (const std::filesystem::path& written : files_of(writing, "output_file"))
      for (CLI::Option* other : options) {
        const auto goes_on = [&](const auto& names) {
          return other->get_name(other->get_positional()) == names.first &&
                 writing->get_name() == names.second;
        };
        if (std::any_of(std::begin(GOES_ON), std::end(GOES_ON), goes_on)) continue;
        for (const std::filesystem::path& read : files_of(other, "input_file"))
          if (same(written, read))
            throw Error(
                ErrorKind::USAGE, written, writing->get_name(),
                "would be written over what " + other->get_name() + " reads" +
                    (written.extension() == ".obj" ? " (a mesh goes beside its document)" : ""),
                "name another output");
        if (other == writing) continue;
        for (const std::filesystem::path& twice : files_of(other, "output_file"))
          if (same(written, twice))
            throw Error(ErrorKind::USAGE, written, writing->get_name(),
                        "would be written by " + other->get_name() + " too", "name two files");
      }
}

static void report_options(CLI::App& app, Reporter& reporter) {
  for (CLI::Option* option :
       app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); })) {
    if (option->count() == 0) continue;
    std::string values;
    for (const std::string& value : option->results()) values += " " + value;
    reporter.info("option " + option->get_name() + values);
  }
  reporter.info("threads: " + std::to_string(thread_count()));
}

static void report_cost(Reporter& reporter, double wall) {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  char text[128];
  std::snprintf(text, sizeof text, "took %.2f s, %.2f s of CPU, at most %ld MB", wall,
                seconds(usage.ru_utime) + seconds(usage.ru_stime), usage.ru_maxrss / 1024);
  reporter.info(text);
}

static std::string version_text(const ToolDescription& tool) {
  std::string out = tool.name + " " + VERSION + "\n";
  if (!tool.reads.empty()) out += "reads: " + tool.reads + "\n";
  if (!tool.writes.empty()) out += "writes: " + tool.writes + "\n";
  return out + "Sloper, Apache License 2.0\n";
}

static std::string answer_request(const Request& request, const ToolDescription& tool) {
  if (request.option == "help") return help_text(tool);
  if (request.option == "version") return version_text(tool);
  if (request.option == "json-usage") return json_usage(tool);
  if (request.option == "generate-man") return man_page(tool);
  return completion(tool, request.value);
}

/// CLI11's "--size: At Most 1 required but received 2" and "--output is required" in words that say
/// what to do.
static std::string plain_words(const std::string& text, const std::vector<Example>& examples) {
  const std::size_t twice = text.find(": At Most 1 required but received "),
                    missing = text.rfind(" is required");
  if (twice != std::string::npos)
    return text.substr(0, twice) + " is given more than once; give it once";
  if (missing == std::string::npos || missing + 12 != text.size()) return text;
  return text.substr(0, missing) + " is missing" +
         (examples.empty() ? "" : "; example: " + examples.front().command_line);
}

static int parse_and_run(CLI::App& app, const std::vector<std::string>& words,
                         const std::vector<Example>& examples, Reporter& reporter,
                         const std::function<void()>& parsed, const std::function<int()>& body) {
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend())); // CLI11 wants them reversed
  } catch (const CLI::ExtrasError&) {
    std::string extra;
    for (const std::string& word : app.remaining()) extra += (extra.empty() ? "" : ", ") + word;
    throw usage_error("unexpected argument " + extra +
                      (examples.empty() ? "" : "; example: " + examples.front().command_line));
  } catch (const CLI::ParseError& error) {
    throw usage_error(plain_words(error.what(), examples));
  }
  parsed();
  check_outputs(app);
  spare_files(app);
  report_options(app, reporter);
  const auto start = std::chrono::steady_clock::now();
  const int code = body();
  report_cost(reporter,
              std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return code;
}

/// What was printed must have gone out: a full disk is told, a reader that left is no error.
static void finish_output() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return;
  struct stat info {};
  if (fstat(STDOUT_FILENO, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode)))
    return;
  throw Error(ErrorKind::OUTPUT, "standard output", "",
              std::string("cannot write: ") + std::strerror(errno));
}

int Tool::run(int argc, char** argv, const std::function<int()>& body) {
  Impl& m = *m_impl;
  install_signal_handlers();
  const std::string hint = "Try '" + m.name + " --help'.";
  try {
    tighten(m.app);
    const std::vector<std::string> words(argv + 1, argv + std::max(1, argc));
    if (words.empty()) {
      std::fprintf(stderr, "Usage: %s\n%s.\n%s\n", m.description().usage().c_str(),
                   m.summary.c_str(), hint.c_str());
      return static_cast<int>(ErrorKind::USAGE);
    }
    const Request request = check_words(m.app, words);
    if (!request.option.empty()) {
      io::write_file("-", answer_request(request, m.description()));
      return 0;
    }
    auto parsed = [&m] {
      m.reporter.show_progress = !m.no_progress;
      set_thread_count(m.threads > 0    ? m.threads
                       : m.threads == 0 ? available_processors()
                                        : std::min(available_processors(), MOST_DEFAULT_THREADS));
    };
    const int code = parse_and_run(m.app, words, m.examples, m.reporter, parsed, body);
    m.reporter.clear_line();
    finish_output();
    return code;
  } catch (const Error& error) {
    m.reporter.error((error.kind() == ErrorKind::INTERNAL ? "our bug: " : "") +
                     std::string(error.what()));
    if (error.kind() == ErrorKind::USAGE) std::fprintf(stderr, "%s\n", hint.c_str());
    return error.exit_code();
  } catch (const std::bad_alloc&) {
    m.reporter.error("out of memory");
  } catch (const std::exception& error) {
    m.reporter.error(std::string("our bug: ") + error.what() +
                     "; please report it with the command line");
  } catch (...) {
    m.reporter.error(
        "our bug: an exception of unknown type; please report it with the command line");
  }
  return static_cast<int>(ErrorKind::INTERNAL);
}

} // namespace sloper::cli
