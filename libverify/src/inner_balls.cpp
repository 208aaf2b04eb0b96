// Balls inside a solid, and how deep it is where they are not:
// docs/algorithms/sphere-covers.md, "Inside a solid".
#include <kaboum/base/error.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/inner_balls.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "ball.h"
#include "cell_sample.h"
#include "membership.h"
#include "nearest.h"
#include "parallel.h"
#include "pieces.h"
#include "point_in_solid.h"
#include "uncovered_region.h"

namespace kaboum::verify {
namespace {

/// A ball in the meshes' unit; nullopt where its numbers do not survive that exactly.
std::optional<Ball> scaled(const MeshPair& meshes, const Ball& ball) {
  const Ball out{ball.center * meshes.scale(), ball.radius * meshes.scale()};
  const bool exact = out.center.allFinite() && std::isfinite(out.radius) &&
                     out.center / meshes.scale() == ball.center &&
                     out.radius / meshes.scale() == ball.radius;
  return exact ? std::optional(out) : std::nullopt;
}

/// A box that holds the ball.
Bounds bounds_of(const Ball& ball) {
  Bounds out;
  for (int k = 0; k < 3; ++k) {
    const double reach = ball.radius + 4 * kUnit * (std::abs(ball.center[k]) + ball.radius) + kTiny;
    out.low[k] = ball.center[k] - reach;
    out.high[k] = ball.center[k] + reach;
  }
  return out;
}

template <class Number>
std::optional<bool> reaches_inside_as(const Corners& t, const Ball& ball) {
  using membership::Sphere;
  const Triple<Number> p = numbers<Number>(ball.center);
  const double r = ball.radius;
  bool open = false;
  const auto holds = [&](const std::optional<bool>& one) {
    open = open || !one;
    return one.value_or(false);
  };
  if (holds(membership::near_triangle<Sphere::Without>(t[0], t[1], t[2], p, r))) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (holds(membership::near_point<Sphere::Without>(t[k], p, r))) return true;
    if (holds(membership::near_segment<Sphere::Without>(t[k], t[(k + 1) % 3], p, r))) return true;
  }
  return open ? std::nullopt : std::optional(false);
}

/// Whether a triangle has a point that is nearer to the ball's centre than its radius, exactly.
bool reaches_inside(const Corners& t, const Ball& ball) {
  const auto rounded = reaches_inside_as<Approx>(t, ball);
  return rounded ? *rounded : *reaches_inside_as<Exact>(t, ball);
}

/// The parts of a closed chain's triangles that bound its solid; nullopt beyond the limits.
std::optional<Pieces> bounding_pieces(const MeshPair& meshes, const InclusionOptions& options) {
  try {
    return pieces_with(meshes, kInside, options,
                       [](int inner, int outer) { return std::min(inner, outer) <= 0; });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::LimitReached) throw;
    return std::nullopt;
  }
}

/// What is found of one ball.
struct BallAnswer {
  Answer answer = Answer::Verified;
  std::optional<Vec3> outside;           ///< a point of it that is not in the solid, exactly
  std::vector<std::uint32_t> triangles;  ///< of the mesh: those that have points inside the ball
};

/// Balls in the solid of a chain.
class BallsWithin {
 public:
  BallsWithin(const MeshPair& meshes, const InclusionOptions& options)
      : meshes_(meshes), options_(options) {}

