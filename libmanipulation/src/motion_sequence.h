#pragma once

#include <kaboum/base/random.h>

#include "geometric_state.h"
#include "goals.h"

namespace kaboum::manipulation {

/// Poses no farther apart are the same: ten times what words are rounded to. [m, 1]
inline constexpr double kSamePose = 1e-6;

/// Motions one after another: each is looked for in the state that the ones before have led to.
/// Where one fails the reason is kept, and nothing more is done.
class MotionSequence {
 public:
  /// @param question  its seed and attempt decide what is tried. Must outlive this, as geometry.
  /// @param mounted   what each object is mounted on.
  MotionSequence(const Geometry& geometry, const plan::Question& question, world::WorldState state,
                 std::vector<std::optional<std::size_t>> mounted);

  /// To one of some configurations. What is carried keeps upright where the scene wants it to.
  /// @param kept  what is kept besides
  /// @return whether it was done.
  bool go(std::size_t robot, const Goals& goals, std::vector<motion::PathConstraint> kept = {});
  bool go(std::size_t robot, const std::vector<double>& q);
  /// Along a path, if it is certainly free and keeps upright what is carried.
  /// @pre it begins where the robot is.
  bool follow(std::size_t robot, const robot::Path& path);

  /// @return false.
  bool fail(plan::Answer::Kind kind, std::string reason);

  [[nodiscard]] const world::WorldState& state() const { return state_; }
  [[nodiscard]] const std::vector<Motion>& motions() const { return motions_; }
  /// A failure of the first motion is what it is; of later ones it depends on what was chosen
  /// before: not found.
  [[nodiscard]] plan::Answer failure() const;
  [[nodiscard]] plan::Answer found(std::string value) const;
  /// Of an object that rests or is held now.
  [[nodiscard]] std::string word_of_object(std::size_t object) const;
  /// Where a mounted object is on the one below.
  [[nodiscard]] std::string word_of_mounted(std::size_t object) const;
  [[nodiscard]] std::optional<world::Attachment> held_by(std::size_t robot,
                                                         std::size_t object) const;
  [[nodiscard]] world::Transform pose_of_object(std::size_t object) const;

 protected:
  [[nodiscard]] world::Transform pose_of_link(std::size_t robot, std::uint32_t link) const;
  /// How a robot holds an object with the tool that is at one of its grasps; nullopt: none is.
  [[nodiscard]] std::optional<world::Attachment> find_grasp(std::size_t robot,
                                                            std::size_t object) const;
  /// True if a path is certainly free, and keeps upright what the robot carries.
  [[nodiscard]] bool may_follow(std::size_t robot, const robot::Path& path) const;
  [[nodiscard]] bool is_free(const world::WorldState& state) const;
  [[nodiscard]] bool is_free_at(std::size_t robot, const std::vector<double>& q) const;
  /// Moves an object, and what is mounted on it, to the hand or to rest.
  void carry(std::size_t object, const std::optional<world::Attachment>& held,
             const world::Transform& pose);
  /// @param any  as of GoalSearch
  void add_goals(Goals& goals, std::size_t robot, std::uint32_t link,
                 const world::Transform& target, bool any = false) const;
  void record(std::size_t robot, const robot::Path& path);
  /// A configuration with the joints of grippers as they are now: what is held decides these.
  [[nodiscard]] std::vector<double> with_fingers(std::size_t robot, std::vector<double> q) const;
  /// Whether the robot is certainly free where it is, the object included, which it does not hold.
  /// @param when  "before it closes on"
  bool is_free_of(std::size_t robot, std::size_t object, const char* when);
  /// Closes or opens the gripper that holds an object: its fingers go straight, and all is free but
  /// for its pads and the object. @pre the object is attached, and stays where it is
  bool move_fingers(std::size_t robot, std::size_t object, Motion::Fingers how);

  const Geometry& geometry_;
  const plan::Question& question_;
  world::WorldState state_;
  std::vector<std::optional<std::size_t>> mounted_;
  std::vector<Motion> motions_;
  plan::Answer::Kind failed_ = plan::Answer::Kind::Impossible;
  std::string reason_;
  bool listed_ = false;   ///< a failure is impossible among what the scene lists
  bool chosen_ = false;   ///< something was chosen among several things that might do
  unsigned choices_ = 0;  ///< among how many a question's choice decides
  Random random_;
  std::vector<robot::Path> last_paths_;  ///< of each robot

 private:
  [[nodiscard]] std::vector<std::vector<double>> nearest_free(
      const world::WorldState& state, std::size_t robot,
      const std::vector<std::vector<double>>& goals) const;
  [[nodiscard]] motion::PathAnswer look_for_path(const world::WorldState& state, std::size_t robot,
                                                 const Goals& goals,
                                                 const motion::PathOptions& options) const;
};

/// Whether a tool holds an object by a grasp, or by any member of its family. Both poses are to one
/// frame.
bool is_at(const world::Transform& tool, const world::Grasp& grasp, const world::Transform& object);

}  // namespace kaboum::manipulation
