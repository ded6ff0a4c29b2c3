/// girths SCAN: measures a scan with Sloper's libraries, as a program outside Sloper does it.
#include <sloper/base/error.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/io/scan_reader.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "Usage: girths SCAN\n");
    return 2;
  }
  try {
    const sloper::io::Scan scan = sloper::io::read_scan(argv[1]);
    const auto measured =
        sloper::body::measure_scan(scan.mesh, argv[1], scan.sha256, {}, sloper::silent_reporter());
    for (const auto& [name, girth] : measured.body.girths)
      std::printf("%-20s %6.1f cm\n", name.c_str(), 100 * girth.value_m);
    for (const auto& [name, level] : measured.body.levels)
      std::printf("%-20s %6.1f cm\n", name.c_str(), 100 * level.girth_m);
  } catch (const sloper::Error& error) {
    std::fprintf(stderr, "girths: %s\n", error.what());
    return error.exit_code();
  }
}
