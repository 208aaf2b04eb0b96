#pragma once

#include <kaboum/judge/cell.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/robot/path.h>
#include <kaboum/world/world.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::test {

/// Two arms with six axes, "left" and "right", whose tools look at what they are to hold; a table,
/// a block and a socket that the block fits on, a wall that stands aside. The bounding sets are the
/// exact boxes.
struct TwoArms {
  static constexpr std::size_t kLeft = 0, kRight = 1;
  enum Things : std::size_t { kTable, kBlock, kSocket, kWall };
  static constexpr double kGap = 0.002;     ///< between a tool and what it holds [m]
  static constexpr double kEpsilon = 1e-4;  ///< of all sets [m]

  TwoArms();

  world::World world;
  judge::Cell cell;
  std::uint32_t hand = 0;  ///< the link

  /// How an arm holds the block by a grasp.
  [[nodiscard]] world::Attachment hold(std::size_t robot, std::size_t grasp) const;
  [[nodiscard]] std::string word(const world::Attachment& held) const;
  /// For the judge: robots at home, things where they are at first.
  [[nodiscard]] judge::CellState state() const;
  [[nodiscard]] judge::Hold hold_of(const world::Attachment& held) const;
};

/// The same robot on a rail along its base's y: links count one more, and the rail's variable is
/// the last. [m]
world::RobotModel on_rail(world::RobotModel robot, double lower, double upper);

geom::Mesh box_at(const geom::Vec3& size, const geom::Vec3& center);

/// A state of the planner that says what it is told to, and notes what is read.
class WordState final : public plan::StateView {
 public:
  explicit WordState(std::map<std::string, std::string> words) : words_(std::move(words)) {}
  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) override;
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& arguments) override;
  bool has_term(const std::string& function, const std::vector<std::string>& arguments) override;
  [[nodiscard]] const std::vector<std::string>& read() const { return read_; }

 private:
  std::map<std::string, std::string> words_;
  std::vector<std::string> read_;
};

/// A call; more attempts, as the planner makes them, until something is found.
plan::Answer ask(const plan::ExternalBindings& all, const std::string& function,
                 const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& words, unsigned attempts = 6,
                 unsigned choice = 0);

struct Motion {
  std::string robot;
  std::map<std::string, std::string> holds;  ///< objects, by what link
  robot::Path path;
};
std::vector<Motion> motions_of(const plan::Answer& answer);

/// Configurations along a path, no joint farther than `step` from one to the next. [rad]
std::vector<std::vector<double>> samples_of(const robot::Path& path, double step);

}  // namespace kaboum::test
