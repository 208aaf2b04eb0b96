// How far two surfaces are apart at most, certified.

#include <kaboum/distance/hausdorff.h>

#include <iostream>

#include "box.h"

int main() {
  const auto distance =
      kaboum::distance::hausdorff(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0}, {1, 1, 1.5}));
  std::cout << "the Hausdorff distance is between " << distance.lower() << " and "
            << distance.upper() << '\n';
  return distance.lower() <= 0.5 && distance.upper() >= 0.5 ? 0 : 1;
}
