// A point in an offending region, for a refutation that can be looked at.
#include "witness.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "cell_sample.h"
#include "nearest.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kFaces = 4000;  // looked at, spread evenly
constexpr std::size_t kTried = 400;   // of the candidates, deepest first
constexpr int kFound = 32;            // witnesses to choose from
constexpr int kHalvings = 60;

struct Candidate {
  Vec3 point;
  Vec3 direction;  ///< into the offending region, unit length
  bool corner;     ///< of the inner mesh: as it is
  double depth;
};

bool contradicts(const MeshPair& meshes, const Vec3& p, bool on_surface, bool relative) {
  const std::optional<int> outer = winding_at(meshes, kOutside, p);
  if (!outer) return false;
  if (on_surface) return *outer <= 0;
  const std::optional<int> inner = winding_at(meshes, kInside, p);
  if (!inner) return false;
  return relative ? *inner > *outer : *inner >= 1 && *outer <= 0;
}

}  // namespace

Witness find_witness(const MeshPair& meshes, const std::vector<Offence>& offences, bool on_surface,
                     bool relative) {
  std::vector<Candidate> candidates;
  const std::size_t step = (offences.size() + kFaces - 1) / kFaces;
  for (std::size_t i = 0; i < offences.size(); i += step) {
    const Offence& offence = offences[i];
    const Vec3 &a = meshes.corner(offence.face, 0), &b = meshes.corner(offence.face, 1),
               &c = meshes.corner(offence.face, 2);
    Vec3 normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (!(length > 0)) normal = Vec3::UnitZ();
    if (length > 0) normal /= length;
    normal *= offence.side;
    candidates.push_back({offence.point, normal, false, 0});
    const bool inner = meshes.face(offence.face).chain == kInside;
    const Vec3 middle = (a + b + c) / 3;
    candidates.push_back({middle, normal, false, 0});
    for (const Vec3* p : {&a, &b, &c}) {
      Vec3 inwards = middle - *p;
      if (inwards.norm() > 0) inwards.normalize();
      candidates.push_back({*p, (normal + inwards).normalized(), inner, 0});
    }
  }
  const NearestTriangle nearest(meshes, kOutside);
  verify::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    const std::optional<int> outer = winding_at(meshes, kOutside, candidate.point);
    const bool enclosed = !relative && outer && *outer >= 1;
    candidate.depth = enclosed ? -1 : nearest.distance(candidate.point);
  });
  std::erase_if(candidates, [](const Candidate& candidate) { return candidate.depth < 0; });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.depth > b.depth; });

  // The deepest of the first few that can be found, each as far along its direction as possible.
  geom::Box3 box;
  for (std::uint32_t f = meshes.begin(kInside); f < meshes.end(kInside); ++f) {
    for (int k = 0; k < 3; ++k) box.extend(meshes.corner(f, k));
  }
  const double extent = box.diagonal();
  std::optional<Witness> best;
  int found = 0;
  const auto look_at = [&](const Vec3& p, bool exact) {
    if (!p.allFinite() || !contradicts(meshes, p, on_surface, relative)) return false;
    const double depth = nearest.distance(p);
    const bool better = !best || (exact != best->exact ? exact : depth > best->depth);
    if (better) best = Witness{p, depth, exact};
    return true;
  };
  for (std::size_t i = 0; i < std::min(kTried, candidates.size()) && found < kFound; ++i) {
    const Candidate& candidate = candidates[i];
    if (on_surface) {  // the point must be one of the surface
      found += static_cast<int>(look_at(candidate.point, candidate.corner));
      continue;
    }
    for (int k = 1; k <= kHalvings; ++k) {
      if (!look_at(candidate.point + std::ldexp(extent, -k) * candidate.direction, true)) continue;
      ++found;
      break;
    }
  }
  if (!best) {
    best = Witness{offences.front().point, nearest.distance(offences.front().point), false};
  }
  return {meshes.point_outside(best->point), meshes.length_outside(best->depth), best->exact};
}

}  // namespace kaboum::verify
