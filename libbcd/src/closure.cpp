#include <kaboum/bcd/closure.h>
#include <kaboum/geom/error.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <map>

namespace kaboum::bcd {

using geom::Mesh;
using geom::Triangle;
using geom::Vec3;

Mesh close_holes(const Mesh& mesh) {
  Mesh out = mesh;
  // The boundary of the chain, reversed: directed edges that the fill has to run through.
  std::map<std::uint32_t, std::vector<std::uint32_t>> next;
  const std::vector<geom::EdgeUse> uses = geom::edge_uses(mesh);
  for (std::size_t i = 0; i < uses.size();) {
    int balance = 0;
    const std::uint32_t lo = uses[i].lo, hi = uses[i].hi;
    for (; i < uses.size() && uses[i].lo == lo && uses[i].hi == hi; ++i)
      balance += uses[i].forward ? 1 : -1;
    for (; balance > 0; --balance) next[hi].push_back(lo);
    for (; balance < 0; ++balance) next[lo].push_back(hi);
  }
  // A boundary has as many edges into a vertex as out of it, so every walk returns.
  while (!next.empty()) {
    std::vector<std::uint32_t> path{next.begin()->first};
    std::map<std::uint32_t, std::size_t> place{{path[0], 0}};
    for (;;) {
      const auto at = next.find(path.back());
      ensure(at != next.end(), "the boundary of a mesh is not closed");
      const std::uint32_t to = at->second.back();
      at->second.pop_back();
      if (at->second.empty()) next.erase(at);
      const auto seen = place.find(to);
      if (seen == place.end()) {
        place[to] = path.size();
        path.push_back(to);
        continue;
      }
      const std::vector<std::uint32_t> loop(
          path.begin() + static_cast<std::ptrdiff_t>(seen->second), path.end());
      for (const std::uint32_t v : loop) place.erase(v);
      path.resize(path.size() - loop.size());
      if (loop.size() == 3) {
        out.triangles.push_back({loop[0], loop[1], loop[2]});
      } else if (loop.size() > 3) {
        Vec3 sum = Vec3::Zero();
        for (const std::uint32_t v : loop)
          sum += mesh.vertices[v] / static_cast<double>(loop.size());
        const auto center = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(sum);
        for (std::size_t k = 0; k < loop.size(); ++k)
          out.triangles.push_back({loop[k], loop[(k + 1) % loop.size()], center});
      }
      if (path.empty()) break;
      place[to] = path.size();
      path.push_back(to);
    }
  }
  return out;
}

}  // namespace kaboum::bcd
