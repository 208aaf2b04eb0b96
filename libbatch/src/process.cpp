// Child processes: started with limits, collected with what they took.

#include "process.h"

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace kaboum::batch {
namespace {

/// Between fork and exec: calls of the system only.
[[noreturn]] void become(char* const* arguments, const char* messages, std::uintmax_t most_memory,
                         pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it ended before it was asked about
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int in = open("/dev/null", O_RDWR);
  const int log = open(messages, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (in < 0 || log < 0) _exit(127);
  dup2(in, STDIN_FILENO);
  dup2(in, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  if (most_memory > 0) {
    const rlimit limit{most_memory, most_memory};
    setrlimit(RLIMIT_AS, &limit);
  }
  execvp(arguments[0], arguments);
  dprintf(STDERR_FILENO, "%s: cannot be run: %s\n", arguments[0], std::strerror(errno));
  _exit(127);
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

std::string find_program(const std::string& name, const fs::path& programs) {
  if (name.find('/') != std::string::npos) return name;
  std::error_code error;
  const fs::path folder =
      programs.empty() ? fs::read_symlink("/proc/self/exe", error).parent_path() : programs;
  const fs::path there = folder / name;
  return !error && fs::is_regular_file(there, error) ? fs::absolute(there).string() : name;
}

pid_t start(const std::vector<std::string>& command, const fs::path& messages,
            std::uintmax_t most_memory) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t id = fork();
  if (id < 0)
    throw Error(ErrorCode::LimitReached,
                std::string("no process can be started: ") + std::strerror(errno));
  if (id == 0) become(arguments.data(), messages.c_str(), most_memory, parent);
  return id;
}

int watched(pid_t id) { return static_cast<int>(syscall(SYS_pidfd_open, id, 0)); }

std::optional<Ended> end_of(pid_t id) {
  int status = 0;
  rusage usage{};
  Ended ended;
  const pid_t got = wait4(id, &status, WNOHANG, &usage);
  if (got == 0) return std::nullopt;
  ended.id = id;
  if (got < 0) {  // somebody else has waited for it
    ended.signal = SIGTERM;
    return ended;
  }
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  ended.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  ended.peak_megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
  return ended;
}

std::string last_line(const fs::path& messages) {
  constexpr std::size_t kMost = 400;
  std::vector<char> bytes;
  try {
    bytes = io::read_file(messages);
  } catch (const Error&) {
    return {};
  }
  std::string text(bytes.begin(), bytes.end());
  text.erase(text.find_last_not_of(" \r\n\t") + 1);
  text.erase(0, text.find_last_of('\n') + 1);
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

}  // namespace kaboum::batch
