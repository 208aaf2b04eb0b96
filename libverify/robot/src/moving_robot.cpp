// A robot in motion, as the verifier of swept sets takes it.
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/verify/moving_robot.h>

#include <algorithm>

namespace kaboum::verify {
namespace {

using From = robot::Geometry::Shape;
using To = MovingShape::Kind;

To kind_of(From shape) {
  switch (shape) {
    case From::Mesh:
      return To::Mesh;
    case From::Box:
      return To::Box;
    case From::Cylinder:
      return To::Cylinder;
    case From::Capsule:
    case From::Ellipsoid:
      return To::Mesh;  // a polytope round it
    case From::Sphere:
      break;
  }
  return To::Sphere;
}

KinematicStage stage_of(const robot::Transform& fixed) {
  KinematicStage stage;
  stage.rotation = fixed.linear;
  stage.translation = fixed.translation;
  return stage;
}

geom::Mesh scaled(geom::Mesh mesh, const geom::Vec3& scale) {
  for (geom::Vec3& v : mesh.vertices) v = v.cwiseProduct(scale);
  if (scale.prod() < 0)  // a mirrored solid is still a solid
    for (geom::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace

KinematicChain chain_to(const robot::Robot& robot, std::uint32_t link) {
  KinematicChain chain;
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) {
    const robot::Joint& joint = robot.joints[l - 1];
    KinematicStage stage = stage_of(joint.origin);
    if (joint.type != robot::JointType::Fixed) {
      using Motion = KinematicStage::Motion;
      stage.motion = joint.type == robot::JointType::Revolute ? Motion::Turn : Motion::Slide;
      stage.axis = joint.axis;
      stage.variable = joint.variable;
      stage.multiplier = joint.multiplier;
      stage.offset = joint.offset;
    }
    chain.push_back(stage);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

std::optional<MovingShape> moving_shape(const robot::Robot& robot, std::uint32_t link,
                                        const robot::Geometry& shape, geom::Mesh mesh) {
  if (robot::is_point(shape)) return std::nullopt;
  MovingShape out;
  out.kind = kind_of(shape.shape);
  out.size = shape.size;
  if (shape.shape == From::Cylinder && shape.size.x() == 0) {
    out.kind = To::Box;
    out.size = {0, 0, shape.size.y()};
  }
  out.chain = chain_to(robot, link);
  out.chain.push_back(stage_of(shape.origin));
  if (shape.shape == From::Capsule || shape.shape == From::Ellipsoid) {
    robot::Geometry here = shape;
    here.origin = {};
    out.mesh = *geom::convex_hull(robot::bounding_points(here));
  } else if (out.kind == To::Mesh) {
    out.mesh = scaled(std::move(mesh), shape.size);
  }
  return out;
}

bool same_poses(const robot::Robot& robot, const std::vector<MovingShape>& shapes,
                const std::vector<std::uint32_t>& links, const robot::Path& path) {
  for (const auto& q : path) {
    const std::vector<robot::Transform> poses = robot::forward(robot, q);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      KinematicChain chain = shapes[i].chain;
      chain.pop_back();
      const auto pose = pose_of(chain, q);
      const robot::Transform& other = poses[links[i]];
      const double size = 1 + other.translation.norm();
      const double allowed = 1e-9 * size + 64 * bound_motion(chain, q, q, size).rounding;
      if (!((pose.leftCols<3>() - other.linear).norm() < allowed / size &&
            (pose.col(3) - other.translation).norm() < allowed))
        return false;
    }
  }
  return true;
}

std::vector<double> configuration_at(const robot::Path& path, const SweepPlace& place) {
  const auto &a = path[place.segment], &b = path[std::min(place.segment + 1, path.size() - 1)];
  std::vector<double> q(a.size());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = a[i] + place.s * (b[i] - a[i]);
  return q;
}

Answer answer_of(const SweepClaims& found, Claims claims) {
  const Answer answer = worse(found.convex.answer, found.surface.answer);
  const bool solid = claims == Claims::All && found.solid.answer != Answer::Undefined;
  return solid ? worse(answer, found.solid.answer) : answer;
}

}  // namespace kaboum::verify
