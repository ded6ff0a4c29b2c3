#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace sloper::io {

static std::string read_descriptor(int fd, const std::string& name) {
  std::string bytes;
  struct stat info {};
  if (fstat(fd, &info) == 0) {
    if (S_ISDIR(info.st_mode))
      throw input_error("file.is-folder"_id, name, "", "is a folder, not a file");
    if (info.st_size > 0)
      bytes.reserve(static_cast<std::size_t>(info.st_size));
  }
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      throw input_error("file.cannot-read"_id, name, "",
                        std::string("cannot read: ") + std::strerror(errno));
    if (n == 0)
      return bytes;
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
}

std::string read_file(const std::string& path) {
  std::optional<std::string> bytes = read_file_if_there(path);
  if (!bytes)
    throw input_error("file.cannot-open"_id, path, "",
                      std::string("cannot open: ") + std::strerror(errno), "check the path");
  return std::move(*bytes);
}

std::optional<std::string> read_file_if_there(const std::string& path) {
  if (path == "-")
    return read_descriptor(STDIN_FILENO, "standard input");
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0 && (errno == ENOENT || errno == ENOTDIR))
    return {};
  if (fd < 0)
    throw input_error("file.cannot-open"_id, path, "",
                      std::string("cannot open: ") + std::strerror(errno), "check the path");
  try {
    std::string bytes = read_descriptor(fd, path);
    close(fd);
    return bytes;
  } catch (...) {
    close(fd);
    throw;
  }
}

static Error write_error(const std::string& name, const std::string& what, int reason,
                         const std::string& next_step = {}) {
  return {ErrorKind::OUTPUT, "file.cannot-write"_id, name, "", what + ": " + std::strerror(reason),
          next_step};
}

/// 0, or the errno of the write that failed.
static int write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return errno;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return 0;
}

/// Bytes into something that is no regular file (a device, a pipe): renaming would replace the
/// thing itself.
static void write_into(int fd, std::string_view bytes, const std::string& name) {
  const int reason = write_all(fd, bytes);
  if (reason != 0 && reason != EPIPE)
    throw write_error(name, "cannot write",
                      reason); // a reader that has seen enough is not an error
}

static int write_and_sync(int fd, std::string_view bytes) {
  int reason = write_all(fd, bytes);
  if (reason == 0 && fsync(fd) != 0 && errno != EINVAL && errno != EROFS)
    reason = errno; // some file systems cannot sync
  if (close(fd) != 0 && reason == 0)
    reason = errno;
  return reason;
}

void write_file(const std::string& path, std::string_view bytes) {
  if (path == "-")
    return write_into(STDOUT_FILENO, bytes, "standard output");
  struct stat info {};
  const bool exists = stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode))
    throw Error(ErrorKind::OUTPUT, "file.is-folder"_id, path, "", "is a folder, not a file",
                "name a file");
  if (exists && !S_ISREG(info.st_mode)) {
    const int fd = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd < 0)
      throw write_error(path, "cannot write", errno);
    try {
      write_into(fd, bytes, path);
    } catch (...) {
      close(fd);
      throw;
    }
    close(fd);
    return;
  }
  std::string target = path; // a link stays a link: what it points to is replaced
  if (char* resolved = exists ? realpath(path.c_str(), nullptr) : nullptr) {
    target = resolved;
    std::free(resolved);
  }
  const std::string temporary = target + ".tmp." + std::to_string(getpid());
  const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0)
    throw write_error(path, "cannot write", errno, "check that the folder exists and is writable");
  if (const int reason = write_and_sync(fd, bytes)) {
    unlink(temporary.c_str());
    throw write_error(path, "cannot write", reason);
  }
  if (std::rename(temporary.c_str(), target.c_str()) != 0) {
    const int reason = errno;
    unlink(temporary.c_str());
    throw write_error(path, "cannot rename into place", reason);
  }
}

std::string sha256(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1)
    throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", "", "SHA-256 is not available");
  std::string hex;
  for (unsigned int i = 0; i < length; ++i) {
    char pair[3];
    std::snprintf(pair, sizeof pair, "%02x", digest[i]);
    hex += pair;
  }
  return hex;
}

std::string numbered_path(const std::string& path, std::size_t k, std::size_t n) {
  std::string digits = std::to_string(k);
  digits.insert(0, std::to_string(n).size() - digits.size(), '0');
  const std::size_t dot = path.rfind('.'), slash = path.rfind('/');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash))
    return path + "-" + digits;
  return path.substr(0, dot) + "-" + digits + path.substr(dot);
}

} // namespace sloper::io
