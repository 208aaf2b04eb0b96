#pragma once

#include <kaboum/world/checker.h>
#include <kaboum/world/motion_check.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// Filtered predicates for many configurations at once: float32 arithmetic with proved error bounds
/// decides most of them, the exact predicates of libcollide the rest. docs/algorithms/batches.md.
namespace kaboum::filter {

/// Instruction set of the vector code. Answers are the same for all.
enum class Instructions : std::uint8_t { Baseline, Avx2, Avx512 };

/// Those that this processor has, the widest last.
std::vector<Instructions> instruction_sets();
const char* name_of(Instructions set);

/// Counts of how configurations, or motions, were decided.
struct BatchCounts {
  std::size_t free = 0;     ///< all, by either way
  std::size_t contact = 0;  ///< all others
  std::size_t exactly = 0;  ///< of both, with the checker's help

  BatchCounts& operator+=(const BatchCounts& other);
};

/// Decides for many configurations of one robot whether they are free, all else being as in a
/// state. Every answer is the one that Checker::is_free gives. Const throughout: threads may share
/// it.
class BatchChecker {
 public:
  struct Options {
    /// Balls that stand for the robot's links, at most; at least one for every convex body is used.
    std::size_t most_balls = 100;
    Instructions instructions = instruction_sets().back();
  };

  /// Refers to the checker. Where the checker has a substitute, or the robot carries something, all
  /// configurations are left to the checker.
  /// @throws as Checker::is_free; Error{InvalidArgument} for a robot that there is not, or
  ///   instructions that the processor lacks.
  BatchChecker(const world::Checker& checker, world::WorldState state, std::size_t robot,
               const Options& options);
  ~BatchChecker();
  BatchChecker(BatchChecker&&) noexcept;
  BatchChecker& operator=(BatchChecker&&) noexcept;
  BatchChecker(const BatchChecker&) = delete;
  BatchChecker& operator=(const BatchChecker&) = delete;

  /// Decides rows of values, one for each variable of the robot, one row after the other.
  /// @param free  for every row 1: free, for certain; 0: in contact or within epsilon, as
  ///   Checker::is_free has it. A contact that the robot has no part in makes all rows 0.
  /// @param progress  called now and then; what it throws ends the work
  /// @throws Error{InvalidArgument} where sizes do not fit, or a value is not finite
  BatchCounts decide(std::span<const double> rows, std::span<std::uint8_t> free,
                     const std::function<void()>& progress = {}) const;

  /// Decides straight motions in joint space, at every instant: of each from a row of `from` to the
  /// same row of `to`. As in check_motion, contacts that the robot has no part in do not count.
  /// Every answer is the one that check_motion gives of that motion; where that would stop at its
  /// most_intervals, the motion may be found free instead.
  /// @param free  for every motion 1: free at every instant, for certain; 0: at some instant sets
  ///   meet, or are nearer than the resolution, or check_motion leaves it undecided
  /// @param options  of world::check_motion, which decides the stretches that are open
  /// @throws as decide
  BatchCounts decide_motions(std::span<const double> from, std::span<const double> to,
                             std::span<std::uint8_t> free, const world::MotionOptions& options,
                             const std::function<void()>& progress = {}) const;

  /// Answer of the vector code alone.
  enum class Answer : std::uint8_t { Contact, Free, Open };
  /// What the vector code says of rows; for tests and measurements.
  void filter(std::span<const double> rows, std::span<Answer> answers) const;

  [[nodiscard]] std::size_t variables() const;
  /// False: all is left to the checker.
  [[nodiscard]] bool decides() const;
  /// Balls that hold the robot's links.
  [[nodiscard]] std::size_t balls() const;

 private:
  friend class MotionChecker;
  class RowWorker;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaboum::filter
