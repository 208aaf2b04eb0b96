// A tree of oriented boxes over convex bodies, built from below.

#include <kaboum/collide/body_tree.h>
#include <kaboum/geom/convex_hull.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <list>

namespace kaboum::collide {
namespace {

using Frames = std::vector<Eigen::Matrix3d>;

double half_surface(const geom::Vec3& sides) {
  return sides.x() * sides.y() + sides.y() * sides.z() + sides.z() * sides.x();
}

/// Principal axes of points.
Eigen::Matrix3d principal_axes(const std::vector<geom::Vec3>& points) {
  geom::Vec3 mean = geom::Vec3::Zero();
  for (const geom::Vec3& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const geom::Vec3& p : points) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors();
}

/// Frames with one axis across a facet and another along one of its edges.
void add_facet_frames(const geom::Mesh& hull, Frames& frames) {
  for (const auto& [a, b, c] : hull.triangles) {
    const geom::Vec3 &p = hull.vertices[a], &q = hull.vertices[b], &r = hull.vertices[c];
    const geom::Vec3 normal = (q - p).cross(r - p).normalized();
    for (const geom::Vec3& edge : {geom::Vec3(q - p), geom::Vec3(r - q), geom::Vec3(p - r)}) {
      Eigen::Matrix3d frame;
      frame << normal, edge.normalized(), normal.cross(edge.normalized());
      if (frame.allFinite()) frames.push_back(frame);
    }
  }
}

}  // namespace

/// The box with the smallest surface among those along the frames.
BodyTree::Node BodyTree::fitted(const std::vector<geom::Vec3>& points, const Frames& frames) {
  Node best{};
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix3d& frame : frames) {
    geom::Box3 box;
    for (const geom::Vec3& p : points) box.extend(frame.transpose() * p);
    const double surface = half_surface(box.max - box.min);
    if (surface >= least) continue;
    least = surface;
    const geom::Vec3 half = 0.5 * (box.max - box.min);
    best = {frame, frame * box.center(), half, half.norm(), -1, 0, 0};
  }
  return best;
}

/// Boxes are joined from below, each time the two that give the smallest box along the coordinate
/// axes.
BodyTree::BodyTree(const std::vector<geom::Mesh>& bodies) {
  struct Group {
    std::size_t node;
    geom::Box3 box;
    std::vector<geom::Vec3> points;
  };
  std::list<Group> groups;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Frames frames{Eigen::Matrix3d::Identity(), principal_axes(bodies[i].vertices)};
    add_facet_frames(bodies[i], frames);
    nodes_.push_back(fitted(bodies[i].vertices, frames));
    nodes_.back().body = static_cast<int>(i);
    groups.push_back({i, geom::bounding_box(bodies[i]), bodies[i].vertices});
  }
  while (groups.size() > 1) {
    auto first = groups.begin(), second = first;
    double least = std::numeric_limits<double>::infinity();
    for (auto a = groups.begin(); a != groups.end(); ++a)
      for (auto b = std::next(a); b != groups.end(); ++b) {
        geom::Box3 box = a->box;
        box.extend(b->box);
        const double surface = half_surface(box.max - box.min);
        if (surface >= least) continue;
        least = surface;
        first = a;
        second = b;
      }
    first->box.extend(second->box);
    first->points.insert(first->points.end(), second->points.begin(), second->points.end());
    Frames frames{Eigen::Matrix3d::Identity(), principal_axes(first->points),
                  nodes_[first->node].axes, nodes_[second->node].axes};
    if (const auto hull = geom::convex_hull(first->points)) {
      frames.push_back(principal_axes(hull->vertices));
      first->points = hull->vertices;
    }
    Node node = fitted(first->points, frames);
    node.left = first->node;
    node.right = second->node;
    first->node = nodes_.size();
    nodes_.push_back(node);
    groups.erase(second);
  }
}

}  // namespace kaboum::collide
