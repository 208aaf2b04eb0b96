// A robot among obstacles in floats, with bounds of how far they are off: docs/algorithms/
// batches.md, "Errors", has the proofs of the numbers here.

#include "model.h"

#include <kaboum/geom/convex_hull.h>
#include <kaboum/world/margins.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <span>
#include <utility>

#include "lanes.h"

namespace kaboum::filter::detail {
namespace {

using collide::PosedSet;
using geom::Transform;
using world::Item;
using Mat3 = Eigen::Matrix3d;

constexpr double kUnit = 0x1p-24;  ///< of rounding of floats, to nearest
constexpr double kSineError = 4 * kUnit;
constexpr double kDoubles = 0x1p-38;     ///< all roundings of doubles, of the lengths involved
constexpr double kSums = 1 + 8 * kUnit;  ///< sums of three floats that are rounded
constexpr double kFarthest = 100;        ///< values of variables beyond are left open
constexpr double kMostAngle = 1000, kLargest = 1e6;
constexpr std::size_t kMostPlanes = 80, kMostSteps = 64;

float rounded_up(double x) {
  const auto out = static_cast<float>(x);
  return out < x ? std::nextafter(out, HUGE_VALF) : out;
}
float rounded_down(double x) { return -rounded_up(-x); }

void put(const Vec3& p, float* out) {
  for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(p[k]);
}
void put(const Mat3& m, float* out) {
  for (int k = 0; k < 9; ++k) {
    const double entry = m(k / 3, k % 3);
    out[k] = std::abs(entry) < kDoubles ? 0.0F : static_cast<float>(entry);
  }
}

/// Bounds of a frame's pose in floats: its rotation's error (spectral), the translation's error,
/// the translation's length, and the sum of the lengths of all that it is made of.
struct FrameBounds {
  double rotation = 3 * kUnit, translation = 0, reach = 0, lengths = 0;
};

/// A rotation that takes z to an axis.
Mat3 rotation_to(const Vec3& axis) {
  const Vec3 z = axis.normalized();
  int least = 0;
  z.cwiseAbs().minCoeff(&least);
  Mat3 out;
  out.col(0) = Vec3::Unit(least).cross(z).normalized();
  out.col(1) = z.cross(out.col(0));
  out.col(2) = z;
  return out;
}

/// What moves a link: a frame, and the link's pose in it.
struct LinkPlace {
  std::uint32_t frame = 0;
  Transform pose;
  double lengths = 0;  ///< of all fixed transforms that the pose is the product of, summed
};

/// The robot's joints, as far as they move, and where its links are.
struct Chain {
  std::vector<FrameBounds> bounds{{}};
  std::vector<LinkPlace> links{{}};
};

/// Bounds of the frame that a joint moves.
/// @param length   of the fixed transform before it, at most
/// @param lengths  of all that this one is the product of, summed
FrameBounds bounds_of(const FrameBounds& parent, double length, double lengths, bool turns,
                      double slide) {
  FrameBounds out;
  out.rotation = 1.001 * parent.rotation + 12.5 * kUnit;
  out.translation =
      parent.translation + (parent.rotation + 8.1 * kUnit) * length + 4.1 * kUnit * parent.reach;
  out.reach = parent.reach + 1.001 * length;
  out.lengths = parent.lengths + 1.001 * lengths;
  if (turns) {
    out.rotation = 1.001 * out.rotation + 1.42 * kSineError + 4.1 * kUnit;
  } else {
    out.translation += (out.rotation + 3.1 * kUnit) * slide + 2.1 * kUnit * out.reach;
    out.reach += 1.001 * slide;
    out.lengths += 1.001 * slide;
  }
  out.translation += kDoubles * (out.reach + out.lengths);
  return out;
}

Chain add_chain(const world::RobotModel& robot, Model& model) {
  Chain out;
  put(robot.base.linear, model.base);
  const auto& variables = robot.kinematics.variables;
  model.variables = variables.size();
  for (const robot::Variable& v : variables) {
    model.low.push_back(std::max(v.lower.value_or(-kFarthest), -kFarthest));
    model.high.push_back(std::min(v.upper.value_or(kFarthest), kFarthest));
    model.more.push_back(0x1p-32 *
                         std::max(std::abs(model.low.back()), std::abs(model.high.back())));
    model.unusable = model.unusable || !(model.low.back() <= model.high.back());
  }
  for (const robot::Joint& joint : robot.kinematics.joints) {
    const LinkPlace& parent = out.links[joint.parent];
    const Transform origin = parent.pose * joint.origin;
    const double lengths = parent.lengths + joint.origin.translation.norm();
    if (joint.type == robot::JointType::Fixed) {
      out.links.push_back({parent.frame, origin, lengths});
      continue;
    }
    Step step{.multiplier = joint.multiplier, .offset = joint.offset};
    step.parent = parent.frame;
    step.variable = joint.variable;
    step.turns = joint.type == robot::JointType::Revolute;
    const Mat3 align = rotation_to(joint.axis);
    put(Mat3(origin.linear * align), step.fixed);
    put(origin.translation, step.fixed + 9);
    const double most =
        std::abs(joint.multiplier) *
            std::max(std::abs(model.low[joint.variable]), std::abs(model.high[joint.variable])) +
        std::abs(joint.offset);
    model.unusable = model.unusable || !(most <= kMostAngle);
    const double length = origin.translation.norm() + kDoubles * lengths;
    step.length = rounded_up(length * kSums);
    step.slide = step.turns ? 0 : rounded_up(most * kSums);
    step.path = step.length + step.slide;
    if (parent.frame > 0) step.path += model.steps[parent.frame - 1].path;
    step.factor = rounded_up(std::abs(joint.multiplier) * kSums);
    out.bounds.push_back(bounds_of(out.bounds[parent.frame], length, lengths, step.turns, most));
    const auto frame = static_cast<std::uint32_t>(model.steps.size() + 1);
    model.steps.push_back(step);
    out.links.push_back({frame, {align.transpose(), Vec3::Zero()}, 0});
  }
  return out;
}

/// A ball of a link in its frame, and how far from there it is computed to be.
struct PlacedBall {
  Vec3 center = Vec3::Zero();
  double length = 0;  ///< of its centre, at most
  double error = 0;   ///< of its centre, and of what the vector code computes with it
  double reach = 0;   ///< from the origin
};
PlacedBall placed(const Chain& chain, const LinkPlace& link, const Vec3& center) {
  const FrameBounds& frame = chain.bounds[link.frame];
  PlacedBall out{link.pose * center};
  const double lengths = link.lengths + center.norm();
  const double length = out.length = out.center.norm() + kDoubles * lengths;
  out.reach = frame.reach + 1.001 * length;
  out.error = frame.translation + (frame.rotation + 8.1 * kUnit) * length +
              4.1 * kUnit * frame.reach + (10 * kUnit + kDoubles) * out.reach +
              kDoubles * (frame.lengths + lengths);
  return out;
}

FrameBall outer_ball(const Chain& chain, const LinkPlace& link, const Ball& ball, double error) {
  const PlacedBall at = placed(chain, link, ball.center);
  FrameBall out;
  put(at.center, out.center);
  out.length = rounded_up(at.length * kSums);
  out.radius = rounded_up((ball.radius * (1 + 1e-8) + at.error + 2.5 * error) * kSums);
  return out;
}

FrameBall inner_ball(const Chain& chain, const LinkPlace& link, const Ball& ball) {
  const PlacedBall at = placed(chain, link, ball.center);
  FrameBall out;
  put(at.center, out.center);
  out.radius = rounded_down((ball.radius * (1 - 1e-8) - at.error) / kSums);
  return out;
}

std::uint32_t size_of(const auto& list) { return static_cast<std::uint32_t>(list.size()); }

/// Normals of a hull's facets, those of the largest areas first; parallel ones once.
std::vector<Vec3> normals_of(const std::vector<Vec3>& points,
                             const std::vector<geom::Triangle>& triangles) {
  struct Facet {
    Vec3 normal;
    double area;
  };
  std::vector<Facet> facets;
  for (const geom::Triangle& t : triangles) {
    const Vec3 n = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
    const double area = n.norm();
    if (!(area > 0)) continue;
    const auto same = std::ranges::find_if(
        facets, [&](const Facet& f) { return f.normal.dot(n) > (1 - 1e-9) * area; });
    if (same == facets.end())
      facets.push_back({n / area, area});
    else
      same->area += area;
  }
  std::ranges::stable_sort(facets, std::ranges::greater{}, &Facet::area);
  std::vector<Vec3> out;
  out.reserve(facets.size());
  for (const Facet& facet : facets) out.push_back(facet.normal);
  return out;
}

/// Axes of a box round points, from normals of facets; rows.
Mat3 box_axes(const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  if (points.size() == 1) return Mat3::Identity();
  if (normals.empty()) return rotation_to(points.back() - points.front()).transpose();
  Mat3 best = rotation_to(normals.front()).transpose();
  double least = HUGE_VAL;
  const std::size_t few = std::min<std::size_t>(normals.size(), 10);
  for (std::size_t i = 0; i < few; ++i)
    for (std::size_t j = 0; j < few; ++j) {
      const Vec3 second = normals[j] - normals[i].dot(normals[j]) * normals[i];
      if (second.norm() < 0.3) continue;
      Mat3 axes;
      axes.row(0) = normals[i];
      axes.row(1) = second.normalized();
      axes.row(2) = axes.row(0).cross(axes.row(1));
      Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
      for (const Vec3& p : points) {
        low = low.cwiseMin(axes * p);
        high = high.cwiseMax(axes * p);
      }
      if (const double volume = (high - low).prod(); volume < least) {
        least = volume;
        best = axes;
      }
    }
  return best;
}

/// How far a corner of a box is from the nearest of the points, at most.
double corners_off(const Mat3& axes, const Vec3& center, const Vec3& half,
                   const std::vector<Vec3>& points) {
  double most = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 local = half;
    for (int k = 0; k < 3; ++k)
      if ((corner >> k & 1U) != 0) local[k] = -local[k];
    const Vec3 at = center + axes.transpose() * local;
    double least = HUGE_VAL;
    for (const Vec3& p : points) least = std::min(least, (p - at).norm());
    most = std::max(most, least);
  }
  return most;
}

/// Bodies of more corners are not looked at by directions.
constexpr std::size_t kMostCorners = 256;

/// @param points  corners in the world
/// @param radius  with the error of the place
/// @param size    lengths that what is rounded is of
/// @return its number
std::uint32_t add_body(const std::vector<Vec3>& points, double radius, double size, Model& model) {
  BodyModel out;
  const Ball ball = ball_round(points);
  put(ball.center, out.ball.center);
  if (points.size() <= kMostCorners) {
    out.corners.begin = size_of(model.corners);
    for (const Vec3& p : points) put(p, model.corners.emplace_back().at);
    out.corners.end = size_of(model.corners);
  }
  out.offset = rounded_up((radius + (12 * kUnit + kDoubles) * size) * kSums);
  out.error = rounded_up(1.1 * (12 * kUnit + kDoubles) * size);
  model.bodies.push_back(out);
  return size_of(model.bodies) - 1;
}

/// @param error  of the place, as the checker has it
void add_obstacle(const PosedSet& at, std::size_t body, const Vec3& origin, Model& model) {
  const geom::ConvexBody& convex = at.set().body(body);
  std::vector<Vec3> points;
  for (const Vec3& p : convex.core.vertices) points.emplace_back(at.pose() * p - origin);
  double size = 0;
  for (const Vec3& p : points) size = std::max(size, p.norm());
  size += at.pose().translation.norm() + origin.norm();
  const double slack = kDoubles * size;
  const std::vector<Vec3> normals = normals_of(points, convex.core.triangles);
  const Mat3 axes = box_axes(points, normals);
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(axes * p);
    high = high.cwiseMax(axes * p);
  }
  const Vec3 center = axes.transpose() * (0.5 * (low + high)), half = 0.5 * (high - low);
  Obstacle out;
  put(axes, out.axes);
  put(center, out.center);
  const double floats = 10 * kUnit * (center.norm() + half.norm()) + slack;
  const double radius = at.radius_above(body) + 2.5 * at.error();
  out.radius = rounded_up((radius + floats) * kSums);
  for (int k = 0; k < 3; ++k) out.half[k] = rounded_up(half[k] + slack);
  const double off = convex.core.triangles.empty() ? 0 : corners_off(axes, center, half, points);
  if (off <= 1e-6 * half.norm()) {
    put(center, out.inner_center);
    for (int k = 0; k < 3; ++k) out.inner_half[k] = rounded_down(half[k]);
    out.inner_radius = rounded_down((at.radius_below(body) - off - floats));
  } else {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : convex.core.vertices)
      mean += p / static_cast<double>(convex.core.vertices.size());
    const Ball inner = detail::inner_ball(convex, mean);
    const Vec3 place = at.pose() * inner.center - origin;
    put(place, out.inner_center);
    out.inner_radius = rounded_down(
        (inner.radius * (1 - 1e-8) - 10 * kUnit * (place.norm() + center.norm()) - slack) / kSums);
  }
  out.planes.begin = size_of(model.planes);
  if (off > 1e-6 * half.norm())
    for (std::size_t i = 0; i < std::min(normals.size(), kMostPlanes); ++i) {
      Plane plane;
      put(Vec3(normals[i] * (1 - 8 * kUnit)), plane.normal);
      const Vec3 normal(plane.normal[0], plane.normal[1], plane.normal[2]);
      double most = -HUGE_VAL;
      for (const Vec3& p : points) most = std::max(most, normal.dot(p));
      plane.offset = rounded_up(most + (radius + slack + 4 * kUnit * std::abs(most)) * kSums);
      model.planes.push_back(plane);
    }
  out.planes.end = size_of(model.planes);
  out.body = add_body(points, radius, size, model);
  model.unusable = model.unusable || !(size + radius < kLargest);
  model.obstacles.push_back(out);
}

