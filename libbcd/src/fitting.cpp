// Boxes and capsules within an outer parallel body. docs/algorithms/capsules-and-boxes.md.
#include "fitting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kaboum::bcd {
namespace {

/// Relative allowance for rounding of lengths.
constexpr double kFitRounding = 1e-11;
constexpr int kCircleSteps = 40;   ///< towards the centre of a smallest circle
constexpr int kSectionSteps = 24;  ///< of a golden section: leaves 1e-5 of the length

/// A segment, and what is asked for often.
struct Segment {
  Segment(const Vec3& a, const Vec3& b)
      : from(a),
        along(b - a),
        inverse(along.squaredNorm() > 1e-300 ? 1 / along.squaredNorm() : 0) {}

  [[nodiscard]] Vec3 nearest(const Vec3& p) const {
    return from + std::clamp((p - from).dot(along) * inverse, 0.0, 1.0) * along;
  }
  [[nodiscard]] double distance(const Vec3& p) const { return (p - nearest(p)).norm(); }

  Vec3 from, along;
  double inverse;  ///< of the square of its length; 0 of about a point
};

/// Distance of c from a convex set that holds the cap, a convex function of c.
double distance_from_cap(const ParallelBody::Cap& cap, double h, const Vec3& c) {
  const Vec3 to = c - cap.center;
  const double square = to.squaredNorm(), along = cap.normal.dot(to);
  const double up = std::max(0.0, cap.height - along);
  const double away = std::sqrt(std::max(0.0, square - along * along));
  const double width =
      cap.height > 0 ? std::sqrt(std::max(0.0, h * h - cap.height * cap.height)) : h;
  const double aside = std::max(0.0, away - width);
  return std::max(std::sqrt(up * up + aside * aside), std::sqrt(square) - h);
}

/// A bound from below of the least value along the segment, by golden section: the function is
/// convex, and changes by no more than the way. It ends where the least value is known to be more
/// than `enough`.
double distance_from_cap(const ParallelBody::Cap& cap, double h, const Vec3& from, const Vec3& to,
                         double enough) {
  constexpr double kGolden = 0.6180339887498949;
  const double length = (to - from).norm();
  const auto at = [&](double t) { return distance_from_cap(cap, h, from + t * (to - from)); };
  double low = 0, high = 1, a = high - kGolden, b = low + kGolden;
  double at_a = at(a), at_b = at(b);
  const auto bound = [&] { return std::min(at_a, at_b) - (high - low) * length; };
  for (int step = 0; step < kSectionSteps && (high - low) * length > 1e-3 * h && bound() <= enough;
       ++step) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = at(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = at(b);
    }
  }
  return bound();
}

}  // namespace

std::vector<Vec3> AxesBox::corners() const {
  std::vector<Vec3> out;
  out.reserve(8);
  for (int i = 0; i < 8; ++i)
    out.emplace_back(center + axes * Vec3((i & 1) != 0 ? high.x() : low.x(),
                                          (i & 2) != 0 ? high.y() : low.y(),
                                          (i & 4) != 0 ? high.z() : low.z()));
  return out;
}

double AxesBox::beyond(const Vec3& p) const {
  const Vec3 q = axes.transpose() * (p - center);
  return std::max((low - q).maxCoeff(), (q - high).maxCoeff());
}

double Capsule::beyond(const Vec3& p) const { return Segment(from, to).distance(p) - radius; }

