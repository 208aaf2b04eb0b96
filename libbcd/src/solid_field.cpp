// Distances to a solid: exact ones by winding numbers and a hierarchy, quick ones from a grid that
// is filled where it is asked.

#include "solid_field.h"

#include <kaboum/geom/closest_point.h>
#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kaboum::bcd {
namespace {

constexpr float kUnset = std::numeric_limits<float>::infinity();
/// Spacing of the grid, as a share of epsilon: two nodes in a body's allowance. No finer than the
/// second share of what the number of nodes gives: that costs 23 times the nodes, filled only where
/// they are asked. Where it is coarser than epsilon, a third of the bodies is misjudged.
constexpr double kSpacingOfEpsilon = 0.7, kFinest = 0.35;
/// Pits that are not deeper than the larger of these (shares of epsilon and of the spacing) need
/// no witness.
constexpr double kShallowEpsilon = 0.3, kShallowSpacing = 0.8;
/// Nodes inside are no deeper than so many spacings: what is interpolated outside has none that
/// are.
constexpr double kDeepest = 4;
/// A neighbour's value has the rounding of a float, and this covers it.
constexpr double kNeighbourUp = 1.001;
/// A root of what is below a square by this factor is below the square's root.
constexpr double kSquaredDown = 1 - 0x1p-50;
/// Above the distance of any two points that are read, and its square is finite.
constexpr double kFarthest = 1e100;

}  // namespace

SolidField::Parts::Parts(const Mesh& mesh)
    : surface(mesh),
      // No owner: both live as long as this.
      winding(mesh,
              std::shared_ptr<const geom::Bvh>(std::shared_ptr<void>(), &surface.hierarchy())),
      wide(mesh, surface.hierarchy()) {
  for (const std::uint32_t t : surface.hierarchy().order()) {
    const Triangle& v = mesh.triangles[t];
    const Vec3& a = mesh.vertices[v[0]];
    corners.push_back({a, mesh.vertices[v[1]] - a, mesh.vertices[v[2]] - a});
  }
}

SolidField::SolidField(const Mesh& mesh, std::size_t nodes, double epsilon, bool witnesses,
                       double work)
    : mesh_(mesh),
      box_(geom::bounding_box(mesh)),
      diagonal_(box_.diagonal()),
      parts_(std::make_shared<Parts>(mesh)),
      work_(work) {
  const Vec3 size = (box_.max - box_.min).cwiseMax(kFlattestGrid * diagonal_);
  const double coarse = std::cbrt(size.prod() / static_cast<double>(nodes));
  spacing_ =
      epsilon > 0 ? std::clamp(kSpacingOfEpsilon * epsilon, kFinest * coarse, coarse) : coarse;
  per_spacing_ = 1 / spacing_;
  step_ = std::max(1, static_cast<int>(2 * coarse / spacing_));
  witness_area_ = step_ * spacing_ * step_ * spacing_;
  shallow_ = std::max(kShallowEpsilon * epsilon, kShallowSpacing * spacing_);
  origin_ = box_.center() - 0.5 * size - Vec3::Constant(1.5 * spacing_);
  std::size_t total = 1;
  for (int k = 0; k < 3; ++k) {
    size_[k] = static_cast<int>(std::ceil(size[k] / spacing_)) + 4;
    total *= static_cast<std::size_t>(size_[k]);
  }
  parts_->value = std::make_unique<std::atomic<float>[]>(total);
  for (std::size_t i = 0; i < total; ++i) parts_->value[i].store(kUnset, std::memory_order_relaxed);
  if (witnesses) find_witnesses();
}

SolidField::SolidField(const SolidField& same, double work)
    : mesh_(same.mesh_),
      box_(same.box_),
      diagonal_(same.diagonal_),
      parts_(same.parts_),
      regions_(same.regions_),
      spacing_(same.spacing_),
      per_spacing_(same.per_spacing_),
      witness_area_(same.witness_area_),
      shallow_(same.shallow_),
      step_(same.step_),
      origin_(same.origin_),
      size_(same.size_),
      work_(work) {}

