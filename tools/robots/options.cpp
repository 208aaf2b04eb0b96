// The options of robots: which shapes, names of files, formats, and what --for sets of them.

#include "options.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/xml_kind.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/robot_folder/loaders.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>

#include "common/request_options.h"
#include "link_epsilons.h"

namespace kaboum::tools {
namespace {

void add_formats(CLI::App& app, RobotOptions& o) {
  std::vector<std::string> names;
  for (const robot_folder::Loader& loader : robot_folder::loaders())
    names.emplace_back(loader.name);
  app.add_option("--robot-format", o.formats,
                 "Also write the robot as MJCF (NAME.xml), SDF (NAME.sdf) or USD with UsdPhysics "
                 "(NAME.usda, "
                 "of convex bodies only), beside the format that it is in, which is always written "
                 "(repeatable)")
      ->delimiter(',')
      ->check(CLI::IsMember({"urdf", "mjcf", "sdf", "usd"}).description(""))
      ->type_name("urdf|mjcf|sdf|usd");
  app.add_option("--for", o.preset,
                 "Set --robot-format, --mesh-prefix, the bodies' format and --min-thickness as the "
                 "program that is to load a robot needs them, where no other option sets them")
      ->check(CLI::IsMember(names).description(""))
      ->type_name("moveit|mujoco|gazebo|bullet|drake");
  app.add_option("--html-report", o.html,
                 "Write a page about a robot: of every link, pictures of original and result, "
                 "counts, epsilon, time and verdict")
      ->check(page_name())
      ->type_name("FILE.html");
}

}  // namespace

bool RobotOptions::writes(const std::string& format) const {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

bool is_robot(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".urdf" || extension == ".xacro" || extension == ".sdf" || extension == ".mjcf")
    return true;
  if (extension != ".xml" || !std::filesystem::is_regular_file(path)) return false;
  const std::vector<char> text = io::read_file(path);
  const io::XmlKind kind = io::xml_kind({text.data(), text.size()});
  return kind == io::XmlKind::Urdf || kind == io::XmlKind::Mjcf || kind == io::XmlKind::Sdf;
}

void add_robot_options(CLI::App& app, RobotOptions& o, bool from) {
  add_request_options(app, robot::held_shape_options(), o.shapes, o.stated);
  if (from)
    app.add_option_function<std::string>(
           "--from", [&o](const std::string& value) { o.shapes.visual = value == "visual"; },
           "The same as --geometry")
        ->check(CLI::IsMember({"collision", "visual"}).description(""))
        ->type_name("collision|visual");
  app.add_flag_callback(
      "--visual", [&o] { o.shapes.visual = true; }, "The same as --geometry visual");
  app.add_option(
         "--mesh-prefix", o.prefix,
         "Put before the new meshes' file names in a robot's new URDF, as in package://arm, with "
         "a slash between; RViz and MoveIt need it [names relative to the URDF]")
      ->type_name("URI");
  app.add_option("--epsilons", o.epsilons,
                 "Epsilon of single links of a robot, a YAML or JSON file: names of links, or "
                 "patterns with * and ?, each with a length or a percentage, as in wrist_*: 0.5% "
                 "[--epsilon for all]")
      ->type_name("FILE");
  app.add_flag("--verbose", o.verbose,
               "Of a robot, also print a line for each mesh and all notes, which otherwise only "
               "--report and --html-report have");
  add_xacro_arguments(app, o.xacro_arguments);
  add_formats(app, o);
}

void add_require_closed(CLI::App& app, certify::PreparationOptions& options) {
  app.add_flag_callback(
         "--require-closed", [&options] { options.holes = geom::Holes::Refuse; },
         "The same as --holes refuse")
      ->excludes("--holes");
}

void require_options_of_meshes(const CLI::App& app, const std::string& input) {
  for (const char* option : {"--geometry", "--visual", "--links", "--package-path", "--mesh-prefix",
                             "--epsilons", "--xacro-args", "--robot-format", "--for",
                             "--html-report", "--verbose", "--missing-meshes"})
    if (app.get_option(option)->count() != 0)
      throw Error(ErrorCode::InvalidArgument, std::string(option) +
                                                  " is for robots (.urdf, .xacro, .xml, .sdf); " +
                                                  input + " is taken for a mesh");
}

void apply_preset(const CLI::App& app, const std::string& folder, RobotOptions& o,
                  std::optional<Length>* thickness) {
  if (o.preset.empty()) return;
  const robot_folder::Loader& loader = robot_folder::loader_of(o.preset);
  if (app.count("--robot-format") == 0) {
    o.formats.clear();
    if (loader.mjcf) o.formats.emplace_back("mjcf");
    if (loader.sdf) o.formats.emplace_back("sdf");
  }
  if (app.count("--mesh-prefix") == 0 && loader.package)
    o.prefix = robot_folder::package_prefix(folder);
  o.bodies = loader.bodies;
  o.declare_convex = loader.declare_convex;
  if (thickness != nullptr && app.count("--min-thickness") == 0 && loader.thickness > 0)
    *thickness = Length{loader.thickness};
}

certify::LinkEpsilons read_epsilons(const std::string& file, const robot::Robot& robot) {
  if (file.empty()) return {};
  const std::vector<char> bytes = io::read_file(file);
  return parse_epsilons({bytes.begin(), bytes.end()}, file, robot);
}

}  // namespace kaboum::tools
