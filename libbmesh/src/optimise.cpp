// Vertices are moved towards the original and edges flipped, by steps that are certified against
// it. docs/algorithms/bounding-mesh.md, "Steps against the original".

#include "optimise.h"

#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>

namespace kaboum::bmesh {
namespace {

/// A step must lower the energy by this share at least: those that gain less take most of the time,
/// and nothing is lost without them.
constexpr double kGain = 0.02;
/// Share of the way to the best place that a vertex goes at a time: if each went all the way, the
/// first ones would leave their neighbours no room.
constexpr double kDamping = 0.5;
/// Placements tried for a vertex, each with what the one before cut off the original as constraint.
constexpr int kAttempts = 5;

double area(const std::array<Vec3, 3>& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

}  // namespace

Vec3 Optimiser::rounding(const Vec3& p) const {
  if (options_.precision == Precision::Double)
    return Vec3::Constant(std::numeric_limits<double>::epsilon() * p.cwiseAbs().maxCoeff());
  return {geom::float32_spacing(p.x()), geom::float32_spacing(p.y()), geom::float32_spacing(p.z())};
}

Optimiser::Optimiser(WorkingMesh& mesh, VertexNotes& notes, SampledError& sampled,
                     ReferenceSolid* solid, const geom::Mesh& original,
                     ErrorBoundCertificate* certificate, const DecimateOptions& options,
                     DecimateStatistics& statistics, std::vector<Step>* steps)
    : m_(mesh),
      notes_(notes),
      sampled_(sampled),
      solid_(solid),
      original_(original),
      certificate_(certificate),
      options_(options),
      statistics_(statistics),
      steps_(steps),
      mark_(mesh.position.size() + mesh.mesh.size(), 0),
      support_(options.direction == Direction::Inner ? -1 : 1) {}

void Optimiser::disturb(std::uint32_t v) {
  notes_.disturb(v);
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : m_.mesh[t]) notes_.disturb(w);
  });
}

bool Optimiser::gather(std::uint32_t v) {
  ring_.clear();
  removed_.clear();
  points_.clear();
  if (m_.border[v] != 0) return false;
  m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
    const geom::Triangle& tri = m_.mesh[t];
    ring_.push_back({t, tri[(k + 1) % 3], tri[(k + 2) % 3]});
    removed_.push_back(t);
  });
  return ring_.size() >= 3;
}

