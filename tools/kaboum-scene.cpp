#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/allowed_pairs.h>

#include <chrono>
#include <iostream>
#include <map>

#include "cli.h"
#include "scene_file.h"
#include "scene_maker.h"
#include "scene_update.h"

namespace {

using namespace kaboum;  // the tool's own names are few

struct Options {
  std::string scene, robot, srdf, epsilon = "1%", effort = "normal", unit = "m", cache;
  std::vector<std::string> robots, objects, regions, packages;
  bool inner = false, visual = false, no_cache = false, drop_sheets = false, force = false;
  std::size_t most_boxes = 20'000;
  double timeout = 0;
  tools::CommonOptions common;
};

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

void add_sources_of_sets(CLI::App& command, Options& o) {
  command
      .add_option("--package-path", o.packages,
                  "A package of package:// or a folder that holds it; may be repeated")
      ->type_name("DIR");
  command
      .add_option("--from-cache", o.cache,
                  "Cache of decompositions, used and filled [as bcd-decompose]")
      ->type_name("DIR");
  command.add_flag("--no-cache", o.no_cache, "Decompose anew and store nothing");
}

CLI::App* describe_make(CLI::App& app, Options& o) {
  CLI::App* make = app.add_subcommand(
      "make", "Make a scene of URDFs and meshes, with the convex sets that it needs");
  make->add_option("SCENE", o.scene, "Scene file to write (.json); sets go into a folder beside it")
      ->required();
  make->add_option("--robot", o.robots, "A robot; may be repeated")->type_name("NAME=URDF");
  make->add_option("--object", o.objects, "An object; may be repeated")->type_name("NAME=MESH");
  make->add_option("--region", o.regions, "A region: its inner set; may be repeated")
      ->type_name("NAME=MESH");
  make->add_flag("--inner", o.inner, "Inner sets of objects as well: contacts can be certain");
  make->add_flag("--visual", o.visual,
                 "Of robots, the shapes for drawing instead of those for collisions");
  make->add_option("--epsilon", o.epsilon,
                   "Largest distance of the sets from their meshes, a length or a percentage of "
                   "each mesh's diagonal")
      ->check([](const std::string& s) {
        return tools::parse_length(s) ? std::string() : "must be a positive number or percentage";
      })
      ->capture_default_str()
      ->type_name("LENGTH|P%");
  make->add_option("--effort", o.effort, "Of the decomposition [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  make->add_flag("--drop-sheets", o.drop_sheets,
                 "Drop back-to-back faces without volume (they are then not covered)");
  make->add_option("--unit", o.unit,
                   "Unit of length of all meshes: m, dm, cm, mm, um, km, in or ft; with robots m")
      ->check(tools::unit_name())
      ->capture_default_str()
      ->type_name("NAME");
  add_sources_of_sets(*make, o);
  make->add_flag("--force", o.force, "Replace a scene that exists, with all that was edited in it");
  tools::add_common_options(*make, o.common);
  return make;
}

CLI::App* describe_update(CLI::App& app, Options& o) {
  CLI::App* update = app.add_subcommand(
      "update", "Make those sets of a scene anew that are out of date, as they were made before");
  update->add_option("SCENE", o.scene, "Scene file; all but its sets stays as it is")->required();
  add_sources_of_sets(*update, o);
  tools::add_common_options(*update, o.common);
  return update;
}

CLI::App* describe_pairs(CLI::App& app, Options& o) {
  CLI::App* pairs = app.add_subcommand(
      "pairs", "Find pairs of a robot's links that never touch, with proof, or always do");
  pairs->add_option("SCENE", o.scene, "Scene file")->required();
  pairs->add_option("--robot", o.robot, "Which robot [the only one]")->type_name("NAME");
  pairs->add_option("--srdf", o.srdf, "Write the pairs as SRDF")->type_name("FILE");
  pairs
      ->add_option("--max-boxes", o.most_boxes,
                   "Most boxes of joint values that are looked at for one pair")
      ->check(tools::number_from(1, 1e9))
      ->capture_default_str()
      ->type_name("N");
  pairs->add_option("--timeout", o.timeout, "After so long, what is left stays unproved [none]")
      ->check(CLI::Range(0.001, 1e9).description(""))
      ->type_name("SECONDS");
  tools::add_common_options(*pairs, o.common);
  return pairs;
}

std::vector<tools::NamedFile> named_files(const std::vector<std::string>& texts,
                                          const char* option) {
  std::vector<tools::NamedFile> out;
  out.reserve(texts.size());
  for (const std::string& text : texts) out.push_back(tools::parse_named_file(text, option));
  return out;
}

void say_made(const Options& o, const tools::MadeScene& made, const std::string& what,
              const char* command) {
  for (const std::string& line : made.notes) tools::log(o.common.quiet, line);
  for (const std::string& size : made.sizes) tools::log(o.common.quiet, size);
  tools::log(o.common.quiet, what);
  tools::write_report(o.common, "kaboum-scene",
                      {{"command", command},
                       {"scene", o.scene},
                       {"sets", made.containers.size()},
                       {"inputs", made.inputs},
                       {"notes", made.notes}});
}

int make_scene(const Options& o) {
  const tools::ThreadLimit threads(o.common.threads);
  tools::SceneMaker maker;
  maker.scene = o.scene;
  maker.robots = named_files(o.robots, "--robot");
  maker.objects = named_files(o.objects, "--object");
  maker.regions = named_files(o.regions, "--region");
  std::vector<std::string> inputs;
  for (const auto* files : {&maker.robots, &maker.objects, &maker.regions})
    for (const tools::NamedFile& file : *files) inputs.push_back(file.file);
  if (inputs.empty())
    throw Error(ErrorCode::InvalidArgument, "nothing is asked for: give --robot or --object");
  if (!o.scene.ends_with(".json"))
    throw Error(ErrorCode::InvalidArgument, o.scene + ": a scene's name ends in .json");
  if (!o.force && std::filesystem::exists(o.scene))
    throw Error(ErrorCode::InvalidArgument,
                o.scene + " exists; --force replaces it, with all that was edited in it");
  // Lengths in URDFs are metres; an arm that is a thousand times too small is free of everything.
  if (!o.robots.empty() && o.unit != "m")
    throw Error(ErrorCode::InvalidArgument,
                "--unit " + o.unit +
                    ": URDFs are in m, and so are scenes with robots; scale the "
                    "meshes of objects to m");
  tools::require_apart({{"SCENE", o.scene}, {"--report", o.common.report}}, inputs);
  maker.inner = o.inner;
  maker.options.visual = o.visual;
  maker.options.sets.epsilon = tools::parse_length(o.epsilon);
  maker.options.sets.effort = kEfforts.at(o.effort);
  maker.options.sets.preparation.drop_sheets = o.drop_sheets;
  maker.options.sets.unit = o.unit;
  maker.options.packages = o.packages;
  const certify::SetCache cache(o.cache.empty() ? certify::SetCache::default_folder()
                                                : std::filesystem::path(o.cache));
  if (!o.no_cache) maker.options.cache = &cache;
  tools::Progress progress(o.common.quiet);
  maker.options.progress = [&](const std::string& stage) { progress.show(stage); };
  const tools::MadeScene made = tools::make_scene(maker);
  say_made(o, made,
           o.scene + ": " + std::to_string(made.containers.size()) +
               " sets, all at the origin: put things where they belong",
           "make");
  return tools::kDone;
}

int update_scene(const Options& o) {
  const tools::ThreadLimit threads(o.common.threads);
  tools::require_apart({{"--report", o.common.report}}, {o.scene});
  const certify::SetCache cache(o.cache.empty() ? certify::SetCache::default_folder()
                                                : std::filesystem::path(o.cache));
  tools::Progress progress(o.common.quiet);
  const tools::MadeScene made =
      tools::update_scene({o.scene, o.packages, o.no_cache ? nullptr : &cache,
                           [&](const std::string& stage) { progress.show(stage); }});
  say_made(
      o, made,
      o.scene + ": " +
          (made.containers.empty() ? std::string("nothing is out of date")
                                   : std::to_string(made.containers.size()) + " sets made anew"),
      "update");
  return tools::kDone;
}

int find_pairs(const Options& o) {
  tools::require_apart({{"--srdf", o.srdf}, {"--report", o.common.report}}, {o.scene});
  const tools::SceneFile scene = tools::read_scene(o.scene);
  for (const std::string& note : scene.notes) tools::log(o.common.quiet, note);
  const auto& robots = scene.world.robots;
  if (robots.empty() || (o.robot.empty() && robots.size() > 1))
    throw Error(ErrorCode::InvalidArgument,
                robots.empty() ? "the scene has no robot" : "several robots: give --robot");
  const auto index =
      o.robot.empty() ? std::optional<std::size_t>(0) : scene.world.find_robot(o.robot);
  if (!index)
    throw Error(ErrorCode::InvalidArgument, "--robot: the scene has no robot '" + o.robot + "'");
  const auto say = [&](const std::string& line) {
    if (!o.common.quiet) std::cout << line << '\n';
  };
  const world::RobotModel& robot = robots[*index];
  const auto name = [&](std::uint32_t link) { return robot.kinematics.links[link].name; };
  std::vector<world::AllowedPair> allowed = world::connected_links(robot);
  tools::Json pairs = tools::Json::array(), never = tools::Json::array();
  std::vector<world::AllowedPair> proofs;
  world::PairOptions options;
  options.most_boxes = o.most_boxes;
  const auto begin = std::chrono::steady_clock::now();
  if (o.timeout > 0)
    options.stop = [&] {
      return std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(o.timeout);
    };
  for (const world::LinkPair& pair : examine_pairs(robot, options)) {
    const std::string reason = pair.reason ? name_of(*pair.reason) : "unproved";
    pairs.push_back({{"links", {name(pair.a), name(pair.b)}},
                     {"reason", reason},
                     {"contact_found", pair.meets},
                     {"contact_always", pair.meets_always}});
    say(name(pair.a) + " " + name(pair.b) + ": " +
        (pair.reason         ? reason
         : pair.meets_always ? "in contact everywhere, though they move against each other"
         : pair.meets        ? "in contact somewhere"
                             : reason));
    if (!pair.reason || *pair.reason == world::AllowedPair::Reason::Adjacent) continue;
    allowed.push_back({pair.a, pair.b, *pair.reason});
    if (*pair.reason != world::AllowedPair::Reason::Never) continue;
    never.push_back({name(pair.a), name(pair.b)});
    proofs.push_back(allowed.back());
  }
  if (!o.srdf.empty()) {
    const std::string text = to_srdf(robot, allowed);
    io::write_file(o.srdf, {text.data(), text.size()});
  }
  const tools::Json proved = {{"proved_for", proof_hash(robot, proofs)}, {"pairs", never}};
  if (!never.empty()) say("for the robot in the scene: \"never_in_contact\": " + proved.dump());
  tools::write_report(o.common, "kaboum-scene",
                      {{"command", "pairs"},
                       {"scene", o.scene},
                       {"robot", robot.name},
                       {"pairs", pairs},
                       {"never_in_contact", proved}});
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes scenes for kaboum-check and planners, and examines their robots.",
               "kaboum-scene"};
  Options options;
  CLI::App* make = describe_make(app, options);
  CLI::App* update = describe_update(app, options);
  describe_pairs(app, options);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 2 usage; 3 bad input; 4 output failed; 5 not built; 6 internal error; "
      "7 limit.");
  return tools::run(app, argc, argv, [&] {
    if (make->parsed()) return make_scene(options);
    return update->parsed() ? update_scene(options) : find_pairs(options);
  });
}
