// Covers by balls: centres on the medial axis, radii by the signed distance, few of them by a local
// search. docs/algorithms/sphere-covers.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/base/random.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "set_cover.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;
using geom::Vec3;

/// Radii are smaller by this share than ε allows, and hold what they are to by it, so that exact
/// decisions find slack.
constexpr double kBallSlack = 1e-5;
/// Chosen points are held with this share of the radius to spare, so that what is between them is
/// held as well.
constexpr double kPointSlack = 2e-3;
constexpr int kBallRounds = 8;    ///< of choices made anew with points added where no ball is
constexpr int kPatchRounds = 40;  ///< of balls added there
constexpr std::size_t kAddedAtOnce = 150;
constexpr int kPieceCuts = 24;  ///< of a triangle
constexpr std::size_t kMostSamples = 12'000;
constexpr std::size_t kMostPoints = 20'000;  ///< after which the best found is enough

/// Amounts of work of a search.
struct SearchEffort {
  std::size_t samples, steps;
  int refinements;
};

SearchEffort effort_of(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {800, 500, 1};
    case Effort::Normal:
      break;
    case Effort::Best:
      return {3000, 20000, 6};
  }
  return {1500, 1500, 2};
}

/// A centre and the signed distance to the surface there, from above.
struct Center {
  Vec3 at;
  double distance;
};

/// A ball of a choice.
struct Chosen {
  Vec3 center;
  double radius;
};

class BallSearch {
 public:
  BallSearch(const Mesh& mesh, const BallOptions& options)
      : mesh_(mesh),
        options_(options),
        effort_(effort_of(options.effort)),
        query_(mesh),
        winding_(mesh),
        box_(geom::bounding_box(mesh)) {
    sample(options.epsilon.value_or(0));
    for (const Vec3& p : options.held) points_.push_back(p);
  }

