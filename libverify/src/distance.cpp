// Whether a surface lies within a distance of another surface, or of its solid: triangles are cut
// until each part is decided. docs/algorithms/exact-inclusion.md, "Distance".
#include <kaboum/base/error.h>
#include <kaboum/verify/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cell_sample.h"
#include "nearest.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

/// A part of a triangle.
struct TrianglePart {
  std::array<Vec3, 3> corner;
  int depth;
};

constexpr int kMaxDepth = 64;
constexpr std::uint32_t kBlock = 8192;  // triangles between looks at the limits

/// Distance claims about the pieces of one triangle.
class Judge {
 public:
  Judge(const MeshPair& meshes, double epsilon, double slack, const DistanceClaimOptions& options)
      : meshes_(meshes),
        nearest_(meshes, kOutside),
        epsilon_(epsilon),
        slack_(slack),
        options_(options) {}

  DistanceClaim operator()(const Vec3& a, const Vec3& b, const Vec3& c) const {
    DistanceClaim claim;
    claim.answer = Answer::Verified;
    std::vector<TrianglePart> stack{{{a, b, c}, 0}};
    while (!stack.empty()) {
      const TrianglePart piece = stack.back();
      stack.pop_back();
      if (++claim.pieces > options_.max_pieces_of_one || piece.depth > kMaxDepth) {
        claim.answer = Answer::Undecided;
        claim.reason = "the supremum is too close to the bound";
        return claim;
      }
      std::uint32_t face = 0;
      if (passes(piece, face, claim)) continue;
      if (claim.largest > epsilon_) {
        claim.answer = Answer::Refuted;
        claim.reason = "a point is farther away";
        return claim;
      }
      split(piece, face, stack);
    }
    return claim;
  }

 private:
  /// Bound of |p − triangle| from above.
  [[nodiscard]] double upper(const Vec3& p, std::uint32_t f) const {
    const Vec3 q =
        closest_point(p, meshes_.corner(f, 0), meshes_.corner(f, 1), meshes_.corner(f, 2));
    return (q - p).norm() + slack_;
  }

  /// Bound of the distance to all triangles from below.
  [[nodiscard]] double lower(const Vec3& p) const {
    return nearest_.lower_bound(p, nearest_.nearest(p).distance) - slack_;
  }

  [[nodiscard]] bool inside(const Vec3& p) const {
    const std::optional<int> w = winding_at(meshes_, kOutside, p);
    return w && *w >= 1;
  }

  /// Whether all of the piece is certainly within the bound. Records distances found on the way.
  /// @param face  the triangle nearest to its centre
  bool passes(const TrianglePart& piece, std::uint32_t& face, DistanceClaim& claim) const {
    const Vec3 centre = (piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3;
    double radius = 0;
    for (const Vec3& p : piece.corner) radius = std::max(radius, (p - centre).norm());
    radius += slack_;

    const NearestTriangle::Hit hit = nearest_.nearest(centre);
    face = hit.face;
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
        const std::optional<int> w = winding_at(meshes_, kOutside, p);
        if (!w || *w >= 1) continue;
      }
      claim.largest = distance;
      claim.at = p;
    }
    return false;
  }

  [[nodiscard]] bool near(const TrianglePart& piece, std::uint32_t face) const {
    return face != NearestTriangle::kNone &&
           std::all_of(piece.corner.begin(), piece.corner.end(),
                       [&](const Vec3& p) { return upper(p, face) <= epsilon_; });
  }

  /// Cuts along a side of the nearest triangle's prism, so that surfaces in one plane fall apart
  /// into the parts that lie on one triangle each; across the longest edge where no side cuts.
  void split(const TrianglePart& piece, std::uint32_t face,
             std::vector<TrianglePart>& stack) const {
    const Vec3 &a = meshes_.corner(face, 0), &b = meshes_.corner(face, 1),
               &c = meshes_.corner(face, 2);
    const Vec3 normal = (b - a).cross(c - a);
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      const Vec3 across = (to - from).cross(normal);
      const double length = across.norm();
      if (length > 0 && cut(piece, from, across / length, stack)) return;
    }
    halve(piece, stack);
  }

  /// Cuts by the plane through `on`; @return false when no corner is clearly on either side.
  bool cut(const TrianglePart& piece, const Vec3& on, const Vec3& normal,
           std::vector<TrianglePart>& stack) const {
    std::array<double, 3> height;
    for (int k = 0; k < 3; ++k) height[k] = normal.dot(piece.corner[k] - on);
    const double clear = 4 * slack_;
    if (*std::max_element(height.begin(), height.end()) <= clear ||
        *std::min_element(height.begin(), height.end()) >= -clear) {
      return false;
    }
    int lone = 0;  // the corner that is alone on its side
    for (int k = 0; k < 3; ++k) {
      const bool other = (height[(k + 1) % 3] >= 0) == (height[(k + 2) % 3] >= 0);
      if (other && (height[k] >= 0) != (height[(k + 1) % 3] >= 0)) lone = k;
    }
    const int i = (lone + 1) % 3, j = (lone + 2) % 3;
    const auto meet = [&](int k) -> Vec3 {
      const double t = height[lone] / (height[lone] - height[k]);
      return (1 - t) * piece.corner[lone] + t * piece.corner[k];
    };
    const Vec3 p = meet(i), q = meet(j);
    const int depth = piece.depth + 1;
    stack.push_back({{piece.corner[lone], p, q}, depth});
    stack.push_back({{p, piece.corner[i], piece.corner[j]}, depth});
    stack.push_back({{p, piece.corner[j], q}, depth});
    return true;
  }

  static void halve(const TrianglePart& piece, std::vector<TrianglePart>& stack) {
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

  const MeshPair& meshes_;
  NearestTriangle nearest_;
  double epsilon_;
  double slack_;
  const DistanceClaimOptions& options_;
};

