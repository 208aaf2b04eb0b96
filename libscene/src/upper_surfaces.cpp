// Level faces that look up, and their convex parts that nothing covers.

#include "upper_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace kaboum::scene {
namespace {

/// Share of a body, seen from above, that is level within ε if its top is.
constexpr double kMostOfBody = 0.9;
/// A level face that has this share of a top is the top.
constexpr double kFaceOfTop = 0.5;
/// Share of a set's size: faces of which no corner is so far from a plane are in it.
constexpr double kSamePlane = 0.5e-6;
/// Share of a set's size: corners that are so near to the line of their neighbours are left out.
constexpr double kStraight = 1e-6;
/// Parts of less than that share of the largest one's area in a plane are left out.
constexpr double kSmallPart = 0.01;
/// Scenes take no more corners of a surface.
constexpr std::size_t kMostCorners = 256;

/// Area that counts as nothing.
double least_area(const Faces& faces) { return kNothing * faces.size() * faces.size(); }

/// A body's top as one level face, if it is level within ε.
std::optional<Face> level_top(const Faces& faces, std::size_t body, const Vec3& up) {
  const geom::ConvexBody& of = faces.set().body(body);
  const double epsilon = faces.set().epsilon();
  double high = -std::numeric_limits<double>::infinity();
  for (const Vec3& v : of.core.vertices) high = std::max(high, up.dot(v));
  Face out{body, up, high + of.radius, {}};
  const Axes axes(up);
  Polygon2 all;
  all.reserve(of.core.vertices.size());
  for (const Vec3& v : of.core.vertices) {
    all.push_back(axes(v));
    if (up.dot(v) >= high - epsilon) out.corners.push_back(v + (out.offset - up.dot(v)) * up);
  }
  const Polygon2 top = flattened(out, axes);
  const double area = centroid_of(top).area;
  if (!(area > least_area(faces)) || area < kMostOfBody * centroid_of(convex_hull(all)).area ||
      !(centroid_of(eroded(top, epsilon)).area > least_area(faces)))
    return std::nullopt;
  return out;
}

double area_of(const Face& face) { return centroid_of(flattened(face, Axes(face.normal))).area; }

/// The two sides of a line through an edge of a polygon.
struct Halves {
  Polygon2 inside, outside;
};

Halves halves_of(const Polygon2& polygon, const Polygon2& by, std::size_t edge) {
  const Vec2 &a = by[edge], &b = by[(edge + 1) % by.size()];
  return {left_of(polygon, a, b - a), left_of(polygon, a, a - b)};
}

/// The area of a polygon outside of others.
double area_outside(const Polygon2& polygon, const std::vector<Polygon2>& of, std::size_t first,
                    double least) {
  const double area = centroid_of(polygon).area;
  if (!(area > least) || first == of.size()) return area;
  if (!(centroid_of(common_part(polygon, of[first])).area > least))
    return area_outside(polygon, of, first + 1, least);
  double out = 0;
  Polygon2 rest = polygon;
  for (std::size_t i = 0; i < of[first].size() && centroid_of(rest).area > least; ++i) {
    Halves halves = halves_of(rest, of[first], i);
    out += area_outside(halves.outside, of, first + 1, least);
    if (out > least) return out;  // enough to know
    rest = std::move(halves.inside);
  }
  return out;
}

/// Faces of one plane, two of which are one where all of them hold what is between them.
std::vector<Polygon2> merged(std::vector<Polygon2> parts, double least) {
  const std::vector<Polygon2> all = parts;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size();) {
      Polygon2 both = parts[i];
      both.insert(both.end(), parts[j].begin(), parts[j].end());
      both = convex_hull(std::move(both));
      if (area_outside(both, all, 0, least) > least) {
        ++j;
        continue;
      }
      parts[i] = std::move(both);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  return parts;
}

/// Convex parts of polygons that nothing covers.
class Uncovered {
 public:
  Uncovered(std::vector<Polygon2> covers, double inset, double least)
      : covers_(std::move(covers)), inset_(inset), least_(least) {}

  /// Adds the parts of a polygon that are outside of all covers, and of what was added before.
  void add(Polygon2 polygon) {
    std::vector<Polygon2> open{std::move(polygon)};
    while (!open.empty()) {
      Polygon2 part = std::move(open.back());
      open.pop_back();
      if (!is_wide(part)) continue;
      const std::size_t largest = largest_cover(part);
      if (largest == covers_.size()) {
        found_.push_back(part);
        covers_.push_back(std::move(part));
        continue;
      }
      // Most is left on one side of an edge; the cover is on the other one.
      Halves best;
      double most = -1;
      for (std::size_t i = 0; i < covers_[largest].size(); ++i) {
        Halves halves = halves_of(part, covers_[largest], i);
        const double area = centroid_of(halves.outside).area;
        if (area > most) {
          most = area;
          best = std::move(halves);
        }
      }
      if (!(most > least_)) continue;  // all of it is covered
      open.push_back(std::move(best.inside));
      open.push_back(std::move(best.outside));
    }
  }

