#include "judge.h"

#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <optional>

#include "support/oracle.h"
#include "support/segment_oracle.h"

namespace kaboum::test {
namespace {

using verify::Answer;

/// How the verifier must answer.
Answer answer_for(const std::optional<bool>& truth) {
  if (!truth) return Answer::Undefined;
  return *truth ? Answer::Verified : Answer::Refuted;
}

/// Distance of a point to the nearest triangle, rounded.
double distance(const geom::Vec3& p, const geom::Mesh& mesh) {
  const auto to_side = [&](const geom::Vec3& a, const geom::Vec3& b) {
    const geom::Vec3 d = b - a;
    const double square = d.squaredNorm();
    const double t = square > 0 ? std::clamp((p - a).dot(d) / square, 0.0, 1.0) : 0.0;
    return (p - a - t * d).norm();
  };
  double best = std::numeric_limits<double>::infinity();
  for (const geom::Triangle& t : mesh.triangles) {
    const geom::Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    best = std::min({best, to_side(a, b), to_side(b, c), to_side(c, a)});
    const geom::Vec3 n = (b - a).cross(c - a);
    if (n.cross(b - a).dot(p - a) >= 0 && n.cross(c - b).dot(p - b) >= 0 &&
        n.cross(a - c).dot(p - c) >= 0 && n.norm() > 0) {
      best = std::min(best, std::abs((p - a).dot(n.normalized())));
    }
  }
  return best;
}

}  // namespace

void keep(const MeshPair& pair) {
  const char* folder = std::getenv("KABOUM_KEEP");
  if (folder == nullptr) return;
  std::string stem = pair.name;
  for (char& c : stem) c = c == ' ' || c == '/' ? '-' : c;
  for (const auto& [mesh, which] : {std::pair{&pair.inner, "inner"}, {&pair.outer, "outer"}}) {
    std::ofstream file(std::string(folder) + '/' + stem + '.' + which + ".obj");
    file.precision(std::numeric_limits<double>::max_digits10);
    for (const geom::Vec3& p : mesh->vertices)
      file << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    for (const geom::Triangle& t : mesh->triangles)
      file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
}

void Tally::compare(const MeshPair& pair, const ArrangementVerdict& truth,
                    const verify::InclusionOptions& options) {
  verify::Inclusion claim;
  const std::string before = faults_;
  try {
    claim = verify::verify_inclusion(pair.inner, pair.outer, options);
  } catch (const std::exception& e) {
    fault(pair.name + ": " + e.what());
    keep(pair);
    return;
  }
  if (claim.inner_closed != truth.inner_closed || claim.outer_closed != truth.outer_closed)
    fault(pair.name + ": closedness");
  // What has no area has no solid; what has no triangles lies nowhere.
  const bool thin = with_area(pair.inner).triangles.empty(), none = pair.inner.triangles.empty();
  const bool relative = !thin && !(truth.inner_closed && truth.outer_closed) && truth.same_border;
  if (claim.relative != relative) fault(pair.name + ": relative or not");
  const Answer solid = answer_for(thin ? std::nullopt : relative ? truth.difference : truth.solid);
  if (claim.solid.answer != solid) {
    fault(pair.name + ": solid claim " + name_of(claim.solid.answer) + " but " + name_of(solid));
  }
  const Answer surface =
      answer_for(none                    ? std::nullopt
                 : truth.surface == true ? std::optional(thin_in_solid(pair.inner, pair.outer))
                                         : truth.surface);
  if (claim.surface.answer != surface) {
    fault(pair.name + ": surface claim " + name_of(claim.surface.answer) + " but " +
          name_of(surface));
  }
  // Triangles without area bound nothing.
  const geom::Mesh inner = with_area(pair.inner), outer = with_area(pair.outer);
  for (const verify::Claim* c : {&claim.solid, &claim.surface}) {
    if (c->answer != Answer::Refuted) {
      if (c->witness) fault(pair.name + ": a witness of nothing");
      continue;
    }
    if (!c->witness || c->reason.empty()) {
      fault(pair.name + ": refuted without witness or reason");
      continue;
    }
    if (c->inner_triangles.empty() && c->outer_triangles.empty())
      fault(pair.name + ": refuted without triangles");
    if (!c->witness->exact) {
      ++inexact_;
      continue;
    }
    ++exact_;
    // Open chains have no winding number; their difference has.
    const geom::Vec3& p = c->witness->point;
    bool contradicts = false;
    if (c == &claim.solid && relative) {
      MeshPair turned{"", inner, outer};
      for (geom::Triangle& t : turned.inner.triangles) std::swap(t[1], t[2]);
      const auto first = static_cast<std::uint32_t>(turned.outer.vertices.size());
      for (const geom::Vec3& v : turned.inner.vertices) turned.outer.vertices.push_back(v);
      for (const geom::Triangle& t : turned.inner.triangles)
        turned.outer.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      const auto w = winding_number_slow(turned.outer, p);
      contradicts = w && *w < 0;
    } else if (c == &claim.solid) {
      const auto a = winding_number_slow(inner, p), b = winding_number_slow(outer, p);
      contradicts = a && b && *a >= 1 && *b <= 0;
    } else {
      // It speaks of the inner mesh's surface: p is on it, or can be moved to it without meeting
      // the outer mesh.
      const auto b = winding_number_slow(outer, p);
      const double away = distance(p, pair.inner);
      contradicts =
          b && *b <= 0 && (away < 0.999 * distance(p, outer) || away < 1e-5 * (1 + p.norm()));
    }
    const double depth = distance(p, outer);
    const double error = 1e-12 * (depth + p.norm());
    if (!(std::abs(c->witness->depth - depth) <= error) && !outer.triangles.empty())
      fault(pair.name + ": the depth of the witness");
    if (!contradicts) fault(pair.name + ": the witness contradicts nothing");
  }
  if (faults_ != before) keep(pair);
}

void Tally::judge_one(const MeshPair& pair, std::uint64_t seed) {
  const ArrangementVerdict truth = arrangement_verdict(pair.inner, pair.outer);
  ++pairs_;
  if (truth.solid) ++solid_[*truth.solid ? 1 : 0];
  if (truth.surface) ++surface_[*truth.surface ? 1 : 0];
  if (!truth.solid && truth.difference) ++difference_[*truth.difference ? 1 : 0];
  compare(pair, truth, {});
  verify::InclusionOptions settling;  // the way of large coplanar overlaps
  settling.settle_from = 0;
  compare(permuted(pair, seed), truth, settling);
}

void Tally::judge(const MeshPair& pair, std::uint64_t seed) {
  judge_one(pair, seed);
  judge_one({pair.name + " reversed", pair.outer, pair.inner}, seed + 1);
}

}  // namespace kaboum::test
