// Covers by balls: the largest balls near the solid, few of them by a local search, fewer by moving
// them. docs/algorithms/sphere-covers.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "ball_relaxation.h"
#include "cover_points.h"
#include "float32_below.h"
#include "options.h"
#include "regional_body.h"
#include "set_cover.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;

/// Radii are smaller by this share than ε allows, and hold what they are to by it, so that exact
/// decisions find slack.
constexpr double kBallSlack = 1e-5;
/// Points are held with this share of the radius to spare, so that what is between them is held.
constexpr double kPointSlack = 2e-3;
/// Sizes of caps, as shares of ε: for searches, and for radii that are written.
constexpr double kCoarseCaps = 0.15, kFineCaps = 0.04;
/// Share of the work for fewer balls before all triangles are held, and again after it.
constexpr double kReducing = 0.3;
constexpr int kPatchRounds = 150;                              ///< of points added where no ball is
constexpr std::size_t kAddedAtOnce = 150, kAddedAtLast = 600;  ///< while balls move, and after it
constexpr int kPieceCuts = 24;                                 ///< of a triangle
constexpr std::size_t kMostPoints = 12'000, kMostSeeds = 6'000, kMostCandidates = 12'000;

/// Amounts of work of a search.
struct SearchEffort {
  std::size_t points, candidates, steps;
  int sweeps, attempts;
  double work;  ///< of moving balls [s]
};

