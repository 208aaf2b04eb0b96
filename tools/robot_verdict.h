#pragma once

#include <kaboum/verify/held_shape.h>
#include <kaboum/verify/matching_shapes.h>

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

Finding finding_of(const verify::HeldDistance& held, const verify::ScaledBound& bound);

/// Of a box, cylinder or sphere.
Finding finding_of(const robot::Geometry& shape, const verify::MatchedShapes& match);

/// The finding of a mesh that other shapes of the result may hold.
Finding beside_others(Finding finding, const verify::MatchedShapes& match);

/// "1 body", "2 bodies".
std::string count(std::size_t n, const char* one, const char* many);

}  // namespace kaboum::tools
