#pragma once

#include <kaboum/plan/externals.h>

#include <string>

/// External functions of a user's own, in other programs and in shared libraries.
/// docs/planning/externals.md.
namespace kaboum::external {

struct ProcessOptions {
  double most_seconds = 10;  ///< for an answer, and for the first line. > 0 [s]
};

/// The external functions that a program offers: it is started once, by /bin/sh, and asked by JSON
/// lines on its standard input and output. It lives as long as the bindings.
///
/// @param command  of the shell.
/// @throws Error{InvalidInput} when it cannot be started, or its first line names no functions. The
///   bindings throw Error{InvalidInput} when it ends or answers what is no answer, and
///   Error{LimitReached} when it takes longer than allowed; then it is ended.
plan::ExternalBindings start_process(const std::string& command, const ProcessOptions& options);

}  // namespace kaboum::external
