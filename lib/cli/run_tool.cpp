#include <sloper/cli/run_tool.hpp>

#include <CLI/CLI.hpp>
#include <cli/option_table.hpp>
#include <cli/spare_files.hpp>
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
#include <optional>

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
  std::string shell_asked, messages = "text";
  int threads = -1; ///< -1: not given
  Impl(const std::string& n, const std::string& s) : name(n), summary(s), app(s, n), reporter(n) {}
  /// The exit status of everything but a signal. Catches all.
  int run(int argc, char** argv, const std::function<int()>& body);
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
  CLI::Option* messages =
      m.app.add_option("--messages", m.messages,
                       "how stderr speaks: text, or json, where each line is one object with "
                       "level, lasting id and text (see docs/messages.md)");
  Option(messages->group(common)).check(one_of({"text", "json"}));
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
Reporter& Tool::reporter() {
  return m_impl->reporter;
}
void Tool::tell(const std::string& line) {
  m_impl->reporter.tell(line);
}
const std::string& Tool::name() const {
  return m_impl->name;
}
void Tool::require_not_stopped(const std::string& output) const {
  if (m_impl->reporter.stop_requested())
    throw Error(ErrorKind::FAILED, "general.stopped"_id, output, "",
                "stopped by the user; nothing is written");
}
void Tool::example(const std::string& command_line, const std::string& what) {
  m_impl->examples.push_back({command_line, what});
}
void Tool::formats(const std::string& read, const std::string& written) {
  m_impl->reads = read;
  m_impl->writes = written;
}

static Error usage_error(MessageId id, const std::string& fact, const std::string& next_step = {}) {
  return {ErrorKind::USAGE, id, "", "", fact, next_step};
}

static Error unknown_option(const CLI::App& app, const std::string& given) {
  std::vector<std::string> known;
  for (const OptionRow& row : option_rows(app))
    for (const std::string& l : row.longs)
      known.push_back("--" + l);
  return usage_error("option.unknown"_id,
                     "unknown option " + given +
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
/// @param reporter  speaks from then on as --messages and -v ask, of the command line's faults too
static Request check_words(const CLI::App& app, const std::vector<std::string>& words,
                           ToolReporter& reporter) {
  Request request;
  auto takes_value = [](const CLI::Option* option) { return option->get_items_expected_max() > 0; };
  auto note = [&](const CLI::Option* option, const std::string& value) {
    if (option->get_lnames().empty())
      return;
    const std::string& name = option->get_lnames().front();
    if (name == "messages")
      reporter.as_json = value == "json";
    if (name == "verbose")
      reporter.verbose = true;
    if (!request.option.empty())
      return;
    for (const char* special :
         {"help", "version", "json-usage", "generate-man", "generate-completion"})
      if (name == special)
        request = {name, value};
  };
  std::optional<Error> failure;
  auto fail = [&](const Error& error) {
    if (!failure)
      failure = error;
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--")
      break;
    if (word.size() < 2 || word[0] != '-')
      continue;
    if (word[1] == '-') {
      const std::size_t equals = word.find('=');
      const std::string name = word.substr(0, equals);
      const CLI::Option* option = app.get_option_no_throw(name);
      if (!option)
        fail(unknown_option(app, name));
      else if (!takes_value(option))
        note(option, "");
      else if (equals != std::string::npos)
        note(option, word.substr(equals + 1));
      else if (++i < words.size())
        note(option, words[i]);
      else
        fail(usage_error("option.needs-value"_id, name + " needs a value"));
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
      if (!takes_value(option))
        continue;
      if (k + 1 == word.size() && ++i == words.size())
        fail(usage_error("option.needs-value"_id, name + " needs a value"));
      break;
    }
  }
  if (request.option.empty() && failure)
    throw *failure;
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

static std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos)
    return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// Minutes of work must not end in a folder that does not exist.
static void check_outputs(CLI::App& app) {
  for (CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    const auto& longs = option->get_lnames();
    const bool output =
        is_written(option) || std::find(longs.begin(), longs.end(), "output") != longs.end();
    if (!output)
      continue;
    for (const std::string& path : option->results()) {
      if (path == "-")
        continue;
      struct stat info {};
      if (stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode))
        throw Error(ErrorKind::OUTPUT, "file.is-folder"_id, path, "", "is a folder, not a file",
                    "name a file");
      const std::string folder = folder_of(path);
      if (stat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode))
        throw Error(ErrorKind::OUTPUT, "file.no-folder"_id, path, "",
                    "cannot write: there is no folder " + folder, "make it first");
      if (access(folder.c_str(), W_OK) != 0)
        throw Error(ErrorKind::OUTPUT, "file.cannot-write"_id, path, "",
                    "cannot write in folder " + folder + ": " + std::strerror(errno));
    }
  }
}

