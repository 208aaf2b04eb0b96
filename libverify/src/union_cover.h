#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>

#include "body_bounds.h"
#include "cell_sample.h"
#include "mesh_pair.h"
#include "nearest.h"
#include "number.h"
#include "parallel.h"
#include "point_in_solid.h"

/// Whether a union of convex bodies of one kind holds triangles and the solid that they bound: the
/// cutting of triangles and boxes, which is the same for every kind.
/// docs/algorithms/sphere-covers.md and capsules-and-boxes.md.
namespace kaboum::verify::union_cover {

inline constexpr int kTriangleCuts = 50;  ///< weights remain multiples of 2^-52
inline constexpr int kBoxCuts = 40;
inline constexpr std::size_t kPartsOfOne = std::size_t{1} << 20U;  ///< of one triangle
inline constexpr std::size_t kTrianglesAtOnce = 4096;
inline constexpr double kSqrt3Up = 1.7320508076;

inline double largest_of(const Vec3& p) { return p.cwiseAbs().maxCoeff(); }

using Corners = std::array<Vec3, 3>;

/// A point of a triangle, by weights that are multiples of 2^-52 and sum up to 1.
struct Corner {
  std::array<double, 3> weight;
  Vec3 at;  ///< rounded
};

inline Corner corner_of(const Corners& t, const std::array<double, 3>& weight) {
  return {weight, weight[0] * t[0] + weight[1] * t[1] + weight[2] * t[2]};
}

/// Where the rounded corners of a part of a triangle are.
struct Extent {
  geom::Box3 box;
  Vec3 middle;
  double reach;  ///< of the corners from the middle
};

inline Extent extent_of(const std::array<Corner, 3>& corner) {
  Extent out{{}, (corner[0].at + corner[1].at + corner[2].at) / 3, 0};
  for (const Corner& c : corner) {
    out.box.extend(c.at);
    out.reach = std::max(out.reach, (c.at - out.middle).norm());
  }
  return out;
}

/// A part of a triangle.
struct Part {
  std::array<Corner, 3> corner;
  int cuts = 0;
  std::vector<std::uint32_t> near;  ///< all bodies that meet it are among these
};

struct TriangleAnswer {
  Answer answer = Answer::Verified;
  std::size_t parts = 0;
  Vec3 at = Vec3::Zero();  ///< refuted: in no body, rounded
  bool is_corner = false;
};

/// A box of the solid's bounding box.
struct Cell {
  Vec3 center;
  double half;
  int cuts;
  std::vector<std::uint32_t> active;  ///< all bodies that are nearest somewhere in it
};

/// Bodies of one kind.
template <class Bodies>
concept Kind = requires(const Bodies& bodies, std::uint32_t b, const Corners& t, const Corner& c,
                        const Extent& extent, const Vec3& p, double largest, Cell& cell) {
  { Bodies::kOne } -> std::convertible_to<const char*>;   ///< "ball"
  { Bodies::kMany } -> std::convertible_to<const char*>;  ///< "balls"
  { bodies.size() } -> std::convertible_to<std::uint32_t>;
  /// Whether a point of a triangle is in a body, exactly. `largest`: coordinate of the triangle.
  { bodies.holds(b, t, c, largest) } -> std::same_as<bool>;
  /// Whether a point given by doubles is, exactly.
  { bodies.holds(b, p) } -> std::same_as<bool>;
  /// False only if a body is apart from the part of a triangle for certain.
  { bodies.may_meet(b, extent, largest) } -> std::same_as<bool>;
  /// Leaves out bodies that are nearest nowhere in the cell. True if no void has its farthest point
  /// in the cell: a body holds it, fewer than four are active, or there is a way out for all.
  { bodies.is_settled(cell) } -> std::same_as<bool>;
};

template <Kind Bodies>
class TriangleCover {
 public:
  TriangleCover(const Corners& triangle, const Bodies& bodies) : t_(triangle), bodies_(bodies) {
    for (const Vec3& v : t_) largest_ = std::max(largest_, largest_of(v));
  }

