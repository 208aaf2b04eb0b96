#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// What the module that evaluates exact faces gives to the library that has loaded it.
namespace kaboum::verify {

struct PointList {
  std::vector<double> coordinates;     ///< three of each point [mm]
  std::vector<std::uint32_t> of_face;  ///< of each point; faces are counted from 0
  std::size_t faces = 0, edges = 0;    ///< one for each place of a face; edges of all of them
  std::string error;                   ///< why nothing was read; empty if everything was
};

/// The module's only function. Catches everything.
/// @param path     of a file that can be opened and read
/// @param density  points along an interval between knots
using ListPoints = void(const char* path, bool iges, std::size_t density, PointList& result);
constexpr const char* kListPoints = "kaboum_list_exact_points";
constexpr const char* kPointsModule = "libkaboum_exact_points.so";

}  // namespace kaboum::verify
