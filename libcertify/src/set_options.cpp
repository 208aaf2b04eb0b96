// The options of a set: their table, the request that they come to, and its record.

#include <kaboum/base/length_unit.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/base/sha256.h>
#include <kaboum/certify/set_options.h>

#include <array>
#include <sstream>
#include <utility>

#include "request.h"

namespace kaboum::certify {
namespace {

using R = SetOptions;
using Mode = PreparationOptions::Mode;

template <class Value, std::size_t N>
using Names = std::array<std::pair<const char*, Value>, N>;

using Direction = SetRequest::Direction;
constexpr Names<Direction, 2> kDirections{
    {{"outer", Direction::Outer}, {"inner", Direction::Inner}}};
using BodyKind = SetRequest::BodyKind;
constexpr Names<BodyKind, 5> kBodyKinds{{{"polytopes", BodyKind::Polytopes},
                                         {"spheres", BodyKind::Spheres},
                                         {"capsules", BodyKind::Capsules},
                                         {"boxes", BodyKind::Boxes},
                                         {"mixed", BodyKind::Mixed}}};
constexpr Names<bcd::Effort, 3> kEfforts{
    {{"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}}};
constexpr Names<bcd::PreStep, 3> kPreSteps{
    {{"auto", bcd::PreStep::Auto}, {"on", bcd::PreStep::On}, {"off", bcd::PreStep::Off}}};

void add_limits(std::vector<Option<R>>& out) {
  out.push_back(option<R>(
      {.name = "epsilon",
       .text = "Fewest bodies with no point farther than this from the solid: a length in the "
               "mesh's unit (of robots m) or its own, as in 5mm, or a percentage of the bounding "
               "box's diagonal, as in 0.5%",
       .otherwise = "1%, of robots 1cm for all links, unless {max-bodies} or "
                    "{max-total-vertices} is given"},
      [](auto& r) -> auto& { return r.request.epsilon; }));
  out.push_back(option<R>(
      {.name = "max-bodies",
       .text = "Look for the smallest distance with at most this many bodies (of a robot, for each "
               "of its meshes)",
       .low = 1,
       .high = 100000},
      [](auto& r) -> auto& { return r.request.max_bodies; }));
  out.push_back(option<R>(
      {.name = "max-total-vertices",
       .text = "Smallest distance with at most this many vertices of all bodies together (of a "
               "robot, for each of its meshes), and at most {max-bodies} where that is given; "
               "searches longer",
       .low = 8,
       .high = 10000000},
      [](auto& r) -> auto& { return r.request.max_total_vertices; }));
  out.push_back(choice<R>(
      {.name = "bodies",
       .text = "What the bodies are, whose union holds the solid and every triangle, or with "
               "{direction} inner lies in it: polytopes; "
               "spheres, as planners with spheres take them (a robot's are written as cuRobo YAML, "
               "XRDF or SRDF); capsules; boxes; mixed: of spheres, capsules and boxes whichever "
               "takes least to be queried. All but polytopes are written as shapes of a robot's "
               "URDF, MJCF or SDF, too"},
      [](auto& r) -> auto& { return r.request.body_kind; }, kBodyKinds));
  out.push_back(choice<R>(
      {.name = "direction",
       .text = "outer: bodies that cover the solid; inner: polytopes or spheres inside it, which "
               "leave out no point deeper than epsilon (not of robots)"},
      [](auto& r) -> auto& { return r.request.direction; }, kDirections));
  out.push_back(option<R>(
      {.name = "min-thickness",
       .text = "Thicken bodies that are less wide than this in some direction, for engines that "
               "shrink hulls; counts towards epsilon (a length or a percentage, as epsilon; of a "
               "robot, for its meshes)",
       .otherwise = "none"},
      [](auto& r) -> auto& { return r.request.thickness; }));
  out.push_back(option<R>(
      {.name = "max-aspect",
       .text =
           "Thicken bodies that are longer than so many times their least width; counts towards "
           "epsilon (of a robot, for its meshes)",
       .low = 4,
       .high = 1e6,
       .otherwise = "none"},
      [](auto& r) -> auto& { return r.request.max_aspect; }));
  out.push_back(option<R>(
      {.name = "max-vertices-per-body",
       .text = "Most vertices of a body; physics engines take 64 or 255",
       .low = 8,
       .high = 100000,
       .always_recorded = true},
      [](auto& r) -> auto& { return r.request.max_vertices; }));
  out.push_back(option<R>(
      {.name = "max-facets-per-body",
       .text = "Most facets of a body, for planners that take half-spaces: planes are chosen so "
               "that bodies have small volumes. Corners are float32, so facets are flat within "
               "eight spacings of that. {max-vertices-per-body} holds as well: a body of F facets "
               "has up to 2 F - 4 vertices",
       .low = 6,
       .high = 256,
       .otherwise = "no limit"},
      [](auto& r) -> auto& { return r.request.max_facets; }));
}

void add_search(std::vector<Option<R>>& out) {
  out.push_back(choice<R>(
      {.name = "effort", .text = "How long to search", .always_recorded = true},
      [](auto& r) -> auto& { return r.request.effort; }, kEfforts));
  out.push_back(option<R>(
      {.name = "simplify",
       .text = "Share of epsilon that leaving out vertices may take: with 0.25, bodies have up to "
               "half as many vertices more and collide falsely less often; not with "
               "{max-total-vertices}",
       .values = "SHARE",
       .low = 0,
       .high = 1,
       .otherwise = "0.5"},
      [](auto& r) -> auto& { return r.request.simplify; }));
  out.push_back(option<R>(
      {.name = "max-work",
       .text = "End the search after so much work, counted in steps that take about so many "
               "seconds of one core, so that the result is the same on any machine; what was found "
               "is then checked and written",
       .values = "SECONDS",
       .low = 0.001,
       .high = 1e9,
       .otherwise = "20, and 1 per 1000 triangles beyond 10000; no limit with {effort} best"},
      [](auto& r) -> auto& { return r.request.max_work; }));
  out.push_back(option<R>(
      {.name = "improve-work",
       .text = "Within epsilon, look for fewer bodies until the search has done so much work, "
               "counted in the same way; of a robot: the searches of all its meshes together",
       .values = "SECONDS",
       .low = 0,
       .high = 1e9,
       .otherwise = "30 of a robot, else no other limit; none with {effort} best"},
      [](auto& r) -> auto& { return r.request.improve_work; }));
  out.push_back(choice<R>(
      {.name = "pre-step",
       .text = "Simplify the input first to a mesh round it, within a tenth of epsilon (0.1% where "
               "none is given); distances remain those to the input; auto: above 20000 triangles, "
               "if a quarter of the vertices suffices"},
      [](auto& r) -> auto& { return r.request.pre_step; }, kPreSteps));
}

std::vector<Option<R>> table() {
  std::vector<Option<R>> out;
  add_limits(out);
  add_search(out);
  out.push_back(option<R>(
      {.name = "scale",
       .text = "Multiply the input's coordinates by this first, as for files of another unit that "
               "do not say so: 0.001 from mm to m, 25.4 from in to mm; each becomes the double "
               "nearest to the product",
       .values = "FACTOR",
       .low = 1e-9,
       .high = 1e9},
      [](auto& r) -> auto& { return r.request.scale; }));
  for (Option<R>& o : options_of_part<R>(
           preparation_options(PreparedFor::Bodies),
           [](auto& r) -> auto& { return r.preparation; }))
    out.push_back(std::move(o));
  std::vector<std::pair<std::string, std::string>> units;
  units.reserve(kLengthUnits.size());
  for (const std::string_view unit : kLengthUnits) units.emplace_back(unit, unit);
  out.push_back(choice<R>(
      {.name = "unit",
       .text = "Unit of length, noted in the container: m, dm, cm, mm, um, km, "
               "in or ft; one that the input states comes first",
       .values = "NAME",
       .unrecorded = true},
      [](auto& r) -> auto& { return r.request.unit; }, units));
  out.push_back(option<R>(
      {.name = "frame", .text = "Coordinate frame, noted in the container", .unrecorded = true},
      [](auto& r) -> auto& { return r.request.frame; }));
  return out;
}

template <class Value, std::size_t N>
const char* name_in(const Names<Value, N>& names, Value value) {
  for (const auto& [name, known] : names)
    if (known == value) return name;
  return "";
}

}  // namespace

const char* name_of(Direction direction) { return name_in(kDirections, direction); }
const char* name_of(BodyKind kind) { return name_in(kBodyKinds, kind); }
const char* plural_of(BodyKind kind) {
  return kind == BodyKind::Mixed ? "spheres, capsules and boxes" : name_of(kind);
}

const std::vector<Option<SetOptions>>& set_options() {
  static const std::vector<Option<SetOptions>> options = table();
  return options;
}

const std::vector<Option<RobotSetOptions>>& robot_set_options() {
  static const std::vector<Option<RobotSetOptions>> options = [] {
    auto out = options_of_part<RobotSetOptions>(
        set_options(), [](auto& r) -> auto& { return r.set; });
    constexpr Names<bool, 2> kGeometries{{{"collision", false}, {"visual", true}}};
    out.push_back(choice<RobotSetOptions>(
        {.name = "geometry", .text = "Which shapes of a robot"},
        [](auto& r) -> auto& { return r.visual; }, kGeometries));
    return out;
  }();
  return options;
}

SetRequest request_of(const SetOptions& options) {
  SetRequest out = options.request;
  const PreparationOptions& p = options.preparation;
  out.preparation = p.preparing();
  const bool if_needed = p.mode == Mode::Auto && out.direction == SetRequest::Direction::Outer &&
                         out.preparation.holes == geom::Holes::Fill &&
                         !out.preparation.keep_orientation;
  if (out.preparation.holes == geom::Holes::Keep) out.preparation.holes = geom::Holes::Refuse;
  out.wrap.reset();
  if (p.mode == Mode::Wrap || if_needed) {
    out.wrap.emplace();
    out.wrap->offset = p.offset;
    out.wrap->seal = p.seal;
    out.wrap->where_needed = if_needed;
  }
  out.hold_exact_faces = p.holds_exact_faces();
  return out;
}

SetOptions options_of(const SetRequest& request) {
  SetOptions out{request, {}};
  PreparationOptions& p = out.preparation;
  p.drop_sheets = request.preparation.drop_sheets;
  p.keep_orientation = request.preparation.keep_orientation;
  if (request.preparation.holes == geom::Holes::Refuse) p.holes = geom::Holes::Refuse;
  if (!request.wrap) return out;
  if (!request.wrap->where_needed) p.mode = Mode::Wrap;
  p.offset = request.wrap->offset;
  p.seal = request.wrap->seal;
  return out;
}

SetRequest in_unit_of_file(SetRequest request, const std::string& unit,
                           std::vector<std::string>& notes) {
  std::vector<Length*> lengths;
  for (std::optional<Length>* one : {&request.epsilon, &request.thickness})
    if (*one) lengths.push_back(&**one);
  for (geom::RequestedRegion& one : request.regions) lengths.push_back(&one.epsilon);
  if (request.wrap)
    for (std::optional<Length>* one : {&request.wrap->offset, &request.wrap->seal})
      if (*one) lengths.push_back(&**one);
  if (unit.empty()) {
    std::vector<Length> stated;
    stated.reserve(lengths.size());
    for (const Length* length : lengths) stated.push_back(*length);
    for (std::string& note :
         notes_on_unit(stated, request.unit + "; another one is stated by «unit=mm»"))
      notes.push_back(std::move(note));
  } else {
    if (unit != request.unit && !request.unit.empty())
      notes.push_back("Its vertices are in " + unit + " as read, and so is its set, not in " +
                      request.unit + ".");
    request.unit = unit;
  }
  for (Length* length : lengths) *length = length->in(request.unit);
  return request;
}

std::optional<Length> SetRequest::wanted_epsilon() const {
  if (epsilon || max_bodies || max_total_vertices) return epsilon;
  return Length{1, true};
}

namespace {

/// A word that stands for regions: a hash of all of their numbers.
std::string word_of(const std::vector<geom::RequestedRegion>& regions) {
  std::ostringstream text;
  text << std::hexfloat;
  const auto put = [&](const geom::Vec3& p) {
    text << ' ' << p.x() << ' ' << p.y() << ' ' << p.z();
  };
  for (const geom::RequestedRegion& one : regions) {
    text << one.name << '\n' << one.epsilon.text() << ' ' << one.region.radius;
    put(one.region.center);
    for (const geom::HalfSpace& side : one.region.sides) {
      put(side.normal);
      text << ' ' << side.offset;
    }
    text << '\n';
  }
  return "sha256:" + sha256(text.str());
}

}  // namespace

std::string SetRequest::parameters() const {
  SetOptions options = options_of(*this);
  options.request.epsilon = wanted_epsilon();
  const std::string out = record_of(set_options(), options);
  return out + certify::record_of(regions);
}

std::string record_of(const std::vector<geom::RequestedRegion>& regions) {
  return regions.empty() ? std::string()
                         : std::string(" --") + kRegionsOption + ' ' + word_of(regions);
}

geom::Provenance origin_of(const SetRequest& request, const std::string& sha256) {
  geom::Provenance p;
  p.source = request.source;
  p.source_sha256 = sha256;
  p.tool = "bcd-decompose " KABOUM_VERSION;
  p.parameters = request.parameters();
  p.unit = request.unit;
  p.frame = request.frame;
  p.direction = name_of(request.direction);
  return p;
}

void be_of_robot(SetOptions& options) {
  bring_lengths_into("m", set_options(), options);
  SetRequest& r = options.request;
  if (!r.epsilon && !r.max_bodies && !r.max_total_vertices) r.epsilon = Length{kRobotEpsilon};
}

std::string contradiction(const SetOptions& options, const std::set<std::string>& stated) {
  std::string flaw = contradiction(options.preparation, stated);
  if (!flaw.empty()) return flaw;
  if (options.request.body_kind != SetRequest::BodyKind::Polytopes) {
    const std::string kind = name_of(options.request.body_kind);
    if (options.request.direction != SetRequest::Direction::Outer &&
        options.request.body_kind != SetRequest::BodyKind::Spheres)
      return "{bodies} " + kind + " needs {direction} outer";
    for (const char* name :
         {"max-total-vertices", "max-vertices-per-body", "max-facets-per-body", "min-thickness",
          "max-aspect", "simplify", "improve-work", "max-work", "pre-step"})
      if (stated.contains(name))
        return "{" + std::string(name) + "} means nothing with {bodies} " + kind;
  }
  if (options.request.direction != SetRequest::Direction::Outer) {
    if (options.preparation.mode == Mode::Wrap)
      return "{prepare} wrap: what lies in a wrap need not lie in the input; only {direction} "
             "outer";
    const char* outer_only = nullptr;
    for (const char* name :
         {"max-total-vertices", "max-facets-per-body", "simplify", "improve-work"})
      if (outer_only == nullptr && stated.contains(name)) outer_only = name;
    if (outer_only != nullptr) return "{" + std::string(outer_only) + "} needs {direction} outer";
    if (options.request.pre_step == bcd::PreStep::On)
      return "{pre-step} on needs {direction} outer";
  }
  if (stated.contains(kRegionsOption)) {
    const std::string regions = std::string("{") + kRegionsOption + "}";
    if (options.request.direction != SetRequest::Direction::Outer)
      return regions + " needs {direction} outer";
    for (const char* name : {"max-bodies", "max-total-vertices", "min-thickness", "max-aspect"})
      if (stated.contains(name)) return regions + (" does not go with {" + std::string(name)) + "}";
  }
  if (options.request.max_facets) {
    for (const char* name : {"max-total-vertices", "min-thickness", "max-aspect", "simplify"})
      if (stated.contains(name))
        return "{max-facets-per-body} does not go with {" + std::string(name) + "}";
  }
  if (options.request.simplify && options.request.max_total_vertices)
    return "{simplify} means nothing with {max-total-vertices}, which leaves out as many vertices "
           "as the distance allows";
  return {};
}

}  // namespace kaboum::certify
