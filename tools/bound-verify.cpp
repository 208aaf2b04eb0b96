#include <kaboum/geom/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <numeric>
#include <sstream>

#include "cli.h"
#include "prepared_original.h"
#include "robot_path.h"
#include "verdict.h"
#include "verify_progressive.h"
#include "verify_robot.h"
#include "verify_sweep.h"

namespace {

using namespace kaboum;
using tools::Json;
using tools::number;
using tools::point;
using verify::Answer;

struct Options {
  bool outer = false, inner = false, cover = false, progressive = false, robot = false,
       prepare = false, drop_sheets = false, set = false;
  std::string original, approximation, original_format, approximation_format;
  std::string epsilon, witness, claims = "all";
  std::size_t max_contacts = verify::InclusionOptions{}.max_contacts;
  tools::VerifySweepOptions sweep;
  tools::CommonOptions common;
};

struct Input {
  geom::Mesh mesh;
  io::Format format;
  std::string sha256;
  std::vector<std::string> notes;
  std::size_t filled_triangles = 0, dropped_sheets = 0;
  std::vector<std::uint32_t> source;  // per triangle, if prepared: its index in the file
};

Input read(const std::string& path, const std::string& format, const char* option) {
  std::vector<char> bytes;
  io::ReadResult r = io::read_mesh(path, tools::format_for(path, format, option), &bytes);
  std::vector<std::string> notes = std::move(r.notes);
  if (r.collapsed_triangles != 0) {
    notes.push_back(std::to_string(r.collapsed_triangles) +
                    " triangles with repeated corners bound nothing and are left out");
  }
  return {std::move(r.mesh), r.format, io::sha256(bytes), std::move(notes), 0, 0, {}};
}

/// Of the box; its square may exceed all doubles, or vanish.
double diagonal_of(const geom::Mesh& mesh) {
  const geom::Box3 box = geom::bounding_box(mesh);
  const double length = box.diagonal();
  return box.empty() || (length > 1e-150 && length < 1e150) ? length
                                                            : (box.max - box.min).stableNorm();
}

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

/// A mesh, or the sum of a set's bodies.
Input read_approximation(const Options& o, geom::ConvexSet& set, bool& is_set) {
  const bool folder = tools::is_folder(o.approximation);
  std::optional<io::Format> format;
  if (!folder) {
    format = tools::format_for(o.approximation, o.approximation_format, "--approximation-format");
  }
  const bool may_have_record = o.approximation != "-" && format == io::Format::Glb;
  if (o.cover || o.set || folder || may_have_record) {
    io::SetReadDetails details;
    set = io::read_convex_set(o.approximation, format, &details);
    is_set = o.cover || o.set || folder || details.has_record;
    if (is_set && o.outer) {
      throw Error(ErrorCode::InvalidArgument,
                  o.approximation +
                      " is a set of convex bodies: ask with --cover whether it covers "
                      "the original");
    }
    if (is_set) {
      return {verify::sum_of(set),
              format.value_or(io::Format::Stl),
              io::sha256(details.bytes),
              std::move(details.notes),
              0,
              0,
              {}};
    }
    set = {};
  }
  return read(o.approximation, o.approximation_format, "--approximation-format");
}

/// What refutes the claims of enclosure sticks out this far.
struct Depths {
  std::optional<verify::Bracket> solid, surface;
  std::string solid_text, surface_text;
};

/// @param margin  of the set that encloses
Depths depths_of(const geom::Mesh& inner, const geom::Mesh& outer,
                 const verify::Inclusion& inclusion, double margin,
                 const std::vector<std::uint32_t>& source_of_inner) {
  Depths depths;
  const auto beyond_margin = [&](verify::Bracket b) {
    b.lower = std::max(0.0, b.lower - margin * (1 + 0x1p-50));
    b.upper -= margin * (1 - 0x1p-50);
    return b;
  };
  const auto text = [](const char* stick, const verify::Bracket& b, const verify::Claim& claim) {
    const std::string extent = tools::in_words(b);
    const bool known = b.lower > 0 || !claim.witness;
    return stick + (extent.empty() ? "" : " by " + extent) + (known ? ", farthest at " : "; at ") +
           point(known ? b.at : claim.witness->point);
  };
  if (inclusion.solid.answer == Answer::Refuted && !inclusion.relative && !inclusion.limited) {
    depths.solid = beyond_margin(verify::bracket_solid(inner, outer, inclusion.solid));
    depths.solid_text = text("it sticks out", *depths.solid, inclusion.solid);
  }
  if (inclusion.surface.answer == Answer::Refuted) {
    const auto& triangles = inclusion.surface.inner_triangles;
    verify::Bracket b = beyond_margin(verify::bracket_distance(inner, triangles, outer, true));
    depths.surface_text = text("they stick out", b, inclusion.surface);
    const bool in_file = source_of_inner.empty() || b.triangle < source_of_inner.size();
    if (!source_of_inner.empty() && in_file) b.triangle = source_of_inner[b.triangle];
    if (b.lower > 0)
      depths.surface_text +=
          in_file ? ", triangle " + std::to_string(b.triangle) : ", where a hole was filled";
    depths.surface = b;
  }
  return depths;
}

/// Everything that was asked for, in the order of printing.
class Verdict {
 public:
  /// @param what     the claim, as a sentence
  /// @param refuted  what is true instead
  /// @param depth    how far what refutes it sticks out, if that was measured
  void add(const std::string& title, const std::string& what, const std::string& refuted,
           const verify::Claim& claim, const std::string& depth = {}) {
    std::string line = title + ": " + name_of(claim.answer) + ": ";
    line += claim.answer == Answer::Verified  ? what
            : claim.answer == Answer::Refuted ? refuted
                                              : claim.reason;
    if (claim.answer == Answer::Refuted && !depth.empty()) {
      line += "; " + depth;
    } else if (claim.witness) {
      line += "; at " + point(claim.witness->point) + ", " + number(claim.witness->depth) + " deep";
      if (!claim.witness->exact) {
        line += " (the point is rounded)";
      }
    }
    lines_.push_back(line);
  }
  void count_enclosure(Answer answer) { enclosure_.push_back(answer); }
  void count_besides(Answer answer) { besides_.push_back(answer); }
  void add(const std::string& title, double bound, const verify::DistanceClaim& claim,
           const verify::Bracket& bracket) {
    std::string line = title + ": " + name_of(claim.answer);
    if (claim.answer == Answer::Verified) line += ": nowhere more than " + number(bound);
    if (!claim.reason.empty()) line += ": " + claim.reason;
    if (claim.answer != Answer::Verified) {
      line += "; " + tools::in_words(bracket) + ", farthest at " + point(bracket.at) +
              ", claimed " + number(bound);
    }
    lines_.push_back(line);
    besides_.push_back(claim.answer);
  }

  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }
  /// Of the claims of enclosure that decide; everything else can only worsen it.
  [[nodiscard]] Answer answer() const {
    const auto any = [](const std::vector<Answer>& answers, Answer a) {
      return std::find(answers.begin(), answers.end(), a) != answers.end();
    };
    for (const Answer a : {Answer::Refuted, Answer::Undecided}) {
      if (any(enclosure_, a) || any(besides_, a)) return a;
    }
    if (!any(enclosure_, Answer::Verified) || any(besides_, Answer::Undefined)) {
      return Answer::Undefined;
    }
    return Answer::Verified;
  }

