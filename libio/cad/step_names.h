#pragma once

#include <string_view>

/// Entity types of STEP (ISO 10303-42, -203, -214, -242): what each can mean for a shape.
namespace kaboum::io {

enum class StepKind {
  Unknown,     ///< in none of the lists: refused
  Refused,     ///< a shape, a part of one, or a file of one, that is not read
  Face,        ///< a bounded piece of a surface
  Container,   ///< holds faces (solids, shells, surface models, geometric sets)
  Surface,     ///< by itself a face only in geometric sets
  Shape,       ///< a representation that a product's shape can be
  Assembly,    ///< which shape is how often in the product
  NotAsShape,  ///< refused in a shape; elsewhere (drawn annotations) no shape
  Part,        ///< what faces, edges and placements are made of
  Harmless     ///< neither a shape nor a part of one
};

/// @param name  in capital letters, as in files
StepKind step_kind(std::string_view name);

}  // namespace kaboum::io
