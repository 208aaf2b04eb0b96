#pragma once

#include <string>
#include <vector>

#include "common/cli.h"
#include "mesh.h"
#include "sweep.h"

namespace CLI {
class App;
}  // namespace CLI

/// What the commands of bound-verify (verify_commands.h) are asked.
namespace kaboum::tools {

/// What bound-verify is asked: one relation of files.
struct VerifyOptions {
  bool outer = false, inner = false, cover = false, robot = false, progressive = false;
  std::vector<std::string> sweep;       ///< ROBOT, PATH and SWEPT; else empty
  std::string original, approximation;  ///< of all other relations
  std::string original_format, approximation_format;
  UnitOption unit;  ///< of the original mesh
  std::string claims = "all", epsilon, witness;
  std::string prepare;  ///< empty: not given
  bool drop_sheets = false, set = false;
  std::size_t max_contacts = VerifyMeshOptions{}.max_contacts;
  std::optional<double> max_work;
  std::size_t exact_points = VerifyMeshOptions{}.exact_points;
  std::string geometry = "collision";  ///< of robots and sweeps
  std::vector<std::string> packages;   ///< of robots and sweeps
  std::string links;                   ///< of robots and sweeps
  std::string gap, base_pose;          ///< of sweeps, as all below
  std::vector<std::string> joints;
  bool degrees = false;
  std::size_t max_cells = VerifySweepOptions{}.max_cells;
  CommonOptions common;
};

/// Whether a mesh or the meshes of a motion are to be prepared.
/// @throws Error{InvalidArgument} on --prepare=wrap, which is of robots
bool is_prepared(const VerifyOptions& options);

/// Names between commas.
std::vector<std::string> split_names(const std::string& list);

inline constexpr const char* kVerifyExitCodes =
    "Exit codes: 0 verified; 1 refuted; 2 usage; 3 bad input, or not closed where a claim needs "
    "it; 4 output failed; 6 internal error; 7 undecided within limits.";

void add_claims(CLI::App& app, VerifyOptions& options, const std::vector<std::string>& names);
/// @param what  it decides
void add_epsilon(CLI::App& app, VerifyOptions& options, const char* what);
/// --prepare and --drop-sheets. @param what  is prepared
void add_preparation(CLI::App& app, VerifyOptions& options, const std::string& what);
/// --unit and --scale.
void add_unit(CLI::App& app, VerifyOptions& options);
void add_set(CLI::App& app, VerifyOptions& options);
void add_witness(CLI::App& app, VerifyOptions& options);
void add_input_format(CLI::App& app, VerifyOptions& options);
/// @param of  the file
void add_approximation_format(CLI::App& app, VerifyOptions& options, const std::string& of);
void add_limits(CLI::App& app, VerifyOptions& options);
void add_exact_points(CLI::App& app, VerifyOptions& options);
void add_links(CLI::App& app, VerifyOptions& options);
/// --geometry, --visual and --package-path. @param of  the robot
void add_geometry(CLI::App& app, VerifyOptions& options, const std::string& of);
/// --joint, --degrees, --gap and --max-cells.
void add_motion(CLI::App& app, VerifyOptions& options);

}  // namespace kaboum::tools