  [[nodiscard]] const std::vector<Polygon2>& found() const { return found_; }

 private:
  [[nodiscard]] bool is_wide(const Polygon2& part) const {
    return centroid_of(part).area > least_ && centroid_of(eroded(part, inset_)).area > least_;
  }

  /// What covers most of a polygon; the number of covers: nothing does.
  [[nodiscard]] std::size_t largest_cover(const Polygon2& part) const {
    std::size_t out = covers_.size();
    double most = least_;
    for (std::size_t i = 0; i < covers_.size(); ++i) {
      const double area = centroid_of(common_part(part, covers_[i])).area;
      if (!(area > most)) continue;
      most = area;
      out = i;
    }
    return out;
  }

  std::vector<Polygon2> covers_;
  double inset_, least_;
  std::vector<Polygon2> found_;
};

/// A polygon without corners that are almost on the line of their neighbours: a part of it.
Polygon2 with_few_corners(Polygon2 polygon, double within) {
  for (std::size_t i = 0; i < polygon.size() && polygon.size() > 3;) {
    const std::size_t n = polygon.size();
    const Vec2 &a = polygon[(i + n - 1) % n], &b = polygon[(i + 1) % n];
    const double length = (b - a).norm();
    if (length <= within || std::abs(cross(b - a, polygon[i] - a)) <= within * length)
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
    else
      ++i;
  }
  return polygon.size() > kMostCorners ? with_few_corners(std::move(polygon), 2 * within) : polygon;
}

UpperSurface surface_of(const Face& leader, const Axes& axes, const Polygon2& polygon) {
  UpperSurface out;
  const auto place = [&](const Vec2& p) -> Vec3 {
    return p.x() * axes.u + p.y() * axes.v + leader.offset * leader.normal;
  };
  for (const Vec2& corner : polygon) out.outline.push_back(place(corner));
  const Centroid middle = centroid_of(polygon);
  out.middle = place(middle.place);
  out.normal = leader.normal;
  out.area = middle.area;
  return out;
}

}  // namespace

std::vector<Face> level_faces(const Faces& faces, const Vec3& up) {
  std::vector<Face> out;
  for (std::size_t body = 0; body < faces.set().size(); ++body) {
    std::vector<Face> own;
    for (const Face& face : faces.all())
      if (face.body == body && face.normal.dot(up) > 0 &&
          face.normal.cross(up).norm() <= kParallel && area_of(face) > least_area(faces))
        own.push_back(face);
    if (std::optional<Face> top = level_top(faces, body, up)) {
      double area = 0;
      for (const Face& face : own) area += area_of(face);
      if (area < kFaceOfTop * area_of(*top)) own = {std::move(*top)};
    }
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

std::vector<UpperSurface> upper_surfaces(const Faces& faces, std::vector<Face> level,
                                         double inset) {
  const double least = least_area(faces);
  std::ranges::stable_sort(
      level, [](const Face& a, const Face& b) { return area_of(a) > area_of(b) * (1 + kNothing); });
  std::vector<UpperSurface> out;
  while (!level.empty()) {
    // The faces that are in the plane of the largest one.
    const Face leader = level.front();
    const Axes axes(leader.normal);
    std::vector<Polygon2> parts;
    std::erase_if(level, [&](const Face& face) {
      const bool same = std::ranges::all_of(face.corners, [&](const Vec3& corner) {
        return std::abs(leader.normal.dot(corner) - leader.offset) <= kSamePlane * faces.size();
      });
      if (same) parts.push_back(flattened(face, axes));
      return same;
    });
    Uncovered uncovered(faces.covers(leader, axes), inset, least);
    parts = merged(std::move(parts), least);
    std::ranges::stable_sort(parts, [](const Polygon2& a, const Polygon2& b) {
      return centroid_of(a).area > centroid_of(b).area * (1 + kNothing);
    });
    for (Polygon2& part : parts) uncovered.add(std::move(part));
    std::vector<Polygon2> kept;
    double largest = 0;
    for (const Polygon2& part : uncovered.found()) {
      kept.push_back(with_few_corners(eroded(part, inset), kStraight * faces.size()));
      largest = std::max(largest, centroid_of(kept.back()).area);
    }
    for (const Polygon2& part : kept)
      if (centroid_of(part).area > std::max(least, kSmallPart * largest))
        out.push_back(surface_of(leader, axes, part));
  }
  std::ranges::stable_sort(out, [](const UpperSurface& a, const UpperSurface& b) {
    return a.area > b.area * (1 + kNothing);
  });
  return out;
}

bool is_on(const UpperSurface& surface, const Vec3& point, double within) {
  if (std::abs(surface.normal.dot(point - surface.middle)) > within) return false;
  for (std::size_t i = 0; i < surface.outline.size(); ++i) {
    const Vec3& a = surface.outline[i];
    const Vec3 edge = surface.outline[(i + 1) % surface.outline.size()] - a;
    if (surface.normal.dot(edge.cross(point - a)) < -within * edge.norm()) return false;
  }
  return true;
}

}  // namespace kaboum::scene
