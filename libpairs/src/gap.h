#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "chain.h"
#include "hull_tree.h"

namespace kaboum::pairs::detail {

/// A box of values of a chain's variables: where the links are in its middle, and how far the
/// joints are from there at most.
class BoxMotion {
 public:
  explicit BoxMotion(const Chain& chain) : chain_(&chain) {}
  /// @param middle, half  of each variable; the box is middle ± half
  void set(std::span<const double> middle, std::span<const double> half);

  [[nodiscard]] const Chain::Placed& placed() const { return placed_; }

  /// Joints on the way from a up to (without) this one are said to move a, the others b; both
  /// relative to the frame between.
  using Split = std::size_t;
  /// Bounds of two bodies' motions from where they are in the middle, for any point of the box.
  struct Bound {
    double first = 0;   ///< of the sum of both displacements [length]
    double second = 0;  ///< of what these differ from their first derivatives' [length]
    Split first_split = 0, second_split = 0;  ///< for which these are least
  };
  /// @param a, b  balls, of b in the frame of a: the middle, the radius
  [[nodiscard]] Bound bound(const Vec3& center_a, double reach_a, const Vec3& center_b,
                            double reach_b) const;

  /// Of one joint: which share of its displacement is along a direction of length 1 at most, but
  /// for rounding. @pre the chain has one joint
  [[nodiscard]] double share_along(const Vec3& direction) const;

  /// The displacements of a's and b's points by their first derivatives, along a direction: for
  /// each variable that moves them, coefficients · p − constant.
  struct Linear {
    static constexpr std::size_t kMost = 40;
    std::size_t count = 0;
    std::array<Vec3, kMost> coefficients;
    std::array<double, kMost> constants{};
    std::array<std::size_t, kMost> variables{};
  };
  void linear(const Vec3& direction, Split split, bool of_b, Linear& out) const;
  /// The displacement of a point of a or b, by first derivatives, for changes `sign` · half of the
  /// variables.
  [[nodiscard]] Vec3 displacement(const Vec3& point, Split split, bool of_b, const Linear& of,
                                  std::span<const double> signs) const;
  /// Sum of the half turns.
  [[nodiscard]] double turns() const { return turns_; }
  [[nodiscard]] double half_of(std::size_t joint) const { return half_[joint]; }

 private:
  /// Of a ball's motion, for each split: the bound of its displacement, and two sums of which the
  /// bound of the second order is made.
  struct Sums {
    std::array<double, Linear::kMost + 1> first{}, share{}, turned{};
  };
  [[nodiscard]] Sums sums(const Vec3& center, double reach, bool of_b) const;

  const Chain* chain_;
  Chain::Placed placed_;
  std::vector<double> half_, chord_;  ///< of each joint
  std::vector<double> turned_;        ///< half turns of the joints before each, and of all
  double turns_ = 0;
};

/// Two clusters at a place.
struct Gap {
  double lower =
      -std::numeric_limits<double>::infinity();  ///< of the distance, everywhere in the box
  Vec3 direction = Vec3::Zero();                 ///< along which that is so
  double upper = std::numeric_limits<double>::infinity();  ///< of the hulls' distance, rounded
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();           ///< points of the hulls, that far apart
};

/// What separates clusters of two trees in boxes of a chain's variables.
class Gaps {
 public:
  Gaps(const HullTree& a, const HullTree& b, const Chain& chain)
      : a_(&a),
        b_(&b),
        reach_(a.extent() + b.extent() + chain.extent()),
        error_(chain.error(a.extent() + b.extent())) {}

  /// A lower bound of the distance of what two clusters hold, for all of the box. Searched until it
  /// is above `enough`, or cannot be.
  /// @param direction  where to look first; becomes the best one found
  double lower(const Cluster& a, const Cluster& b, const BoxMotion& box, Vec3& direction,
               double enough) const;
  /// The distance in the middle: a bracket, and points.
  [[nodiscard]] Gap at_middle(const Cluster& a, const Cluster& b, const BoxMotion& box,
                              const Vec3& direction, double enough) const;
  /// By how much a translation along the direction has to move b at most, to be clear of a.
  [[nodiscard]] double overlap(const Cluster& a, const Cluster& b, const Chain::Placed& placed,
                               const Vec3& direction) const;
  [[nodiscard]] double error() const { return error_; }
  /// Extent of everything; what rounding errors are relative to. [length]
  [[nodiscard]] double reach() const { return reach_; }

 private:
  template <typename Support>
  Gap search(const Support& support, Vec3 direction, double allowed, double enough,
             bool give_up) const;

  const HullTree *a_, *b_;
  double reach_, error_;
};

}  // namespace kaboum::pairs::detail
