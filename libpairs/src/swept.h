#pragma once

#include <kaboum/geom/triangle_search.h>
#include <kaboum/robot/robot.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contact.h"

namespace kaboum::pairs::detail {

/// All that a link's surface sweeps, seen from a link that it hangs from: lower bounds of the
/// distance from it. docs/algorithms/pairs.md, "Swept".
class Swept {
 public:
  /// The surface itself, in its link's frame.
  explicit Swept(const Surface& surface);

  /// What it sweeps while one joint takes all of its values, seen from the joint's parent. nullopt:
  /// the joint slides without limits, or it was stopped.
  /// @param most_nodes  of the grid, or up to twice as many
  /// @param stop        often called; true: nothing comes of it
  [[nodiscard]] std::optional<Swept> above(const robot::Robot& robot, const robot::Joint& joint,
                                           std::size_t most_nodes,
                                           const std::function<bool()>& stop) const;

  /// A lower bound of the distance of a point from the swept set. [length]
  [[nodiscard]] double distance(const Vec3& point) const;

  /// A ball that holds the set.
  struct Ball {
    Vec3 center;
    double radius;
  };
  [[nodiscard]] Ball ball() const;
  /// Below this length nothing is told apart.
  [[nodiscard]] double finest() const;

 private:
  /// Bounds at nodes of a grid round the joint's axis, which is its z axis; and a cylinder that
  /// holds the set.
  struct Grid {
    double radius = 0, bottom = 0, top = 0;
    double ring = 0, rise = 0, turn = 0;  ///< between neighbours
    double floor = 0;                     ///< z of the first nodes
    std::size_t rings = 0, rises = 0, turns = 0;
    std::vector<float> values;

    [[nodiscard]] std::size_t at(std::size_t ring_of, std::size_t rise_of) const {
      return (ring_of * rises + rise_of) * turns;
    }
    [[nodiscard]] double distance(const Vec3& p) const;
    [[nodiscard]] double half_cell(std::size_t ring_of) const;
    void choose_steps(double low, double high, std::size_t most_nodes, double least);
    void sweep_turns(double from, double to);
    void sweep_rises(double from, double to);
  };
  /// A cylinder round the z axis of a frame that holds the set.
  void bound(const Transform& to_frame, Grid& out) const;
  [[nodiscard]] bool fill(const Transform& from_frame, Grid& out,
                          const std::function<bool()>& stop) const;

  Transform to_grid_;                                ///< or to the link's frame
  std::shared_ptr<const geom::DistanceQuery> mesh_;  ///< of no joint yet
  std::shared_ptr<const Grid> grid_;
  const Surface* surface_;
  double extent_ = 0;  ///< what rounding errors are relative to [length]
};

/// A lower bound above 0 of the distance of two swept sets that are seen from the same link.
/// nullopt: none was found.
std::optional<double> between(const Swept& a, const Swept& b, const std::function<bool()>& stop);

/// Two of several surfaces.
using PairOfSurfaces = std::pair<std::size_t, std::size_t>;

/// Of pairs, lower bounds of their distance in all configurations within the joints' limits, the
/// joints on both ways to the link that both hang from taken each by itself. 0: none was found.
/// @param links     of the surfaces
/// @param surfaces  null: none is there
std::vector<double> apart_by_sweeping(const robot::Robot& robot,
                                      const std::vector<std::uint32_t>& links,
                                      const std::vector<const Surface*>& surfaces,
                                      const std::vector<PairOfSurfaces>& pairs,
                                      std::size_t most_nodes, const std::function<bool()>& stop);

}  // namespace kaboum::pairs::detail
