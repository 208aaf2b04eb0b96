// kaboum.Error: what the libraries throw, with its code.

#include <kaboum/base/error.h>
#include <kaboum/base/option.h>

#include <array>
#include <filesystem>

#include "bindings.h"

namespace kaboum::python {
namespace {

PyObject* error_type = nullptr;  // kaboum.Error; lives as long as the interpreter

constexpr const char* kErrorsDoc = R"(Why a call could not do its work.

Attributes
----------
code : str
    'invalid_argument' (options are malformed or contradict each other), 'invalid_input' (the data
    cannot be worked on: malformed file, numbers that are not finite, no solid, float32 too coarse),
    'output_failed', 'not_built' (left out of this build), 'limit_reached' (time, memory or size) or
    'internal' (a defect of KABouM).
exit_code : int
    What the tools exit with then (docs/exit-codes.md).)";

struct Code {
  ErrorCode code;
  const char* name;
  int exit_code;
};
constexpr std::array<Code, 6> kCodes{{{ErrorCode::InvalidArgument, "invalid_argument", 2},
                                      {ErrorCode::InvalidInput, "invalid_input", 3},
                                      {ErrorCode::OutputFailed, "output_failed", 4},
                                      {ErrorCode::NotBuilt, "not_built", 5},
                                      {ErrorCode::Internal, "internal", 6},
                                      {ErrorCode::LimitReached, "limit_reached", 7}}};

void raise(ErrorCode code, const char* message) {
  for (const Code& c : kCodes) {
    if (c.code != code) continue;
    py::object error = py::reinterpret_borrow<py::object>(error_type)(message);
    error.attr("code") = c.name;
    error.attr("exit_code") = c.exit_code;
    PyErr_SetObject(error_type, error.ptr());
  }
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    raise(error.code(), remedy_of_python(error.what()).c_str());
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string text = error.path1().string() + ": " + error.code().message();
    raise(ErrorCode::OutputFailed, text.c_str());  // inputs are opened, not looked at
  }
}

}  // namespace

void bind_errors(py::module_& module) {
  py::dict attributes;
  attributes["code"] = "internal";
  attributes["exit_code"] = 6;
  error_type = PyErr_NewExceptionWithDoc("kaboum.Error", kErrorsDoc, nullptr, attributes.ptr());
  if (error_type == nullptr) throw py::error_already_set();
  module.add_object("Error", error_type);
  py::register_local_exception_translator(translate);
}

}  // namespace kaboum::python
