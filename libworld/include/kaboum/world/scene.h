#pragma once

#include <kaboum/world/world.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::world {

/// Gives the bytes of a file that a scene names, as it names it.
/// @throws Error{InvalidInput} when it cannot be read.
using FileReader = std::function<std::vector<char>(const std::string& file)>;

struct SceneNotes {
  std::vector<std::string> notes;  ///< things a user should know; one sentence each
};

/// A world of a scene file (docs/scene.md): YAML where its name ends in .yaml or .yml, else JSON.
/// Files are looked at by their hashes: one that is not what the scene was made with is refused. So
/// are inner sets where outer ones are needed, sets in another unit, of another link or another
/// robot, links with shapes but without a set, names that are not known or used twice.
///
/// @param name  of the file, for messages.
/// @throws Error{InvalidInput} naming the file, line and column, and what would help;
///   Error{NotBuilt} for YAML in a build without yaml-cpp.
World parse_scene(std::string_view text, const std::string& name, const FileReader& read,
                  SceneNotes* notes = nullptr);

/// A world as read from its scene file, and the files that it was read from.
struct SceneFile {
  World world;
  std::string sha256;
  std::vector<std::string> inputs;  ///< the scene first
  std::vector<std::string> notes;   ///< things a user should know; one sentence each
};

/// Reads a scene file; those that it names are looked for from its folder.
/// @throws as parse_scene.
SceneFile read_scene(const std::string& path);

/// The robot of a name; of no name the only one.
/// @throws Error{InvalidArgument} when there is none, or there are several without a name.
std::size_t robot_named(const World& world, const std::string& name);

/// How a scene states a robot's tools: for messages.
inline constexpr std::string_view kToolExample =
    R"("tools": [{"name": "hand", "link": "LINK", "position": [0, 0, 0.1]}])";

/// The tool of a name; of no name the only one.
/// @throws Error{InvalidArgument} when there is none, or there are several without a name.
const ToolFrame& tool_named(const RobotModel& robot, const std::string& name);

/// A scene file as JSON: what it is, or what its YAML says (without comments).
/// @throws Error{InvalidInput}, Error{NotBuilt} as parse_scene.
std::string scene_as_json(std::string_view text, const std::string& name);

/// Identity that proofs about the robot's own pairs depend on: hash of its kinematics with its
/// limits and of its shapes.
std::string fingerprint_of(const RobotModel& robot);

/// Identity that a scene states beside pairs of links that were proved apart (`proved_for`): hash
/// of the robot's fingerprint and of these pairs, so that no pair can be added by hand.
std::string proof_hash(const RobotModel& robot, const std::vector<AllowedPair>& pairs);

}  // namespace kaboum::world
