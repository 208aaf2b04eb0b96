#pragma once

#include <kaboum/robot/path.h>
#include <kaboum/verify/motion_verdict.h>

#include <string>
#include <vector>

#include "sweep.h"

/// What is said of a motion that was judged, in words and as a report.
namespace kaboum::tools {

/// What was asked, of which files, and what was found.
struct SweepCase {
  const VerifySweepOptions& asked;
  robot::RobotFile robot;
  robot::Path path;
  verify::MotionShapes shapes;
  verify::SweptBodies swept;
  verify::MotionVerdict verdict;

  /// Whether a distance from the bodies was measured that is to be told.
  [[nodiscard]] bool knows_farthest() const {
    return verdict.claims.convex.answer == verify::Answer::Verified &&
           verdict.claims.farthest.distance >= 0;
  }
};

/// All that is said, the verdict last.
std::vector<std::string> lines_of(const SweepCase& run);

/// The report; without the time it took, the same for any number of threads.
Json report_of(const SweepCase& run);

}  // namespace kaboum::tools
