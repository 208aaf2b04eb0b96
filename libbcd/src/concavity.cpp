// How far a hull is from the solid, by samples: of the field on its facets and edges, and at
// witnesses of pits and cavities in it. docs/algorithms/convex-decomposition.md, "Search".

#include "concavity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "principal_box.h"

namespace kaboum::bcd {
namespace {

// About what each step takes. [ns]
constexpr std::uint64_t kPointWork = 250, kSampleWork = 80, kMeasureWork = 300;
/// No more samples along an edge.
constexpr int kMostParts = 16;
/// Points in one plane are moved to both sides of it by this share of the solid's diagonal.
constexpr double kPlateThickness = 1e-6;
/// Points are perturbed by this share of their extent.
constexpr double kPerturbation = 1e-9;
/// Distance of far_point's samples, in spacings of the grid, and the share of the limit from which
/// on the field's value is measured, for it is flat across narrow ridges.
constexpr double kFarSpacings = 1, kSuspect = 0.4;
/// So many facets are passed by in the time of a sample.
constexpr std::size_t kFacetsPerSample = 4;

/// Points in one plane, moved to both sides of it by a little.
std::vector<Vec3> thickened(std::span<const Vec3> points, double diagonal) {
  const std::optional<PrincipalBox> box = principal_box(points);
  if (!box) return {};
  const double step = kPlateThickness * diagonal;
  std::vector<Vec3> out(points.begin(), points.end());
  for (int k = 0; k < 2; ++k) {
    if (box->high[k] - box->low[k] > step) continue;
    const std::size_t size = out.size();
    for (std::size_t i = 0; i < size; ++i) {
      out.emplace_back(out[i] + step * box->axes.col(k));
      out[i] -= step * box->axes.col(k);
    }
  }
  return out;
}

/// The points moved a little, always in the same way, so that no four lie in one plane.
std::span<const Vec3> perturb(std::span<const Vec3> points) {
  static thread_local std::vector<Vec3> moved;
  Box3 extent;
  for (const Vec3& p : points) extent.extend(p);
  const double amount = kPerturbation * extent.diagonal() / 0x1p31;
  moved.resize(points.size());
  std::uint32_t state = 1;
  const auto next = [&] {
    state = state * 1664525U + 1013904223U;
    return amount * (static_cast<double>(state) - 0x1p31);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = next(), y = next(), z = next();
    moved[i] = points[i] + Vec3(x, y, z);
  }
  return moved;
}

/// A facet: a corner, and a normal with its length.
struct HullSide {
  Vec3 corner, normal;
  double length;
};

/// The field at a point of the hull where the distance is not measured yet.
using OpenPoint = std::pair<double, Vec3>;

/// Room for them, kept from one hull to the next.
std::vector<OpenPoint>& open_points() {
  static thread_local std::vector<OpenPoint> points;
  return points;
}

/// A triangle's corners in their order, the longest side between the first two.
std::array<Vec3, 3> from_longest_side(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (ab >= bc && ab >= ca) return {a, b, c};
  return bc >= ca ? std::array{b, c, a} : std::array{c, a, b};
}

/// Samples one hull. The work is told when it ends, however it does.
class Sampler {
 public:
  /// Of so many points the hull was built.
  Sampler(std::span<const Vec3> points, std::size_t built_of, const geom::HullBuilder& hull,
          const SolidField& solid, double limit, Concavity& out, const Density& density = kDense)
      : points_(points), built_of_(built_of), hull_(hull), solid_(solid), limit_(limit), out_(out) {
    for (const std::uint32_t v : hull.vertices()) box_.extend(points[v]);
    unit_ = std::max(density.spacings * solid.spacing(), box_.diagonal() / density.per_diagonal);
    open_.clear();
  }
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;
  ~Sampler() {
    solid_.work().add(kPointWork * built_of_ + kSampleWork * samples_ + kMeasureWork * measured_);
  }

  void run() {
    const Vec3 center = box_.center();
    if (limit_ < std::numeric_limits<double>::infinity()) look_at_middles();
    for (const Triangle& t : hull_.triangles()) {
      if (out_.worst > limit_) return;
      sample_facet(t, center);
    }
    look_at_witnesses();
    if (out_.worst <= limit_) measure_largest();
  }

