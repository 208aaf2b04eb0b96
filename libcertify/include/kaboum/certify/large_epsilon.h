#pragma once

#include <kaboum/base/length.h>
#include <kaboum/base/notes.h>

#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace kaboum::certify {

/// From this share of the diagonal on, an epsilon says hardly anything of a part.
constexpr double kLargeEpsilon = 0.5;

/// How that warning begins.
constexpr std::string_view kLargeEpsilonWarning = "WARNING: epsilon is ";
static_assert(kLargeEpsilonWarning.starts_with(kWarning));

/// Warning of an epsilon that is large against the part, which is mostly one in another unit; empty
/// where it is not.
/// @param diagonal  of the part's box, in the unit that epsilon is in. [length]
inline std::string warning_of(const std::optional<Length>& epsilon, double diagonal) {
  if (!epsilon || !(diagonal > 0) || epsilon->of(diagonal) < kLargeEpsilon * diagonal) return {};
  std::ostringstream text;
  text << std::setprecision(3) << kLargeEpsilonWarning << epsilon->of(diagonal)
       << ", and the part is only " << diagonal << " from corner to corner ("
       << std::setprecision(4) << 100 * epsilon->of(diagonal) / diagonal
       << "%): what may be so far from it bounds hardly anything; is epsilon in the part's unit? A "
          "percentage is written 1%";
  return text.str();
}

}  // namespace kaboum::certify
