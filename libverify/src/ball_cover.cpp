// Unions of balls against triangles and solids: docs/algorithms/sphere-covers.md.
#include <kaboum/verify/ball_cover.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <queue>

#include "body_bounds.h"
#include "cell_sample.h"
#include "nearest.h"
#include "number.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

constexpr int kTriangleCuts = 50;  ///< weights remain multiples of 2^-52
constexpr int kBoxCuts = 40;
constexpr std::size_t kPartsOfOne = std::size_t{1} << 20U;  ///< of one triangle
constexpr std::size_t kTrianglesAtOnce = 4096;
constexpr int kTurns = 12;               ///< of a plane that is to separate a box
constexpr double kUnderflow = 0x1p-500;  ///< more than what squares lose, as a length
constexpr double kSqrt3Up = 1.7320508076;

struct Ball {
  Vec3 center;
  double radius;
};

std::vector<Ball> balls_of(const geom::ConvexSet& set) {
  std::vector<Ball> out;
  out.reserve(set.bodies.size());
  for (const geom::ConvexBody& body : set.bodies)
    out.push_back({body.core.vertices[0], body.radius});
  return out;
}

double largest_of(const Vec3& p) { return p.cwiseAbs().maxCoeff(); }

/// Error of a distance between points that were computed from numbers up to `largest` by a dozen
/// roundings. [length]
double slack_of(double largest) { return 64 * kUnit * largest + kUnderflow; }

/// A point of a triangle, by weights that are multiples of 2^-52 and sum up to 1.
struct Corner {
  std::array<double, 3> weight;
  Vec3 at;  ///< rounded
};

using Corners = std::array<Vec3, 3>;

Corner corner_of(const Corners& t, const std::array<double, 3>& weight) {
  return {weight, weight[0] * t[0] + weight[1] * t[1] + weight[2] * t[2]};
}

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

/// Whether a point given by doubles is in a ball, exactly.
bool is_within(const Ball& ball, const Vec3& p) {
  const double distance = (p - ball.center).norm(),
               slack = slack_of(largest_of(p) + largest_of(ball.center) + ball.radius);
  if (distance + slack <= ball.radius) return true;
  if (distance - slack > ball.radius) return false;
  const Triple<Exact> d{difference<Exact>(p[0], ball.center[0]),
                        difference<Exact>(p[1], ball.center[1]),
                        difference<Exact>(p[2], ball.center[2])};
  const Exact r(ball.radius);
  return sign_of(r * r - dot(d, d)) != Sign::Negative;
}

// --- triangles -------------------------------------------------------------------------------

struct Part {
  std::array<Corner, 3> corner;
  int cuts = 0;
  std::vector<std::uint32_t> near;  ///< all balls that meet it are among these
};

struct TriangleAnswer {
  Answer answer = Answer::Verified;
  std::size_t parts = 0;
  Vec3 at = Vec3::Zero();  ///< refuted: in no ball, rounded
  bool is_corner = false;
};

class TriangleCover {
 public:
  TriangleCover(const Corners& triangle, const std::vector<Ball>& balls)
      : t_(triangle), balls_(balls) {
    for (const Vec3& v : t_) largest_ = std::max(largest_, largest_of(v));
  }

  TriangleAnswer decide(std::vector<std::uint32_t> near) {
    Part all{{corner_of(t_, {1, 0, 0}), corner_of(t_, {0, 1, 0}), corner_of(t_, {0, 0, 1})},
             0,
             std::move(near)};
    for (const Corner& c : all.corner)
      if (!is_covered(c, all.near)) return refuted(c, true);
    std::vector<Part> open{std::move(all)};
    while (!open.empty()) {
      Part part = std::move(open.back());
      open.pop_back();
      ++out_.parts;
      if (in_one_ball(part)) continue;
      if (part.cuts >= kTriangleCuts || out_.parts >= kPartsOfOne) {
        out_.answer = Answer::Undecided;
        out_.at = part.corner[0].at;
        return out_;
      }
      if (const std::optional<Corner> outside = halve(std::move(part), open))
        return refuted(*outside, false);
    }
    return out_;
  }