  /// Adds what one more witness tells.
  void run_witness(const SolidField::Witness& witness) {
    std::vector<HullSide> sides;
    find_sides(sides);
    std::size_t likely = 0;
    look_at(witness, sides, likely);
    measure_largest();
  }

  /// ∫ d⁴ of each facet by itself.
  void run_facets(std::vector<FacetShare>& out) {
    what_ = What::Fourth;
    const Vec3 center = box_.center();
    for (const Triangle& t : hull_.triangles()) {
      out_.fourth = 0;
      sample_facet(t, center);
      if (out_.fourth > 0) out.push_back({t, out_.fourth});
    }
  }

  /// The volume, and ∫ d⁴ until it exceeds what is allowed for that volume.
  void run_fourth(const std::function<double(double volume)>& limit_of) {
    what_ = What::Fourth;
    const Vec3 center = box_.center();
    for (const Triangle& t : hull_.triangles()) {
      const Vec3& a = points_[t[0]];
      out_.volume += (points_[t[1]] - a).cross(points_[t[2]] - a).dot(a - center) / 6;
    }
    const double limit = limit_of(out_.volume);
    for (const Triangle& t : hull_.triangles()) {
      if (out_.fourth > limit) return;
      sample_facet(t, center);
    }
    if (out_.fourth <= limit) look_at_witnesses();
  }

 private:
  void measure(double field, const Vec3& p) {
    ++measured_;
    const double d = solid_.distance_above(out_.worst, p, field);
    if (d <= out_.worst) return;
    out_.worst = d;
    out_.at = p;
  }

  /// Where sheets and walls are thinner than the grid, the field is far above the distance: this is
  /// measured, where the field is largest first.
  void raise(const Vec3& p, double field) {
    if (field > limit_) {
      measure(field, p);
    } else {
      open_.emplace_back(field, p);
    }
  }

  void measure_largest() {
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::make_heap(open_.begin(), open_.end(), less);
    for (; !open_.empty() && open_.front().first > out_.worst; open_.pop_back()) {
      measure(open_.front().first, open_.front().second);
      std::pop_heap(open_.begin(), open_.end(), less);
    }
  }

  /// A point that stands for `share` of the area.
  void sample(const Vec3& p, double share) {
    ++samples_;
    const double d = solid_.field(p);
    if (d <= 0) return;
    out_.fourth += share * d * d * d * d;
    if (what_ == What::All) raise(p, d);
  }

