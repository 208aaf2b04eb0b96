// Unions of balls against triangles and solids: docs/algorithms/sphere-covers.md.
#include <kaboum/verify/ball_cover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "ball.h"
#include "number.h"
#include "union_cover.h"

namespace kaboum::verify {
namespace {

using union_cover::Corner;
using union_cover::Corners;
using union_cover::Extent;
using union_cover::largest_of;

constexpr int kTurns = 12;  ///< of a plane that is to separate a box

/// |Σ wᵢ (vᵢ − c)|² ≤ r².
bool exactly_within(const Ball& ball, const Corners& t, const Corner& p) {
  Triple<Exact> d{Exact(0), Exact(0), Exact(0)};
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      d[static_cast<std::size_t>(k)] =
          d[static_cast<std::size_t>(k)] +
          Exact(p.weight[i]) * difference<Exact>(t[i][k], ball.center[k]);
  const Exact r(ball.radius);
  return sign_of(r * r - dot(d, d)) != Sign::Negative;
}

bool is_within(const Ball& ball, const Corners& t, const Corner& p, double largest) {
  const double distance = (p.at - ball.center).norm(),
               slack = slack_of(largest + largest_of(ball.center) + ball.radius);
  if (distance + slack <= ball.radius) return true;
  if (distance - slack > ball.radius) return false;
  return exactly_within(ball, t, p);
}

/// What decides unions of balls.
class Balls {
 public:
  static constexpr const char* kOne = "ball";
  static constexpr const char* kMany = "balls";

  explicit Balls(const geom::ConvexSet& set) : balls_(balls_of(set)) {}

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(balls_.size()); }
  [[nodiscard]] bool holds(std::uint32_t b, const Corners& t, const Corner& c,
                           double largest) const {
    return is_within(balls_[b], t, c, largest);
  }
  [[nodiscard]] bool holds(std::uint32_t b, const Vec3& p) const { return is_within(balls_[b], p); }

  [[nodiscard]] bool may_meet(std::uint32_t b, const Extent& extent, double largest) const {
    const Ball& ball = balls_[b];
    const double slack = 4 * slack_of(largest + largest_of(ball.center) + ball.radius),
                 reach = ball.radius + slack;
    for (int k = 0; k < 3; ++k)
      if (ball.center[k] + reach < extent.box.min[k] || ball.center[k] - reach > extent.box.max[k])
        return false;
    // Not: keeps all where numbers overflow.
    return !((extent.middle - ball.center).norm() - extent.reach - slack > ball.radius);
  }

  /// Powers instead of distances: their voids have their farthest points where theirs is least.
  [[nodiscard]] bool is_settled(union_cover::Cell& cell) const {
    keep_active(cell);
    return in_one_ball(cell) || cell.active.size() < 4 || is_separated(cell);
  }

 private:
  /// Leaves out balls that have a larger power than another one all over the box: the difference is
  /// linear.
  void keep_active(union_cover::Cell& cell) const {
    const auto power = [&](const Ball& ball) {
      return (cell.center - ball.center).squaredNorm() - ball.radius * ball.radius;
    };
    const auto terms = [&](const Ball& ball) {
      return (cell.center - ball.center).squaredNorm() + ball.radius * ball.radius;
    };
    const auto least = std::ranges::min_element(cell.active, {},
                                                [&](std::uint32_t b) { return power(balls_[b]); });
    const Ball& best = balls_[*least];
    const double far = largest_of(cell.center) + cell.half;
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t b : cell.active) {
      const Ball& ball = balls_[b];
      const double change = 2 * cell.half * (ball.center - best.center).cwiseAbs().sum();
      const double largest = far + largest_of(ball.center) + largest_of(best.center);
      const double error =
          64 * kUnit * (terms(ball) + terms(best) + change + largest * largest) + kUnderflow;
      if (!(power(ball) - power(best) - change > error)) kept.push_back(b);
    }
    cell.active = std::move(kept);
  }

  [[nodiscard]] bool in_one_ball(const union_cover::Cell& cell) const {
    return std::ranges::any_of(cell.active, [&](std::uint32_t b) {
      Vec3 corner;  // the farthest
      for (int k = 0; k < 3; ++k)
        corner[k] =
            cell.center[k] + (balls_[b].center[k] > cell.center[k] ? -cell.half : cell.half);
      return holds(b, corner);
    });
  }