SearchEffort effort_of(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {1200, 400, 3'000, 60, 1, 12};
    case Effort::Normal:
      break;
    case Effort::Best:
      return {4000, 2000, 30'000, 300, 6, 400};
  }
  return {2000, 800, 10'000, 120, 3, 50};
}

class BallSearch {
 public:
  BallSearch(const Mesh& mesh, const BallOptions& options)
      : mesh_(mesh),
        options_(options),
        effort_(effort_of(options.effort)),
        query_(mesh),
        winding_(mesh),
        box_(geom::bounding_box(mesh)),
        relaxation_([this](const Vec3& c) { return room_about(c); }, points_, kPointSlack, 1) {
    CoverPoints points =
        sample_cover_points(mesh, winding_, options.epsilon, effort_.points, kMostPoints);
    surface_ = std::move(points.surface);
    points_ = std::move(points.first);
    inner_ = std::move(points.inside);
    points_.insert(points_.end(), options.held.begin(), options.held.end());
    inner_.insert(inner_.end(), options.held.begin(), options.held.end());
  }

  /// repair_balls.
  std::vector<Ball> repair(const std::vector<Ball>& given, const std::vector<bool>& within) {
    begin(*options_.epsilon);
    allow_work(0);  // balls are not moved together
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < given.size(); ++i)
      balls.push_back(i < within.size() && within[i] ? given[i] : fitted(given[i]));
    std::vector<Vec3> free = not_held(balls, points_);
    for (int round = 0; round < kPatchRounds; ++round) {
      show("repairing", static_cast<double>(round) / kPatchRounds);
      grow(balls, free);
      move_single(balls, free);
      add(balls, free, round == 0 ? effort_.steps : 0);
      if (balls.size() > options_.most)
        throw Error(ErrorCode::LimitReached,
                    "more than " + std::to_string(options_.most) +
                        " spheres would be needed; allow a larger epsilon");
      const std::size_t known = points_.size();
      if (add_free_points(balls)) return balls;
      free.assign(points_.begin() + static_cast<std::ptrdiff_t>(known), points_.end());
    }
    throw Error(ErrorCode::LimitReached,
                "no changes of the spheres were found that hold all triangles within epsilon; "
                "allow a larger one");
  }

  CoverCandidate run() {
    CoverCandidate out;
    std::vector<Ball> balls;
    if (options_.max_bodies) {
      balls = within_count(*options_.max_bodies);
      // With epsilon, too: fewer where it allows that.
      if (options_.epsilon && body_->distance() <= *options_.epsilon)
        balls = cover(*options_.epsilon);
    } else {
      balls = cover(*options_.epsilon);
    }
    measure(balls, out);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      geom::ConvexBody body;
      body.name = "sphere_" + std::to_string(i);
      body.core.vertices = {balls[i].center};
      body.radius = balls[i].radius;
      out.bodies.push_back(std::move(body));
    }
    out.statistics.leaves = out.statistics.vertices = balls.size();
    out.statistics.largest = 1;
    if (options_.epsilon && !(out.excess_upper <= *options_.epsilon))
      out.stop = Stop::TooManyBodies;
    return out;
  }

 private:
  void show(const char* stage, double share) const {
    if (options_.progress) options_.progress({stage, share});
  }

  // --- points and candidates ---

  /// Balls that hold a point of the surface and have their centres inwards of it: about the one
  /// whose centre is farthest from it, and between.
  [[nodiscard]] std::vector<Ball> balls_at(const SurfacePoint& p) const {
    constexpr double kHeld = 0.98;
    constexpr int kHalvings = 9, kPlaces = 6;
    std::vector<Ball> out;
    // @return whether it holds the point
    const auto look = [&](double depth) {
      const Vec3 at = geom::to_float32(p.at + depth * p.inwards);
      const Ball ball{at, body_->radius_about(at)};
      if (!(kHeld * ball.radius >= depth)) return false;
      if (ball.radius > 0) out.push_back(ball);
      return true;
    };
    // The radius grows by no more than the way, so those that hold the point come first.
    double low = 0, high = 0.5 * box_.diagonal() + 2 * body_->distance();
    for (int turn = 0; turn < kHalvings; ++turn) {
      const double middle = 0.5 * (low + high);
      (look(middle) ? low : high) = middle;
    }
    for (int k = 0; k < kPlaces; ++k) look(low * k / kPlaces);
    return out;
  }

  /// Some of the balls at each of the points: all of them where the points are few.
  void add_candidates(const std::vector<SurfacePoint>& at) {
    std::vector<std::vector<Ball>> found(at.size());
    const std::size_t most = std::max<std::size_t>(2, kMostCandidates / (at.size() + 1));
    kaboum::parallel_for(std::size_t{0}, at.size(), [&](std::size_t i) {
      found[i] = balls_at(at[i]);
      thin_out(at[i].at, most, found[i]);
    });
    for (const std::vector<Ball>& some : found)
      candidates_.insert(candidates_.end(), some.begin(), some.end());
  }

  /// Leaves `most` balls: the largest one, and of the others some from the one about the place that
  /// is farthest from p on, evenly.
  static void thin_out(const Vec3& p, std::size_t most, std::vector<Ball>& balls) {
    if (balls.size() <= most) return;
    std::iter_swap(balls.begin(), std::ranges::max_element(balls, {}, &Ball::radius));
    std::sort(balls.begin() + 1, balls.end(), [&](const Ball& a, const Ball& b) {
      return (a.center - p).squaredNorm() > (b.center - p).squaredNorm();
    });
    const std::size_t others = balls.size() - 1;
    for (std::size_t k = 1; k < most; ++k) balls[k] = balls[1 + (k - 1) * others / (most - 1)];
    balls.resize(most);
  }

  void set_distance(double epsilon) {
    body_ = std::make_unique<RegionalBody>(query_, winding_, epsilon * (1 - kBallSlack),
                                           kCoarseCaps, options_.regions, epsilon);
    written_.clear();
  }

  void allow_work(double work) {
    end_of_work_ = relaxation_.work() + work;
    relaxation_.limit_work(end_of_work_);
  }

  /// All candidates for ε.
  void begin(double epsilon) {
    set_distance(epsilon);
    candidates_.clear();
    // Some for each piece of the surface that a ball can hold.
    std::size_t count = effort_.candidates;
    if (options_.epsilon) count = std::max(count, surface_.size() / 4);
    count = std::min(count, kMostSeeds);
    std::vector<SurfacePoint> some;
    const std::size_t stride = std::max<std::size_t>(1, surface_.size() / count);
    for (std::size_t i = 0; i < surface_.size(); i += stride) some.push_back(surface_[i]);
    add_candidates(some);
    const Vec3 middle = geom::to_float32(box_.center());
    if (const double radius = body_->radius_about(middle); radius > 0)
      candidates_.push_back({middle, radius});
  }

  // --- choices ---

  /// Candidates that hold all points; empty where there are none.
  [[nodiscard]] std::vector<Ball> choose(const std::vector<Vec3>& points, std::size_t steps) const {
    std::vector<std::vector<std::uint32_t>> sets(candidates_.size());
    kaboum::parallel_for(std::size_t{0}, candidates_.size(), [&](std::size_t c) {
      const double radius = candidates_[c].radius * (1 - kPointSlack);
      const double square = radius * radius;
      for (std::uint32_t p = 0; p < points.size(); ++p)
        if ((points[p] - candidates_[c].center).squaredNorm() <= square) sets[c].push_back(p);
    });
    std::vector<Ball> out;
    for (const std::uint32_t c : SetCover(points.size(), std::move(sets)).search(steps, 1))
      out.push_back(candidates_[c]);
    return out;
  }

  /// Balls that hold all points known; candidates are added for those that none holds.
  [[nodiscard]] std::vector<Ball> first_choice() {
    for (const Vec3& p : points_)
      if (std::ranges::none_of(candidates_, [&](const Ball& b) {
            return (p - b.center).norm() <= b.radius * (1 - kPointSlack);
          }))
        add_ball_at(p);
    return choose(points_, effort_.steps);
  }

  void add_ball_at(const Vec3& p) {
    const Vec3 at = geom::to_float32(p);
    if (const double radius = body_->radius_about(at); radius > 0)
      candidates_.push_back({at, radius});
  }

  /// Balls that hold each of the points: about it, and inwards of its triangle.
  void add_candidates_for(const std::vector<Vec3>& points) {
    std::vector<SurfacePoint> at;
    for (const Vec3& p : points) {
      add_ball_at(p);
      const auto& [a, b, c] = query_.corners(query_.nearest(p).triangle);
      const Vec3 inwards = -(b - a).cross(c - a).normalized();
      if (inwards.allFinite()) at.push_back({p, inwards});
    }
    add_candidates(at);
  }

  [[nodiscard]] bool may_move() const { return relaxation_.work() < end_of_work_; }

  /// Fewer balls, while that succeeds.
  void reduce(std::vector<Ball>& balls, std::size_t enough) {
    enough = std::max<std::size_t>(enough, 1);
    std::size_t fewer = std::max<std::size_t>(1, balls.size() / 12);
    int failed = 0;
    while (balls.size() > enough && may_move()) {
      fewer = std::min(fewer, balls.size() - enough);
      show("moving balls", 1 - (end_of_work_ - relaxation_.work()) / (kReducing * effort_.work));
      if (relaxation_.hold_with_fewer(balls, fewer, effort_.sweeps)) {
        failed = 0;
        continue;
      }
      if (fewer == 1 && ++failed >= effort_.attempts) break;
      fewer = (fewer + 1) / 2;
    }
  }

  /// As they are written: float32 numbers, and the largest radii that are known.
  [[nodiscard]] std::vector<Ball> written(const std::vector<Ball>& balls) {
    std::vector<Ball> out(balls.size());
    kaboum::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
      const Vec3 at = geom::to_float32(balls[i].center);
      if (i < written_.size() && written_[i].center == at) {
        out[i] = written_[i];
        return;
      }
      out[i] = {at, most_about(at)};
    });
    written_ = out;
    return out;
  }

  /// Points of triangles, or of the inside, in no ball, some of them; adds them. @return whether
  /// there are none
  bool add_free_points(const std::vector<Ball>& balls) {
    std::vector<std::vector<Vec3>> found(mesh_.triangles.size());
    const std::size_t wanted = may_move() ? kAddedAtOnce : kAddedAtLast;
    // Large triangles have many.
    const std::size_t most =
        may_move() ? 8 : std::max<std::size_t>(8, 4 * wanted / mesh_.triangles.size());
    kaboum::parallel_for(std::size_t{0}, mesh_.triangles.size(), [&](std::size_t t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      find_free({mesh_.vertices[i], mesh_.vertices[j], mesh_.vertices[k]}, balls, most, found[t]);
    });
    std::vector<Vec3> all;
    for (const std::vector<Vec3>& some : found) all.insert(all.end(), some.begin(), some.end());
    if (all.empty()) all = free_inner_points(balls);
    const std::size_t stride = all.size() / wanted + 1;
    for (std::size_t i = 0; i < all.size(); i += stride) points_.push_back(all[i]);
    return all.empty();
  }

  [[nodiscard]] std::vector<Vec3> free_inner_points(const std::vector<Ball>& balls) const {
    std::vector<char> is_free(inner_.size());
    kaboum::parallel_for(std::size_t{0}, inner_.size(), [&](std::size_t i) {
      is_free[i] = std::ranges::none_of(balls, [&](const Ball& b) {
        return (inner_[i] - b.center).norm() <= b.radius * (1 - kBallSlack);
      });
    });
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < inner_.size(); ++i)
      if (is_free[i] != 0) out.push_back(inner_[i]);
    return out;
  }

  struct Piece {
    std::array<Vec3, 3> corner;
    int cuts;
    std::vector<Ball> near;  ///< balls that may hold something of it
  };

  /// The balls, less the slack, that meet the ball round a piece.
  static std::vector<Ball> near_piece(const std::array<Vec3, 3>& corner,
                                      const std::vector<Ball>& balls) {
    const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3;
    double reach = 0;
    for (const Vec3& p : corner) reach = std::max(reach, (p - middle).norm());
    std::vector<Ball> out;
    for (const Ball& b : balls)
      if ((b.center - middle).norm() <= b.radius + reach) out.push_back(b);
    return out;
  }

  static void find_free(const std::array<Vec3, 3>& triangle, const std::vector<Ball>& balls,
                        std::size_t most, std::vector<Vec3>& out) {
    constexpr std::size_t kFew = 8;
    std::vector<Ball> smaller = near_piece(triangle, balls);
    for (Ball& b : smaller) b.radius *= 1 - kBallSlack;
    const auto holds = [](const Ball& b, const Vec3& p) {
      return (p - b.center).squaredNorm() <= b.radius * b.radius;
    };
    std::vector<Piece> open{{triangle, 0, std::move(smaller)}};
    while (!open.empty() && out.size() < most) {
      const Piece piece = std::move(open.back());
      open.pop_back();
      bool held = false;
      std::array<bool, 3> some{};
      for (const Ball& b : piece.near) {
        bool all = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const bool one = holds(b, piece.corner[k]);
          some[k] = some[k] || one;
          all = all && one;
        }
        held = held || all;
        if (held) break;
      }
      if (held) continue;
      bool free = false;
      for (std::size_t k = 0; k < 3; ++k) {
        if (some[k]) continue;
        out.push_back(piece.corner[k]);
        free = true;
      }
      if (piece.cuts >= kPieceCuts) {
        out.push_back((piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3);
        continue;
      }
      if (free && piece.cuts > 6) continue;
      std::size_t longest = 0;
      for (std::size_t k = 1; k < 3; ++k)
        if ((piece.corner[(k + 1) % 3] - piece.corner[k]).squaredNorm() >
            (piece.corner[(longest + 1) % 3] - piece.corner[longest]).squaredNorm())
          longest = k;
      const std::size_t next = (longest + 1) % 3;
      const Vec3 half = 0.5 * (piece.corner[longest] + piece.corner[next]);
      for (const std::size_t k : {longest, next}) {
        std::array<Vec3, 3> corner = piece.corner;
        corner[k] = half;
        std::vector<Ball> near =
            piece.near.size() > kFew ? near_piece(corner, piece.near) : piece.near;
        open.push_back({corner, piece.cuts + 1, std::move(near)});
      }
    }
  }

  /// Balls, as they are written, that hold all triangles: where these do not they move, and where
  /// that does not suffice there are more of them.
  /// @return empty if there would have to be more than `most`
  [[nodiscard]] std::vector<Ball> completed(std::vector<Ball> balls, std::size_t most) {
    for (int round = 0; round < kPatchRounds; ++round) {
      show("filling gaps", static_cast<double>(round) / kPatchRounds);
      if (3 * round >= kPatchRounds) allow_work(0);  // moving fills one gap and opens another
      std::vector<Ball> out = written(balls);
      const std::size_t known = points_.size();
      if (add_free_points(out)) return out;
      if (may_move() && relaxation_.hold(balls, effort_.sweeps)) continue;
      const std::vector<Vec3> free(points_.begin() + static_cast<std::ptrdiff_t>(known),
                                   points_.end());
      add_candidates_for(free);
      std::vector<Ball> more = choose(free, 0);
      // A part of them may do, once all have moved.
      if (may_move()) more.resize((more.size() + 2) / 3);
      balls.insert(balls.end(), more.begin(), more.end());
      if (balls.size() > most) return {};
      if (may_move()) relaxation_.hold(balls, effort_.sweeps);
    }
    return {};
  }

  /// A cover of all triangles within ε; empty where none was found with `most` balls or fewer.
  std::vector<Ball> cover(double epsilon, std::size_t most = kAny) {
    const bool any = most == kAny, is_started = any && !options_.start.empty();
    show(any ? "choosing balls" : "trying a distance", 0);
    begin(epsilon);
    std::vector<Ball> balls = is_started ? resized(options_.start) : first_choice();
    if (balls.empty())
      throw Error(ErrorCode::LimitReached,
                  "epsilon is too small for spheres here; allow a larger one");
    if (!is_started) {
      allow_work(kReducing * effort_.work);
      reduce(balls, any ? 1 : most);
    }
    allow_work(effort_.work);
    const std::size_t limit = any ? options_.most : most;
    std::vector<Ball> best;
    if (balls.size() <= limit) best = completed(std::move(balls), limit);
    if (best.empty() && any)
      throw Error(ErrorCode::LimitReached, "no " + std::to_string(limit) +
                                               " spheres or fewer were found that hold all "
                                               "triangles within epsilon; allow a larger one");
    if (best.empty()) return {};
    allow_work(kReducing * effort_.work);
    if (any && !is_started) reduce_complete(best);
    if (any && options_.nearest) bring_nearer(best);
    return best;
  }

  /// A cover by as many balls within less than ε, where one is found.
  void bring_nearer(std::vector<Ball>& best) {
    constexpr int kTurns = 3;
    constexpr double kWorth = 0.004;  // of epsilon
    double high = body_->distance() / (1 - kBallSlack), low = 0;
    for (int turn = 0; turn < kTurns && low < (1 - kWorth) * high; ++turn) {
      show("bringing balls nearer", static_cast<double>(turn) / kTurns);
      // An attempt to hold the known points by balls whose radii are reduced.
      std::vector<Ball> balls = best;
      allow_work(kReducing * effort_.work);
      const double tried = std::max(high - shrunk(balls, high - low), 0.5 * (low + high));
      if (!(tried < (1 - 0.5 * kWorth) * high)) break;
      set_distance(tried);
      balls = resized(balls);
      if (balls.size() == best.size() && relaxation_.hold(balls, effort_.sweeps))
        balls = completed(std::move(balls), best.size());
      else
        balls.clear();
      (balls.empty() ? low : high) = tried;
      if (!balls.empty())
        best = std::move(balls);
      else
        set_distance(high);
    }
    set_distance(high);
  }

  /// Moves balls so that they hold all points known with less than the radii that they may have.
  /// @return by how much, less than `most` [length]
  [[nodiscard]] double shrunk(std::vector<Ball>& balls, double most) {
    constexpr int kTurns = 6;
    double least = 0, less = 0.3 * most;
    most *= 0.6;
    for (int turn = 0; turn < kTurns && may_move(); ++turn) {
      less_ = less;
      std::vector<Ball> moved = resized(balls);
      const bool is_held = moved.size() == balls.size() && relaxation_.hold(moved, effort_.sweeps);
      (is_held ? least : most) = less;
      if (is_held) balls = std::move(moved);
      less = 0.5 * (least + most);
    }
    less_ = 0;
    return least;
  }

  /// Balls with the radii that ε allows.
  [[nodiscard]] std::vector<Ball> resized(const std::vector<Ball>& balls) const {
    std::vector<Ball> out;
    for (const Ball& b : balls)
      if (const double radius = body_->radius_about(b.center) - less_; radius > 0)
        out.push_back({b.center, radius});
    return out;
  }

  /// The largest radius about a point, less what is to be left of it.
  [[nodiscard]] ParallelBody::Room room_about(const Vec3& c) const {
    ParallelBody::Room out = body_->room_about(geom::to_float32(c));
    if (less_ > 0) {
      const double rest = std::max(0.0, out.radius - less_);
      if (out.limit && out.radius > 0) out.limit = c + rest / out.radius * (*out.limit - c);
      out.radius = rest;
    }
    return out;
  }

  /// Fewer balls that hold all triangles. Points where gaps were are known by now.
  void reduce_complete(std::vector<Ball>& best) {
    for (int failed = 0; failed < effort_.attempts && best.size() > 1 && may_move();) {
      std::vector<Ball> fewer = best;
      if (relaxation_.hold_with_fewer(fewer, 1, effort_.sweeps))
        fewer = completed(std::move(fewer), best.size() - 1);
      else
        fewer.clear();
      if (fewer.empty())
        ++failed;
      else
        best = std::move(fewer);
    }
  }

  // --- balls that somebody has ---

  [[nodiscard]] static bool is_held(const Ball& b, const Vec3& p, double slack) {
    return (p - b.center).norm() <= b.radius * (1 - slack);
  }

  [[nodiscard]] static std::vector<Vec3> not_held(const std::vector<Ball>& balls,
                                                  const std::vector<Vec3>& points) {
    std::vector<char> free(points.size());
    kaboum::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
      free[i] = std::ranges::none_of(
          balls, [&](const Ball& b) { return is_held(b, points[i], kBallSlack); });
    });
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (free[i] != 0) out.push_back(points[i]);
    return out;
  }

  /// The largest radius that is known to be allowed about a point.
  [[nodiscard]] double most_about(const Vec3& c) const {
    return float32_below(body_->refined_radius_about(c, kFineCaps));
  }

  /// The ball, no larger than is allowed; put to the surface where its centre is too far.
  [[nodiscard]] Ball fitted(const Ball& b) const {
    constexpr double kLeast = 0.1;  // of epsilon: smaller ones are put elsewhere
    const double most = most_about(b.center);
    if (b.radius <= most) return b;
    if (most > kLeast * body_->distance()) return {b.center, most};
    const auto& [p, q, r] = query_.corners(query_.nearest(b.center).triangle);
    const Vec3 at = geom::to_float32(geom::closest_point(b.center, p, q, r));
    return {at, std::min(float32_below(b.radius), most_about(at))};
  }

  /// A radius that holds a point at this distance with something to spare.
  [[nodiscard]] double radius_for(double distance, double most) const {
    const double wanted = distance * (1 + kPointSlack) + 0.02 * body_->distance();
    return std::min(most, float32_below(wanted));
  }

  /// Makes few balls larger that then hold many of the points; leaves the rest.
  void grow(std::vector<Ball>& balls, std::vector<Vec3>& free) const {
    std::vector<double> most(balls.size());
    kaboum::parallel_for(std::size_t{0}, balls.size(),
                         [&](std::size_t i) { most[i] = most_about(balls[i].center); });
    while (!free.empty()) {
      std::size_t best = 0, count = 0;
      double farthest = 0;
      for (std::size_t i = 0; i < balls.size(); ++i) {
        if (!(most[i] > balls[i].radius)) continue;
        std::size_t own = 0;
        double reach = 0;
        for (const Vec3& p : free) {
          const double away = (p - balls[i].center).norm();
          if (away > most[i] * (1 - kPointSlack)) continue;
          ++own;
          reach = std::max(reach, away);
        }
        if (own <= count) continue;
        count = own;
        best = i;
        farthest = reach;
      }
      if (count == 0) return;
      balls[best].radius = std::max(balls[best].radius, radius_for(farthest, most[best]));
      const std::size_t before = free.size();
      std::erase_if(free, [&](const Vec3& p) { return is_held(balls[best], p, kPointSlack); });
      if (free.size() == before) most[best] = 0;  // by rounding
    }
  }

  /// Moves single balls to points that none holds, where these hold from there what they alone
  /// hold; leaves the rest.
  void move_single(std::vector<Ball>& balls, std::vector<Vec3>& free) const {
    constexpr std::size_t kNearest = 4;
    constexpr std::array<double, 6> kWays{1.02, 1.2, 1.5, 2, 3, 5};
    for (std::size_t k = 0; k < free.size();) {
      const Vec3 p = free[k];
      std::vector<std::pair<double, std::size_t>> near;
      for (std::size_t i = 0; i < balls.size(); ++i)
        near.emplace_back((p - balls[i].center).norm() - balls[i].radius, i);
      std::ranges::sort(near);
      near.resize(std::min(near.size(), kNearest));
      bool is_moved = false;
      for (const auto& [gap, i] : near) {
        const Vec3 along = (p - balls[i].center).normalized();
        if (!along.allFinite()) continue;
        const std::vector<Vec3> own = held_alone(balls, i);
        for (const double way : kWays) {
          const Vec3 at = geom::to_float32(balls[i].center + way * gap * along);
          double reach = (p - at).norm();
          for (const Vec3& q : own) reach = std::max(reach, (q - at).norm());
          const double most = most_about(at);
          if (reach > most * (1 - kPointSlack)) continue;
          balls[i] = {at, std::max(std::min(float32_below(balls[i].radius), most),
                                   radius_for(reach, most))};
          is_moved = true;
          break;
        }
        if (is_moved) break;
      }
      if (is_moved)
        std::erase_if(free, [&](const Vec3& q) {
          return std::ranges::any_of(balls,
                                     [&](const Ball& b) { return is_held(b, q, kPointSlack); });
        });
      else
        ++k;
    }
  }

  /// Points known that one ball alone holds.
  [[nodiscard]] std::vector<Vec3> held_alone(const std::vector<Ball>& balls, std::size_t i) const {
    std::vector<std::size_t> near;
    for (std::size_t k = 0; k < balls.size(); ++k)
      if (k != i && (balls[k].center - balls[i].center).norm() < balls[k].radius + balls[i].radius)
        near.push_back(k);
    std::vector<Vec3> out;
    for (const Vec3& p : points_)
      if (is_held(balls[i], p, kBallSlack) && std::ranges::none_of(near, [&](std::size_t k) {
            return is_held(balls[k], p, kBallSlack);
          }))
        out.push_back(p);
    return out;
  }

  /// Other balls that hold the points.
  void add(std::vector<Ball>& balls, const std::vector<Vec3>& free, std::size_t steps) {
    if (free.empty()) return;
    add_candidates_for(free);
    std::erase_if(candidates_, [&](const Ball& b) {
      return std::ranges::none_of(free, [&](const Vec3& p) { return is_held(b, p, kPointSlack); });
    });
    for (const Ball& b : choose(free, steps))
      balls.push_back({geom::to_float32(b.center), most_about(geom::to_float32(b.center))});
  }

  /// The least ε found with so many balls.
  std::vector<Ball> within_count(std::size_t count) {
    constexpr double kNear = 1.05;
    constexpr int kTurns = 12;
    double high = 0.6 * box_.diagonal(), low = 0, tried = high;
    std::vector<Ball> best;
    for (int turn = 0; turn < kTurns; ++turn) {
      std::vector<Ball> balls = cover(tried, count);
      if (!balls.empty()) {
        best = std::move(balls);
        high = tried;
      } else {
        low = tried;
      }
      if (best.empty())
        tried *= 2;
      else
        tried = low > 0 ? std::sqrt(low * high) : 0.5 * high;
      if (low > 0 && high < kNear * low) break;
    }
    set_distance(high);
    if (!best.empty()) bring_nearer(best);
    return best;
  }

  /// Certified bracket of the farthest point of the balls from the solid.
  void measure(const std::vector<Ball>& balls, CoverCandidate& out) const {
    for (const Ball& b : balls) {
      const ParallelBody::SignedDistance s = body_->signed_distance(b.center);
      out.excess_upper =
          std::max(out.excess_upper,
                   std::min(b.radius + s.upper, body_->distance()) * (1 + 0.5 * kBallSlack));
      if (const std::optional<Vec3> at = body_->boundary_near(b.center)) {
        const Vec3 along = (*at - b.center).normalized();
        if (!along.allFinite()) continue;
        const Vec3 far = b.center + b.radius * (1 - 1e-12) * along;
        out.excess_lower = std::max(out.excess_lower, body_->signed_distance(far).lower);
      }
    }
    out.excess_lower = std::min(out.excess_lower, out.excess_upper);
  }

  static constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();

  const Mesh& mesh_;
  const BallOptions& options_;
  SearchEffort effort_;
  geom::DistanceQuery query_;
  geom::WindingNumber winding_;
  geom::Box3 box_;
  std::unique_ptr<RegionalBody> body_;  ///< what balls may not leave
  std::vector<SurfacePoint> surface_;
  std::vector<Vec3> points_;  ///< to be held
  std::vector<Vec3> inner_;   ///< of the inside, that are looked at when triangles are held
  std::vector<Ball> candidates_;
  std::vector<Ball> written_;  ///< the last ones
  double less_ = 0;            ///< than what is allowed, of radii while balls move [length]
  BallRelaxation relaxation_;
  double end_of_work_ = 0;  ///< of the relaxation, for this distance [s]
};

}  // namespace