  TriangleAnswer decide() {
    Part all{{corner_of(t_, {1, 0, 0}), corner_of(t_, {0, 1, 0}), corner_of(t_, {0, 0, 1})}, 0, {}};
    const Extent extent = extent_of(all.corner);
    for (std::uint32_t b = 0; b < bodies_.size(); ++b)
      if (bodies_.may_meet(b, extent, largest_)) all.near.push_back(b);
    for (const Corner& c : all.corner)
      if (!is_held(c, all.near)) return refuted(c, true);
    std::vector<Part> open{std::move(all)};
    while (!open.empty()) {
      const Part part = std::move(open.back());
      open.pop_back();
      ++out_.parts;
      if (in_one_body(part)) continue;
      if (part.cuts >= kTriangleCuts || out_.parts >= kPartsOfOne) {
        out_.answer = Answer::Undecided;
        out_.at = part.corner[0].at;
        return out_;
      }
      if (const std::optional<Corner> outside = halve(part, open)) return refuted(*outside, false);
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

  [[nodiscard]] bool is_held(const Corner& c, const std::vector<std::uint32_t>& near) const {
    return std::ranges::any_of(near,
                               [&](std::uint32_t b) { return bodies_.holds(b, t_, c, largest_); });
  }

  [[nodiscard]] bool in_one_body(const Part& part) const {
    return std::ranges::any_of(part.near, [&](std::uint32_t b) {
      return std::ranges::all_of(
          part.corner, [&](const Corner& c) { return bodies_.holds(b, t_, c, largest_); });
    });
  }

  /// Cuts the longest side at its middle. @return the middle, where it is in no body
  [[nodiscard]] std::optional<Corner> halve(const Part& part, std::vector<Part>& open) const {
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
    if (!is_held(middle, part.near)) return middle;
    for (const std::size_t replaced : {longest, next}) {
      Part half;
      half.corner = part.corner;
      half.corner[replaced] = middle;
      half.cuts = part.cuts + 1;
      const Extent extent = extent_of(half.corner);
      for (const std::uint32_t b : part.near)
        if (bodies_.may_meet(b, extent, largest_)) half.near.push_back(b);
      open.push_back(std::move(half));
    }
    return std::nullopt;
  }

  const Corners& t_;
  const Bodies& bodies_;
  double largest_ = 0;
  TriangleAnswer out_;
};

/// Of all triangles; those after the limit was reached are Undefined.
template <Kind Bodies>
std::vector<TriangleAnswer> decide_triangles(const geom::Mesh& mesh, const Bodies& bodies,
                                             std::size_t most) {
  std::vector<TriangleAnswer> out(mesh.triangles.size());
  for (TriangleAnswer& answer : out) answer.answer = Answer::Undefined;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < out.size() && parts <= most; i += kTrianglesAtOnce) {
    const std::size_t end = std::min(out.size(), i + kTrianglesAtOnce);
    parallel_for(i, end, [&](std::size_t t) {
      const geom::Triangle& v = mesh.triangles[t];
      const Corners corners{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
      out[t] = TriangleCover(corners, bodies).decide();
    });
    for (std::size_t t = i; t < end; ++t) parts += out[t].parts;
  }
  return out;
}

/// Search of a point of the solid in no body, all triangles being in bodies.
template <Kind Bodies>
class VoidSearch {
 public:
  VoidSearch(const geom::Mesh& mesh, const MeshPair& meshes, const geom::ConvexSet& set,
             const Bodies& bodies)
      : meshes_(meshes),
        nearest_(meshes, kOutside),
        set_(set),
        bodies_(bodies),
        box_(geom::bounding_box(mesh)) {}

  Claim decide(std::size_t most) {
    Claim claim;
    claim.answer = Answer::Verified;
    std::vector<Cell> open{root()};
    std::size_t seen = 0;
    std::optional<Vec3> left_open;
    while (!open.empty()) {
      Cell cell = std::move(open.back());
      open.pop_back();
      if (++seen > most || !std::isfinite(cell.half)) {
        left_open = cell.center;
        break;
      }
      if (is_apart(cell) || bodies_.is_settled(cell)) continue;
      if (std::ranges::none_of(cell.active,
                               [&](std::uint32_t b) { return bodies_.holds(b, cell.center); })) {
        const std::optional<int> winding =
            winding_at(meshes_, kOutside, cell.center * meshes_.scale());
        if (winding && *winding >= 1) return refuted(cell.center);
        if (winding && is_without_triangles(cell)) continue;
      }
      if (cell.cuts >= deepest_) {
        left_open = cell.center;
        continue;
      }
      for (int i = 0; i < 8; ++i) {
        const Vec3 to((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
        open.push_back(
            {cell.center + 0.5 * cell.half * to, 0.5 * cell.half, cell.cuts + 1, cell.active});
      }
    }
    if (left_open) {
      claim.answer = Answer::Undecided;
      claim.reason = "the " + std::string(Bodies::kMany) +
                     " leave too little slack, or too many boxes are needed, inside";
      claim.witness = Witness{*left_open, 0, false};
    }
    return claim;
  }

 private:
  /// Corners and middles of all boxes are multiples of a power of two that doubles hold.
  Cell root() {
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
    Cell out{low + Vec3::Constant(0.5 * size), 0.5 * size, 0, {}};
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) out.active.push_back(b);
    return out;
  }

  [[nodiscard]] bool is_apart(const Cell& cell) const {
    for (int k = 0; k < 3; ++k)
      if (cell.center[k] + cell.half < box_.min[k] || cell.center[k] - cell.half > box_.max[k])
        return true;
    return false;
  }

  [[nodiscard]] bool is_without_triangles(const Cell& cell) const {
    const Vec3 p = cell.center * meshes_.scale();
    const double largest = std::max(meshes_.largest_coordinate(), largest_of(p));
    return nearest_.all_beyond(
        p, kSqrt3Up * cell.half * kGrowth * meshes_.scale() + 4 * rounding_of_distances(largest));
  }

  [[nodiscard]] Claim refuted(const Vec3& p) const {
    Claim claim;
    claim.answer = Answer::Refuted;
    claim.reason = "a point inside the solid is in no " + std::string(Bodies::kOne);
    claim.witness = Witness{p, distance_to_bodies(set_, p), true};
    return claim;
  }

  const MeshPair& meshes_;
  NearestTriangle nearest_;
  const geom::ConvexSet& set_;
  const Bodies& bodies_;
  geom::Box3 box_;
  int deepest_ = 0;
};

inline Claim undecided(std::string why) {
  Claim claim;
  claim.answer = Answer::Undecided;
  claim.reason = std::move(why);
  return claim;
}

/// Beneath places of triangles that are in no body.
template <Kind Bodies>
Claim solid_beneath(const geom::Mesh& mesh, const MeshPair& meshes, const Bodies& bodies,
                    const std::vector<TriangleAnswer>& found) {
  constexpr std::size_t kPlaces = 2000;
  const auto is_held = [&](const Vec3& p) {
    for (std::uint32_t b = 0; b < bodies.size(); ++b)
      if (bodies.holds(b, p)) return true;
    return false;
  };
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
      if (!p.allFinite() || is_held(p)) continue;
      const std::optional<int> winding = winding_at(meshes, kOutside, p * meshes.scale());
      if (!winding || *winding < 1) continue;
      Claim claim;
      claim.answer = Answer::Refuted;
      claim.reason = "a point inside the solid is in no " + std::string(Bodies::kOne);
      claim.witness = Witness{p, share * size, true};
      claim.inner_triangles = {static_cast<std::uint32_t>(t)};
      return claim;
    }
  }
  return undecided("triangles stick out, and no point of the solid was found that does");
}

/// Of all triangles. Notes in `out` how many are left open.
template <Kind Bodies>
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
    claim.reason = "a point of a triangle is in no " + std::string(Bodies::kOne);
  } else if (out.left_out > 0) {
    claim = undecided("of " + std::to_string(out.left_out) +
                      " triangles it was not decided whether the " + Bodies::kMany +
                      " hold them: there is too little slack, or too many parts are needed");
    claim.witness = Witness{open, 0, false};
  }
  out.limited = out.left_out > 0;
  return claim;
}

