/// A program with every kind of option, to test lib/cli without the real tools: it does what --do
/// says.
#include <sloper/cli/run_tool.hpp>
#include <sloper/io/files.hpp>

#include <chrono>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <thread>

using namespace sloper;

int main(int argc, char** argv) {
  cli::Tool tool("probe-tool", "Do what a test asks for");
  std::string input, deed = "nothing", output, accuracy;
  double length = 0.01, bare = 0;
  int count = 1;
  std::vector<std::string> set, operands;
  tool.option("INPUT", operands, "files to read").check(cli::input_file());
  tool.option("--body", input, "a file to read").check(cli::input_file());
  tool.option("--do", deed, "what to do");
  tool.option("--accuracy", accuracy, "how exact")
      .check(cli::one_of({"draft", "standard", "fine"}));
  tool.option("--edge-length", length, "length of an edge")
      .type_name("M")
      .check(cli::finite_in(0.001, 1, "m"));
  tool.option("--bare", bare, "a number whose author forgot the range check");
  tool.option("--count", count, "a whole number");
  tool.option("--set", set, "KNOB=VALUE");
  tool.option("-o,--output", output, "a file to write").required().check(cli::output_file());
  tool.example("probe-tool --do nothing -o out.txt", "do nothing");
  tool.formats("text", "text (version 1)");
  return tool.run(argc, argv, [&] {
    if (deed == "input")
      throw input_error("probe.input"_id, "a.obj", "line 3", "is wrong", "mend it");
    if (deed == "usage")
      throw Error(ErrorKind::USAGE, "probe.usage"_id, "", "", "these two do not go together");
    if (deed == "fail")
      throw Error(ErrorKind::FAILED, "probe.failed"_id, "", "", "did not come to rest");
    if (deed == "memory")
      throw std::bad_alloc();
    if (deed == "bug")
      throw std::logic_error("index 7 of 5");
    if (deed == "no")
      return 1;
    if (deed == "wait") {
      for (int i = 0; i < 2000 && !tool.reporter().stop_requested(); ++i) {
        tool.reporter().progress("waiting", i / 2000.0);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      return tool.reporter().stop_requested() ? 4 : 0;
    }
    tool.reporter().warning({"probe.warning"_id, "a warning"});
    tool.reporter().info("an info");
    std::string text =
        "length " + std::to_string(length) + "\ncount " + std::to_string(count) + "\n";
    for (const std::string& s : set)
      text += "set " + s + "\n";
    for (const std::string& s : operands)
      text += "operand " + s + "\n";
    io::write_file(output, text);
    return 0;
  });
}
