#pragma once

#include <kaboum/world/checker.h>

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace kaboum::search {

/// The meshes of a world's things, those of one thing after another.
using Meshes = std::vector<std::pair<world::Item, geom::Mesh>>;

/// Shapes of things in a collision library, as packaged.
class Shapes {
 public:
  Shapes() = default;
  Shapes(const Shapes&) = delete;
  Shapes& operator=(const Shapes&) = delete;
  virtual ~Shapes() = default;
  /// Adds a shape of the thing of this number.
  virtual void add(std::size_t thing, const geom::Mesh& mesh) = 0;
  /// Places all shapes of a thing.
  virtual void put(std::size_t thing, const geom::Transform& pose) = 0;
  /// Whether a shape of the one meets one of the other; those whose boxes along the axes are apart
  /// are not looked at.
  virtual bool meet(std::size_t a, std::size_t b) = 0;
};

/// @param convex  shapes are convex; else triangles
std::unique_ptr<Shapes> fcl_shapes(std::size_t things, bool convex);     ///< trees of boxes, GJK
std::unique_ptr<Shapes> bullet_shapes(std::size_t things, bool convex);  ///< GImpact, GJK
std::unique_ptr<Shapes> ode_shapes(std::size_t things);                  ///< OPCODE, triangles only

/// A world in another library: pairs are those that a checker looks at.
class OtherWorld {
 public:
  template <typename MakeShapes>
  OtherWorld(const world::Checker& checker, const Meshes& meshes, const MakeShapes& make)
      : checker_(checker), items_(items_of(meshes)), shapes_(make(items_.size())) {
    for (const auto& [item, mesh] : meshes) shapes_->add(number_of(item), mesh);
  }

  /// The pairs that a question is about. @param things  see world::find_obstacles.
  void choose_pairs(const world::WorldState& state);
  void choose_pairs(const world::WorldState& state, std::size_t robot,
                    const std::vector<world::Item>* things);
  /// Whether one of them collides. @param only  places the robot of this number and what it
  /// carries, all else stays where it is.
  bool collide(const world::WorldState& state, std::size_t only = kAll);
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);

 private:
  [[nodiscard]] static std::vector<world::Item> items_of(const Meshes& meshes);
  [[nodiscard]] std::size_t number_of(const world::Item& item) const;
  void place(const world::WorldState& state, std::size_t only);

  const world::Checker& checker_;
  std::vector<world::Item> items_;
  std::unique_ptr<Shapes> shapes_;
  std::vector<std::array<std::size_t, 2>> pairs_;
};

}  // namespace kaboum::search