 private:
  std::vector<std::string> lines_;
  std::vector<Answer> enclosure_, besides_;
};

/// A triangle that is too far away.
struct Far {
  const geom::Mesh* mesh;
  std::uint32_t triangle;
};

/// The offending triangles, of both meshes, as one mesh.
void write_witness(const std::string& path, const geom::Mesh& inner, const geom::Mesh& outer,
                   const std::vector<const verify::Claim*>& claims, const std::vector<Far>& far) {
  geom::Mesh mesh;
  const auto take = [&](const geom::Mesh& from, std::vector<std::uint32_t> triangles) {
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    for (const std::uint32_t t : triangles) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const std::uint32_t v : from.triangles[t]) mesh.vertices.push_back(from.vertices[v]);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  };
  std::vector<std::uint32_t> of_inner, of_outer;
  for (const verify::Claim* claim : claims) {
    of_inner.insert(of_inner.end(), claim->inner_triangles.begin(), claim->inner_triangles.end());
    of_outer.insert(of_outer.end(), claim->outer_triangles.begin(), claim->outer_triangles.end());
  }
  take(inner, std::move(of_inner));
  take(outer, std::move(of_outer));
  for (const Far& f : far) take(*f.mesh, {f.triangle});
  if (mesh.triangles.empty()) return;  // only the bodies' convexity was refuted
  io::WriteOptions options;
  options.double_precision = true;
  options.comment = "triangles that bound what refutes the claim";
  io::Format format = *io::format_from_name(std::filesystem::path(path).extension().string());
  if (format == io::Format::Stl) format = io::Format::StlAscii;  // holds doubles
  io::write_file(path, io::serialise_mesh(geom::Mesh(mesh), format, options));
}

