// Robots from files, with the meshes that they refer to found.

#include <kaboum/robot/robot_file.h>

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/xml_kind.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/mjcf.h>
#include <kaboum/robot/sdf.h>

#include <algorithm>
#include <cctype>
#include <functional>

#include "is_file.h"
#include "xacro.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;

/// Meshes of the Robotics Library's links are named by the scene; here by the links' names.
void find_meshes(Robot& robot, const fs::path& folder) {
  for (robot::Link& link : robot.links) {
    std::vector<std::string> names{link.name};
    if (link.name.starts_with("body")) names.push_back("link" + link.name.substr(4));
    for (const std::string& name : names) {
      for (const char* extension : {".wrl", ".stl", ".obj", ".ply", ".off"}) {
        if (!link.collision.empty() || !is_file(folder / (name + extension))) continue;
        Geometry g;
        g.shape = Geometry::Shape::Mesh;
        g.mesh = name + extension;
        link.collision.push_back(g);
        link.visual.push_back(std::move(g));
      }
    }
  }
}

/// What to do with a document of this kind where a robot is to come; empty for robots, and for
/// damaged XML.
std::string route_to_robot(io::XmlKind kind, std::string_view text) {
  const std::string urdf =
      "; give the robot as URDF, MJCF or SDF, or as rlkin or rlmdl (Robotics Library)";
  switch (kind) {
    case io::XmlKind::Srdf:
      return describe(kind) + "; give the URDF that it belongs to";
    case io::XmlKind::RlScene:
      return describe(kind) + "; give the rlkin or rlmdl that moves it";
    case io::XmlKind::Other:
      return "no robot, but " + io::describe_other(text) + urdf;
    case io::XmlKind::None:
      // Where it is XML, its parser says where it is damaged.
      if (const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
          first != std::string_view::npos && text[first] != '<')
        return "no robot, but " + io::describe_other(text) + urdf;
      break;
    case io::XmlKind::Urdf:
    case io::XmlKind::Xacro:  // its parser names the line
    case io::XmlKind::Mjcf:
    case io::XmlKind::Sdf:
    case io::XmlKind::RlRobot:
      break;
  }
  return {};
}

/// What an SDF robot includes. @param took  gets the file of each
ModelSource models_of(const RobotFile& robot, std::function<void(const std::string&)> took) {
  return [packages = robot.packages, took = std::move(took)](const std::string& uri,
                                                             const std::string& from) {
    const fs::path file = fs::absolute(find_model(uri, from, packages)).lexically_normal();
    took(file.string());
    const std::vector<char> bytes = io::read_file(file);
    return IncludedModel{file.string(), {bytes.begin(), bytes.end()}};
  };
}

}  // namespace

bool is_xacro(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".xacro";
}

void require_modelled(const RobotFile& robot) {
  if (robot.robot.unmodelled.empty()) return;
  throw Error(ErrorCode::InvalidInput,
              robot.robot.unmodelled.front() +
                  "; motions are known of joints that turn or slide. bcd-decompose, bmesh-decimate "
                  "and bound-verify robot take it: shapes do not depend on joints");
}

Dynamics dynamics_of(const RobotFile& robot) {
  const std::string name = robot.path.string();
  if (robot.format == RobotFile::Format::Mjcf) return parse_mjcf(robot.text, name).dynamics;
  if (robot.format == RobotFile::Format::Sdf) return parse_sdf(robot.text, name).dynamics;
  return parse_dynamics(robot.text, name);
}

RobotFile read_robot(const std::string& path, Motions motions,
                     const std::vector<std::string>& xacro_arguments,
                     const std::vector<std::string>& packages) {
  RobotFile out;
  out.path = path;
  out.xacro_arguments = xacro_arguments;
  out.packages = packages;
  if (!xacro_arguments.empty() && !is_xacro(path))
    throw Error(ErrorCode::InvalidArgument,
                path + ": arguments of xacro are for files called NAME.xacro");
  std::string name = path;
  const std::vector<char> bytes = io::read_file(path);
  if (is_xacro(path)) {
    out.text = expand_xacro(path, xacro_arguments, {}, packages);
    name += " (expanded)";  // whose lines are others
  } else {
    out.text.assign(bytes.begin(), bytes.end());
  }
  out.sha256 = io::sha256(out.text);
  const io::XmlKind kind = io::xml_kind(out.text);
  if (const std::string route = route_to_robot(kind, out.text); !route.empty())
    throw Error(ErrorCode::InvalidInput, name + ": " + route);
  if (kind == io::XmlKind::RlRobot) {
    out.robot = robot::parse_rl(out.text, name);
    out.format = RobotFile::Format::Rl;
    find_meshes(out.robot, out.path.parent_path());
  } else if (kind == io::XmlKind::Mjcf) {
    out.format = RobotFile::Format::Mjcf;
    const auto read = [&](const std::string& file) {
      const std::vector<char> included = io::read_file(out.path.parent_path() / file);
      return std::string(included.begin(), included.end());
    };
    const auto exists = [&](const std::string& file) {
      return is_file(out.path.parent_path() / file);
    };
    const std::string expanded = expand_mjcf(out.text, name, read, exists);
    const std::string whole =
        attach_mjcf(expanded, expanded == out.text ? name : name + " (expanded)", read);
    std::string stated = state_fitted_sizes(
        whole, whole == out.text ? name : name + " (expanded)",
        [&](const std::string& file) { return io::read_mesh(out.path.parent_path() / file).mesh; });
    if (stated != out.text) name += " (expanded)";
    out.text = std::move(stated);
    out.sha256 = io::sha256(out.text);
    out.robot = parse_mjcf(out.text, name).robot;
  } else if (kind == io::XmlKind::Sdf) {
    out.format = RobotFile::Format::Sdf;
    std::string whole =
        include_sdf(out.text, name, fs::absolute(out.path).lexically_normal().string(),
                    models_of(out, [](const std::string&) {}));
    if (whole != out.text) {
      name += " (expanded)";
      out.text = std::move(whole);
      out.sha256 = io::sha256(out.text);
    }
    out.robot = parse_sdf(out.text, name).robot;
  } else {
    out.robot = robot::parse_urdf(out.text, name);
  }
  if (motions == Motions::All) require_modelled(out);
  return out;
}