 private:
  TriangleAnswer refuted(const Corner& c, bool is_corner) {
    out_.answer = Answer::Refuted;
    out_.at = c.at;
    out_.is_corner = is_corner;
    return out_;
  }

  [[nodiscard]] bool is_covered(const Corner& c, const std::vector<std::uint32_t>& near) const {
    return std::ranges::any_of(
        near, [&](std::uint32_t b) { return is_within(balls_[b], t_, c, largest_); });
  }

  [[nodiscard]] bool in_one_ball(const Part& part) const {
    return std::ranges::any_of(part.near, [&](std::uint32_t b) {
      return std::ranges::all_of(
          part.corner, [&](const Corner& c) { return is_within(balls_[b], t_, c, largest_); });
    });
  }

  /// Cuts the longest side at its middle. @return the middle, where it is in no ball
  [[nodiscard]] std::optional<Corner> halve(Part part, std::vector<Part>& open) const {
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (part.corner[(k + 1) % 3].at - part.corner[k].at).squaredNorm();
      if (!(length > most)) continue;
      most = length;
      longest = k;
    }
    const std::size_t next = (longest + 1) % 3;
    std::array<double, 3> weight;
    for (std::size_t i = 0; i < 3; ++i)
      weight[i] = 0.5 * (part.corner[longest].weight[i] + part.corner[next].weight[i]);
    const Corner middle = corner_of(t_, weight);
    if (!is_covered(middle, part.near)) return middle;
    for (const std::size_t replaced : {longest, next}) {
      Part half;
      half.corner = part.corner;
      half.corner[replaced] = middle;
      half.cuts = part.cuts + 1;
      keep_near(half, part.near);
      open.push_back(std::move(half));
    }
    return std::nullopt;
  }

  void keep_near(Part& part, const std::vector<std::uint32_t>& known) const {
    const Vec3 middle = (part.corner[0].at + part.corner[1].at + part.corner[2].at) / 3;
    double reach = 0;
    for (const Corner& c : part.corner) reach = std::max(reach, (c.at - middle).norm());
    for (const std::uint32_t b : known) {
      const Ball& ball = balls_[b];
      const double slack = slack_of(largest_ + largest_of(ball.center) + ball.radius);
      // Not: keeps all where numbers overflow.
      if (!((middle - ball.center).norm() - reach - 4 * slack > ball.radius))
        part.near.push_back(b);
    }
  }

  const Corners& t_;
  const std::vector<Ball>& balls_;
  double largest_ = 0;
  TriangleAnswer out_;
};

std::vector<std::uint32_t> balls_near(const geom::Box3& box, const std::vector<Ball>& balls) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t b = 0; b < balls.size(); ++b) {
    const Ball& ball = balls[b];
    const double reach = ball.radius + slack_of(largest_of(ball.center) + ball.radius);
    bool apart = false;
    for (int k = 0; k < 3; ++k)
      apart = apart || ball.center[k] + reach < box.min[k] || ball.center[k] - reach > box.max[k];
    if (!apart) out.push_back(b);
  }
  return out;
}

/// Of all triangles; those after the limit was reached are Undefined.
std::vector<TriangleAnswer> decide_triangles(const geom::Mesh& mesh, const std::vector<Ball>& balls,
                                             std::size_t most) {
  std::vector<TriangleAnswer> out(mesh.triangles.size());
  for (TriangleAnswer& answer : out) answer.answer = Answer::Undefined;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < out.size() && parts <= most; i += kTrianglesAtOnce) {
    const std::size_t end = std::min(out.size(), i + kTrianglesAtOnce);
    parallel_for(i, end, [&](std::size_t t) {
      const geom::Triangle& v = mesh.triangles[t];
      const Corners corners{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
      geom::Box3 box;
      for (const Vec3& p : corners) box.extend(p);
      out[t] = TriangleCover(corners, balls).decide(balls_near(box, balls));
    });
    for (std::size_t t = i; t < end; ++t) parts += out[t].parts;
  }
  return out;
}

