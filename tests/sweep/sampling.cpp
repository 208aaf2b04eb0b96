#include "sampling.h"

#include <kaboum/geom/float32.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <set>

namespace kaboum::test {

Missed sample_points(const TestRobot& robot, const Path& path, const SweepResult& result,
                     std::mt19937_64& random, std::size_t samples, bool anywhere) {
  Missed out;
  std::uniform_real_distribution<double> unit(0, 1);
  const std::size_t segments = std::max<std::size_t>(path.size(), 2) - 1;
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t segment = random() % segments;
    const double s = unit(random);
    const std::vector<double> q =
        between(path[segment], path[std::min(segment + 1, path.size() - 1)], s);
    const std::size_t b = random() % robot.bodies.size();
    const LinkBody& body = robot.bodies[b];
    const Transform pose = reference_pose(robot.robot, body.link, q);
    // A vertex, or a point of an edge of the hull.
    Vec3 local = body.points[random() % body.points.size()];
    if (k % 4 == 0) local += unit(random) * (body.points[random() % body.points.size()] - local);
    const Vec3 p = pose * local;
    ++out.tested;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < result.pieces.size(); ++i) {
      if (result.sources[i] != b) continue;
      const PathInterval& piece = result.pieces[i];
      const geom::Mesh& hull = result.set.bodies[i].core;
      if (anywhere) {
        nearest = std::min(nearest, distance_to(hull, p));
        continue;
      }
      const std::pair<std::size_t, double> here{segment, s};
      if (here < std::pair{piece.first_segment, piece.begin} ||
          here > std::pair{piece.last_segment, piece.end})
        continue;
      // Quicker, and enough when it is small: the hull contains this segment (find_bad_hull).
      nearest = std::min(nearest, segment_distance(geom::to_float32(piece.start * local),
                                                   geom::to_float32(piece.finish * local), p));
      if (nearest > margin_of(result.set).value())
        nearest = std::min(nearest, distance_to(hull, p));
    }
    out.largest = std::max(out.largest, nearest);
    if (nearest > margin_of(result.set).value()) ++out.missed;
  }
  return out;
}

std::optional<std::size_t> find_bad_hull(const TestRobot& robot, const SweepResult& result) {
  for (std::size_t i = 0; i < result.pieces.size(); ++i) {
    const geom::Mesh& hull = result.set.bodies[i].core;
    if (!geom::is_convex(hull)) return i;
    for (const Vec3& v : hull.vertices)
      if (!geom::is_float32(v)) return i;
    for (const Transform& pose : {result.pieces[i].start, result.pieces[i].finish})
      for (const Vec3& local : robot.bodies[result.sources[i]].points)
        for (const geom::Triangle& t : hull.triangles)
          if (geom::orient3d(hull.vertices[t[0]], hull.vertices[t[1]], hull.vertices[t[2]],
                             geom::to_float32(pose * local)) == geom::Sign::Positive)
            return i;
  }
  return std::nullopt;
}

}  // namespace kaboum::test
