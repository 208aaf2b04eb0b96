#pragma once

#include <kaboum/geom/prepare.h>

#include <cstddef>
#include <string>

namespace kaboum::certify {

/// Subject of claims about a mesh: how the mesh that was certified differs from the input.
struct Subject {
  std::size_t reversed_triangles = 0;  ///< and the solid is the one so oriented
  std::size_t dropped_copies = 0;      ///< triangles of copies: what is left is the same surface
  std::size_t dropped_sheets = 0;  ///< triangles of sheets without volume: no claim holds of them
  std::size_t holes = 0;           ///< filled: the solid is the one so closed
  bool wrapped = false;            ///< the solid is that of a wrap round all of its triangles

  friend bool operator==(const Subject&, const Subject&) = default;
};

Subject subject_of(const geom::PreparationReport& report);

/// "the input", and how it was changed.
std::string in_words(const Subject& subject);

}  // namespace kaboum::certify
