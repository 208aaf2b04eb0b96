#include "robot_decomposition.h"

#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/sweep/kinematics.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "robot_bodies.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using sweep::Geometry;
using tinyxml2::XMLElement;

/// A name for a file: what is no letter, digit, '-', '_' or '.' becomes '_'; never twice the same.
class FileNames {
 public:
  std::string unique(const std::string& wish) {
    std::string name;
    for (const char c : wish) {
      const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
      name += plain ? c : '_';
    }
    if (name.empty() || name.front() == '.') name.insert(0, "_");
    std::string result = name;
    for (int i = 2; !taken_.insert(lower(result)).second; ++i)
      result = name + "-" + std::to_string(i);
    return result;
  }

 private:
  static std::string lower(std::string s) {
    std::transform(s.begin(), s.end(), s.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return s;
  }
  std::set<std::string> taken_;
};

/// The bodies of a mesh, and the folder that they are in.
struct Decomposed {
  MeshBodies mesh;
  std::string file;
  std::string folder;  // relative to the output folder
};

/// A link's bodies as a set, and how far it reaches beyond them at most.
struct Container {
  geom::ConvexSet set;
  double beyond = 0;
};

struct Enlarged {
  geom::Mesh hull;
  double moved;  ///< how far vertices have been moved at most
};

/// A hull with float32 vertices that holds all that is within `radius` of this one; nullopt where
/// vertices would be moved by more than `most`, since the body is too thin.
///
/// The hull is scaled about its middle c by 1 + s. A facet's plane, h from c, moves outwards by
/// s·h, and back by no more than the largest rounding ρ of a vertex. So s·h ≥ radius + ρ for the
/// least h will do.
std::optional<Enlarged> enlarged(const geom::Mesh& hull, double radius, double most) {
  geom::Vec3 middle = geom::Vec3::Zero();
  for (const geom::Vec3& v : hull.vertices) middle += v / static_cast<double>(hull.vertices.size());
  double largest = 0, extent = 0;
  for (const geom::Vec3& v : hull.vertices) {
    largest = std::max(largest, v.cwiseAbs().maxCoeff());
    extent = std::max(extent, (v - middle).norm());
  }
  double height = extent;
  for (const geom::Triangle& t : hull.triangles) {
    const geom::Vec3& a = hull.vertices[t[0]];
    const geom::Vec3 n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
    if (!(n.norm() > 0)) return std::nullopt;
    height = std::min(height, n.dot(a - middle) / n.norm());
  }
  height *= 1 - 1e-6;
  // What rounding may have falsified heights by must not matter.
  if (!(height > 1e-9 * (extent + largest))) return std::nullopt;
  // Half a spacing of float32 a coordinate, and the rounding of what is computed here.
  const double rounding = geom::float32_spacing(largest + most) + 0x1p-48 * largest;
  const double share = (radius + rounding) / height * (1 + 1e-6);
  std::vector<geom::Vec3> points;
  Enlarged result{{}, 0};
  for (const geom::Vec3& v : hull.vertices) {
    points.push_back(geom::to_float32(geom::Vec3(middle + (1 + share) * (v - middle))));
    result.moved = std::max(result.moved, (points.back() - v).norm() * (1 + 0x1p-50));
  }
  if (!(result.moved <= most)) return std::nullopt;
  std::optional<geom::Mesh> larger = geom::convex_hull(points);
  if (!larger) return std::nullopt;
  result.hull = *std::move(larger);
  return result;
}

/// Float32 points, their hulls, and what rounding may have moved them by: the bodies are enlarged
/// by it, or where one is too thin for that, it is the set's margin.
Container container(const std::vector<sweep::Body>& bodies, const std::string& link) {
  Container out;
  double margin = 0;
  for (const sweep::Body& body : bodies) {
    std::vector<geom::Vec3> points;
    double moved = 0;
    for (const geom::Vec3& p : body.points) {
      points.push_back(geom::to_float32(p));
      // The difference of a double and its float32 neighbour is exact; its norm is not.
      moved = std::max(moved, (points.back() - p).norm() * (1 + 0x1p-50));
    }
    const auto hull = geom::convex_hull(points);
    if (!hull)
      throw Error(ErrorCode::InvalidInput,
                  "link '" + link + "': a body is too thin for float32 in the link's frame");
    out.set.bodies.push_back({body.name, *hull});
    margin = std::max(margin, (body.margin + moved) * (1 + 0x1p-50));
  }
  out.beyond = 2 * margin;
  if (!(margin > 0)) return out;
  constexpr double kMost = 1e-4;  // of the link's diagonal
  geom::Box3 box;
  for (const geom::ConvexBody& body : out.set.bodies)
    for (const geom::Vec3& v : body.hull.vertices) box.extend(v);
  double moved = 0;
  std::vector<geom::ConvexBody> larger;
  for (const geom::ConvexBody& body : out.set.bodies) {
    std::optional<Enlarged> e = enlarged(body.hull, margin, kMost * box.diagonal());
    if (!e) break;
    moved = std::max(moved, e->moved);
    larger.push_back({body.name, std::move(e->hull)});
  }
  if (larger.size() < out.set.bodies.size()) {
    out.set.margin = margin;
    return out;
  }
  out.set.bodies = std::move(larger);
  out.beyond += moved;
  return out;
}

class Writer {
 public:
  Writer(const RobotDecomposition& options, const MeshDecomposer& decompose)
      : o_(options),
        decompose_(decompose),
        robot_(read_robot(options.robot)),
        urdf_(options.folder / fs::path(options.robot).filename()) {}