double room(const ParallelBody& body, const AxesBox& box, int k, bool high, double most) {
  const double h = body.cap_reach();
  const int u = (k + 1) % 3, v = (k + 2) % 3;
  const double sign = high ? 1 : -1;
  // Along the axis, outwards: where the box begins, and where the face is.
  const double begin = high ? box.low[k] : -box.high[k], face = high ? box.high[k] : -box.low[k];
  const double rounding =
      kFitRounding * (box.center.cwiseAbs().maxCoeff() + box.low.cwiseAbs().maxCoeff() +
                      box.high.cwiseAbs().maxCoeff() + h);
  const Eigen::Matrix3d turn = box.axes.transpose();
  const Eigen::Matrix3d size = turn.cwiseAbs();
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double best = most;
  const auto bound = [&](const geom::Box3& node) {
    if (best < 0) return kNever;  // it meets one
    const Vec3 c = turn * (node.center() - box.center);
    const Vec3 half = size * (0.5 * (node.max - node.min)) + Vec3::Constant(h + rounding);
    for (const int j : {u, v})
      if (c[j] - half[j] > box.high[j] || c[j] + half[j] < box.low[j]) return kNever;
    if (sign * c[k] + half[k] < begin) return kNever;
    return sign * c[k] - half[k] - face;
  };
  body.visit_caps(best, bound, [&](const ParallelBody::Cap& cap) {
    const Vec3 c = turn * (cap.center - box.center), n = turn * cap.normal;
    double side = 0;  // the most that the other two axes add
    for (const int j : {u, v}) {
      const double from = std::max(box.low[j], c[j] - h), to = std::min(box.high[j], c[j] + h);
      if (from > to + rounding) return;
      side += n[j] * ((n[j] > 0 ? to : from) - c[j]);
    }
    const double at = sign * c[k], slope = sign * n[k];
    if (at + h + rounding < begin) return;
    const double needed = cap.height - side - rounding;
    double meets = std::max(at - h, begin);
    if (slope > 1e-9) {
      if (needed > slope * h) return;
      meets = std::max(meets, at + needed / slope);
    } else if (needed > std::max(slope * (meets - at), slope * h)) {
      return;
    }
    best = std::min(best, meets - face - rounding);
  });
  return best;
}

namespace {

/// The largest shift of a face outwards that keeps the box apart from a region; negative where it
/// is not apart. [length]
double room_apart(const geom::Region& region, const AxesBox& box, int k, bool high) {
  const std::vector<Vec3> corners = box.corners();
  const double slack = kApartSlack * (box.high - box.low).maxCoeff();
  const Vec3 way = (high ? 1.0 : -1.0) * box.axes.col(k);
  std::vector<geom::HalfSpace> sides = region.sides;
  if (sides.empty()) {
    // The plane at the ball that is square to the way to the nearest point of the box.
    const Vec3 q = box.axes.transpose() * (region.center - box.center);
    const Vec3 near = box.center + box.axes * q.cwiseMax(box.low).cwiseMin(box.high);
    const Vec3 n = (near - region.center).normalized();
    if (!(n.norm() > 0.5)) return -1;
    sides.push_back({n, n.dot(region.center) + region.radius});
  }
  double best = -1;
  for (const geom::HalfSpace& side : sides) {
    double height = std::numeric_limits<double>::infinity();
    for (const Vec3& p : corners) height = std::min(height, side.normal.dot(p));
    height -= side.offset + slack;
    const double slope = side.normal.dot(way);
    if (height >= 0)
      best = std::max(best, slope < 0 ? height / -slope : std::numeric_limits<double>::infinity());
  }
  return best;
}

}  // namespace

double room(const RegionalBody& body, const AxesBox& box, int k, bool high, double most) {
  double out = room(body.whole(), box, k, high, most);
  for (const RegionalBody::Part& part : body.parts()) {
    const double apart = room_apart(part.region, box, k, high);
    if (apart >= out) continue;
    const bool begins = part.body->signed_distance(box.center).upper < part.body->distance();
    out = std::min(out, std::max(apart, begins ? room(*part.body, box, k, high, out) : -1.0));
  }
  return out;
}

// The room of a face does not grow while other faces move outwards. So a face that was moved as far
// as a cap, or that had no room, is not asked for again.
void grow(const RegionalBody& body, AxesBox& box, std::span<const int> order, double share) {
  const double far = 4 * body.distance() + (box.high - box.low).maxCoeff();
  const double least = 0.02 * body.distance();
  std::array<bool, 6> ended{};
  for (int turn = 0; turn < 40; ++turn) {
    bool moved = false;
    for (const int face : order) {
      bool& end = ended[static_cast<std::size_t>(face)];
      if (end) continue;
      const int k = face / 2;
      const bool high = face % 2 != 0;
      const double most = share < 1
                              ? std::max(share * (box.high - box.low).maxCoeff(), body.distance())
                              : 1e3 * far;
      const double way = room(body, box, k, high, most);
      end = way < most;
      if (!(way > least)) continue;
      (high ? box.high : box.low)[k] += high ? way : -way;
      moved = true;
    }
    if (!moved || share >= 1) return;
  }
}

