#pragma once

#include <array>
#include <string>
#include <vector>

/// A second reader of mesh files, as plain as can be, to check the project's own. Knows OFF, OBJ,
/// STL and PLY as written by the project and found in collections; shares no code with io.
namespace kaboum::test {

using Corner = std::array<double, 3>;
using Polygon = std::vector<Corner>;

/// The faces of a file in order, by coordinates.
/// @throws std::runtime_error when it cannot make sense of the file
std::vector<Polygon> read_plainly(const std::string& path);

}  // namespace kaboum::test
