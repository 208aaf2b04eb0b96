#pragma once

#include <kaboum/bmesh/decimate.h>
#include <kaboum/certify/certificate.h>
#include <kaboum/certify/subject.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/inclusion.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// The surface claim, decided for every triangle: of the original, walls that cancelled and fills
/// of holes included (outer), or of the result (inner). Of a wrapped input: of all its triangles.
struct DecidedSurface {
  /// Triangles: of the original (inner: of the result), then its walls.
  verify::Claim claim;
  std::size_t looked_at = 0;   ///< triangles that the solid claim does not protect
  std::size_t left_out = 0;    ///< triangles that it leaves open, for the work allowed was done
  verify::Bracket sticks_out;  ///< if it is refuted and leaves none open; triangle: of the input
  bool at_filling = false;     ///< its triangle fills a hole: not one of the input
};

/// Verdict of libverify on the bytes.
struct DecidedMesh {
  verify::Inclusion inclusion;
  std::optional<verify::Answer> nested;  ///< in, or round, the finer result before
  double distance_bound = 0;             ///< of the two claims about distances [length]
  verify::Answer original_to_result = verify::Answer::Undefined;
  verify::Answer result_to_original = verify::Answer::Undefined;
};

/// Places at which a result is far from the original: without measuring, so no bound.
struct Outliers {
  double beyond_box = 0;  ///< how far it reaches beyond the original's bounding box [length]
  double away = 0;        ///< largest distance of some vertices of the original from it [length]
};

/// Certificate of a bounding mesh. Claims are made of a CertifiedMesh only.
struct MeshCertificate {
  bmesh::Direction direction = bmesh::Direction::Outer;
  bool keep_convex = false;
  bool closed = true;     ///< the original, as prepared, has a solid; else nothing is enclosed
  Subject subject;        ///< what is enclosed, or encloses
  std::size_t finer = 0;  ///< results before it in its series
  std::optional<std::size_t> requested;  ///< number of vertices
  std::size_t vertices = 0;
  bmesh::Stop stop = bmesh::Stop::Exhausted;
  bmesh::DecimateStatistics statistics;
  bool out_of_work = false;  ///< with more work it might be nearer
  std::size_t steps = 0;     ///< number of those of the series that lead to it
  bool double_precision = false;
  std::optional<double> epsilon;  ///< kept [length]
  /// Certified brackets of the largest distance, surface to surface.
  std::optional<geom::DirectedDistance> original_to_result, result_to_original;
  std::optional<DecidedMesh> decided;
  std::optional<DecidedSurface> surface;  ///< unless nothing is enclosed
  Outliers outliers;

  /// Upper bound of the Hausdorff distance. [length] @pre it was measured
  [[nodiscard]] double hausdorff_upper() const;

  /// Answer whether triangles are where they are claimed to be; Undefined: nothing is claimed.
  [[nodiscard]] verify::Answer surface_answer() const;

  /// True if there are as few vertices as requested, or epsilon allows no fewer.
  [[nodiscard]] bool reached() const;
};

}  // namespace kaboum::certify
