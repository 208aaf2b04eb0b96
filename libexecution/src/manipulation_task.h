#pragma once

#include <kaboum/world/world.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::execution {

/// A task of usual manipulation actions: mates, which are constraints between two objects, and
/// where things are to be in the end (docs/planning/tasks.md).
class ManipulationTask {
 public:
  /// @param name  of the file, for messages.
  /// @throws Error{InvalidInput} naming file and line.
  ManipulationTask(const std::string& text, std::string name);

  /// The scene that the task names, as it names it; empty: none.
  [[nodiscard]] const std::string& scene() const { return scene_; }

  /// Adds a set of constraints to the world for each pair of objects that is to be mated.
  /// @throws Error{InvalidInput} for what the world does not have, naming file and line.
  void add_mates(world::World& world) const;

  /// The problem in KPL: what there is in the world, what is known at first, and the goal.
  /// @throws Error{InvalidInput} for what the world does not have or cannot do, naming file and
  ///   line. @pre add_mates was called
  [[nodiscard]] std::string problem(const world::World& world) const;

 private:
  struct Relation {
    kinematics::Relation relation = kinematics::Relation::Coincident;
    std::string first, second;  ///< of what is put, and of what it is put on
    std::optional<double> value, within, within_angle;
    bool preferred = false;
  };
  struct Mate {
    std::size_t line = 0;
    std::string name;
    std::vector<Relation> relations;
  };
  struct Goal {
    enum class Kind : std::uint8_t { Put, Hold } kind = Kind::Put;
    std::size_t line = 0;
    std::string object, other;  ///< the support, or the robot (may be empty)
    std::string mate;           ///< may be empty
  };

  class ProblemText;
  static void say_what_there_is(const world::World& world, ProblemText& out);
  void say(const Goal& goal, const world::World& world, ProblemText& out) const;
  void read_line(const std::string& line, std::size_t number);
  void read_mate(const std::string& rest, std::size_t number);
  void read_put(const std::vector<std::string>& words, std::size_t number);
  [[noreturn]] void fail(std::size_t line, const std::string& what) const;
  [[nodiscard]] std::size_t object_named(const world::World& world, const std::string& name,
                                         std::size_t line) const;
  [[nodiscard]] static std::string set_name(const Goal& goal);

  std::string text_, name_, scene_;
  std::vector<Mate> mates_;
  std::vector<Goal> goals_;
};

/// The domain of the usual actions in KPL, of which such a problem is: fetch, put, mate, mount and
/// hand over.
extern const char* const kManipulationDomain;

}  // namespace kaboum::execution
