#include "part.h"

#include "planar.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace kaboum::examples {
namespace {

using Point = std::array<std::int64_t, 3>;  // multiples of 1e-7 m
using Path = std::vector<Point>;

constexpr std::int64_t kMillimetre = 10'000;

/// A polyline's consecutive parts put together; the points where they meet are kept once.
Path join(std::initializer_list<Path> parts) {
  Path result;
  for (const Path& part : parts) {
    for (const Point& p : part) {
      if (result.empty() || result.back() != p) result.push_back(p);
    }
  }
  return result;
}

Path reversed(Path path) {
  std::reverse(path.begin(), path.end());
  return path;
}

Path shifted(Path path, int axis, std::int64_t by) {
  for (Point& p : path) p[axis] += by;
  return path;
}

/// Collects triangles; corners with equal coordinates are one vertex.
class Builder {
 public:
  void triangle(const Point& a, const Point& b, const Point& c, bool flip) {
    const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c);
    triangles_.push_back(flip ? geom::Triangle{i, k, j} : geom::Triangle{i, j, k});
  }

  /// Quads between two paths of equal length; normal = direction of the path × (to − from).
  void strip(const Path& from, const Path& to, bool flip) {
    for (std::size_t i = 0; i + 1 < from.size(); ++i) {
      if ((i % 2 == 0) == flip) {
        triangle(from[i], from[i + 1], to[i + 1], flip);
        triangle(from[i], to[i + 1], to[i], flip);
      } else {
        triangle(from[i], from[i + 1], to[i], flip);
        triangle(from[i + 1], to[i + 1], to[i], flip);
      }
    }
  }

  /// The path moved along an axis through the given coordinates.
  void sweep(const Path& path, int axis, const Path& stations, bool flip) {
    for (std::size_t j = 0; j + 1 < stations.size(); ++j) {
      strip(shifted(path, axis, stations[j][axis] - path[0][axis]),
            shifted(path, axis, stations[j + 1][axis] - path[0][axis]), flip);
    }
  }

  /// A planar face across `axis`; the first loop is the outer one, all are closed paths that run
  /// counter-clockwise in the plane (y, z), (x, z) or (x, y).
  void face(int axis, const std::vector<Path>& loops, double spacing, bool flip) {
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    std::vector<Loop> planar;
    for (const Path& path : loops) {
      Loop loop;
      for (std::size_t i = 0; i + 1 < path.size(); ++i) loop.push_back({path[i][u], path[i][v]});
      if (!planar.empty()) std::reverse(loop.begin(), loop.end());
      planar.push_back(std::move(loop));
    }
    const PlanarMesh mesh = triangulate(planar, spacing);
    Path points;
    for (const GridPoint& g : mesh.points) {
      Point p = loops[0][0];
      p[u] = g.x;
      p[v] = g.y;
      points.push_back(p);
    }
    for (const auto& t : mesh.triangles) triangle(points[t[0]], points[t[1]], points[t[2]], flip);
  }

  [[nodiscard]] geom::Mesh mesh() && {
    geom::Mesh result;
    result.triangles = std::move(triangles_);
    for (const Point& p : points_) {
      // One correctly rounded division: the double nearest to the decimal number.
      result.vertices.emplace_back(static_cast<double>(p[0]) / 1e7, static_cast<double>(p[1]) / 1e7,
                                   static_cast<double>(p[2]) / 1e7);
    }
    return result;
  }

 private:
  std::uint32_t vertex(const Point& p) {
    const auto [it, added] = index_.emplace(p, static_cast<std::uint32_t>(points_.size()));
    if (added) points_.push_back(p);
    return it->second;
  }

  std::map<Point, std::uint32_t> index_;
  Path points_;
  std::vector<geom::Triangle> triangles_;
};

/// Subdivision of lines and arcs; the same points whichever way a line is run.
class Drawing {
 public:
  explicit Drawing(int resolution)
      : resolution_(resolution),
        spacing_(static_cast<std::int64_t>(264.0 * kMillimetre / resolution)) {}

  [[nodiscard]] double spacing() const { return static_cast<double>(spacing_); }

