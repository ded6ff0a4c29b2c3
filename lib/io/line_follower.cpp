#include <sloper/base/error.hpp>
#include <sloper/io/line_follower.hpp>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace sloper::io {
namespace {

constexpr int NAP_MS = 5; // between looks at a file that may grow

} // namespace

LineFollower::LineFollower(const std::string& path) : m_stream(path == "-") {
  m_file = m_stream ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (m_file < 0)
    throw input_error("file.cannot-read"_id, path, "",
                      std::string("cannot be read: ") + std::strerror(errno));
}

LineFollower::~LineFollower() {
  if (!m_stream && m_file >= 0)
    close(m_file);
}

bool LineFollower::fill() {
  char block[65536];
  const ssize_t n = read(m_file, block, sizeof block);
  if (n > 0)
    m_buffer.append(block, static_cast<std::size_t>(n));
  if (n == 0 && m_stream)
    m_closed = true;
  return n > 0;
}

std::optional<std::string> LineFollower::take() {
  const std::size_t end = m_buffer.find('\n', m_searched);
  if (end == std::string::npos && !(m_closed && !m_buffer.empty())) {
    m_searched = m_buffer.size();
    return {};
  }
  std::string line = m_buffer.substr(0, end);
  m_buffer.erase(0, end == std::string::npos ? end : end + 1);
  m_searched = 0;
  if (!line.empty() && line.back() == '\r')
    line.pop_back();
  ++m_line;
  return line;
}

std::optional<std::string> LineFollower::next(int wait_ms) {
  for (;;) {
    if (auto line = take())
      return line;
    if (m_closed)
      return {};
    if (m_stream) { // read() would wait without end
      pollfd ready{m_file, POLLIN, 0};
      if (poll(&ready, 1, wait_ms) <= 0)
        return {};
      fill();
      continue;
    }
    if (fill())
      continue;
    if (wait_ms <= 0)
      return {};
    const int nap = std::min(wait_ms, NAP_MS);
    poll(nullptr, 0, nap);
    wait_ms -= nap;
  }
}

} // namespace sloper::io
