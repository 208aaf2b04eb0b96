// sup over S(A) of the distance to S(B): the boundary of S(A) as a surface, then space. The
// arguments are in docs/algorithms/distances.md, "Solids".
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/distance/solid.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <cmath>

#include "inflated.h"

namespace kaboum::distance {
namespace {

using geom::Box3;
using geom::kDistanceRounding;
using geom::TriangleSearch;
using geom::Vec3;

constexpr std::uint32_t kNone = TriangleSearch::kNone;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What one cut moves a corner by, times the largest coordinate.
constexpr double kCutError = geom::ConvexPolygon::kCutError;

/// A tetrahedron of space.
struct Cell {
  std::array<Vec3, 4> corner;
  double upper = kInfinity;
  std::uint32_t nearest = kNone;   ///< triangle of B, to the centre
  std::uint32_t at_worst = kNone;  ///< to the corner that is farthest from that
  int worst = 0;                   ///< that corner
  int cuts = 0;                    ///< that any corner went through
  bool far = false;                ///< small beside its distance from B
  bool few = false;                ///< there are not many triangles near it

  [[nodiscard]] Vec3 center() const {
    return 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
  }
};

struct Finding {
  double lower = 0;
  Vec3 at = Vec3::Zero();
  double upper = 0;   ///< if decided
  bool open = false;  ///< needs to be cut
};

/// Splits a cell at weight w of the edge from corner i to corner j.
std::array<Cell, 2> split(const Cell& cell, int i, int j, double w) {
  std::array<Cell, 2> out{cell, cell};
  const Vec3 x = cell.corner[i] + w * (cell.corner[j] - cell.corner[i]);
  out[0].corner[j] = x;
  out[1].corner[i] = x;
  for (Cell& c : out) ++c.cuts;
  return out;
}

void halve(const Cell& cell, std::vector<Cell>& out) {
  int from = 0, to = 1;
  double longest = -1;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (const double d = (cell.corner[j] - cell.corner[i]).squaredNorm(); d > longest) {
        longest = d;
        from = i;
        to = j;
      }
  for (const Cell& half : split(cell, from, to, 0.5)) out.push_back(half);
}

/// Cuts along a plane, edge by edge, given the corners' heights above it.
void cut_along(const Cell& cell, std::array<double, 4> height, double on, std::vector<Cell>& out) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (!(height[i] < -on && height[j] > on)) continue;
      const std::array<Cell, 2> parts = split(cell, i, j, height[i] / (height[i] - height[j]));
      std::array<double, 4> first = height, second = height;
      first[j] = 0;
      second[i] = 0;
      cut_along(parts[0], first, on, out);
      cut_along(parts[1], second, on, out);
      return;
    }
  out.push_back(cell);
}

/// @return false if the plane leaves the cell whole.
bool cut_by_plane(const Cell& cell, const Vec3& p, const Vec3& n, std::vector<Cell>& out) {
  std::array<double, 4> height{};
  double highest = 0;
  for (int i = 0; i < 4; ++i) {
    height[i] = n.dot(cell.corner[i] - p);
    highest = std::max(highest, std::abs(height[i]));
  }
  const double on = 1e-6 * highest;  // no splinters
  if (!(*std::min_element(height.begin(), height.end()) < -on) ||
      !(*std::max_element(height.begin(), height.end()) > on))
    return false;
  cut_along(cell, height, on, out);
  return true;
}

/// Directions towards all of which some vector points.
class HalfSpace {
 public:
  /// A vector u must have u·direction > least, or u·normal < −kNormalError.
  struct Demand {
    Vec3 direction, normal;
    double least;
    bool by_direction;  ///< the one to begin with
  };
  std::vector<Demand> demands;

  /// Looks for u by Gilbert's iteration towards the point of the directions' hull that is nearest
  /// to the origin.
  [[nodiscard]] bool exists() const {
    const auto aim = [](const Demand& d) -> Vec3 {
      return d.by_direction ? Vec3(d.direction.normalized()) : Vec3(-d.normal.normalized());
    };
    Vec3 z = Vec3::Zero();
    for (const Demand& d : demands) z += aim(d);
    z /= static_cast<double>(demands.size());
    for (int step = 0; step < kSteps; ++step) {
      const double length = z.norm();
      if (!(length > 1e-3)) return false;
      const Vec3 u = z / length;
      const Demand* worst = nullptr;
      double smallest = kInfinity;
      bool all = true;
      for (const Demand& d : demands) {
        if (u.dot(d.direction) > d.least || u.dot(d.normal) < -kNormalError) continue;
        all = false;
        if (const double along = u.dot(aim(d)); along < smallest) {
          smallest = along;
          worst = &d;
        }
      }
      if (all) return true;
      const Vec3 toward = aim(*worst) - z;
      const double square = toward.squaredNorm();
      if (!(square > 0)) return false;
      z += std::clamp(-z.dot(toward) / square, 0.0, 1.0) * toward;
    }
    return false;
  }

