#pragma once

#include <array>
#include <optional>

#include "allowance.h"
#include "contacts.h"
#include "mesh_pair.h"

namespace kaboum::verify {

/// The meshes and the contacts that have been asked for so far.
class Arrangement {
 public:
  /// @param allowance  counts the work where it is limited; then contacts are not sought with all
  ///   that is left
  Arrangement(const MeshPair& meshes, const ContactLimits& limits, Allowance* allowance = nullptr)
      : meshes_(meshes), limits_(limits), allowance_(allowance) {}

  /// Finds the contacts between the two chains, or of a chain with itself, if not known yet.
  /// @throws Error{LimitReached}
  void need_mutual();
  void need_own(int chain);

  /// Pairs of faces of different chains in which one cuts the other, as far as they were asked for.
  [[nodiscard]] std::size_t mutual_cuts() const {
    std::size_t count = 0;
    for (int c = 0; c < 2; ++c) {
      if (contacts_[c][1 - c]) count += contacts_[c][1 - c]->cut_count();
    }
    return count;
  }

  [[nodiscard]] const MeshPair& meshes() const { return meshes_; }
  /// @pre they were asked for
  [[nodiscard]] const Contacts& contacts(int of, int with) const { return *contacts_[of][with]; }
  /// No chain of the mask cuts the face.
  [[nodiscard]] bool uncut(std::uint32_t face, OperandMask with) const {
    const int of = meshes_.face(face).chain;
    for (int c = 0; c < 2; ++c) {
      if ((with & mask_of(c)) != 0 && !contacts_[of][c]->uncut(face)) return false;
    }
    return true;
  }

 private:
  /// within(limits) in what is allowed.
  template <class Search>
  auto limited(const Search& search) const;

  const MeshPair& meshes_;
  ContactLimits limits_;
  Allowance* allowance_;
  std::array<std::array<std::optional<Contacts>, 2>, 2> contacts_;
};

/// A side of a face: +1 outer, −1 inner.
using Side = int;
inline constexpr Side kInner = -1;
inline constexpr Side kOuter = 1;

/// Groups the faces of `chain` that the chains of `mask` leave whole into patches: from one face to
/// its neighbour in the patch one can walk on the given side without crossing the chains of `mask`.
/// @return per face of the chain (counted from its first) the lowest number, so counted, of its
///   patch; for faces that are cut, their own number.
std::vector<std::uint32_t> patches(const Arrangement& arrangement, int chain, OperandMask mask,
                                   Side side);

}  // namespace kaboum::verify
