#pragma once

#include <kaboum/certify/link_verdict.h>
#include <kaboum/page/preview.h>

#include <string>
#include <vector>

/// Pages of convex bodies over what they were made of. docs/pages.md.
namespace kaboum::page {

/// Bodies, vertices and distance, in one line.
std::string summary_of(const certify::SetCertificate& certificate);

/// Why epsilon, if asked for, is not reached, and what helps; empty when it is.
std::string shortfall_of(const certify::SetCertificate& certificate);

/// What a set was made of.
struct SetOrigin {
  std::string file;  ///< name, or what the mesh is called
  const geom::Mesh& mesh;
  geom::PrepareOptions preparation;
};

/// A page of a mesh's set.
/// @throws Error as preparing the mesh.
std::string page_of_set(const SetOrigin& origin, const certify::SetCertificate& certificate,
                        const geom::ConvexSet& set, const Spelling& spelled);

/// What is said of a robot's bodies beside their picture.
struct RobotWords {
  std::string file, unit;
  std::string parameters;  ///< of the sets
  Spelling spelled;
  std::vector<Step> steps = {};  ///< what to do next
};

/// A page of a robot's bodies over its shapes: a verdict for each link, and a slider for each
/// joint.
/// @throws Error as reading its meshes.
std::string page_of_robot(const RobotWords& words, const robot::RobotFile& robot,
                          const certify::CertifiedRobot& made,
                          const std::vector<certify::LinkVerdict>& verdicts);

/// All links at zero joint values, for pictures: not certified.
geom::ConvexSet at_rest(const robot::Robot& robot,
                        const std::vector<certify::CertifiedLink>& links);

}  // namespace kaboum::page
