// What effort changes in the search for bodies round a solid.

#include "tuning.h"

namespace kaboum::bcd {

Tuning tuning(Effort effort) {
  Tuning out{.grid = 200000,
             .search = {},
             .multiples = {1, 1.25, 1.5, 2, 3},
             .thresholds = {0.8},
             .volume_weights = {kVolumeWeight, 0.15, 0.02},
             .first_weights = 1,
             .refinements = 60,
             .rounds = 2,
             .reduce = true,
             .counted = 24,
             .patience = 1};
  switch (effort) {
    case Effort::Fast:
      return quick_tuning(false);
    case Effort::Normal:
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
  return {.grid = 60000,
          .search = {.offsets = 5,
                     .reflex_planes = 6,
                     .refinements = 1,
                     .mirrors = mirrors,
                     .density = kSparse},
          .multiples = {1.5},
          .thresholds = {0.8},
          .volume_weights = {kVolumeWeight},
          .first_weights = 1,
          .refinements = 12,
          .rounds = 1};
}

}  // namespace kaboum::bcd
