// The verdict on two meshes, in words and as a report.

#include "mesh_report.h"

#include <kaboum/geom/facets.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/region_excess.h>

#include <algorithm>
#include <cmath>

#include "common/shell_word.h"
#include "common/verdict.h"

namespace kaboum::tools {

using verify::Answer;
using verify::Relation;

namespace {

/// @param what     the claim, as a sentence
/// @param refuted  what is true instead
/// @param depth    how far what refutes it sticks out, if that was measured
std::string line(const std::string& title, const std::string& what, const std::string& refuted,
                 const verify::Claim& claim, const std::string& depth = {}) {
  std::string line = title + ": " + name_of(claim.answer) + ": ";
  line += claim.answer == Answer::Verified  ? what
          : claim.answer == Answer::Refuted ? refuted
                                            : claim.reason;
  if (claim.answer == Answer::Refuted && !depth.empty()) {
    line += "; " + depth;
  } else if (claim.witness) {
    line += "; at " + point(claim.witness->point) + ", " + number(claim.witness->depth) + " deep";
    if (!claim.witness->exact) line += " (the point is rounded)";
  }
  return line;
}

std::string line(const verify::DistanceVerdict& distance, double bound) {
  const verify::DistanceClaim& claim = distance.claim;
  std::string line = std::string(name_of(distance.between)) + ": " + name_of(claim.answer);
  if (claim.answer == Answer::Verified) line += ": nowhere more than " + number(bound);
  if (!claim.reason.empty()) line += ": " + claim.reason;
  if (claim.answer != Answer::Verified)
    line += "; " + in_words(distance.bracket) + ", farthest at " + point(distance.bracket.at) +
            ", claimed " + number(bound);
  return line;
}

/// @param stick  "it sticks out"
std::string extent(const char* stick, const verify::Bracket& b, const verify::Claim& claim) {
  const std::string size = in_words(b);
  const bool known = b.lower > 0 || !claim.witness;
  return stick + (size.empty() ? "" : " by " + size) + (known ? ", farthest at " : "; at ") +
         point(known ? b.at : claim.witness->point);
}

std::string solid_extent(const MeshCase& run) {
  const auto& depth = run.verdict.solid_depth;
  return depth ? extent("it sticks out", *depth, run.verdict.inclusion.solid) : std::string();
}

std::string surface_extent(const MeshCase& run) {
  const auto& depth = run.verdict.surface_depth;
  if (!depth) return {};
  std::string text = extent("they stick out", *depth, run.verdict.inclusion.surface);
  if (!(depth->lower > 0)) return text;
  const auto triangle = triangle_in_file(run, depth->triangle);
  return text +
         (triangle ? ", triangle " + std::to_string(*triangle) : ", where a hole was filled");
}

std::string inner_name(const MeshCase& run) {
  if (!run.inner()) return "the original";
  return run.approximation.is_set ? "the union of the bodies" : "the approximation";
}

std::string outer_name(const MeshCase& run) {
  if (run.inner()) return "the original";
  if (run.asked.relation != Relation::Cover) return "the approximation";
  const std::string radii = text_of_radii(run.approximation.set);
  return "the union of the bodies" + (radii.empty() ? "" : ", " + radii);
}

/// What the points of exact faces tell, which the claims before are not about.
std::string line_of_points(const verify::PointClaim& claim, const MeshCase& run) {
  const std::string all = std::to_string(claim.points) + " points of the " +
                          std::to_string(run.original.exact->faces) + " exact faces";
  std::string line = std::string("exact points: ") + name_of(claim.answer) + ": ";
  if (claim.answer == Answer::Undefined) return line + claim.reason;
  if (claim.answer == Answer::Verified)
    return line + "all " + all + " are within the solid of " + outer_name(run) +
           " (points can refute, and prove nothing)";
  return line + std::to_string(claim.outside) + " of " + all + " stick out of " + outer_name(run) +
         ", by up to " + number_up(claim.farthest) + ", near " + point(claim.at) + ", face " +
         std::to_string(claim.face + 1) + " (" + std::to_string(claim.faces) +
         (claim.faces == 1 ? " face" : " faces") + " in all)";
}

/// The options that say how files are read and judged, as the other command takes them as well.
std::string option_words(const VerifyMeshOptions& o) {
  std::string out;
  if (!o.original_format.name.empty())
    out += " --input-format " + shell_word(o.original_format.name);
  if (!o.original_format.importer.empty())
    out += " --importer " + shell_word(o.original_format.importer);
  if (!o.approximation_format.empty())
    out += " --approximation-format " + shell_word(o.approximation_format);
  if (!o.unit.unit.empty()) out += " --unit " + shell_word(o.unit.unit);
  out += o.unit.words();
  if (o.how.claims != verify::Claims::All)
    out += std::string(" --claims ") + verify::name_of(o.how.claims);
  if (o.how.epsilon) out += " --epsilon " + shell_word(o.how.epsilon->text());
  if (o.how.prepare) out += " --prepare";
  if (o.how.drop_sheets) out += " --drop-sheets";
  return out;
}

/// The command that a set is judged with, where its record says that it is of the other direction.
std::string other_command(const MeshCase& run) {
  const bool cover = run.asked.relation == Relation::Cover;
  const std::string& direction = run.approximation.set.provenance.direction;
  const std::string files = " " + shell_file(run.asked.original) + " " +
                            shell_file(run.asked.approximation) + option_words(run.asked);
  if (cover && direction == "inner")
    return "the set was made to lie inside: bound-verify mesh --inner" + files + " decides that";
  if (!cover && direction == "outer")
    return "the set was made to cover: bound-verify cover" + files + " decides that";
  return {};
}

/// What users most often got wrong when an enclosure is refuted.
std::vector<std::string> hints(const MeshCase& run) {
  std::vector<std::string> lines;
  if (std::string other = other_command(run); !other.empty()) return {std::move(other)};
  const geom::Mesh &original = run.original.mesh, &approximation = run.approximation.mesh;
  const geom::Box3 a = geom::bounding_box(original), b = geom::bounding_box(approximation);
  const double ratio = diagonal_of(approximation) / diagonal_of(original);
  if (ratio >= 20 || ratio <= 0.05)
    lines.push_back("the approximation's box is " + number(ratio) +
                    " times as large as the original's: are both in the same unit?");
  const geom::Box3 &enclosing = run.inner() ? a : b, &enclosed = run.inner() ? b : a;
  const bool swapped = (enclosing.min.array() > enclosed.min.array()).all() &&
                       (enclosing.max.array() < enclosed.max.array()).all();
  if (swapped && run.asked.relation == Relation::Cover)
    lines.emplace_back(
        "the box of the bodies lies within the original's: whether they lie inside of it is "
        "decided "
        "by bound-verify mesh --inner");
  else if (swapped)
    lines.emplace_back(
        "the enclosing box lies within the enclosed one: ORIGINAL comes first, "
        "APPROXIMATION second; --outer and --inner say which encloses");
  return lines;
}

}  // namespace

double diagonal_of(const geom::Mesh& mesh) {
  const geom::Box3 box = geom::bounding_box(mesh);
  const double length = box.diagonal();
  return box.empty() || (length > 1e-150 && length < 1e150) ? length
                                                            : (box.max - box.min).stableNorm();
}

std::optional<std::uint32_t> triangle_in_file(const MeshCase& run, std::uint32_t triangle) {
  const auto& subject = run.original.subject;
  if (run.inner() || !subject) return triangle;
  if (run.verdict.surface_of_all) {
    if (subject->refusal.empty()) return verify::source_of_held(*subject, triangle);
    const std::size_t others = 2 * run.original.quads.size();
    const std::size_t count = subject->triangles.triangles.size() - others;
    if (triangle < count) return triangle;
    return run.original.quads[(triangle - count) / 2];  // split the other way
  }
  if (!subject->refusal.empty()) return triangle;
  const std::vector<std::uint32_t>& source = subject->report.source;
  if (triangle >= source.size()) return std::nullopt;
  return source[triangle];
}

std::string why_no_points(const MeshCase& run) {
  if (run.original.about_exact.empty() || run.original.exact) return {};
  if (!run.inner()) return "only the triangles were asked about";
  return "an inner claim is about the triangles; the exact faces may lie up to " +
         number_up(run.original.deviation) + " inside " + inner_name(run);
}

std::vector<std::string> lines_of_enclosure(const MeshCase& run) {
  std::vector<std::string> lines;
  const verify::MeshVerdict& v = run.verdict;
  const std::string inner = inner_name(run), outer = outer_name(run);
  if (v.convex)
    lines.push_back(
        line("convexity",
             "all " + std::to_string(run.approximation.set.bodies.size()) + " bodies are convex",
             v.convex->reason, *v.convex));
  const bool relative = v.inclusion.relative;
  lines.push_back(line("solid claim",
                       relative ? "nowhere does " + inner + " wind more often than " + outer +
                                      " (both are open, with the same border)"
                                : "the solid of " + inner + " is within that of " + outer,
                       relative
                           ? inner + " winds more often than " + outer
                           : "a part of the solid of " + inner + " is outside that of " + outer,
                       v.inclusion.solid, solid_extent(run)));
  // Balls have no triangles.
  const bool no_triangles = run.inner() && verify::is_set_of_balls(run.approximation.set);
  lines.push_back(line(
      "surface claim",
      std::string(no_triangles ? "every point of " : "every triangle of ") + inner +
          " is within the solid of " + outer,
      no_triangles ? v.inclusion.surface.reason
                   : (v.inclusion.limited ? "at least " : "") +
                         std::to_string(v.inclusion.surface.inner_triangles.size()) +
                         " triangles of " + inner + " are not all within the solid of " + outer,
      v.inclusion.surface, surface_extent(run)));
  if (v.exact_points) lines.push_back(line_of_points(*v.exact_points, run));
  if (const std::string why = why_no_points(run); !why.empty())
    lines.push_back("exact points: not looked at: " + why);
  return lines;
}

std::vector<std::string> lines_of_distances(const MeshCase& run) {
  std::vector<std::string> lines;
  for (const verify::DistanceVerdict& distance : run.verdict.distances)
    lines.push_back(line(distance, *run.bound));
  for (const verify::RegionVerdict& one : run.verdict.regions) {
    std::string text =
        "distance in the region " + one.region.name + ": " + name_of(one.claim.answer) + ": ";
    text += one.claim.answer == Answer::Verified ? "nowhere more than " + number(one.region.epsilon)
                                                 : one.claim.reason;
    if (one.claim.answer == Answer::Refuted)
      text += "; at least " + number(one.claim.largest) + ", at " + point(one.claim.at) +
              ", claimed " + number(one.region.epsilon);
    if (!verify::may_reach(run.approximation.set, one.region.region))
      text += " (note: no body reaches it)";
    lines.push_back(std::move(text));
  }
  if (const auto& depth = run.verdict.depth)
    lines.push_back(line(
        "depth",
        "every point of the original more than " + number(*run.bound) + " inside it is in a body",
        depth->reason, *depth));
  return lines;
}

namespace {

/// What a verdict has to say where more may be meant than the triangles.
std::string about_triangles(const MeshCase& run) {
  const MeshInput& original = run.original;
  if (run.verdict.answer != Answer::Verified) return {};
  if (original.about_exact.empty()) return original.about_import;
  return std::string(", of the triangles, which stand for exact faces within ") +
         number_up(original.deviation) +
         (original.exact ? "; no point of these that was looked at sticks out"
                         : "; of these nothing is said");
}

}  // namespace

std::string last_line(const MeshCase& run) {
  const verify::Inclusion& in = run.verdict.inclusion;
  const bool open = !in.inner_closed || !in.outer_closed;
  const Answer answer = run.verdict.answer;
  return std::string(name_of(answer)) +
         (open && answer == Answer::Verified ? ", as far as an open mesh defines it" : "") +
         about_triangles(run) + except_sheets({{run.asked.original, run.original.dropped_sheets}});
}

std::vector<std::string> notes_on(const MeshCase& run) {
  std::vector<std::string> lines;
  const bool both_ways = run.original.subject && run.original.subject->both_ways;
  for (const auto& [mesh, name] : {std::pair{&run.original.mesh, "the original"},
                                   std::pair{&run.approximation.mesh, "the approximation"}})
    if (geom::signed_volume(*mesh) < 0 && !(both_ways && mesh == &run.original.mesh))
      lines.push_back(
          std::string(name) +
          " is inside out: its volume is negative, so that its solid is empty or nearly so");
  const verify::Inclusion& in = run.verdict.inclusion;
  if (in.left_out > 0)
    lines.push_back(std::to_string(in.left_out) +
                    " triangles were not decided: --max-work allows more");
  if (in.solid.answer == Answer::Refuted || in.surface.answer == Answer::Refuted)
    for (std::string& hint : hints(run)) lines.push_back(std::move(hint));
  return lines;
}

std::string why_undefined(const MeshCase& run) {
  const verify::Inclusion& in = run.verdict.inclusion;
  const std::string& inner = run.inner() ? run.asked.approximation : run.asked.original;
  const std::string& outer = run.inner() ? run.asked.original : run.asked.approximation;
  if (run.verdict.vacuous)
    return inner +
           " is inside out: its volume is negative, so that its solid is empty or nearly "
           "so, and that it is enclosed says nothing. Turn its triangles round" +
           (run.inner() ? "" : " (--prepare does)") + ", or ask for --claims all";
  const geom::Mesh& mesh = run.inner() ? run.approximation.mesh : run.original.mesh;
  if (mesh.triangles.empty())
    return inner + " has no bodies and no triangles: that nothing lies in something says nothing";
  const auto has_no_area = [&](const geom::Triangle& t) {
    return geom::is_degenerate(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  };
  if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), has_no_area))
    return inner +
           ": none of its triangles has an area, so that it has no solid. The surface claim is "
           "defined: --claims surface";
  if (in.inner_closed && in.outer_closed)
    return "a mesh without any triangle that has an area; no distance to it is defined";
  if (in.outer_closed)
    return inner + ": not a closed mesh (" + std::to_string(in.inner_open_edges) +
           " unbalanced edges); its solid is not defined. The surface claim is: "
           "--claims surface";
  return outer + ": not a closed mesh (" + std::to_string(in.outer_open_edges) +
         " unbalanced edges); nothing can lie inside it. Close its holes first";
}