/// A tree over points of a cloud, halved across the longest side of their box.
class CloudTree {
 public:
  explicit CloudTree(Model& model) : model_(model) {}

  /// Nodes of points from `begin` to `end`, which it puts in order.
  void add(std::uint32_t begin, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(model_.cloud_nodes.size());
    CloudNode node;
    const auto first = model_.cloud_points.begin() + begin,
               last = model_.cloud_points.begin() + end;
    int longest = 0;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(
          first, last, [&](const auto& a, const auto& b) { return a.at[k] < b.at[k]; });
      node.low[k] = low->at[k];
      node.high[k] = high->at[k];
      if (node.high[k] - node.low[k] > node.high[longest] - node.low[longest]) longest = k;
    }
    const bool leaf = end - begin <= kLeaf;
    if (leaf) node.points = {begin, end};
    model_.cloud_nodes.push_back(node);
    if (!leaf) {
      const std::uint32_t middle = begin + (end - begin) / 2;
      // Of equal coordinates the others decide, so that the order is the same everywhere.
      std::nth_element(first, model_.cloud_points.begin() + middle, last,
                       [&](const auto& a, const auto& b) {
                         if (a.at[longest] != b.at[longest]) return a.at[longest] < b.at[longest];
                         return std::ranges::lexicographical_compare(a.at, b.at);
                       });
      add(begin, middle);
      add(middle, end);
    }
    model_.cloud_nodes[at].next = static_cast<std::uint32_t>(model_.cloud_nodes.size());
  }

 private:
  static constexpr std::uint32_t kLeaf = 8;
  Model& model_;
};

