// Whether bodies are within a distance of a solid: cells of rounded boxes, and tetrahedra of
// polytopes, until each is decided. docs/algorithms/rounded-bodies.md, "Cells".
#include "body_excess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "body_bounds.h"
#include "cell_sample.h"
#include "nearest.h"
#include "number.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

using geom::ConvexBody;
using geom::ConvexSet;
using geom::Region;

/// Of the largest coordinate: what all roundings of a body's frame and cells take, by far.
constexpr double kFrameRounding = 0x1p-42;
/// Of the largest coordinate: as far as corners of what passes for a box may be from those of one.
constexpr double kCornerDigits = 0x1p-21;
/// What products of axes may be off by.
constexpr double kOrthonormal = 0x1p-46;
constexpr double kMostCoordinate = 1e100;                       ///< squares do not overflow
constexpr std::size_t kMostCells = std::size_t{1} << 19U;       ///< of one body
constexpr std::size_t kMostTetrahedra = std::size_t{1} << 19U;  ///< of one body
constexpr std::size_t kBodiesAtOnce = 32;  ///< between looks at whether it is decided

/// Points m + A t with |tᵢ| ≤ halfᵢ, and all within the radius of them.
struct RoundedBox {
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, orthonormal but for rounding
  Vec3 half = Vec3::Zero();
  double radius = 0;    ///< with what rounding takes: the body is in it
  double rounding = 0;  ///< of points that are computed of it [length]

  [[nodiscard]] Vec3 at(const Vec3& t) const { return center + axes * t; }
};

/// Of length 1 but for a few roundings, also where squares of the coordinates would underflow; not
/// finite for a direction of length 0.
Vec3 direction_of(const Vec3& p) { return (p / p.cwiseAbs().maxCoeff()).normalized(); }

/// Axes from two directions; nullopt where rounding does not leave them orthonormal.
std::optional<Eigen::Matrix3d> axes_along(const Vec3& first, const Vec3& second) {
  Eigen::Matrix3d out;
  out.col(0) = direction_of(first);
  const Vec3 beside = direction_of(second);
  out.col(1) = direction_of(beside - beside.dot(out.col(0)) * out.col(0));
  out.col(2) = out.col(0).cross(out.col(1));
  const double error = (out.transpose() * out - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return error < kOrthonormal ? std::optional(out) : std::nullopt;
}

/// The direction of a segment, and the axis of coordinates that is nearest to square to it.
std::optional<Eigen::Matrix3d> axes_of_segment(const Vec3& along) {
  Eigen::Index least = 0;
  along.cwiseAbs().minCoeff(&least);
  return axes_along(along, Vec3::Unit(least));
}

/// The directions of the largest facet's normal, and of the largest one square to it.
std::optional<Eigen::Matrix3d> axes_of_facets(const geom::Mesh& core) {
  double size = 0;
  for (const Vec3& p : core.vertices)
    size = std::max(size, (p - core.vertices[0]).cwiseAbs().maxCoeff());
  std::vector<Vec3> normals;
  for (const geom::Triangle& t : core.triangles)
    normals.push_back(((core.vertices[t[1]] - core.vertices[t[0]]) / size)
                          .cross((core.vertices[t[2]] - core.vertices[t[0]]) / size));
  const auto largest = [&](const auto& counts) {
    Vec3 out = Vec3::Zero();
    for (const Vec3& n : normals)
      if (counts(n) && n.squaredNorm() > out.squaredNorm()) out = n;
    return out;
  };
  const Vec3 first = largest([](const Vec3&) { return true; });
  const Vec3 second =
      largest([&](const Vec3& n) { return std::abs(n.dot(direction_of(first))) < 0.1 * n.norm(); });
  return axes_along(first, second);
}

/// nullopt where the body is none, or where its corners are not those of a box but for their
/// digits.
std::optional<RoundedBox> rounded_box_of(const ConvexBody& body) {
  constexpr std::size_t kCorners = 8;
  const std::vector<Vec3>& v = body.core.vertices;
  const bool is_flat = body.core.triangles.empty();
  geom::require_valid(body.core);
  if (std::ranges::any_of(v, [](const Vec3& p) { return !p.allFinite(); })) return std::nullopt;
  if (v.empty() || (is_flat ? v.size() > 2 || !(body.radius > 0) : v.size() != kCorners))
    return std::nullopt;
  RoundedBox out;
  double largest = body.radius;
  for (const Vec3& p : v) largest = std::max(largest, p.cwiseAbs().maxCoeff() + body.radius);
  if (!(largest < kMostCoordinate) || !(body.radius >= 0)) return std::nullopt;
  out.rounding = kFrameRounding * largest + kTiny;
  // Without axes of its own a segment is in the box along those of coordinates.
  const auto axes = is_flat ? axes_of_segment(v.back() - v.front()) : axes_of_facets(body.core);
  if (!axes && !is_flat) return std::nullopt;
  if (axes) out.axes = *axes;
  geom::Box3 box;  // in the axes
  for (const Vec3& p : v) box.extend(Vec3(out.axes.transpose() * (p - v[0])));
  out.center = v[0] + out.axes * box.center();
  out.half = 0.5 * (box.max - box.min);
  out.radius = body.radius + out.rounding;
  for (int k = 0; !is_flat && k < static_cast<int>(kCorners); ++k) {
    const Vec3 corner = out.at(out.half.cwiseProduct(
        Vec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1)));
    if (std::ranges::none_of(
            v, [&](const Vec3& p) { return (p - corner).norm() <= kCornerDigits * largest; }))
      return std::nullopt;
  }
  return out;
}

