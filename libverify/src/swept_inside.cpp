// Whether the solid behind a swept surface is held by the bodies, too: decided at one
// configuration. docs/algorithms/swept-volumes.md.
#include "swept_inside.h"

#include <algorithm>

#include "mesh_pair.h"

namespace kaboum::verify {

using geom::Vec3;

namespace {

constexpr int kConfigurations = 16;

geom::Mesh placed(const MovingShape& shape, std::span<const double> q) {
  const auto pose = pose_of(shape.chain, q);
  geom::Mesh out = shape.mesh;
  for (Vec3& v : out.vertices) v = pose.leftCols<3>() * v + pose.col(3);
  return out;
}

/// Largest distance of a vertex from the bodies; infinite when no body is within the margin.
double farthest_vertex(const geom::Mesh& mesh, const std::vector<SweptBody>& bodies,
                       double margin) {
  double farthest = 0;
  for (const Vec3& v : mesh.vertices) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const SweptBody& body : bodies) {
      if (body.distance_to_box(v) > margin) continue;
      nearest = std::min(nearest, body.distance_from_above(v));
      if (nearest <= farthest) break;
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// The configuration, of some along the first segment, that leaves most room.
geom::Mesh place_with_room(const MovingShape& shape, const std::vector<std::vector<double>>& path,
                           const std::vector<SweptBody>& bodies, double margin) {
  const std::vector<double>&from = path.front(),
        &to = path[std::min<std::size_t>(1, path.size() - 1)];
  geom::Mesh best = placed(shape, from);
  double least = farthest_vertex(best, bodies, margin);
  for (int k = 1; k <= kConfigurations && least > 0; ++k) {
    std::vector<double> q = from;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += k * (to[i] - from[i]) / kConfigurations;
    geom::Mesh mesh = placed(shape, q);
    const double farthest = farthest_vertex(mesh, bodies, margin);
    if (farthest >= least) continue;
    least = farthest;
    best = std::move(mesh);
  }
  return best;
}

/// Bodies each of which holds a triangle or, where none holds all of it, a corner of one.
std::vector<std::uint32_t> holders(const geom::Mesh& mesh, const std::vector<SweptBody>& bodies,
                                   double margin) {
  std::vector<char> used(bodies.size(), 0);
  const auto holds = [&](std::size_t b, const Vec3& p) {
    return bodies[b].distance_to_box(p) <= margin && bodies[b].holds(p, margin);
  };
  std::size_t last = 0;
  for (const geom::Triangle& t : mesh.triangles) {
    const auto holds_all = [&](std::size_t b) {
      return std::all_of(t.begin(), t.end(),
                         [&](std::uint32_t v) { return holds(b, mesh.vertices[v]); });
    };
    if (!holds_all(last)) {
      const std::size_t before = last;
      for (last = 0; last < bodies.size() && !holds_all(last);) ++last;
      if (last == bodies.size()) {
        last = before;
        for (std::size_t b = 0; b < bodies.size(); ++b)
          for (const std::uint32_t v : t)
            if (holds(b, mesh.vertices[v])) used[b] = 1;
        continue;
      }
    }
    used[last] = 1;
  }
  std::vector<std::uint32_t> out;
  for (std::uint32_t b = 0; b < used.size(); ++b)
    if (used[b] != 0) out.push_back(b);
  return out;
}

/// Bodies that, margin included, may meet a box.
std::vector<std::uint32_t> near(const geom::Box3& box, const std::vector<SweptBody>& bodies,
                                double margin) {
  const Vec3 room = Vec3::Constant(margin * (1 + 0x1p-40));
  std::vector<std::uint32_t> out;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const geom::Box3& other = bodies[b].box();
    if ((other.min.array() <= (box.max + room).array()).all() &&
        (other.max.array() >= (box.min - room).array()).all())
      out.push_back(b);
  }
  return out;
}

geom::ConvexSet part_of(const geom::ConvexSet& set, const std::vector<std::uint32_t>& chosen) {
  geom::ConvexSet out;
  for (const std::uint32_t b : chosen) out.bodies.push_back(set.bodies[b]);
  return out;
}

}  // namespace

bool is_closed(const geom::Mesh& mesh) {
  return !mesh.triangles.empty() && MeshPair(mesh, geom::Mesh{}).closed(kInside);
}

Claim verify_inside(const MovingShape& shape, const std::vector<std::vector<double>>& path,
                    const geom::ConvexSet& set, const std::vector<SweptBody>& bodies,
                    const SweepOptions& options) {
  const double margin = geom::margin_of(set).value();
  const geom::Mesh mesh = place_with_room(shape, path, bodies, margin);
  const std::vector<std::uint32_t> some = holders(mesh, bodies, margin);
  Claim claim;
  claim.answer = Answer::Verified;
  // One body that holds all corners holds their hull.
  for (const std::uint32_t b : some)
    if (std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                    [&](const Vec3& v) { return bodies[b].holds(v, margin); }))
      return claim;
  // Few bodies are quicker; when they are not enough, all that are near.
  claim = verify_cover(mesh, part_of(set, some), options.inclusion).inclusion.solid;
  if (claim.answer != Answer::Verified)
    claim = verify_cover(mesh, part_of(set, near(geom::bounding_box(mesh), bodies, margin)),
                         options.inclusion)
                .inclusion.solid;
  if (claim.answer != Answer::Verified) claim.reason = shape.name + ": " + claim.reason;
  claim.inner_triangles.clear();  // of meshes that the caller does not know
  claim.outer_triangles.clear();
  return claim;
}

}  // namespace kaboum::verify
