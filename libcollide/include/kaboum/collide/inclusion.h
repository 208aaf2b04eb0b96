#pragma once

#include <kaboum/collide/bounding_set.h>

#include <cstddef>

namespace kaboum::collide {

enum class Inclusion {
  Included,     ///< certainly: the outer set is in the union of the inner one's bodies
  NotIncluded,  ///< the outer set, with its radii and errors, is not: the solid is, if at all, by
                ///< less than tolerance_of_inclusion
  Undecided,    ///< out of work
};

/// Inclusion by Definition 1 of [gaschler2016], case 4: whether one solid contains another one, by
/// an outer set of the one that is to be contained and an inner set of the other one. The union
/// counts: a body may lie in several bodies of the inner set together. Exact: bodies are subtracted
/// one after the other in rational arithmetic; polytopes within them stand for inner bodies with a
/// radius.
///
/// @param most_pieces  that bodies are cut into before it is given up.
/// @throws Error{InvalidArgument} unless the first set is an outer one and the second an inner one.
Inclusion find_inclusion(const PosedSet& outer, const PosedSet& inner,
                         std::size_t most_pieces = 10'000);

/// Depth in the solid of `inner`: what lies deeper is said to be included. [length]
double tolerance_of_inclusion(const PosedSet& outer, const PosedSet& inner);

}  // namespace kaboum::collide
