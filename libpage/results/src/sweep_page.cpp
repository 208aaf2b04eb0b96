// Pages of swept volumes.

#include <kaboum/page/sweep_page.h>

#include <kaboum/page/gaps.h>
#include <kaboum/robot/exact_shapes.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "swept_link.h"

namespace kaboum::page {
namespace {

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string verdict_of(certify::MotionClaim claim) {
  switch (claim) {
    case certify::MotionClaim::None:
      return "NOT certified: «bound=baginski» is not proved";
    case certify::MotionClaim::Proved:
      return "at every instant of the path the robot lies in the bodies: by the proof of the "
             "steps; "
             "bound-verify sweep decides it from the files alone";
    case certify::MotionClaim::Decided:
      break;
  }
  return "at every instant of the path the robot lies in the bodies: decided exactly";
}

}  // namespace

std::string summary_of(const certify::SweepCertificate& c, std::size_t bodies) {
  std::ostringstream message;
  message.precision(3);
  message << c.bodies << (c.bodies == 1 ? " body" : " bodies") << " for " << bodies
          << " of the robot; margin " << c.margin << "; no point farther than " << c.excess
          << " from what the robot's bodies sweep, these within " << c.bodies_distance
          << " of its shapes";
  if (c.motion == certify::MotionClaim::None)
    message << "; NOT certified: «bound=baginski» is not proved";
  return message.str();
}

std::string page_of_sweep(const SweepWords& words, const robot::RobotFile& robot,
                          const certify::CertifiedBodies& bodies, const robot::Path& path,
                          const certify::CertifiedSweep& swept) {
  const robot::ShapeChoice& choice = bodies.certificate().choice;
  const geom::ConvexSet& set = swept.artefact();
  const certify::SweepCertificate& c = swept.certificate();
  Preview preview{"Swept by " + file_name(words.robot), set.provenance.unit};
  preview.meaning = "distance of the bodies from what their link's shapes sweep";
  Layer input{"robot", Layer::View::Shown, false};
  Layer result{"swept bodies", Layer::View::Transparent};
  result.bodies = true;
  std::map<std::uint32_t, SweptLink> links;
  robot::MeshFiles files(robot.path, choice.packages);
  std::vector<DistanceOf> distances;
  for (const std::size_t source : c.sources) {
    const std::uint32_t index = bodies.artefact()[source].link;
    auto found = links.find(index);
    if (found == links.end()) {
      geom::Mesh exact = robot::exact_shapes(choice.shapes_of(robot.robot.links[index]), files);
      found = links.try_emplace(index, robot.robot, path, index, exact).first;
      input.shapes.push_back({std::move(exact), {}, index});
    }
    distances.emplace_back(
        [&link = found->second](const geom::Vec3& p) { return link.distance(p); });
  }
  geom::Box3 box;
  for (const geom::ConvexBody& body : set.bodies) box.extend(geom::bounding_box(body));
  result.shapes = measured(set.bodies, box.diagonal(), distances);
  preview.facts = {{"robot", file_name(words.robot)},
                   {"path", file_name(words.path) + ", " + std::to_string(path.size()) +
                                (path.size() == 1 ? " waypoint" : " waypoints")},
                   {"options", set.provenance.parameters},
                   {"result", words.summary},
                   {"verdict", words.spelled(verdict_of(c.motion))}};
  preview.layers = {std::move(input), std::move(result)};
  preview.motion.emplace(Motion{robot.robot, path});
  return preview_page(preview);
}

}  // namespace kaboum::page