/// Whether a triangle without area of what is measured to is as near to a point as that.
bool near_without_area(const MeshPair& meshes, const Vec3& p, double distance) {
  const auto is_near = [&](const Face& face) {
    const Vec3 q =
        closest_point(p, meshes.point(face.v[0]), meshes.point(face.v[1]), meshes.point(face.v[2]));
    return (q - p).norm() <= distance;
  };
  const std::vector<Face>& repeated = meshes.repeated(kOutside);
  if (std::any_of(repeated.begin(), repeated.end(), is_near)) return true;
  if (meshes.without_area(kOutside) == 0) return false;
  return std::any_of(meshes.faces().begin() + meshes.begin(kOutside),
                     meshes.faces().begin() + meshes.end(kOutside),
                     [&](const Face& face) { return face.axis < 0 && is_near(face); });
}

}  // namespace

DistanceClaim verify_distance(const geom::Mesh& from, const geom::Mesh& to, double epsilon,
                              const DistanceClaimOptions& options) {
  const MeshPair meshes(from, to);
  if (!meshes.scaled()) {
    throw Error(ErrorCode::InvalidInput,
                "coordinates span too many orders of magnitude to measure distances");
  }
  const double slack = rounding_of_distances(meshes.largest_coordinate());
  const Judge judge(meshes, epsilon * meshes.scale(), slack, options);
  // Segments and points are measured as what they are.
  const std::vector<Face> faces = meshes.in_order_of_sources(kInside);
  const auto count = static_cast<std::uint32_t>(faces.size());
  DistanceClaim result;
  if (count == 0) {
    result.reason = "the mesh that is measured from has no triangles";
    return result;
  }
  if (meshes.tree(kOutside).empty()) {
    result.reason = "no triangle of the mesh that is measured to has an area";
    return result;
  }
  result.answer = Answer::Verified;
  std::vector<DistanceClaim> claims;
  for (std::uint32_t first = 0; first < count; first += kBlock) {
    const std::uint32_t size = std::min(kBlock, count - first);
    claims.assign(size, {});
    verify::parallel_for(std::uint32_t{0}, size, [&](std::uint32_t i) {
      const std::array<std::uint32_t, 3>& v = faces[first + i].v;
      claims[i] = judge(meshes.point(v[0]), meshes.point(v[1]), meshes.point(v[2]));
    });
    for (std::uint32_t i = 0; i < size; ++i) {
      const DistanceClaim& claim = claims[i];
      result.pieces += claim.pieces;
      if (claim.largest > result.largest) {
        result.largest = claim.largest;
        result.at = claim.at;
        result.triangle = faces[first + i].source;
      }
      if (claim.answer == Answer::Refuted ||
          (claim.answer == Answer::Undecided && result.answer == Answer::Verified)) {
        result.answer = claim.answer;
        result.reason = claim.reason;
      }
    }
    if (result.answer == Answer::Refuted) {
      if (!options.to_solid && near_without_area(meshes, result.at, result.largest + 2 * slack)) {
        result.answer = Answer::Undecided;
        result.reason = "the point found is near a triangle without area, which is passed over";
      }
      break;
    }
    if (result.pieces > options.max_pieces) {
      result.answer = Answer::Undecided;
      result.reason = "too many parts of triangles would have to be looked at";
      break;
    }
  }
  result.largest = meshes.length_outside(result.largest);
  result.at = meshes.point_outside(result.at);
  return result;
}

}  // namespace kaboum::verify
