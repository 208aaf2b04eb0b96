// Shorter paths.

#include "shorten.h"

#include <algorithm>

namespace kaboum::motion {
namespace {

using Certain = world::MotionAnswer::Outcome;

/// The waypoints after `a` of a way to `b` that is certainly free and keeps the constraints.
std::optional<robot::Path> certain_way(SearchSpace& space, const Values& a, const Values& b) {
  if (!space.has_constraints())
    return space.is_soon_certain(a, b) ? std::optional<robot::Path>({b}) : std::nullopt;
  auto way = space.way(a, b);
  if (!way) return std::nullopt;
  robot::Path path{a};
  path.insert(path.end(), way->begin(), way->end());
  if (space.check(path).outcome != Certain::Free) return std::nullopt;
  return way;
}

bool can_join(SearchSpace& space, const Values& a, const Values& b) {
  if (space.has_constraints() && space.find_broken({a, b})) return false;
  return space.is_soon_certain(a, b);
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

double length_of(const SearchSpace& space, const Values& from, const robot::Path& way) {
  double out = space.distance(from, way.front());
  for (std::size_t i = 1; i < way.size(); ++i) out += space.distance(way[i - 1], way[i]);
  return out;
}

}  // namespace

robot::Path without_detours(const robot::Path& path, SearchSpace& space) {
  robot::Path out{path.front()};
  std::size_t at = 0;
  while (at + 1 < path.size()) {
    std::size_t next = path.size() - 1;
    if (space.has_constraints()) {
      // Long straight lines leave the constraints: the first that does ends the look.
      next = at + 1;
      while (next + 1 < path.size() && can_join(space, path[at], path[next + 1])) ++next;
    } else {
      while (next > at + 1 && !can_join(space, path[at], path[next])) --next;
    }
    out.push_back(path[next]);
    at = next;
  }
  return out;
}

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
    const auto way = certain_way(space, first, last);
    if (!way || length_of(space, first, *way) > to - from - 0.01 * whole) continue;
    robot::Path shorter(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(a.segment) + 1);
    shorter.push_back(first);
    shorter.insert(shorter.end(), way->begin(), way->end());
    shorter.insert(shorter.end(), path.begin() + static_cast<std::ptrdiff_t>(b.segment) + 1,
                   path.end());
    path = std::move(shorter);
  }
  return without_detours(path, space);
}

}  // namespace kaboum::motion
