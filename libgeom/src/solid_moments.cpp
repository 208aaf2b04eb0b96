// Moments of solids whose surfaces may cross themselves. docs/algorithms/inertia.md has the proof.

#include <kaboum/base/error.h>
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/self_intersection.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "exact_integrals.h"
#include "triangle_contact.h"
#include "union_find.h"

namespace kaboum::geom {

using namespace exact_integrals;

namespace {

/// The winding number in front of a triangle, the same all over it; none: it is crossed, or not
/// found.
using Front = std::optional<int>;

/// Winding numbers in front of triangles.
class Fronts {
 public:
  explicit Fronts(const Mesh& mesh)
      : mesh_(mesh), bvh_(std::make_shared<Bvh>(mesh)), winding_(mesh, bvh_) {
    const Box3 box = bounding_box(mesh);
    near_ = 0x1p-34 * box.diagonal();
    meetings_ = meetings(mesh);
    find();
  }

  [[nodiscard]] const std::vector<Front>& of_triangles() const { return fronts_; }
  /// Triangles that meet one improperly.
  [[nodiscard]] std::vector<std::uint32_t> crossing(std::uint32_t t) const {
    std::vector<std::uint32_t> out;
    const NamedTriangle own = named(t);
    Box3 box;
    for (const Vec3& p : own.at) box.extend(p);
    bvh_->traverse([&](const Box3& other) { return overlap(box, other); },
                   [&](std::uint32_t u) {
                     if (u != t && !is_flat(u) && meet_improperly(own, named(u))) out.push_back(u);
                   });
    return out;
  }

  /// The number in front of a part of a triangle that has these corners but for rounding.
  /// @param scale  largest number that took part in computing them
  /// @param crossing  triangles that may change it; those that meet the part are put into `left`
  [[nodiscard]] Front of_part(std::uint32_t t, const std::array<Vec3, 3>& part, double scale,
                              const std::vector<std::uint32_t>& crossing,
                              std::vector<std::uint32_t>& left) const {
    Box3 box;
    for (const Vec3& p : part) box.extend(p);
    const double slack =
        0x1p-46 * std::max({box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff(), scale});
    box = {box.min.array() - slack, box.max.array() + slack};
    for (const std::uint32_t u : crossing)
      if (!is_beside(u, box)) left.push_back(u);
    return left.empty() ? look(t, part, scale) : Front();
  }

  [[nodiscard]] bool is_flat(std::uint32_t t) const { return meetings_[t] == Meeting::Flat; }

 private:
  /// Triangles that an edge joins in which no others end, and which meet others properly, have one
  /// number in front.
  void find() {
    const std::size_t count = mesh_.triangles.size();
    UnionFind patches(count);
    const std::vector<EdgeUse> uses = edge_uses(mesh_);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 2 || edge[0].forward == edge[1].forward) return;
      if (meetings_[edge[0].triangle] == Meeting::Proper &&
          meetings_[edge[1].triangle] == Meeting::Proper)
        patches.join(edge[0].triangle, edge[1].triangle);
    });
    std::vector<Front> of_patch(count);
    std::vector<int> tries(count, 0);
    for (std::uint32_t t = 0; t < count; ++t) {
      if (meetings_[t] != Meeting::Proper) continue;
      const std::uint32_t patch = patches.find(t);
      constexpr int kTries = 50;
      if (of_patch[patch] || tries[patch] >= kTries) continue;
      ++tries[patch];
      of_patch[patch] = look(t, named(t).at, 0);
    }
    fronts_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t)
      if (meetings_[t] == Meeting::Proper) fronts_[t] = of_patch[patches.find(t)];
  }

  [[nodiscard]] NamedTriangle named(std::uint32_t t) const {
    const Triangle& c = mesh_.triangles[t];
    return {c, {mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]}};
  }

  /// The number at a point beside the middle of a triangle's part, where no other triangle is near.
  /// @param part  its corners but for rounding
  /// @param scale  as of_part
  [[nodiscard]] Front look(std::uint32_t t, const std::array<Vec3, 3>& part, double scale) const {
    const auto [p, q, r] = named(t).at;
    const Vec3 normal = (q - p).cross(r - p);
    if (!(normal.norm() > 0) || !std::isfinite(normal.norm())) return {};
    const Vec3 middle = (part[0] + part[1] + part[2]) / 3,
               at = middle + normal.normalized() * (near_ / 4);
    // No other triangle meets the box, so none is between the point and the triangle's middle,
    // which is in the box for sure: the point is in front of the triangle, or behind it.
    const Box3 round{at.array() - near_, at.array() + near_};
    const double rounding = 0x1p-46 * std::max({p.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff(),
                                                r.cwiseAbs().maxCoeff(), scale});
    if (!(round.min.array() < middle.array() - rounding).all() ||
        !(middle.array() + rounding < round.max.array()).all())
      return {};
    bool alone = true;
    bvh_->traverse(
        [&](const Box3& box) {
          return alone && (box.min.array() <= round.max.array()).all() &&
                 (round.min.array() <= box.max.array()).all();
        },
        [&](std::uint32_t other) {
          if (other != t && !is_beside(other, round)) alone = false;
        });
    if (!alone) return {};
    const Sign side = orient3d(p, q, r, at);
    const std::optional<int> w = winding_(at);
    if (!w || side == Sign::Zero) return {};
    return side == Sign::Negative ? *w - 1 : *w;
  }

  /// Whether a plane separates a triangle from a box, for sure: whatever its normal is, projections
  /// on it are wrong by less than `error`.
  [[nodiscard]] bool is_beside(std::uint32_t t, const Box3& box) const {
    std::array<Vec3, 3> corner;
    double scale = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = mesh_.vertices[mesh_.triangles[t][k]];
      scale = std::max(scale, corner[k].cwiseAbs().maxCoeff());
    }
    const Vec3 half = (box.max - box.min) / 2, middle = box.min + half;
    const auto separates = [&](const Vec3& axis) {
      const double a = axis.dot(corner[0] - middle), b = axis.dot(corner[1] - middle),
                   c = axis.dot(corner[2] - middle);
      const double error = 0x1p-48 * scale * axis.cwiseAbs().sum();
      const double reach = axis.cwiseAbs().dot(half) + error;
      return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).stableNormalized();
    if (separates(Vec3::UnitX()) || separates(Vec3::UnitY()) || separates(Vec3::UnitZ()) ||
        separates(normal))
      return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (separates((corner[(k + 1) % 3] - corner[k]).stableNormalized().cross(normal)))
        return true;
    return false;
  }

  const Mesh& mesh_;
  std::shared_ptr<const Bvh> bvh_;
  WindingNumber winding_;
  std::vector<Meeting> meetings_;
  std::vector<Front> fronts_;
  double near_ = 0;
};