  std::vector<BallAnswer> decide(const std::vector<Ball>& balls) {
    std::vector<BallAnswer> out(balls.size());
    std::vector<std::vector<std::uint32_t>> near(balls.size());
    std::vector<char> crossed(balls.size(), 0);
    parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
      const std::optional<Ball> ball = scaled(meshes_, balls[i]);
      if (!ball) {
        out[i].answer = Answer::Undecided;
        return;
      }
      near[i] = faces_inside(*ball);
      crossed[i] = near[i].empty() ? 0 : 1;
      if (near[i].empty()) look_at_center(*ball, out[i]);
    });
    if (std::ranges::none_of(crossed, [](char c) { return c != 0; })) return out;
    bounding_ = bounding_pieces(meshes_, options_);
    triangles_ = bounding_ ? Triangles(meshes_, bounding_->parts) : Triangles(meshes_);
    parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
      if (crossed[i] != 0) look_at_pieces(*scaled(meshes_, balls[i]), near[i], out[i]);
    });
    return out;
  }

 private:
  [[nodiscard]] Corners corners_of(std::uint32_t t) const {
    return {triangles_.corner(t, 0), triangles_.corner(t, 1), triangles_.corner(t, 2)};
  }

  /// Faces that have points inside the ball.
  [[nodiscard]] std::vector<std::uint32_t> faces_inside(const Ball& ball) const {
    std::vector<std::uint32_t> out;
    const Bounds bounds = bounds_of(ball);
    meshes_.tree(kInside).query([&](const Bounds& box) { return box.meets(bounds); },
                                [&](std::uint32_t f) {
                                  if (reaches_inside(corners_of(f), ball)) out.push_back(f);
                                });
    std::ranges::sort(out);
    return out;
  }

  /// The centre tells of a ball inside of which nothing bounds the solid.
  void look_at_center(const Ball& ball, BallAnswer& out) const {
    const std::optional<int> winding = winding_at(meshes_, kInside, ball.center);
    if (winding) {
      if (*winding >= 1) return;
      out.answer = Answer::Refuted;
      out.outside = ball.center;
      return;
    }
    ExactPoint center{
        {Exact(ball.center[0]), Exact(ball.center[1]), Exact(ball.center[2])}, Exact(1), {}};
    for (int k = 0; k < 3; ++k) center.box.low[k] = center.box.high[k] = ball.center[k];
    try {
      if (is_in_solid(meshes_, kInside, center)) return;
      out.answer = Answer::Refuted;
      out.outside = ball.center;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::LimitReached) throw;
      out.answer = Answer::Undecided;
    }
  }

  void look_at_pieces(const Ball& ball, const std::vector<std::uint32_t>& near,
                      BallAnswer& out) const {
    const auto name = [&](const std::vector<std::uint32_t>& faces) {
      for (const std::uint32_t f : faces) out.triangles.push_back(meshes_.face(f).source);
      std::ranges::sort(out.triangles);
    };
    if (!bounding_) {
      out.answer = Answer::Undecided;
      return name(near);
    }
    const auto faces = static_cast<std::uint32_t>(meshes_.faces().size());
    const double largest =
        std::max(meshes_.largest_coordinate(), ball.center.cwiseAbs().maxCoeff()) + ball.radius;
    const double slack = 2 * rounding_of_distances(largest);
    Bounds bounds = bounds_of(ball);
    for (int k = 0; k < 3; ++k) {  // corners of parts are rounded
      bounds.low[k] -= slack;
      bounds.high[k] += slack;
    }
    bool refuted = false, open = false;
    std::optional<std::uint32_t> nearest;
    double least = ball.radius + slack;
    const auto look = [&](std::uint32_t t, bool sure) {
      const Corners corners = corners_of(t);
      const double distance =
          (closest_point(ball.center, corners[0], corners[1], corners[2]) - ball.center).norm();
      const bool whole = t < faces;
      if (whole ? !reaches_inside(corners, ball) : distance - slack > ball.radius) return;
      (sure && (whole || distance + slack < ball.radius) ? refuted : open) = true;
      if (nearest && !(distance < least)) return;
      nearest = t;
      least = distance;
    };
    const auto met = [&](const Bounds& box) { return box.meets(bounds); };
    bounding_->surely.query(met, [&](std::uint32_t t) { look(t, true); });
    if (!refuted) bounding_->perhaps.query(met, [&](std::uint32_t t) { look(t, false); });
    if (!refuted && !open) return look_at_center(ball, out);
    out.answer = refuted ? Answer::Refuted : Answer::Undecided;
    name(near);
    out.outside = point_outside(ball, *nearest);
    if (out.outside) out.answer = Answer::Refuted;
  }

  /// A point of the ball beside a triangle that is not in the solid, exactly; nullopt where none
  /// was found.
  [[nodiscard]] std::optional<Vec3> point_outside(const Ball& ball, std::uint32_t t) const {
    const Corners c = corners_of(t);
    const Vec3 near = closest_point(ball.center, c[0], c[1], c[2]),
               middle = (c[0] + c[1] + c[2]) / 3;
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized(),
               ray = (near - ball.center).normalized();
    // From the nearest point, and from points within: in a groove the nearest is on its bottom.
    for (const double inwards : {0.0, 1e-4, 1e-2, 0.1, 0.5, 1.0}) {
      const Vec3 from = near + inwards * (middle - near);
      const double room = ball.radius - (from - ball.center).norm();
      if (!(room > 0)) continue;
      for (const double share : {0.9, 0.5, 0.1, 1e-2, 1e-4, 1e-6})
        for (const Vec3& way : {ray, normal, Vec3(-normal), Vec3(-ray)}) {
          const Vec3 p = from + share * room * way;
          if (!p.allFinite() || !is_within(ball, p)) continue;
          const std::optional<int> winding = winding_at(meshes_, kInside, p);
          if (winding && *winding <= 0) return p;
        }
    }
    return std::nullopt;
  }

  const MeshPair& meshes_;
  const InclusionOptions& options_;
  std::optional<Pieces> bounding_;
  Triangles triangles_{meshes_};
};