  /// Most hulls that are too far are so in the middle of some facet.
  void look_at_middles() {
    for (const Triangle& t : hull_.triangles()) {
      const Vec3 middle = (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3;
      ++samples_;
      const double d = solid_.field(middle);
      if (d > limit_) measure(d, middle);
      if (out_.worst > limit_) return;
    }
  }

  [[nodiscard]] int parts_of(double length) const {
    return std::clamp(static_cast<int>(std::ceil(length / unit_)), 1, kMostParts);
  }

  void sample_facet(const Triangle& t, const Vec3& center) {
    const Vec3 &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const Vec3 ab = b - a, ac = c - a;
    const Vec3 normal = ab.cross(ac);
    const double area = 0.5 * normal.norm();
    if (what_ == What::All) out_.volume += normal.dot(a - center) / 6;
    const double longest =
        std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()}));
    if (what_ == What::All) sample_edges(t);
    // Slivers need few samples across.
    const double height = longest > 0 ? 2 * area / longest : 0;
    const int m = parts_of(longest);
    const int rows = parts_of(height);
    if (rows < m / 2) return sample_sliver(a, b, c, area, m);
    const double share = area / (m * m);
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < 2 * (m - i) - 1; ++j) {
        // Centroids of the m² similar triangles.
        const double s = (i + (j % 2 == 0 ? 1.0 : 2.0) / 3) / m;
        const int row = j / 2;
        const double r = (row + (j % 2 == 0 ? 1.0 : 2.0) / 3) / m;
        sample(a + s * ab + r * ac, share);
      }
    }
  }

  /// Pits are often widest below a hull's edge.
  void sample_edges(const Triangle& t) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] > t[(k + 1) % 3]) continue;
      const Vec3 &p = points_[t[k]], &q = points_[t[(k + 1) % 3]];
      const int parts = parts_of((q - p).norm());
      for (int i = 1; i < 2 * parts; i += 2) sample(p + (0.5 * i / parts) * (q - p), 0);
    }
  }

  /// Along the median to the longest side's ends.
  void sample_sliver(const Vec3& a, const Vec3& b, const Vec3& c, double area, int m) {
    const auto [p0, p1, top] = from_longest_side(a, b, c);
    const double share = area / m;
    for (int i = 0; i < m; ++i) {
      const Vec3 base = p0 + ((i + 0.5) / m) * (p1 - p0);
      sample(base + (top - base) / 3, share);
    }
  }

  /// Witnesses in the hull, or just beside it.
  void look_at_witnesses() {
    // The facets' normals, the one first that left out the last witness.
    static thread_local std::vector<HullSide> sides;
    sides.clear();
    if (!solid_.witnesses().empty()) find_sides(sides);
    std::size_t likely = 0;
    for (const SolidField::Witness& witness : solid_.witnesses()) look_at(witness, sides, likely);
  }

  void find_sides(std::vector<HullSide>& sides) const {
    for (const Triangle& t : hull_.triangles()) {
      const Vec3& a = points_[t[0]];
      const Vec3 normal = (points_[t[1]] - a).cross(points_[t[2]] - a);
      sides.push_back({a, normal, normal.norm()});
    }
  }

  /// @param likely  of the sides, the one that left out the last witness
  void look_at(const SolidField::Witness& witness, const std::vector<HullSide>& sides,
               std::size_t& likely) {
    const Vec3& p = witness.point;
    const double near = witness.near();
    if ((p.array() <= box_.min.array() - near).any() ||
        (p.array() >= box_.max.array() + near).any())
      return;
    double outside = 0;
    Vec3 back = Vec3::Zero();
    const auto look_from = [&](std::size_t i) {
      const auto& [a, normal, length] = sides[i];
      const double height = normal.dot(p - a);
      if (!(height > outside * length)) return false;
      outside = height / length;
      back = normal / length;
      return outside >= near;
    };
    if (look_from(likely)) return;
    outside = 0;
    std::size_t side = 0;
    while (side < sides.size() && !look_from(side)) ++side;
    samples_ += side / kFacetsPerSample + 1;
    if (side < sides.size()) {
      likely = side;
      return;
    }
    const double d = witness.distance - outside;
    out_.fourth += solid_.witness_area() * d * d * d * d;
    if (what_ == What::All) raise(p - outside * back, d);
  }

  std::span<const Vec3> points_;
  std::size_t built_of_;
  const geom::HullBuilder& hull_;
  const SolidField& solid_;
  /// What is looked for: all of Concavity, or no largest distance.
  enum class What { All, Fourth };
  What what_ = What::All;
  double limit_;
  Concavity& out_;
  Box3 box_;
  double unit_ = 0;  // between samples [length]
  std::uint64_t samples_ = 0, measured_ = 0;
  std::vector<OpenPoint>& open_ = open_points();
};

}  // namespace

std::optional<SolidField::Witness> far_point(std::span<const Vec3> points, const SolidField& solid,
                                             const geom::HullBuilder& builder, double limit) {
  const double unit = kFarSpacings * solid.spacing();
  std::optional<SolidField::Witness> out;
  std::uint64_t samples = 0, measured = 0;
  const auto look_at = [&](const Vec3& p) {
    ++samples;
    const double field = solid.field(p);
    if (field < kSuspect * limit) return false;
    ++measured;
    const double d = solid.distance_above(limit, p, std::numeric_limits<double>::max());
    if (d > limit) out = {p, d};
    return d > limit;
  };
  const auto look_at_facet = [&](const Triangle& t) {
    const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    // Rows parallel to the longest side.
    const auto [p0, p1, top] = from_longest_side(a, b, c);
    const double longest = (p1 - p0).norm();
    for (int j = 0; j < 3; ++j) {
      if (t[j] > t[(j + 1) % 3]) continue;
      const Vec3 &p = points[t[j]], &q = points[t[(j + 1) % 3]];
      const int parts = std::max(1, static_cast<int>(std::ceil((q - p).norm() / unit)));
      for (int i = 1; i < 2 * parts; i += 2)
        if (look_at(p + (0.5 * i / parts) * (q - p))) return true;
    }
    if (longest < unit) return look_at((a + b + c) / 3);
    const double height = (p1 - p0).cross(top - p0).norm() / longest;
    const int rows = std::max(1, static_cast<int>(std::ceil(height / unit)));
    for (int r = 0; r < rows; ++r) {
      const double u = (r + 0.5) / rows;
      const Vec3 q0 = p0 + u * (top - p0), q1 = p1 + u * (top - p1);
      const int m = std::max(1, static_cast<int>(std::ceil((1 - u) * longest / unit)));
      for (int i = 0; i < m; ++i)
        if (look_at(q0 + ((i + 0.5) / m) * (q1 - q0))) return true;
    }
    return false;
  };
  for (const Triangle& t : builder.triangles())
    if (look_at_facet(t)) break;
  solid.work().add(kSampleWork * samples + kMeasureWork * measured);
  return out;
}

