// Ctrl-C and progress.

#include "running.h"

namespace kaboum::python {

Watch::Watch(const py::object& progress) : progress_(nullptr) {
  if (progress.is_none()) return;
  if (PyCallable_Check(progress.ptr()) == 0)
    throw Error(ErrorCode::InvalidArgument,
                "progress must be a function that takes a str, or None");
  progress_ = progress.ptr();
}

void Watch::operator()(const std::string& stage) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(50);
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress_ == nullptr) return;
  const py::handle progress = progress_;
  progress(stage);
}

}  // namespace kaboum::python
