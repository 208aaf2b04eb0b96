// What bcd-decompose shows on pages.

#include "preview.h"

#include <kaboum/io/file_unit.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

#include "player/gaps.h"
#include "robots/output.h"
#include "words.h"

namespace kaboum::tools {
namespace {

using page::Layer;

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string three_digits(double x) {
  std::ostringstream out;
  out.precision(3);
  out << x;
  return out.str();
}

/// The triangles that distances are to: of the solid as prepared; of the file where a wrap is what
/// was covered.
geom::Mesh original_of(const DecomposeOptions& o, bool wrapped) {
  const certify::SetRequest request = certify::request_of(o.set);
  io::ReadResult read =
      io::read_mesh(o.input, format_for(o.input, o.input_format, "--input-format"));
  io::scale(read, request.scale, o.input);
  if (wrapped) return std::move(read.mesh);
  return naming(o.input,
                [&] { return geom::prepare(read.mesh, request.preparation).solid.mesh(); });
}

/// The bodies, without distances.
std::vector<page::Shape> shapes_of(const geom::ConvexSet& set) {
  std::vector<page::Shape> out;
  for (const geom::ConvexBody& body : set.bodies) out.push_back({body.core});
  return out;
}

std::string verdict_of(const certify::SetCertificate& c) {
  std::string verdict =
      c.direction == certify::SetRequest::Direction::Inner
          ? "every body lies in the solid: decided exactly"
          : "the bodies cover the solid and every triangle that was to be covered: decided exactly";
  const std::string why = shortfall(c);
  return why.empty() ? verdict : verdict + ". But " + why;
}

}  // namespace

std::string page_of_set(const DecomposeOptions& o, const certify::SetCertificate& c,
                        const geom::ConvexSet& set) {
  const bool outer = c.direction == certify::SetRequest::Direction::Outer;
  const geom::Mesh original = original_of(o, c.wrap.has_value());
  const double extent = geom::bounding_box(original).diagonal();
  page::Preview preview{"Bodies of " + file_name(o.input), set.provenance.unit};
  Layer input{"input", outer ? Layer::View::Shown : Layer::View::Transparent, false};
  Layer result{"bodies", outer ? Layer::View::Transparent : Layer::View::Shown};
  result.bodies = result.all_edges = true;
  if (outer) {
    const geom::DistanceQuery triangles(original);
    const std::vector<page::DistanceOf> distances(set.bodies.size(), page::distance_to(triangles));
    preview.meaning = c.wrap ? "distance of the bodies from the input's triangles"
                             : "distance of the bodies from the solid";
    input.shapes.push_back({original});
    result.shapes = page::measured(set.bodies, extent, distances);
  } else {
    result.shapes = shapes_of(set);
    preview.meaning = "distance of the input's surface from the bodies";
    if (set.bodies.empty()) {
      input.shapes.push_back({original});
    } else {
      const geom::DistanceQuery bodies(verify::sum_of(set));
      input.shapes.push_back(page::measured(original, extent, page::distance_to(bodies)));
    }
  }
  preview.facts = {{"input", file_name(o.input) + ", " +
                                 counted(original.triangles.size(), "triangle", "triangles") +
                                 (c.wrap ? ", wrapped" : " as prepared")},
                   {"options", set.provenance.parameters},
                   {"result", summary(c)},
                   {"verdict", verdict_of(c)}};
  for (const std::string& note : c.notes) preview.facts.emplace_back("note", note);
  preview.layers = {std::move(input), std::move(result)};
  return page::preview_page(preview);
}

std::string page_of_robot(const DecomposeOptions& o, const robot::RobotFile& robot,
                          const certify::CertifiedRobot& made,
                          const std::vector<certify::LinkVerdict>& verdicts) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  page::Preview preview{"Bodies of " + file_name(o.input), o.set.request.unit};
  preview.meaning = "distance of the bodies from the shapes of their link";
  Layer input{"shapes", Layer::View::Shown, false};
  Layer result{"bodies", Layer::View::Transparent};
  result.bodies = result.all_edges = true;
  std::size_t count = 0;
  std::vector<std::string> points;  // links that have nothing else
  double reach = 0;
  for (const certify::CertifiedLink& made_link : made.links) {
    const std::uint32_t index = made_link.certificate().link;
    const geom::Mesh exact = robot::exact_shapes(bodies.choice.shapes_of(robot.robot.links[index]),
                                                 robot, bodies.choice.packages);
    if (exact.triangles.empty()) {
      points.push_back(robot.robot.links[index].name);
      continue;
    }
    const geom::DistanceQuery triangles(exact);
    const auto& hulls = made_link.artefact().bodies;
    const std::vector<page::DistanceOf> distances(hulls.size(), page::distance_to(triangles));
    for (page::Shape& shape :
         page::measured(hulls, geom::bounding_box(exact).diagonal(), distances)) {
      shape.link = index;
      result.shapes.push_back(std::move(shape));
    }
    input.shapes.push_back({exact, {}, index});
    count += hulls.size();
    reach = std::max(reach, made_link.certificate().distance);
  }
  preview.facts = {{"robot", file_name(o.input) + ", at zero joint values"},
                   {"options", certify::request_of(o.set).parameters()},
                   {"result", counted(count, "body", "bodies") + " of " +
                                  counted(made.links.size(), "link", "links")},
                   {"verdict", in_words(verdicts) + ": decided exactly"}};
  for (const certify::LinkVerdict& link : verdicts)
    if (link.outcome != certify::Outcome::Held)
      preview.facts.emplace_back("link " + robot.robot.links[link.link].name, link.sentence);
  for (const certify::CertifiedLinkMesh& mesh : bodies.meshes) {
    if (!mesh.held) continue;
    const certify::SetCertificate& c = mesh.made.found.set.certificate();
    const std::string why = shortfall(c);
    preview.facts.emplace_back(mesh.mesh.file.filename().string(),
                               summary(c) + (why.empty() ? "" : ". " + why));
  }
  preview.facts.emplace_back("reach", "no point of a body is farther from its link's shapes than " +
                                          three_digits(reach) + ", certified");
  for (const std::string& link : points)
    preview.facts.emplace_back(link, "its shapes are points, which no body covers");
  preview.layers = {std::move(input), std::move(result)};
  preview.motion.emplace(
      page::Motion{robot.robot, {std::vector<double>(robot.robot.variables.size(), 0.0)}});
  return page::preview_page(preview);
}

geom::ConvexSet at_rest(const robot::Robot& robot,
                        const std::vector<certify::CertifiedLink>& links) {
  const auto poses = robot::forward(robot, std::vector<double>(robot.variables.size(), 0.0));
  geom::ConvexSet out;
  for (const certify::CertifiedLink& link : links)
    for (geom::ConvexBody body : link.artefact().bodies) {
      for (geom::Vec3& v : body.core.vertices) v = poses[link.certificate().link] * v;
      out.bodies.push_back(std::move(body));
    }
  return out;
}

}  // namespace kaboum::tools