  RobotResult run() {
    parse();
    for (std::uint32_t l = 0; l < robot_.robot.links.size(); ++l) decompose_link(l);
    if (total_bodies_ == 0)
      throw Error(ErrorCode::InvalidInput,
                  o_.robot + ": no link has a shape" +
                      (o_.visual ? std::string() : "; try --geometry visual"));
    create(o_.folder / "bodies");
    create(o_.folder / "links");
    for (const Decomposed* d : order_)
      io::write_convex_set(o_.folder / d->folder, d->mesh.set, io::SetFormat::Directory);
    for (const auto& [file, set] : containers_)
      io::write_convex_set(o_.folder / file, set, io::SetFormat::Glb);
    write_urdf();
    result_.report["bodies"] = total_bodies_;
    result_.report["vertices"] = total_vertices_;
    result_.report["meshes"] = order_.size();
    result_.report["links"] = links_;
    return std::move(result_);
  }

 private:
  static void create(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
      throw Error(ErrorCode::OutputFailed,
                  folder.string() + ": cannot be created: " + error.message());
  }

  void parse() {
    std::error_code error;
    if (fs::equivalent(urdf_, o_.robot, error))
      throw Error(ErrorCode::InvalidArgument,
                  urdf_.string() + ": would overwrite the input; name another folder");
    require_own_folder();
    const std::vector<char> bytes = io::read_file(o_.robot);
    if (document_.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS ||
        document_.RootElement() == nullptr ||
        std::string(document_.RootElement()->Name()) != "robot")
      throw Error(ErrorCode::InvalidInput, o_.robot + ": not a URDF");
    result_.inputs.emplace_back(o_.robot);
    rest_ = sweep::forward(robot_.robot, std::vector<double>(robot_.robot.variables.size(), 0.0));
  }

  /// Bodies are named after their meshes: those of another robot in the folder would be replaced.
  void require_own_folder() const {
    std::error_code error;
    if (fs::exists(urdf_, error) && !fs::exists(o_.folder / "bodies", error))
      throw Error(ErrorCode::OutputFailed,
                  urdf_.string() + ": exists, and not with bodies/ beside it as a result of this " +
                      "program would; remove it or name another folder");
    for (const auto& entry : fs::directory_iterator(o_.folder, error))
      if (entry.path().extension() == ".urdf" && entry.path().filename() != urdf_.filename())
        throw Error(ErrorCode::OutputFailed,
                    entry.path().string() +
                        ": another robot, whose bodies would be replaced; name another folder");
  }

  XMLElement* element_of(const std::string& link) {
    for (XMLElement* e = document_.RootElement()->FirstChildElement("link"); e != nullptr;
         e = e->NextSiblingElement("link"))
      if (const char* name = e->Attribute("name"); name != nullptr && link == name) return e;
    throw Error(ErrorCode::Internal, o_.robot + ": link '" + link + "' is lost");
  }

  const Decomposed& decomposed(const Geometry& g) {
    const fs::path file = resolve_mesh(g.mesh, robot_.path, o_.packages);
    const geom::Vec3 scale = g.size.cwiseAbs();
    std::error_code error;
    const fs::path canonical = fs::canonical(file, error);
    // By its place, not by its bytes, which may refer to other files.
    const MeshKey key{(error ? file : canonical).string(), {scale.x(), scale.y(), scale.z()}};
    const auto it = meshes_.find(key);
    if (it != meshes_.end()) return it->second;
    result_.inputs.push_back(file);
    Decomposed& d = meshes_[key];
    d.file = file.string();
    d.folder = "bodies/" + folders_.unique(file.stem().string());
    io::require_replaceable(o_.folder / d.folder);
    d.mesh = decompose_(file, scale);
    order_.push_back(&d);
    return d;
  }

