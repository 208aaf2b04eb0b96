#pragma once

#include <kaboum/robot/robot.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::test {

/// What a scene's sets bound: convex meshes as they are, fixed to links or resting. Decides
/// contacts in rational numbers; shares nothing with libcollide, libworld and libmotion.
struct ExactScene {
  struct Body {
    std::string name;
    geom::Mesh hull;
    geom::Transform pose;               ///< to the link's frame, or the world's
    std::optional<std::uint32_t> link;  ///< none: it rests
  };
  robot::Robot robot;
  std::vector<Body> bodies;
  std::vector<std::array<std::size_t, 2>> pairs;  ///< of bodies that are not to touch

  /// Names of two bodies in contact.
  [[nodiscard]] std::optional<std::string> find_contact(const std::vector<double>& q) const;
};

}  // namespace kaboum::test