void SolidField::find_witnesses() {
  if (std::exchange(witnesses_found_, true)) return;
  const int step = step_;
  geom::HullBuilder hull;
  if (!hull.build(mesh_.vertices)) return;
  std::vector<std::pair<Vec3, double>> planes;
  for (const Triangle& t : hull.triangles()) {
    const Vec3& a = mesh_.vertices[t[0]];
    const Vec3 n = (mesh_.vertices[t[1]] - a).cross(mesh_.vertices[t[2]] - a);
    planes.emplace_back(n, n.dot(a));
  }
  const auto inside = [&](const Vec3& p) {
    return std::all_of(planes.begin(), planes.end(),
                       [&](const auto& plane) { return plane.first.dot(p) < plane.second; });
  };
  for (int z = step; z + step < size_[2]; z += step) {
    for (int y = step; y + step < size_[1]; y += step) {
      // Of a row of nodes, those in the hull; the ones near its ends are asked by themselves.
      const Vec3 begin = origin_ + spacing_ * Vec3(0, y, z);
      double low = 0, high = size_[0];
      for (const auto& [n, d] : planes) {
        const double slope = spacing_ * n.x(), rest = d - n.dot(begin);
        if (slope > 0) high = std::min(high, rest / slope);
        if (slope < 0) low = std::max(low, rest / slope);
      }
      for (int x = step; x + step < size_[0]; x += step) {
        if (x < low - 0.5 || x > high + 0.5) continue;
        const Vec3 p = origin_ + spacing_ * Vec3(x, y, z);
        if (!(x > low + 0.5 && x < high - 0.5) && !inside(p)) continue;
        work_.add(2000);
        const float v = node(x, y, z);
        if (v < shallow_) continue;
        const int ridges = (v >= node(x - step, y, z) && v >= node(x + step, y, z) ? 1 : 0) +
                           (v >= node(x, y - step, z) && v >= node(x, y + step, z) ? 1 : 0) +
                           (v >= node(x, y, z - step) && v >= node(x, y, z + step) ? 1 : 0);
        if (ridges >= 2) witnesses_.push_back({p, v});
      }
    }
  }
}

bool SolidField::add_witness(const Witness& witness, std::span<const Vec3> hull) {
  geom::HullBuilder builder;
  if (!builder.build(hull)) return false;
  for (const Triangle& t : builder.triangles()) {
    const Vec3& a = hull[t[0]];
    if ((hull[t[1]] - a).cross(hull[t[2]] - a).dot(witness.point - a) > 0) return false;
  }
  witnesses_.push_back(witness);
  return true;
}

bool SolidField::contains(const Vec3& p) const {
  const auto w = parts_->winding(p);
  return !w || *w >= 1;
}

bool SolidField::contains_round(const Vec3& p) const {
  const auto w = parts_->winding(p);
  return w && *w >= 1;
}

bool SolidField::triangles_near(const Box3& box, std::size_t most,
                                std::vector<std::uint32_t>& out) const {
  const auto meets = [&](const Box3& other) {
    return out.size() <= most && (other.min.array() <= box.max.array()).all() &&
           (box.min.array() <= other.max.array()).all();
  };
  parts_->surface.hierarchy().traverse(meets, [&](std::uint32_t t) {
    Box3 own;
    for (const std::uint32_t v : mesh_.triangles[t]) own.extend(mesh_.vertices[v]);
    if (meets(own) && std::find(out.begin(), out.end(), t) == out.end()) out.push_back(t);
  });
  return out.size() <= most;
}

double SolidField::rough_distance(const Vec3& p, double limit, double enough) const {
  const double near = enough > 0 ? enough * enough * kSquaredDown : -1;
  double best = limit * limit;
  const std::vector<Parts::Corner>& corners = parts_->corners;
  const geom::WideBvh& wide = parts_->wide;
  float cutoff = wide.frame().cutoff(best);
  wide.visit_near(
      p, cutoff, [&] { return best < near; },
      [&](std::uint32_t i) {
        const double d = geom::squared_distance(p, corners[i].a, corners[i].ab, corners[i].ac);
        if (!(d < best)) return;
        best = d;
        cutoff = wide.frame().cutoff(d);
      });
  return std::sqrt(best);
}

double SolidField::distance_above(double least, const Vec3& p, double guess) const {
  if (guess <= least) return guess;
  const double d = rough_distance(p, guess, least);
  // Far from the surface the field's sign is certain.
  return d > least && d < 2 * spacing_ && contains(p) ? 0 : d;
}

