#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh_pair.h"

namespace kaboum::verify {

/// Where the faces of one chain X meet those of a chain C, as far as it matters for the cells that
/// C cuts X's faces into: contacts in single points and along edges with the same two vertices are
/// left out. docs/algorithms/exact-inclusion.md, "Pairs".
class Contacts {
 public:
  /// The face is cut: `by` meets its interior in a segment, or covers a part of it in its plane.
  struct Cut {
    std::uint32_t face;
    std::uint32_t by;
    bool coplanar;
  };
  /// An edge of the face lies along `on`, on the whole of its length or a part of it.
  struct Along {
    std::uint32_t face;
    std::uint32_t on;
    std::uint8_t edge;  ///< from corner `edge` to the next
    bool whole;
    bool held = false;  ///< the face lies in `on`, in its plane
  };

  Contacts() = default;
  /// Sorts; keeps nothing but what is given. `begin`, `end`: the faces of X.
  Contacts(std::uint32_t begin, std::uint32_t end, std::vector<Cut> cuts,
           std::vector<Along> alongs);

  /// C does not cut the face: it is one cell.
  [[nodiscard]] bool uncut(std::uint32_t face) const { return cuts(face).empty(); }
  [[nodiscard]] std::span<const Cut> cuts(std::uint32_t face) const {
    return {cuts_.data() + first_cut_[face - begin_], cuts_.data() + first_cut_[face - begin_ + 1]};
  }
  [[nodiscard]] std::span<const Along> alongs(std::uint32_t face) const {
    return {alongs_.data() + first_along_[face - begin_],
            alongs_.data() + first_along_[face - begin_ + 1]};
  }
  [[nodiscard]] std::size_t cut_count() const { return cuts_.size(); }

 private:
  std::uint32_t begin_ = 0;
  std::vector<Cut> cuts_;
  std::vector<Along> alongs_;
  std::vector<std::uint32_t> first_cut_, first_along_;
};

/// When to give up.
struct ContactLimits {
  std::size_t contacts;
  std::size_t pairs;                              ///< looked at
  std::atomic<std::size_t>* looked_at = nullptr;  ///< receives their number, when not null
};

/// Contacts of X's faces with Y's, and of Y's with X's; X ≠ Y. Parallel; the result does not depend
/// on the number of threads.
/// @throws Error{LimitReached}
struct MutualContacts {
  Contacts of_inside;
  Contacts of_outside;
};
MutualContacts contacts_between(const MeshPair& meshes, const ContactLimits& limits);

/// Contacts of a chain's faces with each other.
Contacts contacts_within(const MeshPair& meshes, int chain, const ContactLimits& limits);

/// The segment in which two faces that are not coplanar meet, as the ends of it in either face: the
/// places where an edge crosses the other face's plane.
struct Crossing {
  /// Vertices of an edge: `from` above the other's plane, `to` below, one of them possibly on it.
  struct End {
    std::uint32_t from, to;
  };
  std::array<End, 2> ends;  ///< those of this face with the other's plane
  int edge = -1;            ///< ≥ 0: the segment is this edge of the face
  bool exists = false;      ///< the face meets the plane in a segment, not only in a point
};
/// Where face f meets the plane that its corners have the given sides of.
Crossing crossing(const Face& f, const std::array<Sign, 3>& sides);
/// Sides of f's corners with respect to g's plane; common vertices are on it.
template <class Meshes>
std::array<Sign, 3> sides_of(const Meshes& meshes, const Face& f, std::uint32_t g) {
  std::array<Sign, 3> sides;
  for (int k = 0; k < 3; ++k) {
    sides[k] =
        meshes.face(g).place_of(f.v[k]) >= 0 ? Sign::Zero : meshes.side(g, meshes.point(f.v[k]));
  }
  return sides;
}
/// Order of two ends along the common line of both planes: `p` of one face, `q` of the other.
template <class Meshes>
Sign order_of(const Meshes& meshes, const Crossing::End& p, const Crossing::End& q) {
  if (p.from == q.from || p.from == q.to || p.to == q.from || p.to == q.to) return Sign::Zero;
  return geom::orient3d(meshes.point(p.from), meshes.point(p.to), meshes.point(q.from),
                        meshes.point(q.to));
}

}  // namespace kaboum::verify
