#pragma once

#include <kaboum/distance/compare.h>

#include <array>
#include <string>

namespace kaboum::tools {

/// A page that shows two surfaces over each other, each coloured by its distance from the other one
/// (solid: from the other solid). docs/pages.md.
/// @param files  of A and B.
std::string page_of(const distance::Comparison& comparison, const distance::Compared& result,
                    const std::array<std::string, 2>& files, bool solid);

}  // namespace kaboum::tools