  [[nodiscard]] Path line(const Point& a, const Point& b) const {
    if (b < a) return reversed(line(b, a));
    double square = 0;
    for (int k = 0; k < 3; ++k) square += static_cast<double>((b[k] - a[k]) * (b[k] - a[k]));
    const auto count = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(std::ceil(std::sqrt(square) / spacing())));
    Path path;
    for (std::int64_t i = 0; i <= count; ++i) {
      Point p;
      for (int k = 0; k < 3; ++k) p[k] = a[k] + (b[k] - a[k]) * i / count;
      path.push_back(p);
    }
    return path;
  }

  /// Polyline through the corners.
  [[nodiscard]] Path lines(std::initializer_list<Point> corners) const {
    Path path;
    const Point* previous = nullptr;
    for (const Point& corner : corners) {
      if (previous != nullptr) path = join({path, line(*previous, corner)});
      previous = &corner;
    }
    return path;
  }

  /// Arc of `quarters` quarter turns from the angle `start` (in quarters), counter-clockwise in the
  /// plane of the axes u and v.
  [[nodiscard]] Path arc(const Point& centre, int u, int v, std::int64_t radius, int start,
                         int quarters) const {
    const int count = std::max(2 * quarters, resolution_ * quarters / 4);
    Path path;
    for (int i = 0; i <= count; ++i) {
      const double angle =
          (start + static_cast<double>(quarters) * i / count) * std::numbers::pi / 2;
      Point p = centre;
      p[u] += std::llround(static_cast<double>(radius) * std::cos(angle));
      p[v] += std::llround(static_cast<double>(radius) * std::sin(angle));
      path.push_back(p);
    }
    return path;
  }

  [[nodiscard]] Path circle(const Point& centre, int u, int v, std::int64_t radius) const {
    Path path = arc(centre, u, v, radius, 0, 4);
    path.back() = path.front();
    return path;
  }

  /// Stadium across x: two half circles about centre ± half_length along z, and the lines between.
  [[nodiscard]] Path slot(const Point& centre, std::int64_t half_length,
                          std::int64_t radius) const {
    const Path upper = arc({centre[0], centre[1], centre[2] + half_length}, 1, 2, radius, 0, 2);
    const Path lower = arc({centre[0], centre[1], centre[2] - half_length}, 1, 2, radius, 2, 2);
    return join(
        {upper, line(upper.back(), lower.front()), lower, line(lower.back(), upper.front())});
  }

 private:
  int resolution_;
  std::int64_t spacing_;
};

}  // namespace