/// The star of the vertex at `apex`, and the points at which it is measured, which remember where
/// the original was near before.
void Optimiser::place_star(const Vec3& apex) {
  added_.clear();
  points_.resize(ring_.size() * (dense_ ? 5 : 2) + 1);
  auto next = points_.begin();
  const auto put = [&](const Vec3& position, double weight, double share) {
    next->position = position, next->weight = weight, next->share = share;
    ++next;
  };
  double total = 0;
  for (const Ring& r : ring_) {
    const NewTriangle t{r.triangle, {apex, m_.position[r.p], m_.position[r.q]}};
    added_.push_back(t);
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

/// Exact: no tetrahedron between a triangle that goes and `to` cuts into the original. Where one
/// does, the parts cut off become constraints in support_, whose triangle i belongs to removed[i]
/// if `own`.
bool Optimiser::does_not_cut_original(std::span<const std::uint32_t> removed, bool own,
                                      const Vec3& to) {
  bool all = true;
  for (std::size_t i = 0; i < removed.size(); ++i) {
    met_.clear();
    if (certified(removed[i], to, &met_)) continue;
    all = false;
    const geom::Triangle& c = m_.mesh[removed[i]];
    const std::array<Vec3, 4> tetrahedron{m_.position[c[0]], m_.position[c[1]], m_.position[c[2]],
                                          to};
    for (const std::uint32_t t : met_) {
      const geom::Triangle& tri = original_.triangles[t];
      support_.keep(
          own ? i : SupportPlanes::kNearest, tetrahedron,
          {original_.vertices[tri[0]], original_.vertices[tri[1]], original_.vertices[tri[2]]});
    }
  }
  return all;
}

std::optional<Vec3> Optimiser::place_against_original(std::span<const std::uint32_t> removed,
                                                      std::span<const NewTriangle> added,
                                                      const Quadric& quadric, const Vec3& origin) {
  apex_ = added.front().corner[0];
  added_.assign(added.begin(), added.end());
  support_.assign(added_);
  if (options_.direction != Direction::Any)
    sampled_.for_each_assignment(removed, added_,
                                 [&](std::size_t i, const Vec3& o) { support_.keep(i, o); });
  objective_ = quadric;
  const Vec3 linear = quadric.half_gradient(apex_ - origin);
  objective_.bx = linear.x(), objective_.by = linear.y(), objective_.bz = linear.z();
  return next_place();
}

std::optional<Vec3> Optimiser::next_place() {
  support_.half_spaces(rounding(apex_), planes_);
  const auto step = minimise(objective_, {objective_.bx, objective_.by, objective_.bz}, planes_,
                             kRegularisationDistance);
  if (!step) return std::nullopt;
  Vec3 to = apex_ + *step;
  if (options_.precision == Precision::Float) to = geom::to_float32(to);
  if (!to.allFinite()) return std::nullopt;
  return to;
}

bool Optimiser::is_certified(std::span<const std::uint32_t> removed, const Vec3& to) {
  const bool spared = does_not_cut_original(removed, false, to);
  if (!spared) ++statistics_.rejected_original;
  return spared;
}

/// Squared distances of the samples and of the points, which are located, linear in the
/// displacement of v at the apex, weighted by how far they are: (d / scale)².
void Optimiser::linearise(const Vec3& apex, double scale, double penalty) {
  objective_ = {};
  Vec3 b = Vec3::Zero();
  const double sign = options_.direction == Direction::Inner ? -1 : 1;
  const auto add = [&](const Vec3& n, double lambda, double residual, double weight) {
    double w = weight * (sampled_.power() == 4 ? residual * residual / scale + 1e-4 : 1);
    if (sign * residual < 0) w *= penalty;
    const Vec3 g = lambda * n;
    objective_.xx += w * g.x() * g.x(), objective_.xy += w * g.x() * g.y();
    objective_.xz += w * g.x() * g.z(), objective_.yy += w * g.y() * g.y();
    objective_.yz += w * g.y() * g.z(), objective_.zz += w * g.z() * g.z();
    b += w * residual * g;
  };
  for (const Ring& r : ring_) {
    const Vec3 &p = m_.position[r.p], &q = m_.position[r.q];
    const Vec3& n = m_.normal[r.triangle];
    const Vec3 across = n.cross(q - p);
    const double height = across.dot(apex - p);
    if (!(height > 0)) continue;
    // A point o of the original is n·(apex − o) below the triangle, at barycentric weight λ.
    sampled_.for_each_sample(r.triangle, [&](const Vec3& o, double weight) {
      const double lambda = std::clamp(across.dot(o - p) / height, 0.0, 1.0);
      add(n, lambda, n.dot(apex - o), weight);
    });
  }
  for (const SampledError::Point& p : points_) {
    const auto c = sampled_.original().corners(p.nearest);
    const Vec3 offset = p.position - closest_point(p.position, c[0], c[1], c[2]);
    double d = offset.norm();
    if (offset.dot((c[1] - c[0]).cross(c[2] - c[0])) < 0) d = -d;
    if (d != 0) add(offset / d, p.share, d, p.weight);
  }
  objective_.bx = b.x(), objective_.by = b.y(), objective_.bz = b.z();
}

bool Optimiser::folds(const Vec3& to) const {
  return std::any_of(ring_.begin(), ring_.end(), [&](const Ring& r) {
    const Vec3 n = (m_.position[r.p] - to).cross(m_.position[r.q] - to);
    const double along = n.dot(m_.normal[r.triangle]);
    return !(along > 0) || along * along < 0.03 * n.squaredNorm();
  });
}

/// Exact: the tetrahedron between triangle t and the point leaves the original's solid alone;
/// inwards, it also lies in it.
bool Optimiser::certified(std::uint32_t t, const Vec3& to, std::vector<std::uint32_t>* met) {
  if (options_.direction == Direction::Any) return true;
  const geom::Triangle& tri = m_.mesh[t];
  const Vec3 &a = m_.position[tri[0]], &b = m_.position[tri[1]], &c = m_.position[tri[2]];
  ++statistics_.predicates;
  const geom::Sign side = geom::orient3d(a, b, c, to, &statistics_.exact_fallbacks);
  const bool inner = options_.direction == Direction::Inner;
  const geom::Sign wrong = inner ? geom::Sign::Positive : geom::Sign::Negative;
  if (side == geom::Sign::Zero || (side != wrong && !inner)) return true;
  return solid_->contains({a, b, c, to}, inner, met);
}

/// Exact, for inner meshes: triangles of added_, whose apex is `to`, in the planes of those whose
/// indices they take keep their orientation, and cannot cancel.
bool Optimiser::stays_flat(const Vec3& to) {
  if (options_.direction != Direction::Inner) return true;
  flat_.clear();
  for (const NewTriangle& n : added_) {
    const geom::Triangle& tri = m_.mesh[n.index];
    const std::array<Vec3, 3> old{m_.position[tri[0]], m_.position[tri[1]], m_.position[tri[2]]};
    if (geom::orient3d(old[0], old[1], old[2], to) != geom::Sign::Zero) continue;
    if (!same_orientation(old, n.corner)) return false;
    flat_.push_back(m_.normal[n.index]);
  }
  return !opposed(flat_);
}

/// Carries out the move of v that removed_ and added_ describe.
void Optimiser::move(std::uint32_t v, const Vec3& to) {
  sampled_.commit(removed_, added_);
  m_.position[v] = to;
  m_.update_normals_around(v);
  if (steps_ != nullptr) steps_->push_back({v, v, to});
  ++statistics_.pull_backs;
}

bool Optimiser::pull_back(std::uint32_t v, bool alone) {
  if (notes_.movable[v] == 0 || !gather(v)) return false;
  notes_.movable[v] = 0;
  const Vec3 from = m_.position[v];
  place_star(from);
  std::uint32_t& hint = notes_.hint[v];
  const auto before =
      sampled_.energy(removed_, added_, points_, hint, std::numeric_limits<double>::infinity());
  if (!(before.squared > 0)) return false;
  linearise(from, before.squared);
  support_.assign(added_);
  if (options_.direction != Direction::Any)
    for (std::size_t i = 0; i < ring_.size(); ++i)
      sampled_.for_each_sample(ring_[i].triangle,
                               [&](const Vec3& o, double) { support_.keep(i, o); });
  const double goal = (1 - kGain) * before.sum;
  Vec3 refused = from;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    support_.half_spaces(rounding(from), planes_);
    const auto step = minimise(objective_, {objective_.bx, objective_.by, objective_.bz}, planes_,
                               kRegularisationDistance);
    if (!step) return false;
    Vec3 to = from + kDamping * *step;
    if (options_.precision == Precision::Float) to = geom::to_float32(to);
    if (to == from || !to.allFinite()) return false;
    place_star(to);
    const auto after = sampled_.energy(removed_, added_, points_, hint, goal);
    if (folds(to) || !(after.sum < goal)) {
      // Linearised too boldly, perhaps.
      to = from + 0.5 * kDamping * *step;
      if (options_.precision == Precision::Float) to = geom::to_float32(to);
      if (to == from || folds(to)) return false;
      place_star(to);
      if (!(sampled_.energy(removed_, added_, points_, hint, goal).sum < goal)) return false;
    }
    if (to == refused || !stays_flat(to)) return false;
    if (!does_not_cut_original(removed_, true, to)) {
      ++statistics_.rejected_original;
      refused = to;
      continue;
    }
    if (alone && certificate_ != nullptr) {
      if (!certificate_->admits(removed_, added_)) {
        ++statistics_.rejected_distance;
        return false;
      }
      certificate_->commit(removed_);
    }
    move(v, to);
    disturb(v);
    return true;
  }
  return false;
}

bool Optimiser::flip(std::uint32_t a, std::uint32_t b) {
  // The two triangles (a, b, c) and (b, a, d) of a manifold edge.
  std::uint32_t first = 0, second = 0, c = 0, d = 0;
  int forward = 0, backward = 0;
  m_.mesh.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) {
    const geom::Triangle& tri = m_.mesh[t];
    if (tri[(k + 1) % 3] == b) {
      ++forward;
      first = t;
      c = tri[(k + 2) % 3];
    }
    if (tri[(k + 2) % 3] == b) {
      ++backward;
      second = t;
      d = tri[(k + 1) % 3];
    }
  });
  if (forward != 1 || backward != 1 || c == d) return false;
  bool joined = false;
  m_.mesh.for_each_triangle(c, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : m_.mesh[t]) joined = joined || w == d;
  });
  if (joined) return false;
  const Vec3 &pa = m_.position[a], &pb = m_.position[b], &pc = m_.position[c], &pd = m_.position[d];
  // Neither new triangle may turn over.
  const Vec3 mean = m_.normal[first] + m_.normal[second];
  for (const Vec3& n : {Vec3((pd - pa).cross(pc - pa)), Vec3((pb - pd).cross(pc - pd))}) {
    const double along = n.dot(mean);
    if (!(along > 0) || along * along < 0.03 * n.squaredNorm() * mean.squaredNorm()) return false;
  }
  const auto measure = [&](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s,
                           double limit) {
    // Triangles (p, q, r) and (q, p, s) on the edge (p, q).
    added_.clear();
    added_.push_back({first, {p, q, r}});
    added_.push_back({second, {q, p, s}});
    const double a1 = area(added_[0].corner), a2 = area(added_[1].corner);
    points_.clear();
    points_.push_back({0.5 * (p + q), (a1 + a2) / 3});
    points_.push_back({(p + q + r) / 3.0, a1 / 2});
    points_.push_back({(q + p + s) / 3.0, a2 / 2});
    return sampled_.energy(removed_, added_, points_, notes_.hint[a], limit);
  };
  removed_.assign({first, second});
  const auto before = measure(pa, pb, pc, pd, std::numeric_limits<double>::infinity());
  // (a, d, c) and (d, b, c) are (d, c, a) and (c, d, b).
  const double limit = (1 - kGain) * before.sum;
  const auto after = measure(pd, pc, pa, pb, limit);
  if (!(after.sum < limit)) return false;
  if (!certified(first, pd) || !stays_flat(pd)) {
    ++statistics_.rejected_original;
    return false;
  }
  if (certificate_ != nullptr) {
    if (!certificate_->admits(removed_, added_)) {
      ++statistics_.rejected_distance;
      return false;
    }
    certificate_->commit(removed_);
  }
  sampled_.commit(removed_, added_);
  m_.mesh.replace(first, {d, c, a});
  m_.mesh.replace(second, {c, d, b});
  m_.update_normal(first);
  m_.update_normal(second);
  if (steps_ != nullptr) steps_->push_back(Step::flip(a, b, c, d));
  ++statistics_.flips;
  for (const std::uint32_t v : {a, b, c, d}) notes_.disturb(v);
  return true;
}

}  // namespace kaboum::bmesh
