#include "verify_sweep.h"

#include <kaboum/geom/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path.h>
#include <kaboum/verify/sweep.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

#include "find_mesh.h"
#include "notes.h"
#include "prepared_original.h"
#include "robot_file.h"
#include "robot_path.h"
#include "verdict.h"

namespace kaboum::tools {
namespace {

using verify::Answer;
using Stage = verify::ChainStage;

Json to_json(const geom::Vec3& p) { return {p.x(), p.y(), p.z()}; }

struct Shapes {
  std::vector<verify::MovingShape> shapes;
  std::vector<std::uint32_t> links;  // of the shapes
  std::vector<std::string> files, notes;
  Notes mesh_notes;
  DroppedSheets dropped;
  BareLinks bare;
  std::size_t judged = 0, asked = 0;  // links
};

/// The joints from the root to a link, in this verifier's words.
verify::LinkChain chain_to(const robot::Robot& robot, std::uint32_t link) {
  verify::LinkChain chain;
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) {
    const robot::Joint& joint = robot.joints[l - 1];
    Stage stage;
    stage.rotation = joint.origin.linear;
    stage.translation = joint.origin.translation;
    if (joint.type != robot::JointType::Fixed) {
      stage.motion =
          joint.type == robot::JointType::Revolute ? Stage::Motion::Turn : Stage::Motion::Slide;
      stage.axis = joint.axis;
      stage.variable = joint.variable;
      stage.multiplier = joint.multiplier;
      stage.offset = joint.offset;
    }
    chain.push_back(stage);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

geom::Mesh scaled(geom::Mesh mesh, const geom::Vec3& scale) {
  for (geom::Vec3& v : mesh.vertices) v = v.cwiseProduct(scale);
  if (scale.prod() < 0)  // a mirrored solid is still a solid
    for (geom::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A mesh of the robot as the file has it, or as prepared.
geom::Mesh read_link_mesh(const std::string& path, const VerifySweepOptions& o, Shapes& out) {
  io::ReadResult read = io::read_mesh(path);
  for (const std::string& note : read.notes) out.mesh_notes.add(path, note);
  if (!o.prepare) return std::move(read.mesh);
  geom::Prepared prepared =
      naming(path, [&] { return prepare_original(read.mesh, o.drop_sheets, true); });
  for (const std::string& note : prepared.notes) out.mesh_notes.add(path, note);
  if (prepared.dropped_sheets > 0) out.dropped[path] = prepared.dropped_sheets;
  return std::move(prepared.mesh);
}

/// What to try where the meshes as they are were not found within the set; empty if nothing.
std::string preparing_hint(const Shapes& shapes) {
  std::string changed;
  for (const std::string& path : shapes.files) {
    const geom::Mesh mesh = io::read_mesh(path).mesh;
    const auto prepared = [&](bool drop_sheets) -> std::optional<geom::Prepared> {
      try {
        return prepare_original(mesh, drop_sheets, true);
      } catch (const Error&) {
        return std::nullopt;
      }
    };
    if (const auto plain = prepared(false)) {
      if (changed.empty() && !plain->notes.empty()) changed = path;
    } else if (prepared(true)) {
      return path +
             ": sweep-approx takes it with --drop-sheets only, and as prepared; --prepare "
             "--drop-sheets judges that";
    }
  }
  if (changed.empty()) return {};
  return changed + ": sweep-approx speaks of the mesh as prepared; --prepare judges that";
}

Shapes read_shapes(const RobotFile& file, const VerifySweepOptions& o) {
  std::vector<std::string> wanted;
  std::istringstream list(o.links);
  for (std::string name; std::getline(list, name, ',');)
    if (!name.empty()) wanted.push_back(name);
  require_links(file, wanted);
  using From = robot::Geometry::Shape;
  using To = verify::MovingShape::Kind;
  static const std::map<From, To> kKinds{{From::Mesh, To::Mesh},
                                         {From::Box, To::Box},
                                         {From::Cylinder, To::Cylinder},
                                         {From::Sphere, To::Sphere}};
  Shapes out;
  out.bare = bare_links(file.robot, o.geometry == "visual", wanted);
  out.notes = notes_on_flat_shapes(file, o.geometry == "visual", wanted);
  for (const std::string& note :
       notes_on(out.bare, o.geometry == "visual", ": nothing of this is judged"))
    out.notes.push_back(o.files[0] + ": " + note);
  for (std::uint32_t l = 0; l < file.robot.links.size(); ++l) {
    const robot::Link& link = file.robot.links[l];
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), link.name) == wanted.end())
      continue;
    ++out.asked;
    std::size_t count = 0;
    const std::size_t before = out.shapes.size();
    for (const robot::Geometry& g : o.geometry == "visual" ? link.visual : link.collision) {
      verify::MovingShape shape;
      shape.name = link.name + "/" + std::to_string(count++);
      if (robot::is_point(g)) continue;
      shape.kind = kKinds.at(g.shape);
      shape.size = g.size;
      if (g.shape == From::Cylinder && g.size.x() == 0) {
        shape.kind = To::Box;  // a line, without a curved side
        shape.size = {0, 0, g.size.y()};
      }
      shape.chain = chain_to(file.robot, l);
      Stage place;
      place.rotation = g.origin.linear;
      place.translation = g.origin.translation;
      shape.chain.push_back(place);
      if (shape.kind == To::Mesh) {
        const std::string path = find_only_mesh(g.mesh, file.path, o.packages).string();
        shape.mesh = scaled(read_link_mesh(path, o, out), g.size);
        out.files.push_back(path);
      }
      out.shapes.push_back(std::move(shape));
      out.links.push_back(l);
    }
    if (out.shapes.size() > before) ++out.judged;
  }
  if (out.shapes.empty()) {
    std::string why = file.path.string();
    why += ": no link has a shape";
    if (o.geometry != "visual") why += "; try --geometry visual";
    throw Error(ErrorCode::InvalidInput, why);
  }
  return out;
}

/// Both kinematics of the project, written apart, must put everything in the same place.
void require_same_poses(const robot::Robot& robot, const Shapes& shapes, const robot::Path& path) {
  for (const auto& q : path) {
    const std::vector<robot::Transform> poses = robot::forward(robot, q);
    for (std::size_t i = 0; i < shapes.shapes.size(); ++i) {
      verify::LinkChain chain = shapes.shapes[i].chain;
      chain.pop_back();
      const auto pose = verify::pose_of(chain, q);
      const robot::Transform& other = poses[shapes.links[i]];
      const double size = 1 + other.translation.norm();
      const double allowed = 1e-9 * size + 64 * verify::bound_motion(chain, q, q, size).rounding;
      ensure((pose.leftCols<3>() - other.linear).norm() < allowed / size &&
                 (pose.col(3) - other.translation).norm() < allowed,
             "two ways to compute a link's pose disagree");
    }
  }
}

std::vector<double> configuration(const robot::Path& path, const verify::SweepPlace& p) {
  const auto &a = path[p.segment], &b = path[std::min(p.segment + 1, path.size() - 1)];
  std::vector<double> q(a.size());
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = a[i] + p.s * (b[i] - a[i]);
  return q;
}

Json to_json(const verify::SweepPlace& p, const Shapes& shapes, const robot::Path& path) {
  return {{"shape", shapes.shapes[p.shape].name},
          {"segment", p.segment + 1},
          {"s", p.s},
          {"configuration", configuration(path, p)},
          {"point", to_json(p.point)},
          {"distance", p.distance}};
}

Json to_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness)
    json["witness"] = {{"point", to_json(claim.witness->point)}, {"depth", claim.witness->depth}};
  return json;
}

