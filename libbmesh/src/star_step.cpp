// The step at hand of an optimiser: what goes and what comes, where that is
// measured, and the exact certificate against the original.
// docs/algorithms/bounding-mesh.md, "Steps against the original".

#include "star_step.h"

#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>

namespace kaboum::bmesh {

/// Samples that are near weigh at least so much against the farthest: without any weight, vertices
/// would drift where all is near.
constexpr double kLeastWeight = 1e-4;

double area(const std::array<Vec3, 3>& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

StarStep::StarStep(WorkingMesh& mesh, SampledError& sampled, ReferenceSolid* solid,
                   const geom::Mesh& original, const DecimateOptions& options,
                   DecimateStatistics& statistics, std::vector<Step>* steps)
    : support(options.direction == Direction::Inner ? -1 : 1),
      m_(mesh),
      sampled_(sampled),
      solid_(solid),
      original_(original),
      options_(options),
      statistics_(statistics),
      steps_(steps) {}

Vec3 StarStep::rounding(const Vec3& p) const {
  if (options_.precision == Precision::Double)
    return Vec3::Constant(std::numeric_limits<double>::epsilon() * p.cwiseAbs().maxCoeff());
  return {geom::float32_spacing(p.x()), geom::float32_spacing(p.y()), geom::float32_spacing(p.z())};
}

bool StarStep::gather(std::uint32_t v) {
  ring.clear();
  removed.clear();
  points.clear();
  if (m_.border[v] != 0) return false;
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
    const geom::Triangle& tri = m_.mesh[t];
    ring.push_back({t, tri[(k + 1) % 3], tri[(k + 2) % 3]});
    removed.push_back(t);
  });
  return ring.size() >= 3;
}

/// The star of the vertex at `apex`, and the points at which it is measured,
/// which remember where the original was near before.
void StarStep::place_star(const Vec3& apex) {
  added.clear();
  points.resize(ring.size() * (dense_ ? 5 : 2) + 1);
  auto next = points.begin();
  const auto put = [&](const Vec3& position, double weight, double share) {
    next->position = position, next->weight = weight, next->share = share;
    ++next;
  };
  double total = 0;
  for (const Ring& r : ring) {
    const NewTriangle t{r.triangle, {apex, m_.position[r.p], m_.position[r.q]}};
    added.push_back(t);
    const double a = area(t.corner);
    total += a;
    put((apex + t.corner[1]) * 0.5, a / 3, 0.5);
    put((apex + t.corner[1] + t.corner[2]) / 3.0, dense_ ? a / 8 : a / 2, 1.0 / 3);
    if (!dense_) continue;
    for (int k = 0; k < 3; ++k)
      put(t.corner[k] * (2.0 / 3) + (t.corner[(k + 1) % 3] + t.corner[(k + 2) % 3]) / 6, a / 8,
          k == 0 ? 2.0 / 3 : 1.0 / 6);
  }
  put(apex, total / 6, 1);
}

void StarStep::look_around_star(const Vec3& apex, std::uint32_t& hint) {
  double size = 0;
  for (const Ring& r : ring) size = std::max(size, (m_.position[r.p] - apex).squaredNorm());
  // The other points are no farther from the apex than two thirds of that, or little more.
  sampled_.gather(apex, std::sqrt(size) + std::sqrt(sampled_.locate(points.back(), hint)),
                  vicinity);
}

/// Exact: no tetrahedron between a triangle that goes and `to` cuts into the
/// original. Where one does, the parts cut off become constraints in support,
/// whose triangle i belongs to gone[i] if `own`.
bool StarStep::does_not_cut_original(std::span<const std::uint32_t> gone, bool own,
                                     const Vec3& to) {
  bool all = true, looked = false;
  const bool inner = options_.direction == Direction::Inner;
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (!may_cut_original(gone[i], to)) continue;
    if (!looked) look_around(gone, to);
    looked = true;
    const Tetrahedron tetrahedron = between(gone[i], to);
    if (solid_->contains(tetrahedron, inner, &met_, around_)) continue;
    all = false;
    for (const std::uint32_t t : met_) {
      const geom::Triangle& tri = original_.triangles[t];
      support.keep(
          own ? i : SupportPlanes::kNearest, tetrahedron,
          {original_.vertices[tri[0]], original_.vertices[tri[1]], original_.vertices[tri[2]]});
    }
  }
  return all;
}

/// The planes of the star at hand, and beyond them the original near its
/// triangles, become constraints.
void StarStep::bound_by_star() {
  support.assign(added);
  if (options_.direction == Direction::Any) return;
  for (std::size_t i = 0; i < ring.size(); ++i)
    sampled_.for_each_sample(ring[i].triangle, [&](const Vec3& o, double) { support.keep(i, o); });
}

std::optional<Vec3> StarStep::place_against_original(std::span<const std::uint32_t> gone,
                                                     std::span<const NewTriangle> come,
                                                     const Quadric& quadric, const Vec3& origin) {
  apex_ = come.front().corner[0];
  added.assign(come.begin(), come.end());
  support.assign(added);
  if (options_.direction != Direction::Any)
    sampled_.for_each_assignment(gone, added,
                                 [&](std::size_t i, const Vec3& o) { support.keep(i, o); });
  objective = quadric;
  const Vec3 linear = quadric.half_gradient(apex_ - origin);
  objective.bx = linear.x(), objective.by = linear.y(), objective.bz = linear.z();
  return next_place();
}

