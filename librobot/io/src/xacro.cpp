// xacro as a process with limits, its two streams read at the same time.

#include "xacro.h"

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <vector>

#include "is_file.h"
#include "xacro_packages.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;  // what it inherits of them takes terabytes of addresses
#else
constexpr bool kSanitized = false;
#endif

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, file.string() + ": " + what);
}

/// The program; empty: it is not on PATH.
std::string find_on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  const std::string list = path != nullptr ? path : "";
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(':', begin), list.size());
    const fs::path place = fs::path(end > begin ? list.substr(begin, end - begin) : ".") / program;
    if (is_file(place) && ::access(place.c_str(), X_OK) == 0) return place.string();
    begin = end + 1;
  }
  return {};
}

/// A pipe, closed at the end of the scope.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close(0);
    close(1);
  }
  [[nodiscard]] bool is_open() const { return ends_[0] >= 0; }
  [[nodiscard]] int from() const { return ends_[0]; }
  [[nodiscard]] int to() const { return ends_[1]; }
  void close(std::size_t end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// Between fork and exec: calls of the system only.
[[noreturn]] void become(char* const* command, char* const* environment, int out, int messages,
                         const XacroLimits& limits, pid_t parent) {
  ::setpgid(0, 0);  // with all that it starts
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  for (int s = 1; s < 32; ++s) ::signal(s, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const rlimit time{limits.seconds, limits.seconds + 1}, memory{limits.memory, limits.memory};
  const rlimit core{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &core);
  if (!kSanitized) ::setrlimit(RLIMIT_AS, &memory);
  const int in = ::open("/dev/null", O_RDONLY);
  if (in < 0) ::_exit(127);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(messages, STDERR_FILENO);
  ::execve(command[0], command, environment);
  ::dprintf(STDERR_FILENO, "%s: cannot be run: %s\n", command[0], std::strerror(errno));
  ::_exit(127);
}

/// Ends and reaps the process and all of its group at the end of the scope.
class Process {
 public:
  explicit Process(pid_t id) : id_(id) {}
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (id_ <= 0) return;
    ::kill(-id_, SIGKILL);
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  /// Its status once it has ended; false: not before the deadline.
  bool wait(Clock::time_point deadline, int& status) {
    for (;;) {
      const pid_t ended = ::waitpid(id_, &status, WNOHANG);
      if (ended == id_ || (ended < 0 && errno != EINTR)) {
        ::kill(-id_, SIGKILL);  // what it left behind
        id_ = -1;
        return true;
      }
      if (Clock::now() > deadline) return false;
      ::usleep(1000);
    }
  }

 private:
  pid_t id_;
};

constexpr std::size_t kLastWords = 2000;

/// Reads both until they end. @return false at the deadline or beyond the longest output
bool receive(const std::array<int, 2>& from, std::array<std::string, 2>& text,
             const XacroLimits& limits, Clock::time_point deadline) {
  std::array<pollfd, 2> watched{{{from[0], POLLIN, 0}, {from[1], POLLIN, 0}}};
  std::vector<char> block(std::size_t{1} << 16U);
  while (watched[0].fd >= 0 || watched[1].fd >= 0) {
    if (Clock::now() > deadline) return false;
    if (::poll(watched.data(), watched.size(), 100) <= 0) continue;
    for (std::size_t i = 0; i < watched.size(); ++i) {
      if (watched[i].fd < 0 || watched[i].revents == 0) continue;
      const ssize_t got = ::read(watched[i].fd, block.data(), block.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) watched[i].fd = -1;
      if (got > 0) text[i].append(block.data(), static_cast<std::size_t>(got));
    }
    if (text[0].size() > limits.output) return false;
    if (text[1].size() > 2 * kLastWords) text[1].erase(0, text[1].size() - kLastWords);
  }
  return true;
}

/// What it said, in one line at the end of a message.
std::string last_words(std::string text) {
  text.erase(text.find_last_not_of(" \r\n\t") + 1);
  if (text.size() > kLastWords) text.erase(0, text.size() - kLastWords);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "" : ": " + text;
}

/// Packages that are not found, where what xacro said names them, or what it finds them with.
std::string packages_in_words(const XacroPackages& packages, const std::string& said) {
  std::string out;
  for (const auto& [name, place] : packages.missing)
    if (said.find(name) != std::string::npos ||
        said.find("ament_index_python") != std::string::npos)
      out += "; $(find " + name + ") of " + place +
             " is no package that is found: name it, or the folder that holds it, by "
             "«package-path»";
  return out;
}

void require_success(const fs::path& file, int status, const std::string& said, bool bare,
                     const XacroPackages& packages) {
  if (WIFSIGNALED(status))
    fail(file, "xacro was ended by a signal, " + std::string(::strsignal(WTERMSIG(status))) +
                   ", or at a limit of time or memory" + last_words(said));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fail(file,
         "xacro fails, exit code " + std::to_string(WEXITSTATUS(status)) + last_words(said) +
             packages_in_words(packages, said) +
             (bare ? "; arguments that it wants are stated by --xacro-args NAME:=VALUE" : ""));
}

void require_arguments(const XacroArguments& arguments) {
  for (const std::string& argument : arguments) {
    const std::size_t end = argument.find(":=");
    if (end == 0 || end == std::string::npos || argument.starts_with('-'))
      throw Error(ErrorCode::InvalidArgument,
                  "'" + argument + "' is no argument of xacro: NAME:=VALUE is meant");
  }
}

/// What the program prints. @param option  before the file's name; empty: none
std::string run_xacro(const fs::path& file, const std::string& option,
                      const XacroArguments& arguments, const XacroLimits& limits,
                      const std::vector<std::string>& places) {
  require_arguments(arguments);
  const std::string program = find_on_path("xacro");
  if (program.empty())
    fail(file,
         "the program xacro, which expands it, is not on PATH; install xacro (ROS has it), or "
         "run where it is: xacro " +
             file.string() + " > robot.urdf");
  std::string name = file.string();
  if (name.starts_with('-')) name.insert(0, "./");
  if (name.find(":=") != std::string::npos)
    fail(file, "xacro takes a path with ':=' for an argument; rename the file or its folder");
  std::vector<std::string> words{program, name};
  if (!option.empty()) words.insert(words.begin() + 1, option);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> command;
  command.reserve(words.size() + 1);
  for (std::string& word : words) command.push_back(word.data());
  command.push_back(nullptr);
  const XacroPackages packages = packages_of_xacro(file, places);
  const PackageView view(packages);
  std::vector<std::string> variables = view.environment();
  std::vector<char*> environment;
  environment.reserve(variables.size() + 1);
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  Pipe out, messages;
  const pid_t parent = ::getpid();
  const pid_t id = out.is_open() && messages.is_open() ? ::fork() : -1;
  if (id < 0)
    throw Error(ErrorCode::LimitReached, file.string() + ": no process for xacro (" +
                                             std::strerror(errno) + "); close other programs");
  if (id == 0) become(command.data(), environment.data(), out.to(), messages.to(), limits, parent);
  Process process(id);
  out.close(1);
  messages.close(1);
  std::array<std::string, 2> text;
  const auto deadline = Clock::now() + std::chrono::seconds(2 * limits.seconds);
  int status = 0;
  const bool whole = receive({out.from(), messages.from()}, text, limits, deadline) &&
                     process.wait(deadline, status);
  if (!whole)
    fail(file, "xacro was ended: it takes more than " + std::to_string(2 * limits.seconds) +
                   " s, or writes more than " + std::to_string(limits.output >> 20U) + " MiB" +
                   last_words(text[1]));
  require_success(file, status, text[1], arguments.empty(), packages);
  if (text[0].empty() && option.empty())
    fail(file, "xacro makes nothing of it" + last_words(text[1]));
  return std::move(text[0]);
}

}  // namespace

std::string expand_xacro(const fs::path& file, const XacroArguments& arguments,
                         const XacroLimits& limits, const std::vector<std::string>& packages) {
  return run_xacro(file, "", arguments, limits, packages);
}

std::vector<std::string> xacro_includes(const fs::path& file, const XacroArguments& arguments,
                                        const XacroLimits& limits,
                                        const std::vector<std::string>& packages) {
  std::istringstream printed(run_xacro(file, "--deps", arguments, limits, packages));
  std::vector<std::string> files;
  std::string name;  // of a file: as many words as it takes
  for (std::string word; printed >> word;) {
    name += (name.empty() ? "" : " ") + word;
    if (!is_file(name)) continue;
    files.push_back(std::move(name));
    name.clear();
  }
  if (!name.empty())
    fail(file, "it includes '" + name +
                   "' by what xacro --deps says, which is no file: dependencies are not known; "
                   "rename files whose names have blanks at the ends or several together");
  std::ranges::sort(files);  // xacro's order is that of a set
  return files;
}

}  // namespace kaboum::robot
