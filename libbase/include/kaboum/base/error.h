#pragma once

#include <stdexcept>
#include <string>

namespace kaboum {

/// Why a call could not do its work. The tools map each code to their exit status
/// (docs/exit-codes.md).
enum class ErrorCode {
  InvalidArgument,  ///< the caller's parameters are malformed or contradict each other
  InvalidInput,     ///< the data given cannot be worked on: malformed file, non-finite numbers, no
                    ///< solid
  OutputFailed,     ///< a result could not be written or read back
  NotBuilt,         ///< the feature was left out of this build
  Internal,         ///< our bug: an invariant that a guarantee rests on was found broken
  LimitReached,     ///< time, memory or size limit
};

/// The one exception type of the libraries.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// Throws Error{Internal} when `condition` is false. Always on: used where a guarantee depends on
/// it.
inline void ensure(bool condition, const char* what) {
  if (!condition) throw Error(ErrorCode::Internal, std::string("internal error: ") + what);
}

}  // namespace kaboum
