// The meshes of a robot that are to be held, and how near.

#include <kaboum/base/error.h>
#include <kaboum/certify/wanted_meshes.h>

#include <algorithm>
#include <utility>

namespace kaboum::certify {
namespace {

/// The regions of a shape's link, in the shape's frame.
std::vector<geom::RequestedRegion> regions_of(const robot::RobotFile& robot,
                                              const robot::ShapeChoice& choice,
                                              const robot::LinkShape& shape,
                                              const robot::LinkRegions& regions) {
  std::vector<geom::RequestedRegion> out;
  const robot::Link& link = robot.robot.links[shape.link];
  const auto found = regions.find(link.name);
  if (found == regions.end()) return out;
  for (const robot::LinkRegion& one : found->second)
    out.push_back(
        *robot::region_in_shape(one, choice.shapes_of(link)[shape.index], robot::Side::Round));
  return out;
}

}  // namespace

WantedMeshes wanted_meshes(const robot::RobotFile& robot, const robot::ShapeChoice& choice,
                           const LinkEpsilons& epsilons, const robot::LinkRegions& regions) {
  for (const auto& [link, epsilon] : epsilons)
    if (!robot.robot.find_link(link))
      throw Error(ErrorCode::InvalidArgument,
                  robot.path.string() + ": there is no link '" + link + "' to have an epsilon");
  for (const auto& [link, own] : regions)
    if (!robot.robot.find_link(link))
      throw Error(ErrorCode::InvalidArgument,
                  robot.path.string() + ": there is no link '" + link + "' to have regions");
  WantedMeshes out;
  try {
    static_cast<robot::LinkMeshes&>(out) = robot::link_meshes(robot, choice);
  } catch (const Error& error) {
    // Other refusals come again of looking for what is missing.
    if (choice.skip_missing || error.code() != ErrorCode::InvalidInput ||
        robot::missing_meshes(robot, choice).empty())
      throw;
    throw Error(error.code(), std::string(error.what()) +
                                  "; «missing-meshes=skip» leaves them out, and their links are "
                                  "not verified then");
  }
  std::vector<robot::LinkMesh> meshes;
  std::vector<std::size_t> of;  // of `meshes`: index in out.meshes
  for (robot::LinkShape& shape : out.shapes) {
    if (!shape.mesh) continue;
    const auto found = epsilons.find(robot.robot.links[shape.link].name);
    const std::optional<Length> epsilon =
        found == epsilons.end() ? std::nullopt : std::optional(found->second);
    std::vector<geom::RequestedRegion> own = regions_of(robot, choice, shape, regions);
    std::size_t i = 0;
    while (i < of.size() &&
           (of[i] != *shape.mesh || out.epsilons[i] != epsilon || out.regions[i] != own))
      ++i;
    if (i == of.size()) {
      of.push_back(*shape.mesh);
      meshes.push_back(out.meshes[*shape.mesh]);
      out.epsilons.push_back(epsilon);
      out.regions.push_back(std::move(own));
    }
    shape.mesh = i;
  }
  out.meshes = std::move(meshes);
  return out;
}

Length in_unit_of_mesh(Length length, const geom::Vec3& scale) {
  length = length.in("m");
  // Lengths grow by the largest scale at most, the diagonal by the least one at least.
  if (length.percent)
    length.value *= scale.minCoeff() / scale.maxCoeff();
  else
    length.value /= scale.maxCoeff();
  return length;
}

}  // namespace kaboum::certify
