#pragma once

#include <kaboum/base/option.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/points.h>

#include <array>
#include <utility>

namespace kaboum::verify {

/// How a mesh is judged against what was made of it.
struct MeshVerdictOptions {
  Claims claims = Claims::All;    ///< those that decide
  std::optional<Length> epsilon;  ///< bound of the distances, if one is to be decided
  bool prepare = false;           ///< the original as geom::prepare makes it, holes filled
  bool drop_sheets = false;       ///< with `prepare`
  std::size_t max_contacts = InclusionOptions{}.max_contacts;
  std::optional<double> max_work;            ///< InclusionOptions::max_work [s]
  std::size_t exact_points = kPointDensity;  ///< of CAD files; 0: triangles alone
};

/// The options of whether one mesh encloses the other.
const std::vector<Option<MeshVerdictOptions>>& mesh_verdict_options();
/// The options of whether convex bodies cover a mesh.
const std::vector<Option<MeshVerdictOptions>>& cover_verdict_options();

/// Why such options do not go together, as `meaning` takes it; empty: they do.
std::string contradiction(const MeshVerdictOptions& options);

/// Names of the claims that decide.
inline constexpr std::array<std::pair<const char*, Claims>, 3> kClaims{
    {{"all", Claims::All}, {"solid", Claims::Solid}, {"surface", Claims::Surface}}};
const char* name_of(Claims claims);
/// Names of how a mesh is prepared; without one it is judged as it is.
inline constexpr std::array<std::pair<const char*, bool>, 1> kPrepared{{{"auto", true}}};

/// What options of several verdicts are. Each request has its own members for them.
OptionDescription claims_option();
OptionDescription drop_sheets_option();
OptionDescription max_contacts_option();
OptionDescription max_work_option();
OptionDescription exact_points_option();
/// What preparing is, for texts: "parts that are inside out turned, …".
std::string preparation_words();

}  // namespace kaboum::verify
