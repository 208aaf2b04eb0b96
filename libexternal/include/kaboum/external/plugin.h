#pragma once

#include <kaboum/external/process.h>
#include <kaboum/plan/externals.h>

#include <string>

namespace kaboum::external {

/// Interface that a shared library with external functions defines, as it was compiled against this
/// version of <kaboum/plan/externals.h>, which needs no library to be linked:
///
///     extern "C" void kaboum_externals_1(kaboum::plan::ExternalBindings& bindings) {
///       bindings["reach"] = [](const kaboum::plan::Question& q) { ... };
///     }
inline constexpr const char* kPluginEntry = "kaboum_externals_1";

/// The external functions of a shared library. It is loaded in a process of its own, a child of
/// this one, which lives as long as the bindings.
///
/// @throws Error{InvalidInput} when it cannot be loaded, has no such function, or binds nothing;
///   what it throws itself is named. The bindings throw as those of `start_process`: when the child
///   crashes, and when a call takes longer than allowed (it is ended then); and std::runtime_error
///   with what a function threw.
plan::ExternalBindings load_plugin(const std::string& file, const ProcessOptions& options = {});

/// Puts bindings together. @param origin  of `more`, for the message.
/// @throws Error{InvalidInput} for a function that both have.
void merge(plan::ExternalBindings& all, const plan::ExternalBindings& more,
           const std::string& origin);

}  // namespace kaboum::external