// --- the inside ------------------------------------------------------------------------------

struct Box {
  Vec3 center;
  double half;
  int cuts;
  std::vector<std::uint32_t> active;  ///< all balls of least power somewhere in it are among these
};

/// Search of a point of the solid in no ball, all triangles being in balls.
class VoidSearch {
 public:
  VoidSearch(const geom::Mesh& mesh, const MeshPair& meshes, const std::vector<Ball>& balls)
      : meshes_(meshes),
        nearest_(meshes, kOutside),
        balls_(balls),
        box_(geom::bounding_box(mesh)) {}

  Claim decide(std::size_t most) {
    Claim claim;
    claim.answer = Answer::Verified;
    std::vector<Box> open{root()};
    std::size_t seen = 0;
    std::optional<Vec3> left_open;
    while (!open.empty()) {
      Box box = std::move(open.back());
      open.pop_back();
      if (++seen > most || !std::isfinite(box.half)) {
        left_open = box.center;
        break;
      }
      if (is_apart(box)) continue;
      keep_active(box);
      if (in_one_ball(box) || box.active.size() < 4 || is_separated(box)) continue;
      if (is_free(box.center, box.active)) {
        const std::optional<int> winding =
            winding_at(meshes_, kOutside, box.center * meshes_.scale());
        if (winding && *winding >= 1) return refuted(box.center);
        if (winding && is_without_triangles(box)) continue;
      }
      if (box.cuts >= deepest_) {
        left_open = box.center;
        continue;
      }
      for (int i = 0; i < 8; ++i) {
        const Vec3 to(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        open.push_back(
            {box.center + 0.5 * box.half * to, 0.5 * box.half, box.cuts + 1, box.active});
      }
    }
    if (left_open) {
      claim.answer = Answer::Undecided;
      claim.reason = "the balls leave too little slack, or too many boxes are needed, inside";
      claim.witness = Witness{*left_open, 0, false};
    }
    return claim;
  }

 private:
  /// Corners and middles of all boxes are multiples of a power of two that doubles hold.
  Box root() {
    const double extent = (box_.max - box_.min).maxCoeff();
    int exponent = 0;
    std::frexp(extent, &exponent);
    const double size = std::ldexp(1.0, exponent + 1), step = std::ldexp(size, -8);
    Vec3 low = box_.min;
    for (int k = 0; k < 3; ++k) low[k] = step * std::floor(low[k] / step);
    const double most = std::max(largest_of(box_.min), largest_of(box_.max)) + 2 * size;
    int largest = 0;
    std::frexp(most / size, &largest);
    deepest_ = std::max(0, std::min(kBoxCuts, 50 - largest));
    Box out{low + Vec3::Constant(0.5 * size), 0.5 * size, 0, {}};
    for (std::uint32_t b = 0; b < balls_.size(); ++b) out.active.push_back(b);
    return out;
  }

  [[nodiscard]] bool is_apart(const Box& box) const {
    for (int k = 0; k < 3; ++k)
      if (box.center[k] + box.half < box_.min[k] || box.center[k] - box.half > box_.max[k])
        return true;
    return false;
  }

  /// Leaves out balls that have a larger power than another one all over the box: the difference is
  /// linear.
  void keep_active(Box& box) const {
    const auto power = [&](const Ball& ball) {
      return (box.center - ball.center).squaredNorm() - ball.radius * ball.radius;
    };
    const auto terms = [&](const Ball& ball) {
      return (box.center - ball.center).squaredNorm() + ball.radius * ball.radius;
    };
    const auto least =
        std::ranges::min_element(box.active, {}, [&](std::uint32_t b) { return power(balls_[b]); });
    const Ball& best = balls_[*least];
    const double far = largest_of(box.center) + box.half;
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t b : box.active) {
      const Ball& ball = balls_[b];
      const double change = 2 * box.half * (ball.center - best.center).cwiseAbs().sum();
      const double largest = far + largest_of(ball.center) + largest_of(best.center);
      const double error =
          64 * kUnit * (terms(ball) + terms(best) + change + largest * largest) + kUnderflow;
      if (!(power(ball) - power(best) - change > error)) kept.push_back(b);
    }
    box.active = std::move(kept);
  }

