// Whole files, with POSIX calls: only they can tell a failed write from a good one, and make sure
// that the bytes are on the disk before the name points to them.

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <tuple>
#include <utility>

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;

/// Streams have no size; reading one without end must stop somewhere.
constexpr std::size_t kLongestStream = std::size_t{1} << 33;

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void fail_read(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::InvalidInput, name + ": cannot be read: " + why);
}

[[noreturn]] void fail_write(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::OutputFailed, name + ": cannot be written: " + why);
}

/// An open file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }
  /// Closes now. @return false with errno set when the system reports a late error.
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

/// Unlinks a file unless told to keep it.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  void keep() { path_.clear(); }

 private:
  fs::path path_;
};

std::vector<char> read_all(int fd, const std::string& name, std::size_t expected) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  std::vector<char> bytes(expected + 1);  // one more, to meet the end without growing
  std::size_t used = 0;
  for (;;) {
    if (used == bytes.size()) bytes.resize(used + std::max(used / 2, kChunk));
    const ssize_t n = ::read(fd, bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_read(name, reason(errno));
    if (n == 0) break;
    used += static_cast<std::size_t>(n);
    if (used > kLongestStream && used > expected)
      throw Error(ErrorCode::LimitReached, name + ": the stream is longer than 8 GiB; use a file");
  }
  bytes.resize(used);
  return bytes;
}

void write_all(int fd, std::span<const char> bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_write(name, reason(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

/// The open descriptor that names such as /dev/stdout and /dev/fd/3 stand for, or −1. Opening them
/// anew would start at the beginning of a redirected file, or replace it.
int descriptor_named_by(const fs::path& path) {
  const std::string name = path.string();
  if (name == "-" || name == "/dev/stdout") return STDOUT_FILENO;
  if (name == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view prefix : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!name.starts_with(prefix)) continue;
    int fd = -1;
    const auto [end, error] =
        std::from_chars(name.data() + prefix.size(), name.data() + name.size(), fd);
    if (error == std::errc() && end == name.data() + name.size()) return fd;
  }
  return -1;
}

/// Creates a file of its own in `target`'s directory.
std::pair<fs::path, int> create_beside(const fs::path& target, mode_t mode) {
  static std::atomic<std::uint64_t> counter{0};
  for (int attempt = 0; attempt < 1000; ++attempt) {
    // A fixed stem: the target's own name may be as long as the file system allows.
    fs::path path = target.parent_path() / (".kaboum-" + std::to_string(::getpid()) + "-" +
                                            std::to_string(counter++) + ".tmp");
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (fd >= 0) return {std::move(path), fd};
    if (errno != EEXIST) break;
  }
  const int error = errno;
  const std::string directory = target.parent_path().empty() ? "." : target.parent_path().string();
  std::error_code ignored;
  if (error == ENOENT && !fs::exists(directory, ignored))
    fail_write(target.string(),
               "the directory '" + directory + "' does not exist; create it first");
  fail_write(target.string(), "no file can be created in '" + directory + "': " + reason(error));
}

void replace_file(const fs::path& target, std::span<const char> bytes,
                  const struct stat* existing) {
  const std::string name = target.string();
  auto [path, fd] = create_beside(target, 0666);
  Descriptor file(fd);
  TemporaryFile temporary(path);
  // Replacing keeps the permissions; not being able to is no reason to lose the result.
  if (existing != nullptr) std::ignore = ::fchmod(file.get(), existing->st_mode & 07777U);
  write_all(file.get(), bytes, name);
  if (::fsync(file.get()) != 0 && errno != EINVAL && errno != ENOTSUP)
    fail_write(name, reason(errno));
  if (!file.close()) fail_write(name, reason(errno));
  if (::rename(path.c_str(), target.c_str()) != 0) fail_write(name, reason(errno));
  temporary.keep();
  // Makes the rename durable where the file system supports it.
  const fs::path directory = target.parent_path().empty() ? fs::path(".") : target.parent_path();
  const Descriptor parent(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (parent.get() >= 0) std::ignore = ::fsync(parent.get());
}

}  // namespace

std::vector<char> read_file(const fs::path& path) {
  if (path == "-") return read_all(STDIN_FILENO, "standard input", 0);
  const std::string name = path.string();
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail_read(name, reason(errno));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_read(name, reason(errno));
  if (S_ISDIR(status.st_mode)) fail_read(name, "it is a directory; name a file in it");
  const bool regular = S_ISREG(status.st_mode);
  return read_all(file.get(), name, regular ? static_cast<std::size_t>(status.st_size) : 0);
}

void write_file(const fs::path& path, std::span<const char> bytes) {
  const std::string name = path == "-" ? "standard output" : path.string();
  if (path.empty()) fail_write("''", "the name is empty; name a file");
  if (const int fd = descriptor_named_by(path); fd >= 0) return write_all(fd, bytes, name);
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail_write(name, "it is a directory; name a file in it");
  if (exists && !S_ISREG(status.st_mode)) {
    Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (device.get() < 0) fail_write(name, reason(errno));
    write_all(device.get(), bytes, name);
    if (!device.close()) fail_write(name, reason(errno));
    return;
  }
  // Behind a symbolic link, its target is replaced, not the link.
  std::error_code ignored;
  const fs::path target = exists ? fs::canonical(path, ignored) : path;
  replace_file(target.empty() ? path : target, bytes, exists ? &status : nullptr);
}

}  // namespace kaboum::io
