#pragma once

#include <kaboum/certify/cache_folder.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/certify/wrap.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for an enclosing mesh of a file: how the file's triangles get a solid, and what
/// is made of that.
struct EnclosureRequest {
  /// Outer, and one result; its distance is measured whatever `measure` says.
  MeshRequest mesh;
  /// The format where float32 does not do and that of `mesh` holds nothing else: one that holds
  /// doubles.
  std::optional<io::Format> spare_format;
  geom::PrepareOptions preparation{.holes = geom::Holes::Fill};
  /// Set: what is enclosed is a wrap round all triangles (certify_wrap), whose distance from them
  /// counts towards epsilon. With `where_needed` only where preparing refuses them or is in doubt,
  /// or not every triangle is inside otherwise. `farthest`, `float32` and `progress` are not looked
  /// at.
  std::optional<WrapRequest> wrap;
  /// enclose_file wraps the triangles of CAD files, which stand for exact faces, of itself, so that
  /// these are enclosed. False: what is claimed is about the triangles.
  bool hold_exact_faces = true;

  /// One line of all options that the result depends on: a part of the cache's key.
  [[nodiscard]] std::string parameters() const;
};

/// Verdict whether a file's triangles lie in the solid of a mesh: decided by libverify from the
/// bytes of both. Triangles of sheets dropped on request are not asked for. Undecided as well where
/// all are inside, but which solid they bound is not known and not all that it may be is.
struct TrianglesInside {
  verify::Answer answer = verify::Answer::Undefined;
  std::string reason;             ///< of what is not verified
  std::size_t outside = 0;        ///< triangles that are known not to be inside
  std::optional<double> farther;  ///< they stick out by no more, where that is known [length]

  friend bool operator==(const TrianglesInside&, const TrianglesInside&) = default;
};

/// Certificate of an enclosing mesh. A claim only as part of a CertifiedEnclosure.
struct EnclosureCertificate {
  std::size_t vertices_in = 0, vertices = 0, triangles = 0;
  bool in_spare_format = false;  ///< the bytes: EnclosureRequest::spare_format
  double diagonal = 0;           ///< of what is enclosed [length]
  std::optional<double>
      epsilon;  ///< kept between the result and what is enclosed, a wrap's apart [length]
  /// No point of the result's surface is farther than this from the file's triangles (its exact
  /// faces), a wrap's distance included, and no point of what is enclosed from the result.
  /// [length]
  double distance_upper = 0;
  bmesh::Stop stop = bmesh::Stop::Exhausted;
  bool reached = true;  ///< MeshCertificate::reached
  bool out_of_work = false;
  Subject subject;  ///< what is enclosed
  TrianglesInside inside;
  std::vector<Claim> claims;  ///< of the mesh, as certificate_of gave them when it was made
  std::optional<WrapCertificate> wrap;
  std::vector<std::string> notes;  ///< of preparation: what a user should know of the input
};

/// A mesh that encloses that of a file, in the file's frame and unit. The bytes are those of the
/// format asked for.
using CertifiedEnclosure = Certified<geom::Mesh, EnclosureCertificate>;

/// What is claimed of it: the claims of the mesh, and that every triangle of the file is inside.
Certificate certificate_of(const CertifiedEnclosure& enclosure);

/// As in reports: a JSON object.
std::string to_json(const CertifiedEnclosure& enclosure);

/// Prepares or wraps, then certify_mesh; decides whether every triangle is inside.
/// @param mesh  as read.
/// @return nullopt when float32 is too coarse, and double is not allowed.
/// @throws Error as prepare_mesh, certify_wrap and certify_mesh; Error{InvalidArgument} where the
///   request is for an inner mesh or several; Error{InvalidInput} where the mesh stays open.
std::optional<CertifiedEnclosure> certify_enclosure(const geom::Mesh& mesh,
                                                    const EnclosureRequest& request,
                                                    const MeshHooks& hooks = {});

/// A file and what encloses it.
struct EnclosedFile {
  std::string sha256;                    ///< of the file
  std::vector<std::string> read_notes;   ///< what its reader noted
  std::vector<std::string> other_files;  ///< read besides it
  CertifiedEnclosure enclosure;
  bool cached = false;
};

/// Reads the file and finds or certifies an enclosing mesh.
/// @param format  by default by extension.
/// @param cache   null: none.
/// @throws Error naming the file, as certify_enclosure; TooCoarse (mesh_file.h).
EnclosedFile enclose_file(const std::filesystem::path& file, std::optional<io::Format> format,
                          const EnclosureRequest& request, const CacheFolder* cache = nullptr,
                          const MeshHooks& hooks = {});

}  // namespace kaboum::certify
