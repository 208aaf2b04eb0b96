#pragma once

#include <kaboum/judge/solid.h>
#include <kaboum/robot/robot.h>

#include <memory>
#include <optional>
#include <string>

namespace kaboum::judge {

/// Hold of a robot's link on an object.
struct Hold {
  std::size_t robot = 0;
  std::uint32_t link = 0;
  geom::Transform pose;                 ///< from the object's frame to the link's
  std::vector<std::uint32_t> touching;  ///< links that may touch the object besides
  bool link_touches = true;             ///< the link itself may; false: `touching` alone
};

/// Places of all robots and objects.
struct CellState {
  struct Place {
    geom::Transform pose;      ///< to the world, unless it is held
    std::optional<Hold> hold;  ///< it moves with a link
    bool away = false;         ///< it has left the cell
  };
  std::vector<std::vector<double>> q;  ///< for each robot a value per variable
  std::vector<Place> objects;
};

/// Two things whose meshes meet.
struct Meeting {
  std::array<std::string, 2> names;
};

/// Robots and objects as exact triangle meshes. Whether two of them meet in a state is decided by
/// Solid; none of the bounding sets' code is in it.
///
/// Pairs that are not looked at:
/// - links of one robot with only fixed joints, or one joint but for frames without shapes, between
///   them;
/// - pairs that were allowed;
/// - what is held and the link that holds it, with the links that may touch it; where pads hold it,
///   these alone.
class Cell {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// @return its number. Robots are added before their links and before objects.
  std::size_t add_robot(std::string name, robot::Robot kinematics, const geom::Transform& base);
  /// A link's shapes as one mesh in its frame.
  void add_link(std::size_t robot, std::uint32_t link, const geom::Mesh& mesh);
  std::size_t add_object(std::string name, const geom::Mesh& mesh);
  /// Names as "ROBOT/LINK" or "OBJECT". Names of things that have no mesh are ignored.
  void allow(const std::string& a, const std::string& b);

  /// The first pair that meets. Of `robot` only what it moves is looked at, against everything;
  /// kNone: all pairs but those of objects that rest.
  /// @pre the state has as many robots, values and objects as the cell.
  [[nodiscard]] std::optional<Meeting> find_meeting(const CellState& state,
                                                    std::size_t robot = kNone) const;
  /// A pair that meets at a sample of a robot's straight motion in joint space: its start, and so
  /// many, equally far apart, to its end. Of each pair, samples are left out that the distance of
  /// its triangles at one before shows to be free: points move no farther than all turns of the
  /// joints between the two allow, at the most that links reach.
  /// @param looked  is added to: samples of pairs that were looked at
  /// @pre the states differ in the robot's values only
  [[nodiscard]] std::optional<Meeting> find_meeting_on(const CellState& from, const CellState& to,
                                                       std::size_t robot, std::size_t samples,
                                                       std::size_t& looked) const;
  /// How deep the pair that is deepest in each other is, as Solid::depth says it; 0 where none
  /// meets.
  [[nodiscard]] double depth(const CellState& state, double step) const;
  /// The first of a rest of objects with everything that does not hold it.
  [[nodiscard]] std::optional<Meeting> find_meeting_of(const CellState& state,
                                                       std::size_t object) const;

  /// Pose of an object in the world. @pre it is not away.
  [[nodiscard]] geom::Transform pose_of(const CellState& state, std::size_t object) const;
  /// Pose of a link in the world.
  [[nodiscard]] geom::Transform pose_of(const CellState& state, std::size_t robot,
                                        std::uint32_t link) const;

  /// How far a point of what a robot moves is from where it is in another state, at most: an upper
  /// bound, by the ball round each thing. [length]
  /// @pre the states differ in the robot's values only.
  [[nodiscard]] double displacement(const CellState& from, const CellState& to,
                                    std::size_t robot) const;

  [[nodiscard]] const robot::Robot& kinematics(std::size_t robot) const {
    return robots_[robot].kinematics;
  }
  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  [[nodiscard]] std::size_t open() const { return open_; }  ///< things whose meshes are not closed

 private:
  struct Robot {
    std::string name;
    robot::Robot kinematics;
    geom::Transform base;
  };
  struct Thing {
    std::string name;
    std::size_t robot = kNone;  ///< kNone: an object
    std::size_t index = 0;      ///< of a link, or of an object
    std::unique_ptr<Solid> solid;
    geom::Vec3 center;
    double radius = 0;
  };
  /// A thing where it is in a state.
  struct PosedThing {
    const Thing* thing;
    geom::Transform at;
    geom::Vec3 center;
    std::size_t mover;  ///< the robot that moves it; kNone: it rests
    const Hold* hold;
  };

  void add(Thing thing, const geom::Mesh& mesh);
  /// The links from one to the root, without the root.
  [[nodiscard]] static std::vector<std::uint32_t> to_root(const robot::Robot& robot,
                                                          std::uint32_t link);
  /// How far points of two things come nearer while a robot's values go from some to others, at
  /// most: an upper bound. [length]
  [[nodiscard]] double approach(const PosedThing& a, const PosedThing& b, std::size_t robot,
                                const std::vector<double>& begin,
                                const std::vector<double>& end) const;
  [[nodiscard]] std::vector<PosedThing> place(const CellState& state) const;
  [[nodiscard]] bool is_looked_at(const PosedThing& a, const PosedThing& b) const;
  [[nodiscard]] bool connected(const robot::Robot& robot, std::uint32_t a, std::uint32_t b) const;
  /// The first meeting of pairs that `wanted` takes.
  template <typename Wanted>
  [[nodiscard]] std::optional<Meeting> find(const CellState& state, const Wanted& wanted) const;

  std::vector<Robot> robots_;
  std::vector<Thing> things_;
  std::vector<std::size_t> objects_;                 ///< of things_
  std::vector<std::array<std::string, 2>> allowed_;  ///< sorted names
  mutable std::vector<signed char> looked_at_;       ///< by pair of things; 0: not decided yet
  std::size_t triangles_ = 0, open_ = 0;
};

}  // namespace kaboum::judge