/// The original as the tools prepare it, without holes.
void prepare(Input& original, bool drop_sheets) {
  geom::Prepared prepared = tools::prepare_original(original.mesh, drop_sheets, true);
  original.mesh = std::move(prepared.mesh);
  original.notes.insert(original.notes.end(), prepared.notes.begin(), prepared.notes.end());
  original.filled_triangles = prepared.filled_triangles;
  original.dropped_sheets = prepared.dropped_sheets;
  original.source = std::move(prepared.source);
}

/// What preparing would change of the original; empty if nothing.
std::string change_by_preparing(const Input& original) {
  for (const bool drop_sheets : {false, true}) {
    Input prepared{original.mesh, original.format, {}, {}, 0, 0, {}};
    try {
      prepare(prepared, drop_sheets);
    } catch (const Error&) {  // it cannot be prepared
      continue;
    }
    std::string text = drop_sheets ? "with --drop-sheets" : "";
    for (const std::string& note : prepared.notes) text += (text.empty() ? "" : "; ") + note;
    return text;
  }
  return {};
}

/// What users most often got wrong when an enclosure is refuted.
std::vector<std::string> hints(const geom::Mesh& original, const geom::Mesh& approximation,
                               bool inner) {
  std::vector<std::string> lines;
  const geom::Box3 a = geom::bounding_box(original), b = geom::bounding_box(approximation);
  const double ratio = diagonal_of(approximation) / diagonal_of(original);
  if (ratio >= 20 || ratio <= 0.05) {
    lines.push_back("the approximation's box is " + number(ratio) +
                    " times as large as the original's: are both in the same unit?");
  }
  const geom::Box3 &enclosing = inner ? a : b, &enclosed = inner ? b : a;
  const bool swapped = (enclosing.min.array() > enclosed.min.array()).all() &&
                       (enclosing.max.array() < enclosed.max.array()).all();
  if (swapped) {
    lines.push_back(
        "the enclosing box lies within the enclosed one: ORIGINAL comes first, "
        "APPROXIMATION second; --outer and --inner say which encloses");
  }
  return lines;
}

/// What an enclosure says little about.
std::vector<std::string> warnings(const geom::Mesh& original, const geom::Mesh& approximation) {
  std::vector<std::string> lines;
  for (const auto& [mesh, name] :
       {std::pair{&original, "the original"}, std::pair{&approximation, "the approximation"}}) {
    if (geom::signed_volume(*mesh) < 0) {
      lines.push_back(
          std::string(name) +
          " is inside out: its volume is negative, so that its solid is empty or nearly so");
    }
  }
  return lines;
}

/// Nothing that is read may be written, nothing written twice; the witness's format holds doubles.
void require_outputs(const Options& o, const std::vector<std::string>& inputs) {
  tools::require_apart({{"--report", o.common.report}, {"--witness", o.witness}}, inputs);
  if (o.witness.empty()) return;
  const auto format = io::format_from_name(std::filesystem::path(o.witness).extension().string());
  if (!format || !(io::holds_double(*format) || *format == io::Format::Stl))
    throw Error(ErrorCode::InvalidArgument, "--witness: write .ply, .obj, .off or .stl (as text)");
}

int check_sweep(Options o) {
  if (!o.original.empty())
    throw Error(ErrorCode::InvalidArgument, "--sweep takes ROBOT PATH SWEPT and no more files");
  if (o.claims == "solid")
    throw Error(ErrorCode::InvalidArgument,
                "--claims solid: with --sweep it follows from the surface claim; use all");
  require_outputs(o, o.sweep.files);
  o.sweep.claims = o.claims;
  o.sweep.prepare = o.prepare;
  o.sweep.drop_sheets = o.drop_sheets;
  o.sweep.witness = o.witness;
  o.sweep.set_format = o.approximation_format;
  return tools::verify_sweep(o.sweep, o.common);
}

int check_robot(const Options& o) {
  tools::VerifyRobotOptions robot;
  robot.original = o.original;
  robot.result = o.approximation;
  robot.claims = o.claims;
  robot.epsilon = o.epsilon;
  robot.geometry = o.sweep.geometry;
  robot.packages = o.sweep.packages;
  robot.prepare = o.prepare;
  robot.drop_sheets = o.drop_sheets;
  robot.max_contacts = o.max_contacts;
  return tools::verify_robot(robot, o.common);
}

