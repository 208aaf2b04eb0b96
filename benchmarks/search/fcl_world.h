#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <kaboum/world/checker.h>

#include <memory>
#include <vector>

namespace kaboum::search {

/// A world's things in FCL, as packaged: exact meshes in trees of boxes, or bounding sets as convex
/// shapes. Pairs are those that a checker looks at; each is culled by FCL's boxes along the axes.
class FclWorld {
 public:
  using Meshes = std::vector<std::pair<world::Item, geom::Mesh>>;

  FclWorld(const world::Checker& checker, const Meshes& meshes, bool convex);

  /// The pairs that a question is about. @param things  see world::find_obstacles.
  void choose_pairs(const world::WorldState& state);
  void choose_pairs(const world::WorldState& state, std::size_t robot,
                    const std::vector<world::Item>* things);
  /// Whether one of them collides. @param only  places the robot of this number and what it
  /// carries,
  ///   all else stays where it is.
  bool collide(const world::WorldState& state, std::size_t only = kAll);
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);

 private:
  using Object = std::unique_ptr<fcl::CollisionObjectd>;

  [[nodiscard]] std::size_t number_of(const world::Item& item) const;
  void place(const world::WorldState& state, std::size_t only);
  void put(std::size_t item, const geom::Transform& pose);

  const world::Checker& checker_;
  std::vector<world::Item> items_;
  std::vector<std::vector<Object>> objects_;  ///< of the items: one mesh, or the bodies of a set
  std::vector<std::array<std::size_t, 2>> pairs_;
};

}  // namespace kaboum::search
