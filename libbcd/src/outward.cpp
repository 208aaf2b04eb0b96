// float32 polytopes that contain given points: exact orientation tests decide.
// docs/algorithms/convex-decomposition.md, "Rounding" and "Fewer vertices".

#include "outward.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "float32_below.h"
#include "principal_prism.h"

namespace kaboum::bcd {
namespace {

// What is tried; exact orientation tests decide what is good.

/// Steps of the search for a direction that all normals point along, the length below
/// which there is none, and the squared one below which a step leads nowhere.
constexpr int kDirectionSteps = 60;
constexpr double kNoDirection = 1e-6, kNoWay = 1e-12;
/// Margins of a prism round the points, doubled from the first on. [float32 spacings]
constexpr double kFirstMargin = 2, kLastMargin = 1e4;
/// How far a vertex is pushed first, by how much again at least, and how far beyond what a facet
/// lacks. [float32 spacings; factors]
constexpr double kFirstPush = 1.5, kPushAgain = 1.6, kBeyondLack = 1.1;
/// Vertices that need a longer push make a worse body than a prism. [float32 spacings; share of the
/// diagonal]
constexpr double kPushSpacings = 64, kPushShare = 2e-3;
/// Near the largest float32 number.
constexpr double kLargestFloat = 1e38;

struct Less {
  bool operator()(const Vec3& a, const Vec3& b) const {
    if (a.x() != b.x()) return a.x() < b.x();
    return a.y() != b.y() ? a.y() < b.y() : a.z() < b.z();
  }
};

void add_box(std::vector<Vec3>& out, const Vec3& p, double error) {
  Vec3 low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = float32_below(p[k] - error);
    high[k] = float32_above(p[k] + error);
  }
  for (int i = 0; i < 8; ++i) {
    if (((i & 1) != 0 && high.x() == low.x()) || ((i & 2) != 0 && high.y() == low.y()) ||
        ((i & 4) != 0 && high.z() == low.z()))
      continue;
    out.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                     (i & 4) != 0 ? high.z() : low.z());
  }
}

struct Direction {
  Vec3 u;
  double margin;  ///< least n·u of the normals; |u| = 1
};

/// The unit vector farthest from perpendicular to all normals, as far as a few steps find it: along
/// the shortest vector of their hull (Gilbert's algorithm).
Direction middle_of(const std::vector<Vec3>& normals) {
  Vec3 w = Vec3::Zero();
  for (const Vec3& n : normals) w += n / static_cast<double>(normals.size());
  Direction best{w, -1};
  for (int step = 0; step < kDirectionSteps; ++step) {
    const Vec3* least = normals.data();
    for (const Vec3& n : normals)
      if (n.dot(w) < least->dot(w)) least = &n;
    const double length = w.norm();
    if (!(length > kNoDirection)) break;
    if (least->dot(w) / length > best.margin) best = {w / length, least->dot(w) / length};
    const Vec3 d = *least - w;
    const double square = d.squaredNorm();
    if (!(square > kNoWay)) break;
    w += std::clamp(-w.dot(d) / square, 0.0, 1.0) * d;
  }
  return best;
}

/// Directions of which each normal has one with n·u ≥ 1: one, or at a knife's edge, where that
/// would be long, one per side.
std::vector<Vec3> outward(const std::vector<Vec3>& normals, const Vec3& otherwise, bool split) {
  if (normals.empty()) {
    const double length = otherwise.norm();
    return {length > 0 ? Vec3(otherwise / length) : Vec3::Zero()};
  }
  const Direction all = middle_of(normals);
  if (all.margin > 0.1 || !split) return {all.u / std::max(all.margin, 0.01)};
  std::array<std::vector<Vec3>, 2> side;
  for (const Vec3& n : normals) side[n.dot(normals[0]) > 0 ? 0 : 1].push_back(n);
  std::vector<Vec3> out;
  for (const std::vector<Vec3>& part : side) {
    if (part.empty()) continue;
    const Direction d = middle_of(part);
    out.emplace_back(d.u / std::max(d.margin, 0.01));
  }
  return out;
}

/// The points without those closer than `radius` to an earlier one; points of `preferred` (sorted)
/// come first.
std::vector<Vec3> distinct(std::span<const Vec3> points, const std::vector<Vec3>& preferred,
                           double radius) {
  std::vector<Vec3> out;
  for (const bool exact : {true, false}) {
    for (const Vec3& p : points) {
      if (std::binary_search(preferred.begin(), preferred.end(), p, Less()) != exact) continue;
      if (std::none_of(out.begin(), out.end(),
                       [&](const Vec3& q) { return (p - q).cwiseAbs().maxCoeff() <= radius; }))
        out.push_back(p);
    }
  }
  return out;
}

/// float32's spacing at the largest coordinate.
double spacing_at(std::span<const Vec3> points) {
  double magnitude = 0;
  for (const Vec3& p : points) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  if (!(magnitude < kLargestFloat))
    throw Error(ErrorCode::LimitReached, "coordinates beyond float32; scale the mesh");
  return geom::float32_spacing(magnitude);
}

}  // namespace

std::vector<Vec3> outer_points(const Piece& piece, double error) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < piece.points.size(); ++i)
    add_box(out, piece.points[i], piece.exact[i] != 0 ? 0 : error);
  for (std::size_t i = 0; i < piece.inside.size(); ++i)
    if (piece.inside[i] != 0) add_box(out, piece.cell.corners[i], error);
  geom::HullBuilder builder;
  if (!builder.build(out)) return out;
  std::vector<Vec3> hull;
  for (const std::uint32_t v : builder.vertices()) hull.push_back(out[v]);
  return hull;
}