 private:
  static constexpr int kSteps = 12;
  static constexpr double kNormalError = 1e-14;
};

class Volume {
 public:
  Volume(const Solid& a, const Solid& b, const TriangleSearch& to_a, const TriangleSearch& to_b,
         const geom::DistanceOptions& options, SolidDistance& result)
      : a_(a), b_(b), to_a_(to_a), to_b_(to_b), options_(options), result_(result) {
    box_ = to_a.box();
    box_.min.array() -= a.margin() * (1 + 1e-15);
    box_.max.array() += a.margin() * (1 + 1e-15);
    magnitude_ = box_.min.cwiseAbs().cwiseMax(box_.max.cwiseAbs()).maxCoeff();
    Box3 all = to_a.box();  // as in the wish: without the margin
    all.extend(to_b.box());
    diagonal_ = all.diagonal();
    for (const std::array<Vec3, 3>& f : b.boundary().facet) {
      const Vec3 u = f[1] - f[0], v = f[2] - f[0];
      const double size = u.norm() * v.norm();
      normals_.push_back(size > 0 ? Vec3(u.cross(v) / size) : Vec3::Zero());
    }
  }

  /// Raises result's lower bound. @return an upper bound of the distance at local maxima inside A.
  double run() {
    std::vector<Cell> open = first_cells();
    for (int round = 1;; ++round) {
      evaluate(open);
      if (open.empty()) break;
      if (round > kMaxRounds || open.size() > kMaxOpen || result_.cells > kMaxCells) {
        for (const Cell& c : open) decided_ = std::max(decided_, c.upper);
        break;
      }
      std::vector<Cell> next;
      next.reserve(3 * open.size());
      for (const Cell& c : open) cut(c, round, next);
      open = std::move(next);
    }
    return decided_;
  }

 private:
  static constexpr int kMaxRounds = 250;
  static constexpr std::size_t kMaxOpen = std::size_t{1} << 20;
  static constexpr std::uint64_t kMaxCells = std::uint64_t{1} << 22;
  static constexpr std::size_t kMostNear = 400, kFew = 24;

  /// The box in six tetrahedra about a diagonal.
  [[nodiscard]] std::vector<Cell> first_cells() const {
    std::vector<Cell> out;
    std::array<int, 3> axes{0, 1, 2};
    do {
      Cell cell;
      Vec3 p = box_.min;
      cell.corner[0] = p;
      for (int k = 0; k < 3; ++k) {
        p[axes[k]] = box_.max[axes[k]];
        cell.corner[k + 1] = p;
      }
      out.push_back(cell);
    } while (std::next_permutation(axes.begin(), axes.end()));
    return out;
  }

  [[nodiscard]] double limit() const { return options_.wished(result_.max_lower, diagonal_); }