/// @param at  of a set that is a cloud
CloudModel add_cloud(const PosedSet& at, const Vec3& origin, Model& model) {
  CloudModel out;
  const auto begin = static_cast<std::uint32_t>(model.cloud_points.size());
  double farthest = 0, size = 0, above = 0, below = HUGE_VAL;
  for (std::size_t i = 0; i < at.set().size(); ++i) {
    const Vec3& local = at.set().body(i).core.vertices.front();
    const Vec3 p = at.pose() * local - origin;
    CloudPoint point;
    put(p, point.at);
    model.cloud_points.push_back(point);
    farthest = std::max(farthest, p.norm());
    size = std::max(size, local.norm());
    above = std::max(above, at.radius_above(i));
    below = std::min(below, at.radius_below(i));
  }
  size += farthest + at.pose().translation.norm() + origin.norm();
  const double floats = 10 * kUnit * farthest + kDoubles * size;
  out.radius = rounded_up((above + 2.5 * at.error() + floats) * kSums);
  out.inner_radius = rounded_down((below - floats) / kSums);
  out.nodes.begin = static_cast<std::uint32_t>(model.cloud_nodes.size());
  CloudTree(model).add(begin, static_cast<std::uint32_t>(model.cloud_points.size()));
  out.nodes.end = static_cast<std::uint32_t>(model.cloud_nodes.size());
  model.unusable = model.unusable || !(farthest + above < kLargest);
  return out;
}