std::vector<std::string> included_files(const RobotFile& robot) {
  if (is_xacro(robot.path))
    return xacro_includes(robot.path, robot.xacro_arguments, {}, robot.packages);
  std::vector<std::string> files;
  if (robot.format == RobotFile::Format::Mjcf) {
    const std::vector<char> bytes = io::read_file(robot.path);
    const fs::path folder = robot.path.parent_path();
    const std::string name = robot.path.string();
    const auto read = [&](const std::string& file) {
      const std::vector<char> included = io::read_file(folder / file);
      files.push_back((folder / file).string());
      return std::string(included.begin(), included.end());
    };
    const auto exists = [&](const std::string& file) { return is_file(folder / file); };
    const std::string text = attach_mjcf(
        expand_mjcf(std::string(bytes.begin(), bytes.end()), name, read, exists), name, read);
    static_cast<void>(state_fitted_sizes(text, name, [&](const std::string& file) {
      files.push_back((folder / file).string());
      return io::read_mesh(folder / file).mesh;
    }));
  }
  if (robot.format == RobotFile::Format::Sdf) {
    const std::vector<char> bytes = io::read_file(robot.path);
    static_cast<void>(include_sdf(std::string(bytes.begin(), bytes.end()), robot.path.string(),
                                  fs::absolute(robot.path).lexically_normal().string(),
                                  models_of(robot, [&](const std::string& file) {
                                    if (std::ranges::find(files, file) == files.end())
                                      files.push_back(file);
                                  })));
  }
  return files;
}

void require_links(const RobotFile& robot, const std::vector<std::string>& links) {
  std::vector<std::string> known;
  for (const robot::Link& link : robot.robot.links) known.push_back(link.name);
  for (const std::string& name : links) {
    if (robot.robot.find_link(name)) continue;
    std::string hint = kaboum::did_you_mean(name, known);
    if (hint.empty()) hint = "; it has " + names_of(known);
    std::string message = robot.path.string();
    message.append(": «links»: there is no link '").append(name).append("'").append(hint);
    throw Error(ErrorCode::InvalidArgument, message);
  }
}

std::string names_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::size_t shown = names.size() <= kMost ? names.size() : kMost - 1;
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == names.size();
    text += (i == 0 ? "'" : last ? " and '" : ", '") + names[i] + "'";
  }
  if (shown < names.size()) text += " and " + std::to_string(names.size() - shown) + " more";
  return text;
}

std::vector<std::string> BareLinks::all() const {
  std::vector<std::string> out = empty;
  out.insert(out.end(), other.begin(), other.end());
  return out;
}

BareLinks bare_links(const Robot& robot, bool visual, const std::vector<std::string>& links) {
  BareLinks out;
  for (const robot::Link& link : robot.links) {
    if (!links.empty() && std::find(links.begin(), links.end(), link.name) == links.end()) continue;
    const auto &shapes = visual ? link.visual : link.collision,
               &others = visual ? link.collision : link.visual;
    if (shapes.empty()) (others.empty() ? out.empty : out.other).push_back(link.name);
  }
  return out;
}

std::vector<std::string> notes_on(const BareLinks& bare, bool visual,
                                  const std::string& consequence) {
  std::vector<std::string> out;
  const auto add = [&](const std::vector<std::string>& names, const std::string& what) {
    if (names.empty()) return;
    out.push_back((names.size() == 1 ? "link " : "links ") + names_of(names) +
                  (names.size() == 1 ? " has no " : " have no ") + what + consequence);
  };
  const std::string kind = visual ? "visual" : "collision", other = visual ? "collision" : "visual";
  add(bare.empty, kind + " shape");
  add(bare.other, kind + " shape, only " + other + " ones");
  return out;
}

std::string links_judged(std::size_t judged, std::size_t asked, const BareLinks& bare) {
  std::string text = std::to_string(judged) + " of " + std::to_string(asked) +
                     (asked == 1 ? " link judged" : " links judged");
  if (!bare.other.empty())
    text += "; not " + names_of(bare.other) + ", with shapes of the other kind only";
  return text;
}

std::vector<std::string> notes_on_flat_shapes(const RobotFile& robot, bool visual,
                                              const std::vector<std::string>& links) {
  std::vector<std::string> out;
  for (const robot::Link& link : robot.robot.links) {
    if (!links.empty() && std::find(links.begin(), links.end(), link.name) == links.end()) continue;
    for (const Geometry& g : visual ? link.visual : link.collision)
      if (robot::is_flat(g)) {
        std::string place = robot.path.string();
        if (g.line > 0) place.append(":").append(std::to_string(g.line));
        out.push_back(place + ": link '" + link.name + "': a " + describe(g) +
                      (robot::is_point(g) ? " is a point: it is not covered"
                                          : " has no volume; its surface is covered, but engines "
                                            "may refuse it: give it a thickness"));
      }
  }
  return out;
}

}  // namespace kaboum::robot
