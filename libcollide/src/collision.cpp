// Predicates of whole sets: boxes leave out most pairs of bodies, exact proximity decides the
// others.

#include <kaboum/base/error.h>
#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "lengths.h"
#include "meeting.h"

namespace kaboum::collide {
namespace {

using detail::kSumUp;
using detail::require_length;
using geom::Box3;
using geom::Vec3;

bool overlap(const Box3& a, const Box3& b) {
  return a.min.x() <= b.max.x() && b.min.x() <= a.max.x() && a.min.y() <= b.max.y() &&
         b.min.y() <= a.max.y() && a.min.z() <= b.max.z() && b.min.z() <= a.max.z();
}

Box3 enlarged(const Box3& box, double by) {
  if (by == 0) return box;
  const Vec3 all = Vec3::Constant(by) + 0x1p-50 * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs());
  return {box.min - all, box.max + all};
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

/// Pairs of bodies whose boxes meet, 64 bodies of b after the other. Boxes round 64 bodies, and
/// round 64 of such boxes, leave out most of a set of very many.
struct BoxPairs {
  const PosedSet &a, &b;
  double slack;

  static constexpr std::size_t kBlock = PosedSet::kBlock;

  /// Calls visit(i, j) for them until it is true.
  template <typename Visit>
  [[nodiscard]] bool any(const Visit& visit) const {
    // Only b is looked at by blocks.
    if (a.set().size() > kVeryMany && b.set().size() < a.set().size())
      return BoxPairs{b, a, slack}.any_in_order(
          [&](std::size_t j, std::size_t i) { return visit(i, j); });
    return any_in_order(visit);
  }

 private:
  static constexpr std::size_t kVeryMany = 4096;

  template <typename Visit>
  [[nodiscard]] bool any_in_order(const Visit& visit) const {
    const std::size_t n = a.set().size(), m = b.set().size();
    const Box3 all = enlarged(b.box(), slack), whole = enlarged(a.box(), slack);
    if (n == 0 || m == 0 || !overlap(whole, b.box())) return false;
    const Query<Visit> query{*this, all, whole, visit};
    return query.any_of_level(b.levels_.size(), 0, b.levels_.empty() ? m : b.levels_.back().count);
  }

  template <typename Visit>
  struct Query {
    const BoxPairs& pairs;
    const Box3 &all, &whole;
    const Visit& visit;

    /// @param level  0: of bodies. @param from, count  of the boxes that are looked at
    [[nodiscard]] bool any_of_level(std::size_t level, std::size_t from, std::size_t count) const {
      const PosedSet& b = pairs.b;
      if (level == 0) {
        const detail::BoxRows rows{{b.low(0), b.low(1), b.low(2)},
                                   {b.high(0), b.high(1), b.high(2)}};
        // Most are far from all of a.
        const std::uint64_t near = detail::meeting_boxes(rows, from, count, whole);
        return near != 0 && any_of_bodies(from, near);
      }
      const PosedSet::Level& here = b.levels_[level - 1];
      const double* at = b.boxes_->data() + here.from;
      const auto row = [&](std::size_t k) { return at + k * here.count; };
      const detail::BoxRows rows{{row(0), row(1), row(2)}, {row(3), row(4), row(5)}};
      const std::size_t below = level == 1 ? b.set().size() : b.levels_[level - 2].count;
      for (std::uint64_t left = detail::meeting_boxes(rows, from, count, whole); left != 0;
           left &= left - 1) {
        const std::size_t first =
            kBlock * (from + static_cast<std::size_t>(std::countr_zero(left)));
        if (any_of_level(level - 1, first, std::min(below - first, kBlock))) return true;
      }
      return false;
    }

