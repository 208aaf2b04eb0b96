#include "robot_bodies.h"

#include <kaboum/geom/similar_name.h>
#include <kaboum/io/convex_io.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "find_mesh.h"
#include "notes.h"
#include "xml_kind.h"

extern char** environ;

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// Meshes of the Robotics Library's links are named by the scene; here by the links' names.
void find_meshes(robot::Robot& robot, const fs::path& folder) {
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
                          const std::string& epsilon, const fs::path& result, Notes& notes) {
  const fs::path report = fs::path(result).replace_extension(".json");
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
                                   "--report",
                                   report.string(),
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
  const std::vector<char> text = io::read_file(report);
  const Json said = Json::parse(text.begin(), text.end(), nullptr, false);
  ensure(said.is_object() && said.contains("notes"), "a report without notes");
  for (const Json& note : said["notes"]) notes.add(mesh.string(), note.get<std::string>());
  return io::read_convex_set(result);
}

}  // namespace

RobotFile read_robot(const std::string& path) {
  RobotFile out;
  out.path = path;
  const std::vector<char> bytes = io::read_file(path);
  out.sha256 = io::sha256(bytes);
  const std::string_view text(bytes.data(), bytes.size());
  const XmlKind kind = xml_kind(text);
  if (const std::string route = route_to_robot(kind); !route.empty())
    throw Error(ErrorCode::InvalidInput, path + ": " + route);
  if (kind == XmlKind::RlRobot) {
    out.robot = robot::parse_rl(text, path);
    find_meshes(out.robot, out.path.parent_path());
  } else {
    out.robot = robot::parse_urdf(text, path);
  }
  return out;
}

void require_links(const RobotFile& robot, const std::vector<std::string>& links) {
  std::vector<std::string> known;
  for (const robot::Link& link : robot.robot.links) known.push_back(link.name);
  for (const std::string& name : links) {
    if (robot.robot.find_link(name)) continue;
    std::string hint = geom::did_you_mean(name, known);
    if (hint.empty()) hint = "; it has " + names_of(known);
    throw Error(ErrorCode::InvalidArgument,
                robot.path.string() + ": --links: there is no link '" + name + "'" + hint);
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

BareLinks bare_links(const robot::Robot& robot, bool visual,
                     const std::vector<std::string>& links) {
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
      if (robot::is_flat(g))
        out.push_back(robot.path.string() + (g.line > 0 ? ":" + std::to_string(g.line) : "") +
                      ": link '" + link.name + "': a " + describe(g) +
                      (robot::is_point(g) ? " is a point: it is not covered"
                                          : " has no volume; its surface is covered, but engines "
                                            "may refuse it: give it a thickness"));
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

void place_shape(const Geometry& g, const geom::ConvexSet* set, const std::string& link,
                 std::uint32_t index, std::vector<robot::LinkBody>& bodies) {
  const auto name = [&] {
    const auto same = [&](const robot::LinkBody& b) { return b.link == index; };
    return link + "/" + std::to_string(std::count_if(bodies.begin(), bodies.end(), same));
  };
  // The points' own rounding where shape and link lie far from one another's origin.
  const auto rounding = [&](double size) { return 0x1p-46 * (size + g.origin.translation.norm()); };
  if (robot::is_point(g)) return;
  if (g.shape != Geometry::Shape::Mesh) {
    bodies.push_back({name(), index, robot::bounding_points(g), rounding(2 * g.size.norm())});
    return;
  }
  int exponent = 0;
  const bool exact = g.origin.linear.isIdentity(0) && g.origin.translation.isZero(0) &&
                     std::all_of(g.size.begin(), g.size.end(), [&](double s) {
                       return std::abs(std::frexp(s, &exponent)) == 0.5;
                     });
  for (const geom::ConvexBody& body : set->bodies) {
    robot::LinkBody b{name(), index, {}, g.size.cwiseAbs().maxCoeff() * set->margin};
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
  require_links(robot, options.links);
  const WorkFolder work;
  Notes notes;
  LinkBodies out;
  out.bare = bare_links(robot.robot, options.visual, options.links);
  out.notes = notes_on_flat_shapes(robot, options.visual, options.links);
  std::map<std::pair<std::string, std::string>, geom::ConvexSet> decomposed;
  for (std::uint32_t l = 0; l < robot.robot.links.size(); ++l) {
    const robot::Link& link = robot.robot.links[l];
    if (!options.links.empty() &&
        std::find(options.links.begin(), options.links.end(), link.name) == options.links.end())
      continue;
    const std::vector<Geometry>& shapes = options.visual ? link.visual : link.collision;
    for (const Geometry& g : shapes) {
      if (g.shape != Geometry::Shape::Mesh) {
        place_shape(g, nullptr, link.name, l, out.bodies);
        out.epsilon = std::max(out.epsilon, robot::bounding_excess(g));
        continue;
      }
      const fs::path mesh = resolve_mesh(g.mesh, robot.path, options.packages);
      const double scale = g.size.cwiseAbs().maxCoeff();
      const std::pair key{mesh.string(), epsilon_of_mesh(options.epsilon, scale)};
      auto it = decomposed.find(key);
      if (it == decomposed.end()) {
        const fs::path result = work.path() / (std::to_string(decomposed.size()) + ".glb");
        it = decomposed.emplace(key, decompose(mesh, options, key.second, result, notes)).first;
        if (std::find(out.files.begin(), out.files.end(), key.first) == out.files.end())
          out.files.push_back(key.first);
      }
      out.epsilon = std::max(out.epsilon, scale * std::max(it->second.provenance.epsilon, 0.0));
      place_shape(g, &it->second, link.name, l, out.bodies);
    }
  }
  for (std::string& line : notes.lines()) out.notes.push_back(std::move(line));
  if (out.bodies.empty())
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": no link has a shape" +
                    (options.visual ? std::string() : "; try --geometry visual"));
  return out;
}

}  // namespace kaboum::tools
