#include "robot_bodies.h"

#include <kaboum/io/convex_io.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>

extern char** environ;

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using sweep::Geometry;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Meshes of the Robotics Library's links are named by the scene; here by the links' names.
void find_meshes(sweep::Robot& robot, const fs::path& folder) {
  for (sweep::Link& link : robot.links) {
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

/// A folder that vanishes with this object.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (fs::temp_directory_path() / "kaboum-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw Error(ErrorCode::OutputFailed, name + ": no temporary folder can be made");
    path_ = name;
  }
  ~WorkFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The program of that name beside this one, else the one on PATH.
std::string program(const char* name) {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error && is_file(self.parent_path() / name)) return (self.parent_path() / name).string();
  return name;
}

/// Runs a program and waits for it. @return its exit code; 127 when it cannot be run.
int run_program(std::vector<std::string> arguments,
                const std::optional<std::string>& extra_variable) {
  std::vector<char*> argv, environment;
  for (std::string& a : arguments) argv.push_back(a.data());
  argv.push_back(nullptr);
  std::string extra = extra_variable.value_or("");
  const std::string key = extra.substr(0, extra.find('=') + 1);
  for (char** e = environ; *e != nullptr; ++e)
    if (key.empty() || !std::string(*e).starts_with(key)) environment.push_back(*e);
  if (!extra.empty()) environment.push_back(extra.data());
  environment.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawnp(&child, argv[0], nullptr, nullptr, argv.data(), environment.data()) != 0)
    return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return 127;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

ErrorCode code_of(int exit_code) {
  switch (exit_code) {
    case kBadInput:
    case kNo:
      return ErrorCode::InvalidInput;
    case kUsage:
      return ErrorCode::InvalidArgument;
    case kOutputFailed:
      return ErrorCode::OutputFailed;
    case kNotBuilt:
      return ErrorCode::NotBuilt;
    case kLimit:
      return ErrorCode::LimitReached;
    default:
      return ErrorCode::Internal;
  }
}

geom::ConvexSet decompose(const fs::path& mesh, const BodyOptions& options,
                          const std::string& epsilon, const fs::path& result) {
  std::vector<std::string> command{program("bcd-decompose"),
                                   mesh.string(),
                                   "-o",
                                   result.string(),
                                   "--epsilon",
                                   epsilon,
                                   "--max-vertices-per-body",
                                   std::to_string(options.max_vertices),
                                   "--effort",
                                   options.effort,
                                   "--threads",
                                   std::to_string(options.threads),
                                   "--quiet"};
  if (options.no_cache) command.emplace_back("--no-cache");
  if (options.drop_sheets) command.emplace_back("--drop-sheets");
  std::optional<std::string> variable;
  if (!options.cache.empty()) variable = "KABOUM_CACHE=" + options.cache;
  const int code = run_program(command, variable);
  if (code != kDone && (code != kNo || !is_file(result)))
    throw Error(code_of(code), mesh.string() + ": its decomposition failed (exit code " +
                                   std::to_string(code) + " of " + command.front() + ")");
  if (code == kNo)
    log(options.quiet, mesh.string() + ": the decomposition does not reach " + epsilon);
  return io::read_convex_set(result);
}

/// Name of a document's first element; empty when there is none.
std::string_view root_of(std::string_view text) {
  while (true) {
    const std::size_t begin = text.find('<');
    if (begin == std::string_view::npos) return {};
    text.remove_prefix(begin + 1);
    const std::string_view end = text.starts_with("!--") ? "-->"
                                 : text.starts_with("?") ? "?>"
                                 : text.starts_with("!") ? ">"
                                                         : "";
    if (end.empty()) return text.substr(0, text.find_first_of(" \t\r\n/>"));
    const std::size_t close = text.find(end);
    if (close == std::string_view::npos) return {};
    text.remove_prefix(close + end.size());
  }
}

}  // namespace

RobotFile read_robot(const std::string& path) {
  RobotFile out;
  out.path = path;
  const std::vector<char> bytes = io::read_file(path);
  out.sha256 = io::sha256(bytes);
  const std::string_view text(bytes.data(), bytes.size());
  if (const std::string_view root = root_of(text); root == "rlkin" || root == "rlmdl") {
    out.robot = sweep::parse_rl(text, path);
    find_meshes(out.robot, out.path.parent_path());
  } else {
    out.robot = sweep::parse_urdf(text, path);
  }
  return out;
}

std::string epsilon_of_mesh(const std::string& epsilon, double scale) {
  const auto length = parse_length(epsilon);
  if (!length || length->percent || scale == 1) return epsilon;
  std::ostringstream text;
  text.precision(17);
  text << length->value / scale;
  return text.str();
}