std::optional<geom::Mesh> push_out(std::span<const Vec3> shape, std::span<const Vec3> required,
                                   std::size_t most) {
  const double ulp = spacing_at(required);
  std::vector<Vec3> sorted(required.begin(), required.end());
  std::sort(sorted.begin(), sorted.end(), Less());
  // What is pushed farther fares better in a prism.
  Box3 extent;
  for (const Vec3& p : required) extent.extend(p);
  const double longest_push = std::max(kPushSpacings * ulp, kPushShare * extent.diagonal());
  geom::HullBuilder builder;
  const std::vector<Vec3> corners = distinct(shape, sorted, 4 * ulp);
  if (builder.build(corners)) {
    const geom::Mesh hull = builder.mesh();
    const std::size_t n = hull.vertices.size();
    // Facets narrower than rounding have no direction that means something.
    std::vector<std::vector<Vec3>> normals(n);
    for (const Triangle& t : hull.triangles) {
      const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
      const Vec3 m = (b - a).cross(c - a);
      const double longest = std::sqrt(
          std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
      if (m.norm() > 30 * ulp * longest)
        for (const std::uint32_t v : t) normals[v].push_back(m.normalized());
    }
    Vec3 center = Vec3::Zero();
    for (const Vec3& p : hull.vertices) center += p / static_cast<double>(n);
    // Both sides of knives' edges, unless that makes too many vertices.
    for (const bool split : {true, false}) {
      std::vector<Vec3> start, direction;  // of what is moved, and the vertex that it is
      std::vector<std::uint32_t> vertex;
      std::vector<double> push(n, 0);
      for (std::uint32_t v = 0; v < n; ++v) {
        for (const Vec3& d : outward(normals[v], hull.vertices[v] - center, split)) {
          start.push_back(hull.vertices[v]);
          direction.push_back(d);
          vertex.push_back(v);
        }
        if (!std::binary_search(sorted.begin(), sorted.end(), hull.vertices[v], Less()))
          push[v] = kFirstPush * ulp;
      }
      std::vector<Vec3> moved(start.size());
      for (int round = 0; round < 40; ++round) {
        for (std::size_t i = 0; i < moved.size(); ++i)
          moved[i] = geom::to_float32(Vec3(start[i] + push[vertex[i]] * direction[i]));
        if (!builder.build(moved) || builder.vertices().size() > most) break;
        bool good = true;
        std::vector<double> farther = push;
        for (const Triangle& t : builder.triangles()) {
          const Vec3 &a = moved[t[0]], &b = moved[t[1]], &c = moved[t[2]];
          if (std::none_of(required.begin(), required.end(), [&](const Vec3& p) {
                return geom::orient3d(a, b, c, p) == geom::Sign::Positive;
              }))
            continue;
          good = false;
          const Vec3 m = (b - a).cross(c - a);
          double lack = 0;
          for (const Vec3& p : required) lack = std::max(lack, m.dot(p - a));
          lack = m.norm() > 0 ? lack / m.norm() : 0;
          for (const std::uint32_t i : t) {
            const double now = push[vertex[i]];
            farther[vertex[i]] = std::max(
                {farther[vertex[i]], kFirstPush * ulp, kPushAgain * now, now + kBeyondLack * lack});
          }
        }
        push = std::move(farther);
        if (good) return builder.mesh();
        if (*std::max_element(push.begin(), push.end()) > longest_push) break;
      }
    }
  }
  return std::nullopt;
}

std::optional<geom::Mesh> prism_round(std::span<const Vec3> points, std::size_t most) {
  const double ulp = spacing_at(points);
  const std::optional<PrincipalPrism> prism = PrincipalPrism::round(points, most);
  if (!prism) return std::nullopt;
  geom::HullBuilder builder;
  for (double margin = kFirstMargin * ulp; margin < kLastMargin * ulp; margin *= 2) {
    std::vector<Vec3> corners = prism->corners(margin);
    for (Vec3& p : corners) p = geom::to_float32(p);
    if (!builder.build(corners)) continue;
    bool good = true;
    for (const Triangle& t : builder.triangles())
      for (const Vec3& p : points)
        good = good && geom::orient3d(corners[t[0]], corners[t[1]], corners[t[2]], p) !=
                           geom::Sign::Positive;
    if (good) return builder.mesh();
  }
  return std::nullopt;
}

geom::Mesh enclose(std::span<const Vec3> shape, std::span<const Vec3> required, std::size_t most) {
  if (std::optional<geom::Mesh> pushed = push_out(shape, required, most)) return *std::move(pushed);
  const double ulp = spacing_at(required);
  geom::HullBuilder builder;
  // Too thin to be pushed along normals: the points themselves, or a prism round them.
  if (builder.build(required) && builder.vertices().size() <= most) return builder.mesh();
  if (!required.empty()) {
    if (auto prism = prism_round(required, most)) return *std::move(prism);
  }
  // Flat: boxes of a few float32 steps.
  std::vector<Vec3> thick;
  for (const Vec3& p : required) add_box(thick, p, 2 * ulp);
  ensure(builder.build(thick), "a set of boxes without a hull");
  return builder.mesh();
}

}  // namespace kaboum::bcd