void add_group(const PosedSet& at, const Vec3& origin, Model& model) {
  ObstacleGroup out;
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  double size = at.pose().translation.norm() + origin.norm();
  for (std::size_t i = 0; i < at.set().size(); ++i)
    for (const Vec3& p : at.set().body(i).core.vertices) {
      const Vec3 place = at.pose() * p - origin;
      const double radius = at.radius_above(i) + 2.5 * at.error();
      low = low.cwiseMin(place - Vec3::Constant(radius));
      high = high.cwiseMax(place + Vec3::Constant(radius));
      size = std::max(size, p.norm() + at.pose().translation.norm() + origin.norm() + radius);
    }
  const Vec3 center = 0.5 * (low + high), half = 0.5 * (high - low);
  put(center, out.center);
  for (int k = 0; k < 3; ++k)
    out.half[k] = rounded_up((half[k] + 10 * kUnit * center.norm() + kDoubles * size) * kSums);
  out.obstacles.begin = size_of(model.obstacles);
  if (at.set().is_cloud())
    out.cloud = add_cloud(at, origin, model);
  else
    for (std::size_t i = 0; i < at.set().size(); ++i) add_obstacle(at, i, origin, model);
  out.obstacles.end = size_of(model.obstacles);
  model.groups.push_back(out);
}

double largest_radius(const collide::BoundingSet& set) {
  double out = 0;
  for (std::size_t i = 0; i < set.size(); ++i) out = std::max(out, set.body(i).radius);
  return out;
}

/// What errors of places take of the extents of a link's corners along a direction.
double extent_error(const Chain& chain, const LinkPlace& link, double reach, double lengths,
                    double error) {
  const FrameBounds& frame = chain.bounds[link.frame];
  return kDoubles * (frame.lengths + link.lengths + lengths) +
         (2 * frame.rotation + 12 * kUnit) * reach + frame.translation + 10 * kUnit * frame.reach +
         2.5 * error;
}

void add_corners(const world::Checker& checker, const world::RobotModel& robot, std::size_t index,
                 const Chain& chain, const std::vector<double>& errors, Model& model) {
  for (std::size_t s = 0; s < model.shapes.size(); ++s) {
    ShapeModel& shape = model.shapes[s];
    const LinkPlace& link = chain.links[robot.shapes[s].link];
    const double radius = largest_radius(robot.shapes[s].outer);
    double reach = 0;
    shape.corners.begin = size_of(model.corners);
    for (const Vec3& p : checker.hull_of({index, s})) {
      const Vec3 at = link.pose * p;
      Corner corner;
      put(at, corner.at);
      model.corners.push_back(corner);
      reach = std::max(reach, at.norm() + kDoubles * (link.lengths + p.norm()));
      shape.corner_radius =
          std::max(shape.corner_radius, outer_ball(chain, link, {p, radius}, errors[s]).radius);
    }
    shape.corners.end = size_of(model.corners);
    shape.reach = rounded_up(reach * (1 + 1e-6));
    BodyModel hull;
    hull.ball = shape.whole;
    if (shape.corners.end - shape.corners.begin <= kMostCorners) hull.corners = shape.corners;
    hull.reach = shape.reach;
    hull.error = HUGE_VALF;  // where hulls meet, their bodies need not
    const auto& ball = robot.shapes[s].outer.ball();
    hull.offset = rounded_up(
        (radius * (1 + 1e-8) + 1.1 * extent_error(chain, link, shape.reach,
                                                  ball.center.norm() + ball.radius, errors[s])) *
        kSums);
    shape.hull = size_of(model.bodies);
    model.bodies.push_back(hull);
  }
}

/// Planes that separate two shapes in configurations that balls leave open.
class WitnessSearch {
 public:
  /// @param places  of both shapes where the pair is open
  WitnessSearch(const world::RobotModel& robot, const ShapePair& pair,
                const std::vector<std::array<Transform, 2>>& places, const world::Checker& checker,
                std::size_t index)
      : places_(places),
        corners_{&checker.hull_of({index, pair.a}), &checker.hull_of({index, pair.b})},
        reach_(largest_radius(robot.shapes[pair.a].outer) +
               largest_radius(robot.shapes[pair.b].outer) + pair.margin) {
    const collide::Polytope a(*corners_[0]), b(*corners_[1]);
    for (const auto& [at_a, at_b] : places_) {
      const collide::Gap gap = collide::gap_between({a, at_a}, {b, at_b});
      const Vec3 d = gap.on_b - gap.on_a;
      if (!(gap.lower > 0) || !(d.norm() > 0)) continue;
      normals_.emplace_back(0, at_a.linear.transpose() * d.normalized());
      normals_.emplace_back(1, -(at_b.linear.transpose() * d.normalized()));
    }
  }

