#pragma once

#include <kaboum/verify/inclusion.h>

#include <array>
#include <functional>
#include <vector>

#include "mesh_pair.h"

/// Parts of a chain's triangles on which the winding numbers beside them satisfy a condition.
/// docs/algorithms/exact-inclusion.md, "Parts of triangles".
namespace kaboum::verify {

using Corners = std::array<Vec3, 3>;

/// The triangles that distances are measured to: a pair's faces and, numbered after them, parts of
/// faces. Refers to both.
class Triangles {
 public:
  Triangles(const MeshPair& meshes) : meshes_(&meshes), faces_(meshes.faces().size()) {}  // NOLINT
  Triangles(const MeshPair& meshes, const std::vector<Corners>& parts)
      : meshes_(&meshes), faces_(meshes.faces().size()), parts_(parts.data()) {}

  [[nodiscard]] const Vec3& corner(std::uint32_t t, int k) const {
    return t < faces_ ? meshes_->corner(t, k) : parts_[t - faces_][static_cast<std::size_t>(k)];
  }
  [[nodiscard]] const BoxTree& tree(int chain) const { return meshes_->tree(chain); }

 private:
  const MeshPair* meshes_;
  std::size_t faces_;
  const Corners* parts_ = nullptr;
};

/// Trees of what lies in a part of a chain's surface for sure, and of what holds all of that part.
struct Pieces {
  std::vector<Corners> parts;  ///< numbered as in Triangles
  BoxTree surely, perhaps;
};

/// The part of a chain's surface on which the winding numbers of the chain on the inner and the
/// outer side satisfy a condition, as whole faces and parts of faces. Corners of parts are rounded
/// by less than rounding_of_distances allows for. What options.max_work leaves undone may be a
/// part.
/// @throws Error{LimitReached} beyond the limits on contacts
Pieces pieces_with(const MeshPair& meshes, int chain, const InclusionOptions& options,
                   const std::function<bool(int inner, int outer)>& condition);

}  // namespace kaboum::verify
