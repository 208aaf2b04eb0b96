// Predicates of whole sets: boxes leave out most pairs of bodies, exact proximity decides the
// others.

#include <kaboum/base/error.h>
#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "closed_forms.h"
#include "facings.h"
#include "lengths.h"

namespace kaboum::collide {
namespace {

using detail::Facings;
using detail::kSumUp;
using detail::require_length;
using geom::Box3;
using geom::Vec3;

constexpr std::size_t kVeryMany = 4096;

double square_size(const PosedSet& set) {
  const Box3& box = set.set().box();
  return (box.max - box.min).squaredNorm();
}

/// Sum of lengths, not below the exact one; exact when one of them is all.
double sum_up(std::initializer_list<double> lengths) {
  double sum = 0;
  int parts = 0;
  for (const double x : lengths) {
    sum += x;
    parts += x > 0 ? 1 : 0;
  }
  return parts > 1 ? sum * kSumUp : sum;
}

double reach_of(const PosedSet& a, std::size_t i, const PosedSet& b, std::size_t j, double slack) {
  return sum_up({a.radius_above(i), a.error(), b.radius_above(j), b.error(), slack});
}

/// Both margins, not above the exact sum.
double margins(const PosedSet& a, std::size_t i, const PosedSet& b, std::size_t j) {
  return (a.radius_below(i) + b.radius_below(j)) / kSumUp;
}

/// A polytope that is more than `by` inside the hull all round; nullopt where the hull is too thin.
/// It is scaled about a point that is at least r below all planes: then by r times the scale.
std::optional<Polytope> shrunk(const geom::Mesh& hull, double by) {
  Vec3 center = Vec3::Zero();
  double largest = 0;
  for (const Vec3& p : hull.vertices) {
    center += p / static_cast<double>(hull.vertices.size());
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  double inside = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : hull.triangles) {
    const Vec3& a = hull.vertices[i];
    const Vec3 u = hull.vertices[j] - a, v = hull.vertices[k] - a, n = u.cross(v);
    // |n| is wrong by less than 2^-49 |u| |v|; slivers are not used.
    if (!(n.norm() > 0x1p-20 * u.norm() * v.norm())) return std::nullopt;
    inside = std::min(inside, n.dot(a - center) / n.norm() - 0x1p-24 * largest);
  }
  const double share = 2 * (by + 0x1p-48 * largest) / inside;
  if (!(share > 0 && share < 0.5)) return std::nullopt;
  std::vector<Vec3> points;
  for (const Vec3& p : hull.vertices) points.emplace_back(p + share * (center - p));
  return Polytope(points);
}

}  // namespace

Axis* Memory::axis(std::size_t i, std::size_t j, std::size_t n, std::size_t m) {
  constexpr std::size_t kMost = 1 << 16;
  if (n * m > kMost) return nullptr;
  if (axes_.size() != n * m) axes_.assign(n * m, Axis::Zero());
  return &axes_[i * m + j];
}

std::optional<BodyPair> find_collision(const PosedSet& a, const PosedSet& b, double slack,
                                       Memory* memory, Decided* decided) {
  if (a.set().direction() != Direction::Outer || b.set().direction() != Direction::Outer)
    throw Error(ErrorCode::InvalidArgument, "a collision is looked for with outer sets");
  require_length(slack, "a slack");
  const std::size_t n = a.set().size(), m = b.set().size();
  // Bodies of the set that reaches farther are looked at one by one, where they are near the other
  // one, and those of that one eight at a time.
  const bool by_blocks_of_a = n > kVeryMany && m < n;
  const bool a_faces = by_blocks_of_a || (m <= Facings::kBlock && square_size(a) > square_size(b));
  // Of pairs that meet, that with the first lane is meant, among 64 bodies that face it; or else
  // that with the first body that faces.
  const bool lanes_first = !a_faces || by_blocks_of_a;
  const Facings facings(a_faces ? a : b, a_faces ? b : a, slack);
  const auto meet = [&](std::size_t face, std::size_t lane) {
    const std::size_t i = a_faces ? face : lane, j = a_faces ? lane : face;
    Axis* axis = memory == nullptr ? nullptr : memory->axis(i, j, n, m);
    return are_within(a.body(i), b.body(j), reach_of(a, i, b, j, slack), axis, decided);
  };
  std::optional<BodyPair> found;
  std::size_t best = a_faces ? m : n;
  static_cast<void>(facings.any_block([&](std::size_t from, std::uint64_t near) {
    for (std::uint64_t left = near; left != 0 && best > 0; left &= left - 1) {
      const std::size_t face = from + static_cast<std::size_t>(std::countr_zero(left));
      const std::size_t lane = facings.first_to_meet(face, best, meet, decided);
      if (lane == best) continue;
      best = lane;
      found = a_faces ? BodyPair{face, lane} : BodyPair{lane, face};
      if (!lanes_first) break;
    }
    return found.has_value();
  }));
  return found;
}

bool certainly_collide(const PosedSet& a, const PosedSet& b) {
  for (const PosedSet* s : {&a, &b})
    if (s->set().direction() == Direction::Outer && s->set().epsilon() > 0)
      throw Error(ErrorCode::InvalidArgument, "a certain collision is looked for with inner sets");
  const double errors = sum_up({a.error(), b.error()});
  const bool a_faces = a.set().size() > kVeryMany && b.set().size() < a.set().size();
  return Facings(a_faces ? a : b, a_faces ? b : a, 0).any_pair([&](std::size_t f, std::size_t l) {
    const std::size_t i = a_faces ? f : l, j = a_faces ? l : f;
    if (errors == 0) return are_within(a.body(i), b.body(j), margins(a, i, b, j));
    const double radii = margins(a, i, b, j);
    if (radii > 2 * errors) return are_within(a.body(i), b.body(j), (radii - errors) / kSumUp);
    const auto smaller = shrunk(a.set().body(i).core, errors);
    return smaller && are_within(Posed(*smaller, a.pose()), b.body(j), radii);
  });
}

std::optional<Clearance> clearance(const PosedSet& a, const PosedSet& b) {
  struct Candidate {
    double least;
    BodyPair pair;
  };
  const std::vector<Box3> boxes_a = a.boxes(), boxes_b = b.boxes();
  const auto least_of = [&](std::size_t i, std::size_t j) {
    const Box3 &x = boxes_a[i], &y = boxes_b[j];
    const Vec3 apart = (x.min - y.max).cwiseMax(y.min - x.max).cwiseMax(Vec3::Zero());
    // The boxes hold the margins; rounding of the difference is relative to what it is of.
    const double scale = x.min.cwiseAbs().sum() + x.max.cwiseAbs().sum() + y.min.cwiseAbs().sum() +
                         y.max.cwiseAbs().sum();
    return apart.norm() / kSumUp - 0x1p-48 * scale;
  };
  const auto upper_of = [&](const Gap& gap, std::size_t i, std::size_t j) {
    return std::max((gap.upper + a.error() + b.error()) * kSumUp - margins(a, i, b, j), 0.0);
  };
  // The bound by which very many pairs are pruned: what the pair with the nearest boxes has.
  constexpr std::size_t kMany = 1 << 16;
  double most = std::numeric_limits<double>::infinity();
  if (a.set().size() * b.set().size() > kMany) {
    Candidate best{most, {}};
    for (std::size_t i = 0; i < a.set().size(); ++i)
      for (std::size_t j = 0; j < b.set().size(); ++j)
        if (const double least = least_of(i, j); least < best.least) best = {least, {i, j}};
    const auto [i, j] = best.pair;
    most = upper_of(gap_between(a.body(i), b.body(j)), i, j);
  }
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < a.set().size(); ++i)
    for (std::size_t j = 0; j < b.set().size(); ++j)
      if (const double least = least_of(i, j); least <= most) candidates.push_back({least, {i, j}});
  if (candidates.empty()) return std::nullopt;
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.least < y.least; });
  Clearance out;
  out.lower = out.upper = std::numeric_limits<double>::infinity();
  for (const auto& [least, pair] : candidates) {
    if (least > out.upper) break;
    const Gap gap = gap_between(a.body(pair.a), b.body(pair.b));
    const double reach = reach_of(a, pair.a, b, pair.b, 0);
    out.lower = std::min(out.lower, std::max((gap.lower - reach) / kSumUp, 0.0));
    const double upper = upper_of(gap, pair.a, pair.b);
    if (upper >= out.upper) continue;
    out.upper = upper;
    out.bodies = pair;
    out.on_a = gap.on_a;
    out.on_b = gap.on_b;
  }
  return out;
}

}  // namespace kaboum::collide