bool has_facets_only(const ConvexBody& body) {
  return body.radius == 0 && !body.core.triangles.empty();
}

/// Where a claim counts.
struct InRegion {
  const Region* region;  ///< nullptr: everywhere
  double rounding;
};

ConvexBody scaled(ConvexBody body, double scale) {
  for (Vec3& p : body.core.vertices) p *= scale;
  body.radius *= scale;
  return body;
}

/// One body's points against the solid: what parts of all kinds are asked. Lengths are in the unit
/// of the pair of meshes.
class Search {
 protected:
  /// @param largest  coordinate of the body in that unit, or more
  /// @param rounding  of points of it, besides that of distances
  Search(const MeshPair& meshes, const ConvexBody& body, double largest, double rounding,
         double epsilon, const InRegion& region)
      : meshes_(meshes),
        nearest_(meshes, kOutside),
        body_(body),
        epsilon_(epsilon * meshes.scale()),
        region_(region),
        slack_(4 * rounding_of_distances(std::max(meshes.largest_coordinate(), largest)) +
               rounding) {
    out_.answer = Answer::Verified;
  }

  /// Cuts parts until each is decided. Large ones come first: a point that refutes need not be
  /// sought in the smallest ones.
  /// @param most  parts that are looked at
  /// @param look  of a part and what it is cut into, to be added to: whether it is decided or was
  /// cut
  template <class Part, class Look>
  void search(std::vector<Part> open, std::size_t most, const Look& look) {
    bool is_open = false;  // a part that is too small to be cut, or there are too many
    while (!open.empty() && out_.answer == Answer::Verified) {
      std::vector<Part> smaller;
      for (const Part& part : open) {
        if (out_.answer != Answer::Verified) break;
        is_open = !look(part, smaller) || is_open;
        if (out_.pieces + smaller.size() <= most) continue;
        is_open = true;
        smaller.clear();
        break;
      }
      open = std::move(smaller);
    }
    if (is_open && out_.answer == Answer::Verified) out_.answer = Answer::Undecided;
  }

  /// How far a point is from the region, negative within it. [length of the files]
  [[nodiscard]] double from_region(const Vec3& p) const {
    const Vec3 at = meshes_.point_outside(p);
    return geom::distance_from(*region_.region, {&at, 1});
  }
  [[nodiscard]] bool is_beyond_region(const Vec3& middle, double reach) const {
    return region_.region != nullptr &&
           from_region(middle) > meshes_.length_outside(reach) * (1 + 1e-9) + region_.rounding;
  }

  [[nodiscard]] Vec3 closest(const Vec3& p, std::uint32_t face) const {
    return closest_point(p, meshes_.corner(face, 0), meshes_.corner(face, 1),
                         meshes_.corner(face, 2));
  }
  [[nodiscard]] double upper(const Vec3& p, std::uint32_t face) const {
    return (p - closest(p, face)).norm() + slack_;
  }

