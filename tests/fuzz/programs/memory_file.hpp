#pragma once
/// Files that are only in memory, for readers that take a path.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <string>

namespace sloper::fuzz {

class MemoryFile {
public:
  /// @param number  of the descriptor, and so the file's name; -1: any
  MemoryFile(const void* data, std::size_t size, int number = -1)
      : m_file(memfd_create("fuzz", 0)) {
    if (m_file < 0 || write(m_file, data, size) != static_cast<ssize_t>(size))
      _exit(3);
    if (number < 0)
      return;
    if (dup2(m_file, number) != number)
      _exit(3);
    close(m_file);
    m_file = number;
  }
  ~MemoryFile() { close(m_file); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(m_file); }

private:
  int m_file;
};

} // namespace sloper::fuzz
