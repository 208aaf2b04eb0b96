#pragma once

#include <kaboum/bmesh/decimate.h>

#include <cstdint>
#include <vector>

#include "change.h"
#include "collapse_evaluator.h"
#include "error_bound_certificate.h"
#include "reference_solid.h"
#include "sampled_error.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// Gives room to vertices that cannot move. Outwards, a vertex has room if some point lies in front
/// of all planes around it; where edges at it are concave, there may be none. Flipping a concave
/// edge fills it with a tetrahedron, and takes it away from the vertex: with the last one gone,
/// there is room (inwards likewise, with convex edges, which are cut off).
class Loosener {
 public:
  /// All references must outlive this object; pointers may be null.
  Loosener(const Context& context, WorkingMesh& mesh, ReferenceSolid* solid,
           ErrorBoundCertificate* certificate, SampledError* sampled, std::vector<Step>* steps,
           DecimateStatistics& statistics);

  /// Flips the edge at v that changes the volume least, of those that exact tests, the error bound
  /// and the shape of the triangles admit. @return whether there was one.
  bool loosen(std::uint32_t v);

 private:
  struct Edge {
    std::uint32_t a, b, c, d;     // triangles (a, b, c) and (b, a, d)
    std::uint32_t first, second;  // these
    double volume;
  };

  void find(std::uint32_t a, std::uint32_t b);
  bool bends(Edge& e) const;
  bool admits(const Edge& e);
  void flip(const Edge& e);

  const Context& context_;
  WorkingMesh& m_;
  ReferenceSolid* solid_;
  ErrorBoundCertificate* certificate_;
  SampledError* sampled_;
  std::vector<Step>* steps_;
  DecimateStatistics& statistics_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> removed_;
  std::vector<NewTriangle> added_;
};

}  // namespace kaboum::bmesh