  /// A plane has the box on one side and the centres of all its balls on the other.
  [[nodiscard]] bool is_separated(const union_cover::Cell& cell) const {
    Vec3 normal = Vec3::Zero();
    for (const std::uint32_t b : cell.active) normal += balls_[b].center - cell.center;
    for (int turn = 0; turn < kTurns; ++turn) {
      const double length = normal.norm();
      if (!(length > 0) || !std::isfinite(length)) return false;
      normal /= length;
      double least = std::numeric_limits<double>::infinity();
      Vec3 worst = Vec3::Zero();
      double largest = largest_of(cell.center) + cell.half;
      for (const std::uint32_t b : cell.active) {
        const Vec3 to = balls_[b].center - cell.center;
        largest = std::max(largest, largest_of(balls_[b].center));
        if (const double height = normal.dot(to); height < least) {
          least = height;
          worst = to;
        }
      }
      if (least > cell.half * normal.cwiseAbs().sum() * kUp + 4 * slack_of(largest)) return true;
      // Turned to have the lowest one higher, by more where it is nearer.
      normal = 0.5 * (turn % 2 + 1) * normal + worst / std::max(worst.norm(), cell.half);
    }
    return false;
  }

  std::vector<Ball> balls_;
};

// --- how much is outside ----------------------------------------------------------------------

/// A part of a triangle, of rounded corners.
struct OpenPart {
  Corners corner;
  double area;
  double upper;  ///< bound of its points' distances from the union, negative in one ball
  double lower;  ///< the same from below
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Signed area of what the triangle of the origin and an edge has in common with a disc about the
/// origin.
double area_in_disc(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double square) {
  const auto sector = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return 0.5 * square * std::atan2(cross(p, q), p.dot(q));
  };
  const Eigen::Vector2d d = b - a;
  const double length = d.squaredNorm(), half = a.dot(d),
               root = half * half - length * (a.squaredNorm() - square);
  if (!(root > 0) || !(length > 0)) return sector(a, b);
  const double first = (-half - std::sqrt(root)) / length,
               last = (-half + std::sqrt(root)) / length;
  if (first >= 1 || last <= 0) return sector(a, b);
  const Eigen::Vector2d p = a + std::max(first, 0.0) * d, q = a + std::min(last, 1.0) * d;
  return 0.5 * cross(p, q) + (first > 0 ? sector(a, p) : 0) + (last < 1 ? sector(q, b) : 0);
}

/// Area of what a triangle has in common with a ball, and what that errs by. The error of the plane
/// moves the disc by no more than 10^-10 of the radius, since slivers are left out.
/// @return nullopt for slivers
std::optional<std::pair<double, double>> area_in_ball(const Corners& c, double area,
                                                      const Ball& ball) {
  constexpr double kSliver = 1e-4, kTiny = 1e-6, kError = 1e-9;
  double longest = 0, far = largest_of(ball.center) + ball.radius;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, (c[(k + 1) % 3] - c[k]).norm());
    far = std::max(far, largest_of(c[k]));
  }
  if (!(2 * area > kSliver * longest * longest) || !(longest > kTiny * far)) return std::nullopt;
  const Vec3 u = (c[1] - c[0]).normalized();
  const Vec3 n = u.cross(c[2] - c[0]).normalized(), v = n.cross(u);
  const double height = n.dot(ball.center - c[0]),
               square = ball.radius * ball.radius - height * height;
  const double error = std::min(area, kError * far * far);
  if (!(square > 0)) return std::pair(0.0, error);
  std::array<Eigen::Vector2d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = {u.dot(c[k] - ball.center), v.dot(c[k] - ball.center)};
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k) out += area_in_disc(p[k], p[(k + 1) % 3], square);
  return std::pair(std::clamp(out, 0.0, area), error);
}