std::vector<fs::path> find_mesh(const std::string& reference, const fs::path& robot,
                                const std::vector<std::string>& packages) {
  const auto fail = [&](const std::string& where) -> std::vector<fs::path> {
    throw Error(ErrorCode::InvalidInput, robot.string() + ": no mesh file for '" + reference +
                                             "'; looked for it in " + where);
  };
  const fs::path folder = robot.has_parent_path() ? robot.parent_path() : fs::path(".");
  const std::string file = "file://", package = "package://";
  if (reference.starts_with(package)) {
    const fs::path rest = reference.substr(package.size());
    std::vector<fs::path> places(packages.begin(), packages.end());
    if (const char* variable = std::getenv("ROS_PACKAGE_PATH")) {
      std::string list = variable;
      for (std::size_t begin = 0; begin < list.size();) {
        const std::size_t end = std::min(list.find(':', begin), list.size());
        if (end > begin) places.emplace_back(list.substr(begin, end - begin));
        begin = end + 1;
      }
    }
    std::error_code error;
    const fs::path start = fs::absolute(folder, error).lexically_normal();
    for (fs::path up = start;; up = up.parent_path()) {
      places.push_back(up);
      if (up == up.root_path() || up.empty()) break;
    }
    std::vector<fs::path> found;
    for (const fs::path& place : places)
      if (is_file(place / rest)) found.push_back(place / rest);
    return found.empty()
               ? fail("--package-path, $ROS_PACKAGE_PATH and the folders above the robot's file")
               : found;
  }
  if (reference.find("://") != std::string::npos && !reference.starts_with(file))
    return fail("no place: only package:// and file:// are known");
  fs::path path =
      reference.starts_with(file) ? fs::path(reference.substr(file.size())) : fs::path(reference);
  if (path.is_relative()) path = folder / path;
  if (is_file(path)) return {path};
  return fail(path.parent_path().string());
}

fs::path resolve_mesh(const std::string& reference, const fs::path& robot,
                      const std::vector<std::string>& packages) {
  return find_mesh(reference, robot, packages).front();
}

void place_shape(const Geometry& g, const geom::ConvexSet* set, const std::string& link,
                 std::uint32_t index, std::vector<sweep::Body>& bodies) {
  const auto name = [&] {
    const auto same = [&](const sweep::Body& b) { return b.link == index; };
    return link + "/" + std::to_string(std::count_if(bodies.begin(), bodies.end(), same));
  };
  // The points' own rounding where shape and link lie far from one another's origin.
  const auto rounding = [&](double size) { return 0x1p-46 * (size + g.origin.translation.norm()); };
  if (g.shape != Geometry::Shape::Mesh) {
    bodies.push_back({name(), index, sweep::bounding_points(g), rounding(2 * g.size.norm())});
    return;
  }
  int exponent = 0;
  const bool exact = g.origin.linear.isIdentity(0) && g.origin.translation.isZero(0) &&
                     std::all_of(g.size.begin(), g.size.end(), [&](double s) {
                       return std::abs(std::frexp(s, &exponent)) == 0.5;
                     });
  for (const geom::ConvexBody& body : set->bodies) {
    sweep::Body b{name(), index, {}, g.size.cwiseAbs().maxCoeff() * set->margin};
    double size = 0;
    for (const geom::Vec3& p : body.hull.vertices) {
      const geom::Vec3 scaled = p.cwiseProduct(g.size);
      size = std::max(size, scaled.norm());
      b.points.emplace_back(exact ? scaled : g.origin * scaled);
    }
    if (!exact) b.margin += rounding(size);
    bodies.push_back(std::move(b));
  }
}

LinkBodies bodies_of(const RobotFile& robot, const BodyOptions& options) {
  for (const std::string& name : options.links)
    if (!robot.robot.find_link(name))
      throw Error(ErrorCode::InvalidArgument,
                  robot.path.string() + ": there is no link '" + name + "'");
  const WorkFolder work;
  LinkBodies out;
  std::map<std::pair<std::string, std::string>, geom::ConvexSet> decomposed;
  for (std::uint32_t l = 0; l < robot.robot.links.size(); ++l) {
    const sweep::Link& link = robot.robot.links[l];
    if (!options.links.empty() &&
        std::find(options.links.begin(), options.links.end(), link.name) == options.links.end())
      continue;
    const std::vector<Geometry>& shapes = options.visual ? link.visual : link.collision;
    if (shapes.empty()) out.bare.push_back(link.name);
    for (const Geometry& g : shapes) {
      if (g.shape != Geometry::Shape::Mesh) {
        place_shape(g, nullptr, link.name, l, out.bodies);
        out.epsilon = std::max(out.epsilon, sweep::bounding_excess(g));
        continue;
      }
      const fs::path mesh = resolve_mesh(g.mesh, robot.path, options.packages);
      const double scale = g.size.cwiseAbs().maxCoeff();
      const std::pair key{mesh.string(), epsilon_of_mesh(options.epsilon, scale)};
      auto it = decomposed.find(key);
      if (it == decomposed.end()) {
        const fs::path result = work.path() / (std::to_string(decomposed.size()) + ".glb");
        it = decomposed.emplace(key, decompose(mesh, options, key.second, result)).first;
        if (std::find(out.files.begin(), out.files.end(), key.first) == out.files.end())
          out.files.push_back(key.first);
      }
      out.epsilon = std::max(out.epsilon, scale * std::max(it->second.provenance.epsilon, 0.0));
      place_shape(g, &it->second, link.name, l, out.bodies);
    }
  }
  if (out.bodies.empty())
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": no link has a shape" +
                    (options.visual ? std::string() : "; try --geometry visual"));
  return out;
}

}  // namespace kaboum::tools