  [[nodiscard]] bool is_inside(const Vec3& p) const {
    const std::optional<int> winding = winding_at(meshes_, kOutside, p);
    return winding && *winding >= 1;
  }
  /// Whether what is within `reach` of a point of the solid is within ε of the solid.
  [[nodiscard]] bool is_deep(const Vec3& middle, double distance, double reach) const {
    const double depth = nearest_.lower_bound(middle, distance) - slack_;
    return reach - std::max(depth, 0.0) <= epsilon_;
  }

  /// What is farther than ε from a point of the surface, and no farther than h from b, is on one
  /// side of a plane, by Lemma 2 of docs/algorithms/sphere-covers.md: whether nothing is that has
  /// no n · (x − b) above `most`.
  [[nodiscard]] bool is_below_cap(double a, double h, double most) const {
    const double e = epsilon_ - slack_;
    if (!(a > slack_) || !(e > 0)) return false;
    const double rounding = 32 * kUnit * (e * e + a * a + h * h) / (2 * a);
    return most + 1e-12 * std::abs(most) + slack_ + rounding <= (e * e - a * a - h * h) / (2 * a);
  }

  /// Refutes by a point if it is in the body, and in the region, and farther than ε.
  bool is_far(const Vec3& p) {
    const Vec3 at = meshes_.point_outside(p);
    if (!at.allFinite() || at * meshes_.scale() != p) return false;
    if (region_.region != nullptr && !(from_region(p) < -region_.rounding)) return false;
    const double from_below = nearest_.lower_bound(p, nearest_.distance(p)) - slack_;
    if (!(from_below > largest_)) return false;
    const std::optional<int> winding = winding_at(meshes_, kOutside, p);
    if (!winding || *winding >= 1 || !contains(body_, at)) return false;
    largest_ = from_below;
    out_.largest = meshes_.length_outside(from_below);
    out_.at = at;
    if (!(from_below > epsilon_)) return false;
    out_.answer = Answer::Refuted;
    return true;
  }

  const MeshPair& meshes_;
  NearestTriangle nearest_;
  const ConvexBody& body_;
  double epsilon_;
  InRegion region_;
  double slack_;
  double largest_ = 0;  ///< of points looked at
  DistanceClaim out_;
};

/// Part of the space about a body: |tᵢ − centerᵢ| ≤ halfᵢ.
struct Cell {
  Vec3 center, half;
  std::uint32_t face;  ///< near it, or NearestTriangle::kNone
};

/// What a body has in a cell.
struct Content {
  Cell cell;       ///< no larger than it has to be
  Vec3 low, high;  ///< points of the core that are nearest to points of it are between
  Vec3 middle;     ///< of the cell, in space
  double reach;    ///< of its points from the middle
};

class RoundedBoxSearch : private Search {
 public:
  /// @param box  of the body in the unit of the meshes
  RoundedBoxSearch(const MeshPair& meshes, const ConvexBody& body, const RoundedBox& box,
                   double epsilon, const InRegion& region)
      : Search(meshes, body, box.center.cwiseAbs().maxCoeff() + box.half.sum() + 2 * box.radius,
               box.rounding, epsilon, region),
        box_(box),
        body_radius_(body.radius * meshes.scale()) {}

  /// Looks at points of the body that are far out, one of which is most often the farthest one.
  DistanceClaim ends() {
    const auto look = [&](const Vec3& direction) {
      Vec3 end;
      for (int k = 0; k < 3; ++k)
        end[k] = direction[k] == 0 ? 0 : std::copysign(box_.half[k], direction[k]);
      is_far(point_at(end, direction.normalized()));
    };
    const Vec3 surface = closest(box_.center, nearest_.nearest(box_.center).face);
    const Vec3 away = box_.axes.transpose() * (box_.center - surface);
    if (away.norm() > 0) {
      look(away);
      look(-away);
    }
    for (const double x : {-1.0, 0.0, 1.0})
      for (const double y : {-1.0, 0.0, 1.0})
        for (const double z : {-1.0, 0.0, 1.0})
          if (const Vec3 direction(x, y, z);
              out_.answer == Answer::Verified && !direction.isZero(0))
            look(direction);
    return out_;
  }

