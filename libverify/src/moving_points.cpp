// Points of exact faces that move: carried to configurations of a path, and looked at there.
#include <kaboum/verify/moving_points.h>

#include <algorithm>
#include <cmath>

#include "body_bounds.h"
#include "outside.h"

namespace kaboum::verify {
namespace {

constexpr double kLooks = 5e5;         ///< at points, altogether
constexpr std::size_t kMostStops = 8;  ///< configurations of a segment

/// The sampling: every n-th point, at so many configurations of a segment.
struct Density {
  std::size_t every = 1, stops = 1;
};

Density density_of(std::size_t points, std::size_t segments) {
  const double looks = static_cast<double>(points) * static_cast<double>(segments);
  Density out;
  out.stops = static_cast<std::size_t>(
      std::clamp(kLooks / std::max(looks, 1.0), 1.0, static_cast<double>(kMostStops)));
  out.every = static_cast<std::size_t>(std::max(1.0, std::ceil(looks / kLooks)));
  return out;
}

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double s) {
  std::vector<double> q(a.size());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = a[i] + s * (b[i] - a[i]);
  return q;
}

/// The claim about every n-th point of one shape, from the given one on, at one configuration.
PointClaim look(const MovingPoints& shape, const std::vector<double>& q, std::size_t first,
                std::size_t every, const Outside& outside, double margin) {
  const auto pose = pose_of(shape.chain, q);
  std::vector<geom::Vec3> points;
  std::vector<std::uint32_t> of_face;
  double radius = 0;
  for (std::size_t i = first; i < shape.exact.points.size(); i += every) {
    const geom::Vec3& p = shape.exact.points[i];
    points.emplace_back(pose.leftCols<3>() * p + pose.col(3));
    of_face.push_back(i < shape.exact.of_face.size() ? shape.exact.of_face[i] : 0);
    radius = std::max(radius, p.norm());
  }
  // A coordinate turned is wrong by at most √3 times what each of the three was.
  const double rounding =
      (1.8 * shape.exact.rounding + bound_motion(shape.chain, q, q, radius).rounding) *
      (1 + 0x1p-50);
  return verify_points({points, of_face, rounding}, outside, margin);
}

}  // namespace

ExactPoints scaled(ExactPoints exact, const geom::Vec3& scale) {
  double largest = 0;
  for (geom::Vec3& p : exact.points) {
    p = p.cwiseProduct(scale);
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  exact.rounding =
      (exact.rounding * scale.cwiseAbs().maxCoeff() + largest * 0x1p-52) * (1 + 0x1p-50);
  return exact;
}

std::optional<MovingPointClaim> verify_moving_points(std::span<const MovingPoints> shapes,
                                                     const std::vector<std::vector<double>>& path,
                                                     const geom::ConvexSet& set) {
  std::size_t count = 0;
  for (const MovingPoints& shape : shapes) count += shape.exact.points.size();
  if (count == 0 || path.empty()) return std::nullopt;
  const std::optional<double> margin = geom::margin_of(set);
  const std::optional<BodyBounds> bounds =
      margin ? std::nullopt : bounds_of(set, kFirstBoundsLevel + 1);
  if (!margin && !bounds) {
    MovingPointClaim out;
    out.points.reason = "the bodies are too many to be bounded by polytopes";
    return out;
  }
  // Points refute: what polytopes round the bodies do not hold.
  const Outside outside(sum_of(bounds ? bounds->outside : set));
  const std::size_t segments = std::max<std::size_t>(1, path.size() - 1);
  Density density = density_of(count, segments);
  if (path.size() == 1) density.stops = 1;
  MovingPointClaim out;
  out.points.answer = Answer::Verified;
  const auto look_at = [&](std::size_t segment, double s) {
    const std::size_t first = out.configurations++ % density.every;  // all have their turn
    const std::vector<double>&from = path[segment],
          &to = path[std::min(segment + 1, path.size() - 1)];
    const std::vector<double> q = between(from, to, s);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const PointClaim found =
          look(shapes[i], q, first, density.every, outside, margin.value_or(0));
      if (found.answer == Answer::Undefined && found.points > 0 && out.points.outside == 0) {
        out.points.answer = Answer::Undefined;
        out.points.reason = found.reason;
      }
      out.points.points += found.points;
      out.points.outside += found.outside;
      out.points.rounding = std::max(out.points.rounding, found.rounding);
      if (found.outside == 0) continue;
      out.points.answer = Answer::Refuted;
      out.points.faces = std::max(out.points.faces, found.faces);
      if (found.farthest < out.points.farthest) continue;
      out.points.farthest = found.farthest;
      out.points.at = found.at;
      out.points.face = found.face;
      out.shape = i;
      out.segment = segment;
      out.s = s;
    }
  };
  for (std::size_t segment = 0; segment < segments; ++segment)
    for (std::size_t i = 0; i < density.stops; ++i)
      look_at(segment, static_cast<double>(i) / static_cast<double>(density.stops));
  if (path.size() > 1) look_at(segments - 1, 1);
  return out;
}

}  // namespace kaboum::verify
