// Balls inside a solid: cubes of an octree are each to lie in one ball; for those that lie in none
// yet a large ball is grown, and few of the balls are chosen in the end.
// docs/algorithms/sphere-covers.md, "Inside a solid".
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/bcd/inner.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cell.h"
#include "depth_bounds.h"
#include "float32_below.h"
#include "options.h"
#include "set_cover.h"

namespace kaboum::bcd {
namespace {

/// Triangles that others cross are cut to this share of epsilon where samples of what they bound
/// differ, and else to the larger one, or to that share of the diagonal.
constexpr double kPieceSize = 0.08, kCoarsePiece = 0.5, kCoarseOfDiagonal = 5e-3;
/// No point deeper than epsilon less this share of it is left out, so that exact decisions find
/// slack.
constexpr double kDepthSlack = 0.01;
/// Cubes are held with this share of epsilon to spare, by the cube root of `safety` more, and no
/// more than kMostSlack.
constexpr double kHeldSlack = 0.02, kMostSlack = 0.25;
/// Cubes are not cut to less than this share of epsilon: in one that is deep for certain, a ball of
/// more than kSmallestBall times epsilon holds it then. Where there is none, triangles seem to
/// bound the solid that do not.
constexpr double kSmallestCube = 1.0 / 24, kSmallestBall = 0.5;
constexpr std::size_t kMostCubes = 4'000'000;
/// Balls grown at once, whatever the number of threads.
constexpr std::size_t kGrownAtOnce = 16;
/// Words of the table by which few balls are chosen.
constexpr std::size_t kMostWords = 40'000'000;
/// With a number of balls, epsilon is found to this factor.
constexpr double kFinest = 1.05;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct InnerBallEffort {
  double smallest;    ///< cubes that are not deep all over are this share of epsilon when balls are
                      ///< grown for them
  int looks;          ///< at places for a ball
  std::size_t steps;  ///< of the choice
};

InnerBallEffort effort_of(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {1.0 / 6, 80, 500};
    case Effort::Normal:
      break;
    case Effort::Best:
      return {1.0 / 12, 400, 20'000};
  }
  return {1.0 / 8, 160, 4'000};
}

/// Least radius of a ball about p that holds the cube, rounded up.
double reach_of(const Cube& cube, const Vec3& p) {
  return ((p - cube.center).cwiseAbs() + Vec3::Constant(cube.half)).norm() * kLengthUp;
}

bool holds(const Ball& ball, const Cube& cube, double slack) {
  return reach_of(cube, ball.center) + slack <= ball.radius;
}

bool may_meet(const Ball& ball, const Cube& cube) {
  const Vec3 past =
      ((ball.center - cube.center).cwiseAbs() - Vec3::Constant(cube.half)).cwiseMax(0.0);
  return past.squaredNorm() <= ball.radius * ball.radius * kLengthUp;
}

/// Balls by place and size, to find those that may hold a point.
class BallGrid {
 public:
  /// Adds a ball under its number.
  void add(const Ball& ball, std::uint32_t number) {
    int size = 0;
    std::frexp(ball.radius, &size);  // the radius is less than 2^size
    sizes_.insert(size);
    const Place low = place_of(size, ball.center - Vec3::Constant(ball.radius)),
                high = place_of(size, ball.center + Vec3::Constant(ball.radius));
    for (std::int64_t x = low[1]; x <= high[1]; ++x)
      for (std::int64_t y = low[2]; y <= high[2]; ++y)
        for (std::int64_t z = low[3]; z <= high[3]; ++z) balls_[{size, x, y, z}].push_back(number);
  }

  /// True if the test is true of one of the balls that hold the point, or of one near it.
  template <class Test>
  [[nodiscard]] bool any(const Vec3& p, const Test& test) const {
    return std::ranges::any_of(sizes_, [&](int size) {
      const auto found = balls_.find(place_of(size, p));
      return found != balls_.end() && std::ranges::any_of(found->second, test);
    });
  }

 private:
  using Place = std::array<std::int64_t, 4>;  // the size, and a cell of a grid twice as wide
  struct Hash {
    std::size_t operator()(const Place& place) const {
      std::uint64_t out = 0;
      for (const std::int64_t x : place)
        out = (out ^ static_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15U + (out >> 29U);
      return out;
    }
  };
  static Place place_of(int size, const Vec3& p) {
    Place out{size, 0, 0, 0};
    for (int k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(k) + 1] =
          static_cast<std::int64_t>(std::floor(std::ldexp(p[k], -size - 1)));
    return out;
  }

  std::set<int> sizes_;
  std::unordered_map<Place, std::vector<std::uint32_t>, Hash> balls_;
};

class InnerBallSearch {
 public:
  InnerBallSearch(const Mesh& mesh, const InnerBallOptions& options, double epsilon)
      : options_(options),
        effort_(effort_of(options.effort)),
        whole_epsilon_(epsilon),
        epsilon_(epsilon * (1 - kDepthSlack)),
        held_slack_(epsilon * std::min(kMostSlack, kHeldSlack * std::cbrt(options.safety))),
        winding_(mesh),
        boundary_(boundary_of(mesh, winding_, kPieceSize * epsilon_, options.doubtful,
                              std::max(kCoarsePiece * epsilon_,
                                       kCoarseOfDiagonal * geom::bounding_box(mesh).diagonal()))) {
    if (boundary_.outside.empty()) throw Error(ErrorCode::InvalidInput, "the mesh has no solid");
    bounds_.emplace(mesh, winding_, boundary_);
    for (const Cube& cube : cubes_over(geom::bounding_box(mesh))) add_node(cube);
    roots_ = static_cast<std::uint32_t>(nodes_.size());
  }

  InnerCandidate run() {
    std::vector<Open> level;
    for (std::uint32_t n = 0; n < roots_; ++n) level.push_back({n});
    for (int depth = 0; !level.empty(); ++depth) {
      if (options_.progress)
        options_.progress({"growing spheres", std::min(0.9, 0.1 * static_cast<double>(depth))});
      level = next_level(std::move(level));
    }
    return result(choose());
  }

 private:
  struct Node {
    Cube cube;
    std::uint32_t children = kNone;  ///< the first of eight
    bool held = false;
  };
  /// A cube that is not decided yet.
  struct Open {
    std::uint32_t node;
    std::uint32_t hint = kNone;  ///< a triangle that may be near
    double depth = 0;            ///< no triangle is nearer to the middle; 0: outside
    double upper = 0;            ///< nothing is deeper, where it was looked for
    bool decided = false, held = false;
  };
  /// The middle of a cube that is not deep anywhere.
  struct Shallow {
    Vec3 at;
    double depth;
  };
  /// A place for a ball: how large it may be there, and what it then holds to spare.
  struct Place {
    Ball ball{Vec3::Zero(), 0};
    double spare = -std::numeric_limits<double>::infinity();
    Vec3 away = Vec3::Zero();  ///< from the nearest triangle
    std::uint32_t triangle = kNone;
  };

  void add_node(const Cube& cube) { nodes_.push_back({cube, kNone, false}); }

  [[nodiscard]] bool is_held(const Cube& cube) const {
    return grid_.any(cube.center,
                     [&](std::uint32_t b) { return holds(balls_[b], cube, held_slack_); });
  }

  /// Decides an open cube of which nothing is deep, or that one of the balls holds.
  void look(Open& open) const {
    const Cube& cube = nodes_[open.node].cube;
    open.held = open.decided = is_held(cube);
    if (open.held) return;
    const double radius = cube.half * kHalfDiagonal + bounds_->slack();
    const geom::TriangleSearch::Nearest at = bounds_->nearest(cube.center, open.hint);
    open.hint = at.triangle;
    if (!bounds_->inside(cube.center)) {
      open.decided = at.lower > radius || radius <= epsilon_;
      return;
    }
    open.depth = at.lower;
    if (at.upper + radius > epsilon_ && cube.half > kSmallestCube * epsilon_) return;
    open.upper = bounds_->upper(cube.center, at.triangle) + radius;
    open.decided = open.upper <= epsilon_;
  }

  /// The cubes that are left, in eight each.
  std::vector<Open> next_level(std::vector<Open> level) {
    kaboum::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) { look(level[i]); });
    grow_for(level);
    std::vector<Open> next;
    for (Open& open : level) {
      if (!open.decided && nodes_[open.node].cube.half <= kSmallestCube * epsilon_)
        deepest_left_ = std::max(deepest_left_, open.upper);
      else if (!open.decided)
        split(open, next);
      else if (open.held)
        nodes_[open.node].held = true;
      else if (open.depth > 0)
        shallow_.push_back({nodes_[open.node].cube.center, open.depth});
    }
    return next;
  }

  void split(const Open& open, std::vector<Open>& next) {
    const Cube cube = nodes_[open.node].cube;
    if (nodes_.size() + 8 > kMostCubes)
      throw Error(ErrorCode::LimitReached,
                  "spheres that leave out nothing deeper than epsilon would take too many cubes of "
                  "the solid to be found; allow a larger epsilon");
    nodes_[open.node].children = static_cast<std::uint32_t>(nodes_.size());
    const double h = 0.5 * cube.half;
    for (int i = 0; i < 8; ++i) {
      const Cube part{
          cube.center + Vec3((i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h, (i & 4) != 0 ? h : -h),
          h};
      next.push_back({static_cast<std::uint32_t>(nodes_.size()), open.hint});
      add_node(part);
    }
  }

  /// Whether a ball may hold the cube, and is worth while: a shallow one is cut first.
  [[nodiscard]] bool may_be_held(const Open& open) const {
    const double half = nodes_[open.node].cube.half;
    if (open.decided || !(open.depth > std::max(half, kSmallestBall * epsilon_))) return false;
    return open.depth - kHalfDiagonal * half >= epsilon_ || half <= effort_.smallest * epsilon_;
  }

  /// Grows balls for cubes that none holds, deepest first.
  void grow_for(std::vector<Open>& level) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < level.size(); ++i)
      if (may_be_held(level[i])) order.push_back(i);
    std::ranges::stable_sort(
        order, [&](std::uint32_t a, std::uint32_t b) { return level[a].depth > level[b].depth; });
    for (std::size_t begin = 0; begin < order.size();) {
      std::vector<std::uint32_t> batch;
      for (; begin < order.size() && batch.size() < kGrownAtOnce; ++begin) {
        Open& open = level[order[begin]];
        open.decided = open.held = is_held(nodes_[open.node].cube);
        if (!open.held) batch.push_back(order[begin]);
      }
      std::vector<std::vector<Ball>> grown(batch.size());
      kaboum::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
        grown[i] = grow(nodes_[level[batch[i]].node].cube, level[batch[i]].hint);
      });
      for (std::size_t i = 0; i < batch.size(); ++i) {
        if (grown[i].empty()) continue;
        Open& open = level[batch[i]];
        if (!is_held(nodes_[open.node].cube)) add_balls(grown[i]);
        open.decided = open.held = true;
      }
      if (balls_.size() > 4 * kMostBalls)
        throw Error(ErrorCode::LimitReached,
                    "too many spheres would be needed inside the solid; allow a larger epsilon");
    }
  }

  void add_balls(const std::vector<Ball>& balls) {
    for (const Ball& ball : balls) {
      grid_.add(ball, static_cast<std::uint32_t>(balls_.size()));
      balls_.push_back(ball);
    }
  }

  // --- growing ---

  [[nodiscard]] Place place_at(const Cube& cube, const Vec3& p, std::uint32_t hint) const {
    Place out;
    out.ball.center = geom::to_float32(p);
    const Vec3& c = out.ball.center;
    const geom::TriangleSearch::Nearest at = bounds_->nearest(c, hint);
    out.triangle = at.triangle;
    if (!bounds_->inside(c)) return out;
    const double room = at.lower - options_.safety * bounds_->slack();
    if (!(room > 0)) return out;
    out.ball.radius = float32_below(room);
    out.spare = out.ball.radius - reach_of(cube, c);
    out.away = (c - bounds_->nearest_point(c, at.triangle)).normalized();
    return out;
  }

  /// Balls that hold the cube: the largest one found by steps from its middle, and some on the way
  /// there. Empty if none does.
  [[nodiscard]] std::vector<Ball> grow(const Cube& cube, std::uint32_t hint) const {
    constexpr std::array<double, 2> kShares{0.85, 0.65};
    constexpr double kLonger = 1.5, kLeastStep = 0.02, kAlike = 0.9;
    Place best = place_at(cube, cube.center, hint);
    if (!(best.ball.radius > 0)) return {};
    std::vector<Ball> way;
    const auto keep = [&] {
      if (best.spare >= held_slack_) way.push_back(best.ball);
    };
    keep();
    const auto is_better = [&](const Place& place) {
      const double now = std::min(best.spare, held_slack_),
                   then = std::min(place.spare, held_slack_);
      if (then != now) return then > now;
      return place.ball.radius > best.ball.radius * (1 + 1e-4);
    };
    // Where triangles are as near as each other, the way leads between them.
    std::vector<Vec3> normals{best.away};
    const auto remember = [&](const Vec3& away) {
      if (!(away.squaredNorm() > 0.5)) return;
      std::erase_if(normals, [&](const Vec3& n) { return n.dot(away) > kAlike; });
      normals.push_back(away);
      if (normals.size() > 3) normals.erase(normals.begin());
    };
    double step = std::max(best.ball.radius, cube.half);
    for (int looks = 0; looks < effort_.looks && step > kLeastStep * best.ball.radius;) {
      std::vector<Vec3> ways;
      Vec3 sum = Vec3::Zero();
      for (auto n = normals.rbegin(); n != normals.rend(); ++n) {
        sum += *n;
        if (sum.norm() > 1e-3) ways.push_back(sum.normalized());
      }
      for (const double x : {-1, 0, 1})
        for (const double y : {-1, 0, 1})
          for (const double z : {-1, 0, 1})
            if (const Vec3 d(x, y, z); d.squaredNorm() > 0) ways.push_back(d.normalized());
      bool found = false;
      for (const Vec3& d : ways) {
        const Place place = place_at(cube, best.ball.center + step * d, best.triangle);
        ++looks;
        remember(place.away);
        if (!is_better(place)) continue;
        best = place;
        keep();
        found = true;
        break;
      }
      step *= found ? kLonger : 0.5;
    }
    if (!(best.spare >= held_slack_)) return {};
    std::vector<Ball> out{best.ball};
    for (const double share : kShares) {
      const auto it = std::ranges::min_element(
          way, {}, [&](const Ball& b) { return std::abs(b.radius - share * best.ball.radius); });
      if (it->radius < 0.95 * out.back().radius) out.push_back(*it);
    }
    return out;
  }

  // --- choice ---

  /// Adds the held cubes that the ball holds.
  void held_by(const Ball& ball, std::uint32_t node, bool all,
               std::vector<std::uint32_t>& out) const {
    const Node& n = nodes_[node];
    if (!all && !may_meet(ball, n.cube)) return;
    all = all || holds(ball, n.cube, held_slack_);
    if (n.children == kNone) {
      if (n.held && all) out.push_back(node);
      return;
    }
    for (std::uint32_t k = 0; k < 8; ++k) held_by(ball, n.children + k, all, out);
  }

  /// Few of the balls that hold all cubes that were held.
  std::vector<Ball> choose() const {
    if (options_.progress) options_.progress({"choosing spheres", 0.9});
    std::vector<std::vector<std::uint32_t>> cubes(balls_.size());
    kaboum::parallel_for(std::size_t{0}, balls_.size(), [&](std::size_t b) {
      for (std::uint32_t n = 0; n < roots_; ++n) held_by(balls_[b], n, false, cubes[b]);
    });
    // Cubes that the same balls hold are one.
    std::vector<std::vector<std::uint32_t>> holders(nodes_.size());
    for (std::uint32_t b = 0; b < cubes.size(); ++b)
      for (const std::uint32_t n : cubes[b]) holders[n].push_back(b);
    std::map<std::vector<std::uint32_t>, std::uint32_t> kinds;
    for (std::vector<std::uint32_t>& one : holders)
      if (!one.empty()) kinds.emplace(std::move(one), static_cast<std::uint32_t>(kinds.size()));
    std::vector<std::vector<std::uint32_t>> sets(balls_.size());
    for (const auto& [of, kind] : kinds)
      for (const std::uint32_t b : of) sets[b].push_back(kind);
    for (std::vector<std::uint32_t>& set : sets) std::ranges::sort(set);
    if (balls_.size() * (kinds.size() / 64 + 1) > kMostWords)
      throw Error(ErrorCode::LimitReached,
                  "too many spheres would be needed inside the solid; allow a larger epsilon");
    std::vector<Ball> out;
    if (kinds.empty()) return out;
    for (const std::uint32_t b : SetCover(kinds.size(), std::move(sets)).search(effort_.steps, 1))
      out.push_back(balls_[b]);
    return out;
  }

  InnerCandidate result(const std::vector<Ball>& chosen) {
    if (chosen.size() > kMostBalls)
      throw Error(ErrorCode::LimitReached,
                  "more than " + std::to_string(kMostBalls) +
                      " spheres would be needed inside the solid; allow a larger epsilon");
    InnerCandidate out;
    out.uncovered_depth_upper = std::max(whole_epsilon_, deepest_left_ / (1 - kDepthSlack));
    if (out.uncovered_depth_upper > whole_epsilon_) out.stop = Stop::Stuck;
    std::ranges::sort(shallow_, std::greater<>(), &Shallow::depth);
    const auto free = std::ranges::find_if(shallow_, [&](const Shallow& one) {
      return std::ranges::none_of(
          chosen, [&](const Ball& b) { return (one.at - b.center).norm() <= b.radius; });
    });
    if (free != shallow_.end())
      out.uncovered_depth_lower = std::min(free->depth, out.uncovered_depth_upper);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      geom::ConvexBody body;
      body.name = "sphere_" + std::to_string(i);
      body.core.vertices = {chosen[i].center};
      body.radius = chosen[i].radius;
      out.bodies.push_back(std::move(body));
    }
    out.vertices = chosen.size();
    out.largest = chosen.empty() ? 0 : 1;
    return out;
  }

  const InnerBallOptions& options_;
  InnerBallEffort effort_;
  double whole_epsilon_, epsilon_, held_slack_;
  geom::WindingNumber winding_;
  Boundary boundary_;
  std::optional<DepthBounds> bounds_;
  std::vector<Node> nodes_;
  std::vector<Ball> balls_;
  BallGrid grid_;
  std::vector<Shallow> shallow_;
  double deepest_left_ = 0;  // bound of the depth in cubes that no ball was found for
  std::uint32_t roots_ = 0;  // of the cubes: the first ones
};