  /// Normals and of which shape, those that separate most first.
  [[nodiscard]] std::vector<std::pair<std::size_t, Vec3>> best() const {
    std::vector<std::vector<char>> separates;
    for (const auto& [of, normal] : normals_) {
      auto& row = separates.emplace_back();
      const double above = top(of, normal);
      for (const auto& place : places_) row.push_back(beyond(of, normal, place) > above + reach_);
    }
    std::vector<char> done(places_.size());
    std::vector<std::pair<std::size_t, Vec3>> out;
    while (out.size() < 6 && !normals_.empty()) {
      std::size_t most = 0, found = 0;
      for (std::size_t i = 0; i < normals_.size(); ++i) {
        std::size_t gain = 0;
        for (std::size_t k = 0; k < done.size(); ++k) gain += separates[i][k] > done[k] ? 1 : 0;
        if (gain > most) {
          most = gain;
          found = i;
        }
      }
      if (20 * most < places_.size() || most < 2) break;
      for (std::size_t k = 0; k < done.size(); ++k) done[k] |= separates[found][k];
      out.push_back(normals_[found]);
    }
    return out;
  }

  /// The farthest of a shape's corners along a normal of its own.
  [[nodiscard]] double top(std::size_t of, const Vec3& normal) const {
    double out = -HUGE_VAL;
    for (const Vec3& p : *corners_[of]) out = std::max(out, normal.dot(p));
    return out;
  }
  [[nodiscard]] double reach() const { return reach_; }

 private:
  /// The nearest of the other shape's corners along a normal.
  [[nodiscard]] double beyond(std::size_t of, const Vec3& normal,
                              const std::array<Transform, 2>& place) const {
    const Vec3 world = place[of].linear * normal, local = place[1 - of].linear.transpose() * world;
    double least = HUGE_VAL;
    for (const Vec3& p : *corners_[1 - of]) least = std::min(least, local.dot(p));
    return least + world.dot(place[1 - of].translation - place[of].translation);
  }

  const std::vector<std::array<Transform, 2>>& places_;
  std::array<const std::vector<Vec3>*, 2> corners_;
  double reach_;
  std::vector<std::pair<std::size_t, Vec3>> normals_;
};

/// Looks at rows for a pair at a time.
class PairProbe {
 public:
  /// Points of clouds are left out: no pair with one may be asked for. So are directions.
  PairProbe(const Model& model, std::span<const double> rows)
      : alone_(balls_alone(model)),
        memory_(alone_),
        answers_(rows.size() / alone_.variables),
        blocks_(in_blocks(rows.data(), answers_.size(), alone_.variables)) {}

  const std::vector<BatchChecker::Answer>& look_at(const ShapePair& pair) {
    alone_.shape_pairs = {pair};
    alone_.obstacle_pairs.clear();
    return look();
  }
  std::size_t count_contacts(const auto& pair) {
    return static_cast<std::size_t>(
        std::ranges::count(look_at(pair), BatchChecker::Answer::Contact));
  }
  const std::vector<BatchChecker::Answer>& look_at(const ObstaclePair& pair) {
    alone_.shape_pairs.clear();
    alone_.obstacle_pairs = {pair};
    return look();
  }

 private:
  static Model balls_alone(const Model& model) {
    Model out = model;
    out.cloud_points.clear();
    out.cloud_nodes.clear();
    for (BodyModel& body : out.bodies) body.corners = {};
    return out;
  }
  const std::vector<BatchChecker::Answer>& look() {
    filter_blocks(alone_, instruction_sets().back(), blocks_.data(), nullptr, answers_.size(),
                  memory_, answers_.data());
    return answers_;
  }

  Model alone_;
  LaneMemory memory_;
  std::vector<BatchChecker::Answer> answers_;
  std::vector<double> blocks_;
};

/// Puts pairs first that are in contact in most of some rows: one contact ends the look.
void sort_pairs(std::span<const double> rows, Model& model) {
  PairProbe probe(model, rows);
  std::array<std::size_t, 2> all{};
  const auto sort = [&](auto& pairs, std::size_t& sum, const auto& is_counted) {
    std::vector<std::pair<std::size_t, std::size_t>> counts;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      counts.emplace_back(is_counted(pairs[i]) ? probe.count_contacts(pairs[i]) : 0, i);
      sum += counts.back().first;
    }
    std::ranges::stable_sort(counts, std::ranges::greater{},
                             &std::pair<std::size_t, std::size_t>::first);
    auto sorted = pairs;
    for (std::size_t i = 0; i < pairs.size(); ++i) sorted[i] = pairs[counts[i].second];
    pairs = std::move(sorted);
  };
  sort(model.shape_pairs, all[0], [](const ShapePair&) { return true; });
  sort(model.obstacle_pairs, all[1], [&](const ObstaclePair& pair) {
    const CloudModel& cloud = model.groups[pair.group].cloud;
    return cloud.nodes.begin == cloud.nodes.end;
  });
  model.obstacles_first = all[1] > all[0];
}