  void decompose_link(std::uint32_t l) {
    const sweep::Link& link = robot_.robot.links[l];
    const std::vector<Geometry>& shapes = o_.visual ? link.visual : link.collision;
    XMLElement* element = element_of(link.name);
    const char* tag = o_.visual ? "visual" : "collision";
    std::vector<XMLElement*> originals;
    for (XMLElement* e = element->FirstChildElement(tag); e != nullptr;
         e = e->NextSiblingElement(tag))
      originals.push_back(e);
    if (originals.size() != shapes.size())
      throw Error(ErrorCode::InvalidInput, o_.robot + ": link '" + link.name + "' has <" + tag +
                                               "> elements that cannot be read");
    std::vector<XMLElement*> old;
    for (XMLElement* e = element->FirstChildElement("collision"); e != nullptr;
         e = e->NextSiblingElement("collision"))
      old.push_back(e);
    std::vector<sweep::Body> bodies;
    double reach = 0;
    bool solid = true, surface = true;
    Json report = {{"link", link.name}, {"shapes", shapes.size()}};
    tinyxml2::XMLNode* last = element->LastChild();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Geometry& g = shapes[i];
      if (g.shape != Geometry::Shape::Mesh) {
        last = element->InsertAfterChild(last, collision(originals[i], link.name, bodies.size()));
        place_shape(g, nullptr, link.name, l, bodies);
        reach = std::max(reach, sweep::bounding_excess(g));
        continue;
      }
      const Decomposed& d = decomposed(g);
      const geom::ConvexSet& set = d.mesh.set;
      for (std::size_t b = 0; b < set.bodies.size(); ++b) {
        XMLElement* copy = collision(originals[i], link.name, bodies.size() + b);
        XMLElement* mesh = copy->FirstChildElement("geometry")->FirstChildElement("mesh");
        mesh->SetAttribute("filename",
                           (o_.prefix + d.folder + "/" + io::default_name(b) + ".stl").c_str());
        last = element->InsertAfterChild(last, copy);
      }
      place_shape(g, &set, link.name, l, bodies);
      reach = std::max(reach, g.size.cwiseAbs().maxCoeff() * set.provenance.epsilon);
      solid = solid && set.provenance.covers_solid;
      surface = surface && set.provenance.covers_surface;
      report["meshes"].push_back({{"file", d.file}, {"result", d.mesh.report}});
    }
    if (shapes.empty()) {
      // What the link has for collisions stays.
      for (XMLElement* e : old) move_references(e);
      result_.bare.push_back(link.name);
      return;
    }
    for (XMLElement* e : old) element->DeleteChild(e);
    auto [set, beyond] = container(bodies, link.name);
    geom::Provenance& p = set.provenance;
    p.source = fs::path(o_.robot).filename().string();
    p.source_sha256 = robot_.sha256;
    p.tool = std::string("bcd-decompose ") + version();
    p.parameters = o_.parameters;
    p.unit = o_.unit;
    p.frame = link.name;
    p.direction = "outer";
    p.epsilon = reach + beyond;
    p.covers_solid = solid;
    p.covers_surface = surface;
    const std::string file = "links/" + link_files_.unique(link.name) + ".glb";
    report["file"] = file;
    report["bodies"] = bodies.size();
    report["reach_upper"] = reach;
    report["margin"] = set.margin;
    links_.push_back(std::move(report));
    total_bodies_ += set.bodies.size();
    for (const geom::ConvexBody& body : set.bodies) {
      total_vertices_ += body.hull.vertices.size();
      geom::ConvexBody posed = body;
      for (geom::Vec3& v : posed.hull.vertices) v = rest_[l] * v;
      result_.at_rest.bodies.push_back(std::move(posed));
    }
    containers_.emplace_back(file, std::move(set));
  }

  /// A <collision> with the pose and geometry of a <collision> or <visual>.
  XMLElement* collision(const XMLElement* original, const std::string& link, std::size_t number) {
    XMLElement* copy = document_.NewElement("collision");
    copy->SetAttribute("name", (link + "_" + std::to_string(number)).c_str());
    for (const char* part : {"origin", "geometry"})
      if (const XMLElement* e = original->FirstChildElement(part))
        copy->InsertEndChild(e->DeepClone(&document_));
    return copy;
  }

  /// Names relative to the robot's folder become relative to the output folder.
  void move_references(XMLElement* element) {
    for (XMLElement* e = element->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string tag = e->Name();
      const char* name = e->Attribute("filename");
      if (tag != "collision") move_references(e);
      if (name == nullptr || (tag != "mesh" && tag != "texture")) continue;
      const std::string reference = name;
      if (reference.find("://") != std::string::npos || fs::path(reference).is_absolute()) continue;
      const fs::path file = fs::absolute(robot_.path).parent_path() / reference;
      std::error_code error;
      const fs::path moved = fs::relative(file, fs::absolute(o_.folder), error);
      if (!error) e->SetAttribute("filename", moved.generic_string().c_str());
    }
  }

  void write_urdf() {
    move_references(document_.RootElement());
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    io::write_file(urdf_, std::string_view(printer.CStr()));
    result_.report["urdf"] = urdf_.string();
  }

  const RobotDecomposition& o_;
  const MeshDecomposer& decompose_;
  RobotFile robot_;
  fs::path urdf_;
  tinyxml2::XMLDocument document_;
  std::vector<sweep::Transform> rest_;
  using MeshKey = std::pair<std::string, std::array<double, 3>>;  // file, scale
  std::map<MeshKey, Decomposed> meshes_;
  std::vector<const Decomposed*> order_;
  std::vector<std::pair<std::string, geom::ConvexSet>> containers_;
  FileNames folders_, link_files_;
  std::size_t total_bodies_ = 0, total_vertices_ = 0;
  Json links_ = Json::array();
  RobotResult result_;
};

}  // namespace

RobotResult decompose_robot(const RobotDecomposition& options, const MeshDecomposer& decompose) {
  return Writer(options, decompose).run();
}

}  // namespace kaboum::tools
