/// Any bytes as each document that people write or tools leave: body, pose, landmark rules, scene.
#include "../targets.hpp"

#include <garment/scene.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include <string>

namespace {

/// A file that is only in memory: these readers take a path.
class MemoryFile {
public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : m_file(memfd_create("fuzz", 0)) {
    if (m_file < 0 || write(m_file, data, size) != static_cast<ssize_t>(size)) _exit(3);
  }
  ~MemoryFile() { close(m_file); }
  MemoryFile(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(m_file); }

private:
  int m_file;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  sloper::fuzz::read_document_file(file.path());
  try {
    sloper::garment::read_scene(file.path());
  } catch (const sloper::Error&) {}
  return 0;
}
