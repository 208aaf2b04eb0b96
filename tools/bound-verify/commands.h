#pragma once

#include <functional>
#include <set>
#include <string>

#include "mesh.h"
#include "progressive.h"
#include "robot.h"
#include "sweep.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What bound-verify is asked: the command's options, of which those of one command count.
struct VerifyOptions {
  VerifyMeshOptions mesh;  ///< of mesh and cover
  VerifyRobotOptions robot;
  VerifySweepOptions sweep;
  VerifyProgressiveOptions progressive;
  std::set<std::string> stated;  ///< names of the libraries' options that were stated
  CommonOptions common;
  std::function<int()> decide;  ///< carries out the command; returns the exit code
};

inline constexpr const char* kVerifyExitCodes =
    "Exit codes: 0 verified; 1 refuted; 2 usage; 3 bad input, or not closed where a claim needs "
    "it; 4 output failed; 6 internal error; 7 undecided within limits.";

/// What to say where a command was meant by a flag (bound-verify --cover ORIGINAL SET); empty where
/// a command comes first, or there is no such flag.
std::string command_instead(int argc, const char* const* argv);

/// The commands mesh, cover, robot, sweep and progressive, each with the options that mean
/// something for it.
void add_commands(CLI::App& app, VerifyOptions& options);

}  // namespace kaboum::tools
