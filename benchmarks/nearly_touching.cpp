#include <kaboum/collide/proximity.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "support/contacts.h"
#include "support/rational_contact.h"

/// Pairs of convex bodies that nearly touch: are_within against rational numbers.
/// nearly-touching-benchmark [PAIRS [SEED]]; exit code 1 where an answer is wrong.
int main(int argc, char** argv) {
  using namespace kaboum;
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 100'000;
  std::mt19937_64 random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  int wrong = 0, meeting = 0;
  collide::Decided decided;
  double seconds = 0;
  for (int i = 0; i < pairs; ++i) {
    const test::Contact c = test::random_contact(random);
    const collide::Polytope a(c.a.vertices), b(c.b.vertices);
    const auto start = std::chrono::steady_clock::now();
    const bool said = collide::are_within(collide::Posed(a, c.pose_a), collide::Posed(b, c.pose_b),
                                          0, nullptr, &decided);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const bool truth = test::rational_within(c.a, c.pose_a, c.b, c.pose_b, 0);
    meeting += truth ? 1 : 0;
    wrong += said == truth ? 0 : 1;
  }
  std::printf(
      "%d pairs, %d of them meet; %d wrong answers; %llu decided at once, %llu in rounded "
      "arithmetic, %llu exactly; %.3g us each\n",
      pairs, meeting, wrong, static_cast<unsigned long long>(decided.at_once),
      static_cast<unsigned long long>(decided.rounded),
      static_cast<unsigned long long>(decided.exactly), 1e6 * seconds / pairs);
  return wrong == 0 ? 0 : 1;
}
