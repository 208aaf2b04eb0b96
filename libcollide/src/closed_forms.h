#pragma once

#include <kaboum/base/processor.h>

#include "poses.h"
#include "shapes.h"

/// Closed forms of pairs of segments and boxes, enlarged by balls: eight bodies of one set against
/// one of another, in floats. docs/algorithms/bounded-predicates.md, "Closed forms", has the bounds
/// and their proofs.
namespace kaboum::collide::detail {

/// A body of one set, as the lanes of another set see it.
struct Facing {
  bool is_round = true;
  /// Of the lanes' frame, as the axes of a box see it, else those of its set; the way is from the
  /// body's centre to the lanes' origin. [length]
  FloatRelation relation;
  float half[3] = {};  ///< of a box's edges; of a round body from its middle to an end
  /// A round body's ends in the lanes' frame, from their origin.
  float first[3] = {}, second[3] = {};
  float size = 0;   ///< of `way` and `half` or the ends: what errors are relative to
  float reach = 0;  ///< in which both meet, but for the radii of the lanes [length]
  float outer = 0;  ///< what the body may be larger by than what is above, with all errors
                    ///< that are not relative to sizes [length]
  float inner = 0;  ///< what it may be smaller by, likewise; infinite: nothing is inside
};

/// A bit for each lane: those whose bodies are farther apart than the reach, for certain, and those
/// that are not, for certain.
struct Verdicts {
  unsigned apart = 0, meet = 0;
};

/// @param wide  whether eight are looked at at once, else four. @pre has_avx2() where it is
Verdicts look(const Lanes& lanes, const Facing& body, bool wide = has_avx2());

}  // namespace kaboum::collide::detail
