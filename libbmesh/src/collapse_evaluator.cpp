// The place of the vertex that replaces an edge, and the exact tests that it
// has to pass. Source: [gaschler2016] Alg. 1; docs/algorithms/bounding-mesh.md
// has the theorem that they serve.

#include "collapse_evaluator.h"

#include <kaboum/geom/float32.h>

#include <array>
#include <cmath>
#include <limits>

#include "closest_triangle.h"

namespace kaboum::bmesh {
namespace {

using geom::Sign;
using geom::Triangle;

/// Spacing of the representable numbers at x, at least.
double spacing(double x, Precision precision) {
  if (precision == Precision::Float) return geom::float32_spacing(x);
  const double a = std::abs(x);
  return std::nextafter(a, std::numeric_limits<double>::infinity()) - a;
}

/// What the minimiser may be wrong by, as a share of the step: some hundred roundings.
constexpr double kPlacementError = 1e-13;
/// Coordinates this near to a plane across an axis are put on it: with float32, of the minimiser's
/// error, as what is rounded to float32 comes to lie on it anyway; with double, of the step.
constexpr double kSnapFloat = 0.01, kSnapDouble = 1e-9;
/// About the nanoseconds that a candidate takes, and each triangle of its star.
constexpr std::uint64_t kCandidate = 500, kStarTriangle = 100;

/// The axis that a unit normal is, or -1.
int axis(const Vec3& n) {
  if (n.x() != 0 && n.y() != 0) return -1;  // most
  if ((n.x() == 0) + (n.y() == 0) + (n.z() == 0) != 2) return -1;
  return n.x() != 0 ? 0 : n.y() != 0 ? 1 : 2;
}

geom::Box3 box_of(const std::vector<Vec3>& points) {
  geom::Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

}  // namespace

Context::Context(const geom::Mesh& input, bool is_closed, const DecimateOptions& requested,
                 Work* counter)
    : Context(box_of(input.vertices), is_closed, requested, counter) {}

Context::Context(const geom::Box3& box, bool is_closed, const DecimateOptions& requested,
                 Work* counter)
    : options(requested),
      cost(requested, box),
      sign(requested.direction == Direction::Inner ? -1 : 1),
      constrained(requested.direction != Direction::Any),
      closed(is_closed),
      diagonal(box.diagonal()),
      clamp_box(0.5 * (box.max - box.min) + Vec3::Constant(box.diagonal())),
      work(counter) {}

CollapseEvaluator::CollapseEvaluator(const Context& context, const WorkingMesh& mesh,
                                     ReferenceSolid* solid, DecimateStatistics& statistics)
    : context_(context),
      options_(context.options),
      m_(mesh),
      solid_(solid),
      statistics_(statistics),
      star_(mesh) {}

CollapseEvaluator::Validity CollapseEvaluator::evaluate(std::uint32_t a, std::uint32_t b,
                                                        const Quadric& q, Purpose purpose,
                                                        const BucketQueue& queue) {
  candidate_.a = a;
  candidate_.b = b;
  candidate_.against_original = false;
  star_.gather(a, b);
  count(context_.work, kCandidate + kStarTriangle * star_.triangles.size());
  const bool free = m_.border[a] == 0 && m_.border[b] == 0;
  bool found = false;
  if (free) {
    if (has_rim()) star_.gather_rim();
    found = place(q, 1);
    if (found && purpose == Purpose::Due) {
      find_cost(q);
      if (!queue.due(candidate_.cost)) return Validity::Later;
    }
  }
  const auto none = [](std::uint64_t& counter) {
    ++counter;
    return Validity::None;
  };
  if (!star_.keeps_topology(a, b)) return none(statistics_.rejected_topology);
  if (!free) {
    candidate_.position = m_.border[a] != 0 ? m_.position[a] : m_.position[b];
    if (!encloses()) return none(statistics_.rejected_predicate);
  } else {
    // The second attempt keeps farther from the planes, for positions that
    // rounding spoils; the end points themselves serve in flat places, where
    // every plane of the star is the same one.
    const bool placed = found && (encloses() || (place(q, 16) && encloses()));
    if (!placed && !at_end_point()) {
      if (purpose == Purpose::AgainstOriginal) {
        candidate_.encloses = false;
        candidate_.position = m_.position[a] + 0.5 * (m_.position[b] - m_.position[a]);
        return Validity::Valid;
      }
      return none(found ? statistics_.rejected_predicate : statistics_.rejected_no_position);
    }
  }
  candidate_.enclosing = candidate_.position;
  candidate_.encloses = !folds();
  if (!candidate_.encloses && purpose != Purpose::AgainstOriginal)
    return none(statistics_.rejected_fold);
  find_cost(q);
  return Validity::Valid;
}

bool CollapseEvaluator::evaluate_move(std::uint32_t v, double care, bool may_fold) {
  candidate_.a = candidate_.b = v;
  star_.gather(v);
  if (has_rim()) star_.gather_rim();
  const Quadric nearest = point_quadric(m_.position[v] - context_.cost.origin());
  return place(nearest, care) && encloses() && (may_fold || !folds()) && keeps_shape();
}

bool CollapseEvaluator::place_against_original(const Vec3& place, const Quadric& q) {
  const Vec3 before = candidate_.position;
  candidate_.position = place;
  if (is_too_far_out() || folds()) {
    candidate_.position = before;
    return false;
  }
  candidate_.against_original = true;
  find_cost(q);
  return true;
}

bool CollapseEvaluator::keeps_shape() {
  if (options_.keep_convex && !stays_convex()) {
    ++statistics_.rejected_predicate;
    return false;
  }
  if (stays_inside()) return true;
  ++statistics_.rejected_original;
  return false;
}

void CollapseEvaluator::find_cost(const Quadric& q) {
  candidate_.cost =
      context_.cost.key(q, candidate_.position,
                        (m_.position[candidate_.b] - m_.position[candidate_.a]).squaredNorm());
  if (options_.cost != Cost::Distance) return;
  // Beyond a knife's edge a vertex is near all planes, and far from the
  // triangles.
  constexpr double kFar = 0.125;
  const Vec3 &p = candidate_.position, &a = m_.position[candidate_.a],
             &b = m_.position[candidate_.b];
  double squared = squared_distance(p, {a, b, b});
  const double enough = candidate_.cost * candidate_.cost / (kFar * kFar);
  for (std::size_t i = 0; i < star_.triangles.size() && squared > enough; ++i) {
    const Triangle& t = m_.mesh[star_.triangles[i].index];
    squared = std::min(
        squared, squared_distance(p, {m_.position[t[0]], m_.position[t[1]], m_.position[t[2]]}));
  }
  candidate_.cost = std::max(candidate_.cost, kFar * std::sqrt(squared));
}

/// Tries to contract to an end point of the edge, where it is.
bool CollapseEvaluator::at_end_point() {
  for (const std::uint32_t v : {candidate_.a, candidate_.b}) {
    candidate_.position = m_.position[v];
    if (options_.precision == Precision::Float && !geom::is_float32(candidate_.position)) continue;
    if (encloses() && !folds()) return true;
  }
  return false;
}

/// Whether a rounded vertex can lie exactly on the triangle's plane: it is
/// axis-aligned, at a representable coordinate.
bool CollapseEvaluator::can_lie_on(std::uint32_t t) const {
  const int k = axis(m_.normal[t]);
  return k >= 0 && (options_.precision == Precision::Double ||
                    geom::is_float32(m_.position[m_.mesh[t][0]][k]));
}

/// How far the new vertex is from where its star was seen from: half the edge,
/// or half the longest edge around a vertex that moves alone.
double CollapseEvaluator::step_bound() const {
  const Vec3& a = m_.position[candidate_.a];
  if (candidate_.a != candidate_.b) return 0.5 * (m_.position[candidate_.b] - a).lpNorm<1>();
  double longest = 0;
  for (const StarTriangle& s : star_.triangles)
    for (const std::uint32_t v : m_.mesh[s.index])
      longest = std::max(longest, (m_.position[v] - a).lpNorm<1>());
  return 0.5 * longest;
}

/// Minimises the quadric over the half-spaces of the star and rounds the
/// result.
bool CollapseEvaluator::place(const Quadric& q, double care) {
  ++statistics_.placements;
  const Vec3 &pa = m_.position[candidate_.a], &pb = m_.position[candidate_.b];
  const Vec3 half = 0.5 * (pb - pa);
  const Vec3 middle = pa + half;
  // A rounded coordinate is off by half a spacing; what else is off is the
  // minimiser's own error.
  const Vec3 spread(spacing(middle.x(), options_.precision),
                    spacing(middle.y(), options_.precision),
                    spacing(middle.z(), options_.precision));
  const double extent = step_bound(), own_error = kPlacementError * extent;
  planes_.clear();
  if (context_.constrained) {
    const double sign = context_.sign;
    for (const StarTriangle& s : star_.triangles) {
      const Vec3& n = m_.normal[s.index];
      const double margin =
          can_lie_on(s.index) ? 0 : care * (kHalfSpacing * n.cwiseAbs().dot(spread) + own_error);
      // Height of the middle over the plane, which passes through a or b.
      const double height = s.vanishes ? 0 : s.at_b ? -n.dot(half) : n.dot(half);
      planes_.push_back({sign * n, margin - sign * height});
    }
    for (const std::uint32_t t : star_.rim) {
      const Vec3& n = m_.normal[t];
      const double margin =
          can_lie_on(t) ? 0 : care * (kHalfSpacing * n.cwiseAbs().dot(spread) + own_error);
      planes_.push_back({-n, margin + n.dot(middle - m_.position[m_.mesh[t][0]])});
    }
  }
  const auto y = minimise(q, q.half_gradient(middle - context_.cost.origin()), planes_,
                          context_.cost.regularisation());
  if (!y) return false;
  candidate_.position = middle + *y;
  if (options_.precision == Precision::Float) {
    // Numbers near 0 are finer than the minimiser; what keeps away from other
    // planes stays so.
    snap_to_axis_planes(kSnapFloat * own_error);
    candidate_.position = geom::to_float32(candidate_.position);
  } else {
    snap_to_axis_planes(kSnapDouble * extent);
  }
  return !is_too_far_out();
}

bool CollapseEvaluator::is_too_far_out() const {
  return !((candidate_.position - context_.cost.origin()).cwiseAbs().array() <=
           context_.clamp_box.array())
              .all();
}

/// Puts the position exactly on axis-aligned planes that it is on but for
/// rounding.
void CollapseEvaluator::snap_to_axis_planes(double distance) {
  for (const StarTriangle& s : star_.triangles) {
    const int k = axis(m_.normal[s.index]);
    if (k < 0) continue;
    const double c = m_.position[m_.mesh[s.index][0]][k];
    if (std::abs(candidate_.position[k] - c) <= distance) candidate_.position[k] = c;
  }
}

Sign CollapseEvaluator::side(std::uint32_t t) {
  ++statistics_.predicates;
  const Triangle& tri = m_.mesh[t];
  return geom::orient3d(m_.position[tri[0]], m_.position[tri[1]], m_.position[tri[2]],
                        candidate_.position, &statistics_.exact_fallbacks);
}

/// The exact test that the certificate rests on: the new vertex is on the right
/// side of, or on, the plane of every triangle of the star.
bool CollapseEvaluator::encloses() {
  if (!context_.constrained) return true;
  const Sign wrong = options_.direction == Direction::Inner ? Sign::Positive : Sign::Negative;
  for (const StarTriangle& s : star_.triangles)
    if (side(s.index) == wrong) return false;
  for (const std::uint32_t t : star_.rim)
    if (side(t) == Sign::Positive) return false;
  return true;
}

/// Whether a remaining triangle would collapse or turn by more than about 80
/// degrees.
bool CollapseEvaluator::folds() const {
  for (const StarTriangle& s : star_.triangles) {
    if (s.vanishes) continue;
    const Vec3& before = m_.normal[s.index];
    if (before.x() == 0 && before.y() == 0 && before.z() == 0) continue;
    const Triangle& t = m_.mesh[s.index];
    const Vec3& p = m_.position[t[(s.corner + 1) % 3]];
    const Vec3 n =
        (p - candidate_.position).cross(m_.position[t[(s.corner + 2) % 3]] - candidate_.position);
    if (bmesh::folds(before, n)) return true;
  }
  return false;
}

/// Exact: all that an inner step takes away is inside the original, so that no
/// new triangle leaves it: no fold. docs/algorithms/bounding-mesh.md, "Inner
/// surfaces".
bool CollapseEvaluator::stays_inside() {
  if (options_.direction != Direction::Inner || solid_ == nullptr) return true;
  flat_.clear();
  for (const StarTriangle& s : star_.triangles) {
    const Triangle& t = m_.mesh[s.index];
    const std::array<Vec3, 3> old{m_.position[t[0]], m_.position[t[1]], m_.position[t[2]]};
    if (side(s.index) != Sign::Zero) {
      if (!solid_->contains({old[0], old[1], old[2], candidate_.position}, true)) return false;
      continue;
    }
    if (s.vanishes) continue;
    std::array<Vec3, 3> now = old;
    now[s.corner] = candidate_.position;
    if (!same_orientation(old, now, &statistics_.exact_fallbacks)) return false;
    flat_.push_back(m_.normal[s.index]);
  }
  return !opposed(flat_);
}

/// Exact: no vertex would be above a new triangle. The other triangles keep all
/// vertices below them: outwards the new vertex was tested against those across
/// the star's boundary (beyond them none is visible from it), inwards it lies
/// in the old, convex body.
bool CollapseEvaluator::stays_convex() {
  const bool inner = options_.direction == Direction::Inner;
  bool solid = !inner;  // inwards the body might be flattened
  for (const StarTriangle& s : star_.triangles) {
    if (s.vanishes) continue;
    const Triangle& t = m_.mesh[s.index];
    const Vec3 &p = m_.position[t[(s.corner + 1) % 3]], &q = m_.position[t[(s.corner + 2) % 3]];
    const auto below = [&](std::uint32_t v) {
      if (v == candidate_.a || v == candidate_.b) return true;
      ++statistics_.predicates;
      const Sign height =
          geom::orient3d(candidate_.position, p, q, m_.position[v], &statistics_.exact_fallbacks);
      solid = solid || height == Sign::Negative;
      return height != Sign::Positive;
    };
    if (inner) {
      for (std::uint32_t v = 0; v < m_.position.size(); ++v)
        if (m_.mesh.used(v) && !below(v)) return false;
      continue;
    }
    for (const std::uint32_t r : star_.rim)
      for (const std::uint32_t v : m_.mesh[r])
        if (!below(v)) return false;
  }
  return solid;
}

}  // namespace kaboum::bmesh
