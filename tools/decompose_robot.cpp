// bcd-decompose on robots: reads, certifies, writes a folder, and says what came of it.

#include "decompose_robot.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>

#include "decompose_words.h"
#include "robot_bodies.h"
#include "robot_folder.h"
#include "robot_urdf.h"
#include "set_picture.h"
#include "urdf_output.h"

namespace kaboum::tools {
namespace {

void require_folder(const DecomposeOptions& o) {
  if (o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument,
                "--direction inner: decompose the robot's meshes one by one");
  if (!o.output_format.empty() || o.output == "-")
    throw Error(ErrorCode::InvalidArgument, "-o: a robot's bodies need a folder");
  const std::filesystem::path folder(o.output);
  const bool names_file = is_robot(o.output) || io::format_from_name(folder.extension().string());
  if (names_file && !is_folder(folder))
    throw Error(ErrorCode::InvalidArgument,
                "-o: a robot's bodies need a folder, which gets a URDF, the bodies and a container "
                "per link; name one without the extension of a file, such as " +
                    std::filesystem::path(folder).replace_extension().string() + ", not " +
                    o.output);
}

certify::RobotRequest robot_request(const DecomposeOptions& o) {
  certify::RobotRequest r{request_of(o), {o.links, o.geometry == "visual", o.packages}, {}, {}};
  if (!o.input_format.empty()) r.format = io::format_from_name(o.input_format);
  return r;
}

/// What was made, and where it goes.
struct Run {
  const DecomposeOptions& o;
  robot::RobotFile robot;
  certify::RobotRequest request;
  certify::CertifiedRobot made;
  Notes notes;
  int code = kDone;
};

void certify_links(Run& run) {
  Progress progress(run.o.common.quiet);
  certify::RobotHooks hooks =
      hooks_of(run.notes, [&](const std::string& stage) { progress.show(stage); });
  hooks.made = [&](const certify::CertifiedLinkMesh& mesh) {
    progress.show("");
    const std::string file = mesh.mesh.file.string();
    const certify::SetCertificate& certificate = mesh.made.found.set.certificate();
    log(run.o.common.quiet,
        file + ": " + summary(certificate) + (mesh.made.found.cached ? " (from the cache)" : ""));
    const std::string why = shortfall(certificate);
    if (why.empty()) return;
    log(run.o.common.quiet, file + ": " + why);
    run.code = std::max(run.code, code_of(certificate));
  };
  const certify::SetCache cache(certify::SetCache::default_folder());
  run.made =
      certify::certify_robot(run.robot, run.request, run.o.no_cache ? nullptr : &cache, hooks);
}

/// The URDF with the bodies that are written.
std::string urdf_of(const Run& run, const RobotFolder& folder, RobotUrdf& urdf) {
  const certify::BodiesCertificate& bodies = run.made.bodies.certificate();
  const std::string prefix = with_slash(run.o.prefix);
  std::vector<std::vector<ShapeInUrdf>> of_link(run.robot.robot.links.size());
  std::vector<std::size_t> count(of_link.size());
  for (std::size_t s = 0; s < bodies.shapes.size(); ++s) {
    const robot::LinkShape& shape = bodies.shapes[s];
    const robot::Link& link = run.robot.robot.links[shape.link];
    ShapeInUrdf& out = of_link[shape.link].emplace_back();
    out.first = count[shape.link];
    if (!shape.mesh) {
      if (!robot::is_point(bodies.choice.shapes_of(link)[shape.index])) ++count[shape.link];
      continue;
    }
    const std::string& name = folder.bodies_of(s);
    out.meshes.emplace();
    for (std::size_t b = 0; b < bodies.meshes[*shape.mesh].made.found.set.artefact().bodies.size();
         ++b)
      out.meshes->push_back(std::string(prefix).append("bodies/").append(name).append("/").append(
                                io::default_name(b, name)) +
                            ".stl");
    count[shape.link] += out.meshes->size();
  }
  for (std::size_t l = 0; l < of_link.size(); ++l) {
    const std::string& name = run.robot.robot.links[l].name;
    if (of_link[l].empty())
      urdf.keep(name);
    else
      urdf.replace(name, run.request.shapes.visual, of_link[l]);
  }
  return urdf.text();
}

Json links_report(const Run& run, const std::vector<std::string>& files) {
  Json out = Json::array();
  for (std::size_t i = 0; i < run.made.links.size(); ++i) {
    const certify::CertifiedLink& link = run.made.links[i];
    Json report = {{"link", run.robot.robot.links[link.certificate().link].name},
                   {"shapes", link.certificate().shapes}};
    for (const robot::LinkShape& shape : run.made.bodies.certificate().shapes) {
      if (shape.link != link.certificate().link || !shape.mesh) continue;
      const certify::CertifiedLinkMesh& mesh = run.made.bodies.certificate().meshes[*shape.mesh];
      report["meshes"].push_back(
          {{"file", mesh.mesh.file.string()}, {"result", report_of(mesh.made)}});
    }
    report["file"] = files[i];
    report["bodies"] = link.artefact().bodies.size();
    report["reach_upper"] = link.certificate().distance;
    out.push_back(std::move(report));
  }
  return out;
}

/// All links at zero joint values, for pictures: not certified.
geom::ConvexSet at_rest(const Run& run) {
  const auto poses =
      robot::forward(run.robot.robot, std::vector<double>(run.robot.robot.variables.size(), 0.0));
  geom::ConvexSet out;
  for (const certify::CertifiedLink& link : run.made.links)
    for (geom::ConvexBody body : link.artefact().bodies) {
      for (geom::Vec3& v : body.hull.vertices) v = poses[link.certificate().link] * v;
      out.bodies.push_back(std::move(body));
    }
  return out;
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

/// What a user should know of the result.
void say(const Run& run, const RobotFolder& folder, const robot::BareLinks& bare,
         const std::vector<std::string>& stale) {
  const bool quiet = run.o.common.quiet;
  const std::size_t bodies = run.made.bodies.artefact().size();
  const std::string urdf = folder.urdf().string();
  log(quiet, urdf + ": " + counted(bodies, "body", "bodies") + " of " +
                 counted(run.made.links.size(), "link", "links") + ", from " +
                 counted(run.made.bodies.certificate().meshes.size(), "mesh", "meshes"));
  log(quiet, how_meshes_are_found(urdf, "bodies", with_slash(run.o.prefix)));
  for (const std::string& text : run.notes.lines()) log(quiet, text);
  const bool visual = run.request.shapes.visual;
  for (const std::string& text :
       robot::notes_on_flat_shapes(run.robot, visual, run.request.shapes.links))
    log(quiet, text);
  if (!stale.empty())
    log(quiet, std::filesystem::path(run.o.output).string() + ": " + robot::names_of(stale) +
                   (stale.size() == 1 ? " is" : " are") +
                   " not of this result (perhaps of an earlier one), and left there");
  for (const std::string& text :
       robot::notes_on({{}, bare.other}, visual,
                       visual ? ", which stay as they are"
                              : ": nothing of this is covered (--visual covers those)"))
    log(quiet, run.o.input + ": " + text);
}

Json robot_report(const Run& run, const RobotFolder& folder, const robot::BareLinks& bare,
                  const std::vector<std::string>& stale, const std::vector<std::string>& files) {
  std::size_t bodies = 0, vertices = 0;
  for (const certify::CertifiedLink& link : run.made.links) {
    bodies += link.artefact().bodies.size();
    for (const geom::ConvexBody& body : link.artefact().bodies)
      vertices += body.hull.vertices.size();
  }
  return {{"urdf", folder.urdf().string()},
          {"stale", stale},
          {"bodies", bodies},
          {"vertices", vertices},
          {"meshes", run.made.bodies.certificate().meshes.size()},
          {"links", links_report(run, files)},
          {"stop", run.code == kDone ? "done" : "epsilon not reached"},
          {"links_without_shapes", bare.all()},
          {"input", {{"file", run.o.input}}},
          {"parameters", run.request.parameters()}};
}

}  // namespace

int decompose_robot(const DecomposeOptions& o) {
  require_folder(o);
  Run run{o, robot::read_robot(o.input), robot_request(o), {}, {}};
  const robot::ShapeChoice& choice = run.request.shapes;
  RobotFolder folder(o.output, run.robot);
  RobotUrdf urdf(run.robot, o.output);
  const robot::LinkMeshes meshes = robot::link_meshes(run.robot, choice);
  for (const robot::Link& link : run.robot.robot.links)
    if (choice.has(link))
      urdf.require_shapes(link.name, choice.visual, choice.shapes_of(link).size());
  folder.name_bodies(meshes, choice, urdf.mesh_stems());
  require_formats(meshes, o.input_format);
  certify_links(run);
  const robot::BareLinks bare = robot::bare_links(run.robot.robot, choice.visual, choice.links);
  const std::vector<std::string> files = folder.write(run.made, urdf_of(run, folder, urdf));
  const std::vector<std::string> stale = folder.stale();
  say(run, folder, bare, stale);
  if (!o.preview.empty()) io::write_file(o.preview, picture_of(at_rest(run), o.explode));
  if (!o.common.report.empty())
    write_report(o.common, "bcd-decompose", robot_report(run, folder, bare, stale, files));
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    for (std::string& file : strings(run.made.bodies.certificate().files))
      inputs.push_back(std::move(file));
    write_depfile(o.depfile, {folder.urdf().string()}, inputs);
  }
  return run.code;
}

}  // namespace kaboum::tools
