// Certified convex sets for all links of a robot, and for what it sweeps, in process.
// Arguments: a URDF and a path (CSV), see docs/formats.md; without them an arm is made up.

#include <kaboum/certify/robot.h>
#include <kaboum/certify/sweep.h>
#include <kaboum/robot/path_file.h>

#include <iostream>

#include "arm.h"

int main(int argc, char** argv) {
  using namespace kaboum;
  const robot::RobotFile arm = robot::read_robot(argc > 2 ? argv[1] : write_arm());
  certify::RobotRequest request;
  request.set.epsilon = kaboum::Length{2, true};  // percent of each mesh's diagonal
  const certify::CertifiedRobot links = certify::certify_robot(arm, request);
  for (const certify::CertifiedLink& link : links.links)
    std::cout << arm.robot.links[link.certificate().link].name << ": "
              << link.artefact().bodies.size() << " bodies hold it, no farther from it than "
              << link.artefact().provenance.epsilon.value() << '\n';

  std::vector<std::string> notes;
  const robot::Path path =
      robot::read_path(argc > 2 ? argv[2] : write_path(), arm.robot, {}, notes);
  certify::SweepRequest motion;
  motion.search.epsilon = 0.02;  // [m]
  const auto swept = certify::certify_sweep(arm, links.bodies, path, motion);
  if (!swept) return 1;  // float32 is too coarse
  const bool decided = swept->certificate().motion == certify::MotionClaim::Decided;
  std::cout << swept->artefact().bodies.size() << " bodies and a margin of "
            << swept->certificate().margin
            << " hold all of them along the path: " << (decided ? "decided" : "proved") << '\n';
  return decided ? 0 : 1;
}
