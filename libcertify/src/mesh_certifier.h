#pragma once

#include <kaboum/certify/mesh.h>

#include <optional>
#include <vector>

#include "mesh_surface.h"

// From candidates to certified meshes. Internal to kaboum_certify.
namespace kaboum::certify {

/// @throws Error{InvalidInput} when the original would enclose nothing by itself.
void require_extent(const geom::Prepared& original);

/// @throws Error{InvalidInput} when all triangles are segments or points, exactly.
void require_area(const geom::Mesh& mesh);

/// The options of the search; targets and callbacks apart.
bmesh::DecimateOptions search_options(const MeshRequest& request, const MeshPlan& plan);

/// Certifies candidates for one request, finest first. Whatever made them: with
/// MeshRequest::decide no claim is made that libverify refutes.
class MeshCertifier {
 public:
  /// All are referred to.
  /// @param wrapped  the input, where the original is a wrap whose solid holds all of its triangles
  MeshCertifier(const geom::Prepared& original, const MeshRequest& request, const MeshPlan& plan,
                const MeshHooks& hooks, const geom::Mesh* wrapped = nullptr)
      : original_(original),
        request_(request),
        plan_(plan),
        hooks_(hooks),
        wrapped_(wrapped),
        claimed_(original) {}

  /// @param candidates  one for each number of vertices asked for, or one
  /// @throws Error{Internal} when a claim is refuted, or the bytes do not hold the mesh.
  std::vector<CertifiedMesh> certify(std::vector<bmesh::DecimateResult> candidates);

 private:
  /// One result while its certificate is made.
  struct Candidate {
    geom::Mesh mesh;
    MeshCertificate certificate;
    std::vector<char> bytes;
  };
  [[nodiscard]] static Candidate repeated(const Candidate& from, std::size_t place,
                                          std::size_t requested);
  [[nodiscard]] Candidate begin(bmesh::DecimateResult candidate, std::size_t place);
  void measure(Candidate& made) const;
  void decide(Candidate& made, const Candidate* before) const;
  void look_at_surface(Candidate& made, double work);
  [[nodiscard]] DecidedSurface decided_surface(const Candidate& made);
  [[nodiscard]] Outliers outliers(const geom::Mesh& result) const;

  void show(const std::string& stage) const {
    if (hooks_.progress) hooks_.progress(stage);
  }
  [[nodiscard]] bool outer() const { return request_.direction == bmesh::Direction::Outer; }

  const geom::Prepared& original_;
  const MeshRequest& request_;
  const MeshPlan& plan_;
  const MeshHooks& hooks_;
  const geom::Mesh* wrapped_;
  ClaimedSurface claimed_;
  std::size_t steps_ = 0;  // of the candidates begun
};

}  // namespace kaboum::certify
