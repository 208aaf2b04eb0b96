// Processes that end with the planner. A signal for the parent's death (prctl) would be one for the
// death of the thread that started the child, and does not reach what the child starts.

#include <kaboum/external/process_group.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace kaboum::external {
namespace {

constexpr useconds_t kLastWords = 200'000;  ///< [µs]

}  // namespace

void close_others(int kept, int from) {
  if (kept > from) close_range(static_cast<unsigned>(from), static_cast<unsigned>(kept - 1), 0);
  close_range(static_cast<unsigned>(kept < from ? from : kept + 1), ~0U, 0);
}

bool ProcessGroup::start() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  guard_ = ::fork();
  if (guard_ == 0) {
    setpgid(0, 0);
    close_others(ends[0], 0);
    char none = 0;
    while (::read(ends[0], &none, 1) < 0 && errno == EINTR) {
    }
    // The planner is gone: its children see the end of their input, and may stop what they drive.
    usleep(kLastWords);
    if (getpgrp() == getpid()) ::kill(0, SIGKILL);  // itself as well
    _exit(0);
  }
  ::close(ends[0]);
  if (guard_ < 0) {
    ::close(ends[1]);
    return false;
  }
  setpgid(guard_, guard_);  // whoever comes first
  held_ = ends[1];
  return true;
}

bool ProcessGroup::add(int process) const {
  return setpgid(process, guard_) == 0 || (process != 0 && errno == EACCES);
}

void ProcessGroup::end() {
  if (guard_ < 0) return;
  ::kill(-guard_, SIGKILL);  // its number is nobody else's before it is waited for
  waitpid(guard_, nullptr, 0);
  ::close(held_);
  guard_ = held_ = -1;
}

}  // namespace kaboum::external
