#pragma once

#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/mesh_verdict.h>

#include <string>

#include "common/cli.h"
#include "common/unit_option.h"

namespace kaboum::tools {

/// What `bound-verify mesh` and `bound-verify cover` are asked.
struct VerifyMeshOptions {
  verify::Relation relation = verify::Relation::Outer;
  std::string original, approximation;  ///< `-`: standard input
  std::string original_format, approximation_format;
  UnitOption unit;  ///< of the original
  std::string epsilon, witness, claims = "all";
  bool prepare = false, drop_sheets = false;
  bool set = false;  ///< the approximation is a set, whatever the file looks like
  std::size_t max_contacts = verify::InclusionOptions{}.max_contacts;
  std::optional<double> max_work;
  std::size_t exact_points = verify::kPointDensity;  ///< of CAD files; 0: triangles alone
};

/// Decides the claims, prints and reports them.
/// @return the exit code.
/// @throws Error on bad input, and where the claims are not defined.
int verify_mesh(const VerifyMeshOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
