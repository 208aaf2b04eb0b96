#pragma once

#include <kaboum/distance/compare.h>

#include <array>
#include <string>
#include <vector>

/// Two shapes coloured by their distances from each other. docs/pages.md.
namespace kaboum::page {

/// True for names of files that a heatmap can be written into: .png, .html and .ply.
bool is_heatmap(const std::string& file);

/// Two shapes that were compared, and what they are called.
struct HeatmapOf {
  const distance::Comparison& comparison;
  const distance::Compared& result;
  std::array<std::string, 2> names;  ///< of A and B
  bool solid;                        ///< distances from solids
};

/// The bytes of a file: .png draws both with a scale, .html is a page of both over each other, .ply
/// is A with colours and the distance as `quality`.
/// @param file  its name, which says which of them
/// @throws Error{InvalidArgument} for another name
std::vector<char> heatmap(const std::string& file, const HeatmapOf& shapes);

}  // namespace kaboum::page
