#pragma once

namespace kaboum::certify {

/// Part of the keys of all that is kept with a claim: changes whenever libverify may decide
/// otherwise, so that nothing is found that it has not decided as it is.
inline constexpr const char* kDecisions = "decisions 3";

}  // namespace kaboum::certify
