// Convex sets: kaboum.decompose, as bcd-decompose; sets from files.

#include "convex_set.h"

#include <kaboum/base/length_unit.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <filesystem>

#include "mesh.h"
#include "running.h"
#include "set_options.h"

namespace kaboum::python {
namespace {

py::object parsed(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

void bind_plain(py::module_& module) {
  py::class_<SetValue>(
      module, "ConvexSet",
      R"(Convex bodies, each enlarged by a ball of radius `margin`: their union. It never changes.)")
      .def(py::init([](const py::list& bodies, double margin) {
             geom::ConvexSet set = *set_of(bodies);
             if (!(margin >= 0))
               throw Error(ErrorCode::InvalidArgument, "margin must be at least 0");
             set.margin = margin;
             return SetValue{std::make_shared<geom::ConvexSet>(std::move(set))};
           }),
           py::arg("bodies"), py::kw_only(), py::arg("margin") = 0.0,
           "A list of meshes, which need not be convex: `verify_cover` tells.")
      .def_property_readonly(
          "bodies", [](const SetValue& s) { return bodies_of(s.set); },
          "A list of `Mesh`; nothing is copied.")
      .def_property_readonly(
          "margin", [](const SetValue& s) { return s.set->margin; }, "[length]")
      .def_property_readonly(
          "record", [](const SetValue& s) { return record_of(s.set->provenance); },
          "What the container says of itself: source, parameters, claims.")
      .def(
          "write", [](const SetValue& s, const py::object& path) { write_set(*s.set, {}, path); },
          py::arg("path"),
          "Writes a .glb container, an .obj with one object per body, or a folder of STL files.")
      .def("__len__", [](const SetValue& s) { return s.set->bodies.size(); })
      .def("__repr__", [](const SetValue& s) {
        return "<kaboum.ConvexSet of " + std::to_string(s.set->bodies.size()) + " bodies>";
      });
}

void bind_certified(py::module_& module) {
  using Value = CertifiedSetValue;
  py::class_<Value>(
      module, "CertifiedSet",
      R"(Convex bodies that cover a solid, or fill it, decided exactly. It never changes.

It may be given wherever a ConvexSet is expected.)")
      .def_property_readonly(
          "bodies", [](const Value& s) { return bodies_of(s.set()); },
          "A list of `Mesh`; nothing is copied.")
      .def_property_readonly(
          "margin", [](const Value& s) { return s.made.artefact().margin; }, "0. [length]")
      .def_property_readonly(
          "record", [](const Value& s) { return record_of(s.made.artefact().provenance); },
          "What the container says of itself: source, parameters, claims.")
      .def_property_readonly(
          "report", [](const Value& s) { return parsed(certify::to_json(s.made)); },
          "As the report of bcd-decompose (docs/reports.md).")
      .def_property_readonly(
          "reached", [](const Value& s) { return s.made.certificate().reached(); },
          "Whether epsilon, if asked for, is reached within all limits.")
      .def_property_readonly(
          "distance",
          [](const Value& s) {
            return py::make_tuple(s.made.certificate().distance_lower,
                                  s.made.certificate().distance_upper);
          },
          "Certified bracket of the largest distance from a point of the set to the solid (outer), "
          "or of the depth of what is left out (inner). [length]")
      .def_readonly("cached", &Value::cached, "Whether an earlier call's result was used.")
      .def_readonly("notes", &Value::notes, "What a user should know of the input.")
      .def_property_readonly(
          "bytes",
          [](const Value& s) { return py::bytes(s.made.bytes().data(), s.made.bytes().size()); },
          "The certified container (.glb).")
      .def(
          "write",
          [](const Value& s, const py::object& path) {
            write_set(s.made.artefact(), s.made.bytes(), path);
          },
          py::arg("path"),
          "Writes the certified .glb container, an .obj with one object per body, or a folder of "
          "STL files.")
      .def("__len__", [](const Value& s) { return s.made.artefact().bodies.size(); })
      .def("__repr__", [](const Value& s) {
        return "<kaboum.CertifiedSet of " + std::to_string(s.made.artefact().bodies.size()) +
               " bodies>";
      });
}

CertifiedSetValue decompose(
    const py::object& mesh, const py::object& epsilon, const std::optional<std::size_t>& max_bodies,
    const std::optional<std::size_t>& max_total_vertices, std::size_t max_vertices_per_body,
    const std::optional<double>& simplify, double min_thickness, const std::string& direction,
    const std::string& effort, const std::optional<double>& max_work, const std::string& method,
    const std::string& pre_step, const std::string& unit, const std::string& frame,
    const std::string& prepare, const py::object& offset, const py::object& seal, bool drop_sheets,
    const std::string& holes, bool keep_orientation, bool no_cache, int threads,
    const py::object& progress) {
  certify::SetRequest r;
  if (prepare == "wrap")
    r.wrap.emplace();
  else if (prepare != "auto")
    refuse_name("prepare", prepare, {"auto", "wrap"});
  if (!r.wrap && (!offset.is_none() || !seal.is_none()))
    throw Error(ErrorCode::InvalidArgument, "offset and seal are for prepare='wrap'");
  if (!r.wrap && direction == "outer" && holes == "fill" && !keep_orientation)
    r.wrap.emplace().where_needed = true;
  if (r.wrap) r.wrap->offset = length_of(offset, "offset");
  if (r.wrap) r.wrap->seal = length_of(seal, "seal");
  r.epsilon = length_of(epsilon, "epsilon");
  r.max_bodies = max_bodies;
  r.max_total_vertices = max_total_vertices;
  r.max_vertices = max_vertices_per_body;
  r.simplify = simplify;
  r.min_thickness = min_thickness;
  r.direction = value_of(kSetDirections, direction, "direction");
  r.effort = value_of(kSetEfforts, effort, "effort");
  r.max_work = max_work;
  r.method = value_of(kMethods, method, "method");
  r.pre_step = value_of(kPreSteps, pre_step, "pre_step");
  r.preparation = {.drop_sheets = drop_sheets,
                   .holes = holes_of(holes, false),
                   .keep_orientation = keep_orientation};
  if (std::find(kLengthUnits.begin(), kLengthUnits.end(), unit) == kLengthUnits.end())
    refuse_name("unit", unit, {kLengthUnits.begin(), kLengthUnits.end()});
  r.frame = frame;
  const MeshValue value = mesh_of(mesh, "mesh");
  r.unit = value.unit.empty() ? unit : value.unit;
  r.source = std::filesystem::path(value.source).filename().string();
  // Of STEP and IGES the exact faces are what is covered.
  if (value.deviation > 0 && r.direction == certify::SetRequest::Direction::Outer) {
    if (!r.wrap) r.wrap.emplace();
    r.wrap->where_needed = false;
    r.wrap->clearance = value.deviation;
  }
  Watch watch(progress);
  return run(threads, [&] {
    CertifiedSetValue out;
    out.notes = value.notes;
    const certify::SetCache cache(certify::SetCache::default_folder());
    auto found = certify::find_or_certify(
        *value.mesh, value.sha256, r, no_cache ? nullptr : &cache,
        {watch.hook(), [&](const std::string& text) { out.notes.push_back(text); }});
    if (!found) throw certify::TooCoarse(value.source.empty() ? "the mesh" : value.source);
    out.made = found->set;
    out.cached = found->cached;
    return out;
  });
}

constexpr const char* kDoc =
    R"(Decomposes a solid into few convex bodies whose union provably contains it.

Options and defaults are those of bcd-decompose (docs/algorithms/convex-decomposition.md).

Parameters
----------
mesh : mesh
epsilon : float or str, optional
    Fewest bodies with no point farther than this from the solid: a length, or a percentage of the
    diagonal such as '0.5%'. By default '1%', unless max_bodies or max_total_vertices is given.
max_bodies : int, optional
    Smallest distance with at most this many bodies.
max_total_vertices : int, optional
    Smallest distance with at most this many vertices of all bodies together.
max_vertices_per_body : int
simplify : float, optional
    Share of epsilon that leaving out vertices may take, 0 to 1.
min_thickness : float
    Thicken bodies that are less wide than this in some direction. [length]
direction : str
    'outer': bodies that cover the solid; 'inner': bodies inside it, which leave out no point deeper
    than epsilon.
effort : str
    'fast', 'normal' or 'best'.
max_work : float, optional
    End the search after work of about so many seconds; the result does not depend on the machine.
method : str
    'planes', 'clusters' or 'voxels'.
pre_step : str
    Simplify the input first: 'auto', 'on' or 'off'.
unit, frame : str
    Noted in the container; a unit that the mesh's file states comes first.
prepare : str
    'auto', or 'wrap': what is covered is a closed mesh round all triangles, whatever they are like;
    how far it is from them counts towards epsilon. A mesh read from STEP or IGES is wrapped in any
    case, so that its exact faces are covered.
offset, seal : float or str, optional
    Of a wrap: how far it may be from the triangles where it can get near them; hollows behind gaps
    narrower than this are filled.
drop_sheets, holes, keep_orientation
    As for `prepare`; holes are filled or refused.
no_cache : bool
    Neither use nor store results of earlier runs ($KABOUM_CACHE, else $XDG_CACHE_HOME/kaboum, else
    ~/.cache/kaboum).
threads : int
    0: one per core. The result is the same for any number.
progress : callable, optional
    Called with what is being done; what it raises ends the work, as Ctrl-C does.

Raises
------
Error
    'invalid_input' when the mesh has no solid, or float32 is too coarse; 'invalid_argument'.)";

}  // namespace

std::shared_ptr<const geom::ConvexSet> set_of(const py::object& value) {
  if (py::isinstance<SetValue>(value)) return value.cast<SetValue>().set;
  if (py::isinstance<CertifiedSetValue>(value)) return value.cast<CertifiedSetValue>().set();
  if (const auto path = path_of(value))
    return std::make_shared<geom::ConvexSet>(io::read_convex_set(*path));
  if (!py::isinstance<py::list>(value)) return nullptr;
  auto set = std::make_shared<geom::ConvexSet>();
  for (const py::handle body : value) {
    const MeshValue mesh = mesh_of(py::reinterpret_borrow<py::object>(body), "bodies");
    set->bodies.push_back({io::default_name(set->bodies.size()), *mesh.mesh});
  }
  return set;
}

py::list bodies_of(const std::shared_ptr<const geom::ConvexSet>& set) {
  py::list out;
  for (const geom::ConvexBody& body : set->bodies)
    out.append(MeshValue{.mesh = {set, &body.hull}, .source = body.name});
  return out;
}

py::dict record_of(const geom::Provenance& p) {
  py::dict out;
  out["source"] = p.source;
  out["source_sha256"] = p.source_sha256;
  out["tool"] = p.tool;
  out["parameters"] = p.parameters;
  out["unit"] = p.unit;
  out["frame"] = p.frame;
  out["direction"] = p.direction;
  out["epsilon"] = p.epsilon < 0 ? py::object(py::none()) : py::object(py::float_(p.epsilon));
  out["covers_solid"] = p.covers_solid;
  out["covers_surface"] = p.covers_surface;
  return out;
}

void write_set(const geom::ConvexSet& set, const std::vector<char>& bytes, const py::object& path) {
  const auto file = path_of(path);
  if (!file) throw Error(ErrorCode::InvalidArgument, "path must be a str or an os.PathLike");
  run(0, [&] {
    if (!bytes.empty() && io::set_format_from_path(*file) == io::SetFormat::Glb)
      io::write_file(*file, bytes);
    else
      io::write_convex_set(*file, set);
  });
}

void bind_convex_sets(py::module_& module) {
  bind_plain(module);
  bind_certified(module);
  module.def(
      "decompose", &decompose, py::arg("mesh"), py::kw_only(), py::arg("epsilon") = py::none(),
      py::arg("max_bodies") = py::none(), py::arg("max_total_vertices") = py::none(),
      py::arg("max_vertices_per_body") = 64, py::arg("simplify") = py::none(),
      py::arg("min_thickness") = 0.0, py::arg("direction") = "outer", py::arg("effort") = "normal",
      py::arg("max_work") = py::none(), py::arg("method") = "planes", py::arg("pre_step") = "auto",
      py::arg("unit") = "m", py::arg("frame") = "", py::arg("prepare") = "auto",
      py::arg("offset") = py::none(), py::arg("seal") = py::none(), py::arg("drop_sheets") = false,
      py::arg("holes") = "fill", py::arg("keep_orientation") = false, py::arg("no_cache") = false,
      py::arg("threads") = 0, py::arg("progress") = py::none(), kDoc);
  module.def(
      "read_set",
      [](const py::object& path, const std::optional<std::string>& format) {
        const auto file = path_of(path);
        if (!file) throw Error(ErrorCode::InvalidArgument, "path must be a str or an os.PathLike");
        const auto known = format_of(format, "format");
        return run(0, [&] {
          return SetValue{std::make_shared<geom::ConvexSet>(io::read_convex_set(*file, known))};
        });
      },
      py::arg("path"), py::kw_only(), py::arg("format") = py::none(),
      R"(Reads convex bodies: a .glb container, an .obj, a folder of STL files, or a mesh, each of whose
connected parts is a body (docs/formats.md).

Raises
------
Error
    As `read`.)");
}

}  // namespace kaboum::python
