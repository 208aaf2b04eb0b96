// A reader in a child process: fork, a pipe for the result, limits of memory and CPU time.
//
// fork copies the calling thread only; a lock that another thread holds at that moment stays locked
// in the child for ever. The child touches two kinds of locks. Those of the C library (malloc,
// stdio, the loader) are put in order by its fork. Those of the foreign importers are free: no
// thread of this process ever runs an importer outside such a child. Should a lock be held all the
// same, the child waits without using CPU time, and the deadline in real time ends it. posix_spawn
// of a helper program would need no such argument, but a library has no way to find the helper once
// it is linked into a program of somebody else.

#include "child.h"

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <mutex>
#include <type_traits>

namespace kaboum::io {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // their shadow memory takes terabytes of addresses
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
/// Real time may be this many times the CPU time allowed: the machine may be busy.
constexpr std::uint64_t kPatience = 20;

/// Bytes of addresses that the child may have altogether; 0: as many as it likes.
std::uint64_t address_limit(const ChildLimits& limits) {
  std::uint64_t pages = 0;
  if (kSanitized || !(std::ifstream("/proc/self/statm") >> pages)) return 0;
  return limits.memory + pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// --- the message: a kind, then an error's code and text, or the fields of a ReadResult ---

enum class Kind : std::uint8_t { Mesh, Bytes, Error, NoMemory, Exception };

class Sender {
 public:
  explicit Sender(int to) : to_(to) {}

  void bytes(const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t sent = ::write(to_, at, size);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) ::_exit(1);  // nobody listens
      at += sent;
      size -= static_cast<std::size_t>(sent);
    }
  }
  template <typename T>
  void value(T v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&v, sizeof(T));
  }
  void text(std::string_view t) {
    value(t.size());
    bytes(t.data(), t.size());
  }
  void mesh(const ReadResult& r) {
    value(Kind::Mesh);
    value(r.format);
    value(std::uint8_t{r.single_precision});
    for (const std::size_t n :
         {r.file_vertices, r.file_triangles, r.split_polygons, r.collapsed_triangles})
      value(n);
    value(r.notes.size());
    for (const std::string& note : r.notes) text(note);
    value(r.other_files.size());
    for (const std::string& file : r.other_files) text(file);
    text(r.unit);
    value(r.deviation);
    value(r.exact_faces);
    value(r.bent_polygons);
    value(r.largest_bend);
    value(r.bent_quads.size());
    bytes(r.bent_quads.data(), r.bent_quads.size() * sizeof(std::uint32_t));
    value(r.mesh.vertices.size());
    bytes(r.mesh.vertices.data(), r.mesh.vertices.size() * sizeof(geom::Vec3));
    value(r.mesh.triangles.size());
    bytes(r.mesh.triangles.data(), r.mesh.triangles.size() * sizeof(geom::Triangle));
  }

 private:
  int to_;
};

/// Takes a message apart. The child may have died in the middle of it, or its memory may be
/// damaged: nothing in it is believed unchecked.
class Receiver {
 public:
  explicit Receiver(std::string_view message) : left_(message) {}

  template <typename T>
  T value() {
    T v{};
    const std::string_view raw = take(sizeof(T));
    if (ok_) std::memcpy(&v, raw.data(), sizeof(T));
    return v;
  }
  std::string text() { return std::string(take(value<std::size_t>())); }

