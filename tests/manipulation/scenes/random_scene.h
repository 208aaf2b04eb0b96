#pragma once

#include <kaboum/judge/cell.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::test {

/// A small scene made at random: one or two arms of five or six axes, blocks with a few grasps
/// each, boxes in the way, perhaps a shelf; and a planning task about it. All bounding sets are the
/// exact boxes. Some blocks are where an arm can grasp them, some anywhere, some out of reach.
struct RandomScene {
  static constexpr double kGap = 0.003;  ///< between a tool and what it holds [m]
  static constexpr double kGrown = 2e-4;

  explicit RandomScene(std::uint32_t seed);

  struct Block {
    std::size_t object = 0;  ///< in the world and in both cells
    double half_height = 0;
    std::vector<geom::Transform> grasps;  ///< from the block's frame to the tool's
  };

  world::World world;
  judge::Cell cell;   ///< the exact meshes
  judge::Cell grown;  ///< blocks and boxes larger by kGrown on every side
  std::uint32_t hand = 0;
  geom::Transform tool;  ///< from the tool's frame to the hand's
  std::vector<Block> blocks;
  std::optional<std::size_t> shelf;           ///< object
  geom::Vec3 shelf_top = geom::Vec3::Zero();  ///< in the world
  std::vector<std::size_t> removed, stowed;   ///< blocks that the goal asks for
  std::string task;                           ///< domain and problem

  /// Robots at home, objects where they are at first.
  [[nodiscard]] judge::CellState state() const;
};

}  // namespace kaboum::test
