// Robots in motion as libverify takes them: certified bodies of meshes instead of the meshes.

#include "swept_motion.h"

#include <kaboum/base/error.h>
#include <kaboum/verify/moving_robot.h>

#include <algorithm>

namespace kaboum::certify {
namespace {

std::vector<verify::MovingShape> moving_shapes(const robot::RobotFile& robot,
                                               const CertifiedBodies& bodies,
                                               const robot::Path& path) {
  std::vector<verify::MovingShape> out;
  std::vector<std::uint32_t> links;
  const BodiesCertificate& made = bodies.certificate();
  for (const robot::LinkShape& shape : made.shapes) {
    const robot::Link& link = robot.robot.links[shape.link];
    const robot::Geometry& g = made.choice.shapes_of(link)[shape.index];
    const auto add = [&](geom::Mesh mesh) {
      auto moving = verify::moving_shape(robot.robot, shape.link, g, std::move(mesh));
      if (!moving) return;  // a point
      moving->name = link.name + "/" + std::to_string(shape.index);
      out.push_back(*std::move(moving));
      links.push_back(shape.link);
    };
    if (!shape.mesh) {
      add({});
      continue;
    }
    for (const geom::ConvexBody& body : made.meshes[*shape.mesh].made.found.set.artefact().bodies)
      add(body.core);
  }
  ensure(verify::same_poses(robot.robot, out, links, path),
         "two ways to compute a link's pose disagree");
  return out;
}

}  // namespace

verify::Claim decide_motion(const robot::RobotFile& robot, const CertifiedBodies& bodies,
                            const robot::Path& path, const geom::ConvexSet& set,
                            std::size_t max_cells,
                            const std::function<void(const std::string&)>& progress) {
  const std::vector<verify::MovingShape> shapes = moving_shapes(robot, bodies, path);
  verify::SweepOptions options;
  options.gap = verify::default_gap(set);
  options.max_cells = max_cells;
  if (progress) options.progress = [&](const std::string& what) { progress("deciding: " + what); };
  const verify::SweepClaims found = verify::verify_sweep(shapes, path, set, options);
  verify::Claim claim;
  claim.answer = verify::answer_of(found, verify::Claims::All);
  for (const verify::Claim* part : {&found.convex, &found.surface, &found.solid})
    if (claim.answer != verify::Answer::Verified && part->answer == claim.answer) {
      claim.reason = part->reason;
      break;
    }
  return claim;
}

}  // namespace kaboum::certify