/// Adds planes that separate a pair of shapes, as configurations that are drawn show them.
/// @param answers  for this pair
void add_witnesses(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                   const Chain& chain, const std::vector<double>& errors,
                   const std::vector<double>& rows,
                   const std::vector<BatchChecker::Answer>& answers, std::size_t number,
                   Model& model) {
  constexpr std::size_t kMostOpen = 60;
  ShapePair& pair = model.shape_pairs[number];
  const world::RobotModel& arm = checker.world().robots[robot];
  const auto open =
      static_cast<std::size_t>(std::ranges::count(answers, BatchChecker::Answer::Open));
  if (100 * open < answers.size()) return;
  std::vector<std::array<Transform, 2>> places;
  world::Scratch scratch;
  world::WorldState at = state;
  for (std::size_t i = 0; i < answers.size() && places.size() < kMostOpen; ++i) {
    if (answers[i] != BatchChecker::Answer::Open) continue;
    const double* row = rows.data() + i * model.variables;
    at.q[robot].assign(row, row + model.variables);
    const auto both = checker.places(at, {{robot, pair.a}, {robot, pair.b}}, scratch);
    places.push_back({both[0].place.pose(), both[1].place.pose()});
  }
  const WitnessSearch search(arm, pair, places, checker, robot);
  const std::array<std::uint32_t, 2> shapes{pair.a, pair.b};
  double error = 0;
  for (const std::uint32_t s : shapes) {
    const auto& ball = arm.shapes[s].outer.ball();
    error += extent_error(chain, chain.links[arm.shapes[s].link], model.shapes[s].reach,
                          ball.center.norm() + ball.radius, errors[s]);
  }
  pair.witnesses.begin = size_of(model.witnesses);
  for (const auto& [of, normal] : search.best()) {
    const Mat3& aligned = chain.links[arm.shapes[shapes[of]].link].pose.linear;
    const Vec3& shift = chain.links[arm.shapes[shapes[of]].link].pose.translation;
    Witness witness;
    put(Vec3(aligned * normal * (1 - 0x1p-9)), witness.normal);
    witness.of_first = of == 0;
    const Vec3 exact(witness.normal[0], witness.normal[1], witness.normal[2]);
    double most = -HUGE_VAL;
    for (const Vec3& p : checker.hull_of({robot, shapes[of]}))
      most = std::max(most, exact.dot(aligned * p + shift));
    witness.offset = rounded_up(
        most + (search.reach() * (1 + 1e-8) + 1.1 * error + 8 * kUnit * std::abs(most)) * kSums);
    model.witnesses.push_back(witness);
  }
  pair.witnesses.end = size_of(model.witnesses);
}

/// The last frame that two frames are, or hang from.
std::uint32_t common_frame(const Model& model, std::uint32_t a, std::uint32_t b) {
  while (a != b) (a > b ? a : b) = model.steps[std::max(a, b) - 1].parent;
  return a;
}

/// Values within the limits, the same every time.
std::vector<double> drawn_rows(const Model& model) {
  constexpr std::size_t kRows = 2000;
  std::mt19937_64 random(1);
  std::vector<double> out;
  out.reserve(kRows * model.variables);
  for (std::size_t i = 0; i < kRows; ++i)
    for (std::size_t k = 0; k < model.variables; ++k) {
      const double share = static_cast<double>(random() >> 11) * 0x1p-53;
      out.push_back(model.low[k] + share * (model.high[k] - model.low[k]));
    }
  return out;
}

void add_levers(const Chain& chain, Model& model) {
  for (const FrameBounds& frame : chain.bounds) model.size = std::max(model.size, frame.reach);
  for (const ShapeModel& shape : model.shapes)
    model.size = std::max<double>(model.size, chain.bounds[shape.frame].reach + shape.whole.radius);
  model.levers.assign(model.variables, 0.0);
  for (std::size_t j = 0; j < model.steps.size(); ++j) {
    const Step& step = model.steps[j];
    const double lever = step.turns ? model.size - chain.bounds[j + 1].reach : 1;
    model.levers[step.variable] += step.factor * std::max(lever, 0.1 * model.size);
  }
}

/// Bounds of how far velocities are off: docs/algorithms/batches.md, "Motions".
void add_blur(const Chain& chain, Model& model) {
  double rotation = 0, translation = 0, reach = 0;
  for (const FrameBounds& frame : chain.bounds) {
    rotation = std::max(rotation, frame.rotation);
    translation = std::max(translation, frame.translation);
    reach = std::max(reach, frame.reach);
  }
  double farthest = 0;  // of the links' points, from their frames
  for (const ShapeModel& shape : model.shapes)
    farthest = std::max<double>(farthest, shape.whole.length + shape.whole.radius);
  farthest *= 1.07;  // the middle of a cluster's box: √(9/8)
  const auto joints = static_cast<double>(model.steps.size());
  const double all = 1.01 * (reach + farthest);
  const double error = translation + (rotation + 20 * kUnit) * farthest + 5 * kUnit * all;
  model.blur_of_turns =
      rounded_up(1.1 * (((8 * joints + 80) * kUnit + 3 * rotation) * all + 3 * error));
  model.blur_of_slides = rounded_up(1.1 * ((4 * joints + 20) * kUnit + 2 * rotation));
  for (const Step& step : model.steps)
    for (std::uint32_t f = step.parent; !step.turns && f > 0; f = model.steps[f - 1].parent)
      if (model.steps[f - 1].turns) model.bend = 1;
}

