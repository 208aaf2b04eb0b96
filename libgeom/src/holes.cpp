// Fills holes: the boundary of the chain of triangles, reversed, is walked loop by loop, and each
// loop is filled with a fan.
#include <kaboum/base/error.h>
#include <kaboum/geom/holes.h>
#include <kaboum/geom/solid_mesh.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <map>
#include <utility>

#include "solid_mesh_maker.h"

namespace kaboum::geom {
namespace {

void fill(const std::vector<std::uint32_t>& loop, FilledHoles& out) {
  if (loop.size() < 3) return;  // to and fro along one edge
  Mesh& mesh = out.mesh;
  Vec3 sum = Vec3::Zero();
  Box3 box;
  for (const std::uint32_t v : loop) {
    sum += mesh.vertices[v] / static_cast<double>(loop.size());
    box.extend(mesh.vertices[v]);
  }
  ++out.holes;
  out.rims.push_back(loop);
  if (out.holes == 1 || box.diagonal() > out.largest) {
    out.largest = box.diagonal();
    out.largest_at = box.center();
  }
  if (loop.size() == 3) {
    mesh.triangles.push_back({loop[0], loop[1], loop[2]});
    return;
  }
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(sum);
  for (std::size_t k = 0; k < loop.size(); ++k)
    mesh.triangles.push_back({loop[k], loop[(k + 1) % loop.size()], center});
}

bool has_equal_vertices(const Mesh& mesh) {
  std::vector<Vec3> sorted = mesh.vertices;
  std::sort(sorted.begin(), sorted.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

}  // namespace

FilledHoles fill_holes(const Mesh& mesh) {
  FilledHoles out;
  out.mesh = mesh;
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  const std::vector<std::uint32_t> component = components(uses, mesh.triangles.size(), nullptr);
  // The boundary of the chain, reversed: directed edges that the fill has to run through. An edge
  // belongs to one component, a vertex may belong to several.
  using Corner = std::pair<std::uint32_t, std::uint32_t>;  // component, vertex
  std::map<Corner, std::vector<std::uint32_t>> next;
  for_each_edge(uses, [&](std::span<const EdgeUse> e) {
    int balance = 0;
    for (const EdgeUse& u : e) balance += u.forward ? 1 : -1;
    const std::uint32_t c = component[e[0].triangle];
    for (; balance > 0; --balance) next[{c, e[0].hi}].push_back(e[0].lo);
    for (; balance < 0; ++balance) next[{c, e[0].lo}].push_back(e[0].hi);
  });
  // A boundary has as many edges into a vertex as out of it, so every walk returns.
  while (!next.empty()) {
    const std::uint32_t c = next.begin()->first.first;
    std::vector<std::uint32_t> path{next.begin()->first.second};
    std::map<std::uint32_t, std::size_t> place{{path[0], 0}};
    while (!path.empty()) {
      const auto at = next.find({c, path.back()});
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
      const auto first = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
      const std::vector<std::uint32_t> loop(first, path.end());
      for (const std::uint32_t v : loop) place.erase(v);
      path.erase(first, path.end());
      fill(loop, out);
      if (path.empty()) break;
      place[to] = path.size();
      path.push_back(to);
    }
  }
  return out;
}

SolidMesh close_holes(const SolidMesh& open) {
  if (open.closed()) return open;
  Mesh mesh = fill_holes(open.mesh()).mesh;
  if (has_equal_vertices(mesh)) {  // the middle of a hole may lie on a vertex
    mesh = weld(mesh);
    std::erase_if(mesh.triangles,
                  [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    mesh = weld(mesh);
  }
  const std::size_t filled =
      open.filled_triangles() + mesh.triangles.size() - open.mesh().triangles.size();
  std::vector<char> border(mesh.vertices.size(), 0);
  return SolidMeshMaker::make(std::move(mesh), std::move(border), true, filled);
}

}  // namespace kaboum::geom
