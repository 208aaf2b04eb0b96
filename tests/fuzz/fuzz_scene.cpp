// Any text given to the reader of scenes either makes a world that keeps what World promises and
// can be checked, the same one from YAML and from what it says as JSON, or throws Error. The first
// byte selects JSON or YAML; #NAME# stands for the hash of a file.

#include <kaboum/world/checker.h>

#include "../world/worlds.h"
#include "fuzz.h"

namespace {

using namespace kaboum;

const test::SceneFiles& scene_files() {
  static const test::SceneFiles files;
  return files;
}

std::string with_hashes(std::string text) {
  for (const auto& [name, bytes] : scene_files().files) {
    const std::string word = "#" + name + "#", hash = scene_files().hash(name);
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
      text.replace(at, word.size(), hash);
  }
  return text;
}

world::World parse(const std::string& text, const std::string& name) {
  return world::parse_scene(text, name,
                            [](const std::string& file) { return scene_files().read(file); });
}

void require_link(const world::RobotModel& robot, std::uint32_t link, const char* what) {
  if (link >= robot.kinematics.links.size()) fuzz::broken(what, "of no link");
}

void look_at(const world::RobotModel& robot) {
  if (robot.home.size() != robot.kinematics.variables.size())
    fuzz::broken("home", "of another number of joints");
  for (const world::LinkShape& s : robot.shapes) require_link(robot, s.link, "a shape");
  for (const world::ToolFrame& t : robot.tools) require_link(robot, t.link, "a tool");
  for (const world::LinkFeature& f : robot.features) require_link(robot, f.link, "a feature");
  for (const world::AllowedPair& p : robot.allowed)
    if (p.a >= p.b || p.b >= robot.kinematics.links.size()) fuzz::broken("a pair", "of no links");
  for (const world::Gripper& g : robot.grippers) {
    if (g.tool >= robot.tools.size()) fuzz::broken("a gripper", "of no tool");
    for (const std::uint32_t link : g.links) require_link(robot, link, "a finger");
    for (const std::uint32_t link : g.pads) require_link(robot, link, "a pad");
    for (const std::uint32_t joint : g.joints)
      if (joint >= robot.home.size()) fuzz::broken("a gripper", "of no joint");
    if (!g.joints.empty() && g.pads.empty()) fuzz::broken("a gripper", "with joints and no pads");
  }
}

void look_at(const world::World& world) {
  if (world.attachments.size() != world.objects.size())
    fuzz::broken("attachments", "not one for each object");
  for (const world::RobotModel& robot : world.robots) look_at(robot);
  for (const auto& held : world.attachments)
    if (held && held->link_touches && !held->fingers.empty())
      fuzz::broken("an attachment", "of fingers, by a link");
  // Of any scene that is read, its first state can be checked.
  world::Scratch scratch;
  const world::Checker checker(world);
  const world::WorldState state = world::initial_state(world);
  const bool free = checker.is_free(state, scratch);
  if (free != checker.find_contacts(state, scratch, {}).empty())
    fuzz::broken("contacts", free ? "of what is free" : "none of what is not");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text = with_hashes(fuzz::text_of(data, size));
  const bool yaml = data[0] % 2 != 0;
  fuzz::survive([&] {
    const std::string name = yaml ? "fuzz.yaml" : "fuzz.json";
    const world::World world = parse(text, name);
    look_at(world);
    const std::string json = world::scene_as_json(text, name);
    world::World again;
    try {
      again = parse(json, "fuzz.json");
    } catch (const Error& e) {
      fuzz::broken(e.what(), json);
    }
    if (again.objects.size() != world.objects.size() || again.robots.size() != world.robots.size())
      fuzz::broken("another world", json);
    for (std::size_t r = 0; r < world.robots.size(); ++r)
      if (again.robots[r].fingerprint != world.robots[r].fingerprint ||
          again.robots[r].home != world.robots[r].home)
        fuzz::broken("another robot", json);
  });
  return 0;
}
