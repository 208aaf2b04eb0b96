// Pages of convex bodies.

#include <kaboum/page/set_page.h>

#include <kaboum/base/notes.h>
#include <kaboum/base/number_text.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/page/gaps.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>

namespace kaboum::page {
namespace {

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string three_digits(double x) {
  std::ostringstream out;
  out.precision(3);
  out << x;
  return out.str();
}

std::string percent(double length, double diagonal) {
  std::ostringstream out;
  out.precision(3);
  out << length << " (" << (diagonal > 0 ? 100 * length / diagonal : 0) << " % of the diagonal)";
  return out.str();
}

/// The bodies, without distances.
std::vector<Shape> shapes_of(const geom::ConvexSet& set) {
  std::vector<Shape> out;
  for (const geom::ConvexBody& body : set.bodies) out.push_back({body.core});
  return out;
}

std::string verdict_of(const certify::SetCertificate& c) {
  std::string verdict =
      c.direction == certify::SetRequest::Direction::Inner
          ? "every body lies in the solid: decided exactly"
          : "the bodies cover the solid and every triangle that was to be covered: decided exactly";
  const std::string why = shortfall_of(c);
  return why.empty() ? verdict : verdict + ". But " + why;
}

}  // namespace

std::string shortfall_of(const certify::SetCertificate& c) {
  switch (c.stop) {
    case bcd::Stop::Done:
      return c.undecided.empty() ? std::string()
                                 : "every triangle is inside, but whether all that they bound is, "
                                   "is NOT decided: " +
                                       c.undecided;
    case bcd::Stop::OutOfWork:
      return "epsilon was not reached within the work allowed; allow more with «max-work», or a "
             "larger epsilon";
    case bcd::Stop::Stuck:
      if (c.thickened > 0)
        return std::string("epsilon could not be reached with ") +
               (c.max_aspect > 0 ? "«max-aspect»" : "«min-thickness»") +
               "; allow thinner bodies or a larger epsilon";
      if (c.direction == certify::SetRequest::Direction::Inner)
        return std::string(
                   "epsilon could not be reached: the search for deep points gave up; "
                   "allow a larger epsilon") +
               (c.largest_body_vertices == 1 ? "" : ", or «effort=best»");
      return c.max_facets > 0
                 ? "epsilon could not be reached; allow more facets with «max-facets-per-body»"
                 : "epsilon could not be reached; allow more vertices per body";
    case bcd::Stop::TooManyBodies:
    case bcd::Stop::TooCoarse:
      break;
  }
  return "within the limits of bodies and vertices nothing nearer was found; allow more, or a "
         "larger epsilon";
}

std::string summary_of(const certify::SetCertificate& c) {
  const bool outer = c.direction == certify::SetRequest::Direction::Outer;
  if (!outer && c.bodies == 0)
    return "0 bodies: no point of the solid is deeper than " +
           percent(c.distance_upper, c.diagonal);
  std::string bodies =
      (c.bodies == 1 ? " body, " : " bodies, ") + std::to_string(c.vertices) + " vertices";
  if (c.largest_body_vertices == 1) bodies = c.bodies == 1 ? " sphere" : " spheres";
  if (c.largest_body_vertices == 2) bodies = c.bodies == 1 ? " capsule" : " capsules";
  return std::to_string(c.bodies) + bodies +
         (outer ? "; cover verified exactly" : "; inside verified exactly") +
         (outer && c.subject.dropped_sheets > 0 ? " without the sheets dropped" : "") +
         (outer ? "; no point farther from the solid than " : "; no point left out deeper than ") +
         percent(c.distance_upper, c.diagonal);
}

std::string page_of_set(const SetOrigin& origin, const certify::SetCertificate& c,
                        const geom::ConvexSet& set, const Spelling& spelled) {
  const bool outer = c.direction == certify::SetRequest::Direction::Outer;
  // The triangles that distances are to: of the solid as prepared; of the file where a wrap is what
  // was covered.
  const geom::Mesh original =
      c.wrap ? origin.mesh : geom::prepare(origin.mesh, origin.preparation).solid.mesh();
  const double extent = geom::bounding_box(original).diagonal();
  Preview preview{"Bodies of " + file_name(origin.file), set.provenance.unit};
  Layer input{"input", outer ? Layer::View::Shown : Layer::View::Transparent, false};
  Layer result{"bodies", outer ? Layer::View::Transparent : Layer::View::Shown};
  result.bodies = result.all_edges = true;
  if (outer) {
    const geom::DistanceQuery triangles(original);
    const std::vector<DistanceOf> distances(set.bodies.size(), distance_to(triangles));
    preview.meaning = c.wrap ? "distance of the bodies from the input's triangles"
                             : "distance of the bodies from the solid";
    input.shapes.push_back({original});
    result.shapes = measured(set.bodies, extent, distances);
  } else {
    result.shapes = shapes_of(set);
    preview.meaning = "distance of the input's surface from the bodies";
    if (set.bodies.empty()) {
      input.shapes.push_back({original});
    } else {
      const geom::DistanceQuery bodies(verify::sum_of(set));
      input.shapes.push_back(measured(original, extent, distance_to(bodies)));
    }
  }
  preview.facts = {{"input", file_name(origin.file) + ", " +
                                 counted(original.triangles.size(), "triangle", "triangles") +
                                 (c.wrap ? ", wrapped" : " as prepared")},
                   {"options", set.provenance.parameters},
                   {"result", summary_of(c)},
                   {"verdict", spelled(verdict_of(c))}};
  for (const std::string& note : c.notes) preview.facts.emplace_back("note", note);
  preview.layers = {std::move(input), std::move(result)};
  return preview_page(preview);
}

std::string page_of_robot(const RobotWords& words, const robot::RobotFile& robot,
                          const certify::CertifiedRobot& made,
                          const std::vector<certify::LinkVerdict>& verdicts) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  Preview preview{"Bodies of " + file_name(words.file), words.unit};
  preview.meaning = "distance of the bodies from the shapes of their link";
  Layer input{"shapes", Layer::View::Shown, false};
  Layer result{"bodies", Layer::View::Transparent};
  result.bodies = result.all_edges = true;
  std::vector<std::string> points;  // links that have nothing else
  std::map<std::uint32_t, const certify::CertifiedLink*> sets;
  double reach = 0;
  robot::MeshFiles files(robot.path, bodies.choice.packages);
  for (const certify::CertifiedLink& made_link : made.links) {
    const std::uint32_t index = made_link.certificate().link;
    sets[index] = &made_link;
    const geom::Mesh exact =
        robot::exact_shapes(bodies.choice.shapes_of(robot.robot.links[index]), files);
    if (exact.triangles.empty()) {
      points.push_back(robot.robot.links[index].name);
      continue;
    }
    const geom::DistanceQuery triangles(exact);
    const auto& hulls = made_link.artefact().bodies;
    const std::vector<DistanceOf> distances(hulls.size(), distance_to(triangles));
    for (Shape& shape : measured(hulls, geom::bounding_box(exact).diagonal(), distances)) {
      shape.link = index;
      result.shapes.push_back(std::move(shape));
    }
    input.shapes.push_back({exact, {}, index});
    reach = std::max(reach, made_link.certificate().distance);
  }
  preview.table.head = {"link", "bodies", "vertices", "within", "verdict"};
  std::size_t count = 0;
  for (const certify::LinkVerdict& link : verdicts) {
    if (link.outcome != certify::Outcome::Held)
      preview.table.bad.push_back(preview.table.rows.size());
    std::vector<std::string>& row = preview.table.rows.emplace_back();
    row = {robot.robot.links[link.link].name, "-", "-", "-", link.sentence};
    const auto set = sets.find(link.link);
    if (set == sets.end()) continue;
    std::size_t vertices = 0;
    for (const geom::ConvexBody& body : set->second->artefact().bodies)
      vertices += body.core.vertices.size();
    count += set->second->artefact().bodies.size();
    row[1] = std::to_string(set->second->artefact().bodies.size());
    row[2] = std::to_string(vertices);
    row[3] = number_up(set->second->certificate().distance);
  }
  preview.facts = {{"robot", file_name(words.file)},
                   {"options", words.parameters},
                   {"result", counted(count, "body", "bodies") + " of " +
                                  counted(made.links.size(), "link", "links")},
                   {"verdict", in_words(verdicts) + ": decided exactly"}};
  Notes shortfalls;
  for (const certify::CertifiedLinkMesh& mesh : bodies.meshes) {
    if (!mesh.held) continue;
    const std::string why = words.spelled(shortfall_of(mesh.made.found.set.certificate()));
    if (!why.empty()) shortfalls.add(mesh.mesh.file.filename().string(), why);
  }
  for (const std::string& text : shortfalls.lines())
    preview.facts.emplace_back("not reached", text);
  preview.steps = words.steps;
  preview.facts.emplace_back("reach", "no point of a body is farther from its link's shapes than " +
                                          three_digits(reach) + ", certified");
  for (const std::string& link : points)
    preview.facts.emplace_back(link, "its shapes are points, which no body covers");
  preview.layers = {std::move(input), std::move(result)};
  preview.motion.emplace(
      Motion{robot.robot, {std::vector<double>(robot.robot.variables.size(), 0.0)}, true});
  return preview_page(preview);
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

}  // namespace kaboum::page