  DistanceClaim decide() {
    if (is_held_by_middle()) return out_;
    search(std::vector<Cell>{{Vec3::Zero(), box_.half + Vec3::Constant(box_.radius),
                              NearestTriangle::kNone}},
           kMostCells, [&](const Cell& cell, std::vector<Cell>& smaller) {
             const std::optional<Content> content = content_of(cell);
             if (!content || is_beyond_region(content->middle, content->reach)) return true;
             ++out_.pieces;
             std::uint32_t face = cell.face;
             if (passes(*content, face)) return true;
             if (!(content->reach > 8 * slack_)) return false;
             cut(content->cell, face, smaller);
             return true;
           });
    return out_;
  }

 private:
  /// nullopt: nothing. Of points of the cell the ones of the core that are nearest are found
  /// coordinate by coordinate.
  [[nodiscard]] std::optional<Content> content_of(const Cell& cell) const {
    const auto on_core = [&](const Vec3& t) -> Vec3 {
      return t.cwiseMax(-box_.half).cwiseMin(box_.half);
    };
    Content out{cell, on_core(cell.center - cell.half), on_core(cell.center + cell.half), {}, 0};
    const Vec3 gap = (cell.center.cwiseAbs() - cell.half - box_.half).cwiseMax(0);
    if (gap.norm() > box_.radius * kUp) return std::nullopt;
    const Vec3 radius = Vec3::Constant(box_.radius);
    const Vec3 low = (cell.center - cell.half).cwiseMax(out.low - radius),
               high = (cell.center + cell.half).cwiseMin(out.high + radius);
    out.cell.center = 0.5 * (low + high);
    out.cell.half = (0.5 * (high - low)).cwiseMax(0);
    out.middle = box_.at(out.cell.center);
    out.reach = out.cell.half.norm() * kUp + slack_;
    return out;
  }

  /// Whether the points between two corners, in the body's axes, are within a distance of a
  /// triangle: the distance is convex.
  [[nodiscard]] bool is_near(const Vec3& low, const Vec3& high, std::uint32_t face,
                             double distance) const {
    for (int k = 0; k < 8; ++k) {
      const Vec3 t((k & 1) != 0 ? high[0] : low[0], (k & 2) != 0 ? high[1] : low[1],
                   (k & 4) != 0 ? high[2] : low[2]);
      if (upper(box_.at(t), face) > distance) return false;
    }
    return true;
  }

  /// Whether all that the body has in the cell is within ε. Refutes where a point is found.
  /// @param face  where to begin; becomes the triangle nearest to the middle
  bool passes(const Content& content, std::uint32_t& face) {
    const NearestTriangle::Hit hit = nearest_.nearest(content.middle, face);
    face = hit.face;
    if (hit.distance + slack_ + content.reach <= epsilon_) return true;
    const Vec3 half = content.cell.half;
    if (is_near(content.cell.center - half, content.cell.center + half, face, epsilon_) ||
        (epsilon_ > box_.radius &&
         is_near(content.low, content.high, face, epsilon_ - box_.radius)))
      return true;
    const Vec3 surface = closest(content.middle, face);
    if (is_below_cap(content, surface)) return true;
    if (is_inside(content.middle)) return is_deep(content.middle, hit.distance, content.reach);
    if (!(hit.distance > epsilon_ && is_far(content.middle))) look_for_far_point(content, surface);
    return false;
  }

  [[nodiscard]] bool is_below_cap(const Content& content, const Vec3& surface) const {
    const Vec3 to = content.middle - surface;
    const double a = to.norm();
    if (!(a > slack_)) return false;
    const Vec3 normal = box_.axes.transpose() * (to / a);
    const Vec3 low = content.low - content.cell.center, high = content.high - content.cell.center;
    double of_core = box_.radius;
    for (int k = 0; k < 3; ++k) of_core += std::max(normal[k] * low[k], normal[k] * high[k]);
    return Search::is_below_cap(a, content.reach,
                                std::min({normal.cwiseAbs().dot(content.cell.half), of_core,
                                          round_height(content, normal)}));
  }