std::string say(const verify::SweepPlace& p, const Shapes& shapes) {
  std::ostringstream text;
  text << std::setprecision(17) << shapes.shapes[p.shape].name << " at " << p.s << " of segment "
       << p.segment + 1 << ", " << point(p.point);
  return text.str();
}

/// The bodies of a URDF as sweep-approx writes it: the only link's collision shapes, meshes in the
/// link's frame and unit.
geom::ConvexSet read_swept_urdf(const std::string& path, const VerifySweepOptions& o,
                                io::SetReadDetails& details) {
  const RobotFile file = read_robot(path);
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::InvalidInput, path + ": " + why +
                                             "; a swept volume as sweep-approx writes it is the "
                                             "collision meshes of one link, neither moved nor "
                                             "scaled");
  };
  if (file.robot.links.size() != 1) refuse("it has several links");
  details.bytes = io::read_file(path);
  geom::ConvexSet set;
  for (const robot::Geometry& g : file.robot.links[0].collision) {
    if (g.shape != robot::Geometry::Shape::Mesh) refuse("it has a " + describe(g));
    if (!g.origin.linear.isIdentity(0) || !g.origin.translation.isZero(0) || !g.size.isOnes(0))
      refuse("a mesh is moved or scaled");
    const std::filesystem::path mesh = find_only_mesh(g.mesh, file.path, o.packages);
    std::vector<char> bytes;
    set.bodies.push_back({mesh.filename().string(), io::read_mesh(mesh, {}, &bytes).mesh});
    details.bytes.insert(details.bytes.end(), bytes.begin(), bytes.end());
  }
  if (set.bodies.empty()) refuse("it has no collision shape");
  return set;
}