std::optional<Vec3> StarStep::next_place() {
  support.half_spaces(rounding(apex_), planes);
  const auto step = minimise(objective, {objective.bx, objective.by, objective.bz}, planes,
                             kRegularisationDistance);
  if (!step) return std::nullopt;
  Vec3 to = apex_ + *step;
  if (options_.precision == Precision::Float) to = geom::to_float32(to);
  if (!to.allFinite()) return std::nullopt;
  return to;
}

bool StarStep::is_certified(std::span<const std::uint32_t> gone, const Vec3& to) {
  const bool spared = does_not_cut_original(gone, false, to);
  if (!spared) ++statistics_.rejected_original;
  return spared;
}

/// Squared distances of the samples and of the points, which are located,
/// linear in the displacement of v at the apex, weighted by how far they are:
/// (d / scale)².
void StarStep::linearise(const Vec3& apex, double scale, double penalty) {
  objective = {};
  Vec3 b = Vec3::Zero();
  const double sign = options_.direction == Direction::Inner ? -1 : 1;
  const auto add = [&](const Vec3& n, double lambda, double residual, double weight) {
    double w = weight * (sampled_.power() == 4 ? residual * residual / scale + kLeastWeight : 1);
    if (sign * residual < 0) w *= penalty;
    const Vec3 g = lambda * n;
    objective.xx += w * g.x() * g.x(), objective.xy += w * g.x() * g.y();
    objective.xz += w * g.x() * g.z(), objective.yy += w * g.y() * g.y();
    objective.yz += w * g.y() * g.z(), objective.zz += w * g.z() * g.z();
    b += w * residual * g;
  };
  for (const Ring& r : ring) {
    const Vec3 &p = m_.position[r.p], &q = m_.position[r.q];
    const Vec3& n = m_.normal[r.triangle];
    const Vec3 across = n.cross(q - p);
    const double height = across.dot(apex - p);
    if (!(height > 0)) continue;
    // A point o of the original is n·(apex − o) below the triangle, at
    // barycentric weight λ.
    sampled_.for_each_sample(r.triangle, [&](const Vec3& o, double weight) {
      const double lambda = std::clamp(across.dot(o - p) / height, 0.0, 1.0);
      add(n, lambda, n.dot(apex - o), weight);
    });
  }
  for (const SampledError::Point& p : points) {
    const auto c = sampled_.original().corners(p.nearest);
    const Vec3 offset = p.position - closest_point(p.position, c[0], c[1], c[2]);
    double d = offset.norm();
    if (offset.dot((c[1] - c[0]).cross(c[2] - c[0])) < 0) d = -d;
    if (d != 0) add(offset / d, p.share, d, p.weight);
  }
  objective.bx = b.x(), objective.by = b.y(), objective.bz = b.z();
}

bool StarStep::folds(const Vec3& to) const {
  return std::any_of(ring.begin(), ring.end(), [&](const Ring& r) {
    const Vec3 n = (m_.position[r.p] - to).cross(m_.position[r.q] - to);
    return bmesh::folds(m_.normal[r.triangle], n);
  });
}

/// The tetrahedron of triangle t and the point.
Tetrahedron StarStep::between(std::uint32_t t, const Vec3& to) const {
  const geom::Triangle& tri = m_.mesh[t];
  return {m_.position[tri[0]], m_.position[tri[1]], m_.position[tri[2]], to};
}

/// Exact: whether the tetrahedron between triangle t and the point has volume and, outwards, is on
/// the wrong side of t.
bool StarStep::may_cut_original(std::uint32_t t, const Vec3& to) {
  if (options_.direction == Direction::Any) return false;
  const auto [a, b, c, d] = between(t, to);
  ++statistics_.predicates;
  const geom::Sign side = geom::orient3d(a, b, c, d, &statistics_.exact_fallbacks);
  return side == geom::Sign::Negative ||
         (side == geom::Sign::Positive && options_.direction == Direction::Inner);
}

/// around_ holds all tetrahedra between the triangles and the point, and not many times their box.
void StarStep::look_around(std::span<const std::uint32_t> gone, const Vec3& to) {
  geom::Box3 box;
  box.extend(to);
  for (const std::uint32_t t : gone)
    for (const std::uint32_t v : m_.mesh[t]) box.extend(m_.position[v]);
  if (!around_.hold(box)) solid_->look_around(box, around_);
}

/// Exact: the tetrahedron between triangle t and the point leaves the
/// original's solid alone; inwards, it also lies in it.
bool StarStep::certified(std::uint32_t t, const Vec3& to) {
  return !may_cut_original(t, to) ||
         solid_->contains(between(t, to), options_.direction == Direction::Inner);
}

/// Exact, for inner meshes: triangles of added, whose apex is `to`, in the
/// planes of those whose indices they take keep their orientation, and cannot
/// cancel.
bool StarStep::stays_flat(const Vec3& to) {
  if (options_.direction != Direction::Inner) return true;
  flat_.clear();
  for (const NewTriangle& n : added) {
    const geom::Triangle& tri = m_.mesh[n.index];
    const std::array<Vec3, 3> old{m_.position[tri[0]], m_.position[tri[1]], m_.position[tri[2]]};
    if (geom::orient3d(old[0], old[1], old[2], to) != geom::Sign::Zero) continue;
    if (!same_orientation(old, n.corner)) return false;
    flat_.push_back(m_.normal[n.index]);
  }
  return !opposed(flat_);
}

/// Carries out the move of v that removed and added describe.
void StarStep::move(std::uint32_t v, const Vec3& to) {
  sampled_.commit(removed, added);
  m_.position[v] = to;
  m_.update_normals_around(v);
  if (steps_ != nullptr) steps_->push_back({v, v, to});
  ++statistics_.pull_backs;
}

}  // namespace kaboum::bmesh