  /// The point of the body above a point of its core, but for digits.
  [[nodiscard]] Vec3 point_at(const Vec3& on_core, const Vec3& direction) const {
    const double inwards = 1 - (body_.core.triangles.empty() ? 1e-12 : 1e-6);
    return box_.at(inwards * (on_core + body_radius_ * direction));
  }

  /// The most that n · (x − b) is over points x of the body in the cell, as far as its round border
  /// tells: in the coordinates in which they have one point y of the core as nearest, they are
  /// within r of it. Infinite where that says little.
  [[nodiscard]] double round_height(const Content& content, const Vec3& normal) const {
    constexpr double kDeep = 0.25;  // of the radius
    Vec3 from_core = Vec3::Zero(), across = Vec3::Zero();
    double along = 0, square = 0;
    for (int k = 0; k < 3; ++k) {
      if (content.low[k] < content.high[k]) {
        along += std::abs(normal[k]) * content.cell.half[k];
        continue;
      }
      from_core[k] = content.cell.center[k] - content.low[k];
      across[k] = normal[k];
      square += content.cell.half[k] * content.cell.half[k];
    }
    const double d = from_core.norm(), r = box_.radius;
    const double share = d > 0 ? across.dot(from_core) / d : 0;
    if (!(d > kDeep * r) || !(share > 0)) return std::numeric_limits<double>::infinity();
    const double aside = (across - share / d * from_core).norm();
    return share * (r - d) * (r + d) / (2 * d) +
           std::min(aside * std::sqrt(square) * kUp, aside * aside * d / (2 * share)) + along;
  }

  /// Whether the ball round the body about its middle is within ε: of a ball whose middle is deep
  /// in the solid, that is as much as can be said.
  [[nodiscard]] bool is_held_by_middle() const {
    const double reach = box_.half.norm() * kUp + box_.radius + slack_;
    const double away = nearest_.distance(box_.center);
    if (away + slack_ + reach <= epsilon_) return true;
    return is_inside(box_.center) && is_deep(box_.center, away, reach);
  }

  /// The point of the body in the cell that is highest above the plane at the surface, if that
  /// seems to be too far, as a witness.
  void look_for_far_point(const Content& content, const Vec3& surface) {
    const Vec3 to = content.middle - surface;
    if (!(to.norm() > slack_)) return;
    const Vec3 normal = box_.axes.transpose() * to.normalized();
    const Vec3& c = content.cell.center;
    // Of the core and of the cell's middle.
    Vec3 top, middle = c.cwiseMax(-box_.half).cwiseMin(box_.half);
    for (int k = 0; k < 3; ++k) top[k] = normal[k] > 0 ? content.high[k] : content.low[k];
    const Vec3 beside = c - middle;
    const Vec3 outwards = beside.norm() > 0 ? Vec3(beside.normalized()) : Vec3(normal);
    for (const auto& [on_core, direction] : {std::pair{top, normal}, std::pair{middle, outwards}}) {
      const Vec3 p = point_at(on_core, direction);
      if ((p - surface).norm() > epsilon_ && is_far(p)) return;
    }
  }

  static void cut(const Cell& cell, std::uint32_t face, std::vector<Cell>& open) {
    constexpr double kLong = 0.6;  // of the longest
    const double longest = cell.half.maxCoeff();
    const auto parts = [&](int k) { return cell.half[k] > kLong * longest ? 2 : 1; };
    Vec3 half = cell.half;
    for (int k = 0; k < 3; ++k) half[k] /= parts(k);
    for (int i = 0; i < 8; ++i) {
      Vec3 center = cell.center;
      bool counts = true;
      for (int k = 0; k < 3; ++k) {
        const bool upper = (static_cast<unsigned>(i) >> static_cast<unsigned>(k) & 1U) != 0;
        if (parts(k) == 2)
          center[k] += upper ? half[k] : -half[k];
        else
          counts = counts && !upper;
      }
      if (counts) open.push_back({center, half, face});
    }
  }

  const RoundedBox& box_;
  double body_radius_;
};

