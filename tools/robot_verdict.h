#pragma once

#include <kaboum/verify/held_shape.h>

#include <string>

#include "cli.h"

/// What is said of a robot's shapes that were judged.
namespace kaboum::tools {

struct Finding {
  verify::Answer answer = verify::Answer::Undefined;
  std::string text;  ///< one clause
  Json json = Json::object();
};

/// @param prepared  the mesh was prepared.
Finding finding_of(const verify::HeldShape& held, const verify::Holders& holders, bool prepared);

/// @param uneven  the scale: what is too far by the largest factor may be near enough.
Finding finding_of(const verify::HeldDistance& held, double bound, bool uneven);

/// "1 body", "2 bodies".
std::string count(std::size_t n, const char* one, const char* many);

}  // namespace kaboum::tools
