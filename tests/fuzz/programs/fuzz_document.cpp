/// Any bytes as each document that people write or tools leave: body, pose, landmark rules, scene.
#include "../targets.hpp"
#include "memory_file.hpp"

#include <sloper/garment/scene/scene.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const sloper::fuzz::MemoryFile file(data, size);
  sloper::fuzz::read_document_file(file.path());
  try {
    sloper::garment::read_scene(file.path());
  } catch (const sloper::Error&) {}
  return 0;
}
