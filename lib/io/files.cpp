#include <base/error.hpp>
#include <io/files.hpp>

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace sloper::io {

static std::string read_descriptor(int fd, const std::string& name) {
  std::string bytes;
  struct stat info {};
  if (fstat(fd, &info) == 0) {
    if (S_ISDIR(info.st_mode)) throw input_error(name, "", "is a folder, not a file");
    if (info.st_size > 0) bytes.reserve(static_cast<std::size_t>(info.st_size));
  }
  char buffer[1 << 16];
  for (;;) {
    const ssize_t n = read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw input_error(name, "", std::string("cannot read: ") + std::strerror(errno));
    if (n == 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(n));
  }
}

std::string read_file(const std::string& path) {
  if (path == "-") return read_descriptor(STDIN_FILENO, "standard input");
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw input_error(path, "", std::string("cannot open: ") + std::strerror(errno), "check the path");
  try {
    std::string bytes = read_descriptor(fd, path);
    close(fd);
    return bytes;
  } catch (...) {
    close(fd);
    throw;
  }
}

static void write_all(int fd, std::string_view bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t n = write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(ErrorKind::OUTPUT, name, "", std::string("cannot write: ") + std::strerror(errno));
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    try {
      write_all(STDOUT_FILENO, bytes, "standard output");
    } catch (const Error&) {
      if (errno != EPIPE) throw; // a reader that has seen enough is not an error
    }
    return;
  }
  const std::string temporary = path + ".tmp." + std::to_string(getpid());
  const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) throw Error(ErrorKind::OUTPUT, path, "", std::string("cannot write: ") + std::strerror(errno), "check that the folder exists and is writable");
  try {
    write_all(fd, bytes, path);
    if (fsync(fd) != 0 && errno != EINVAL && errno != EROFS) throw Error(ErrorKind::OUTPUT, path, "", std::string("cannot write: ") + std::strerror(errno));
  } catch (...) {
    close(fd);
    unlink(temporary.c_str());
    throw;
  }
  close(fd);
  if (std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    unlink(temporary.c_str());
    throw Error(ErrorKind::OUTPUT, path, "", std::string("cannot rename into place: ") + std::strerror(reason));
  }
}

std::string sha256(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1) throw Error(ErrorKind::INTERNAL, "", "", "SHA-256 is not available");
  std::string hex;
  for (unsigned int i = 0; i < length; ++i) {
    char pair[3];
    std::snprintf(pair, sizeof pair, "%02x", digest[i]);
    hex += pair;
  }
  return hex;
}

} // namespace sloper::io
