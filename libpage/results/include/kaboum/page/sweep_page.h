#pragma once

#include <kaboum/certify/sweep.h>
#include <kaboum/page/preview.h>

#include <string>

namespace kaboum::page {

/// What is said of a sweep beside its picture.
struct SweepWords {
  std::string robot, path;  ///< names of files
  std::string summary;
  Spelling spelled;
};

/// Bodies, margin and distances, in one line.
/// @param bodies  of the robot
std::string summary_of(const certify::SweepCertificate& certificate, std::size_t bodies);

/// A page: the bodies that bound what is swept, over the robot's shapes along the path.
/// docs/pages.md.
/// @throws Error as reading the robot's meshes.
std::string page_of_sweep(const SweepWords& words, const robot::RobotFile& robot,
                          const certify::CertifiedBodies& bodies, const robot::Path& path,
                          const certify::CertifiedSweep& swept);

}  // namespace kaboum::page
