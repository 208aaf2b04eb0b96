#pragma once

#include <kaboum/base/option.h>
#include <kaboum/world/world.h>

#include <map>
#include <string>

namespace kaboum::world {

/// Distance that two things are to be kept from each other in a state: the one stated of the pair,
/// else the larger of those stated of either, else that of all. Parts of one robot, with what it
/// carries, are kept apart only where their pair states it. [length]
double margin_between(const World& world, const WorldState& state, const Item& a, const Item& b);

/// Margins by names, as users state them; no percentages.
struct MarginRequest {
  /// By "OBJECT", "ROBOT", "ROBOT/LINK", or two of them with a comma between; the empty name is of
  /// all things that are not named.
  std::map<std::string, Length> margins = {};
};

/// The option of margins: margin.
const std::vector<Option<MarginRequest>>& margin_options();

/// The margins that are asked for, in one line: "0.02; arm/tool,box=0"; empty: none are.
std::string words_of(const MarginRequest& request);

/// The margins that are asked for.
/// @throws Error{InvalidArgument} for names that the world lacks, distances that are negative, not
///   finite or percentages
Margins margins_of(const World& world, const MarginRequest& request);

}  // namespace kaboum::world
