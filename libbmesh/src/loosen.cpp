// Room for vertices that cannot move: edges at them are flipped.
// docs/algorithms/bounding-mesh.md, "Representable coordinates".
#include "loosen.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kaboum::bmesh {

using geom::Sign;
using geom::Triangle;

Loosener::Loosener(const Context& context, WorkingMesh& mesh, ReferenceSolid* solid,
                   ErrorBoundCertificate* certificate, SampledError* sampled,
                   std::vector<Step>* steps, DecimateStatistics& statistics)
    : context_(context),
      m_(mesh),
      solid_(solid),
      certificate_(certificate),
      sampled_(sampled),
      steps_(steps),
      statistics_(statistics) {}

/// Every two triangles that run opposite ways along the edge: of more than two, too.
void Loosener::find(std::uint32_t a, std::uint32_t b) {
  m_.mesh.for_each_triangle(a, [&](std::uint32_t first, std::uint32_t k) {
    if (m_.mesh[first][(k + 1) % 3] != b) return;
    const std::uint32_t c = m_.mesh[first][(k + 2) % 3];
    m_.mesh.for_each_triangle(a, [&](std::uint32_t second, std::uint32_t l) {
      if (m_.mesh[second][(l + 2) % 3] != b) return;
      Edge e{a, b, c, m_.mesh[second][(l + 1) % 3], first, second, 0};
      if (bends(e)) edges_.push_back(e);
    });
  });
}

/// Whether a flip bends them the way asked for, and turns neither over.
bool Loosener::bends(Edge& e) const {
  if (e.c == e.d) return false;
  bool joined = false;
  m_.mesh.for_each_triangle(e.c, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : m_.mesh[t]) joined = joined || w == e.d;
  });
  if (joined) return false;
  const Vec3 &pa = m_.position[e.a], &pb = m_.position[e.b], &pc = m_.position[e.c],
             &pd = m_.position[e.d];
  const bool outer = context_.options.direction == Direction::Outer;
  if (geom::orient3d(pa, pb, pc, pd) != (outer ? Sign::Positive : Sign::Negative)) return false;
  e.volume = std::abs((pb - pa).cross(pc - pa).dot(pd - pa));
  const Vec3 mean = m_.normal[e.first] + m_.normal[e.second];
  return (pd - pa).cross(pc - pa).dot(mean) > 0 && (pb - pd).cross(pc - pd).dot(mean) > 0;
}

bool Loosener::admits(const Edge& e) {
  const Vec3 &pa = m_.position[e.a], &pb = m_.position[e.b], &pc = m_.position[e.c],
             &pd = m_.position[e.d];
  if (context_.options.direction == Direction::Inner && solid_ != nullptr &&
      !solid_->contains({pa, pb, pc, pd}, true)) {
    ++statistics_.rejected_original;
    return false;
  }
  removed_.assign({e.first, e.second});
  added_.assign({{e.first, {pd, pc, pa}}, {e.second, {pc, pd, pb}}});
  if (certificate_ != nullptr && !certificate_->admits(removed_, added_)) {
    ++statistics_.rejected_distance;
    return false;
  }
  return true;
}

void Loosener::flip(const Edge& e) {
  if (certificate_ != nullptr) certificate_->commit(removed_);
  if (sampled_ != nullptr) sampled_->commit(removed_, added_);
  m_.mesh.replace(e.first, {e.d, e.c, e.a});
  m_.mesh.replace(e.second, {e.c, e.d, e.b});
  m_.update_normal(e.first);
  m_.update_normal(e.second);
  if (steps_ != nullptr) steps_->push_back(Step::flip(e.a, e.b, e.c, e.d));
  ++statistics_.flips;
}

bool Loosener::loosen(std::uint32_t v) {
  edges_.clear();
  std::vector<std::uint32_t> ends;
  m_.mesh.for_each_triangle(
      v, [&](std::uint32_t t, std::uint32_t k) { ends.push_back(m_.mesh[t][(k + 1) % 3]); });
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const std::uint32_t w : ends) find(v, w);
  std::sort(edges_.begin(), edges_.end(), [](const Edge& x, const Edge& y) {
    return std::tie(x.volume, x.first, x.second) < std::tie(y.volume, y.first, y.second);
  });
  for (const Edge& e : edges_) {
    if (!admits(e)) continue;
    flip(e);
    return true;
  }
  return false;
}

}  // namespace kaboum::bmesh
