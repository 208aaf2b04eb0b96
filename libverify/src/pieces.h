#pragma once

#include <kaboum/verify/inclusion.h>

#include <array>
#include <functional>
#include <vector>

#include "scene.h"

/// Parts of a chain's triangles on which the winding numbers beside them satisfy a condition.
/// docs/algorithms/exact-inclusion.md, "Parts of triangles".
namespace kaboum::verify {

using Corners = std::array<Vec3, 3>;

/// The triangles that distances are measured to: a scene's faces and, numbered after them, parts of
/// faces. Refers to both.
class Triangles {
 public:
  Triangles(const Scene& scene) : scene_(&scene), faces_(scene.faces().size()) {}  // NOLINT
  Triangles(const Scene& scene, const std::vector<Corners>& parts)
      : scene_(&scene), faces_(scene.faces().size()), parts_(parts.data()) {}

  [[nodiscard]] const Vec3& corner(std::uint32_t t, int k) const {
    return t < faces_ ? scene_->corner(t, k) : parts_[t - faces_][static_cast<std::size_t>(k)];
  }
  [[nodiscard]] const BoxTree& tree(int chain) const { return scene_->tree(chain); }

 private:
  const Scene* scene_;
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
Pieces pieces_with(const Scene& scene, int chain, const InclusionOptions& options,
                   const std::function<bool(int inner, int outer)>& condition);

}  // namespace kaboum::verify
