#pragma once

#include <kaboum/judge/cell.h>
#include <kaboum/plan/replay.h>
#include <kaboum/world/world.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace kaboum::execution {

/// A geometric state as the words of a plan's state say, and these words one after another.
struct StatedState {
  judge::CellState state;
  std::vector<std::optional<std::size_t>> mounted;  ///< what each object is mounted on
  /// How each object is held, by its own word; none: it is not, or mounted on what is.
  std::vector<std::optional<world::Attachment>> held = {};
  std::string words;
};

/// nullopt: a configuration or a pose is not known.
/// @throws Error{InvalidInput} for words that the scene does not know.
std::optional<StatedState> state_of(const world::World& world, const plan::Model& model,
                                    const plan::KnownState& known);

/// From the world to a frame that is a rotation and a translation.
geom::Transform inverse(const geom::Transform& pose);

/// Whether two poses are the same but for the rounding of words.
bool same(const geom::Transform& a, const geom::Transform& b);

/// Whether a tool of a robot's link is at a grasp of an object.
bool is_at_grasp(const world::World& world, std::size_t robot, std::uint32_t link,
                 const geom::Transform& link_pose, std::size_t object,
                 const geom::Transform& object_pose);

/// Which way a robot's link pushes an object, level and of unit length: a plane `push…` of the link
/// faces a plane `push…` of the object, no farther away than `gap`, their points opposite each
/// other. nullopt: it pushes nothing.
std::optional<geom::Vec3> pushed_way(const world::World& world, std::size_t robot,
                                     std::uint32_t link, const geom::Transform& link_pose,
                                     std::size_t object, const geom::Transform& object_pose,
                                     double gap);

/// Whether an object that was pushed that way from a pose may be at another one: on a straight
/// line, neither leaning nor turned.
bool is_on_line(const geom::Transform& from, const geom::Vec3& way, const geom::Transform& now);

/// Whether an object and another one are where all constraints of one of some sets of the scene,
/// which are between these two, are met. By formulas of its own.
bool is_mated(const world::World& world, const std::set<std::string>& sets, std::size_t object,
              const geom::Transform& object_pose, std::size_t onto,
              const geom::Transform& onto_pose);

/// Whether the plane `mount` of an object is on the plane `seat` of another one, facing it, no
/// farther away than `gap`.
bool is_on_seat(const world::World& world, std::size_t object, const geom::Transform& object_pose,
                std::size_t onto, const geom::Transform& onto_pose, double gap);

}  // namespace kaboum::execution
