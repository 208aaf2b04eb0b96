#pragma once

#include <kaboum/plan/externals.h>

#include <string>

namespace kaboum::external {

/// What a shared library with external functions has to define, as it was compiled against this
/// version of <kaboum/plan/externals.h>, which needs no library to be linked:
///
///     extern "C" void kaboum_externals_1(kaboum::plan::ExternalBindings& bindings) {
///       bindings["reach"] = [](const kaboum::plan::Question& q) { ... };
///     }
inline constexpr const char* kPluginEntry = "kaboum_externals_1";

/// The external functions of a shared library, which stays loaded.
/// @throws Error{InvalidInput} when it cannot be loaded, has no such function, or binds nothing;
///   what it throws itself is named.
plan::ExternalBindings load_plugin(const std::string& file);

/// Puts bindings together. @param origin  of `more`, for the message.
/// @throws Error{InvalidInput} for a function that both have.
void merge(plan::ExternalBindings& all, plan::ExternalBindings more, const std::string& origin);

}  // namespace kaboum::external