/// As near as so many balls were found to allow: nothing deeper than `enough`, where they suffice.
InnerCandidate within_count(const Mesh& mesh, const InnerBallOptions& options, double enough) {
  const std::size_t most = *options.max_bodies;
  const auto search = [&](double epsilon) -> std::optional<InnerCandidate> {
    try {
      InnerCandidate found = InnerBallSearch(mesh, options, epsilon).run();
      if (found.bodies.size() <= most) return found;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::LimitReached) throw;
    }
    return std::nullopt;
  };
  // No point is as deep as the box's diagonal.
  double high = geom::bounding_box(mesh).diagonal();
  std::optional<InnerCandidate> best = search(high);
  double low = 0;
  while (low == 0 && high > enough) {
    const double next = std::max(enough, 0.5 * high);
    if (too_coarse(mesh, next)) break;
    if (std::optional<InnerCandidate> found = search(next)) {
      best = std::move(found);
      high = next;
    } else {
      low = next;
    }
  }
  while (low > 0 && high > kFinest * low) {
    const double middle = std::sqrt(low * high);
    if (std::optional<InnerCandidate> found = search(middle)) {
      best = std::move(found);
      high = middle;
    } else {
      low = middle;
    }
  }
  if (options.epsilon && high > *options.epsilon) best->stop = Stop::TooManyBodies;
  return *std::move(best);
}

}  // namespace

InnerCandidate find_inner_balls(const geom::SolidMesh& input, const InnerBallOptions& options) {
  if (!options.epsilon && !options.max_bodies)
    throw Error(ErrorCode::InvalidArgument, "neither epsilon nor max_bodies is given");
  SearchSettings settings;
  settings.max_bodies = options.max_bodies;
  require_sound(settings, options);
  require_doubtful(input.mesh(), options.doubtful);
  if (!input.closed())
    throw Error(ErrorCode::InvalidInput, "the mesh is open: bodies inside it mean nothing");
  if (too_coarse(input.mesh(), options.epsilon)) {
    InnerCandidate coarse;
    coarse.stop = Stop::TooCoarse;
    return coarse;
  }
  if (options.max_bodies) return within_count(input.mesh(), options, options.epsilon.value_or(0));
  return InnerBallSearch(input.mesh(), options, *options.epsilon).run();
}

}  // namespace kaboum::bcd