  CoverCandidate run() {
    CoverCandidate out;
    std::vector<Chosen> balls;
    if (options_.max_bodies) {
      balls = within_count(*options_.max_bodies);
      // With epsilon, too: fewer where it allows that.
      if (options_.epsilon && epsilon_ <= *options_.epsilon) balls = cover(*options_.epsilon);
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

  // --- candidates ---

  /// From above.
  [[nodiscard]] double signed_distance(const Vec3& p) const {
    const geom::TriangleSearch::Nearest near = query_.nearest(p);
    const std::optional<int> winding = winding_(p);
    return winding && *winding >= 1 ? -near.lower * (1 - 1e-12) : near.upper * (1 + 1e-12);
  }

  void add_center(const Vec3& p) {
    const Vec3 at = geom::to_float32(p);
    centers_.push_back({at, signed_distance(at)});
  }

  /// The centre of the largest ball in the solid that touches a point of the surface, by shrinking
  /// one about the normal's line. [ma2012]
  [[nodiscard]] Vec3 medial_center(const Vec3& p, const Vec3& outwards) const {
    double radius = 0.5 * box_.diagonal();
    for (int turn = 0; turn < 30; ++turn) {
      const Vec3 c = p - radius * outwards;
      const std::uint32_t t = query_.nearest(c).triangle;
      const auto& [a, b, d] = query_.corners(t);
      const Vec3 q = geom::closest_point(c, a, b, d);
      const Vec3 to = p - q;
      const double along = to.dot(outwards);
      if ((q - c).norm() >= radius * (1 - 1e-6) || !(along > 0)) break;
      const double less = to.squaredNorm() / (2 * along);
      if (!(less < radius)) break;
      radius = less;
    }
    return p - radius * outwards;
  }

  /// Points of the surface, evenly by area, of the inside, and medial centres for all of them.
  void sample(double epsilon) {
    std::vector<double> sums;
    double area = 0;
    for (const auto& [i, j, k] : mesh_.triangles) {
      area += 0.5 * (mesh_.vertices[j] - mesh_.vertices[i])
                        .cross(mesh_.vertices[k] - mesh_.vertices[i])
                        .norm();
      sums.push_back(area);
    }
    std::size_t count = effort_.samples;
    if (epsilon > 0)
      count = std::clamp(static_cast<std::size_t>(std::min(area / (epsilon * epsilon), 1e9)), count,
                         kMostSamples);
    std::vector<Vec3> normals;
    std::vector<Vec3> at;
    const double step = area / static_cast<double>(count);
    double next = 0.5 * step;
    for (std::size_t t = 0; t < sums.size(); ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      const Vec3 &a = mesh_.vertices[i], &b = mesh_.vertices[j], &c = mesh_.vertices[k];
      const Vec3 normal = (b - a).cross(c - a);
      for (; next < sums[t]; next += step) {
        double u = random_.between(0, 1), v = random_.between(0, 1);
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        at.emplace_back(a + u * (b - a) + v * (c - a));
        normals.push_back(normal.normalized());
      }
    }
    std::vector<Center> found(2 * at.size());
    kaboum::parallel_for(std::size_t{0}, at.size(), [&](std::size_t i) {
      const Vec3 medial = geom::to_float32(medial_center(at[i], normals[i]));
      found[2 * i] = {medial, signed_distance(medial)};
      const Vec3 here = geom::to_float32(at[i]);
      found[2 * i + 1] = {here, signed_distance(here)};
    });
    for (std::size_t i = 0; i < at.size(); ++i) {
      points_.push_back(at[i]);
      if (found[2 * i].distance < 0) centers_.push_back(found[2 * i]);
      // Centres on the surface: the only ones where the solid is thin.
      if (i % 8 == 0) centers_.push_back(found[2 * i + 1]);
      // A part of the medial centres stand for the inside.
      if (i % 8 == 0 && found[2 * i].distance < 0) points_.push_back(found[2 * i].at);
    }
  }

  // --- choices ---

  [[nodiscard]] double radius_of(const Center& c, double epsilon) const {
    return epsilon * (1 - kBallSlack) - c.distance;
  }

  /// Centres chosen for ε: indices.
  [[nodiscard]] std::vector<std::uint32_t> choose(const std::vector<Vec3>& points, double epsilon,
                                                  std::size_t steps, std::size_t enough) const {
    std::vector<std::vector<std::uint32_t>> sets(centers_.size());
    kaboum::parallel_for(std::size_t{0}, centers_.size(), [&](std::size_t c) {
      const double radius = radius_of(centers_[c], epsilon) * (1 - kPointSlack);
      if (!(radius > 0)) return;
      const double square = radius * radius;
      for (std::uint32_t p = 0; p < points.size(); ++p)
        if ((points[p] - centers_[c].at).squaredNorm() <= square) sets[c].push_back(p);
    });
    return SetCover(points.size(), std::move(sets)).search(steps, enough);
  }

  [[nodiscard]] std::vector<Chosen> balls_of(const std::vector<std::uint32_t>& choice,
                                             double epsilon) const {
    std::vector<Chosen> out;
    out.reserve(choice.size());
    for (const std::uint32_t c : choice) {
      double radius = geom::to_float32(radius_of(centers_[c], epsilon));
      if (radius > radius_of(centers_[c], epsilon))
        radius -= geom::float32_spacing(radius * (1 - 1e-7));
      out.push_back({centers_[c].at, radius});
    }
    return out;
  }

  /// New centres about those chosen.
  void scatter(const std::vector<std::uint32_t>& choice, double epsilon, double width) {
    std::vector<Vec3> places;
    for (const std::uint32_t c : choice) {
      const double reach = width * radius_of(centers_[c], epsilon);
      for (int k = 0; k < 24; ++k) {
        const double x = random_.between(-1, 1), y = random_.between(-1, 1),
                     z = random_.between(-1, 1);
        places.emplace_back(geom::to_float32(centers_[c].at + reach * Vec3(x, y, z)));
      }
    }
    std::vector<Center> found(places.size());
    kaboum::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
      found[i] = {places[i], signed_distance(places[i])};
    });
    for (const Center& c : found)
      if (radius_of(c, epsilon) > 0) centers_.push_back(c);
  }

  /// Drops centres that were not chosen, but for the first ones.
  void forget(std::vector<std::uint32_t>& choice, std::size_t kept) {
    std::vector<Center> out(
        centers_.begin(),
        centers_.begin() + static_cast<std::ptrdiff_t>(std::min(kept, centers_.size())));
    for (std::uint32_t& c : choice) {
      if (c < kept) continue;
      out.push_back(centers_[c]);
      c = static_cast<std::uint32_t>(out.size() - 1);
    }
    centers_ = std::move(out);
  }