geom::ConvexSet read_swept(const std::string& path, const VerifySweepOptions& o,
                           io::SetReadDetails& details) {
  if (o.set_format.empty() && std::filesystem::path(path).extension() == ".urdf")
    return read_swept_urdf(path, o, details);
  std::optional<io::Format> format;
  if (!is_folder(path)) format = format_for(path, o.set_format, "--approximation-format");
  return io::read_convex_set(path, format, &details);
}

void write_witness(const std::string& path, const verify::SweepPlace& place) {
  geom::Mesh mesh;
  mesh.vertices = place.triangle;
  mesh.triangles = {{0, 1, 2}};
  io::WriteOptions options;
  options.double_precision = true;
  options.comment = "a part of the robot that is outside the swept set";
  io::Format format = *io::format_from_name(std::filesystem::path(path).extension().string());
  if (format == io::Format::Stl) format = io::Format::StlAscii;  // holds doubles
  io::write_file(path, io::serialise_mesh(mesh, format, options));
}

}  // namespace

int verify_sweep(const VerifySweepOptions& o, const CommonOptions& common) {
  const std::string &robot_path = o.files[0], &path_path = o.files[1], &set_path = o.files[2];
  require_apart({{"--report", common.report}, {"--witness", o.witness}}, o.files);
  const ThreadLimit threads(common.threads);
  const RobotFile file = read_robot(robot_path);
  // Limits are no matter of the set.
  std::vector<std::string> notes;
  const robot::Path path =
      read_path(path_path, file.robot, {false, o.degrees, fixed_joints(o.joints)}, notes);
  const Shapes shapes = read_shapes(file, o);
  require_apart({{"--report", common.report}, {"--witness", o.witness}}, shapes.files);
  require_same_poses(file.robot, shapes, path);
  io::SetReadDetails details;
  const geom::ConvexSet set = read_swept(set_path, o, details);
  for (const auto& more : {shapes.notes, shapes.mesh_notes.lines()})
    notes.insert(notes.end(), more.begin(), more.end());
  for (const std::string& note : notes) log(common.quiet, note);
  for (std::string& note : details.notes)
    log(common.quiet, note.insert(0, ": ").insert(0, set_path));

  geom::Box3 box;
  for (const geom::ConvexBody& b : set.bodies) box.extend(geom::bounding_box(b.hull));
  Progress progress(common.quiet);
  verify::SweepOptions options;
  options.gap = o.gap.empty()
                    ? std::max({1e-6 * set.margin, box.empty() ? 0 : 1e-9 * box.diagonal(), 1e-12})
                    : parse_length(o.gap)->value;
  options.max_cells = o.max_cells;
  options.solids = o.claims != "surface";
  options.progress = [&](const std::string& what) { progress.show("deciding: " + what); };
  const verify::SweepClaims claims = verify::verify_sweep(shapes.shapes, path, set, options);

  Answer answer = worse(claims.convex.answer, claims.surface.answer);
  if (o.claims == "all" && claims.solid.answer != Answer::Undefined)
    answer = worse(answer, claims.solid.answer);

  const bool at_most = claims.convex.answer == Answer::Verified;
  if (!common.report.empty()) {
    Json json{{"tool", "bound-verify"},
              {"version", version()},
              {"relation", "sweep"},
              {"verdict", name_of(answer)},
              {"deciding_claims", o.claims},
              {"robot", {{"file", robot_path}, {"sha256", file.sha256}, {"meshes", shapes.files}}},
              {"path", {{"file", path_path}, {"waypoints", path.size()}}},
              {"swept",
               {{"file", set_path},
                {"sha256", io::sha256(details.bytes)},
                {"bodies", set.bodies.size()},
                {"margin", set.margin}}},
              {"gap", options.gap},
              {"claims",
               {{"convex", to_json(claims.convex)},
                {"surface", to_json(claims.surface)},
                {"solid", to_json(claims.solid)}}}};
    if (claims.refuting)
      json["claims"]["surface"]["place"] = to_json(*claims.refuting, shapes, path);
    if (claims.undecided)
      json["claims"]["surface"]["first_undecided"] = to_json(*claims.undecided, shapes, path);
    if (at_most && claims.farthest.distance >= 0)
      json["largest_found"] = to_json(claims.farthest, shapes, path);
    json["prepared"] = o.prepare;
    json["dropped_sheet_triangles"] = shapes.dropped;
    json["open_meshes"] = claims.open_meshes;
    json["shapes"] = shapes.shapes.size();
    json["links"] = {{"asked", shapes.asked},
                     {"judged", shapes.judged},
                     {"without_shapes", shapes.bare.all()},
                     {"with_other_shapes_only", shapes.bare.other}};
    json["cells"] = claims.cells;
    json["samples"] = claims.samples;
    json["resources"] = {{"user_seconds", user_seconds()}, {"peak_megabytes", peak_megabytes()}};
    write_json(common.report, json);
  }
  if (!o.witness.empty() && claims.refuting) write_witness(o.witness, *claims.refuting);

  if (!common.quiet) {
    std::ostream& out = common.report == "-" ? std::cerr : std::cout;
    const auto line = [&](const char* title, const verify::Claim& claim, const std::string& what) {
      out << title << ": " << name_of(claim.answer) << ": "
          << (claim.answer == Answer::Verified ? what : claim.reason) << '\n';
    };
    line("convexity", claims.convex,
         "all " + std::to_string(set.bodies.size()) + " bodies are convex");
    line("surface claim", claims.surface,
         "during the whole path " + std::to_string(shapes.shapes.size()) +
             " shapes of the links stay within " +
             (set.margin > 0 ? "the bodies, with the margin " + number(set.margin) + " included"
                             : std::string("the bodies")));
    if (claims.refuting) {
      out << "  " << say(*claims.refuting, shapes) << ": " << number(claims.refuting->distance)
          << " from the nearest body, margin " << number(set.margin) << '\n';
    } else if (claims.undecided) {
      out << "  " << say(*claims.undecided, shapes) << '\n';
    }
    if (!claims.refuting && at_most && claims.farthest.distance >= 0)
      out << "  farthest of " << claims.samples
          << " places sampled: " << number(claims.farthest.distance) << ", "
          << (claims.farthest.distance > 0 ? say(claims.farthest, shapes) : "none is outside")
          << '\n';
    if (o.claims != "surface" && claims.solid.answer != Answer::Undefined)
      line("solid claim", claims.solid, "so do the insides of the closed shapes");
    if (claims.open_meshes > 0)
      out << claims.open_meshes << " meshes are not closed: their surfaces alone are judged\n";
    out << name_of(answer) << ": " << links_judged(shapes.judged, shapes.asked, shapes.bare)
        << except_sheets(shapes.dropped) << '\n';
    if (answer != Answer::Verified && !o.prepare)
      if (const std::string hint = preparing_hint(shapes); !hint.empty())
        log(common.quiet, "note: " + hint);
  }
  return exit_code(answer);
}

}  // namespace kaboum::tools
