// Bullet's hulls of the written bodies, scaled and posed as its URDF importer does it, are the
// bodies.

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <gtest/gtest.h>

#include "expected.h"

namespace engines {
namespace {

btVector3 vector(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Its points, in the order of the file's corners, and what it says of its reach.
Measure measure_hull(const Shape& shape) {
  btConvexHullShape hull;
  for (const Eigen::Vector3d& p :
       corners_of_stl(shape.file, Eigen::Vector3d::Ones(), Eigen::Isometry3d::Identity()))
    hull.addPoint(vector(p), false);
  hull.setLocalScaling(vector(shape.scale));
  hull.setMargin(0);
  hull.recalcLocalAabb();
  const auto posed = [&](const btVector3& v) {
    return Eigen::Vector3d(shape.pose * Eigen::Vector3d(v.x(), v.y(), v.z()));
  };
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < hull.getNumPoints(); ++i) corners.push_back(posed(hull.getScaledPoint(i)));
  Measure out = measure(shape.mesh, corners);
  out.volume = std::abs(out.volume);  // of mirrored ones
  for (std::size_t d = 0; d < out.reach.size(); ++d) {
    const Eigen::Vector3d u = shape.pose.linear().transpose() * directions()[d];
    out.reach[d] = posed(hull.localGetSupportingVertex(vector(u))).dot(directions()[d]);
  }
  return out;
}

TEST(Bullet, HullsAreTheBodiesThatWereWritten) {
  for (const std::filesystem::path& urdf : outputs())
    for (const Link& link : read_urdf(urdf).links)
      for (const Shape& shape : link.collisions)
        if (!shape.mesh.empty())
          expect_same(urdf.string() + ", link '" + link.name + "'", {shape.measure},
                      {measure_hull(shape)});
}

TEST(Bullet, AddsMoreThanItsOwnRoundingTakesAway) {
  // What its URDF importer does besides: it rounds vertices, and adds a margin of 1 mm
  // (docs/engines.md).
  for (const std::filesystem::path& urdf : outputs())
    for (const Link& link : read_urdf(urdf).links)
      for (const Shape& shape : link.collisions) {
        if (shape.mesh.empty()) continue;
        btConvexHullShape hull;
        const auto corners = corners_of_stl(shape.file, shape.scale, Eigen::Isometry3d::Identity());
        for (const Eigen::Vector3d& p : corners) hull.addPoint(vector(p), false);
        hull.setMargin(0);
        hull.optimizeConvexHull();
        hull.recalcLocalAabb();
        const Measure written = measure(shape.mesh, corners);
        double extent = 0;
        for (std::size_t d = 0; d < 13; ++d)
          extent = std::max(extent, written.reach[d] + written.reach[25 - d]);
        for (std::size_t d = 0; d < written.reach.size(); ++d) {
          const btVector3 v = hull.localGetSupportingVertex(vector(directions()[d]));
          EXPECT_GE(Eigen::Vector3d(v.x(), v.y(), v.z()).dot(directions()[d]),
                    written.reach[d] - 2e-4 * extent)
              << urdf << ": " << shape.mesh;
        }
      }
}

}  // namespace
}  // namespace engines