  /// Points of triangles in no ball, up to some; adds them. @return whether there are none
  bool add_free_points(const std::vector<Chosen>& balls) {
    std::vector<std::vector<Vec3>> found(mesh_.triangles.size());
    kaboum::parallel_for(std::size_t{0}, mesh_.triangles.size(), [&](std::size_t t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      find_free({mesh_.vertices[i], mesh_.vertices[j], mesh_.vertices[k]}, balls, found[t]);
    });
    std::vector<Vec3> all;
    for (const std::vector<Vec3>& some : found) all.insert(all.end(), some.begin(), some.end());
    const std::size_t stride = all.size() / kAddedAtOnce + 1;
    for (std::size_t i = 0; i < all.size(); i += stride) points_.push_back(all[i]);
    return all.empty();
  }

  struct Piece {
    std::array<Vec3, 3> corner;
    int cuts;
  };

  static void find_free(const std::array<Vec3, 3>& triangle, const std::vector<Chosen>& balls,
                        std::vector<Vec3>& out) {
    constexpr std::size_t kMost = 8;
    std::vector<Chosen> near;
    const Vec3 middle = (triangle[0] + triangle[1] + triangle[2]) / 3;
    double reach = 0;
    for (const Vec3& p : triangle) reach = std::max(reach, (p - middle).norm());
    for (const Chosen& b : balls)
      if ((b.center - middle).norm() <= b.radius + reach)
        near.push_back({b.center, b.radius * (1 - kBallSlack)});
    const auto holds = [](const Chosen& b, const Vec3& p) {
      return (p - b.center).squaredNorm() <= b.radius * b.radius;
    };
    std::vector<Piece> open{{triangle, 0}};
    while (!open.empty() && out.size() < kMost) {
      const Piece piece = open.back();
      open.pop_back();
      bool held = false;
      std::array<bool, 3> some{};
      for (const Chosen& b : near) {
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
        Piece part = piece;
        part.corner[k] = half;
        ++part.cuts;
        open.push_back(part);
      }
    }
  }

  /// A cover of all triangles within ε; empty where none was found with `limit` balls or fewer.
  /// @param limit  of the number of balls; 0: none
  std::vector<Chosen> cover(double epsilon, std::size_t limit = 0) {
    constexpr int kBefore = 2;  // rounds that find points at first
    epsilon_ = epsilon;
    const std::size_t first = centers_.size();
    std::vector<std::uint32_t> choice;
    std::vector<Chosen> best;
    for (int round = 0; round < kBallRounds; ++round) {
      show(limit > 0 ? "trying a distance" : "choosing balls",
           static_cast<double>(round) / kBallRounds);
      const int refined = round - kBefore;
      if (limit == 0 && refined >= 0 && refined < effort_.refinements) {
        forget(choice, first);
        scatter(choice, epsilon, 0.4 / (refined + 1));
      }
      const std::size_t steps = round < kBefore ? effort_.steps / 4 : effort_.steps;
      choice = choose(points_, epsilon, steps, limit);
      if (choice.empty()) {
        // A point that no centre's ball holds: balls about the points themselves do.
        for (const Vec3& p : std::vector<Vec3>(points_)) add_center(p);
        choice = choose(points_, epsilon, steps, limit);
        if (choice.empty())
          throw Error(ErrorCode::LimitReached,
                      "epsilon is too small for spheres here; allow a larger one");
      }
      if (limit > 0 && choice.size() > limit) return {};
      std::vector<Chosen> balls = patched(choice, epsilon, limit);
      const bool is_whole = balls.size() == choice.size();  // nothing was added
      if (!balls.empty() && (best.empty() || balls.size() < best.size())) best = std::move(balls);
      if (limit > 0 && !best.empty()) return best;
      if (!best.empty() && points_.size() > kMostPoints) break;
      if (is_whole && refined >= effort_.refinements) break;
    }
    if (best.empty() && limit == 0)
      throw Error(
          ErrorCode::LimitReached,
          "no spheres were found that hold all triangles within epsilon; allow a larger one");
    return best;
  }