int check(const Options& o) {
  if (o.approximation.empty())
    throw Error(ErrorCode::InvalidArgument, "ORIGINAL and APPROXIMATION are required");
  require_outputs(o, {o.original, o.approximation});
  const tools::ThreadLimit threads(o.common.threads);
  std::optional<tools::Length> epsilon;
  if (!o.epsilon.empty()) {
    epsilon = tools::parse_length(o.epsilon);
    if (!epsilon) {
      throw Error(ErrorCode::InvalidArgument,
                  "--epsilon: '" + o.epsilon + "' is neither a positive length nor a percentage");
    }
  }
  if (o.original == "-" && o.approximation == "-") {
    throw Error(ErrorCode::InvalidArgument, "only one of the two files can be standard input");
  }

  Input original = read(o.original, o.original_format, "--input-format");
  geom::ConvexSet set;
  bool is_set = false;
  Input approximation = read_approximation(o, set, is_set);
  if (o.prepare) tools::naming(o.original, [&] { prepare(original, o.drop_sheets); });
  if (o.inner && set.margin > 0) {
    throw Error(ErrorCode::InvalidInput, o.approximation + ": the set's margin, " +
                                             number(set.margin) +
                                             ", enlarges the bodies; an inner set must have none");
  }
  for (const Input* input : {&original, &approximation}) {
    for (const std::string& note : input->notes) {
      tools::log(o.common.quiet, (input == &original ? o.original : o.approximation) + ": " + note);
    }
  }

  std::optional<tools::InsideOut> inside_out;
  if (!o.prepare) inside_out = tools::find_inside_out(original.mesh);
  if (inside_out) tools::log(false, "warning: " + o.original + ": " + tools::text_of(*inside_out));

  const double diagonal = diagonal_of(original.mesh);
  if (epsilon && !std::isfinite(epsilon->of(diagonal)))
    throw Error(ErrorCode::InvalidInput,
                o.original + ": its diagonal exceeds all numbers; give --epsilon as a length");
  if (epsilon && !(epsilon->of(diagonal) > set.margin)) {
    throw Error(ErrorCode::InvalidArgument, "--epsilon: it must be larger than the set's margin, " +
                                                number(set.margin) + ", and than 0");
  }

  tools::Progress progress(o.common.quiet);
  verify::InclusionOptions options;
  options.max_contacts = o.max_contacts;
  options.progress = [&](const std::string& what) { progress.show("deciding: " + what); };

  Verdict verdict;
  // What is decided is said at once: a distance may take long.
  std::ostream& out = o.common.report == "-" ? std::cerr : std::cout;
  std::size_t said = 0;
  const auto say = [&] {
    if (o.common.quiet) return;
    progress.show("");
    for (; said < verdict.lines().size(); ++said) out << verdict.lines()[said] << '\n';
    out.flush();
  };
  Json claims;
  const bool wants_solid = o.claims != "surface", wants_surface = o.claims != "solid";
  const geom::Mesh& inner = o.inner ? approximation.mesh : original.mesh;
  const geom::Mesh& outer = o.inner ? original.mesh : approximation.mesh;
  verify::Inclusion inclusion;
  if (is_set) {
    const verify::Claim convex = verify::verify_convexity(set).convex;
    verdict.add("convexity", "all " + std::to_string(set.bodies.size()) + " bodies are convex",
                convex.reason, convex);
    verdict.count_besides(convex.answer);
    claims["convex"] = to_json(convex);
  }
  inclusion = o.cover ? verify::verify_cover(original.mesh, set, options).inclusion
                      : verify::verify_inclusion(inner, outer, options);
  const std::string inner_name = is_set && o.inner ? "the union of the bodies"
                                 : o.inner         ? "the approximation"
                                                   : "the original";
  const std::string outer_name =
      o.cover
          ? (set.margin > 0
                 ? "the union of the bodies, with the margin " + number(set.margin) + " included"
                 : "the union of the bodies")
      : o.inner ? "the original"
                : "the approximation";
  const bool relative = inclusion.relative;
  progress.show("measuring what sticks out");
  const Depths depths = depths_of(inner, outer, inclusion, o.cover ? set.margin : 0,
                                  o.inner ? std::vector<std::uint32_t>{} : original.source);
  verdict.add("solid claim",
              relative ? "nowhere does " + inner_name + " wind more often than " + outer_name +
                             " (both are open, with the same border)"
                       : "the solid of " + inner_name + " is within that of " + outer_name,
              relative
                  ? inner_name + " winds more often than " + outer_name
                  : "a part of the solid of " + inner_name + " is outside that of " + outer_name,
              inclusion.solid, depths.solid_text);
  if (wants_solid) verdict.count_enclosure(inclusion.solid.answer);
  verdict.add("surface claim",
              "every triangle with area of " + inner_name + " is within the solid of " + outer_name,
              std::to_string(inclusion.surface.inner_triangles.size()) + " triangles of " +
                  inner_name + " are not all within the solid of " + outer_name,
              inclusion.surface, depths.surface_text);
  if (wants_surface) verdict.count_enclosure(inclusion.surface.answer);
  claims["solid"] = to_json(inclusion.solid);
  claims["solid"]["relative"] = inclusion.relative;
  claims["surface"] = to_json(inclusion.surface);
  if (depths.solid) claims["solid"]["depth"] = to_json(*depths.solid);
  if (depths.surface) claims["surface"]["depth"] = to_json(*depths.surface);
  say();

  std::vector<Far> far;
  verify::Claim depth;  // its triangles are the original's and, as outer ones, the bodies'
  if (epsilon) {
    const double bound = epsilon->of(diagonal);
    const auto measure = [&](const char* title, const char* key, const geom::Mesh& from,
                             const geom::Mesh& to, bool to_solid) {
      progress.show(std::string("deciding: ") + title);
      verify::DistanceClaimOptions distance;
      distance.to_solid = to_solid;
      const verify::DistanceClaim claim = verify::verify_distance(from, to, bound, distance);
      verify::Bracket bracket{claim.largest, std::numeric_limits<double>::infinity(), claim.at,
                              claim.triangle};
      if (claim.answer != Answer::Verified) {
        std::vector<std::uint32_t> all(from.triangles.size());
        std::iota(all.begin(), all.end(), 0U);
        const verify::Bracket found = verify::bracket_distance(from, all, to, to_solid);
        bracket.upper = found.upper;
        if (found.lower > bracket.lower) bracket = found;
      }
      verdict.add(title, bound, claim, bracket);
      if (claim.answer == Answer::Refuted) far.push_back({&from, claim.triangle});
      claims[key] = to_json(claim);
      claims[key]["bound"] = bound;
    };
    if (o.cover) {
      progress.show("deciding: distance");
      const verify::DistanceClaim claim =
          verify::verify_reach(set, original.mesh, bound, inclusion.inner_closed);
      if (claim.answer == Answer::Refuted) far.push_back({&approximation.mesh, claim.triangle});
      verify::Bracket bracket{claim.largest, std::numeric_limits<double>::infinity(), claim.at,
                              claim.triangle};
      if (claim.answer != Answer::Verified) {  // inside the bodies it may be farther
        std::vector<std::uint32_t> all(approximation.mesh.triangles.size());
        std::iota(all.begin(), all.end(), 0U);
        const verify::Bracket found = verify::bracket_distance(
            approximation.mesh, all, original.mesh, inclusion.inner_closed);
        if (found.lower > bracket.lower) {
          bracket.lower = found.lower;
          bracket.at = found.at;
        }
      }
      verdict.add(inclusion.inner_closed ? "distance from the union to the solid"
                                         : "distance from the bodies' facets to the surface",
                  bound, claim, bracket);
      claims["distance"] = to_json(claim);
      claims["distance"]["bound"] = bound;
      claims["distance"]["margin"] = set.margin;
      claims["distance"]["to_solid"] = inclusion.inner_closed;
    } else if (is_set) {
      progress.show("deciding: depth");
      const verify::Claim claim = verify::verify_depth(original.mesh, set, bound, options);
      verdict.add(
          "depth",
          "every point of the original more than " + number(bound) + " inside it is in a body",
          claim.reason, claim);
      verdict.count_besides(claim.answer);
      claims["depth"] = to_json(claim);
      depth = claim;
      claims["depth"]["bound"] = bound;
    } else {
      measure("distance from approximation to original", "approximation_to_original",
              approximation.mesh, original.mesh, false);
      measure("distance from original to approximation", "original_to_approximation", original.mesh,
              approximation.mesh, false);
    }
  }

  // A solid that is empty is within any other.
  const bool vacuous = !wants_surface && geom::signed_volume(inner) < 0;
  const Answer answer =
      vacuous && verdict.answer() == Answer::Verified ? Answer::Undefined : verdict.answer();
  if (!o.witness.empty() && answer == Answer::Refuted) {
    for (const std::uint32_t t : depth.inner_triangles) far.push_back({&original.mesh, t});
    for (const std::uint32_t t : depth.outer_triangles) far.push_back({&approximation.mesh, t});
    write_witness(o.witness, inner, outer, {&inclusion.solid, &inclusion.surface}, far);
  }
  if (!o.common.report.empty()) {
    const auto file = [](const std::string& path, const Input& input, bool closed,
                         std::size_t open) {
      return Json{{"file", path},
                  {"sha256", input.sha256},
                  {"triangles", input.mesh.triangles.size()},
                  {"closed", closed},
                  {"unbalanced_edges", open},
                  {"notes", input.notes}};
    };
    const bool swap = o.inner;
    Json json{
        {"tool", "bound-verify"},
        {"version", tools::version()},
        {"relation", o.cover   ? "cover"
                     : o.inner ? "inner"
                               : "outer"},
        {"verdict", name_of(answer)},
        {"deciding_claims", o.claims},
        {"original",
         file(o.original, original, swap ? inclusion.outer_closed : inclusion.inner_closed,
              swap ? inclusion.outer_open_edges : inclusion.inner_open_edges)},
        {"approximation", file(o.approximation, approximation,
                               swap ? inclusion.inner_closed : inclusion.outer_closed,
                               swap ? inclusion.inner_open_edges : inclusion.outer_open_edges)},
        {"bbox_diagonal", diagonal}};
    if (is_set) {
      json["approximation"]["bodies"] = set.bodies.size();
      json["approximation"]["margin"] = set.margin;
    }
    if (o.prepare) {
      json["original"]["filled_triangles"] = original.filled_triangles;
      json["original"]["dropped_sheet_triangles"] = original.dropped_sheets;
    } else {
      json["original"]["inside_out_parts"] = inside_out ? inside_out->parts : 0;
      if (inside_out && !inside_out->refusal.empty())
        json["original"]["cannot_be_prepared"] = inside_out->refusal;
      else if (inside_out && inside_out->parts != 0)
        json["original"]["inside_out"] = {{"triangle", inside_out->triangle},
                                          {"at", to_json(inside_out->at)},
                                          {"remedy", "--prepare"}};
      if (inside_out && inside_out->hollow)
        json["original"]["hollow_at"] = to_json(*inside_out->hollow);
    }
    json["claims"] = claims;
    json["triangles_without_area"] = inclusion.triangles_without_area;
    json["contacts"] = inclusion.contacts;
    json["samples"] = inclusion.samples;
    json["resources"] = {{"user_seconds", tools::user_seconds()},
                         {"peak_megabytes", tools::peak_megabytes()}};
    tools::write_json(o.common.report, json);
  }
  say();
  if (answer != Answer::Verified && answer != Answer::Undecided && !o.prepare) {
    if (const std::string change = change_by_preparing(original); !change.empty())
      tools::log(o.common.quiet, "note: bmesh-decimate and bcd-decompose speak of " + o.original +
                                     " as prepared; --prepare judges that: " + change);
  }
  if (answer == Answer::Undefined && vacuous) {
    throw Error(ErrorCode::InvalidInput,
                (o.inner ? o.approximation : o.original) +
                    " is inside out: its volume is negative, so that its solid is empty or nearly "
                    "so, and that it is enclosed says nothing. Turn its triangles round" +
                    (o.inner ? "" : " (--prepare does)") + ", or ask for --claims all");
  }
  if (answer == Answer::Undefined && inclusion.inner_closed && inclusion.outer_closed) {
    throw Error(ErrorCode::InvalidInput,
                "a mesh without any triangle that has an area; no distance to it is defined");
  }
  if (answer == Answer::Undefined) {
    throw Error(ErrorCode::InvalidInput,
                inclusion.outer_closed
                    ? (o.inner ? o.approximation : o.original) + ": not a closed mesh (" +
                          std::to_string(inclusion.inner_open_edges) +
                          " unbalanced edges); its solid is not defined. The surface claim is: "
                          "--claims surface"
                    : (o.inner ? o.original : o.approximation) + ": not a closed mesh (" +
                          std::to_string(inclusion.outer_open_edges) +
                          " unbalanced edges); nothing can lie inside it. Close its holes first");
  }
  if (!o.common.quiet) {
    const bool open = !inclusion.inner_closed || !inclusion.outer_closed;
    out << name_of(answer)
        << (open && answer == Answer::Verified ? ", as far as an open mesh defines it" : "")
        << tools::except_sheets({{o.original, original.dropped_sheets}}) << '\n';
  }
  for (const std::string& warning : warnings(original.mesh, approximation.mesh)) {
    tools::log(o.common.quiet, "note: " + warning);
  }
  const bool not_enclosed =
      inclusion.solid.answer == Answer::Refuted || inclusion.surface.answer == Answer::Refuted;
  if (not_enclosed) {
    for (const std::string& hint : hints(original.mesh, approximation.mesh, o.inner)) {
      tools::log(o.common.quiet, "note: " + hint);
    }
  }
  return tools::exit_code(answer);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Decides from two files alone, in exact arithmetic, whether an approximation encloses the "
      "original (--outer), is enclosed by it (--inner) or, a set of convex bodies, covers it "
      "(--cover); whether the collision shapes of one robot hold those of another (--robot); or "
      "whether a set of convex bodies holds a robot during a motion (--sweep).\n"
      "With --progressive: replays a progressive file, every step checked exactly.\n"
      "\n"
      "Solid claim: points about which one mesh winds at least once are so in the other.\n"
      "Surface claim: every triangle of the enclosed mesh lies in the solid of the enclosing one.\n"
      "Both are answered; --claims says which decide the exit code.",
      "bound-verify");
  Options o;
  CLI::Option_group* relation = app.add_option_group("Relation", "One of");
  relation->add_flag("--outer", o.outer, "APPROXIMATION encloses ORIGINAL");
  relation->add_flag("--inner", o.inner, "APPROXIMATION is enclosed by ORIGINAL");
  relation->add_flag("--cover", o.cover,
                     "APPROXIMATION is a set of convex bodies that covers ORIGINAL");
  CLI::Option* sweep =
      relation
          ->add_option("--sweep", o.sweep.files,
                       "SWEPT, a set of convex bodies, holds the links of ROBOT (URDF, rlkin, "
                       "rlmdl) all along PATH (.csv, .json)")
          ->expected(3)
          ->type_name("ROBOT PATH SWEPT");
  relation->add_flag(
      "--progressive", o.progressive,
      "APPROXIMATION is a progressive file of bmesh-decimate: all its steps and levels");
  relation->add_flag("--robot", o.robot,
                     "ORIGINAL and APPROXIMATION are robots (URDF) that move alike, and the "
                     "collision shapes of each link of the second hold those of the first");
  relation->require_option(1);
  app.add_option("ORIGINAL", o.original, "The mesh that was approximated (- for standard input)")
      ->type_name("FILE");
  app.add_option("APPROXIMATION", o.approximation,
                 "The result: a mesh; with --cover or --set a set (.glb, .obj, a folder of .stl)")
      ->type_name("FILE");
  app.add_option("--claims", o.claims,
                 "Claims that decide: all, solid or surface; those that mean nothing for the files "
                 "do not count")
      ->check(CLI::IsMember({"all", "solid", "surface"}))
      ->capture_default_str()
      ->type_name("NAME");
  CLI::Option* epsilon =
      app.add_option(
             "--epsilon", o.epsilon,
             "Also decide that no distance exceeds this: a length, or a percentage of ORIGINAL's "
             "bounding-box diagonal (0.5%); between the surfaces, both ways; with --cover from "
             "the union to the solid (to the surface when ORIGINAL is open and --prepare is not "
             "given); of an inner set, that it leaves out no point deeper than this inside "
             "ORIGINAL")
          ->type_name("LENGTH");
  app.add_flag(
      "--prepare", o.prepare,
      "Judge against ORIGINAL as bmesh-decimate and bcd-decompose prepare it (parts that are "
      "inside "
      "out turned, copies and walls dropped, holes filled) instead of the file as it is: what "
      "their claims, and a container's epsilon, are about. With --sweep and --robot: the links' "
      "meshes");
  app.add_flag("--drop-sheets", o.drop_sheets,
               "With --prepare: drop sheets (faces back to back without volume), as bmesh-decimate "
               "and bcd-decompose do with this option; nothing is then said about them, and the "
               "verdict names them")
      ->needs("--prepare");
  CLI::Option* set = app.add_flag(
      "--set", o.set,
      "With --inner: APPROXIMATION is a set of convex bodies (known anyway of folders and "
      "of containers)");
  app.add_option("--witness", o.witness,
                 "When refuted, write the offending triangles to this mesh file")
      ->type_name("FILE");
  app.add_option("--input-format", o.original_format, "Format of ORIGINAL [by extension]")
      ->type_name("NAME");
  app.add_option("--approximation-format", o.approximation_format,
                 "Format of APPROXIMATION [by extension]")
      ->type_name("NAME");
  app.add_option("--max-contacts", o.max_contacts,
                 "Give up (exit code 7) beyond this many pairs of triangles that touch")
      ->check(CLI::Range(std::size_t{1}, std::size_t{4'000'000'000}))
      ->capture_default_str()
      ->type_name("N");
  for (CLI::Option* other : {epsilon, set}) other->excludes(sweep);
  const auto of_sweep = [&](CLI::Option* option) { option->needs(sweep)->group("With --sweep"); };
  of_sweep(app.add_option("--links", o.sweep.links, "Only these links, separated by commas [all]")
               ->type_name("A,B"));
  app.add_option("--geometry", o.sweep.geometry,
                 "Which shapes of ROBOT, or of ORIGINAL, are to be held [collision]")
      ->check(CLI::IsMember({"collision", "visual"}).description(""))
      ->type_name("collision|visual")
      ->group("With --sweep or --robot");
  app.add_flag_callback(
         "--visual", [&o] { o.sweep.geometry = "visual"; }, "The same as --geometry visual")
      ->group("With --sweep or --robot");
  app.add_option("--package-path", o.sweep.packages,
                 "A package of package:// or a folder that holds it, as for sweep-approx; may be "
                 "repeated")
      ->type_name("DIR")
      ->group("With --sweep or --robot");
  of_sweep(tools::add_joint_option(app, o.sweep.joints));
  of_sweep(tools::add_degrees_option(app, o.sweep.degrees));
  of_sweep(app.add_option("--gap", o.sweep.gap,
                          "Parts that move and measure less are not divided further; where they "
                          "are not known to be inside, the answer is undecided [margin / 10^6]")
               ->check([](const std::string& s) {
                 const auto length = tools::parse_length(s);
                 return length && !length->percent
                            ? std::string()
                            : "must be a positive length, a number above 0 without a unit, not " +
                                  s;
               })
               ->type_name("LENGTH"));
  of_sweep(app.add_option("--max-cells", o.sweep.max_cells,
                          "Give up beyond this many parts of a triangle per segment of the path")
               ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000'000}).description(""))
               ->capture_default_str()
               ->type_name("N"));
  tools::add_common_options(app, o.common);
  app.footer(
      "A result of bcd-decompose from a mesh: --cover INPUT RESULT --prepare --epsilon E (--inner "
      "for --direction inner; E the epsilon that was asked for or is recorded), and --drop-sheets "
      "where it was given. From a robot (URDF): --robot INPUT.urdf DIR/INPUT.urdf --prepare, with "
      "--geometry visual where --visual was given: all its links at once.\n\n"
      "--robot: a mesh is held by the meshes of the same pose and scale in the same link, so that "
      "no rounding of poses matters; boxes, cylinders and spheres must be there again. --epsilon: "
      "a length in the robot's unit, or a percentage of each mesh's diagonal.\n\n"
      "--sweep: every triangle of the links' meshes, every box, cylinder and sphere, at every "
      "configuration of PATH, lies in a body enlarged by the margin: during the whole motion, not "
      "only at samples (docs/algorithms/swept-volumes.md); so do the insides of closed meshes. It "
      "shares the parsers of ROBOT and PATH with sweep-approx, and with --prepare what prepares "
      "meshes; nothing else. Meshes that sweep-approx prepared (its notes say so) need --prepare, "
      "and --drop-sheets where it was given.\n\n"
      "Exit codes: 0 verified; 1 refuted; 2 usage; 3 bad input, or not closed where a claim needs "
      "it; 4 output failed; 6 internal error; 7 undecided within limits.");
  return tools::run(app, argc, argv, [&] {
    if (!o.sweep.files.empty()) return check_sweep(o);
    if (o.robot) {
      tools::require_absent(app, "--robot",
                            {"--set", "--witness", "--input-format", "--approximation-format"});
      return check_robot(o);
    }
    const char* relation_name = o.progressive ? "--progressive"
                                : o.cover     ? "--cover"
                                : o.inner     ? "--inner"
                                              : "--outer";
    tools::require_absent(app, relation_name, {"--geometry", "--visual", "--package-path"});
    if (!o.progressive) return check(o);
    tools::require_absent(app, "--progressive",
                          {"--claims", "--epsilon", "--prepare", "--drop-sheets", "--set",
                           "--witness", "--approximation-format", "--max-contacts"});
    return tools::verify_progressive(o.original, o.original_format, o.approximation, o.common);
  });
}
