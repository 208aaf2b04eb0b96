#pragma once

#include <kaboum/plan/solve.h>

#include <chrono>
#include <string>

namespace kaboum::plan {

/// Thrown out of grounding and analysis when a limit is reached; `solve` turns it into
/// Outcome::Limit.
struct LimitExceeded {};

/// Time and memory of one call of `solve`, checked every so often.
class Limits {
 public:
  Limits(const SolveOptions& options, Statistics& statistics);

  /// For searches. @return true if the search, which holds `bytes`, must stop; `reason()` says why.
  bool exceeded(std::size_t bytes) {
    if (++checks_ >= pause_at_) return true;
    if (checks_ % 256 != 0 && reason_.empty()) return false;
    return check(bytes);
  }
  /// `exceeded` is true after so many more calls of it, without a reason, until this is called
  /// again: the search stops for its caller to look around.
  void pause_after(std::uint64_t calls) { pause_at_ = checks_ + calls; }
  [[nodiscard]] bool paused() const { return checks_ >= pause_at_ && reason_.empty(); }
  void never_pause() { pause_at_ = ~std::uint64_t{0}; }
  /// The same, at every call: where one step takes long.
  bool check(std::size_t bytes);

  /// Whether so much may be held by a search; it need not stop if not.
  [[nodiscard]] bool fits(std::size_t bytes) const {
    return options_.max_memory == 0 || bytes + held_ <= options_.max_memory;
  }

  /// For grounding and analysis: some work was done, and this much more memory is held until
  /// `solve` ends. @throws LimitExceeded
  void work(std::size_t more_bytes = 0) {
    held_ += more_bytes;
    if (++work_ % 1024 == 0 && check(0)) throw LimitExceeded();
  }
  /// The same of much memory, before it is taken. @throws LimitExceeded
  void hold(std::size_t more_bytes) {
    held_ += more_bytes;
    if (check(0)) throw LimitExceeded();
  }
  /// So much of what is held is not any more.
  void give_back(std::size_t bytes) { held_ -= bytes; }
  [[nodiscard]] const std::string& reason() const { return reason_; }

  /// What was held while it lives is given back when it ends.
  class Scope {
   public:
    explicit Scope(Limits& limits) : limits_(limits), held_(limits.held_) {}
    ~Scope() { limits_.held_ = held_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Limits& limits_;
    std::size_t held_;
  };

 private:
  const SolveOptions& options_;
  Statistics& statistics_;
  std::chrono::steady_clock::time_point start_, last_progress_;
  std::uint64_t checks_ = 0;
  std::uint64_t pause_at_ = ~std::uint64_t{0};
  std::uint64_t work_ = 0;
  std::size_t held_ = 0;
  std::string reason_;
};

}  // namespace kaboum::plan