std::vector<Ball> repair_balls(const geom::SolidMesh& input, const std::vector<Ball>& given,
                               const std::vector<bool>& within, const BallOptions& options) {
  if (!options.epsilon || !(*options.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument, "balls are repaired within an epsilon above 0");
  const geom::SolidMesh closed = geom::close_holes(input);
  BallOptions asked = options;
  asked.max_bodies.reset();
  asked.epsilon = std::min(*asked.epsilon, 0.6 * geom::bounding_box(closed.mesh()).diagonal());
  return BallSearch(closed.mesh(), asked).repair(given, within);
}

CoverCandidate find_balls(const geom::SolidMesh& input, const BallOptions& options) {
  if (!options.epsilon && !options.max_bodies)
    throw Error(ErrorCode::InvalidArgument, "balls: epsilon or a number of them is needed");
  if (!options.start.empty() && (options.max_bodies || !options.epsilon))
    throw Error(ErrorCode::InvalidArgument, "balls to begin with need epsilon, and no number");
  if (options.epsilon && !(*options.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument, "epsilon must be positive");
  if (options.max_bodies && *options.max_bodies == 0)
    throw Error(ErrorCode::InvalidArgument, "there must be a body at least");
  if (options.max_bodies && !options.regions.empty())
    throw Error(ErrorCode::InvalidArgument, "regions do not go with a limit on the bodies");
  const geom::SolidMesh closed = geom::close_holes(input);
  const geom::Box3 box = geom::bounding_box(closed.mesh());
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (options.epsilon && geom::float32_spacing(largest) > 0.01 * *finest_epsilon(options)) {
    CoverCandidate coarse;
    coarse.stop = Stop::TooCoarse;
    return coarse;
  }
  // Half the diagonal is enough for one ball round everything.
  BallOptions asked = options;
  if (asked.epsilon) asked.epsilon = std::min(*asked.epsilon, 0.6 * box.diagonal());
  CoverCandidate out = BallSearch(closed.mesh(), asked).run();
  out.statistics.filled_triangles = closed.filled_triangles();
  return out;
}

}  // namespace kaboum::bcd