/// Bodies of a link's set.
/// @param error  of its place, as the checker has it
void add_bodies(const collide::BoundingSet& set, const BallCover& cover, const Chain& chain,
                const LinkPlace& link, double error, Model& model) {
  for (std::size_t b = 0; b < set.size(); ++b) {
    const geom::ConvexBody& body = set.body(b);
    BodyModel out;
    Ball round = ball_round(body.core.vertices);
    round.radius += body.radius;
    out.ball = outer_ball(chain, link, round, error);
    out.balls.begin = size_of(model.outer);
    for (std::size_t k = cover.bodies[b]; k < cover.bodies[b + 1]; ++k)
      model.outer.push_back(outer_ball(chain, link, cover.outer[k], error));
    out.balls.end = size_of(model.outer);
    double reach = 0, lengths = 0;
    out.corners.begin = size_of(model.corners);
    for (const Vec3& p : body.core.vertices) {
      const Vec3 at = link.pose * p;
      put(at, model.corners.emplace_back().at);
      lengths = std::max(lengths, p.norm());
      reach = std::max(reach, at.norm() + kDoubles * (link.lengths + p.norm()));
    }
    out.corners.end = size_of(model.corners);
    if (body.core.vertices.size() > kMostCorners) {
      model.corners.resize(out.corners.begin);
      out.corners = {};
    }
    out.reach = rounded_up(reach * (1 + 1e-6));
    out.error = rounded_up(1.1 * extent_error(chain, link, out.reach, lengths, 0));
    out.offset = rounded_up(
        (body.radius * (1 + 1e-8) + 1.1 * extent_error(chain, link, out.reach, lengths, error)) *
        kSums);
    model.bodies.push_back(out);
  }
}

/// The bounding sets of the robot's links.
/// @param errors  of their places, as the checker has them
void add_shapes(const world::RobotModel& robot, const Chain& chain,
                const std::vector<double>& errors, std::size_t most_balls, Model& model) {
  std::vector<const collide::BoundingSet*> sets;
  for (const world::LinkShape& shape : robot.shapes) sets.push_back(&shape.outer);
  const std::vector<BallCover> covers = cover_by_balls(sets, most_balls);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const LinkPlace& link = chain.links[robot.shapes[s].link];
    ShapeModel out;
    out.frame = link.frame;
    out.bodies.begin = size_of(model.bodies);
    const auto& ball = sets[s]->ball();
    out.whole = outer_ball(chain, link, {ball.center, ball.radius}, errors[s]);
    add_bodies(*sets[s], covers[s], chain, link, errors[s], model);
    out.bodies = {out.bodies.begin, size_of(model.bodies)};
    out.inner.begin = size_of(model.inner);
    for (const Ball& b : covers[s].inner)
      if (const FrameBall inner = inner_ball(chain, link, b); inner.radius > 0)
        model.inner.push_back(inner);
    out.inner.end = size_of(model.inner);
    const PlacedBall whole = placed(chain, link, ball.center);
    model.unusable = model.unusable || !(whole.reach + ball.radius < kLargest) ||
                     !(chain.bounds[link.frame].rotation < 1e-3) || model.steps.size() > kMostSteps;
    model.shapes.push_back(out);
  }
}

/// Leaves out things that a link cannot reach.
void leave_out_of_reach(const Chain& chain, const world::RobotModel& robot, Model& model) {
  std::erase_if(model.obstacle_pairs, [&](const ObstaclePair& pair) {
    const ShapeModel& shape = model.shapes[pair.shape];
    const ObstacleGroup& group = model.groups[pair.group];
    const LinkPlace& link = chain.links[robot.shapes[pair.shape].link];
    const double reach = placed(chain, link, robot.shapes[pair.shape].outer.ball().center).reach;
    Vec3 away = Vec3::Zero();  // of the base from the box
    for (int k = 0; k < 3; ++k)
      away[k] = std::max(0.0, std::abs(double{group.center[k]}) - double{group.half[k]});
    return away.norm() * (1 - 1e-6) >
           (reach + shape.whole.radius + pair.margin + kReachSlack * model.size) * (1 + 1e-6);
  });
}

/// Numbers of Model::groups.
using Groups = std::map<Item, std::uint32_t>;

void add_items(std::size_t robot, const Groups& groups, Model& model) {
  std::vector<Item> things(model.groups.size());
  for (const auto& [item, group] : groups) things[group] = item;
  for (const ShapePair& pair : model.shape_pairs)
    model.items.push_back({Item{robot, pair.a}, Item{robot, pair.b}});
  for (const ObstaclePair& pair : model.obstacle_pairs)
    model.items.push_back({Item{robot, pair.shape}, things[pair.group]});
}

/// Balls round the shapes of each frame, for pairs of which one has several.
/// @param errors  of the shapes' places, as the checker has them
class Clusters {
 public:
  Clusters(const Chain& chain, const std::vector<double>& errors, Model& model)
      : chain_(chain), errors_(errors), model_(model), of_frame_(chain.bounds.size(), kNoCluster) {
    count_.assign(chain.bounds.size(), 0);
    for (const ShapeModel& shape : model.shapes) ++count_[shape.frame];
  }

  void add() {
    for (ObstaclePair& pair : model_.obstacle_pairs)
      if (const std::uint32_t frame = frame_of(pair.shape); count_[frame] > 1)
        pair.clusters = number_of({cluster_of(frame), pair.group, true, 0, 0}, pair.margin);
    for (ShapePair& pair : model_.shape_pairs) {
      const std::uint32_t a = frame_of(pair.a), b = frame_of(pair.b);
      if (count_[a] * count_[b] > 1 && a != b)
        pair.clusters =
            number_of({cluster_of(a), cluster_of(b), false, pair.common, 0}, pair.margin);
    }
  }

