// The options of a bounding mesh: their table, and the requests that they come to.

#include <kaboum/certify/mesh_options.h>

#include <algorithm>
#include <array>
#include <utility>

namespace kaboum::certify {
namespace {

using R = MeshOptions;
using Numbers = MeshRequest::Numbers;
using Mode = PreparationOptions::Mode;

template <class Value, std::size_t N>
using Names = std::array<std::pair<const char*, Value>, N>;

constexpr Names<bmesh::Direction, 3> kDirections{{{"outer", bmesh::Direction::Outer},
                                                  {"inner", bmesh::Direction::Inner},
                                                  {"any", bmesh::Direction::Any}}};
constexpr Names<bmesh::Cost, 6> kCosts{{{"planes", bmesh::Cost::Planes},
                                        {"planes-adapted", bmesh::Cost::PlanesAdapted},
                                        {"planes-diagonal", bmesh::Cost::PlanesDiagonal},
                                        {"triangles", bmesh::Cost::Triangles},
                                        {"distance", bmesh::Cost::Distance},
                                        {"mean", bmesh::Cost::Mean}}};
constexpr Names<bmesh::Effort, 3> kEfforts{{{"fast", bmesh::Effort::Fast},
                                            {"normal", bmesh::Effort::Normal},
                                            {"best", bmesh::Effort::Best}}};
constexpr Names<Numbers, 3> kNumbers{
    {{"auto", Numbers::Auto}, {"float", Numbers::Float}, {"double", Numbers::Double}}};

void add_targets(std::vector<Option<R>>& out) {
  out.push_back(choice<R>(
      {.name = "direction",
       .text = "outer: the result encloses the input; inner: the input encloses the result; any: "
               "neither, for comparison"},
      [](auto& r) -> auto& { return r.request.direction; }, kDirections));
  out.push_back(option<R>(
      {.name = "vertices",
       .text = "Stop at this many vertices. Several numbers, as in 20000,10000,5000, give a series "
               "in one pass: each result encloses (inner: is enclosed by) the finer ones",
       .low = 4},
      [](auto& r) -> auto& { return r.request.vertices; }));
  out.push_back(option<R>(
      {.name = "ratio",
       .text = "Stop at this fraction of the input's welded vertices",
       .values = "R",
       .low = 0,
       .high = 1,
       .between = true},
      [](auto& r) -> auto& { return r.request.ratio; }));
  out.push_back(option<R>(
      {.name = "epsilon",
       .text = "Keep every point of either surface within this distance of the other: a length in "
               "the mesh's unit (of robots m) or its own, as in 5mm, or a percentage of the "
               "bounding box's diagonal, as in 0.5%"},
      [](auto& r) -> auto& { return r.request.epsilon; }));
}

void add_search(std::vector<Option<R>>& out) {
  out.push_back(choice<R>(
      {.name = "cost",
       .text = "Cost of a contraction. distance: the measured distance, for a small largest "
               "distance; mean: for a small mean distance; planes and the others: the thesis's, "
               "faster, and go on to fewer vertices, with spikes"},
      [](auto& r) -> auto& { return r.request.cost; }, kCosts));
  out.push_back(choice<R>(
      {.name = "effort",
       .text = "Tightness against time. fast: contractions only; normal and best: vertices are "
               "also pulled back towards the input and edges flipped, many times slower (not with "
               "{keep-convex}, nor for open meshes)"},
      [](auto& r) -> auto& { return r.request.effort; }, kEfforts));
  out.push_back(option<R>(
      {.name = "max-work",
       .text = "End after so much work, counted in steps that take about so many seconds of one "
               "core, so that the result is the same on any machine; the best result so far is "
               "written, and encloses as ever",
       .values = "SECONDS",
       .low = 0.001,
       .high = 1e9,
       .otherwise = "12, and 2 per 1000 triangles beyond 10000; no limit with {effort} best"},
      [](auto& r) -> auto& { return r.request.max_work; }));
  out.push_back(option<R>(
      {.name = "as-printed",
       .text = "With the thesis's formulas as printed, to reproduce its tables (only with {cost} "
               "planes-diagonal)"},
      [](auto& r) -> auto& { return r.request.as_printed; }));
  out.push_back(choice<R>(
      {.name = "precision",
       .text = "Numbers of the result's coordinates; auto: float, or double where float is too "
               "coarse and the format can hold it"},
      [](auto& r) -> auto& { return r.request.numbers; }, kNumbers));
  out.push_back(option<R>(
      {.name = "sharp-angle",
       .text = "Edges whose normals differ by more degrees than this resist growing spikes; 180: "
               "none (only with {cost} planes, planes-adapted and planes-diagonal)",
       .values = "DEG",
       .low = 0,
       .high = 180,
       .otherwise = option_text::of(bmesh::kSharpAngle)},
      [](auto& r) -> auto& { return r.request.sharp_angle; }));
  out.push_back(option<R>(
      {.name = "keep-convex", .text = "Convex in, convex out, exactly"},
      [](auto& r) -> auto& { return r.request.keep_convex; }));
}

void add_judgement(std::vector<Option<R>>& out) {
  out.push_back(option<R>(
      {.name = "verify",
       .text = "Decide enclosure and distances anew, exactly and by independent means, against the "
               "input as prepared"},
      [](auto& r) -> auto& { return r.request.decide; }));
  out.push_back(option<R>(
      {.name = "measure",
       .text = "Measure the distances between input and result, in certified brackets, which "
               "{epsilon} and {verify} ask for anyway"},
      [](auto& r) -> auto& { return r.request.measure; }));
}

std::vector<Option<R>> table() {
  std::vector<Option<R>> out;
  add_targets(out);
  add_search(out);
  for (Option<R>& o : options_of_part<R>(
           preparation_options(PreparedFor::Bounding),
           [](auto& r) -> auto& { return r.preparation; }))
    out.push_back(std::move(o));
  add_judgement(out);
  return out;
}

std::string cannot_join(const std::string& one, const std::string& other) {
  return one + " cannot be joined with {" + other + "}";
}

}  // namespace

const std::vector<Option<MeshOptions>>& mesh_options() {
  static const std::vector<Option<MeshOptions>> options = table();
  return options;
}

std::string contradiction(const MeshOptions& options, const std::set<std::string>& stated) {
  const MeshRequest& r = options.request;
  const auto named = [&](const char* name) {
    return std::string("{").append(name).append("} ").append(
        value_of(mesh_options(), name, options));
  };
  if (std::string flaw = contradiction(options.preparation, stated); !flaw.empty()) return flaw;
  if (r.vertices.empty() && !r.ratio && !r.epsilon)
    return "give at least one of {vertices}, {ratio} and {epsilon}";
  if (r.vertices.size() > 1 && r.ratio)
    return "several numbers of {vertices} cannot be joined with {ratio}";
  if (r.as_printed && r.cost != bmesh::Cost::PlanesDiagonal)
    return cannot_join(named("cost"), "as-printed");
  if (r.sharp_angle && !named("cost").starts_with("{cost} planes"))
    return cannot_join(named("cost"), "sharp-angle");
  if (options.preparation.mode == Mode::Wrap && r.direction != bmesh::Direction::Outer)
    return "{prepare} wrap: what lies in a wrap need not lie in the input; only {direction} outer";
  if (r.decide && r.direction == bmesh::Direction::Any)
    return "{verify}: direction 'any' claims nothing that could be verified";
  return {};
}

MeshPreparation preparation_of(const MeshOptions& options,
                               const std::vector<std::uint32_t>& bent_quads, double deviation) {
  using Wrap = MeshPreparation::Wrap;
  using Diagonal = geom::PrepareOptions::Diagonal;
  const PreparationOptions& p = options.preparation;
  const bool outer = options.request.direction == bmesh::Direction::Outer;
  MeshPreparation out;
  out.options = p.preparing();
  if (!options.request.record_steps && options.request.direction != bmesh::Direction::Any) {
    out.options.quads = bent_quads;
    out.options.diagonal = outer ? Diagonal::Outward : Diagonal::Inward;
  }
  const bool always = p.mode == Mode::Wrap || (outer && deviation > 0 && p.holds_exact_faces());
  out.wrap = always ? Wrap::Always : p.mode == Mode::Auto ? Wrap::WhereNeeded : Wrap::Never;
  out.wrapping.offset = p.offset;
  out.wrapping.seal = p.seal;
  out.wrapping.clearance = deviation;
  return out;
}

EnclosureRequest link_request_of(MeshOptions options, const std::optional<io::Format>& format) {
  if (format && format != io::Format::Stl && format != io::Format::Obj)
    throw Error(ErrorCode::InvalidArgument, "a robot's meshes are stl or obj");
  if (options.request.vertices.size() > 1)
    throw Error(ErrorCode::InvalidArgument,
                "a robot's meshes are no series: one number of vertices");
  options.request.format = format.value_or(io::Format::Stl);
  if (options.request.numbers == MeshRequest::Numbers::Double &&
      !io::holds_double(options.request.format))
    throw Error(ErrorCode::InvalidArgument, "stl holds float32 only: doubles need obj");
  EnclosureRequest out = enclosure_request_of(options);
  if (!format) out.spare_format = io::Format::Obj;
  return out;
}

EnclosureRequest enclosure_request_of(const MeshOptions& options) {
  const PreparationOptions& p = options.preparation;
  EnclosureRequest out;
  out.mesh = options.request;
  out.preparation = p.preparing();
  // Holes that are kept and an orientation that is kept say which solid is wanted.
  const bool where_needed = p.mode == Mode::Auto && out.preparation.holes == geom::Holes::Fill &&
                            !out.preparation.keep_orientation;
  if (p.mode == Mode::Wrap || where_needed) {
    out.wrap.emplace();
    out.wrap->offset = p.offset;
    out.wrap->seal = p.seal;
    out.wrap->where_needed = where_needed;
  }
  out.hold_exact_faces = p.holds_exact_faces();
  return out;
}

std::string EnclosureRequest::parameters() const {
  MeshOptions options;
  options.request = mesh;
  options.request.measure = false;  // it is, in any case
  options.preparation.holes = preparation.holes;
  options.preparation.drop_sheets = preparation.drop_sheets;
  options.preparation.keep_orientation = preparation.keep_orientation;
  if (wrap) {
    options.preparation.offset = wrap->offset;
    options.preparation.seal = wrap->seal;
    if (!wrap->where_needed) options.preparation.mode = Mode::Wrap;
  }
  std::string out = record_of(mesh_options(), options);
  out += wrap ? ", clearance " + option_text::of(wrap->clearance) : ", never wrapped";
  return out;
}

}  // namespace kaboum::certify