  void evaluate(std::vector<Cell>& cells) {
    std::vector<Finding> findings(cells.size());
    const double enough = limit();
    parallel_ranges(cells.size(), {.grain = 32}, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> near;
      HalfSpace half_space;
      for (std::size_t i = begin; i != end; ++i)
        findings[i] = look_at(cells[i], enough, near, half_space);
    });
    result_.cells += cells.size();
    for (const Finding& f : findings)
      if (f.lower > result_.max_lower) {
        result_.max_lower = f.lower;
        result_.at = f.at;
        result_.inside = true;
      }
    const double now = limit();  // the lower bound may have risen
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (findings[i].open && cells[i].upper > now)
        cells[kept++] = cells[i];
      else
        decided_ = std::max(decided_, findings[i].open ? cells[i].upper : findings[i].upper);
    }
    cells.resize(kept);
  }

  [[nodiscard]] double upper_to(const Vec3& p, std::uint32_t triangle) const {
    const auto& [a, b, c] = to_b_.corners(triangle);
    return geom::point_triangle_upper(p, a, b, c);
  }

  /// Largest distance of the corners from a triangle of B, which no point of the cell exceeds.
  std::pair<double, int> worst_corner(const Cell& cell, std::uint32_t triangle) const {
    double worst = -1;
    int where = 0;
    for (int i = 0; i < 4; ++i)
      if (const double d = upper_to(cell.corner[i], triangle); d > worst) {
        worst = d;
        where = i;
      }
    return {worst, where};
  }

  /// A point of S(A) that is not in S(B), at a distance that would be news.
  void consider(Finding& finding, const Vec3& p, double distance) const {
    if (distance <= std::max(result_.max_lower, finding.lower)) return;
    if (b_.contains(p, distance) != std::optional(false)) return;
    if (a_.contains(p) != std::optional(true)) {
      const auto at = to_a_.nearest(p);
      if (a_.contains(p, at.lower) != std::optional(true) &&
          !(at.upper + a_.boundary().error <= a_.margin()))
        return;
    }
    finding.lower = distance;
    finding.at = p;
  }

  Finding look_at(Cell& cell, double enough, std::vector<std::uint32_t>& near,
                  HalfSpace& half_space) const {
    Finding finding;
    const double moved = cell.cuts * kCutError * magnitude_;
    const auto decided = [&](double upper) {
      finding.upper = upper;
      return finding;
    };
    // What was near the cell that this one was cut from may decide it.
    for (const std::uint32_t t : {cell.nearest, cell.at_worst})
      if (t != kNone) {
        cell.upper = std::min(cell.upper, worst_corner(cell, t).first + moved);
        if (cell.upper <= enough) return decided(cell.upper);
      }
    const Vec3 c = cell.center();
    double radius = 0;
    for (const Vec3& p : cell.corner) radius = std::max(radius, (p - c).norm());
    radius = radius * (1 + kDistanceRounding) + moved;
    const auto at = to_b_.nearest(c, cell.nearest);
    cell.nearest = cell.at_worst = at.triangle;
    cell.far = radius < 0.5 * at.lower;
    cell.upper = std::min(cell.upper, (at.upper + radius) * (1 + kDistanceRounding));
    const auto [worst, where] = worst_corner(cell, at.triangle);
    cell.worst = where;
    cell.upper = std::min(cell.upper, worst + moved);
    if (cell.upper <= enough) return decided(cell.upper);
    if (b_.covers_ball(c, radius, at.lower)) return decided(0);
    if (outside_a(c, radius)) return decided(0);
    // Lower maxima than that there may be.
    if (has_no_maximum(cell, c, radius, at.upper, enough, near, half_space)) return decided(enough);
    consider(finding, c, at.lower);
    if (cell.far) {
      const Vec3& corner = cell.corner[where];
      const auto at_corner = to_b_.nearest(corner, at.triangle);
      consider(finding, corner, at_corner.lower);
      if (at_corner.triangle != at.triangle) {
        cell.at_worst = at_corner.triangle;
        cell.upper = std::min(cell.upper, worst_corner(cell, at_corner.triangle).first + moved);
      }
    }
    if (cell.upper <= enough) return decided(cell.upper);
    finding.open = true;
    return finding;
  }

  /// Whether the ball holds no point of S(A).
  [[nodiscard]] bool outside_a(const Vec3& c, double radius) const {
    const double cutoff = radius + a_.margin() + a_.boundary().error;
    const auto at = to_a_.nearest(c);
    return at.lower > cutoff * (1 + kDistanceRounding) &&
           a_.contains(c, at.lower) == std::optional(false);
  }

  /// Whether the ball certainly holds no point outside S(B) that is a local maximum of the distance
  /// from S(B): there is a direction in which all triangles that can be nearest to such a point
  /// recede.
  bool has_no_maximum(Cell& cell, const Vec3& c, double radius, double distance, double enough,
                      std::vector<std::uint32_t>& near, HalfSpace& half_space) const {
    const double error = b_.boundary().error;
    const double cutoff = (distance + 2 * radius + 2 * error) * (1 + kDistanceRounding);
    cell.few = b_.near(c, cutoff, kMostNear, near);
    if (!cell.few) return false;
    cell.few = near.size() <= kFew;
    half_space.demands.clear();
    for (const std::uint32_t t : near) {
      const auto& corners = to_b_.corners(t);
      const auto d = to_b_.to_triangle(c, t);
      if (d.lower > cutoff || !can_be_nearest(cell, c, t, cutoff, enough)) continue;
      const Vec3 v = geom::nearest_point(c, corners[0], corners[1], corners[2]) - c;
      double scale = c.cwiseAbs().maxCoeff();
      for (const Vec3& p : corners) scale = std::max(scale, p.cwiseAbs().maxCoeff());
      const double slack = 4 * kDistanceRounding * scale;
      const double length = v.norm() * (1 + kDistanceRounding) + slack;
      const double turn = std::sqrt(std::max(0.0, length * length - d.lower * d.lower));
      const double least = radius + error + 2 * std::sqrt(error * (length + radius + error)) +
                           slack + turn + 1e-14 * length;
      half_space.demands.push_back({v, normals_[t], least, length > 2 * least});
    }
    return half_space.demands.empty() || half_space.exists();
  }

  /// Whether triangle t may hold the nearest point to a point of the cell that is outside S(B) and
  /// more than `enough` away from it: the point is above t, by more than that, or t's exposed sides
  /// or corners are within cutoff.
  [[nodiscard]] bool can_be_nearest(const Cell& cell, const Vec3& c, std::uint32_t t, double cutoff,
                                    double enough) const {
    const auto& p = to_b_.corners(t);
    const unsigned exposed = b_.exposed(t);
    for (int k = 0; k < 3; ++k) {
      if ((exposed >> k & 1U) != 0 &&
          geom::point_triangle_distance(c, p[k], p[(k + 1) % 3], p[(k + 1) % 3]).lower <= cutoff)
        return true;
      if ((exposed >> (3 + k) & 1U) != 0 && (p[k] - c).norm() * (1 - kDistanceRounding) <= cutoff)
        return true;
    }
    // Heights above the plane of the facet that t is a part of.
    const auto& facet = b_.boundary().facet[t];
    const Vec3 u = facet[1] - facet[0], v = facet[2] - facet[0], n = u.cross(v);
    const double length = n.norm(), sine = length / (u.norm() * v.norm());
    if (!(sine > 1e-6)) return true;  // a sliver has no reliable normal
    double highest = -kInfinity, size = 0;
    for (const Vec3& x : cell.corner) {
      highest = std::max(highest, n.dot(x - facet[0]) / length);
      size = std::max(size, (x - facet[0]).cwiseAbs().maxCoeff());
    }
    const double slack = cell.cuts * kCutError * magnitude_ + b_.boundary().error +
                         size * 4 * kDistanceRounding / sine;
    return highest + slack >= enough;
  }

  /// Cuts between two competing planes, along the prism of the nearest triangle, or in two.
  void cut(const Cell& cell, int round, std::vector<Cell>& out) const {
    if (cell.far && round % 3 != 0) {
      if (round % 3 == 1 ? cut_by_bisector(cell, out) || cut_by_prism(cell, out)
                         : cut_by_prism(cell, out) || cut_by_bisector(cell, out))
        return;
    }
    // At an edge of S(B) planes of its sides tell the parts of space apart.
    if (!cell.far && cell.few && round % 2 == 0 && cut_by_facet(cell, out)) return;
    halve(cell, out);
  }

  bool cut_by_facet(const Cell& cell, std::vector<Cell>& out) const {
    for (const std::uint32_t t : {cell.nearest, cell.at_worst}) {
      const auto& p = to_b_.corners(t);
      const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]);
      if (n.norm() > 0 && cut_by_plane(cell, p[0], n.normalized(), out)) return true;
    }
    return false;
  }

  bool cut_by_bisector(const Cell& cell, std::vector<Cell>& out) const {
    if (cell.at_worst == cell.nearest) return false;
    const auto plane = geom::bisector(to_b_.corners(cell.nearest), to_b_.corners(cell.at_worst),
                                      cell.center(), 1e-12);
    return plane && cut_by_plane(cell, plane->point, plane->normal, out);
  }

  /// Cuts along the side of the nearest triangle's prism that the worst corner is farthest beyond.
  bool cut_by_prism(const Cell& cell, std::vector<Cell>& out) const {
    const auto& t = to_b_.corners(cell.nearest);
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    int side = -1;
    double farthest = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 outward = (t[(k + 1) % 3] - t[k]).cross(n);
      const double length = outward.norm();
      if (!(length > 0)) return false;
      const double beyond = outward.dot(cell.corner[cell.worst] - t[k]) / length;
      if (beyond > farthest) {
        farthest = beyond;
        side = k;
      }
    }
    if (side < 0) return false;
    return cut_by_plane(cell, t[side], (t[(side + 1) % 3] - t[side]).cross(n).normalized(), out);
  }

  const Solid &a_, &b_;
  const TriangleSearch &to_a_, &to_b_;
  const geom::DistanceOptions& options_;
  SolidDistance& result_;
  std::vector<Vec3> normals_;  // of B's facets, the sine of their corner in length
  Box3 box_;
  double magnitude_ = 0;
  double diagonal_ = 0;
  double decided_ = 0;
};

