#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include <tbb/global_control.h>

#include <memory>

#include <kaboum/base/error.h>

#include "bindings.h"

namespace kaboum::python {

/// How a call is watched while it runs without the interpreter's lock: Ctrl-C ends it, and a
/// function of the caller's is told what is being done; both at most twenty times a second.
/// @pre lives, as the function does, until the call is over; hooks are called from the calling
/// thread
class Watch {
 public:
  /// @param progress  a callable that takes a str, or None.
  /// @throws Error{InvalidArgument} otherwise
  explicit Watch(const py::object& progress);

  /// Throws what Ctrl-C or the function raised, which ends the work.
  void operator()(const std::string& stage);

  [[nodiscard]] std::function<void(const std::string&)> hook() {
    return [this](const std::string& stage) { (*this)(stage); };
  }

 private:
  PyObject* progress_;  // borrowed; null: none
  std::chrono::steady_clock::time_point next_{};
};

/// Calls `work` without the interpreter's lock, on so many threads (0: one per core).
/// @throws Error{InvalidArgument} on a negative number
template <class Work>
auto run(int threads, const Work& work) {
  if (threads < 0 || threads > 1024)
    throw Error(ErrorCode::InvalidArgument, "threads must be from 0 to 1024");
  const py::gil_scoped_release released;
  std::unique_ptr<tbb::global_control> limit;
  if (threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(threads));
  return work();
}

}  // namespace kaboum::python
