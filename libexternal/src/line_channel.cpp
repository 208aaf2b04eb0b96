// A child process with a socket as its standard input and output.

#include <kaboum/external/line_channel.h>

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

namespace kaboum::external {
namespace {

constexpr std::size_t kLongestLine = std::size_t{1} << 24U;  // [bytes]
constexpr int kPatience = 200;  ///< for a program whose input has ended to end by itself [ms]

/// Takes what passes while it lives from `seconds`.
class Clock {
 public:
  explicit Clock(double& seconds) : seconds_(seconds), before_(seconds) {}
  ~Clock() { update(); }
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  /// Milliseconds that are left; 0: none.
  int left() {
    update();
    return seconds_ > 0 ? static_cast<int>(std::min(seconds_, 1e6) * 1e3) + 1 : 0;
  }

 private:
  void update() {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
    seconds_ = before_ - passed.count();
  }
  double& seconds_;
  double before_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool wait_for(int socket, short event, Clock& clock) {
  for (;;) {
    const int left = clock.left();
    if (left == 0) return false;
    pollfd p{socket, event, 0};
    const int ready = poll(&p, 1, left);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

}  // namespace

void LineChannel::start(const std::string& name, const std::function<void(int)>& child) {
  const auto fail = [&] {
    throw Error(ErrorCode::InvalidInput,
                "'" + name + "' cannot be started: " + std::strerror(errno));
  };
  int ends[2];
  if (!group_.start()) fail();
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail();
  process_ = fork();
  if (process_ == 0) {
    // Nothing leaves this function: what called it is the planner's, and goes on there.
    try {
      if (group_.add(0)) child(ends[1]);
    } catch (...) {
    }
    _exit(127);
  }
  ::close(ends[1]);
  lines_.reset(ends[0]);
  if (process_ < 0) fail();
  static_cast<void>(group_.add(process_));  // whoever comes first
}

LineChannel::LineChannel(const std::string& command) {
  start(command, [&](int socket) {
    dup2(socket, STDIN_FILENO);
    dup2(socket, STDOUT_FILENO);
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
  });
}

LineChannel::LineChannel(const std::string& name, const std::function<void(LineSocket&)>& work) {
  start(name, [&](int socket) {
    dup2(STDERR_FILENO, STDOUT_FILENO);  // standard output is the planner's result
    close_others(socket, STDERR_FILENO + 1);
    LineSocket lines(socket);
    work(lines);
    _exit(0);
  });
}

LineChannel::~LineChannel() { end(); }

LineSocket::ReadOutcome LineSocket::read_line(std::string& line, double& seconds) {
  Clock clock(seconds);
  std::size_t looked_at = 0;
  for (;;) {
    const std::size_t at = buffer_.find('\n', looked_at);
    if (at != std::string::npos) {
      line = buffer_.substr(0, at);
      buffer_.erase(0, at + 1);
      return ReadOutcome::Line;
    }
    looked_at = buffer_.size();
    if (looked_at > kLongestLine) return ReadOutcome::TooLong;
    if (!wait_for(socket_, POLLIN, clock)) return ReadOutcome::Late;
    char part[65536];
    const ssize_t got = recv(socket_, part, sizeof part, 0);
    if (got > 0) {
      buffer_.append(part, static_cast<std::size_t>(got));
    } else if (got == 0 || errno != EINTR) {
      return ReadOutcome::End;
    }
  }
}

std::optional<std::string> LineSocket::take_what_is_there() {
  if (buffer_.empty()) {
    char part[4096];
    const ssize_t got = recv(socket_, part, sizeof part, MSG_DONTWAIT);
    if (got > 0) buffer_.append(part, static_cast<std::size_t>(got));
  }
  if (buffer_.empty()) return std::nullopt;
  const std::size_t at = buffer_.find('\n');
  std::string out = buffer_.substr(0, at);
  buffer_.erase(0, at == std::string::npos ? at : at + 1);
  return out;
}

bool LineSocket::write_line(std::string line, double& seconds) {
  Clock clock(seconds);
  line += '\n';
  std::size_t sent = 0;
  while (sent < line.size()) {
    if (!wait_for(socket_, POLLOUT, clock)) return false;
    const ssize_t part =
        send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (part > 0) {
      sent += static_cast<std::size_t>(part);
    } else if (errno != EINTR && errno != EAGAIN) {
      return false;
    }
  }
  return true;
}

void LineSocket::end_writing() { shutdown(socket_, SHUT_WR); }

void LineSocket::close() { reset(-1); }

void LineSocket::reset(int socket) {
  if (socket_ >= 0) ::close(socket_);
  socket_ = socket;
}

std::string LineChannel::end() {
  if (process_ < 0) return "it has ended";
  lines_.end_writing();
  int status = 0;
  pid_t ended = 0;
  for (int waited = 0; ended == 0 && waited < kPatience; waited += 5) {
    ended = waitpid(process_, &status, WNOHANG);
    if (ended == 0) usleep(5000);
  }
  const bool by_itself = ended == process_;
  group_.end();  // what it started as well
  if (!by_itself) waitpid(process_, &status, 0);
  lines_.close();
  process_ = -1;
  if (!by_itself) return "it was ended";
  if (WIFSIGNALED(status)) return "it ended by signal " + std::to_string(WTERMSIG(status));
  const int code = WEXITSTATUS(status);
  return "it ended with exit code " + std::to_string(code) +  // the shell's word for a signal
         (code > 128 ? " (signal " + std::to_string(code - 128) + ")" : "");
}

}  // namespace kaboum::external