/// A part of a polytope.
struct Tetrahedron {
  std::array<Vec3, 4> corner;
  std::uint32_t face;  ///< near it, or NearestTriangle::kNone
};

class PolytopeSearch : private Search {
 public:
  /// @param core  of the body in the unit of the meshes
  PolytopeSearch(const MeshPair& meshes, const ConvexBody& body, const geom::Mesh& core,
                 double epsilon, const InRegion& region)
      : Search(meshes, body, 2 * largest_of(core), kFrameRounding * largest_of(core), epsilon,
               region),
        core_(core) {}

  /// Looks at the corners.
  DistanceClaim ends() {
    for (const Vec3& p : core_.vertices)
      if (is_far(p)) break;
    return out_;
  }

  DistanceClaim decide() {
    // There are three times as many, or more.
    if (!(area() < epsilon_ * epsilon_ * (static_cast<double>(kMostTetrahedra) / 3))) {
      out_.answer = Answer::Undecided;
      return out_;
    }
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : core_.vertices) middle += p / static_cast<double>(core_.vertices.size());
    std::vector<Tetrahedron> open;
    for (const geom::Triangle& t : core_.triangles)
      open.push_back({{middle, core_.vertices[t[0]], core_.vertices[t[1]], core_.vertices[t[2]]},
                      NearestTriangle::kNone});
    search(std::move(open), kMostTetrahedra,
           [&](const Tetrahedron& part, std::vector<Tetrahedron>& smaller) {
             const Vec3 b =
                 0.25 * (part.corner[0] + part.corner[1] + part.corner[2] + part.corner[3]);
             double reach = 0;
             for (const Vec3& p : part.corner) reach = std::max(reach, (p - b).norm());
             reach = reach * kUp + slack_;
             if (is_beyond_region(b, reach)) return true;
             ++out_.pieces;
             std::uint32_t face = part.face;
             if (passes(part, b, reach, face)) return true;
             if (!(reach > 8 * slack_)) return false;
             halve(part, face, smaller);
             return true;
           });
    return out_;
  }

  static double largest_of(const geom::Mesh& core) {
    double out = 0;
    for (const Vec3& p : core.vertices) out = std::max(out, p.cwiseAbs().maxCoeff());
    return out;
  }

 private:
  [[nodiscard]] double area() const {
    double out = 0;
    for (const auto& [a, b, c] : core_.triangles)
      out += 0.5 * (core_.vertices[b] - core_.vertices[a])
                       .cross(core_.vertices[c] - core_.vertices[a])
                       .norm();
    return out;
  }

  /// Whether all of the part is within ε. Refutes where a point is found.
  bool passes(const Tetrahedron& part, const Vec3& b, double reach, std::uint32_t& face) {
    const NearestTriangle::Hit hit = nearest_.nearest(b, face);
    face = hit.face;
    if (hit.distance + slack_ + reach <= epsilon_) return true;
    if (std::ranges::all_of(part.corner, [&](const Vec3& p) { return upper(p, face) <= epsilon_; }))
      return true;
    const Vec3 surface = closest(b, face), to = b - surface;
    const double a = to.norm();
    if (a > slack_) {
      double most = 0;
      for (const Vec3& p : part.corner) most = std::max(most, to.dot(p - b) / a);
      if (is_below_cap(a, reach, most)) return true;
    }
    if (is_inside(b)) return is_deep(b, hit.distance, reach);
    if (hit.distance > epsilon_ && is_far(b)) return false;
    for (const Vec3& p : part.corner)
      if ((p - surface).norm() > epsilon_ && is_far(p)) return false;
    return false;
  }

  /// At the middle of the longest side.
  static void halve(const Tetrahedron& part, std::uint32_t face,
                    std::vector<Tetrahedron>& smaller) {
    std::size_t from = 0, to = 1;
    double longest = -1;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (const double square = (part.corner[i] - part.corner[j]).squaredNorm();
            square > longest) {
          longest = square;
          from = i;
          to = j;
        }
    const Vec3 middle = 0.5 * part.corner[from] + 0.5 * part.corner[to];
    for (const std::size_t k : {from, to}) {
      Tetrahedron one{part.corner, face};
      one.corner[k] = middle;
      smaller.push_back(one);
    }
  }

  const geom::Mesh& core_;
};

