// A certified convex decomposition in process, and its certificate.

#include <kaboum/certify/convex_set.h>

#include <iostream>

#include "box.h"

int main() {
  using namespace kaboum;
  certify::SetRequest request;
  request.epsilon = kaboum::Length{1, true};  // percent of the diagonal
  const auto made = certify::certify_set(box({0, 0, 0}, {3, 2, 1}), "", request);
  if (!made) return 1;
  std::cout << made->artefact().bodies.size() << " body, certified:\n"
            << certify::to_json(*made) << '\n';
  return made->certificate().reached() ? 0 : 1;
}
