// Shorter paths.

#include "shorten.h"

#include <algorithm>

namespace kaboum::motion {
namespace {

using Certain = world::MotionAnswer::Outcome;

bool can_join(SearchSpace& space, const Values& a, const Values& b) {
  return space.looks_free(a, b) && space.check({a, b}).outcome == Certain::Free;
}

/// Leaves waypoints out: from each, the farthest that a straight line leads to is next.
robot::Path without_detours(const robot::Path& path, SearchSpace& space) {
  robot::Path out{path.front()};
  std::size_t at = 0;
  while (at + 1 < path.size()) {
    std::size_t next = path.size() - 1;
    while (next > at + 1 && !can_join(space, path[at], path[next])) --next;
    out.push_back(path[next]);
    at = next;
  }
  return out;
}

/// A place on a path: a segment and a share of it.
struct Place {
  std::size_t segment = 0;
  double share = 0;
};

Place place_at(const std::vector<double>& lengths, double length) {
  Place out;
  while (out.segment + 1 < lengths.size() && length > lengths[out.segment])
    length -= lengths[out.segment++];
  const double whole = lengths[out.segment];
  out.share = whole > 0 ? std::min(1.0, length / whole) : 0;
  return out;
}

}  // namespace

robot::Path shorten(robot::Path path, SearchSpace& space, std::size_t shortcuts, Random& random) {
  if (path.size() < 3 || shortcuts == 0) return path;
  path = without_detours(path, space);
  for (std::size_t k = 0; k < shortcuts && path.size() > 2 && !space.work_ended(); ++k) {
    std::vector<double> lengths;
    double whole = 0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      lengths.push_back(space.distance(path[i], path[i + 1]));
      whole += lengths.back();
    }
    double from = random.between(0, whole), to = random.between(0, whole);
    if (from > to) std::swap(from, to);
    const Place a = place_at(lengths, from), b = place_at(lengths, to);
    if (a.segment == b.segment) continue;
    const Values first = between(path[a.segment], path[a.segment + 1], a.share),
                 last = between(path[b.segment], path[b.segment + 1], b.share);
    // Not worth a look where little is gained.
    if (space.distance(first, last) > to - from - 0.01 * whole) continue;
    if (!can_join(space, first, last)) continue;
    robot::Path shorter(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(a.segment) + 1);
    shorter.push_back(first);
    shorter.push_back(last);
    shorter.insert(shorter.end(), path.begin() + static_cast<std::ptrdiff_t>(b.segment) + 1,
                   path.end());
    path = std::move(shorter);
  }
  return without_detours(path, space);
}

}  // namespace kaboum::motion