  ReadResult mesh() {
    ReadResult r;
    const auto format = value<std::underlying_type_t<Format>>();
    ok_ = ok_ && format >= 0 && format <= static_cast<int>(Format::Assimp);
    if (ok_) r.format = static_cast<Format>(format);
    r.single_precision = value<std::uint8_t>() != 0;
    for (std::size_t* n :
         {&r.file_vertices, &r.file_triangles, &r.split_polygons, &r.collapsed_triangles})
      *n = value<std::size_t>();
    for (auto n = value<std::size_t>(); n > 0 && ok_; --n) r.notes.push_back(text());
    for (auto n = value<std::size_t>(); n > 0 && ok_; --n) r.other_files.push_back(text());
    r.unit = text();
    r.deviation = value<double>();
    ok_ = ok_ && r.deviation >= 0 && r.deviation <= std::numeric_limits<double>::max();
    r.exact_faces = value<std::size_t>();
    r.bent_polygons = value<std::size_t>();
    r.largest_bend = value<double>();
    ok_ = ok_ && r.largest_bend >= 0;
    array(r.bent_quads);
    array(r.mesh.vertices);
    array(r.mesh.triangles);
    for (const geom::Vec3& p : r.mesh.vertices) ok_ = ok_ && p.allFinite();
    for (const geom::Triangle& t : r.mesh.triangles)
      for (const std::uint32_t corner : t) ok_ = ok_ && corner < r.mesh.vertices.size();
    ok_ = ok_ && !r.mesh.triangles.empty();
    for (const std::uint32_t quad : r.bent_quads)
      ok_ = ok_ && std::size_t{quad} + 1 < r.mesh.triangles.size();
    return r;
  }
  /// All of the message was there, and nothing more.
  [[nodiscard]] bool complete() const { return ok_ && left_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    ok_ = ok_ && size <= left_.size();
    if (!ok_) return {};
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }
  template <typename T>
  void array(std::vector<T>& values) {
    const auto n = value<std::size_t>();
    ok_ = ok_ && n <= left_.size() / sizeof(T);
    if (!ok_) return;
    values.resize(n);
    const std::string_view raw = take(n * sizeof(T));
    if (n > 0) std::memcpy(static_cast<void*>(values.data()), raw.data(), raw.size());
  }

  std::string_view left_;
  bool ok_ = true;
};

// --- the child ---

void set_limit(int which, std::uint64_t soft, std::uint64_t hard) {
  rlimit limit{};
  if (::getrlimit(static_cast<__rlimit_resource>(which), &limit) != 0) return;
  const auto lower = [](rlim_t present, std::uint64_t wished) {
    return present == RLIM_INFINITY ? static_cast<rlim_t>(wished)
                                    : std::min<rlim_t>(present, wished);
  };
  limit.rlim_max = lower(limit.rlim_max, hard);
  limit.rlim_cur = std::min(lower(limit.rlim_cur, soft), limit.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource>(which), &limit);
}

/// Signals kill, as they do in a new program; the caller's handlers are not for this process.
void reset_signals() {
  for (int s = 1; s < 32; ++s) {
    struct sigaction action {};
    if (::sigaction(s, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = SIG_DFL;
    ::sigaction(s, &action, nullptr);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

/// Ends by _exit: the caller's buffers, files and exit handlers are the caller's.
[[noreturn]] void run(int to, const ChildLimits& limits, std::uint64_t addresses,
                      const std::function<void(Sender&)>& work) {
  reset_signals();
  set_limit(RLIMIT_CORE, 0, 0);
  set_limit(RLIMIT_CPU, limits.seconds, limits.seconds + 1);
  if (addresses > 0) set_limit(RLIMIT_AS, addresses, addresses);
  // What an importer prints before it dies is not for the user.
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nothing >= 0) {
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
  }
  Sender sender(to);
  try {
    work(sender);
  } catch (const Error& e) {
    sender.value(Kind::Error);
    sender.value(e.code());
    sender.text(e.what());
  } catch (const std::bad_alloc&) {
    sender.value(Kind::NoMemory);
  } catch (const std::exception& e) {
    sender.value(Kind::Exception);
    sender.text(e.what());
  } catch (...) {
    sender.value(Kind::Exception);
    sender.text("unknown exception");
  }
  ::_exit(0);
}

// --- the parent ---

/// Closes a file descriptor at the end of its scope.
struct Descriptor {
  int fd;
  explicit Descriptor(int number) : fd(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void close() {
    if (fd >= 0) ::close(fd);
    fd = -1;
  }
};

/// Ends and reaps the child at the end of its scope, however that is left.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ > 0) {
      ::kill(id_, SIGKILL);
      wait();
    }
  }
  /// Its status; 0 when the caller's program reaps children itself.
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0) {
      if (errno == EINTR) continue;
      status = 0;
      break;
    }
    id_ = -1;
    return status;
  }

 private:
  pid_t id_;
};

enum class End { Closed, TooLate, TooLong };