  [[nodiscard]] bool in_one_ball(const Box& box) const {
    return std::ranges::any_of(box.active, [&](std::uint32_t b) {
      Vec3 corner;  // the farthest
      for (int k = 0; k < 3; ++k)
        corner[k] = box.center[k] + (balls_[b].center[k] > box.center[k] ? -box.half : box.half);
      return is_within(balls_[b], corner);
    });
  }

  /// A plane has the box on one side and the centres of all its balls on the other.
  [[nodiscard]] bool is_separated(const Box& box) const {
    Vec3 normal = Vec3::Zero();
    for (const std::uint32_t b : box.active) normal += balls_[b].center - box.center;
    for (int turn = 0; turn < kTurns; ++turn) {
      const double length = normal.norm();
      if (!(length > 0) || !std::isfinite(length)) return false;
      normal /= length;
      double least = std::numeric_limits<double>::infinity();
      Vec3 worst = Vec3::Zero();
      double largest = largest_of(box.center) + box.half;
      for (const std::uint32_t b : box.active) {
        const Vec3 to = balls_[b].center - box.center;
        largest = std::max(largest, largest_of(balls_[b].center));
        if (const double height = normal.dot(to); height < least) {
          least = height;
          worst = to;
        }
      }
      if (least > box.half * normal.cwiseAbs().sum() * kUp + 4 * slack_of(largest)) return true;
      // Turned to have the lowest one higher, by more where it is nearer.
      normal = 0.5 * (turn % 2 + 1) * normal + worst / std::max(worst.norm(), box.half);
    }
    return false;
  }

  [[nodiscard]] bool is_free(const Vec3& p, const std::vector<std::uint32_t>& active) const {
    return std::ranges::none_of(active, [&](std::uint32_t b) { return is_within(balls_[b], p); });
  }

  [[nodiscard]] bool is_without_triangles(const Box& box) const {
    const Vec3 p = box.center * meshes_.scale();
    const double largest = std::max(meshes_.largest_coordinate(), largest_of(p));
    return nearest_.all_beyond(
        p, kSqrt3Up * box.half * meshes_.scale() + 4 * rounding_of_distances(largest));
  }

  [[nodiscard]] Claim refuted(const Vec3& p) const {
    Claim claim;
    claim.answer = Answer::Refuted;
    claim.reason = "a point inside the solid is in no ball";
    double depth = std::numeric_limits<double>::infinity();
    for (const Ball& ball : balls_) depth = std::min(depth, (p - ball.center).norm() - ball.radius);
    claim.witness = Witness{p, std::max(0.0, depth), true};
    return claim;
  }

  const MeshPair& meshes_;
  NearestTriangle nearest_;
  const std::vector<Ball>& balls_;
  geom::Box3 box_;
  int deepest_ = 0;
};

Claim undecided(std::string why) {
  Claim claim;
  claim.answer = Answer::Undecided;
  claim.reason = std::move(why);
  return claim;
}