  /// Adds balls until all triangles are held; empty where these would be too many.
  std::vector<Chosen> patched(std::vector<std::uint32_t> choice, double epsilon,
                              std::size_t limit) {
    for (int round = 0; round < kPatchRounds; ++round) {
      if (limit > 0 && choice.size() > limit) return {};
      std::vector<Chosen> balls = balls_of(choice, epsilon);
      const std::size_t known = points_.size();
      if (add_free_points(balls)) return balls;
      const std::vector<Vec3> free(points_.begin() + static_cast<std::ptrdiff_t>(known),
                                   points_.end());
      for (std::size_t i = 0; i < free.size(); i += 4) add_center(free[i]);
      std::vector<std::uint32_t> more = choose(free, epsilon, 0, 0);
      if (more.empty()) {
        for (const Vec3& p : free) add_center(p);
        more = choose(free, epsilon, 0, 0);
      }
      choice.insert(choice.end(), more.begin(), more.end());
    }
    return {};
  }

  /// The least ε found with so many balls.
  std::vector<Chosen> within_count(std::size_t count) {
    double high = 0.5 * box_.diagonal(), low = 0;
    std::vector<Chosen> best;
    // A ball about the middle holds everything.
    centers_.push_back(
        {geom::to_float32(box_.center()), signed_distance(geom::to_float32(box_.center()))});
    double tried = high;
    for (int turn = 0; turn < 9; ++turn) {
      std::vector<Chosen> balls = cover(tried, count);
      if (!balls.empty()) {
        best = std::move(balls);
        high = tried;
      } else {
        low = tried;
      }
      if (best.empty()) {
        tried *= 2;
      } else {
        tried = low > 0 ? std::sqrt(low * high) : 0.4 * high;
      }
      if (low > 0 && high < 1.02 * low) break;
    }
    // New centres about those found, at a little less.
    for (int turn = 0; turn < 3 * effort_.refinements; ++turn) {
      const std::size_t first = centers_.size();
      for (const Chosen& b : best)
        for (int k = 0; k < 40; ++k) {
          const double reach = 0.4 * b.radius / (1 + turn);
          const double x = random_.between(-1, 1), y = random_.between(-1, 1),
                       z = random_.between(-1, 1);
          add_center(b.center + reach * Vec3(x, y, z));
        }
      const double step = turn < effort_.refinements ? 0.95 : 0.98;
      std::vector<Chosen> balls = cover(step * high, count);
      if (!balls.empty()) {
        best = std::move(balls);
        high *= step;
      }
      if (first > 30'000)
        centers_.erase(centers_.begin(), centers_.begin() + static_cast<std::ptrdiff_t>(first / 2));
    }
    epsilon_ = high;
    return best;
  }

  /// Certified bracket of the farthest point of the balls from the solid.
  void measure(const std::vector<Chosen>& balls, CoverCandidate& out) const {
    for (const Chosen& b : balls) {
      const double up = 1 + 1e-12;
      out.excess_upper = std::max(out.excess_upper, (b.radius + signed_distance(b.center)) * up);
      const auto& [a, c, d] = query_.corners(query_.nearest(b.center).triangle);
      const Vec3 q = geom::closest_point(b.center, a, c, d);
      const Vec3 along = (q - b.center).normalized();
      if (!along.allFinite()) continue;
      const Vec3 far = b.center + b.radius * (1 - 1e-12) * along;
      const std::optional<int> winding = winding_(far);
      if (winding && *winding <= 0)
        out.excess_lower = std::max(out.excess_lower, query_.nearest(far).lower * (1 - 1e-9));
    }
    out.excess_lower = std::min(out.excess_lower, out.excess_upper);
  }

  const Mesh& mesh_;
  const BallOptions& options_;
  SearchEffort effort_;
  geom::DistanceQuery query_;
  geom::WindingNumber winding_;
  geom::Box3 box_;
  Random random_{1};
  std::vector<Center> centers_;
  std::vector<Vec3> points_;  ///< to be held
  double epsilon_ = 0;
};

}  // namespace

CoverCandidate find_balls(const geom::SolidMesh& input, const BallOptions& options) {
  if (!options.epsilon && !options.max_bodies)
    throw Error(ErrorCode::InvalidArgument, "balls: epsilon or a number of them is needed");
  if (options.epsilon && !(*options.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument, "epsilon must be positive");
  if (options.max_bodies && *options.max_bodies == 0)
    throw Error(ErrorCode::InvalidArgument, "there must be a body at least");
  const geom::SolidMesh closed = geom::close_holes(input);
  const geom::Box3 box = geom::bounding_box(closed.mesh());
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (options.epsilon && geom::float32_spacing(largest) > 0.01 * *options.epsilon) {
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
