#include "witness.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "nearest.h"
#include "spot.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kFaces = 4000;  // looked at, spread evenly
constexpr std::size_t kTried = 400;   // of the candidates, deepest first
constexpr int kHalvings = 60;

struct Candidate {
  Vec3 point;
  Vec3 direction;  ///< into the offending region, unit length
  double depth;
};

bool contradicts(const Scene& scene, const Vec3& p, bool on_surface, bool relative) {
  const std::optional<int> outer = winding_at(scene, kOutside, p);
  if (!outer) return false;
  if (on_surface) return *outer <= 0;
  const std::optional<int> inner = winding_at(scene, kInside, p);
  if (!inner) return false;
  return relative ? *inner > *outer : *inner >= 1 && *outer <= 0;
}

}  // namespace

Witness find_witness(const Scene& scene, const std::vector<Offence>& offences, bool on_surface,
                     bool relative) {
  std::vector<Candidate> candidates;
  const std::size_t step = (offences.size() + kFaces - 1) / kFaces;
  for (std::size_t i = 0; i < offences.size(); i += step) {
    const Offence& offence = offences[i];
    const Vec3 &a = scene.corner(offence.face, 0), &b = scene.corner(offence.face, 1),
               &c = scene.corner(offence.face, 2);
    Vec3 normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (!(length > 0)) normal = Vec3::UnitZ();
    if (length > 0) normal /= length;
    normal *= offence.side;
    candidates.push_back({offence.point, normal, 0});
    const Vec3 middle = (a + b + c) / 3;
    candidates.push_back({middle, normal, 0});
    for (const Vec3* p : {&a, &b, &c}) {
      Vec3 inwards = middle - *p;
      if (inwards.norm() > 0) inwards.normalize();
      candidates.push_back({*p, (normal + inwards).normalized(), 0});
    }
  }
  const NearestTriangle nearest(scene, kOutside);
  oneapi::tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    const std::optional<int> outer = winding_at(scene, kOutside, candidate.point);
    const bool enclosed = !relative && outer && *outer >= 1;
    candidate.depth = enclosed ? -1 : nearest.distance(candidate.point);
  });
  std::erase_if(candidates, [](const Candidate& candidate) { return candidate.depth < 0; });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.depth > b.depth; });

  const auto try_at = [&](const Candidate& candidate, double reach) -> std::optional<Witness> {
    // A point of a triangle shows by itself that it is outside.
    if (on_surface && contradicts(scene, candidate.point, on_surface, relative)) {
      return Witness{candidate.point, nearest.distance(candidate.point), true};
    }
    for (int k = 0; k <= kHalvings; ++k) {
      const Vec3 p = candidate.point + std::ldexp(reach, -k) * candidate.direction;
      if (!p.allFinite() || !contradicts(scene, p, on_surface, relative)) continue;
      return Witness{p, nearest.distance(p), true};
    }
    return std::nullopt;
  };
  for (std::size_t i = 0; i < std::min(kTried, candidates.size()); ++i) {
    const Candidate& candidate = candidates[i];
    const double scale = std::max(candidate.point.cwiseAbs().maxCoeff(), 1e-300);
    if (auto witness =
            try_at(candidate, candidate.depth > 0 ? 0.5 * candidate.depth : 1e-6 * scale)) {
      return *witness;
    }
  }
  return {offences.front().point, nearest.distance(offences.front().point), false};
}

}  // namespace kaboum::verify
