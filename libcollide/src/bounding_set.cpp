// Predicates of whole sets: boxes leave out most pairs of bodies, exact proximity decides the
// others.

#include <kaboum/base/error.h>
#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::collide {
namespace {

using geom::Box3;
using geom::Vec3;

constexpr double kSumUp = 1 + 0x1p-50;
constexpr double kFarthest = 1e60;  ///< as Posed takes it

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
  return sum_up({a.margin_above(i), a.error(), b.margin_above(j), b.error(), slack});
}

/// Both margins, not above the exact sum.
double margins(const PosedSet& a, std::size_t i, const PosedSet& b, std::size_t j) {
  return (a.margin_below(i) + b.margin_below(j)) / kSumUp;
}

/// Bounds |LᵀL − I|: 0 for matrices that only swap axes and turn them round. An entry of nine errs
/// by less than 5 · 2^-52.
double bound_of_defect(const Eigen::Matrix3d& l, const Eigen::Matrix3d& defect) {
  if (((l.array() == 0) || (l.array() == 1) || (l.array() == -1)).all()) return 0;
  return defect.norm() + 0x1p-47;
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

/// A ball round the points that is at most a hundredth larger than the smallest
/// one: M. Bădoiu, K. L. Clarkson, Smaller core-sets for balls, 2003.
BoundingSet::Ball ball_of(const std::vector<BoundingSet::Body>& bodies, const Box3& box) {
  BoundingSet::Ball out;
  out.radius = std::numeric_limits<double>::infinity();
  if (box.empty()) return {};
  Vec3 center = box.center();
  for (int step = 1; step <= 100; ++step) {
    double most = 0;
    Vec3 farthest = center;
    for (const BoundingSet::Body& body : bodies) {
      for (const Vec3& p : body.hull.vertices) {
        const double reach = (p - center).norm() + body.margin;
        if (reach <= most) continue;
        most = reach;
        farthest = p;
      }
    }
    if (most < out.radius) out = {center, most};
    center += (farthest - center) / (step + 1);
  }
  out.radius *= kSumUp;
  return out;
}

double require_length(double x, const char* what) {
  if (!(x >= 0) || !std::isfinite(x))
    throw Error(ErrorCode::InvalidArgument,
                std::string("a bounding set with ") + what + " that is no number from 0 on");
  return x;
}

Direction direction_of(const geom::ConvexSet& set) {
  if (set.provenance.direction == "outer") return Direction::Outer;
  if (set.provenance.direction == "inner") return Direction::Inner;
  throw Error(ErrorCode::InvalidInput,
              "the set does not state whether it is an outer or an inner one");
}

std::vector<BoundingSet::Body> bodies_of(const geom::ConvexSet& set) {
  if (set.provenance.epsilon < 0)
    throw Error(ErrorCode::InvalidInput,
                "the set states no epsilon: how far it is from its solid is not certified");
  if (const auto i = geom::find_not_convex(set))
    throw Error(ErrorCode::InvalidInput,
                "body " + std::to_string(*i) + " ('" + set.bodies[*i].name + "') is not convex");
  std::vector<BoundingSet::Body> out;
  for (const geom::ConvexBody& body : set.bodies) out.push_back({body.hull, set.margin});
  return out;
}

}  // namespace

BoundingSet::BoundingSet(std::vector<Body> bodies, Direction direction, double epsilon)
    : bodies_(std::move(bodies)),
      direction_(direction),
      epsilon_(require_length(epsilon, "an epsilon")) {
  for (const Body& body : bodies_) {
    require_length(body.margin, "a margin");
    const Box3& box = polytopes_.emplace_back(body.hull.vertices).box();
    const Vec3 middle = box.center(), half = 0.5 * box.max - 0.5 * box.min;
    margins_.push_back(body.margin);
    for (int k = 0; k < 3; ++k) {
      middle_[k].push_back(middle[k]);
      half_[k].push_back(half[k]);
      magnitude_[k].push_back(polytopes_.back().magnitude()[k]);
    }
    const Vec3 reach = Vec3::Constant(body.margin * kSumUp) +
                       0x1p-50 * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs());
    box_.extend(Box3{box.min - reach, box.max + reach});
  }
  ball_ = ball_of(bodies_, box_);
}

BoundingSet::BoundingSet(const geom::ConvexSet& set)
    : BoundingSet(bodies_of(set), direction_of(set), set.provenance.epsilon) {}

PosedSet::PosedSet(const BoundingSet& set, const geom::Transform& pose, double error)
    : set_(&set), boxes_(6 * set.size()) {
  place(pose, error);
}