    /// @param near  a bit for each body of b from `from` on that is looked at
    [[nodiscard]] bool any_of_bodies(std::size_t from, std::uint64_t near) const {
      const PosedSet &a = pairs.a, &b = pairs.b;
      for (std::size_t i = 0; i < a.set().size(); ++i) {
        const Box3 one = a.box(i);
        if (!overlap(one, all)) continue;
        const Box3 own = enlarged(one, pairs.slack);
        for (std::uint64_t left = near; left != 0; left &= left - 1) {
          const std::size_t j = from + static_cast<std::size_t>(std::countr_zero(left));
          if (overlap(own, b.box(j)) && visit(i, j)) return true;
        }
      }
      return false;
    }
  };
};

/// Boxes of two sets' bodies along the axes of both sets
/// (docs/algorithms/bounded-predicates.md, "Boxes").
class OrientedBoxes {
 public:
  OrientedBoxes(const PosedSet& a, const PosedSet& b) : a_(a.set()), b_(b.set()) {
    const geom::Transform &at_a = a.pose(), &at_b = b.pose();
    between_ = at_a.linear.transpose() * at_b.linear;
    const Vec3 way = at_b.translation - at_a.translation;
    way_a_ = at_a.linear.transpose() * way;
    way_b_ = at_b.linear.transpose() * way;
    size_ = at_a.translation.lpNorm<1>() + at_b.translation.lpNorm<1>();
  }

  /// True only for bodies that are farther apart than `reach`.
  [[nodiscard]] bool are_beyond(std::size_t i, std::size_t j, double reach) const {
    const Vec3 middle_a = a_.column(0, i), half_a = a_.column(3, i), middle_b = b_.column(0, j),
               half_b = b_.column(3, j);
    const double size = size_ + a_.polytope(i).magnitude().sum() + b_.polytope(j).magnitude().sum();
    const double most = kUp * reach + kError * size + 1e-200;
    for (int k = 0; k < 3; ++k) {
      const double x = between_(k, 0), y = between_(k, 1), z = between_(k, 2);
      const double way =
          way_a_[k] + x * middle_b[0] + y * middle_b[1] + z * middle_b[2] - middle_a[k];
      const double wide =
          std::abs(x) * half_b[0] + std::abs(y) * half_b[1] + std::abs(z) * half_b[2] + half_a[k];
      if (std::abs(way) > kUp * wide + most) return true;
    }
    for (int k = 0; k < 3; ++k) {
      const double x = between_(0, k), y = between_(1, k), z = between_(2, k);
      const double way =
          way_b_[k] - x * middle_a[0] - y * middle_a[1] - z * middle_a[2] + middle_b[k];
      const double wide =
          std::abs(x) * half_a[0] + std::abs(y) * half_a[1] + std::abs(z) * half_a[2] + half_b[k];
      if (std::abs(way) > kUp * wide + most) return true;
    }
    return false;
  }

 private:
  static constexpr double kError = 1e-8, kUp = 1 + kError;
  const BoundingSet &a_, &b_;
  Eigen::Matrix3d between_;
  Vec3 way_a_, way_b_;  ///< from a to b, along the axes of each
  double size_;
};

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
  std::optional<BodyPair> found;
  std::optional<OrientedBoxes> boxes;
  static_cast<void>(BoxPairs{a, b, slack}.any([&](std::size_t i, std::size_t j) {
    const double reach = reach_of(a, i, b, j, slack);
    if (!boxes) boxes.emplace(a, b);
    if (boxes->are_beyond(i, j, reach)) return false;
    Axis* axis = memory == nullptr ? nullptr : memory->axis(i, j, a.set().size(), b.set().size());
    if (are_within(a.body(i), b.body(j), reach, axis, decided)) found = {i, j};
    return found.has_value();
  }));
  return found;
}

bool certainly_collide(const PosedSet& a, const PosedSet& b) {
  for (const PosedSet* s : {&a, &b})
    if (s->set().direction() == Direction::Outer && s->set().epsilon() > 0)
      throw Error(ErrorCode::InvalidArgument, "a certain collision is looked for with inner sets");
  const double errors = sum_up({a.error(), b.error()});
  return BoxPairs{a, b, 0}.any([&](std::size_t i, std::size_t j) {
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
  const auto least_of = [&](std::size_t i, std::size_t j) {
    const Vec3 apart =
        (a.box(i).min - b.box(j).max).cwiseMax(b.box(j).min - a.box(i).max).cwiseMax(Vec3::Zero());
    // The boxes hold the margins; rounding of the difference is relative to what it is of.
    const double scale = a.box(i).min.cwiseAbs().sum() + a.box(i).max.cwiseAbs().sum() +
                         b.box(j).min.cwiseAbs().sum() + b.box(j).max.cwiseAbs().sum();
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
