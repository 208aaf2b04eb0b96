#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/four_triangles.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace kaboum::geom {

/// Hierarchy over triangles of which four boxes, and four triangles, are compared with a point at
/// once, in single precision: that decides nothing but where to look. Made of a Bvh, whose order of
/// triangles it has: a triangle's place is its index there.
class WideBvh {
 public:
  WideBvh() = default;
  WideBvh(const Mesh& mesh, const Bvh& bvh);

  [[nodiscard]] const UnitFrame& frame() const { return frame_; }

  /// Calls visit(place) for triangles that may be nearer to p than the length that frame().cutoff
  /// gave `cutoff`, which visit may lower; the nearest boxes come first. Near the mesh none that
  /// is nearer is left out; at a distance of many of its sizes, those that are by less than a
  /// millionth. Ends where done() is true after a leaf.
  /// @return boxes and leaves looked at
  template <class Done, class Visit>
  std::uint64_t visit_near(const Vec3& p, const float& cutoff, const Done& done,
                           const Visit& visit) const {
    if (packs_.empty()) return 0;
    const Eigen::Vector3f x = frame_(p);
    struct Entry {
      float squared;
      std::uint32_t node;
    };
    std::array<Entry, 3 * Bvh::kMaxDepth + 1> stack;
    std::size_t size = 0;
    stack[size++] = {0, root_};
    std::uint64_t visited = 1;
    while (size > 0 && !done()) {
      const Entry entry = stack[--size];
      if (!(entry.squared < cutoff)) continue;
      ++visited;
      if ((entry.node & kLeaf) != 0) {
        visit_leaf(entry.node & ~kLeaf, x, cutoff, visit);
        continue;
      }
      const Node& node = nodes_[entry.node];
      const Float4 bound = squared_distance(node.low, node.high, x);
      // The nearest comes last.
      const std::size_t first = size;
      for (unsigned bits = bits_below(bound, cutoff); bits != 0; bits &= bits - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(bits));
        std::size_t at = size++;
        for (; at > first && stack[at - 1].squared < bound[i]; --at) stack[at] = stack[at - 1];
        stack[at] = {bound[i], node.child[i]};
      }
    }
    return visited;
  }

  /// The leaves near a ball, for many points in it.
  class Vicinity {
   public:
    /// Whether all that is as near to p as that is held.
    [[nodiscard]] bool holds(const Vec3& p, double squared) const {
      return (p - center_).norm() + std::sqrt(squared) <= radius_;
    }

   private:
    friend class WideBvh;
    struct FourLeaves {
      std::array<Float4, 3> low, high;
      std::array<std::uint32_t, 4> leaf;
    };
    Vec3 center_ = Vec3::Zero();
    double radius_ = -1;
    std::vector<FourLeaves> leaves_;
  };

  /// Makes the vicinity hold all in the ball. @return boxes looked at
  std::uint64_t gather(const Vec3& center, double radius, Vicinity& out) const;

  /// As the other, of a vicinity that holds p with what `cutoff` was given for.
  template <class Done, class Visit>
  std::uint64_t visit_near(const Vicinity& vicinity, const Vec3& p, const float& cutoff,
                           const Done& done, const Visit& visit) const {
    const Eigen::Vector3f x = frame_(p);
    std::uint64_t visited = 0;
    for (const Vicinity::FourLeaves& four : vicinity.leaves_) {
      ++visited;
      const Float4 bound = squared_distance(four.low, four.high, x);
      for (unsigned bits = bits_below(bound, cutoff); bits != 0; bits &= bits - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(bits));
        if (!(bound[i] < cutoff)) continue;
        ++visited;
        visit_leaf(four.leaf[i], x, cutoff, visit);
        if (done()) return visited;
      }
    }
    return visited;
  }

 private:
  // A leaf is the place of its first triangle, with the number of the others from bit 29 on.
  static constexpr std::uint32_t kLeaf = 1U << 31, kOthers = 29, kMostTriangles = 1U << kOthers;
  /// Boxes of four nodes; those that are not there are nowhere.
  struct Node {
    static constexpr float kFar = std::numeric_limits<float>::infinity();
    static constexpr Float4 kAllFar{kFar, kFar, kFar, kFar};
    std::array<Float4, 3> low{kAllFar, kAllFar, kAllFar};
    std::array<Float4, 3> high{-kAllFar, -kAllFar, -kAllFar};
    std::array<std::uint32_t, 4> child{};
  };
  /// Of a point from four boxes.
  static Float4 squared_distance(const std::array<Float4, 3>& low,
                                 const std::array<Float4, 3>& high, const Eigen::Vector3f& x) {
    const auto away = [&](int k) {
      return larger(larger(low[k] - x[k], x[k] - high[k]), Float4{});
    };
    const Float4 dx = away(0), dy = away(1), dz = away(2);
    return dx * dx + dy * dy + dz * dz;
  }

  template <class Visit>
  void visit_leaf(std::uint32_t leaf, const Eigen::Vector3f& x, const float& cutoff,
                  const Visit& visit) const {
    const std::uint32_t first = leaf & (kMostTriangles - 1), last = first + (leaf >> kOthers);
    unsigned left = 15U << first % 4;
    for (std::uint32_t pack = first / 4; pack <= last / 4; ++pack, left = 15) {
      if (pack == last / 4) left &= 15U >> (3 - last % 4);
      const Float4 bound = packs_[pack].at_least(x);
      for (unsigned bits = bits_below(bound, cutoff) & left; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(bits));
        if (bound[i] < cutoff) visit(4 * pack + i);
      }
    }
  }

  static std::size_t wide_nodes(const Bvh& bvh, std::uint32_t index);
  std::uint32_t add(const Bvh& bvh, std::uint32_t index);

  UnitFrame frame_;
  std::vector<Node> nodes_;
  std::vector<FourTriangles> packs_;  // by place
  std::uint32_t root_ = kLeaf;
};

}  // namespace kaboum::geom