void PosedSet::place(const geom::Transform& pose, double error) {
  const Eigen::Matrix3d defect =
      pose.linear.transpose() * pose.linear - Eigen::Matrix3d::Identity();
  if (!(defect.cwiseAbs().maxCoeff() < 1e-9) || !(pose.linear.determinant() > 0))
    throw Error(ErrorCode::InvalidArgument, "a pose whose matrix is no rotation");
  if (!pose.translation.allFinite() || !(pose.translation.cwiseAbs().maxCoeff() <= kFarthest))
    throw Error(ErrorCode::InvalidArgument, "a pose with numbers beyond 1e60");
  pose_ = pose;
  error_ = require_length(error, "an error of its place");
  defect_ = bound_of_defect(pose.linear, defect);
  box_ = {};
  const std::size_t n = set_->size();
  for (std::size_t k = 0; k < 3 && n > 0; ++k) {
    // Posed::box, for all bodies at once.
    const double x = pose.linear(k, 0), y = pose.linear(k, 1), z = pose.linear(k, 2),
                 t = pose.translation[k];
    const auto &middle = set_->middle_, &half = set_->half_, &magnitude = set_->magnitude_;
    double *low = boxes_.data() + k * n, *high = low + 3 * n;
    for (std::size_t i = 0; i < n; ++i) {
      const double at = x * middle[0][i] + y * middle[1][i] + z * middle[2][i] + t;
      const double wide =
          std::abs(x) * half[0][i] + std::abs(y) * half[1][i] + std::abs(z) * half[2][i];
      const double large = std::abs(x) * magnitude[0][i] + std::abs(y) * magnitude[1][i] +
                           std::abs(z) * magnitude[2][i] + std::abs(t);
      // Margin and error, rounded up.
      const double reach = (set_->margins_[i] * (1 + defect_) + error) * kSumUp;
      const double most = (wide + reach) * (1 + 0x1p-48) + 0x1p-48 * large + 0x1p-900;
      low[i] = at - most;
      high[i] = at + most;
    }
    box_.min[k] = *std::min_element(low, low + n);
    box_.max[k] = *std::max_element(high, high + n);
  }
}

/// Pairs of bodies whose boxes meet.
struct BoxPairs {
  const PosedSet &a, &b;
  double slack;

  /// Calls visit(i, j) for them until it is true.
  template <typename Visit>
  [[nodiscard]] bool any(const Visit& visit) const {
    const std::size_t n = a.set().size(), m = b.set().size();
    const Box3 all = enlarged(b.box(), slack);
    if (n == 0 || m == 0 || !overlap(a.box(), all)) return false;
    for (std::size_t i = 0; i < n; ++i) {
      if (!overlap(a.box(i), all)) continue;
      const Box3 own = enlarged(a.box(i), slack);
      for (std::size_t j = 0; j < m; ++j)
        if (meets(own, j) && visit(i, j)) return true;
    }
    return false;
  }

  [[nodiscard]] bool meets(const Box3& own, std::size_t j) const {
    return own.min[0] <= b.high(0)[j] && b.low(0)[j] <= own.max[0] && own.min[1] <= b.high(1)[j] &&
           b.low(1)[j] <= own.max[1] && own.min[2] <= b.high(2)[j] && b.low(2)[j] <= own.max[2];
  }
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
  static_cast<void>(BoxPairs{a, b, slack}.any([&](std::size_t i, std::size_t j) {
    Axis* axis = memory == nullptr ? nullptr : memory->axis(i, j, a.set().size(), b.set().size());
    if (are_within(a.body(i), b.body(j), reach_of(a, i, b, j, slack), axis, decided))
      found = {i, j};
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
    const auto smaller = shrunk(a.set().body(i).hull, errors);
    return smaller && are_within(Posed(*smaller, a.pose()), b.body(j), margins(a, i, b, j));
  });
}

std::optional<Clearance> clearance(const PosedSet& a, const PosedSet& b) {
  struct Candidate {
    double least;
    BodyPair pair;
  };
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < a.set().size(); ++i) {
    for (std::size_t j = 0; j < b.set().size(); ++j) {
      const Vec3 apart = (a.box(i).min - b.box(j).max)
                             .cwiseMax(b.box(j).min - a.box(i).max)
                             .cwiseMax(Vec3::Zero());
      // The boxes hold the margins; rounding of the difference is relative to what it is of.
      const double scale = a.box(i).min.cwiseAbs().sum() + a.box(i).max.cwiseAbs().sum() +
                           b.box(j).min.cwiseAbs().sum() + b.box(j).max.cwiseAbs().sum();
      candidates.push_back({apart.norm() / kSumUp - 0x1p-48 * scale, {i, j}});
    }
  }
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
    const double upper =
        std::max((gap.upper + a.error() + b.error()) * kSumUp - margins(a, pair.a, b, pair.b), 0.0);
    if (upper >= out.upper) continue;
    out.upper = upper;
    out.bodies = pair;
    out.on_a = gap.on_a;
    out.on_b = gap.on_b;
  }
  return out;
}

}  // namespace kaboum::collide