using verify::Between;

namespace {

Json to_json(const geom::Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json to_json(const verify::Bracket& bracket) {
  return {{"lower", bracket.lower},
          {"upper", std::isfinite(bracket.upper) ? Json(bracket.upper) : Json()},
          {"at", to_json(bracket.at)},
          {"triangle", bracket.triangle}};
}

Json to_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness) {
    json["witness"] = {{"point", to_json(claim.witness->point)},
                       {"depth", claim.witness->depth},
                       {"exact", claim.witness->exact}};
    json["inner_triangles"] = claim.inner_triangles.size();
    json["outer_triangles"] = claim.outer_triangles.size();
  }
  return json;
}

Json to_json(const verify::DistanceClaim& claim) {
  return {{"answer", name_of(claim.answer)},
          {"reason", claim.reason},
          {"largest_found", claim.largest},
          {"at", to_json(claim.at)},
          {"pieces", claim.pieces}};
}

const char* key_of(Between between) {
  switch (between) {
    case Between::ApproximationToOriginal:
      return "approximation_to_original";
    case Between::OriginalToApproximation:
      return "original_to_approximation";
    case Between::UnionToSolid:
    case Between::FacetsToSurface:
      break;
  }
  return "distance";
}

Json json_of_claims(const MeshCase& run) {
  const verify::MeshVerdict& v = run.verdict;
  Json claims;
  if (v.convex) claims["convex"] = to_json(*v.convex);
  claims["solid"] = to_json(v.inclusion.solid);
  claims["solid"]["relative"] = v.inclusion.relative;
  claims["surface"] = to_json(v.inclusion.surface);
  if (v.solid_depth) claims["solid"]["depth"] = to_json(*v.solid_depth);
  if (v.surface_depth) {
    verify::Bracket depth = *v.surface_depth;
    depth.triangle = triangle_in_file(run, depth.triangle).value_or(depth.triangle);
    claims["surface"]["depth"] = to_json(depth);
  }
  for (const verify::DistanceVerdict& distance : v.distances) {
    Json& json = claims[key_of(distance.between)];
    json = to_json(distance.claim);
    json["bound"] = *run.bound;
    if (run.asked.relation != Relation::Cover) continue;
    json["margin"] = margin_json(run.approximation.set);
    json["to_solid"] = distance.between == Between::UnionToSolid;
  }
  for (const verify::RegionVerdict& one : v.regions) {
    Json json = to_json(one.claim);
    json["name"] = one.region.name;
    json["bound"] = one.region.epsilon;
    json["reached"] = verify::may_reach(run.approximation.set, one.region.region);
    claims["regions"].push_back(std::move(json));
  }
  if (v.exact_points) {
    const verify::PointClaim& points = *v.exact_points;
    Json& json = claims["exact_points"];
    json = {{"answer", name_of(points.answer)}, {"reason", points.reason},
            {"points", points.points},          {"outside", points.outside},
            {"faces_outside", points.faces},    {"rounding", points.rounding}};
    if (points.outside > 0) {
      json["farthest"] = points.farthest;
      json["at"] = to_json(points.at);
      json["face"] = points.face + 1;
    }
  }
  if (const std::string why = why_no_points(run); !why.empty())
    claims["exact_points"] = {{"answer", name_of(verify::Answer::Undefined)}, {"reason", why}};
  if (v.depth) {
    claims["depth"] = to_json(*v.depth);
    claims["depth"]["bound"] = *run.bound;
  }
  return claims;
}

