#pragma once

#include <kaboum/verify/claims.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/region_excess.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Verdict on one mesh of a link.
struct HeldShape {
  Answer answer = Answer::Undefined;
  std::string reason;                   ///< one clause, where no decision about the claims says it
  bool solid = false, surface = false;  ///< the claims that count
  std::optional<Claim> decisive;        ///< the worst of these
  std::optional<Inclusion> inclusion;   ///< where it was decided
  bool prepare_helps = false;           ///< it is inside out, which preparing mends
};

/// Distance of meshes from what holds them.
struct HeldDistance {
  std::optional<DistanceClaim> claim;  ///< none: not all of what is to hold is closed
  bool to_solid = true;                ///< else to the surface, as a mesh is open
  bool of_surface = false;  ///< of what holds, as not all of it is convex: else of all its points
};

/// The meshes of a result that have one frame of a link, of which each, or several together, are to
/// hold meshes of the original with the same frame.
class Holders {
 public:
  struct NamedMesh {
    std::string name;
    const geom::Mesh* mesh;
  };

  /// Those that are open or inside out hold nothing, and are left out. The sum of the others winds
  /// about a point only where one of them does.
  explicit Holders(const std::vector<NamedMesh>& meshes);

  /// Decides whether the mesh is in the union of the holders. Refuted where none was given, or the
  /// only one is left out and its triangles do not lie in what that one winds round. Where there
  /// are several and they are not all convex, negative windings of one may hide what another holds:
  /// what would be refuted is undecided then.
  /// @throws as verify_inclusion
  [[nodiscard]] HeldShape hold(const geom::Mesh& mesh, Claims claims,
                               const InclusionOptions& limits = {}) const;

  /// The same of a mesh that is closed whichever way it is oriented: one that is inside out is
  /// judged as it is.
  [[nodiscard]] HeldShape hold_any(const geom::Mesh& mesh, Claims claims,
                                   const InclusionOptions& limits = {}) const;
  /// Decides whether the mesh is in the sum of the holders. @pre there are some
  [[nodiscard]] Inclusion inclusion_of(const geom::Mesh& mesh,
                                       const InclusionOptions& limits) const {
    return verify_inclusion(mesh, sum_, limits);
  }

  /// Decides whether no point of the holders is farther than `bound` from the solids of the meshes;
  /// where they are not all convex, no point of their surfaces.
  /// @pre bound > 0 [length, as the meshes]
  [[nodiscard]] HeldDistance distance(const std::vector<geom::Mesh>& meshes, double bound,
                                      const InclusionOptions& limits = {}) const;

  /// Decides whether no point of the holders in a region is farther than its epsilon from the
  /// solids of the meshes. Of holders that are not all convex it is not decided.
  /// @pre as distance; as verify_region_excess [length, as the meshes]
  [[nodiscard]] HeldDistance distance_in_region(const std::vector<geom::Mesh>& meshes,
                                                const geom::BoundedRegion& region,
                                                const InclusionOptions& limits = {}) const;

  /// The ones that hold.
  [[nodiscard]] const geom::ConvexSet& set() const { return set_; }
  [[nodiscard]] const Claim& convex() const { return convex_; }
  [[nodiscard]] bool all_convex() const { return convex_.answer == Answer::Verified; }
  /// True if what is not in their sum is in none of them.
  [[nodiscard]] bool refutes() const { return all_convex() || set_.bodies.size() < 2; }
  [[nodiscard]] const geom::Mesh& sum() const { return sum_; }
  /// Names of those that are left out, and why.
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& left_out() const {
    return left_out_;
  }

 private:
  /// True if the only mesh, which is open or inside out, does not hold all triangles of another.
  [[nodiscard]] bool lone_refutes(const geom::Mesh& mesh, const InclusionOptions& limits) const;

  std::size_t given_;
  std::optional<geom::Mesh> lone_;  ///< the only mesh, where it is left out
  geom::ConvexSet set_;
  geom::Mesh sum_;
  Claim convex_;
  std::vector<std::pair<std::string, std::string>> left_out_;
};

}  // namespace kaboum::verify
