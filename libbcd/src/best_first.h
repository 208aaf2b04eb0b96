#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace kaboum::bcd {

/// Branch and bound, the part with the largest bound (`upper`) first.
///
/// `bound(part)` sets a part's `upper`; false: it need not be looked at. `decided(part)` tells
/// whether the bound is good enough, and takes note of it. `enough(part)`, asked of the part with
/// the largest bound before it is split, ends the search. `split(part, visit)` calls `visit` with
/// each half.
template <class Part, class Bound, class Decided, class Enough, class Split>
void best_first(std::vector<Part> first, Bound&& bound, Decided&& decided, Enough&& enough,
                Split&& split) {
  std::vector<Part> open;
  const auto lower = [](const Part& p, const Part& q) { return p.upper < q.upper; };
  const auto visit = [&](Part&& part) {
    if (!bound(part) || decided(part)) return;
    open.push_back(std::move(part));
    std::push_heap(open.begin(), open.end(), lower);
  };
  for (Part& part : first) visit(std::move(part));
  while (!open.empty()) {
    std::pop_heap(open.begin(), open.end(), lower);
    const Part part = std::move(open.back());
    open.pop_back();
    if (enough(part)) return;
    split(part, visit);
  }
}

}  // namespace kaboum::bcd
