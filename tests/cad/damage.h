#pragma once

#include <cstdint>
#include <set>
#include <string>

/// What may happen to a STEP or IGES file.
namespace kaboum::test {

struct Damage {
  std::string text;  ///< of the file afterwards
  std::string what;  ///< was done, in words: "drop #12 = PLANE"
  /// Entities whose records are not as they were: the numbers of a STEP file, of an IGES file those
  /// of directory entries.
  std::set<int> touched;
  std::set<int> placing;  ///< of these, records that say where something is, or in which unit
  bool header = false;    ///< what all of an IGES file is about is not as it was: its unit
};

/// One of many ways to damage the file, always the same for the same seed.
Damage damaged(const std::string& text, bool iges, std::uint64_t seed);

/// The entity and all that its record refers to, directly or not.
std::set<int> all_below(const std::string& text, bool iges, int entity);

}  // namespace kaboum::test
