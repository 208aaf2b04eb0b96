#include <kaboum/verify/distance.h>

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nearest.h"
#include "spot.h"

namespace kaboum::verify {
namespace {

/// A part of a triangle.
struct Piece {
  std::array<Vec3, 3> corner;
  int depth;
};

constexpr int kMaxDepth = 64;

/// Distance claims about the pieces of one triangle.
class Judge {
 public:
  Judge(const Scene& scene, double epsilon, double slack, const DistanceClaimOptions& options)
      : scene_(scene),
        nearest_(scene, kOutside),
        epsilon_(epsilon),
        slack_(slack),
        options_(options) {}

  DistanceClaim operator()(const Vec3& a, const Vec3& b, const Vec3& c) const {
    DistanceClaim claim;
    claim.answer = Answer::Verified;
    std::vector<Piece> stack{{{a, b, c}, 0}};
    while (!stack.empty()) {
      const Piece piece = stack.back();
      stack.pop_back();
      if (++claim.pieces > options_.max_pieces || piece.depth > kMaxDepth) {
        claim.answer = Answer::Undecided;
        claim.reason = "the supremum is too close to the bound";
        return claim;
      }
      if (passes(piece, claim)) continue;
      if (claim.largest > epsilon_) {
        claim.answer = Answer::Refuted;
        claim.reason = "a point is farther away";
        return claim;
      }
      split(piece, stack);
    }
    return claim;
  }

 private:
  /// Bound of |p − triangle| from above.
  [[nodiscard]] double upper(const Vec3& p, std::uint32_t f) const {
    const Vec3 q = closest_point(p, scene_.corner(f, 0), scene_.corner(f, 1), scene_.corner(f, 2));
    return (q - p).norm() + slack_;
  }

  /// Bound of the distance to all triangles from below.
  [[nodiscard]] double lower(const Vec3& p) const {
    return nearest_.lower_bound(p, nearest_.nearest(p).distance) - slack_;
  }

  [[nodiscard]] bool inside(const Vec3& p) const {
    const std::optional<int> w = winding_at(scene_, kOutside, p);
    return w && *w >= 1;
  }

  /// Whether all of the piece is certainly within the bound. Records distances found on the way.
  bool passes(const Piece& piece, DistanceClaim& claim) const {
    const Vec3 centre = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3;
    double radius = 0;
    for (const Vec3& p : piece.corner) radius = std::max(radius, (p - centre).norm());
    radius += slack_;

    const NearestTriangle::Hit hit = nearest_.nearest(centre);
    if (near(piece, hit.face)) return true;
    if (options_.to_solid && hit.distance > 2 * radius && lower(centre) > radius &&
        inside(centre)) {
      return true;
    }
    for (const Vec3& p : piece.corner) {
      const NearestTriangle::Hit own = nearest_.nearest(p);
      if (own.face != hit.face && near(piece, own.face)) return true;
      if (own.distance <= claim.largest) continue;
      const double distance = lower(p);
      if (distance <= claim.largest) continue;
      if (options_.to_solid) {
        const std::optional<int> w = winding_at(scene_, kOutside, p);
        if (!w || *w >= 1) continue;
      }
      claim.largest = distance;
      claim.at = p;
    }
    return false;
  }

  [[nodiscard]] bool near(const Piece& piece, std::uint32_t face) const {
    return std::all_of(piece.corner.begin(), piece.corner.end(),
                       [&](const Vec3& p) { return upper(p, face) <= epsilon_; });
  }

  static void split(const Piece& piece, std::vector<Piece>& stack) {
    int longest = 0;
    double length = -1;
    for (int k = 0; k < 3; ++k) {
      const double l = (piece.corner[(k + 1) % 3] - piece.corner[k]).squaredNorm();
      if (l > length) {
        length = l;
        longest = k;
      }
    }
    const Vec3 &a = piece.corner[longest], &b = piece.corner[(longest + 1) % 3],
               &c = piece.corner[(longest + 2) % 3];
    const Vec3 middle = 0.5 * a + 0.5 * b;
    stack.push_back({{a, middle, c}, piece.depth + 1});
    stack.push_back({{middle, b, c}, piece.depth + 1});
  }

  const Scene& scene_;
  NearestTriangle nearest_;
  double epsilon_;
  double slack_;
  const DistanceClaimOptions& options_;
};

}  // namespace

DistanceClaim verify_distance(const geom::Mesh& from, const geom::Mesh& to, double epsilon,
                              const DistanceClaimOptions& options) {
  const Scene scene(from, to);
  double largest = 0;
  for (const Face& face : scene.faces()) {
    for (const std::uint32_t v : face.v) {
      largest = std::max(largest, scene.point(v).cwiseAbs().maxCoeff());
    }
  }
  // docs/algorithms/exact-inclusion.md, "Distance": 64 splits and one closest point.
  const double slack = 256 * kUnit * largest + kTiny;
  const Judge judge(scene, epsilon, slack, options);
  const std::uint32_t count = scene.count(kInside);
  std::vector<DistanceClaim> claims(count);
  oneapi::tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t f) {
    claims[f] = judge(scene.corner(f, 0), scene.corner(f, 1), scene.corner(f, 2));
  });

  DistanceClaim result;
  result.answer = Answer::Verified;
  for (const DistanceClaim& claim : claims) {
    result.pieces += claim.pieces;
    if (claim.largest > result.largest) {
      result.largest = claim.largest;
      result.at = claim.at;
    }
    if (claim.answer == Answer::Refuted ||
        (claim.answer == Answer::Undecided && result.answer == Answer::Verified)) {
      result.answer = claim.answer;
      result.reason = claim.reason;
    }
  }
  return result;
}

}  // namespace kaboum::verify
