#pragma once

#include <set>

#include "scene_sets.h"

namespace kaboum::world::detail {

/// A robot of a scene: its URDF, what the scene says of it, and the sets of its links.
class SceneRobot : public SceneSets {
 public:
  using SceneSets::SceneSets;

  /// @throws Error{InvalidInput}; says in `notes` what is not looked at.
  RobotModel read(const Located& r, const std::string& name);

  std::uint32_t link_of(const robot::Robot& robot, const Located& value) const;
  std::size_t tool_of(const RobotModel& robot, const Located& value) const;

  /// The point, line, plane or surface of an object with these members. @param taken  kinds and
  /// names of others, to which its own are added.
  Feature feature(const Located& f, std::set<std::string>& taken) const;

 private:
  std::size_t variable_of(const robot::Robot& robot, const std::string& name,
                          const Located& at) const;

  void read_limits(const Located& value, robot::Robot& robot) const;
  std::vector<double> read_home(const Located* value, const Located& at,
                                const robot::Robot& robot) const;

  /// @param robot  with its shapes, tools and grippers so far
  Gripper gripper_of(const RobotModel& robot, const Located& gripper) const;
  void require_above_fingers(const Located& r, const RobotModel& robot) const;
  bool is_of_visual_shapes(const Located& r) const;
  void note_bare_links(const RobotModel& robot, bool visual);
  void require_shapes(const Loaded& loaded, const Located& value, bool visual) const;
  /// The member `direction` of a link's entry: a set of this link, of this robot file's shapes.
  Loaded link_set(const Located& entry, const char* direction, const std::string& link,
                  const File& urdf, bool visual);
  void add_shapes(const Located& r, const File& urdf, bool visual, RobotModel& out);
  void add_features(const Located& r, RobotModel& out) const;
  void read_surface(const Located& s, Feature& out) const;

  AllowedPair pair_of(const RobotModel& robot, const Located& value,
                      AllowedPair::Reason reason) const;

  void add_proved(const Located& r, RobotModel& robot) const;
};

}  // namespace kaboum::world::detail
