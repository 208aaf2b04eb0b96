#pragma once

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// What `bound-verify sweep ROBOT PATH SWEPT` is asked.
struct VerifySweepOptions {
  std::vector<std::string> files;  ///< robot, path, swept set
  std::string links, geometry = "collision", gap, claims = "all", witness, set_format;
  std::vector<std::string> packages, joints;  ///< joints: of --joint
  std::string base_pose;                      ///< as --base-pose; empty: the origin
  bool prepare = false, drop_sheets = false;  ///< the links' meshes, as bcd-decompose does
  bool degrees = false;                       ///< angles of the path and of --joint
  std::size_t max_cells = 20000;
  std::size_t exact_points = 0;  ///< of CAD files; 0: triangles alone
};

/// Decides the claims, prints and reports them. @return the exit code.
/// @throws Error on bad input.
int verify_sweep(const VerifySweepOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
