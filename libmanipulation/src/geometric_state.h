#pragma once

#include <kaboum/manipulation/externals.h>
#include <kaboum/world/checker.h>

#include <map>
#include <span>
#include <unordered_map>

namespace kaboum::manipulation {

/// A robot goes along a path, with what it carries; or the fingers of a gripper alone, about an
/// object that is among what it holds before it moves, or while it still rests.
struct Motion {
  enum class Fingers : std::uint8_t { Still, Close, Open };
  std::size_t robot = 0;
  robot::Path path;
  std::vector<std::pair<std::size_t, world::Attachment>> holds;  ///< objects, ascending
  Fingers fingers = Fingers::Still;
  std::size_t object = 0;  ///< that the fingers close or open about
  /// Of a gripper with several joints: a path that comes to any combination of their values, within
  /// `beside` of each variable. Empty: `path` does.
  robot::Path covering = {};
  std::vector<double> beside = {};

  /// What is decided about it.
  [[nodiscard]] const robot::Path& decided() const { return covering.empty() ? path : covering; }
};

/// What a call has led to among the things that it involves.
struct Performed {
  plan::Answer answer;
  std::vector<Motion> motions;
  std::vector<signed char> in_the_way;  ///< by Geometry::placed, see Involved
};

struct Volume;

/// A world, and what is asked of it again and again.
struct Geometry {
  Geometry(world::World w, const ExternalOptions& o)
      : world(std::move(w)),
        options(o),
        checker(world, options.observer.get(), options.substitute.get()) {
    check.scratch = &scratch;
    check.where = false;
  }
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  const world::World world;
  const ExternalOptions options;
  const world::Checker checker;
  world::MotionOptions check = options.path.check;  ///< of all motions
  /// Whether they stay as they are in the scene: the domain has no term for them. @pre a
  /// GeometricState has been made
  [[nodiscard]] bool is_fixed_robot(std::size_t robot) const { return fixed_robots[robot] != 0; }
  [[nodiscard]] bool is_fixed_object(std::size_t object) const {
    return fixed_objects[object] != 0;
  }
  std::vector<char> fixed_robots, fixed_objects;

  // Kept by all that they depend on: nothing that was asked before has a say in them.
  std::unordered_map<std::string, Performed> performed;
  std::unordered_map<std::string, std::uint32_t> placed;  ///< numbers of things where they are
  std::unordered_map<std::string, plan::Answer> reached;  ///< whether objects are in reach
  std::unordered_map<std::string, std::shared_ptr<const Volume>> volumes;  ///< by their words
  std::size_t volume_bodies = 0;  ///< of the volumes that are kept
  mutable world::Scratch scratch;
};

/// How motions of a robot are decided that holds something: with room for its fingers.
/// @param beside  more room, as Motion::beside
world::MotionOptions check_of(const Geometry& geometry, std::size_t robot,
                              const std::vector<std::optional<world::Attachment>>& attachments,
                              const std::vector<double>& beside = {});

/// @throws Error{InvalidInput} for names that the scene does not have.
std::size_t robot_named(const Geometry& geometry, const std::string& name);
std::size_t object_named(const Geometry& geometry, const std::string& name);
std::size_t region_named(const Geometry& geometry, const std::string& name);

/// The state of the world as the planner knows it, as far as it was read: what is read is in the
/// footprint of the call. Things that were not read are as in the scene, objects absent, held by
/// nobody.
class GeometricState {
 public:
  GeometricState(Geometry& geometry, plan::StateView& view);

  /// Reads the configuration of a robot. @return false: it is not known.
  bool read_robot(std::size_t robot);
  /// Reads where an object is, and what it is mounted on; of what holds it the configuration too.
  bool read_object(std::size_t object);
  /// Reads these, and what never changes. @return false: something is not known.
  bool read(std::span<const std::size_t> robots, std::span<const std::size_t> objects);
  bool read_all();
  /// A configuration that the call states: the state's is not read.
  void set_robot(std::size_t robot, std::vector<double> q) { state_.q[robot] = std::move(q); }

  [[nodiscard]] const world::WorldState& world() const { return state_; }
  /// What each object is mounted on, as far as it was read.
  [[nodiscard]] const std::vector<std::optional<std::size_t>>& mounted() const { return mounted_; }
  /// How far the joints of a robot's grippers may be off, by what it holds: as
  /// MotionOptions::around.
  [[nodiscard]] const std::vector<double>& finger_room(std::size_t robot) const {
    return finger_room_[robot];
  }
  /// A sentence, when something is not known.
  [[nodiscard]] const std::string& unknown() const { return unknown_; }

 private:
  bool read_place(std::size_t object, std::size_t depth);
  bool read_fingers(std::size_t robot);
  void find_fixed();

  Geometry& geometry_;
  plan::StateView& view_;
  world::WorldState state_;
  std::vector<std::optional<std::size_t>> mounted_;
  std::vector<bool> robots_read_, objects_read_;
  std::vector<std::vector<double>> finger_room_;  ///< of the robots that were read
  std::string unknown_;
};

}  // namespace kaboum::manipulation
