#pragma once

#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "closed_forms.h"
#include "meeting.h"
#include "poses.h"

namespace kaboum::collide::detail {

/// Two sets at their places, in the frame of one of them: its bodies face those of the other one,
/// the lanes, one by one. docs/algorithms/bounded-predicates.md, "Boxes" and "Closed forms".
class Facings {
 public:
  static constexpr std::size_t kBlock = BoundingSet::kBlock;

  Facings(const PosedSet& faces, const PosedSet& lanes, double slack);

  /// Calls visit(from, near) until it is true: bit k of `near` is set where the box of body
  /// from + k that faces meets that of all lanes; for blocks of 64 bodies in which there is one.
  template <typename Visit>
  [[nodiscard]] bool any_block(const Visit& visit) const {
    if (empty_) return false;
    const auto& levels = faces_->set().levels_;
    return any_of_level(levels.size() - 1, 0, levels.back().count, visit);
  }

  /// Calls visit(face, lane) until it is true, for pairs of bodies whose boxes meet.
  template <typename Visit>
  [[nodiscard]] bool any_pair(const Visit& visit) const {
    return any_block([&](std::size_t from, std::uint64_t near) {
      const BoxRows rows = rows_of(0);
      for (std::size_t lane = 0; lane < lanes_->set().size(); ++lane) {
        const FloatBox box = moved(*lanes_, lane, relation_);
        for (std::uint64_t left = near; left != 0; left &= left - 1) {
          const std::size_t face = from + static_cast<std::size_t>(std::countr_zero(left));
          if (meeting_boxes(rows, face, 1, box, false) != 0 && visit(face, lane)) return true;
        }
      }
      return false;
    });
  }

  /// The first lane below `end` whose body meets one that faces; `end` for none. What closed forms
  /// leave open is asked of meet(face, lane).
  template <typename Meet>
  [[nodiscard]] std::size_t first_to_meet(std::size_t face, std::size_t end, const Meet& meet,
                                          Decided* decided) const {
    const Shapes& shapes = *lanes_->set().shapes_;
    const bool many = shapes.lanes.size() > kFew;
    const FloatBox own = many ? seen(face) : FloatBox{};
    Facing facing;
    if (in_floats_ && !face_lanes(face, facing)) return end;
    for (const Lanes& lanes : shapes.lanes) {
      if (lanes.body[0] >= end || (many && !overlap(own, lanes.box))) continue;
      const Verdicts verdicts = in_floats_ ? look(lanes, facing) : Verdicts{};
      unsigned open = ((1U << lanes.count) - 1) & ~verdicts.apart;
      for (; open != 0; open &= open - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(open));
        if (lanes.body[lane] >= end) break;
        const bool met = (verdicts.meet >> lane & 1U) != 0;
        if (met && decided != nullptr) ++decided->rounded;
        if (!met && !meet(face, lanes.body[lane])) continue;
        end = lanes.body[lane];
        break;
      }
    }
    return end;
  }

 private:
  static constexpr std::size_t kFew = 2;  ///< eights of lanes that are looked at without more ado

  static bool overlap(const FloatBox& a, const geom::Box3& b) {
    for (int k = 0; k < 3; ++k)
      if (a.low[k] > b.max[k] || b.min[k] > a.high[k]) return false;  // NaN: not known
    return true;
  }
  [[nodiscard]] BoxRows rows_of(std::size_t level) const {
    const BoundingSet& set = faces_->set();
    const auto row = [&](std::size_t k) { return set.rows_.data() + set.levels_[level].at(k); };
    return {{row(0), row(1), row(2)}, {row(3), row(4), row(5)}};
  }

  template <typename Visit>
  [[nodiscard]] bool any_of_level(std::size_t level, std::size_t from, std::size_t count,
                                  const Visit& visit) const {
    std::uint64_t near = meeting_boxes(rows_of(level), from, count, whole_.box);
    if (level == 0) return near != 0 && visit(from, near);
    const std::size_t below = faces_->set().levels_[level - 1].count;
    for (; near != 0; near &= near - 1) {
      const std::size_t first = kBlock * (from + static_cast<std::size_t>(std::countr_zero(near)));
      if (any_of_level(level - 1, first, std::min(below - first, kBlock), visit)) return true;
    }
    return false;
  }

  /// A box in the other frame that holds a body of one of the sets, and all that it may meet.
  [[nodiscard]] FloatBox moved(const PosedSet& set, std::size_t body,
                               const Relation& relation) const;
  /// Of a body that faces.
  [[nodiscard]] FloatBox seen(std::size_t face) const;
  /// @return false where it is beyond all lanes
  bool face_lanes(std::size_t face, Facing& out) const;

  const PosedSet *faces_, *lanes_;
  Relation relation_;  ///< of the lanes' frame, in the faces'
  double reach_ = 0;   ///< errors and slack [length]
  double size_ = 0;    ///< of all coordinates [length]
  bool in_floats_ = false, empty_ = true;
  MovedBox whole_;  ///< of all lanes; its centre is the lanes' origin
};

}  // namespace kaboum::collide::detail