/// The tetrahedra of triangles with an apex.
class Cones {
 public:
  Cones(const Mesh& mesh, const Vec3& apex) : mesh_(mesh), apex_(apex) {}

  using Corners = std::array<std::array<Dyadic, 3>, 3>;

  /// A triangle, or a part of one, all of which is a border between inside and outside.
  void add(const Corners& corner) { sums_.add(corner); }

  /// One of which that is not known of any part.
  void add_unknown(const Corners& corner) {
    Sums own;
    own.add(corner);
    Range volume = own.integrals().one;
    if (volume.lower == 0) return;
    volume = volume.lower < 0 ? Range(volume.lower, 0) : Range(0, volume.upper);
    std::array<Range, 3> box;
    for (int i = 0; i < 3; ++i) {
      box[i] = Range(0);
      for (const auto& point : corner) {
        const Rational x(point[i]);
        box[i] = {std::min(box[i].lower, x), std::max(box[i].upper, x)};
      }
    }
    unknown_ += of_parts(box, volume);
    has_unknown_ = true;
  }

  /// Cut into quarters until parts are known, or small.
  void add_cut(std::uint32_t t, const Fronts& fronts) {
    add_part(t, corners(t), fronts.crossing(t), fronts, 0);
  }

  /// Relative to the apex.
  [[nodiscard]] Corners corners(std::uint32_t t) const {
    Corners out;
    for (std::size_t k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        out[k][i] = Dyadic(mesh_.vertices[mesh_.triangles[t][k]][i]) - Dyadic(apex_[i]);
    return out;
  }

  [[nodiscard]] Integrals known() const { return shifted(sums_.integrals(), apex_); }
  [[nodiscard]] Integrals unknown() const { return shifted(unknown_, apex_); }
  [[nodiscard]] bool has_unknown() const { return has_unknown_; }

 private:
  static constexpr int kCuts = 5;

  void add_part(std::uint32_t t, const Corners& corner, const std::vector<std::uint32_t>& crossing,
                const Fronts& fronts, int depth) {
    std::array<Vec3, 3> at;
    for (std::size_t k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) at[k][i] = CGAL::to_double(corner[k][i]) + apex_[i];
    std::vector<std::uint32_t> left;
    // Numbers relative to the apex are rounded: by its coordinates, however small the sums are.
    const Front front = fronts.of_part(t, at, apex_.cwiseAbs().maxCoeff(), crossing, left);
    if (front == Front(0)) add(corner);
    if (front) return;
    if (depth == kCuts) {
      add_unknown(corner);
      return;
    }
    Corners middle;  // of the sides opposite to the corners
    for (std::size_t k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        middle[k][i] = (corner[(k + 1) % 3][i] + corner[(k + 2) % 3][i]) * Dyadic(0.5);
    for (std::size_t k = 0; k < 3; ++k)
      add_part(t, {corner[k], middle[(k + 2) % 3], middle[(k + 1) % 3]}, left, fronts, depth + 1);
    add_part(t, middle, left, fronts, depth + 1);
  }

  const Mesh& mesh_;
  Vec3 apex_;
  Sums sums_;
  Integrals unknown_;
  bool has_unknown_ = false;
};

}  // namespace

Moments moments_of(const SolidMesh& solid) {
  const Mesh& mesh = solid.mesh();
  if (!solid.closed()) throw Error(ErrorCode::InvalidInput, "it is open");
  if (solid.filled_triangles() > 0) throw Error(ErrorCode::InvalidInput, "it has holes");
  const Fronts fronts(mesh);
  Cones cones(mesh, to_float32(bounding_box(mesh).center()));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (fronts.is_flat(t)) continue;
    const Front& front = fronts.of_triangles()[t];
    if (!front)
      cones.add_cut(t, fronts);
    else if (*front == 0)
      cones.add(cones.corners(t));
    // Else both its sides are inside, or both outside.
  }
  Moments out;
  out.numbers_ = std::make_shared<const Moments::Numbers>(
      Moments::Numbers{cones.known(), -cones.unknown(), cones.has_unknown()});
  return out;
}

}  // namespace kaboum::geom
