// Convex bodies that cover a solid, decided exactly by the verifier.

#include <kaboum/bcd/cover.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <iostream>

#include "box.h"

int main() {
  using namespace kaboum;
  // Two boxes that overlap: an angle.
  geom::Mesh angle = box({0, 0, 0}, {4, 1, 1});
  const geom::Mesh upright = box({0, 0, 0}, {1, 1, 4});
  for (const auto& [a, b, c] : upright.triangles) angle.triangles.push_back({a + 8, b + 8, c + 8});
  angle.vertices.insert(angle.vertices.end(), upright.vertices.begin(), upright.vertices.end());

  const geom::Prepared input = geom::prepare(angle);
  bcd::CoverOptions options;
  options.epsilon = 0.01;
  const bcd::CoverCandidate result = bcd::find_cover(input.solid, options);

  geom::ConvexSet set;
  set.bodies = result.bodies;
  const verify::Cover cover = verify::verify_cover(input.solid.mesh(), set);
  std::cout << set.bodies.size() << " bodies, nowhere farther than " << result.excess_upper
            << "; the solid is covered: " << verify::name_of(cover.inclusion.solid.answer) << '\n';
  return cover.inclusion.solid.answer == verify::Answer::Verified ? 0 : 1;
}