/// The claims about triangles and solid. @param set  what `bodies` stand for
template <Kind Bodies>
Inclusion decide(const geom::Mesh& original, const geom::ConvexSet& set, const Bodies& bodies,
                 const InclusionOptions& options) {
  const std::string many = Bodies::kMany;
  const MeshPair meshes(geom::Mesh{}, original);
  Inclusion out;
  out.inner_open_edges = meshes.unbalanced(kOutside);
  out.inner_closed = out.inner_open_edges == 0;
  out.triangles_without_area = meshes.without_area(kOutside) + meshes.repeated(kOutside).size();
  if (original.triangles.empty()) {
    out.solid.reason = out.surface.reason = "the inner mesh has no triangles";
    return out;
  }
  if (options.progress) options.progress("parts of triangles in " + many);
  const std::vector<TriangleAnswer> found = decide_triangles(original, bodies, options.max_cells);
  out.surface = surface_claim<Bodies>(set, found, out);
  if (!out.inner_closed) {
    out.solid.reason = "the meshes are not closed and have different borders";
  } else if (meshes.tree(kOutside).empty()) {
    out.solid.reason = "no triangle of the inner mesh has an area, so that it has no solid";
  } else if (options.surface_only) {
    out.solid.reason = "only the surface claim was asked for";
  } else if (out.surface.answer == Answer::Verified) {
    if (options.progress) options.progress("boxes inside the solid");
    out.solid = VoidSearch(original, meshes, set, bodies).decide(options.max_cells);
  } else if (out.surface.answer == Answer::Refuted) {
    out.solid = solid_beneath(original, meshes, bodies, found);
  } else {
    out.solid = undecided("it is not known whether the " + many + " hold all triangles");
  }
  return out;
}

}  // namespace kaboum::verify::union_cover
