// Which parts of a prepared mesh were guessed. docs/algorithms/preparation.md.
#include "guesses.h"

#include <map>

namespace kaboum::geom {

Guesses find_guesses(std::span<const EdgeUse> edges, std::span<const std::uint32_t> part,
                     std::span<const std::uint32_t> source, std::span<const char> agreed,
                     std::span<const char> opened) {
  Guesses out;
  std::vector<char> is_guessed(part.size(), 0);
  for (std::uint32_t t = 0; t < source.size(); ++t) {
    if (agreed[source[t]] != 0) out.agreed.push_back(t);
    if (agreed[source[t]] != 0 || opened[source[t]] != 0) is_guessed[part[t]] = 1;
  }
  for (std::uint32_t t = 0; t < part.size(); ++t)
    if (is_guessed[part[t]] != 0) out.triangles.push_back(t);
  std::map<std::uint32_t, char> branched;
  for_each_edge(edges, [&](std::span<const EdgeUse> e) {
    if (e.size() > 2) branched[part[e[0].triangle]] = 1;
  });
  for (std::uint32_t t = 0; t < source.size() && !out.ambiguous; ++t)
    if (agreed[source[t]] != 0 && opened[source[t]] != 0 && branched.contains(part[t]))
      out.ambiguous = source[t];
  return out;
}

std::vector<std::uint32_t> some_of(std::span<const std::uint32_t> triangles,
                                   std::span<const std::uint32_t> part) {
  constexpr std::size_t kMaxTriangles = 20'000;
  std::map<std::uint32_t, std::size_t> size, seen;
  const auto part_of = [&](std::uint32_t t) { return part.empty() ? 0 : part[t]; };
  for (const std::uint32_t t : triangles) ++size[part_of(t)];
  std::vector<std::uint32_t> some;
  for (const std::uint32_t t : triangles)
    if (seen[part_of(t)]++ % (1 + size[part_of(t)] / kMaxTriangles) == 0) some.push_back(t);
  return some;
}

}  // namespace kaboum::geom