/// Halves boxes until each of them is decided.
class DepthSearch {
 public:
  DepthSearch(const MeshPair& meshes, const Pieces& bounding, const std::vector<Ball>& balls,
              double epsilon)
      : meshes_(meshes),
        triangles_(meshes, bounding.parts),
        surely_(triangles_, bounding.surely),
        perhaps_(triangles_, bounding.perhaps),
        chain_(meshes, kInside),
        balls_(balls),
        epsilon_(epsilon),
        slack_(rounding_of_distances(meshes.largest_coordinate())) {
    std::vector<Bounds> boxes;
    std::vector<std::uint32_t> items;
    for (std::uint32_t b = 0; b < balls.size(); ++b) {
      boxes.push_back(bounds_of(balls[b]));
      items.push_back(b);
    }
    tree_ = BoxTree(std::move(boxes), std::move(items));
  }

  [[nodiscard]] Claim decide(std::size_t most) const {
    Claim claim;
    std::vector<Bounds> cells{meshes_.tree(kInside).nodes().front().box}, open;
    std::vector<Look> looks;
    std::size_t seen = 0;
    for (; !cells.empty(); cells.swap(open)) {
      seen += cells.size();
      if (seen > most)
        return undecided("not decided within the work allowed, " +
                         std::to_string(seen - cells.size()) +
                         " boxes looked at; balls that overlap more, or a slightly larger "
                         "distance, may be decided");
      looks.assign(cells.size(), {});
      parallel_for(std::size_t{0}, cells.size(),
                   [&](std::size_t i) { looks[i] = look_at(cells[i]); });
      for (const Look& look : looks) seen += look.balls / kBallsOfABox;
      const auto deepest = std::ranges::max_element(looks, {}, &Look::beyond);
      if (deepest->beyond > 0) {
        claim.answer = Answer::Refuted;
        claim.reason = "a point that is deeper than that inside the original is in no ball";
        claim.witness = Witness{meshes_.point_outside(deepest->point),
                                meshes_.length_outside(deepest->beyond), true};
        const std::uint32_t f = chain_.nearest(deepest->point).face;
        if (f != NearestTriangle::kNone) claim.inner_triangles = {meshes_.face(f).source};
        return claim;
      }
      open.clear();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (looks[i].decided) continue;
        if (diagonal_of(cells[i]) <= slack_)
          return undecided(
              "the balls leave no slack, or the largest depth is the limit but for rounding, as "
              "far as can be told; a slightly larger one may be decided");
        halve(cells[i], open);
      }
    }
    claim.answer = Answer::Verified;
    return claim;
  }

 private:
  struct Look {
    bool decided = false;
    Vec3 point = Vec3::Zero();
    double beyond = 0;  ///< above 0: the point is in the solid and in no ball, and so much too deep
    std::size_t balls = 0;  ///< that were looked at
  };
  static constexpr std::size_t kBallsOfABox = 16;  ///< take about as long as a box

  static Claim undecided(std::string why) {
    Claim claim;
    claim.answer = Answer::Undecided;
    claim.reason = std::move(why);
    return claim;
  }

  [[nodiscard]] Look look_at(const Bounds& cell) const {
    // Off the middle, which meshes with round coordinates like to have their planes through.
    static const Vec3 kPlace(0.4877, 0.5131, 0.5023);
    const Vec3 low(cell.low.data()), high(cell.high.data());
    Look look;
    look.point = low + kPlace.cwiseProduct(high - low);
    look.decided = one_holds(cell, look.balls);
    if (look.decided) return look;
    const double radius = (high - look.point).cwiseMax(look.point - low).norm() + slack_;
    const NearestTriangle::Hit hit = surely_.nearest(look.point);
    look.decided = hit.distance + slack_ + radius <= epsilon_ || all_near(cell, hit.face);
    if (look.decided) return look;
    const std::optional<int> winding = winding_at(meshes_, kInside, look.point);
    if (!winding) return look;
    if (*winding < 1) {
      look.decided = radius <= epsilon_ || chain_.all_beyond(look.point, radius + slack_);
      return look;
    }
    const double beyond =
        perhaps_.lower_bound(look.point, perhaps_.distance(look.point)) - slack_ - epsilon_;
    if (beyond > 0 && !is_held(look.point, look.balls)) look.beyond = beyond;
    return look;
  }

  /// @param looked  raised by the number of balls that were looked at
  [[nodiscard]] bool one_holds(const Bounds& cell, std::size_t& looked) const {
    bool held = false;
    tree_.query([&](const Bounds& box) { return !held && box.meets(cell); },
                [&](std::uint32_t b) {
                  if (held) return;
                  ++looked;
                  Vec3 corner;  // the farthest
                  for (int k = 0; k < 3; ++k) {
                    const double c = balls_[b].center[k];
                    corner[k] = c - cell.low[k] > cell.high[k] - c ? cell.low[k] : cell.high[k];
                  }
                  held = is_within(balls_[b], corner);
                });
    return held;
  }

  [[nodiscard]] bool is_held(const Vec3& p, std::size_t& looked) const {
    Bounds at;
    for (int k = 0; k < 3; ++k) at.low[k] = at.high[k] = p[k];
    return one_holds(at, looked);
  }

  /// Whether the box's corners, and so all of it, are within the limit of one triangle.
  [[nodiscard]] bool all_near(const Bounds& cell, std::uint32_t t) const {
    for (unsigned i = 0; i < 8; ++i) {
      const Vec3 p((i & 1U) != 0 ? cell.high[0] : cell.low[0],
                   (i & 2U) != 0 ? cell.high[1] : cell.low[1],
                   (i & 4U) != 0 ? cell.high[2] : cell.low[2]);
      const Vec3 q = closest_point(p, triangles_.corner(t, 0), triangles_.corner(t, 1),
                                   triangles_.corner(t, 2));
      if (!((q - p).norm() + slack_ <= epsilon_)) return false;
    }
    return true;
  }

  const MeshPair& meshes_;
  Triangles triangles_;
  NearestTriangle surely_, perhaps_, chain_;
  const std::vector<Ball>& balls_;
  BoxTree tree_;  // of the balls
  double epsilon_, slack_;
};

}  // namespace

