#pragma once

#include <kaboum/geom/region.h>

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// Adds --epsilon-map, which names a file.
void add_epsilon_map(CLI::App& app, std::string& file, const std::string& text);

/// The regions that a file of --epsilon-map states (docs/formats.md, "Regions"); none without one.
/// @throws Error{InvalidInput} naming the file and the region
std::vector<geom::RequestedRegion> read_epsilon_map(const std::string& file);

}  // namespace kaboum::tools