class OutsideSearch {
 public:
  OutsideSearch(const geom::Mesh& mesh, const std::vector<Ball>& balls) : balls_(balls) {
    double largest = 0;
    for (const geom::Triangle& t : mesh.triangles) {
      const Corners c{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
      for (const Vec3& p : c) largest = std::max(largest, largest_of(p));
      parts_.push_back(part_of(c));
      out_.area += parts_.back().area;
    }
    for (const Ball& b : balls_) largest = std::max(largest, largest_of(b.center) + b.radius);
    slack_ = 4 * slack_of(largest);
  }

  OutsideBalls measure() {
    measure_depth();
    measure_share();
    return out_;
  }

  /// Parts in one ball or outside, for certain; of smaller ones than `size` their middles decide.
  [[nodiscard]] SplitMesh split(double size, std::size_t most) const {
    const auto less = [](const OpenPart& a, const OpenPart& b) { return a.area < b.area; };
    std::priority_queue<OpenPart, std::vector<OpenPart>, decltype(less)> open(less);
    SplitMesh out;
    const auto take = [&](const Corners& c, geom::Mesh& to) {
      const auto first = static_cast<std::uint32_t>(to.vertices.size());
      to.vertices.insert(to.vertices.end(), c.begin(), c.end());
      to.triangles.push_back({first, first + 1, first + 2});
    };
    const auto by_middle = [&](const Corners& c) {
      take(c, height(middle_of(c)) > slack_ ? out.outside : out.held);
    };
    const auto look = [&](const OpenPart& part) {
      if (part.upper + slack_ <= 0) return take(part.corner, out.held);
      if (part.lower > slack_) return take(part.corner, out.outside);
      if (reach_of(part.corner, middle_of(part.corner)) > size) return open.push(part);
      by_middle(part.corner);
    };
    for (const OpenPart& part : parts_) look(part);
    while (!open.empty() &&
           open.size() + out.held.triangles.size() + out.outside.triangles.size() < most) {
      const OpenPart part = open.top();
      open.pop();
      halve(part, look);
    }
    for (; !open.empty(); open.pop()) by_middle(open.top().corner);
    return out;
  }

 private:
  static constexpr std::size_t kMostParts = std::size_t{1} << 20U;

  /// Distance from the union where above 0, rounded.
  [[nodiscard]] double height(const Vec3& p) const {
    double out = std::numeric_limits<double>::infinity();
    for (const Ball& b : balls_) out = std::min(out, (p - b.center).norm() - b.radius);
    return out;
  }
  static Vec3 middle_of(const Corners& c) { return (c[0] + c[1] + c[2]) / 3; }
  static double reach_of(const Corners& c, const Vec3& middle) {
    double out = 0;
    for (const Vec3& p : c) out = std::max(out, (p - middle).norm());
    return out;
  }
  /// The distance from one ball is a convex function: no larger than at the farthest corner.
  [[nodiscard]] OpenPart part_of(const Corners& c) const {
    const Vec3 middle = middle_of(c);
    const double reach = reach_of(c, middle);
    double of_middle = std::numeric_limits<double>::infinity(), upper = of_middle;
    for (const Ball& b : balls_) {
      of_middle = std::min(of_middle, (middle - b.center).norm() - b.radius);
      const double square =
          std::max({(c[0] - b.center).squaredNorm(), (c[1] - b.center).squaredNorm(),
                    (c[2] - b.center).squaredNorm()});
      upper = std::min(upper, std::sqrt(square) - b.radius);
    }
    return {c, 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm(), std::min(upper, of_middle + reach),
            of_middle - reach};
  }
  template <class Take>
  void halve(const OpenPart& part, const Take& take) const {
    const Corners& c = part.corner;
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if ((c[(k + 1) % 3] - c[k]).squaredNorm() > (c[(longest + 1) % 3] - c[longest]).squaredNorm())
        longest = k;
    const std::size_t next = (longest + 1) % 3;
    const Vec3 half = 0.5 * (c[longest] + c[next]);
    for (const std::size_t k : {longest, next}) {
      Corners one = c;
      one[k] = half;
      take(part_of(one));
    }
  }

  /// The ball that a part may meet, where there is one only.
  [[nodiscard]] const Ball* only_ball_near(const Corners& c) const {
    const Vec3 middle = middle_of(c);
    const double reach = reach_of(c, middle) + slack_;
    const Ball* out = nullptr;
    for (const Ball& b : balls_) {
      if ((middle - b.center).norm() - b.radius > reach) continue;
      if (out != nullptr) return nullptr;
      out = &b;
    }
    return out;
  }

  void measure_depth() {
    const auto less = [](const OpenPart& a, const OpenPart& b) { return a.upper < b.upper; };
    std::priority_queue<OpenPart, std::vector<OpenPart>, decltype(less)> open(less);
    const auto look = [&](const OpenPart& part) {
      for (const Vec3& p : part.corner) {
        const double found = height(p) - slack_;
        if (!(found > out_.depth_lower)) continue;
        out_.depth_lower = found;
        out_.at = p;
      }
      open.push(part);
    };
    for (const OpenPart& part : parts_) look(part);
    std::size_t seen = 0;
    while (!open.empty() && open.top().upper > out_.depth_lower * 1.001 + slack_ &&
           ++seen < kMostParts) {
      const OpenPart part = open.top();
      open.pop();
      halve(part, look);
    }
    if (!open.empty()) out_.depth_upper = std::max(0.0, open.top().upper + slack_);
    out_.depth_upper = std::max(out_.depth_upper, out_.depth_lower);
  }

  void measure_share() {
    if (!(out_.area > 0)) return;
    const auto less = [](const OpenPart& a, const OpenPart& b) { return a.area < b.area; };
    std::priority_queue<OpenPart, std::vector<OpenPart>, decltype(less)> open(less);
    double outside = 0, unknown = 0, error = 0;
    const auto look = [&](const OpenPart& part) {
      if (part.upper + slack_ <= 0) return;
      if (part.lower > slack_) {
        outside += part.area;
        return;
      }
      if (const Ball* ball = only_ball_near(part.corner)) {
        if (const auto inside = area_in_ball(part.corner, part.area, *ball)) {
          outside += part.area - inside->first;
          error += inside->second;
          return;
        }
      }
      unknown += part.area;
      open.push(part);
    };
    for (const OpenPart& part : parts_) look(part);
    std::size_t seen = 0;
    while (!open.empty() && unknown > 2e-3 * out_.area && ++seen < kMostParts) {
      const OpenPart part = open.top();
      open.pop();
      unknown -= part.area;
      halve(part, look);
    }
    // Sums and areas are rounded.
    out_.share_lower = std::clamp((outside - error) / out_.area - 1e-9, 0.0, 1.0);
    out_.share_upper =
        std::clamp((outside + error + std::max(unknown, 0.0)) / out_.area + 1e-9, 0.0, 1.0);
    if (open.empty() && outside == 0 && error == 0) out_.share_upper = 0;
  }

  const std::vector<Ball>& balls_;
  std::vector<OpenPart> parts_;
  double slack_ = 0;
  OutsideBalls out_;
};

}  // namespace

