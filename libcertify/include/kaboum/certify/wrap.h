#pragma once

#include <kaboum/base/length.h>
#include <kaboum/certify/certificate.h>
#include <kaboum/certify/certified.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/io/mesh_io.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

struct WrapRequest {
  /// The wrap takes the place of the prepared mesh only where that is needed: preparing refuses the
  /// triangles, or is in doubt about what they enclose (geom::doubt_about). Then holes that it
  /// filled are wrapped as well. certify_wrap does not look at it.
  bool where_needed = false;
  /// Largest distance of the wrap from the input where it can get near it [a quarter of `farthest`,
  /// else 0.1 %]; percentages are of the diagonal.
  std::optional<Length> offset;
  /// Hollows behind gaps narrower than this are filled [found, so that `farthest` is kept; else
  /// 1 %].
  std::optional<Length> seal;
  /// No point of the wrap may be farther from the input. [length]
  std::optional<double> farthest;
  /// The surface that is meant is within this of the triangles (io::ReadResult::deviation), and is
  /// to be inside as well. [length]
  double clearance = 0;
  /// Quads that are not plane (io::ReadResult::bent_quads): both ways of splitting them are to be
  /// inside.
  std::vector<std::uint32_t> quads = {};
  /// Number of given triangles that are the input's: the rest fills its holes or is another way of
  /// splitting its quads [all].
  std::optional<std::size_t> input_triangles;
  bool float32 = true;         ///< numbers of the wrap; else doubles
  bool may_be_double = false;  ///< doubles stand in for float32 where that is too coarse
  std::function<void(const std::string& stage)> progress;
};

/// Has a file's triangles wrapped clear of the exact faces that they stand for. Wraps
/// that are asked for get the clearance, and where none is, one is made if `hold` says so.
void hold_exact_faces(const io::ReadResult& read, bool hold, std::optional<WrapRequest>& wrap);

/// @throws Error{InvalidInput}: an epsilon that leaves nothing beside the deviation of exact faces.
[[noreturn]] void refuse_deviation(double clearance);

struct WrapCertificate {
  double offset = 0, seal = 0;  ///< as wrapped [length]
  double diagonal = 0;          ///< of the input's box [length]
  /// Certified bracket of the largest distance of the wrap's points from the input's triangles, and
  /// a point that is so far away. [length]
  double farthest_lower = 0, farthest_upper = 0;
  geom::Vec3 at = geom::Vec3::Zero();
  double clearance = 0;  ///< no point of the wrap is nearer to the input, by the proof [length]
  std::size_t input_triangles = 0;
};

/// Description of a wrap, in one sentence.
std::string in_words(const WrapCertificate& wrap);

/// As in reports: a JSON object.
std::string to_json(const WrapCertificate& wrap);

/// A closed mesh whose solid holds every triangle of the input: decided by libverify.
using CertifiedWrap = Certified<geom::Mesh, WrapCertificate>;

/// What is claimed of it: every triangle is inside.
Certificate certificate_of(const CertifiedWrap& wrap);

/// Wraps any triangles (wrap::wrap), measures how far the wrap reaches, and has libverify decide
/// that every triangle lies inside, exactly. docs/algorithms/wrapping.md
///
/// Its bytes are empty: who writes it serialises it (serialise_checked).
///
/// @throws Error{InvalidInput} when there is nothing to wrap, coordinates are too large, or the
/// wrap
///   reaches farther than it may; Error{InvalidArgument} on lengths that are not positive;
///   Error{LimitReached} when carving or deciding takes too much; Error{Internal} when
///   libverify refutes it.
CertifiedWrap certify_wrap(const geom::Mesh& input, const WrapRequest& request);

}  // namespace kaboum::certify
