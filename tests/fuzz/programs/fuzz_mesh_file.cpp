#include "../targets.hpp"
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sloper::fuzz::read_mesh_file_bytes({reinterpret_cast<const char*>(data), size});
  return 0;
}