Inclusion verify_balls_within(const geom::ConvexSet& set, const geom::Mesh& original,
                              const InclusionOptions& options) {
  const MeshPair meshes(original, geom::Mesh{});
  Inclusion out;
  out.outer_open_edges = meshes.unbalanced(kInside);
  out.outer_closed = out.outer_open_edges == 0;
  out.triangles_without_area = meshes.without_area(kInside) + meshes.repeated(kInside).size();
  if (!out.outer_closed) {
    out.surface.reason = "the outer mesh is not closed";
    out.solid.reason = "the meshes are not closed and have different borders";
    return out;
  }
  if (options.progress) options.progress("balls inside the solid");
  const std::vector<Ball> balls = balls_of(set);
  const std::vector<BallAnswer> found = BallsWithin(meshes, options).decide(balls);
  Claim claim;
  claim.answer = Answer::Verified;
  std::size_t refuted = 0, open = 0;
  std::optional<std::size_t> first, first_open;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const BallAnswer& one = found[i];
    if (one.answer == Answer::Verified) continue;
    if (one.answer == Answer::Refuted) {
      ++refuted;
      if (!first || (one.outside && !found[*first].outside)) first = i;
    } else {
      ++open;
      if (!first_open) first_open = i;
    }
    claim.outer_triangles.insert(claim.outer_triangles.end(), one.triangles.begin(),
                                 one.triangles.end());
  }
  std::ranges::sort(claim.outer_triangles);
  claim.outer_triangles.erase(
      std::unique(claim.outer_triangles.begin(), claim.outer_triangles.end()),
      claim.outer_triangles.end());
  const auto count = [&](std::size_t n) {
    return std::to_string(n) + " of " + std::to_string(balls.size()) + " balls";
  };
  if (first) {
    claim.answer = Answer::Refuted;
    claim.reason = count(refuted) + " reach out of the solid; the first of them is ball " +
                   std::to_string(*first);
    const std::optional<Vec3>& at = found[*first].outside;
    if (at) claim.witness = Witness{meshes.point_outside(*at), 0, true};
    if (at && meshes.scaled()) {
      const NearestTriangle nearest(meshes, kInside);
      const double slack =
          rounding_of_distances(std::max(meshes.largest_coordinate(), at->cwiseAbs().maxCoeff()));
      claim.witness->depth = meshes.length_outside(
          std::max(0.0, nearest.lower_bound(*at, nearest.distance(*at)) - slack));
    }
  } else if (open > 0) {
    claim.answer = Answer::Undecided;
    claim.reason = "whether " + count(open) +
                   " lie in the solid depends on rounding where its triangles cut each other, or "
                   "would take too long to tell";
    claim.witness = Witness{balls[*first_open].center, 0, false};
    out.left_out = open;
  }
  out.limited = open > 0;
  out.surface = claim;
  if (options.surface_only)
    out.solid.reason = "only the surface claim was asked for";
  else
    out.solid = std::move(claim);
  return out;
}

Claim verify_ball_depth(const geom::Mesh& original, const geom::ConvexSet& set, double epsilon,
                        const InclusionOptions& options) {
  const MeshPair meshes(original, geom::Mesh{});
  Claim claim;
  if (!meshes.closed(kInside)) {
    claim.reason = "the original is not closed";
    return claim;
  }
  claim.answer = Answer::Undecided;
  std::vector<Ball> balls;
  for (const Ball& ball : balls_of(set)) {
    const std::optional<Ball> one = scaled(meshes, ball);
    if (!meshes.scaled() || !one) {
      claim.reason = "coordinates span too many orders of magnitude to measure distances";
      return claim;
    }
    balls.push_back(*one);
  }
  const std::optional<Pieces> bounding = bounding_pieces(meshes, options);
  if (bounding && bounding->perhaps.empty()) {  // no solid
    claim.answer = Answer::Verified;
    return claim;
  }
  if (!bounding || bounding->surely.empty()) {
    claim.reason = "no triangle of the original is known to bound its solid";
    return claim;
  }
  return DepthSearch(meshes, *bounding, balls, epsilon * meshes.scale()).decide(options.max_cells);
}

}  // namespace kaboum::verify