OutsideBalls measure_outside_balls(const geom::Mesh& mesh, const geom::ConvexSet& set) {
  geom::require_valid(mesh);
  const std::vector<Ball> balls = balls_of(set);
  OutsideBalls out = OutsideSearch(mesh, balls).measure();
  if (!balls.empty() || mesh.triangles.empty()) return out;
  out.share_lower = out.share_upper = 1;
  out.depth_lower = out.depth_upper = std::numeric_limits<double>::infinity();
  out.at = mesh.vertices[mesh.triangles[0][0]];
  return out;
}

SplitMesh split_by_balls(const geom::Mesh& mesh, const geom::ConvexSet& set, double size,
                         std::size_t most) {
  geom::require_valid(mesh);
  if (set.bodies.empty()) return {{}, mesh};
  const std::vector<Ball> balls = balls_of(set);
  return OutsideSearch(mesh, balls).split(size, most);
}

bool is_set_of_balls(const geom::ConvexSet& set) {
  return !set.bodies.empty() && std::ranges::all_of(set.bodies, [](const geom::ConvexBody& body) {
    return body.core.triangles.empty() && body.core.vertices.size() == 1 &&
           body.core.vertices[0].allFinite() && body.radius > 0 && std::isfinite(body.radius);
  });
}

Inclusion verify_ball_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                            const InclusionOptions& options) {
  return union_cover::decide(original, set, Balls(set), options);
}

}  // namespace kaboum::verify