double clearance(const ParallelBody& body, const Vec3& from, const Vec3& to, double least) {
  const double h = body.cap_reach();
  const Vec3 middle = 0.5 * (from + to);
  const double half = 0.5 * (to - from).norm();
  const double rounding = kFitRounding * (middle.cwiseAbs().maxCoeff() + half + h);
  double best = std::numeric_limits<double>::infinity();
  const Segment segment(from, to);
  const Vec3 low = from.cwiseMin(to), high = from.cwiseMax(to);
  const auto bound = [&](const geom::Box3& node) {
    if (best < least) return std::numeric_limits<double>::infinity();
    // From the segment's box to the box, and from the segment to the ball round it.
    const double to_box = (low - node.max).cwiseMax(node.min - high).cwiseMax(0.0).norm();
    if (to_box - h - rounding > best) return std::numeric_limits<double>::infinity();
    const double to_ball = segment.distance(node.center()) - 0.5 * (node.max - node.min).norm();
    return std::max(to_ball, to_box) - h - rounding;
  };
  body.visit_caps(best, bound, [&](const ParallelBody::Cap& cap) {
    const Vec3 near = segment.nearest(cap.center);
    if ((near - cap.center).norm() - h >= best) return;
    // No section is needed where one point is nearer than what is asked for.
    const double at_near = distance_from_cap(cap, h, near);
    best = std::min(
        best, at_near < least ? at_near : distance_from_cap(cap, h, from, to, best) - rounding);
  });
  return best < least || !std::isfinite(best) ? 0.0 : std::max(best, 0.0);
}

double clearance(const RegionalBody& body, const Vec3& from, const Vec3& to, double least) {
  double out = clearance(body.whole(), from, to, least);
  const std::array<Vec3, 2> ends{from, to};
  for (const RegionalBody::Part& part : body.parts()) {
    const double apart = (1 - kApartSlack) * geom::distance_from(part.region, ends);
    if (apart >= out) continue;
    const bool begins = part.body->signed_distance(from).upper < part.body->distance();
    out = std::min(out, std::max(apart, begins ? clearance(*part.body, from, to, least) : 0.0));
  }
  return out < least ? 0.0 : std::max(out, 0.0);
}

AxesBox box_round(std::span<const Vec3> points, const Eigen::Matrix3d& axes, double spare) {
  AxesBox out;
  out.axes = axes;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : points) {
    const Vec3 q = axes.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  out.center = axes * (0.5 * (low + high));
  out.high = 0.5 * (high - low) + Vec3::Constant(spare);
  out.low = -out.high;
  return out;
}

// M. Bădoiu, K. L. Clarkson, Smaller core-sets for balls, 2003.
Cylinder cylinder_round(std::span<const Vec3> points, const Vec3& direction) {
  int least = 0;
  direction.cwiseAbs().minCoeff(&least);
  const Vec3 u = direction.cross(Vec3::Unit(least)).normalized(), v = direction.cross(u);
  const std::size_t n = points.size();
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = u.dot(points[i]);
    y[i] = v.dot(points[i]);
  }
  double at_x = x[0], at_y = y[0], best_x = at_x, best_y = at_y;
  double best = std::numeric_limits<double>::infinity();
  for (int step = 1; step <= kCircleSteps; ++step) {
    double most = -1;
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double dx = x[i] - at_x, dy = y[i] - at_y;
      if (const double away = dx * dx + dy * dy; away > most) {
        most = away;
        farthest = i;
      }
    }
    if (most < best) {
      best = most;
      best_x = at_x;
      best_y = at_y;
    }
    at_x += (x[farthest] - at_x) / (step + 1);
    at_y += (y[farthest] - at_y) / (step + 1);
  }
  Cylinder out{direction, best_x * u + best_y * v, 0};
  // As the points are along the direction, not as they are along u and v.
  for (const Vec3& p : points) out.radius = std::max(out.radius, out.distance_from_axis(p));
  out.radius *= 1 + kFitRounding;
  return out;
}

std::optional<Capsule> capsule_round(std::span<const Vec3> points, const Cylinder& cylinder,
                                     double radius, double spare) {
  const double held = radius - spare;
  if (!(held > cylinder.radius)) return std::nullopt;
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const Vec3& p : points) {
    const double at = cylinder.direction.dot(p), away = cylinder.distance_from_axis(p);
    const double reach = std::sqrt(std::max(0.0, held * held - away * away));
    from = std::min(from, at + reach);
    to = std::max(to, at - reach);
  }
  if (from > to) from = to = 0.5 * (from + to);
  return Capsule{cylinder.center + from * cylinder.direction,
                 cylinder.center + to * cylinder.direction, radius};
}

}  // namespace kaboum::bcd
