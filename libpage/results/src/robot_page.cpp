// A page about a robot: one row for each link, with pictures of original and result.

#include <kaboum/page/robot_page.h>

#include <kaboum/base/error.h>
#include <kaboum/base/xml_text.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/picture/render.h>
#include <kaboum/robot/mesh_files.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace kaboum::page {
namespace {

using robot::Geometry;

constexpr int kWidth = 260, kHeight = 200;

constexpr const char* kPageHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<style>
body { font: 14px/1.45 system-ui, sans-serif; margin: 1.5em auto; max-width: 76em; padding: 0 1em; color: #222; }
table { border-collapse: collapse; width: 100%; }
th, td { padding: .4em .7em; border-bottom: 1px solid #ddd; text-align: left; vertical-align: middle; }
th { white-space: nowrap; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
td.yes { color: #1a7f37; } td.no { color: #cf222e; }
tfoot td { font-weight: 600; }
img { width: 195px; height: 150px; display: block; }
small { color: #666; } code { background: #f3f3f3; padding: .1em .3em; }
</style>
)";

std::string base64(const std::vector<char>& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8U | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

std::string number(double x) {
  std::ostringstream text;
  text.precision(4);
  text << x;
  return text.str();
}

/// Of a bound: four digits, not below it.
std::string length_up(double x) {
  if (!(x > 0) || !std::isfinite(x)) return number(x);
  constexpr int kDigits = 4;
  const double step = std::pow(10, std::floor(std::log10(x)) - (kDigits - 1));
  std::string text = number(x);
  for (double up = std::ceil(x / step); std::strtod(text.c_str(), nullptr) < x; ++up)
    text = number(up * step);
  return text;
}

/// Both seen from the same place.
std::string drawn(const geom::Mesh& mesh, const geom::Box3& box, const picture::Colour& colour,
                  const std::string& what) {
  if (mesh.triangles.empty() || box.empty()) return "<small>nothing to draw</small>";
  picture::Image image(kWidth, kHeight, {1, 1, 1});
  picture::Style style;
  style.surface = colour;
  draw_mesh(image, 0, 0, kWidth, kHeight, mesh, picture::Camera(box, {}, kWidth, kHeight), style);
  return "<img alt=\"" + escape_xml(what) + "\" src=\"data:image/png;base64," +
         base64(picture::encode_png(image)) + "\">";
}

void cell(std::string& page, const std::string& content, const char* kind = "") {
  page.append("<td");
  if (*kind != '\0') page.append(" class=\"").append(kind).append("\"");
  page.append(">").append(content).append("</td>");
}

std::string lines_of(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += "<br><small>" + escape_xml(text) + "</small>";
  return out;
}

void add_row(std::string& page, const PageLink& link) {
  geom::Box3 box;
  for (const geom::Mesh* mesh : {&link.original, &link.result})
    for (const geom::Vec3& v : mesh->vertices) box.extend(v);
  page += "<tr>";
  cell(page, "<b>" + escape_xml(link.name) + "</b>" + lines_of(link.meshes));
  cell(page, drawn(link.original, box, {0.66F, 0.68F, 0.71F}, "original"));
  cell(page, drawn(link.result, box, {0.45F, 0.62F, 0.86F}, "result"));
  cell(page, std::to_string(link.bodies), "n");
  cell(page, std::to_string(link.vertices), "n");
  cell(page, escape_xml(link.epsilon), "n");
  cell(page, length_up(link.reach), "n");
  cell(page, link.seconds ? number(*link.seconds) : "cached", "n");
  cell(page, escape_xml(link.verdict.sentence),
       link.verdict.outcome == certify::Outcome::Held ? "yes" : "no");
  page += "</tr>\n";
}

}  // namespace

std::string RobotCounts::of_meshes() const {
  std::string text = std::to_string(meshes) + (meshes == 1 ? " mesh" : " meshes");
  if (kept > 0)
    text += ", of which " + std::to_string(kept) + (kept == 1 ? " stays" : " stay") + " as " +
            (kept == 1 ? "it was" : "they were");
  if (missing > 0)
    text += (kept > 0 ? " and " : ", of which ") + std::to_string(missing) +
            (missing == 1 ? " is" : " are") + " missing";
  return text;
}

std::string epsilon_of(const std::string& link, const certify::LinkEpsilons& own,
                       const std::optional<Length>& of_all) {
  const auto found = own.find(link);
  const std::optional<Length> epsilon = found == own.end() ? of_all : std::optional(found->second);
  return epsilon ? epsilon->text() : std::string();
}

std::string to_html(const RobotPage& p) {
  std::string page = kPageHead;
  const std::string name = escape_xml(p.robot);
  page += "<title>" + name + "</title></head><body><h1>" + name + "</h1>\n<p>" +
          escape_xml(p.source) + ", by " + escape_xml(p.tool) +
          ". The last column says of each link whether every triangle of it is inside its new "
          "shapes; lengths are in " +
          escape_xml(p.unit) + ".";
  if (!p.command.empty())
    page += std::string(" From the files alone") +
            (p.passes ? "" : ", which finds the same and ends with an exit code above 0") +
            ": <code>" + escape_xml(p.command) + "</code>";
  page += "</p>\n";
  page +=
      "<table><thead><tr><th>link</th><th>original</th><th>result</th><th "
      "class=\"n\">" +
      escape_xml(p.made) +
      "</th><th class=\"n\">vertices</th><th class=\"n\">epsilon</th><th "
      "class=\"n\">within</th><th class=\"n\">time [s]</th><th>verdict</th></tr></thead><tbody>\n";
  double reach = 0, seconds = 0;
  std::vector<certify::LinkVerdict> verdicts;
  for (const PageLink& link : p.links) {
    add_row(page, link);
    reach = std::max(reach, link.reach);
    seconds += link.seconds.value_or(0);
    verdicts.push_back(link.verdict);
  }
  page += "</tbody><tfoot><tr>";
  cell(page, std::to_string(p.counts.links) + (p.counts.links == 1 ? " link" : " links") + ", " +
                 p.counts.of_meshes());
  cell(page, "");
  cell(page, "");
  cell(page, std::to_string(p.counts.bodies), "n");
  cell(page, std::to_string(p.counts.vertices), "n");
  cell(page, "");
  cell(page, length_up(reach), "n");
  cell(page, number(seconds), "n");
  cell(page, escape_xml(in_words(verdicts)),
       outcome_of(verdicts) == certify::Outcome::Held ? "yes" : "no");
  page += "</tr></tfoot></table>\n";
  for (const Step& step : p.steps)
    page += "<p>" + escape_xml(step.name) +
            (step.words.empty() ? "" : ": " + escape_xml(step.words)) + "<br><code>" +
            escape_xml(step.command) + "</code></p>\n";
  if (!p.files.empty()) page += "<p>Files:" + lines_of(p.files) + "</p>\n";
  if (!p.notes.empty()) page += "<p>Notes:" + lines_of(p.notes) + "</p>\n";
  return page + "</body></html>\n";
}

void append_placed(geom::Mesh& to, const geom::Mesh& mesh, const Geometry& place) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (const geom::Vec3& v : mesh.vertices)
    to.vertices.emplace_back(place.origin * v.cwiseProduct(place.size));
  for (geom::Triangle t : mesh.triangles) {
    if (place.size.prod() < 0) std::swap(t[1], t[2]);
    to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

geom::Mesh drawn_shapes(const std::vector<Geometry>& shapes, robot::MeshFiles& files) {
  geom::Mesh out;
  for (const Geometry& g : shapes) {
    if (g.shape == Geometry::Shape::Mesh) {
      try {
        append_placed(out, io::read_mesh(files.first(g.mesh)).mesh, g);
      } catch (
          const Error&) {  // NOLINT(bugprone-empty-catch): one that cannot be read is not drawn
      }
    } else if (!robot::is_point(g)) {
      if (const auto hull = geom::convex_hull(robot::bounding_points(g)))
        append_placed(out, *hull, {});
    }
  }
  return out;
}

RobotCounts counts_of(const certify::CertifiedRobot& made) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  RobotCounts counts{.links = verdicts(made).size(), .meshes = bodies.meshes.size()};
  for (const certify::CertifiedLinkMesh& mesh : bodies.meshes)
    if (!mesh.held) ++(mesh.mesh.missing.empty() ? counts.kept : counts.missing);
  for (const certify::CertifiedLink& link : made.links) {
    counts.bodies += link.artefact().bodies.size();
    for (const geom::ConvexBody& body : link.artefact().bodies)
      counts.vertices += body.core.vertices.size();
  }
  return counts;
}

std::vector<PageLink> page_links(const robot::RobotFile& robot, const certify::CertifiedRobot& made,
                                 const certify::RobotRequest& request,
                                 const std::vector<double>& seconds) {
  const certify::BodiesCertificate& bodies = made.bodies.certificate();
  std::vector<PageLink> links;
  robot::MeshFiles files(robot.path, bodies.choice.packages);
  for (const certify::LinkVerdict& link : verdicts(made)) {
    PageLink& out = links.emplace_back();
    out.name = robot.robot.links[link.link].name;
    out.shapes = link.shapes;
    out.verdict = link;
    for (const certify::CertifiedLink& set : made.links) {
      if (set.certificate().link != link.link) continue;
      out.reach = set.certificate().distance;
      out.bodies = set.artefact().bodies.size();
      for (const geom::ConvexBody& body : set.artefact().bodies) {
        out.vertices += body.core.vertices.size();
        append_placed(out.result, body.core, {});
      }
    }
    for (const robot::LinkShape& shape : bodies.shapes) {
      if (shape.link != link.link || !shape.mesh) continue;
      const certify::CertifiedLinkMesh& mesh = bodies.meshes[*shape.mesh];
      out.meshes.push_back(mesh.mesh.file.filename().string());
      if (mesh.held && !mesh.made.found.cached && *shape.mesh < seconds.size())
        out.seconds = out.seconds.value_or(0) + seconds[*shape.mesh];
    }
    out.epsilon = epsilon_of(out.name, request.epsilons, request.set.wanted_epsilon());
    out.original = drawn_shapes(bodies.choice.shapes_of(robot.robot.links[link.link]), files);
  }
  return links;
}

RobotCounts counts_of(const certify::LinkEnclosures& made) {
  RobotCounts counts{.links = made.shapes_by_link().size(), .meshes = made.meshes.size()};
  for (const certify::EnclosedLinkMesh& mesh : made.meshes) {
    if (!mesh.flaw.empty()) {
      ++(mesh.mesh.missing.empty() ? counts.kept : counts.missing);
      continue;
    }
    ++counts.bodies;
    counts.vertices += mesh.made.enclosure.certificate().vertices;
  }
  return counts;
}

std::vector<PageLink> page_links(const robot::RobotFile& robot, const certify::LinkEnclosures& made,
                                 const certify::LinkEnclosuresRequest& request) {
  const std::vector<certify::LinkVerdict> links = verdicts(made);
  std::vector<PageLink> out;
  robot::MeshFiles files(robot.path, request.shapes.packages);
  for (const std::vector<robot::LinkShape>& shapes : made.shapes_by_link()) {
    const std::uint32_t at = shapes.front().link;
    const robot::Link& link = robot.robot.links[at];
    PageLink& row = out.emplace_back();
    row.name = link.name;
    row.shapes = shapes.size();
    row.verdict = links[out.size() - 1];
    for (const robot::LinkShape& shape : shapes) {
      if (!shape.mesh) continue;
      const certify::EnclosedLinkMesh& mesh = made.meshes[*shape.mesh];
      row.meshes.push_back(mesh.mesh.file.filename().string());
      if (!mesh.flaw.empty()) continue;
      const certify::EnclosureCertificate& c = mesh.made.enclosure.certificate();
      const Geometry& place = request.shapes.shapes_of(link)[shape.index];
      ++row.bodies;
      row.vertices += c.vertices;
      row.reach = std::max(row.reach, c.distance_upper * place.size.cwiseAbs().maxCoeff());
      if (!mesh.made.cached) row.seconds = row.seconds.value_or(0) + mesh.seconds;
      append_placed(row.result, mesh.made.enclosure.artefact(), place);
    }
    row.epsilon = epsilon_of(link.name, request.epsilons, request.mesh.mesh.epsilon);
    row.original = drawn_shapes(request.shapes.shapes_of(link), files);
  }
  return out;
}

}  // namespace kaboum::page