float SolidField::node(int x, int y, int z) const {
  const std::array<int, 3> at{x, y, z};
  const std::array<std::size_t, 3> step{
      1, static_cast<std::size_t>(size_[0]),
      static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1])};
  std::size_t index = 0;
  for (int k = 0; k < 3; ++k) index += static_cast<std::size_t>(at[k]) * step[k];
  std::atomic<float>* const value = parts_->value.get();
  const float known = value[index].load(std::memory_order_relaxed);
  if (known != kUnset) return known;
  const Vec3 p = origin_ + spacing_ * Vec3(x, y, z);
  // A neighbour whose distance exceeds the way to here is on the same side, and bounds the
  // distance.
  int side = 0;
  double limit = std::numeric_limits<double>::max();
  const auto deepest = static_cast<float>(kDeepest * spacing_);
  for (int k = 0; k < 3; ++k) {
    for (const int s : {-1, 1}) {
      if (at[k] + s < 0 || at[k] + s >= size_[k]) continue;
      const float v =
          value[s < 0 ? index - step[k] : index + step[k]].load(std::memory_order_relaxed);
      if (v == kUnset) continue;
      if (v > -deepest) limit = std::min(limit, kNeighbourUp * (std::abs(v) + spacing_));
      if (std::abs(v) > kNeighbourUp * spacing_) side = v < 0 ? -1 : 1;
    }
  }
  // The bound from a neighbour must not show in the value: it is never attained.
  if (side == 0) side = contains(p) ? -1 : 1;
  limit = std::min(limit, side < 0 ? deepest : kFarthest);
  const auto found = static_cast<float>(side * rough_distance(p, limit));
  value[index].store(found, std::memory_order_relaxed);
  parts_->computed.fetch_add(1, std::memory_order_relaxed);
  return found;
}

double SolidField::field(const Vec3& p) const {
  std::array<std::size_t, 3> cell{};
  Vec3 f, beyond;  // beyond the grid, the way to it counts as well
  for (int k = 0; k < 3; ++k) {
    const double from_origin = (p[k] - origin_[k]) * per_spacing_;
    const double x = std::clamp(from_origin, 0.0, size_[k] - 1.001);
    beyond[k] = from_origin - x;
    cell[k] = static_cast<std::size_t>(static_cast<int>(x));
    f[k] = x - static_cast<double>(static_cast<int>(x));
  }
  const std::size_t row = static_cast<std::size_t>(size_[0]);
  const std::size_t layer = row * static_cast<std::size_t>(size_[1]);
  const std::atomic<float>* first = &parts_->value[cell[0] + row * cell[1] + layer * cell[2]];
  const std::atomic<float>* const second = first + layer;
  const auto read = [](const std::atomic<float>& x) { return x.load(std::memory_order_relaxed); };
  std::array<float, 8> v{read(first[0]),       read(first[1]),       read(first[row]),
                         read(first[row + 1]), read(second[0]),      read(second[1]),
                         read(second[row]),    read(second[row + 1])};
  // Those that are not known are infinite.
  if (*std::ranges::max_element(v) == kUnset)
    for (unsigned c = 0; c < 8; ++c)
      if (v[c] == kUnset)
        v[c] =
            node(static_cast<int>(cell[0] + (c & 1U)), static_cast<int>(cell[1] + ((c >> 1U) & 1U)),
                 static_cast<int>(cell[2] + (c >> 2U)));
  const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
  const double inside = mix(mix(mix(v[0], v[1], f.x()), mix(v[2], v[3], f.x()), f.y()),
                            mix(mix(v[4], v[5], f.x()), mix(v[6], v[7], f.x()), f.y()), f.z());
  return beyond.isZero(0) ? inside : inside + spacing_ * beyond.norm();
}

void SolidField::weigh(const std::vector<geom::BoundedRegion>& regions, double epsilon) {
  regions_.clear();
  for (const geom::BoundedRegion& one : regions)
    if (one.epsilon < epsilon) regions_.push_back({one.name, one.region, epsilon / one.epsilon});
}

double SolidField::weight(std::span<const Vec3> hull) const {
  double out = 1;
  for (const geom::BoundedRegion& one : regions_)
    if (one.epsilon > out && !hull.empty() &&
        !(geom::distance_from(one.region, hull) > 1e-9 * diagonal_))
      out = one.epsilon;
  return out;
}

}  // namespace kaboum::bcd
