#pragma once

#include <kaboum/filter/batch_checker.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace kaboum::filter {

/// Straight motions of a robot decided one after the other, each in packs of stretches of its way:
/// for searches, of which each question depends on the last answer. Answers are those of
/// BatchChecker::decide_motions. It has the memory of one thread, so threads may not share it.
class MotionChecker {
 public:
  using Answer = BatchChecker::Answer;

  /// Refers to the batch checker.
  explicit MotionChecker(const BatchChecker& batch);
  ~MotionChecker();
  MotionChecker(MotionChecker&&) noexcept;
  MotionChecker& operator=(MotionChecker&&) noexcept;
  MotionChecker(const MotionChecker&) = delete;
  MotionChecker& operator=(const MotionChecker&) = delete;

  /// What the vector code says of the straight motion in joint space between two configurations,
  /// the same for every instruction set. Free: at every instant all is apart by more than its
  /// margin and the resolution. Contact: sets meet at some instant.
  /// @param from, to  a value for each variable, finite
  /// @param resolution  as of world::MotionOptions, above 0 [length]
  Answer filter(std::span<const double> from, std::span<const double> to, double resolution);

  /// Stretches of the last motion that the vector code left open, from a share of its way to
  /// another one, ascending: all else of it is free as filter says. Empty where it did not look.
  [[nodiscard]] std::span<const std::array<double, 2>> open() const;

  /// Pairs of things that these stretches are open for: all others are apart there by more than the
  /// resolution, for certain. Empty: any may be nearer.
  [[nodiscard]] std::span<const std::array<world::Item, 2>> open_pairs() const;

  /// True if the motion, which filter left open last, is free at every instant, for certain: the
  /// exact predicates decide its open stretches. Then check_motion calls it
  /// free. False: nothing is said.
  /// @param intervals  is added to: of time that were looked at
  bool are_open_free(std::span<const double> from, std::span<const double> to,
                     const world::MotionOptions& options, std::size_t& intervals);

  /// True if the motion is free at every instant, for certain: the answer of check_motion, which is
  /// asked where the vector code leaves it open.
  /// @throws as world::check_motion
  bool is_free(std::span<const double> from, std::span<const double> to,
               const world::MotionOptions& options);

  /// Stretches of motions that were looked at so far; the same for every instruction set.
  [[nodiscard]] std::size_t stretches() const;
  /// Motions that were left to check_motion so far.
  [[nodiscard]] std::size_t exact() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaboum::filter