/// Calls look(search) with the search of a body; nullopt where the body has none, for its size.
template <class Look>
std::optional<DistanceClaim> with_search(const MeshPair& meshes, const ConvexBody& body,
                                         double epsilon, const InRegion& region, const Look& look) {
  const ConvexBody placed = scaled(body, meshes.scale());
  if (has_facets_only(body)) {
    if (!(PolytopeSearch::largest_of(placed.core) < kMostCoordinate)) return std::nullopt;
    return look(PolytopeSearch(meshes, body, placed.core, epsilon, region));
  }
  const std::optional<RoundedBox> box = rounded_box_of(placed);
  if (!box) return std::nullopt;
  return look(RoundedBoxSearch(meshes, body, *box, epsilon, region));
}

/// What was found of several bodies.
class Claims {
 public:
  /// @param claim  of body i; nullopt: it is not decided
  void take(std::size_t i, const std::optional<DistanceClaim>& claim) {
    const std::string name = "body " + std::to_string(i);
    if (claim) {
      all_.pieces += claim->pieces;
      if (claim->largest > all_.largest) {
        all_.largest = claim->largest;
        all_.at = claim->at;
      }
      if (claim->answer == Answer::Refuted && all_.answer != Answer::Refuted) {
        all_.answer = Answer::Refuted;
        all_.reason = "a point of " + name + " is farther away";
      }
    }
    if ((claim && claim->answer != Answer::Undecided) || all_.answer != Answer::Verified) return;
    all_.answer = Answer::Undecided;
    all_.reason = "the farthest point of " + name +
                  " is as far away as that but for rounding, or it would take too many cells";
  }
  [[nodiscard]] const DistanceClaim& all() const { return all_; }

 private:
  DistanceClaim all_{Answer::Verified, "", 0, geom::Vec3::Zero(), 0, 0};
};

}  // namespace

bool have_cells(const ConvexSet& set) {
  return !set.bodies.empty() && std::ranges::all_of(set.bodies, [](const ConvexBody& body) {
    return has_facets_only(body) ? geom::is_convex(body) : rounded_box_of(body).has_value();
  });
}

DistanceClaim verify_body_excess(const ConvexSet& set, const geom::Mesh& original, double epsilon,
                                 const Region* region, double region_rounding,
                                 std::vector<std::size_t>* open) {
  const MeshPair meshes(geom::Mesh{}, original);
  DistanceClaim out;
  out.answer = Answer::Undecided;
  if (!meshes.scaled() || meshes.tree(kOutside).empty()) {
    out.reason = "the original has no triangle with an area, or its coordinates span too much";
    return out;
  }
  const InRegion in{region, region_rounding};
  std::vector<std::optional<DistanceClaim>> claims(set.bodies.size());
  // Bodies whose ends are too far refute before work is spent on others.
  verify::parallel_for(std::size_t{0}, claims.size(), [&](std::size_t i) {
    claims[i] = with_search(meshes, set.bodies[i], epsilon, in,
                            [](auto&& search) { return search.ends(); });
  });
  Claims ends, all;
  for (std::size_t i = 0; i < claims.size(); ++i) ends.take(i, claims[i]);
  if (ends.all().answer != Answer::Verified) return ends.all();
  for (std::size_t first = 0; first < set.bodies.size(); first += kBodiesAtOnce) {
    const std::size_t last = std::min(first + kBodiesAtOnce, set.bodies.size());
    verify::parallel_for(first, last, [&](std::size_t i) {
      claims[i] = with_search(meshes, set.bodies[i], epsilon, in,
                              [](auto&& search) { return search.decide(); });
    });
    for (std::size_t i = first; i < last; ++i) {
      all.take(i, claims[i]);
      if (open != nullptr && !(claims[i] && claims[i]->answer != Answer::Undecided))
        open->push_back(i);
    }
    if (all.all().answer == Answer::Refuted) break;
    if (all.all().answer != Answer::Verified && open == nullptr) break;
  }
  out = all.all();
  if (ends.all().largest > out.largest) {
    out.largest = ends.all().largest;
    out.at = ends.all().at;
  }
  return out;
}

}  // namespace kaboum::verify