Json file(const std::string& path, const MeshInput& input, bool closed, std::size_t open) {
  return {{"file", path},        {"sha256", input.sha256},
          {"unit", input.unit},  {"triangles", input.mesh.triangles.size()},
          {"closed", closed},    {"unbalanced_edges", open},
          {"notes", input.notes}};
}

/// What preparing did to the original, or would have to do.
void add_preparation(const MeshCase& run, Json& original) {
  if (run.asked.how.prepare) {
    original["filled_triangles"] = run.original.filled_triangles;
    original["dropped_sheet_triangles"] = run.original.dropped_sheets;
    if (!run.original.subject->refusal.empty())
      original["cannot_be_prepared"] = run.original.subject->refusal;
    return;
  }
  const auto& found = run.inside_out;
  original["inside_out_parts"] = found ? found->parts : 0;
  if (!found) return;
  if (!found->refusal.empty())
    original["cannot_be_prepared"] = found->refusal;
  else if (found->parts != 0)
    original["inside_out"] = {
        {"triangle", found->triangle}, {"at", to_json(found->at)}, {"remedy", "--prepare"}};
  if (found->hollow) original["hollow_at"] = to_json(*found->hollow);
}

/// The most vertices and facets that a body has; facets of polytopes only.
void add_sizes(const MeshCase& run, Json& json) {
  std::size_t vertices = 0, facets = 0;
  const bool convex = run.verdict.convex && run.verdict.convex->answer == Answer::Verified;
  for (const geom::ConvexBody& body : run.approximation.set.bodies) {
    vertices = std::max(vertices, body.core.vertices.size());
    if (convex && !body.core.triangles.empty())
      facets = std::max(facets, geom::float32_facet_count(body.core));
  }
  json["most_vertices"] = vertices;
  json["most_facets"] = facets > 0 ? Json(facets) : Json();
}

