// Time and memory, looked at every so often; progress is told from here as well.
#include "task/solve_limits.h"

#include <algorithm>

namespace kaboum::plan {

Limits::Limits(const SolveOptions& options, Statistics& statistics)
    : options_(options),
      statistics_(statistics),
      start_(std::chrono::steady_clock::now()),
      last_progress_(start_) {}

bool Limits::check(std::size_t bytes) {
  if (!reason_.empty()) return true;
  bytes += held_;
  const auto now = std::chrono::steady_clock::now();
  if (options_.timeout > 0 &&
      std::chrono::duration<double>(now - start_).count() > options_.timeout)
    reason_ = "time limit reached";
  if (options_.max_memory > 0 && bytes > options_.max_memory) reason_ = "memory limit reached";
  if (options_.progress && now - last_progress_ > std::chrono::milliseconds(200)) {
    last_progress_ = now;
    Statistics s = statistics_;
    s.state_bytes = std::max<std::uint64_t>(s.state_bytes, bytes);
    options_.progress(s);
  }
  return !reason_.empty();
}

}  // namespace kaboum::plan
