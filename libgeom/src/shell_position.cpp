// Which shells wind round which, exactly, and which meet in more than corners and edges.
// docs/algorithms/preparation.md.
#include "shell_position.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "triangle_contact.h"

namespace kaboum::geom {
namespace {

constexpr int kOn = std::numeric_limits<int>::min();

}  // namespace

Position ShellPositions::find(std::uint32_t c) const {
  Position out;
  bool near = false;
  for (std::uint32_t d = 0; d < shells_.box.size() && !near; ++d)
    near = d != c && shells_.chains.closed[d] != 0 && overlap(shells_.box[c], shells_.box[d]);
  if (!near) return out;
  std::set<std::uint32_t> touched;
  for (const std::uint32_t t : shells_.members[c]) {
    Box3 box;
    for (int k = 0; k < 3; ++k) box.extend(shells_.mesh.vertices[shells_.mesh.triangles[t][k]]);
    bvh_.traverse([&](const Box3& b) { return overlap(b, box); },
                  [&](std::uint32_t u) {
                    const std::uint32_t d = shells_.chains.label[u];
                    if (d == c || shells_.chains.closed[d] == 0 || out.unclear.contains(d)) return;
                    const Triangle &x = shells_.mesh.triangles[t], &y = shells_.mesh.triangles[u];
                    if (std::find_first_of(x.begin(), x.end(), y.begin(), y.end()) != x.end())
                      touched.insert(d);
                    if (meet_improperly(shells_.mesh, t, u)) out.unclear.insert(d);
                  });
  }
  // Only corners and edges are common: the winding number of another shell is the same all over
  // the inside of a triangle, and at those of its corners that are not on that shell.
  std::map<std::uint32_t, std::map<std::uint32_t, int>> at_vertex;
  const auto windings = [&](std::uint32_t v) -> const std::map<std::uint32_t, int>& {
    const auto entry = at_vertex.try_emplace(v);
    std::map<std::uint32_t, int>& numbers = entry.first->second;
    if (!entry.second) return numbers;
    std::set<std::uint32_t> on;
    winding_.crossings(shells_.mesh.vertices[v], [&](std::uint32_t t, int sign) {
      const std::uint32_t d = shells_.chains.label[t];
      if (sign == 0) on.insert(d);
      numbers[d] += sign;
    });
    for (const std::uint32_t d : on) numbers[d] = kOn;
    return numbers;
  };
  for (const auto& [d, w] : windings(shells_.mesh.triangles[shells_.members[c][0]][0])) {
    if (d == c || w == 0 || touched.contains(d)) continue;
    if (w == kOn) {  // where only triangles without area meet
      out.unclear.insert(d);
    } else {
      out.winding.emplace(d, w);
    }
  }
  for (const std::uint32_t d : touched) {
    std::optional<int> all;
    bool same = true;
    for (std::size_t i = 0; i < shells_.members[c].size() && same; ++i) {
      bool decided = false;
      for (const std::uint32_t v : shells_.mesh.triangles[shells_.members[c][i]]) {
        const auto& w = windings(v);
        const auto at = w.find(d);
        const int value = at == w.end() ? 0 : at->second;
        if (value == kOn) continue;
        decided = true;
        same = same && (!all || *all == value);
        all = value;
      }
      same = same && decided;
    }
    if (!same) {
      out.unclear.insert(d);
    } else if (*all != 0) {
      out.winding.emplace(d, *all);
    }
  }
  return out;
}

}  // namespace kaboum::geom
