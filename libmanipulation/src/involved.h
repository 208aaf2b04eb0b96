#pragma once

#include <kaboum/robot/path.h>

#include <initializer_list>
#include <span>

#include "geometric_state.h"

namespace kaboum::manipulation {

/// What a call is about, and what has turned out to be in its way: what answers are looked for
/// among. Other things are not there, as far as that goes; whether they are in the way of what was
/// found is decided afterwards, for each of them by itself (docs/planning/geometry.md, "Only what
/// is in the way").
class Involved {
 public:
  /// @param state  of which all has been read. Must outlive this.
  Involved(Geometry& geometry, const GeometricState& state, std::span<const std::size_t> robots,
           std::span<const std::size_t> objects);

  /// Without what is not involved.
  [[nodiscard]] world::WorldState state() const;
  /// What objects are mounted on, of those that are involved.
  [[nodiscard]] std::vector<std::optional<std::size_t>> mounted() const;
  /// Adds all that `state` and `mounted` say to a key.
  void add_to(std::string& key) const;

  /// Involves what is in the way of some motions. @return false: nothing is.
  bool add_obstacles(Performed& performed);
  void add_all();

 private:
  /// A robot with what it carries, or an object that rests.
  struct Thing {
    std::size_t robot = world::Item::kObject;
    std::size_t object = 0;  ///< where `robot` is kObject
    std::vector<world::Item> items;
    std::uint32_t number = 0;  ///< of the thing where it is
  };

  void close();
  [[nodiscard]] bool is_carried(std::size_t object, std::size_t robot) const;
  [[nodiscard]] std::vector<Thing> others() const;
  [[nodiscard]] std::vector<Thing> decide(const Performed& performed,
                                          std::vector<Thing> things) const;

  Geometry& geometry_;
  const world::WorldState& all_;
  const std::vector<std::optional<std::size_t>>& mounted_;
  std::vector<char> robots_, objects_;  ///< whether they are involved
};

/// Bits of numbers, as part of a key that tells all of them apart.
void add_to_key(std::string& key, std::span<const double> values);
void add_to_key(std::string& key, std::uint64_t number);
void add_to_key(std::string& key, const world::Transform& pose);

}  // namespace kaboum::manipulation
