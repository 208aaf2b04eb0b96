#pragma once

#include <kaboum/base/random.h>

#include <nlohmann/json.hpp>

#include "geometric_state.h"
#include "goals.h"
#include "lines.h"

namespace kaboum::manipulation {

/// Motions one after another that make an action: each is looked for in the state that the ones
/// before have led to. Where one fails the reason is kept, and nothing more is done.
class Sequence {
 public:
  /// @param question  its seed and attempt decide what is tried. Must outlive this, as geometry.
  Sequence(const Geometry& geometry, const plan::Question& question, const GeometricState& state);

  // Each is true when it was done.
  /// To one of some configurations.
  bool go(std::size_t robot, const Goals& goals);
  bool go(std::size_t robot, const std::vector<double>& q);
  /// Whether inverse kinematics knows a configuration that reaches the object by a grasp.
  bool is_in_reach(std::size_t robot, std::size_t object);
  /// To where a tool holds the object by one of its grasps. It may be held by another robot.
  bool reach(std::size_t robot, std::size_t object);
  /// Holds the object, with what is mounted on it, by the tool that is at one of its grasps.
  bool take(std::size_t robot, std::size_t object);
  /// To where the held object stands on another one; upright all the way, if that is asked for.
  bool place(std::size_t robot, std::size_t object, std::size_t support, bool upright);
  /// To where the held object's plane `mount` is on the plane `seat` of another one, along the
  /// seat's normal at last.
  bool mount(std::size_t robot, std::size_t object, std::size_t onto);
  /// Lets go what stands or is mounted, at the very pose that was meant.
  void let_go(std::size_t robot, std::size_t object);
  /// The tool straight back from what was mounted, as far as that slid in.
  bool withdraw(std::size_t robot);
  /// Straight up with the held object.
  bool lift(std::size_t robot, std::size_t object, double height);
  /// Both robots to where one can grasp what the other one holds; then it holds it.
  bool hand_over(std::size_t from, std::size_t object, std::size_t to);
  /// To some configuration, at random.
  bool wander(std::size_t robot);

  bool fail(plan::Answer::Kind kind, std::string reason);

  [[nodiscard]] const world::WorldState& state() const { return state_; }
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

 private:
  /// A held object, as it is about to be let go.
  struct Target {
    std::size_t object = 0;
    world::Transform pose;
    std::optional<std::size_t> onto;
    std::uint32_t link = 0;  ///< that holds it
    double depth = 0;        ///< how far the tool has to withdraw [length]
  };

  [[nodiscard]] world::Transform pose_of_link(std::size_t robot, std::uint32_t link) const;
  [[nodiscard]] std::optional<world::Attachment> find_grasp(std::size_t robot,
                                                            std::size_t object) const;
  [[nodiscard]] Goals goals_of_reach(std::size_t robot, std::size_t object) const;
  /// Turns about the vertical, or a seat's normal, that are tried.
  [[nodiscard]] std::vector<double> turns();
  [[nodiscard]] bool is_free(std::size_t robot, const robot::Path& path) const;
  [[nodiscard]] bool is_free(const world::WorldState& state) const;
  bool go_upright(std::size_t robot, std::size_t object, const world::Attachment& held,
                  const Goals& goals, const world::Transform& link_pose);
  bool meet(std::size_t from, std::size_t object, std::size_t to, const std::vector<double>& q);
  /// Moves an object, and what is mounted on it, to the hand or to rest.
  void carry(std::size_t object, const std::optional<world::Attachment>& held,
             const world::Transform& pose);
  [[nodiscard]] motion::PathAnswer look_for_path(const world::WorldState& state, std::size_t robot,
                                                 const Goals& goals,
                                                 const motion::PathOptions& options) const;
  [[nodiscard]] const robot::Path& usual_path(std::size_t robot, const Goals& goals,
                                              const motion::PathOptions& options) const;
  void add_goals(Goals& goals, std::size_t robot, std::uint32_t link,
                 const world::Transform& target) const;
  void record(std::size_t robot, const robot::Path& path);

  const Geometry& geometry_;
  const plan::Question& question_;
  world::WorldState state_;
  std::vector<std::optional<std::size_t>> mounted_;
  nlohmann::json paths_ = nlohmann::json::array();
  plan::Answer::Kind failed_ = plan::Answer::Kind::Impossible;
  std::string reason_;
  std::optional<Target> target_;
  Random random_;
};

/// Whether a tool may hold an object by a grasp: "TOOL/NAME" names the tools that may.
bool fits(const world::ToolFrame& tool, const world::Grasp& grasp);

}  // namespace kaboum::manipulation
