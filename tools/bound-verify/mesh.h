#pragma once

#include <kaboum/verify/mesh_verdict.h>
#include <kaboum/verify/verdict_options.h>

#include <optional>
#include <string>

#include "common/cli.h"
#include "common/unit_option.h"

namespace kaboum::tools {

/// What `bound-verify mesh` and `bound-verify cover` are asked.
struct VerifyMeshOptions {
  verify::Relation relation = verify::Relation::Outer;
  std::string original, approximation;  ///< `-`: standard input
  InputFormat original_format;
  std::string approximation_format;
  UnitOption unit;  ///< of the original
  std::string witness;
  bool set = false;  ///< the approximation is a set, whatever the file looks like
  verify::MeshVerdictOptions how;
  std::optional<std::string> epsilon_map;  ///< file of regions with bounds of their own, of a cover
};

/// Decides the claims, prints and reports them.
/// @return the exit code.
/// @throws Error on bad input, and where the claims are not defined.
int verify_mesh(const VerifyMeshOptions& options, const CommonOptions& common);

}  // namespace kaboum::tools