geom::Mesh make_bracket(int resolution) {
  if (resolution < kMinBracketResolution || resolution > kMaxBracketResolution) {
    throw Error(ErrorCode::InvalidArgument, "the resolution must be from " +
                                                std::to_string(kMinBracketResolution) + " to " +
                                                std::to_string(kMaxBracketResolution));
  }
  constexpr std::int64_t mm = kMillimetre;
  constexpr std::int64_t length = 200 * mm, width = 120 * mm, height = 140 * mm;
  constexpr std::int64_t base = 8 * mm, wall = 4 * mm;  // thicknesses
  constexpr std::int64_t bend = 10 * mm, fillet = 8 * mm;
  constexpr std::int64_t base_corner = 20 * mm, wall_corner = 24 * mm;
  constexpr std::int64_t rib0 = 56 * mm, rib1 = 64 * mm;  // the rib's sides, y
  constexpr std::int64_t rib_x = 95 * mm, rib_z = 80 * mm, rib_tip = 4 * mm;
  constexpr std::int64_t in_x = wall + fillet, in_z = base + fillet;  // where the fillet ends
  constexpr std::int64_t base_end = length - base_corner, wall_end = height - wall_corner;

  const Drawing draw(resolution);
  const double spacing = draw.spacing();
  Builder part;

  const Path across = draw.line({0, 0, 0}, {0, width, 0});
  const Path base_up = draw.line({0, 0, 0}, {0, 0, base});
  const Path wall_through = draw.line({0, 0, 0}, {wall, 0, 0});

  // Cross-section, plane (x, z), y = 0.
  const Path outer_bend = draw.arc({bend, 0, bend}, 0, 2, bend, 2, 1);
  const Path inner_fillet = draw.arc({in_x, 0, in_z}, 0, 2, fillet, 2, 1);
  const Path section =
      join({draw.lines({{bend, 0, 0}, {base_end, 0, 0}, {base_end, 0, base}, {in_x, 0, base}}),
            reversed(inner_fillet),
            draw.lines({{wall, 0, in_z}, {wall, 0, wall_end}, {0, 0, wall_end}, {0, 0, bend}}),
            outer_bend});
  part.face(1, {section}, spacing, false);
  part.face(1, {shifted(section, 1, width)}, spacing, true);
  part.sweep(outer_bend, 1, across, true);
  part.sweep(inner_fillet, 1, draw.line({0, 0, 0}, {0, rib0, 0}), false);
  part.sweep(inner_fillet, 1, draw.line({0, rib1, 0}, {0, width, 0}), false);

  // Rounded ends of base and wall.
  const Path base_rim =
      join({draw.arc({base_end, base_corner, 0}, 0, 1, base_corner, 3, 1),
            draw.line({length, base_corner, 0}, {length, width - base_corner, 0}),
            draw.arc({base_end, width - base_corner, 0}, 0, 1, base_corner, 0, 1)});
  const Path wall_rim = join({draw.arc({0, width - wall_corner, wall_end}, 1, 2, wall_corner, 0, 1),
                              draw.line({0, width - wall_corner, height}, {0, wall_corner, height}),
                              draw.arc({0, wall_corner, wall_end}, 1, 2, wall_corner, 1, 1)});
  part.sweep(base_rim, 2, base_up, false);
  part.sweep(wall_rim, 0, wall_through, false);

  // Planar faces, to be given their holes.
  std::vector<Path> bottom{
      join({draw.line({bend, 0, 0}, {base_end, 0, 0}), base_rim,
            draw.lines({{base_end, width, 0}, {bend, width, 0}, {bend, 0, 0}})})};
  std::vector<Path> top{
      join({draw.line({in_x, 0, base}, {base_end, 0, base}), shifted(base_rim, 2, base),
            draw.lines({{base_end, width, base},
                        {in_x, width, base},
                        {in_x, rib1, base},
                        {rib_x, rib1, base},
                        {rib_x, rib0, base},
                        {in_x, rib0, base},
                        {in_x, 0, base}})})};
  std::vector<Path> back{join({draw.lines({{0, 0, bend}, {0, width, bend}, {0, width, wall_end}}),
                               wall_rim, draw.line({0, 0, wall_end}, {0, 0, bend})})};
  std::vector<Path> front{
      join({draw.lines({{wall, 0, in_z},
                        {wall, rib0, in_z},
                        {wall, rib0, rib_z},
                        {wall, rib1, rib_z},
                        {wall, rib1, in_z},
                        {wall, width, in_z},
                        {wall, width, wall_end}}),
            shifted(wall_rim, 0, wall), draw.line({wall, 0, wall_end}, {wall, 0, in_z})})};

  // Bolt holes: counterbored ones, and a plain one for a cable.
  constexpr std::int64_t bolt = 13 * mm / 2, head = 11 * mm, seat = 4 * mm;
  for (const auto& [x, y] : {std::pair{50 * mm, 24 * mm}, std::pair{50 * mm, 96 * mm},
                             std::pair{172 * mm, 28 * mm}, std::pair{172 * mm, 92 * mm}}) {
    const Path hole = draw.circle({x, y, 0}, 0, 1, bolt);
    const Path bore = draw.circle({x, y, seat}, 0, 1, head);
    part.sweep(hole, 2, draw.line({0, 0, 0}, {0, 0, seat}), true);
    part.strip(shifted(hole, 2, seat), bore, true);
    part.sweep(bore, 2, draw.line({0, 0, seat}, {0, 0, base}), true);
    bottom.push_back(hole);
    top.push_back(shifted(bore, 2, base - seat));
  }
  const Path cable = draw.circle({136 * mm, 60 * mm, 0}, 0, 1, 15 * mm);
  part.sweep(cable, 2, base_up, true);
  bottom.push_back(cable);
  top.push_back(shifted(cable, 2, base));

  // Slots and holes of the wall.
  std::vector<Path> openings{draw.slot({0, 26 * mm, 66 * mm}, 22 * mm, 6 * mm),
                             draw.slot({0, 94 * mm, 66 * mm}, 22 * mm, 6 * mm),
                             draw.circle({0, 60 * mm, 103 * mm}, 1, 2, 10 * mm)};
  for (std::int64_t y = 36; y <= 84; y += 12) {
    openings.push_back(draw.circle({0, y * mm, 126 * mm}, 1, 2, 3 * mm));
  }
  for (const Path& opening : openings) {
    part.sweep(opening, 0, wall_through, true);
    back.push_back(opening);
    front.push_back(shifted(opening, 0, wall));
  }

  part.face(2, bottom, spacing, true);
  part.face(2, top, spacing, false);
  part.face(0, back, spacing, true);
  part.face(0, front, spacing, false);

  // The rib: its slanted ridge and its sides.
  const Path ridge = draw.lines({{rib_x, rib0, base},
                                 {rib_x, rib0, base + rib_tip},
                                 {wall + rib_tip, rib0, rib_z},
                                 {wall, rib0, rib_z}});
  const Path rib_side =
      join({draw.line({in_x, rib0, base}, {rib_x, rib0, base}), ridge,
            draw.line({wall, rib0, rib_z}, {wall, rib0, in_z}), shifted(inner_fillet, 1, rib0)});
  part.sweep(ridge, 1, draw.line({0, rib0, 0}, {0, rib1, 0}), true);
  part.face(1, {rib_side}, spacing, false);
  part.face(1, {shifted(rib_side, 1, rib1 - rib0)}, spacing, true);

  return std::move(part).mesh();
}

}  // namespace kaboum::examples