/// Levels of subdivision of the ball that stands for a margin.
constexpr int kFirstLevel = 2, kLastLevel = 6;

/// The boundary of S(A) when A has a margin: the distance of points of A without it, enlarged by
/// the margin, bounds it above, which is tight where B is convex; polytopes inside the bodies with
/// their margin bound it below, and above by what they lack.
geom::DirectedDistance distance_with_margin(const Solid& a, const Solid& b,
                                            const TriangleSearch& boundary_a,
                                            const TriangleSearch& boundary_b, double diagonal,
                                            geom::DistanceOptions options) {
  options.relative_gap *= 0.45;
  options.absolute_gap *= 0.45;
  geom::DistanceOptions bare = options;
  bare.offset = std::max(0.0, options.offset - a.margin());
  geom::DirectedDistance best = geom::directed_distance(boundary_a, boundary_b, bare, &b);
  best.max_upper = (best.max_upper + a.margin()) * (1 + 1e-15);
  options.relative_gap *= 2;  // of what both uses of it leave
  options.absolute_gap *= 2;
  for (int level = kFirstLevel; level <= kLastLevel; ++level) {
    if (best.max_upper <= options.wished(best.max_lower, diagonal)) break;
    const Inflated polytopes = inflate(a.set(), level);
    geom::DistanceOptions half = options;
    half.relative_gap *= 0.5;
    half.absolute_gap *= 0.5;
    const geom::DirectedDistance d =
        geom::directed_distance(verify::sum_of(polytopes.polytopes), boundary_b, half, &b);
    best.queries += d.queries;
    best.max_upper = std::min(best.max_upper, d.max_upper + polytopes.defect);
    if (const double lower = d.max_lower - polytopes.excess; lower > best.max_lower) {
      best.max_lower = lower;
      best.at = d.at;
    }
  }
  return best;
}

}  // namespace

