#pragma once

#include <kaboum/kinematics/sample.h>
#include <kaboum/world/world.h>

#include <string>
#include <utility>
#include <vector>

namespace kaboum::manipulation {

/// A constraint problem about things of a scene, whose features are named. What is not sought stays
/// as the scene has it: other robots at home, objects where they are or on what carries them.
class SceneConstraints {
 public:
  /// Refers to the world.
  /// @param arms  robots whose joints are sought, and the link or tool frame that each chain from
  ///   the robot's root ends at
  /// @param objects  whose poses are sought; boxes to draw from are set in problem().objects
  /// @throws Error{InvalidArgument} for names that the world does not have, objects that are
  ///   carried, and as kinematics::arm_of.
  SceneConstraints(const world::World& world,
                   const std::vector<std::pair<std::string, std::string>>& arms,
                   const std::vector<std::string>& objects);

  /// The feature of a name (world::find_feature), wherever it is fixed to.
  /// @throws Error{InvalidArgument} as find_feature, and when it moves with
  ///   joints that are not those of the robot's chain.
  kinematics::PlacedFeature feature(const std::string& name);

  /// To which constraints between features are added. Robots and objects are in the order above.
  kinematics::ConstraintProblem& problem() { return problem_; }

 private:
  [[nodiscard]] std::size_t robot_named(const std::string& name) const;
  /// A feature that moves with a link, in the link's frame.
  kinematics::PlacedFeature on_link(std::size_t robot, std::uint32_t link,
                                    const world::Feature& feature);

  const world::World& world_;
  std::vector<std::size_t> arms_, objects_;  ///< their numbers in the world
  kinematics::ConstraintProblem problem_;
};

}  // namespace kaboum::manipulation