bool spans_beyond(std::span<const Vec3> points, const SolidField& solid, double limit) {
  static const std::array<Vec3, 7> kDirections{Vec3(1, 0, 0), Vec3(0, 1, 0),  Vec3(0, 0, 1),
                                               Vec3(1, 1, 1), Vec3(-1, 1, 1), Vec3(1, -1, 1),
                                               Vec3(1, 1, -1)};
  std::array<const Vec3*, 14> extreme{};
  for (std::size_t k = 0; k < kDirections.size(); ++k) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
          return kDirections[k].dot(p) < kDirections[k].dot(q);
        });
    extreme[2 * k] = &*low;
    extreme[2 * k + 1] = &*high;
  }
  for (std::size_t i = 0; i < extreme.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 middle = 0.5 * (*extreme[i] + *extreme[j]);
      if (solid.distance_above(limit, middle, solid.field(middle)) > limit) return true;
    }
  return false;
}

namespace {

/// Builds the hull, thickened where it is flat, and has `sample` sample it.
template <class Sample>
Concavity with_hull(std::span<const Vec3> points, const SolidField& solid,
                    geom::HullBuilder& builder, bool perturbed, double limit,
                    const Density& density, Sample&& sample) {
  Concavity out;
  if (perturbed && !points.empty()) points = perturb(points);
  const std::size_t count = points.size();
  std::vector<Vec3> thick;
  out.flat = !builder.build(points);
  if (out.flat) {
    thick = thickened(points, solid.diagonal());
    points = thick;
    if (!builder.build(points)) {
      solid.work().add(kPointWork * count);
      return out;
    }
  }
  Sampler sampler(points, count, builder, solid, limit, out, density);
  sample(sampler);
  return out;
}

}  // namespace

Concavity estimate_concavity(std::span<const Vec3> points, const SolidField& solid,
                             geom::HullBuilder& builder, bool perturbed, double limit) {
  const double weight = solid.weight(points);
  Concavity out = with_hull(points, solid, builder, perturbed, limit / weight, kDense,
                            [](Sampler& sampler) { sampler.run(); });
  out.weight = weight;
  out.worst *= weight;
  return out;
}

void add_witness(std::span<const Vec3> hull, const SolidField& solid,
                 const SolidField::Witness& witness, geom::HullBuilder& builder,
                 Concavity& concavity) {
  if (concavity.flat || !builder.build(hull)) {
    concavity = estimate_concavity(hull, solid, builder);
    return;
  }
  concavity.worst /= concavity.weight;
  Sampler(hull, hull.size(), builder, solid, std::numeric_limits<double>::infinity(), concavity)
      .run_witness(witness);
  concavity.worst *= concavity.weight;
}

Concavity estimate_fourth(std::span<const Vec3> points, const SolidField& solid,
                          geom::HullBuilder& builder,
                          const std::function<double(double volume)>& limit_of,
                          const Density& density) {
  return with_hull(points, solid, builder, true, std::numeric_limits<double>::infinity(), density,
                   [&](Sampler& sampler) { sampler.run_fourth(limit_of); });
}

std::vector<FacetShare> facet_shares(std::span<const Vec3> points, const SolidField& solid,
                                     geom::HullBuilder& builder) {
  std::vector<FacetShare> out;
  const bool flat = with_hull(points, solid, builder, true, std::numeric_limits<double>::infinity(),
                              kDense, [&](Sampler& sampler) { sampler.run_facets(out); })
                        .flat;
  if (flat) out.clear();  // corners are of thickened points
  return out;
}

}  // namespace kaboum::bcd
