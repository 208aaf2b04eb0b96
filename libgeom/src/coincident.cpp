// Triangles with the same corners: opposite pairs, copies, and which pairs are sheets without
// volume. docs/algorithms/preparation.md.
#include "coincident.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/winding.h>

#include <algorithm>

#include "neighbours.h"
#include "prepare_words.h"

namespace kaboum::geom {

Coincident find_coincident(const Mesh& mesh, std::span<const EdgeUse> edges,
                           std::span<const std::uint32_t> source) {
  std::vector<std::pair<Triangle, std::uint32_t>> keyed;
  keyed.reserve(mesh.triangles.size());
  const auto even = [](const Triangle& t, const Triangle& sorted) {
    return (t[0] == sorted[0] && t[1] == sorted[1]) || (t[1] == sorted[0] && t[2] == sorted[1]) ||
           (t[2] == sorted[0] && t[0] == sorted[1]);
  };
  // Only triangles that share an edge and the corner opposite to it can coincide.
  std::vector<char> candidate(mesh.triangles.size(), 0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_corner;
  for_each_edge(edges, [&](std::span<const EdgeUse> e) {
    if (e.size() < 2) return;
    if (e.size() == 2) {
      if (opposite_corner(mesh, e[0]) == opposite_corner(mesh, e[1]))
        candidate[e[0].triangle] = candidate[e[1].triangle] = 1;
      return;
    }
    by_corner.clear();
    for (const EdgeUse& u : e) by_corner.emplace_back(opposite_corner(mesh, u), u.triangle);
    std::sort(by_corner.begin(), by_corner.end());
    for (std::size_t i = 1; i < by_corner.size(); ++i)
      if (by_corner[i].first == by_corner[i - 1].first)
        candidate[by_corner[i].second] = candidate[by_corner[i - 1].second] = 1;
  });
  for (std::uint32_t t = 0; t < candidate.size(); ++t) {
    if (candidate[t] == 0 || source[t] == kFilled) continue;
    Triangle key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    keyed.emplace_back(key, t);
  }
  std::sort(keyed.begin(), keyed.end());
  Coincident found;
  for (std::size_t i = 0; i < keyed.size();) {
    std::vector<std::uint32_t> side[2];
    std::size_t j = i;
    for (; j < keyed.size() && keyed[j].first == keyed[i].first; ++j)
      side[even(mesh.triangles[keyed[j].second], keyed[i].first)].push_back(keyed[j].second);
    const std::size_t opposite = std::min(side[0].size(), side[1].size());
    for (const auto& s : side) {
      found.pairs.insert(found.pairs.end(), s.begin(),
                         s.begin() + static_cast<std::ptrdiff_t>(opposite));
      for (std::size_t k = opposite + 1; k < s.size(); ++k) found.copies.push_back(s[k]);
    }
    i = j;
  }
  return found;
}

std::vector<std::uint32_t> closed_copies(const Mesh& mesh, std::span<const std::uint32_t> copies) {
  Mesh alone{mesh.vertices, {}};
  for (const std::uint32_t t : copies) alone.triangles.push_back(mesh.triangles[t]);
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> label = components(alone, true, &count);
  std::vector<char> closed(count, 1);
  for_each_edge(edge_uses(alone), [&](std::span<const EdgeUse> e) {
    if (!is_balanced(e)) closed[label[e[0].triangle]] = 0;
  });
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < copies.size(); ++i)
    if (closed[label[i]] != 0) out.push_back(copies[i]);
  return out;
}

std::vector<Cancelled> find_sheets(const Mesh& mesh, std::span<const Cancelled> pairs) {
  const WindingNumber winding(mesh);
  std::vector<Cancelled> sheets;
  for (const Cancelled& c : pairs) {
    const auto& corners = c.corners;
    const auto outside = [&](const Vec3& p) { return winding(p).value_or(1) <= 0; };
    if (outside((corners[0] + corners[1] + corners[2]) / 3.0) ||
        std::any_of(corners.begin(), corners.end(), outside))
      sheets.push_back(c);
  }
  return sheets;
}

void refuse_sheets(std::span<const Cancelled> sheets) {
  std::uint32_t first = kFilled;
  for (const Cancelled& c : sheets) first = std::min(first, c.source);
  throw Error(
      ErrorCode::InvalidInput,
      count_of(sheets.size(), "face lies", "faces lie") +
          " back to back with an opposite copy and no volume between (sheets; the first "
          "is input triangle " +
          std::to_string(first) +
          "); have a wrap give the sheets a thickness (mesh-prepare, «prepare=wrap»), or drop "
          "them with «drop-sheets»: they are then not enclosed");
}

}  // namespace kaboum::geom
