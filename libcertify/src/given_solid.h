#pragma once

#include <kaboum/certify/wrap.h>
#include <kaboum/geom/prepare.h>

#include <functional>
#include <optional>
#include <string>

// What stands for triangles. Internal to kaboum_certify.
namespace kaboum::certify {

/// The solid that stands for the triangles of a file.
struct GivenSolid {
  geom::Prepared prepared;
  std::optional<CertifiedWrap> wrap;  ///< then it is this one's, prepared
  std::string why;                    ///< the wrap was needed, where it was not asked for
  /// What was wrapped: the triangles, and those that fill holes.
  geom::Mesh wrapped;
};

/// geom::prepare, or prepare_mesh, which refuses more.
using Prepare = geom::Prepared (*)(const geom::Mesh&, const geom::PrepareOptions&);

/// Prepares, or wraps where that is asked for or needed.
/// @param wrap     as asked for; none: prepared, or refused
/// @param make     makes a wrap of these triangles
/// @param because  wraps all the same, for this reason; empty: there is none
/// @throws Error{InvalidInput} as `prepare` and `make`, which names both reasons where one was
///   needed
GivenSolid give_solid(const geom::Mesh& mesh, Prepare prepare, const geom::PrepareOptions& options,
                      const std::optional<WrapRequest>& wrap,
                      const std::function<CertifiedWrap(const geom::Mesh&)>& make,
                      const std::string& because = {});

/// Nothing was turned, dropped or filled, and nothing counts as hollow: the solid of what was
/// prepared is that of the prepared mesh.
bool is_as_it_was(const geom::PreparationReport& report);

/// Why it is not known whether a result holds all that triangles, which are inside, are meant to
/// bound; empty: it does. Decided as the verifier does.
/// @param outer  closed, and holds the prepared solid
std::string undecided_solid(const geom::Mesh& mesh, const geom::Prepared& prepared,
                            const geom::PrepareOptions& options, const geom::Mesh& outer);

/// The triangles, and those that fill their holes: the solid that is closed so is wrapped, too.
geom::Mesh with_fillings(geom::Mesh mesh, const geom::SolidMesh& solid);

/// The triangles, and those of the other way of splitting quads that are not plane.
geom::Mesh with_other_diagonals(geom::Mesh mesh, const geom::PrepareOptions& options);

/// The sentence that says so.
std::string why_wrapped(const std::string& why);

}  // namespace kaboum::certify
