// What effort changes in the search for bodies round a solid.

#include "tuning.h"

namespace kaboum::bcd {

namespace {

/// What normal effort begins with is all that fast effort does: it finds no more bodies within
/// epsilon (Decompose.NormalEffortFindsNoMoreBodiesThanFast).
Tuning first_search() {
  return {.grid = 200000,
          .search = {},
          .multiples = {1.5},
          .thresholds = {0.8},
          .volume_weights = {kVolumeWeight},
          .first_weights = 1,
          .refinements = 12,
          .rounds = 1};
}

}  // namespace

Tuning tuning(Effort effort) {
  Tuning out = first_search();
  switch (effort) {
    case Effort::Fast:
      return out;
    case Effort::Normal:
      out.multiples = {1, 1.25, 1.5, 2, 3};
      out.volume_weights = {kVolumeWeight, 0.15, 0.02};
      out.refinements = 60;
      out.rounds = 2;
      out.reduce = true;
      out.counted = 24;
      out.patience = 1;
      return out;
    case Effort::Best:
      break;
  }
  return {1000000,
          {.offsets = 11, .reflex_planes = 16, .refinements = 4, .look_ahead = 8},
          {1, 1.25, 1.5, 2, 3, 4.5, 6},
          {1, 0.85, 0.7, 0.5, 0.35},
          {kVolumeWeight, 0.15, 0.02, 0.3, 0},
          kUnlimited,
          200,
          4,
          true};
}

Tuning quick_tuning(bool mirrors) {
  Tuning out = first_search();
  out.grid = 60000;
  out.search = {.offsets = 5, .reflex_planes = 6, .refinements = 1, .mirrors = mirrors};
  return out;
}

}  // namespace kaboum::bcd