 private:
  [[nodiscard]] std::uint32_t frame_of(std::uint32_t shape) const {
    return model_.shapes[shape].frame;
  }

  std::uint32_t cluster_of(std::uint32_t frame) {
    if (of_frame_[frame] != kNoCluster) return of_frame_[frame];
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    double error = 0;
    const auto center_of = [](const ShapeModel& shape) {
      return Vec3(shape.whole.center[0], shape.whole.center[1], shape.whole.center[2]);
    };
    const auto for_all = [&](const auto& tell) {
      for (std::size_t s = 0; s < model_.shapes.size(); ++s)
        if (model_.shapes[s].frame == frame) tell(model_.shapes[s], errors_[s]);
    };
    for_all([&](const ShapeModel& shape, double its) {
      const Vec3 radius = Vec3::Constant(shape.whole.radius);
      low = low.cwiseMin(center_of(shape) - radius);
      high = high.cwiseMax(center_of(shape) + radius);
      error = std::max(error, its);
    });
    Ball ball;
    ball.center = 0.5 * (low + high);
    for_all([&](const ShapeModel& shape, double) {
      ball.radius = std::max(
          ball.radius, (center_of(shape) - ball.center).norm() * (1 + 1e-12) + shape.whole.radius);
    });
    const LinkPlace place{frame, {}, 0};
    of_frame_[frame] = size_of(model_.clusters);
    model_.clusters.push_back({frame, outer_ball(chain_, place, ball, error)});
    return of_frame_[frame];
  }

  std::uint32_t number_of(const ClusterPair& pair, float margin) {
    const auto found = std::ranges::find_if(model_.cluster_pairs, [&](const ClusterPair& other) {
      return other.a == pair.a && other.b == pair.b && other.with_group == pair.with_group;
    });
    const auto number = static_cast<std::uint32_t>(found - model_.cluster_pairs.begin());
    if (found == model_.cluster_pairs.end()) model_.cluster_pairs.push_back(pair);
    float& most = model_.cluster_pairs[number].margin;
    most = std::max(most, margin);
    return number;
  }

  const Chain& chain_;
  const std::vector<double>& errors_;
  Model& model_;
  std::vector<std::uint32_t> of_frame_;
  std::vector<std::size_t> count_;
};

}  // namespace

Model make_model(const world::Checker& checker, const world::WorldState& given, std::size_t robot,
                 std::size_t most_balls) {
  Model out;
  const world::World& world = checker.world();
  const world::RobotModel& model = world.robots[robot];
  const Chain chain = add_chain(model, out);
  out.unusable =
      out.unusable || checker.substitute() != nullptr ||
      (!given.absent_robots.empty() && given.absent_robots[robot]) ||
      std::ranges::any_of(given.attachments, [&](const auto& attachment) {
        // Fingers that hold something may be off: check_motion makes room for that.
        return attachment && (attachment->robot == robot || !attachment->fingers.empty());
      });
  if (out.unusable) return out;
  world::WorldState state = given;
  for (std::size_t i = 0; i < out.variables; ++i)
    state.q[robot][i] = 0.5 * (out.low[i] + out.high[i]);
  world::Scratch scratch;
  std::vector<Item> links;
  for (std::size_t s = 0; s < model.shapes.size(); ++s) links.push_back({robot, s});
  std::vector<double> errors;
  for (const auto& at : checker.places(state, links, scratch)) errors.push_back(at.place.error());
  add_shapes(model, chain, errors, most_balls, out);
  add_levers(chain, out);
  add_blur(chain, out);

  const auto moves = [&](const Item& item) {
    return item.robot == robot && out.shapes[item.index].frame != 0;
  };
  Groups groups;
  const auto group_of = [&](const Item& item) {
    if (const auto found = groups.find(item); found != groups.end()) return found->second;
    add_group(checker.places(state, {item}, scratch).front().place, model.base.translation, out);
    return groups[item] = size_of(out.groups) - 1;
  };
  for (const auto& pair : checker.pairs(state, {})) {
    auto [a, b] = pair;
    if (!moves(a)) std::swap(a, b);
    if (!moves(a)) continue;
    const double margin = margin_between(world, state, a, b);
    const float above = rounded_up(margin * kSums), below = rounded_down(margin / kSums);
    const auto shape = static_cast<std::uint32_t>(a.index);
    if (b.robot == robot)
      out.shape_pairs.push_back(
          {shape,
           static_cast<std::uint32_t>(b.index),
           common_frame(out, out.shapes[a.index].frame, out.shapes[b.index].frame),
           above,
           below,
           {}});
    else
      out.obstacle_pairs.push_back({shape, group_of(b), above, below});
  }
  out.always_contact = std::ranges::any_of(
      checker.find_contacts(state, scratch, {}),
      [&](const auto& contact) { return !moves(contact.items[0]) && !moves(contact.items[1]); });
  add_corners(checker, model, robot, chain, errors, out);
  const std::vector<double> rows = drawn_rows(out);
  PairProbe probe(out, rows);
  for (std::size_t i = 0; i < out.shape_pairs.size(); ++i)
    add_witnesses(checker, state, robot, chain, errors, rows, probe.look_at(out.shape_pairs[i]), i,
                  out);
  leave_out_of_reach(chain, model, out);
  constexpr std::size_t kRowsForOrder = 500;
  sort_pairs(std::span(rows).first(kRowsForOrder * out.variables), out);
  Clusters(chain, errors, out).add();
  add_items(robot, groups, out);
  return out;
}

}  // namespace kaboum::filter::detail
