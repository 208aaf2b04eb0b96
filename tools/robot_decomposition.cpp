#include "robot_decomposition.h"

#include <kaboum/io/convex_io.h>
#include <kaboum/robot/kinematics.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "file_names.h"
#include "find_mesh.h"
#include "link_container.h"
#include "urdf_output.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;
using tinyxml2::XMLElement;

/// The bodies of a mesh.
struct Decomposed {
  MeshBodies mesh;
  std::string file;
};

/// Where they are written: once for every scale that the mesh has. MuJoCo tells meshes apart by the
/// stems of their names, and its versions differ where a mesh has several scales.
struct Stored {
  const Decomposed* bodies = nullptr;
  std::string name;  ///< of the folder in bodies/, and the stem of its files
};

class Writer {
 public:
  Writer(const RobotDecomposition& options, const MeshDecomposer& decompose)
      : o_(options),
        decompose_(decompose),
        robot_(read_robot(options.robot)),
        urdf_(options.folder / fs::path(options.robot).filename()) {}

  RobotResult run() {
    parse();
    require_links(robot_, o_.links);
    result_.bare = bare_links(robot_.robot, o_.visual, o_.links);
    result_.notes = notes_on_flat_shapes(robot_, o_.visual, o_.links);
    for (std::uint32_t l = 0; l < robot_.robot.links.size(); ++l) decompose_link(l);
    if (total_bodies_ == 0)
      throw Error(ErrorCode::InvalidInput,
                  o_.robot + ": no link has a shape" +
                      (o_.visual ? std::string() : "; try --geometry visual"));
    create(o_.folder / "bodies");
    create(o_.folder / "links");
    for (const Stored* s : order_)
      io::write_convex_set(o_.folder / "bodies" / s->name, s->bodies->mesh.set,
                           io::SetFormat::Directory, s->name);
    for (const auto& [file, set] : containers_)
      io::write_convex_set(o_.folder / file, set, io::SetFormat::Glb);
    write_urdf();
    note_stale();
    result_.report["bodies"] = total_bodies_;
    result_.report["vertices"] = total_vertices_;
    result_.report["meshes"] = meshes_.size();
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
    reserve_names(document_.RootElement());
    for (const robot::Link& link : robot_.robot.links) reserve_stem(plain_file_name(link.name));
    rest_ = robot::forward(robot_.robot, std::vector<double>(robot_.robot.variables.size(), 0.0));
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

  const Stored& stored(const Geometry& g) {
    const fs::path file = resolve_mesh(g.mesh, robot_.path, o_.packages);
    std::error_code error;
    const fs::path canonical = fs::canonical(file, error);
    // By its place, not by its bytes, which may refer to other files.
    const std::string place = (error ? file : canonical).string();
    Stored& s = stored_[{place, {g.size.x(), g.size.y(), g.size.z()}}];
    if (s.bodies != nullptr) return s;
    s.name = names_.unique(file.stem().string());
    io::require_replaceable(o_.folder / "bodies" / s.name);
    // Turned over, the bodies are the same.
    const geom::Vec3 scale = g.size.cwiseAbs();
    Decomposed& d = meshes_[{place, {scale.x(), scale.y(), scale.z()}}];
    if (d.file.empty()) {
      result_.inputs.push_back(file);
      d.file = file.string();
      d.mesh = decompose_(file, scale);
      for (const std::string& other : d.mesh.other_files) result_.inputs.emplace_back(other);
    }
    s.bodies = &d;
    order_.push_back(&s);
    return s;
  }

  /// No body gets the stem of a mesh that stays.
  void reserve_names(const XMLElement* element) {
    for (const XMLElement* e = element->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      reserve_names(e);
      const char* name = e->Attribute("filename");
      if (name == nullptr || std::string_view(e->Name()) != "mesh") continue;
      reserve_stem(fs::path(name).stem().string());
    }
  }

  /// No body is to get this name: those of bodies end with a number.
  void reserve_stem(const std::string& stem) {
    const std::size_t dash = stem.rfind('-');
    if (dash != std::string::npos && stem.size() - dash > 4 &&
        stem.find_first_not_of("0123456789", dash + 1) == std::string::npos)
      names_.reserve(stem.substr(0, dash));
  }

  void decompose_link(std::uint32_t l) {
    const robot::Link& link = robot_.robot.links[l];
    static const std::vector<Geometry> kNone;
    const bool asked = o_.links.empty() ||
                       std::find(o_.links.begin(), o_.links.end(), link.name) != o_.links.end();
    const std::vector<Geometry>& shapes = !asked ? kNone : o_.visual ? link.visual : link.collision;
    XMLElement* element = element_of(link.name);
    const char* tag = o_.visual ? "visual" : "collision";
    std::vector<XMLElement*> originals;
    for (XMLElement* e = element->FirstChildElement(tag); e != nullptr;
         e = e->NextSiblingElement(tag))
      originals.push_back(e);
    if (asked && originals.size() != shapes.size())
      throw Error(ErrorCode::InvalidInput, o_.robot + ": link '" + link.name + "' has <" + tag +
                                               "> elements that cannot be read");
    std::vector<XMLElement*> old;
    for (XMLElement* e = element->FirstChildElement("collision"); e != nullptr;
         e = e->NextSiblingElement("collision"))
      old.push_back(e);
    std::vector<robot::LinkBody> bodies;
    double reach = 0;
    bool solid = true, surface = true;
    Json report = {{"link", link.name}, {"shapes", shapes.size()}};
    tinyxml2::XMLNode* last = element->LastChild();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Geometry& g = shapes[i];
      if (g.shape != Geometry::Shape::Mesh) {
        last = element->InsertAfterChild(last, collision(originals[i], link.name, bodies.size()));
        place_shape(g, nullptr, link.name, l, bodies);
        reach = std::max(reach, robot::bounding_excess(g));
        continue;
      }
      const Stored& file = stored(g);
      const Decomposed& d = *file.bodies;
      const geom::ConvexSet& set = d.mesh.set;
      for (std::size_t b = 0; b < set.bodies.size(); ++b) {
        XMLElement* copy = collision(originals[i], link.name, bodies.size() + b);
        XMLElement* mesh = copy->FirstChildElement("geometry")->FirstChildElement("mesh");
        const std::string name = io::default_name(b, file.name) + ".stl";
        mesh->SetAttribute("filename", (o_.prefix + "bodies/" + file.name + "/" + name).c_str());
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
      return;
    }
    for (XMLElement* e : old) element->DeleteChild(e);
    auto [set, beyond] = link_container(bodies);
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
    const std::string container_file = "links/" + link_names_.unique(link.name) + ".glb";
    report["file"] = container_file;
    report["bodies"] = bodies.size();
    report["reach_upper"] = reach;
    links_.push_back(std::move(report));
    total_bodies_ += set.bodies.size();
    for (const geom::ConvexBody& body : set.bodies) {
      total_vertices_ += body.hull.vertices.size();
      geom::ConvexBody posed = body;
      for (geom::Vec3& v : posed.hull.vertices) v = rest_[l] * v;
      result_.at_rest.bodies.push_back(std::move(posed));
    }
    containers_.emplace_back(container_file, std::move(set));
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
    let_mujoco_find_meshes(*document_.RootElement());
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    io::write_file(urdf_, std::string_view(printer.CStr()));
    result_.report["urdf"] = urdf_.string();
  }

  /// Names what is in bodies/ and links/ and not of this result, as an earlier one with other
  /// options leaves it. It stays: it may be somebody's own.
  void note_stale() {
    std::set<fs::path> written;
    for (const Stored* s : order_) written.insert(fs::path("bodies") / s->name);
    for (const auto& container : containers_) written.insert(container.first);
    std::vector<std::string> stale;
    for (const char* part : {"bodies", "links"}) {
      std::error_code error;
      for (const auto& entry : fs::directory_iterator(o_.folder / part, error)) {
        const fs::path name = fs::path(part) / entry.path().filename();
        if (!written.contains(name)) stale.push_back(name.generic_string());
      }
    }
    std::ranges::sort(stale);
    result_.report["stale"] = stale;
    if (!stale.empty())
      result_.notes.push_back(o_.folder.string() + ": " + names_of(stale) +
                              (stale.size() == 1 ? " is" : " are") +
                              " not of this result (perhaps of an earlier one), and left there");
  }

  const RobotDecomposition& o_;
  const MeshDecomposer& decompose_;
  RobotFile robot_;
  fs::path urdf_;
  tinyxml2::XMLDocument document_;
  std::vector<robot::Transform> rest_;
  using MeshKey = std::pair<std::string, std::array<double, 3>>;  // file, scale
  std::map<MeshKey, Decomposed> meshes_;                          // turned over or not
  std::map<MeshKey, Stored> stored_;
  std::vector<const Stored*> order_;
  std::vector<std::pair<std::string, geom::ConvexSet>> containers_;
  FileNames names_, link_names_;
  std::size_t total_bodies_ = 0, total_vertices_ = 0;
  Json links_ = Json::array();
  RobotResult result_;
};

}  // namespace

RobotResult decompose_robot(const RobotDecomposition& options, const MeshDecomposer& decompose) {
  return Writer(options, decompose).run();
}

}  // namespace kaboum::tools
