#pragma once

#include <kaboum/robot/path_options.h>
#include <kaboum/verify/motion_verdict.h>
#include <kaboum/verify/robot_verdict.h>
#include <kaboum/verify/verdict_options.h>

namespace kaboum::verify {

/// How a robot is judged against another that is to hold its shapes.
struct RobotVerdictOptions {
  Claims claims = Claims::All;
  std::optional<Length> epsilon = {};  ///< RobotQuestion::epsilon
  robot::ShapeChoice shapes = {};      ///< of the original
  Solid solid = Solid::AsFile;
  bool drop_sheets = false;  ///< with Solid::Prepared
  std::size_t exact_points = kPointDensity;
  std::size_t max_contacts = InclusionOptions{}.max_contacts;
  std::optional<double> max_work = {};
};

const std::vector<Option<RobotVerdictOptions>>& robot_verdict_options();

/// How bodies are judged that are to hold a robot's motion.
struct MotionVerdictOptions {
  Claims claims = Claims::All;  ///< All or Surface
  MotionShapeOptions shapes = {};
  robot::PathOptions reading = {.check_limits = false};  ///< limits are no matter of the bodies
  std::string base_pose;           ///< as robot::parse_pose; empty: the origin
  std::optional<double> gap = {};  ///< MotionQuestion::gap [length]
  std::size_t max_cells = SweepOptions{}.max_cells;
};

const std::vector<Option<MotionVerdictOptions>>& motion_verdict_options();

/// Why such options do not go together, as `meaning` takes it; empty: they do.
std::string contradiction(const RobotVerdictOptions& options);
std::string contradiction(const MotionVerdictOptions& options);

/// The question that such options ask.
RobotQuestion question_of(const robot::Robot& original, const robot::Robot& result,
                          std::function<const MeshFile&(const robot::Geometry&, bool)> file_of,
                          const RobotVerdictOptions& options);

}  // namespace kaboum::verify