/// All that comes through the pipe.
End receive(int from, const ChildLimits& limits, std::string& message) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(kPatience * limits.seconds);
  std::vector<char> block(std::size_t{1} << 16U);
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return End::TooLate;
    pollfd watched{from, POLLIN, 0};
    const int ready = ::poll(&watched, 1, static_cast<int>(std::min<std::int64_t>(left, 60'000)));
    if (ready <= 0) continue;
    const ssize_t got = ::read(from, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return End::Closed;
    message.append(block.data(), static_cast<std::size_t>(got));
    if (message.size() > limits.memory) return End::TooLong;
  }
}

constexpr const char* kRemedy =
    "; it is damaged, or uses what the importer cannot read; export it as STL, OBJ or GLB";

[[noreturn]] void fail_by_signal(const Source& source, const ChildLimits& limits, int signal) {
  if (signal == SIGXCPU || signal == SIGKILL)
    fail(source, "the importer was stopped: it took more than " + std::to_string(limits.seconds) +
                     " s of CPU time or too much memory for this file" + kRemedy);
  fail(source, "the importer crashed on this file (signal " + std::to_string(signal) + ", " +
                   ::strsignal(signal) + ")" + kRemedy);
}

/// What the child was to send, of the kind that is expected.
template <class Take>
auto result_of(const Source& source, const ChildLimits& limits, std::string_view message,
               Kind expected, const Take& take) {
  Receiver receiver(message);
  const Kind kind = receiver.value<Kind>();
  switch (kind) {
    case Kind::Mesh:
    case Kind::Bytes:
      if (kind != expected) break;
      if (auto result = take(receiver); receiver.complete()) return result;
      break;
    case Kind::Error: {
      const auto code = receiver.value<ErrorCode>();
      const std::string text = receiver.text();
      if (receiver.complete()) throw Error(code, text);
      break;
    }
    case Kind::NoMemory:
      fail(source, "the importer needs more than " + std::to_string(limits.memory / kMiB) +
                       " MiB of memory for this file" + kRemedy);
    case Kind::Exception: {
      const std::string text = receiver.text();
      if (receiver.complete()) fail(source, "the importer failed: " + text + kRemedy);
      break;
    }
  }
  fail(source, std::string("the importer broke down on this file") + kRemedy);
}

}  // namespace

ChildLimits child_limits(std::uint64_t file_size) {
  return {1024 * kMiB + 256 * file_size, 20 + 5 * (file_size / kMiB)};
}

namespace {

/// All that a child sends that does the work.
std::string message_of_child(const Source& source, const ChildLimits& limits,
                             const std::function<void(Sender&)>& work) {
  const std::uint64_t addresses = address_limit(limits);
  const auto cannot = [&](const char* what) {
    throw Error(ErrorCode::LimitReached, std::string(source.name) +
                                             ": no process for the importer (" + what + ": " +
                                             std::strerror(errno) + "); close other programs");
  };
  // One at a time, or a child that another thread starts now would hold this pipe open.
  static std::mutex starting;
  std::unique_lock lock(starting);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) cannot("pipe");
  Descriptor from(ends[0]), to(ends[1]);
  // Signals wait until the child has its own handling of them.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t id = ::fork();
  if (id == 0) run(to.fd, limits, addresses, work);
  const int error = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  if (id < 0) cannot("fork");
  Child child(id);
  to.close();
  lock.unlock();
  std::string message;
  const End end = receive(from.fd, limits, message);
  if (end == End::TooLate) fail_by_signal(source, limits, SIGXCPU);
  if (end == End::TooLong) fail_by_signal(source, limits, SIGKILL);
  const int status = child.wait();
  if (WIFSIGNALED(status)) fail_by_signal(source, limits, WTERMSIG(status));
  return message;
}

}  // namespace

ReadResult read_in_child(const Source& source, const ChildLimits& limits,
                         const std::function<ReadResult()>& read) {
  const std::string message =
      message_of_child(source, limits, [&](Sender& sender) { sender.mesh(read()); });
  return result_of(source, limits, message, Kind::Mesh,
                   [](Receiver& receiver) { return receiver.mesh(); });
}

std::string bytes_of_child(const std::string& name, const ChildLimits& limits,
                           const std::function<std::string()>& work) {
  const Source source{{}, name, {}, true};
  const std::string message = message_of_child(source, limits, [&](Sender& sender) {
    const std::string bytes = work();
    sender.value(Kind::Bytes);
    sender.text(bytes);
  });
  return result_of(source, limits, message, Kind::Bytes,
                   [](Receiver& receiver) { return receiver.text(); });
}

}  // namespace kaboum::io