/// Beneath places of triangles that are in no ball.
Claim solid_beneath(const geom::Mesh& mesh, const MeshPair& meshes, const std::vector<Ball>& balls,
                    const std::vector<TriangleAnswer>& found) {
  constexpr std::size_t kPlaces = 2000;
  std::size_t looked = 0;
  for (std::size_t t = 0; t < found.size() && looked < kPlaces; ++t) {
    if (found[t].answer != Answer::Refuted) continue;
    const geom::Triangle& v = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[v[0]], &b = mesh.vertices[v[1]], &c = mesh.vertices[v[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized(), middle = (a + b + c) / 3;
    if (!normal.allFinite()) continue;
    ++looked;
    const double size = (middle - found[t].at).norm();
    for (const double share : {0.3, 0.01, 1e-4}) {
      const Vec3 p = found[t].at + share * (middle - found[t].at) - 0.5 * share * size * normal;
      if (!p.allFinite() ||
          std::ranges::any_of(balls, [&](const Ball& ball) { return is_within(ball, p); }))
        continue;
      const std::optional<int> winding = winding_at(meshes, kOutside, p * meshes.scale());
      if (!winding || *winding < 1) continue;
      Claim claim;
      claim.answer = Answer::Refuted;
      claim.reason = "a point inside the solid is in no ball";
      claim.witness = Witness{p, share * size, true};
      claim.inner_triangles = {static_cast<std::uint32_t>(t)};
      return claim;
    }
  }
  return undecided("triangles stick out, and no point of the solid was found that does");
}

Claim surface_claim(const geom::ConvexSet& set, const std::vector<TriangleAnswer>& found,
                    Inclusion& out) {
  Claim claim;
  claim.answer = Answer::Verified;
  Vec3 open = Vec3::Zero();
  for (std::uint32_t t = 0; t < found.size(); ++t) {
    const TriangleAnswer& one = found[t];
    if (one.answer == Answer::Verified) continue;
    if (one.answer != Answer::Refuted) {
      if (out.left_out++ == 0) open = one.at;
      continue;
    }
    const double depth = distance_to_bodies(set, one.at);
    claim.inner_triangles.push_back(t);
    if (!claim.witness || depth > claim.witness->depth)
      claim.witness = Witness{one.at, depth, one.is_corner};
  }
  if (!claim.inner_triangles.empty()) {
    claim.answer = Answer::Refuted;
    claim.reason = "a point of a triangle is in no ball";
  } else if (out.left_out > 0) {
    claim = undecided("of " + std::to_string(out.left_out) +
                      " triangles it was not decided whether the balls hold them: there is too "
                      "little slack, or too many parts are needed");
    claim.witness = Witness{open, 0, false};
  }
  out.limited = out.left_out > 0;
  return claim;
}

// --- distances -------------------------------------------------------------------------------

/// A ball that a part of a body lies in.
struct Cell {
  Vec3 center;
  double reach;  ///< half the diagonal of the box
  double half;
  std::uint32_t ball;
  int cuts;
};

/// A ball that holds all that a ball has in common with a ball about b of radius h: about
/// m = λ c + (1 − λ) b, of radius ρ with ρ² = λ r² + (1 − λ) h² − λ (1 − λ) |b − c|².
Ball common_ball(const Ball& ball, const Vec3& b, double h, double lambda) {
  const Vec3 to = ball.center - b;
  const double gains = lambda * ball.radius * ball.radius + (1 - lambda) * h * h,
               loses = lambda * (1 - lambda) * to.squaredNorm();
  // A dozen roundings of what is added up, and of m.
  const double square = std::max(0.0, gains - loses) + 16 * kUnit * (gains + loses);
  return {b + lambda * to,
          std::sqrt(square) * kUp + slack_of(largest_of(b) + largest_of(ball.center) + h)};
}

/// Bounds of the distance from a point to the solid's surface, negative inside, in the unit of the
/// mesh.
class SignedDistance {
 public:
  explicit SignedDistance(const geom::Mesh& mesh)
      : meshes_(geom::Mesh{}, mesh), nearest_(meshes_, kOutside) {}

  [[nodiscard]] std::pair<double, double> operator()(const Vec3& q) const {
    const Vec3 p = q * meshes_.scale();
    const double slack =
        4 * rounding_of_distances(std::max(meshes_.largest_coordinate(), largest_of(p)));
    const double far = nearest_.distance(p);
    const double above = meshes_.length_outside(far + slack);
    const double below =
        std::max(0.0, meshes_.length_outside(nearest_.lower_bound(p, far) - slack));
    const std::optional<int> winding = winding_at(meshes_, kOutside, p);
    if (winding && *winding >= 1) return {-above, -below};
    if (!winding) return {-0.0, above};
    return {below, above};
  }

  /// The point of a ball that is beyond its centre's nearest point of the surface: most often the
  /// farthest one.
  [[nodiscard]] Vec3 far_point(const Ball& ball) const {
    const Vec3 p = ball.center * meshes_.scale();
    const std::uint32_t f = nearest_.nearest(p).face;
    const Vec3 near = meshes_.point_outside(
        closest_point(p, meshes_.corner(f, 0), meshes_.corner(f, 1), meshes_.corner(f, 2)));
    const std::optional<int> winding = winding_at(meshes_, kOutside, p);
    const Vec3 along = (winding && *winding >= 1 ? near - ball.center : ball.center - near);
    const double length = along.norm();
    if (!(length > 0)) return ball.center;
    return ball.center + ball.radius * (1 - 1e-12) / length * along;
  }

 private:
  MeshPair meshes_;
  NearestTriangle nearest_;
};

// --- how much is outside ----------------------------------------------------------------------

/// A part of a triangle, of rounded corners.
struct OpenPart {
  Corners corner;
  double area;
  double upper;  ///< bound of its points' distances from the union
};

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
      if (in_one_ball(part.corner)) return take(part.corner, out.held);
      const Vec3 middle = middle_of(part.corner);
      const double reach = reach_of(part.corner, middle);
      if (height(middle) - reach > slack_) return take(part.corner, out.outside);
      if (reach > size) return open.push(part);
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
  [[nodiscard]] OpenPart part_of(const Corners& c) const {
    const Vec3 middle = middle_of(c);
    return {c, 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm(), height(middle) + reach_of(c, middle)};
  }
  [[nodiscard]] bool in_one_ball(const Corners& c) const {
    return std::ranges::any_of(balls_, [&](const Ball& b) {
      return std::ranges::all_of(
          c, [&](const Vec3& p) { return (p - b.center).norm() + slack_ <= b.radius; });
    });
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
      if (in_one_ball(part.corner)) continue;
      halve(part, look);
    }
    if (!open.empty()) out_.depth_upper = std::max(0.0, open.top().upper + slack_);
    out_.depth_upper = std::max(out_.depth_upper, out_.depth_lower);
  }

  void measure_share() {
    if (!(out_.area > 0)) return;
    const auto less = [](const OpenPart& a, const OpenPart& b) { return a.area < b.area; };
    std::priority_queue<OpenPart, std::vector<OpenPart>, decltype(less)> open(less);
    double outside = 0, unknown = 0;
    const auto look = [&](const OpenPart& part) {
      if (in_one_ball(part.corner)) return;
      const Vec3 middle = middle_of(part.corner);
      if (height(middle) - reach_of(part.corner, middle) > slack_) {
        outside += part.area;
        return;
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
    out_.share_lower = std::clamp(outside / out_.area - 1e-9, 0.0, 1.0);
    out_.share_upper = std::clamp((outside + std::max(unknown, 0.0)) / out_.area + 1e-9, 0.0, 1.0);
    if (open.empty() && outside == 0) out_.share_upper = 0;
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
  const MeshPair meshes(geom::Mesh{}, original);
  Inclusion out;
  out.inner_open_edges = meshes.unbalanced(mask_of(kOutside), false);
  out.inner_closed = out.inner_open_edges == 0;
  out.triangles_without_area = meshes.without_area(kOutside) + meshes.repeated(kOutside).size();
  if (original.triangles.empty()) {
    out.solid.reason = out.surface.reason = "the inner mesh has no triangles";
    return out;
  }
  const std::vector<Ball> balls = balls_of(set);
  if (options.progress) options.progress("parts of triangles in balls");
  const std::vector<TriangleAnswer> found = decide_triangles(original, balls, options.max_cells);
  out.surface = surface_claim(set, found, out);
  if (!out.inner_closed) {
    out.solid.reason = "the meshes are not closed and have different borders";
  } else if (meshes.tree(kOutside).empty()) {
    out.solid.reason = "no triangle of the inner mesh has an area, so that it has no solid";
  } else if (options.surface_only) {
    out.solid.reason = "only the surface claim was asked for";
  } else if (out.surface.answer == Answer::Verified) {
    if (options.progress) options.progress("boxes inside the solid");
    out.solid = VoidSearch(original, meshes, balls).decide(options.max_cells);
  } else if (out.surface.answer == Answer::Refuted) {
    out.solid = solid_beneath(original, meshes, balls, found);
  } else {
    out.solid = undecided("it is not known whether the balls hold all triangles");
  }
  return out;
}

DistanceClaim verify_ball_excess(const geom::ConvexSet& set, const geom::Mesh& original,
                                 double epsilon) {
  constexpr int kCuts = 24;
  constexpr std::size_t kMostCells = 1'000'000;
  const SignedDistance distance(original);
  const std::vector<Ball> balls = balls_of(set);
  DistanceClaim out;
  out.answer = Answer::Verified;
  std::vector<Cell> open;
  const auto look = [&](std::uint32_t b, const Vec3& p, double reached) {
    if (reached > out.largest) {
      out.largest = reached;
      out.at = p;
    }
    if (!(reached > epsilon)) return false;
    out.answer = Answer::Refuted;
    out.reason = "a point of ball " + std::to_string(b) + " is farther away";
    return true;
  };
  for (std::uint32_t b = 0; b < balls.size(); ++b)
    if (const Vec3 p = distance.far_point(balls[b]);
        is_within(balls[b], p) && look(b, p, distance(p).first))
      return out;
  const auto slack = [](const Cell& cell) {
    return slack_of(largest_of(cell.center) + cell.reach);
  };
  for (std::uint32_t b = 0; b < balls.size(); ++b) {
    // The ball itself first, then boxes.
    open.push_back({balls[b].center, balls[b].radius, balls[b].radius, b, 0});
    for (bool first = true; !open.empty(); first = false) {
      const Cell cell = open.back();
      open.pop_back();
      const Ball& ball = balls[cell.ball];
      const double away = (cell.center - ball.center).norm();
      if (!first && away - cell.reach - 4 * slack(cell) > ball.radius) continue;
      ++out.pieces;
      const auto [lower, upper] = distance(cell.center);
      if (upper + cell.reach * kUp + slack(cell) <= epsilon) continue;
      if (!first && upper > 0 && upper < away) {
        const Ball common = common_ball(ball, cell.center, cell.reach * kUp, upper / away);
        if (distance(common.center).second + common.radius <= epsilon) continue;
      }
      Vec3 p = cell.center;
      if (away > ball.radius)
        p = ball.center + ball.radius / away * (1 - 1e-12) * (p - ball.center);
      if (is_within(ball, p) && look(b, p, p == cell.center ? lower : distance(p).first))
        return out;
      if (cell.cuts >= kCuts || out.pieces > kMostCells) {
        out.answer = Answer::Undecided;
        out.reason = "the farthest point of ball " + std::to_string(b) +
                     " is as far away as that but for rounding";
        open.clear();
        break;
      }
      const double half = first ? cell.half : 0.5 * cell.half;
      const auto add = [&](const Vec3& center) {
        open.push_back({center, kSqrt3Up * half * kUp, half, cell.ball, cell.cuts + 1});
      };
      if (first) {
        add(cell.center);
        continue;
      }
      for (int i = 0; i < 8; ++i)
        add(cell.center + half * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    if (out.pieces > kMostCells) break;
  }
  return out;
}

}  // namespace kaboum::verify