SolidDistance solid_distance(const Solid& a, const Solid& b, const TriangleSearch& boundary_a,
                             const TriangleSearch& boundary_b,
                             const geom::DistanceOptions& options) {
  SolidDistance result;
  // A little finer than allowed: the boundaries that are measured stand for the true ones.
  geom::DistanceOptions finer = options;
  finer.relative_gap *= 0.99;
  finer.absolute_gap *= 0.99;
  finer.offset = b.margin();
  Box3 box = boundary_a.box();
  box.extend(boundary_b.box());
  static_cast<geom::DirectedDistance&>(result) =
      a.margin() > 0 ? distance_with_margin(a, b, boundary_a, boundary_b, box.diagonal(), finer)
                     : geom::directed_distance(boundary_a, boundary_b, finer, &b);
  const double inside = Volume(a, b, boundary_a, boundary_b, finer, result).run();
  const double error = a.boundary().error + b.boundary().error;
  result.max_upper = std::max({result.max_upper, inside, result.max_lower}) + error;
  result.max_lower = std::max(0.0, result.max_lower - error);
  geom::DistanceOptions wish = options;
  wish.offset = b.margin();
  result.within_gap =
      result.max_upper <= wish.wished(result.max_lower, box.diagonal()) * (1 + 1e-15);
  // B's margin, and polytopes that stand for bodies.
  const double defect = a.defect() + b.defect();
  result.max_lower = std::max(0.0, result.max_lower - b.margin() - defect);
  result.max_upper = std::max(0.0, result.max_upper - b.margin() + defect);
  if (defect > 0)
    result.within_gap = result.max_upper <= options.wished(result.max_lower, box.diagonal());
  return result;
}

}  // namespace kaboum::distance