static void report_options(CLI::App& app, Reporter& reporter) {
  for (CLI::Option* option :
       app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); })) {
    if (option->count() == 0)
      continue;
    std::string values;
    for (const std::string& value : option->results())
      values += " " + value;
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
  if (!tool.reads.empty())
    out += "reads: " + tool.reads + "\n";
  if (!tool.writes.empty())
    out += "writes: " + tool.writes + "\n";
  return out + "Sloper, Apache License 2.0\n";
}

static std::string answer_request(const Request& request, const ToolDescription& tool) {
  if (request.option == "help")
    return help_text(tool);
  if (request.option == "version")
    return version_text(tool);
  if (request.option == "json-usage")
    return json_usage(tool);
  if (request.option == "generate-man")
    return man_page(tool);
  return completion(tool, request.value);
}

static std::string example_of(const std::vector<Example>& examples) {
  return examples.empty() ? "" : "example: " + examples.front().command_line;
}

/// CLI11's "--size: At Most 1 required but received 2" and "--output is required" in words that say
/// what to do.
static Error parse_error(const std::string& text, const std::vector<Example>& examples) {
  const std::string is_required = " is required";
  const std::size_t twice = text.find(": At Most 1 required but received ");
  const std::size_t missing = text.rfind(is_required);
  if (twice != std::string::npos)
    return usage_error("option.repeated"_id, text.substr(0, twice) + " is given more than once",
                       "give it once");
  if (missing == std::string::npos || missing + is_required.size() != text.size())
    return usage_error("option.wrong-value"_id, text);
  return usage_error("option.missing"_id, text.substr(0, missing) + " is missing",
                     example_of(examples));
}

static int parse_and_run(CLI::App& app, const std::vector<std::string>& words,
                         const std::vector<Example>& examples, Reporter& reporter,
                         const std::function<void()>& parsed, const std::function<int()>& body) {
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend())); // CLI11 wants them reversed
  } catch (const CLI::ExtrasError&) {
    std::string extra;
    for (const std::string& word : app.remaining())
      extra += (extra.empty() ? "" : ", ") + word;
    throw usage_error("option.unexpected-argument"_id, "unexpected argument " + extra,
                      example_of(examples));
  } catch (const CLI::ParseError& error) {
    throw parse_error(error.what(), examples);
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

/// All that was printed must have gone out: a full disk is an error, a reader that left is none.
static void finish_output() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good())
    return;
  struct stat info {};
  if (fstat(STDOUT_FILENO, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode)))
    return;
  throw Error(ErrorKind::OUTPUT, "file.cannot-write"_id, "standard output", "",
              std::string("cannot write: ") + std::strerror(errno));
}

static const char* const REPORT_IT = "please report it with the command line";

int Tool::Impl::run(int argc, char** argv, const std::function<int()>& body) {
  const std::string hint = "Try '" + name + " --help'.";
  try {
    tighten(app);
    const std::vector<std::string> words(argv + 1, argv + std::max(1, argc));
    if (words.empty()) {
      std::fprintf(stderr, "Usage: %s\n%s.\n%s\n", description().usage().c_str(), summary.c_str(),
                   hint.c_str());
      return static_cast<int>(ErrorKind::USAGE);
    }
    const Request request = check_words(app, words, reporter);
    if (!request.option.empty()) {
      io::write_file("-", answer_request(request, description()));
      return 0;
    }
    auto parsed = [this] {
      reporter.show_progress = !no_progress;
      int count = threads;
      if (threads < 0)
        count = std::min(available_processors(), MOST_DEFAULT_THREADS);
      if (threads == 0)
        count = available_processors();
      set_thread_count(count);
    };
    const int code = parse_and_run(app, words, examples, reporter, parsed, body);
    reporter.clear_line();
    finish_output();
    return code;
  } catch (const Error& error) {
    reporter.error(error, error.kind() == ErrorKind::USAGE ? hint : "");
    return error.exit_code();
  } catch (const std::bad_alloc&) {
    reporter.error({ErrorKind::INTERNAL, "general.out-of-memory"_id, "", "", "out of memory"}, "");
  } catch (const std::exception& error) {
    reporter.error({ErrorKind::INTERNAL, "general.internal"_id, "", "", error.what(), REPORT_IT},
                   "");
  } catch (...) {
    reporter.error({ErrorKind::INTERNAL, "general.internal"_id, "", "",
                    "an exception of unknown type", REPORT_IT},
                   "");
  }
  return static_cast<int>(ErrorKind::INTERNAL);
}

int Tool::run(int argc, char** argv, const std::function<int()>& body) {
  install_signal_handlers();
  const int code = m_impl->run(argc, argv, body);
  end_by_stop_signal();
  return code;
}

} // namespace sloper::cli
