#pragma once

#include <kaboum/verify/inclusion.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "pairs.h"
#include "support/arrangement_oracle.h"

namespace kaboum::test {

/// Compares verify_inclusion with the exact oracle and counts.
class Tally {
 public:
  /// The pair both ways round, and the same pairs permuted: one verdict of the oracle, one claim
  /// each by the verifier, of the permuted pair with cells settled by coplanar faces. Witnesses are
  /// checked with winding numbers computed another way.
  void judge(const MeshPair& pair, std::uint64_t seed);
  /// One direction only.
  void judge_one(const MeshPair& pair, std::uint64_t seed);

  /// What was wrong, one line each; empty if nothing.
  [[nodiscard]] const std::string& faults() const { return faults_; }

  [[nodiscard]] std::size_t pairs() const { return pairs_; }
  [[nodiscard]] std::size_t solid_true() const { return solid_[1]; }
  [[nodiscard]] std::size_t solid_false() const { return solid_[0]; }
  [[nodiscard]] std::size_t surface_true() const { return surface_[1]; }
  [[nodiscard]] std::size_t surface_false() const { return surface_[0]; }
  [[nodiscard]] std::size_t difference_true() const { return difference_[1]; }
  [[nodiscard]] std::size_t difference_false() const { return difference_[0]; }
  [[nodiscard]] std::size_t exact_witnesses() const { return exact_; }
  [[nodiscard]] std::size_t inexact_witnesses() const { return inexact_; }

 private:
  void compare(const MeshPair& pair, const ArrangementVerdict& truth,
               const verify::InclusionOptions& options);
  void fault(const std::string& text) { faults_ += text + '\n'; }

  std::string faults_;
  std::size_t pairs_ = 0, exact_ = 0, inexact_ = 0;
  std::size_t solid_[2] = {0, 0}, surface_[2] = {0, 0}, difference_[2] = {0, 0};
};

/// Keeps the pair as two OBJ files with all digits, in $KABOUM_KEEP, if that is set.
void keep(const MeshPair& pair);

}  // namespace kaboum::test