const char* name_of_relation(Relation relation) {
  switch (relation) {
    case Relation::Outer:
      return "outer";
    case Relation::Inner:
      return "inner";
    case Relation::Cover:
      break;
  }
  return "cover";
}

}  // namespace

Json report_of(const MeshCase& run) {
  const verify::Inclusion& in = run.verdict.inclusion;
  const bool swap = run.inner();
  Json json{
      {"relation", name_of_relation(run.asked.relation)},
      {"verdict", name_of(run.verdict.answer)},
      {"deciding_claims", name_of(run.asked.how.claims)},
      {"original", file(run.asked.original, run.original, swap ? in.outer_closed : in.inner_closed,
                        swap ? in.outer_open_edges : in.inner_open_edges)},
      {"approximation",
       file(run.asked.approximation, run.approximation, swap ? in.inner_closed : in.outer_closed,
            swap ? in.inner_open_edges : in.outer_open_edges)},
      {"bbox_diagonal", run.diagonal}};
  if (run.approximation.is_set) {
    json["approximation"]["bodies"] = run.approximation.set.bodies.size();
    json["approximation"]["margin"] = margin_json(run.approximation.set);
    add_sizes(run, json["approximation"]);
  }
  json["original"]["scale"] = run.asked.unit.scale;
  json["original"]["single_precision"] = run.original.single_precision;
  if (!run.original.about_import.empty()) json["original"]["importer"] = "assimp";
  if (!run.original.about_exact.empty()) json["original"]["deviation"] = run.original.deviation;
  if (const auto& exact = run.original.exact) {
    json["original"]["exact_faces"] = exact->faces;
    json["original"]["exact_edges"] = exact->edges;
  }
  add_preparation(run, json["original"]);
  json["claims"] = json_of_claims(run);
  json["triangles_without_area"] = in.triangles_without_area;
  json["limited"] = in.limited;
  json["triangles_left_out"] = in.left_out;
  json["contacts"] = in.contacts;
  json["samples"] = in.samples;
  return json;
}

}  // namespace kaboum::tools
