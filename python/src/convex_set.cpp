// Convex sets: kaboum.decompose, as bcd-decompose; sets from files.

#include "convex_set.h"
#include "answers.h"

#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/page/set_page.h>
#include <kaboum/picture/bodies.h>
#include <kaboum/picture/png_file.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "arguments.h"
#include "mesh.h"
#include "pictures.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

/// The ends of a segment, or a point; nullopt for what is no array of them.
std::optional<std::vector<geom::Vec3>> points_of_core(const py::object& value) {
  if (!py::isinstance<py::array>(value)) return std::nullopt;
  const auto array = value.cast<py::array>();
  const bool point = array.ndim() == 1 && array.shape(0) == 3;
  const bool rows = array.ndim() == 2 && array.shape(0) <= 2 && array.shape(1) == 3;
  if (!point && !rows) return std::nullopt;
  return points_of(array.attr("reshape")(-1, 3), "bodies");
}

void take_radii(const py::object& value, geom::ConvexSet& set) {
  const py::array given = array_from(value);
  if (!given || given.ndim() > 1) {
    PyErr_Clear();
    throw Error(ErrorCode::InvalidArgument, "radii must be a number or a list of numbers");
  }
  require_doubles(given.attr("reshape")(1, -1), "radii");
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  const std::vector<double> radii(array.data(), array.data() + array.size());
  if (radii.size() != 1 && radii.size() != set.bodies.size())
    throw Error(ErrorCode::InvalidArgument,
                "radii must be one number, or one for each of the bodies (" +
                    std::to_string(set.bodies.size()) + ")");
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    const double radius = radii[radii.size() == 1 ? 0 : i];
    if (!(radius >= 0) || !std::isfinite(radius))
      throw Error(ErrorCode::InvalidArgument, "radii must be at least 0, and finite");
    if (set.bodies[i].core.triangles.empty() && radius == 0)
      throw Error(ErrorCode::InvalidArgument, "body " + std::to_string(i) +
                                                  " is a segment or a point: its radius must be "
                                                  "above 0");
    set.bodies[i].radius = radius;
  }
}

py::array_t<double> radii_of(const geom::ConvexSet& set) {
  py::array_t<double> out = row_of<double>(set.bodies.size());
  auto at = out.mutable_unchecked<1>();
  for (std::size_t i = 0; i < set.bodies.size(); ++i)
    at(static_cast<py::ssize_t>(i)) = set.bodies[i].radius;
  return out;
}

py::object parsed(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

void bind_plain(py::module_& module) {
  py::class_<SetValue>(module, "ConvexSet",
                       R"(Convex bodies: their union. It never changes.

A body is all points within a radius of its core: a polytope, a segment or a point.)")
      .def(py::init([](const py::list& bodies, const py::object& radii) {
             geom::ConvexSet set = *set_of(bodies);
             take_radii(radii, set);
             return SetValue{std::make_shared<geom::ConvexSet>(std::move(set))};
           }),
           py::arg("bodies"), py::kw_only(), py::arg("radii") = 0.0,
           R"(Parameters
----------
bodies : list
    The cores: meshes, which need not be convex (`verify_cover` tells), and arrays (2, 3), the ends
    of a segment, or (1, 3) or (3,), a point. [length]
radii : float or array (n,)
    One for all bodies, or one for each; at least 0. [length])")
      .def_property_readonly(
          "bodies", [](const SetValue& s) { return bodies_of(s.set); },
          "A list of `Mesh`; nothing is copied.")
      .def_property_readonly(
          "radii", [](const SetValue& s) { return radii_of(*s.set); },
          "Of each body, (n,) float64. [length]")
      .def_property_readonly(
          "record", [](const SetValue& s) { return record_of(s.set->provenance); },
          "What the container says of itself: source, parameters, claims.")
      .def(
          "write", [](const SetValue& s, const py::object& path) { write_set(*s.set, {}, path); },
          py::arg("path"),
          "Writes a .glb container, an .obj with one object per body, or a folder of STL files.")
      .def(
          "write_preview",
          [](const SetValue& s, const py::object& file, double explode) {
            required_path(file, "file");
            png_bytes(file,
                      [&] { return picture::encode_png(picture::draw_bodies(*s.set, explode)); });
          },
          py::arg("file"), py::kw_only(), py::arg("explode") = picture::kExplode,
          R"(Writes a picture (.png) of the bodies.

It has a second panel, with the bodies moved apart by the share `explode` of their distance from the
middle; 0: it has none.)")
      .def("__len__", [](const SetValue& s) { return s.set->bodies.size(); })
      .def("__repr__", [](const SetValue& s) {
        return "<kaboum.ConvexSet of " + std::to_string(s.set->bodies.size()) + " bodies>";
      });
}

void write_set_preview(const CertifiedSetValue& s, const py::object& file, double explode) {
  write_preview(
      file,
      [&] {
        return page::page_of_set({s.file.empty() ? "the mesh" : s.file, *s.mesh, s.preparation},
                                 s.made.certificate(), s.made.artefact(), remedy_of_python);
      },
      [&] { return picture::encode_png(picture::draw_bodies(s.made.artefact(), explode)); });
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
          "radii", [](const Value& s) { return radii_of(s.made.artefact()); },
          "Of each body, (n,) float64: zeros. [length]")
      .def_property_readonly(
          "record", [](const Value& s) { return record_of(s.made.artefact().provenance); },
          "What the container says of itself: source, parameters, claims.")
      .def_property_readonly(
          "certificate", [](const Value& s) { return dict_of(certify::certificate_of(s.made)); },
          kCertificateDoc)
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
      .def_property_readonly("notes", notes_of(&Value::notes),
                             "What a user should know of the input.")
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
      .def(
          "write_preview", &write_set_preview, py::arg("file"), py::kw_only(),
          py::arg("explode") = picture::kExplode,
          R"(Writes a page (.html) that shows the bodies over the mesh, or a picture (.png) of the bodies,
as `bcd-decompose --preview`.

The picture has a second panel, with the bodies moved apart by the share `explode` of their distance
from the middle; 0: it has none.)")
      .def("__len__", [](const Value& s) { return s.made.artefact().bodies.size(); })
      .def("__repr__", [](const Value& s) {
        return "<kaboum.CertifiedSet of " + std::to_string(s.made.artefact().bodies.size()) +
               " bodies>";
      });
}

/// The mesh with its coordinates multiplied by a factor.
MeshValue scaled(MeshValue value, double factor) {
  io::ReadResult read;
  read.mesh = *value.mesh;
  read.unit = value.unit;
  read.deviation = value.deviation;
  read.bent_quads = value.bent_quads;
  io::scale(read, factor, value.source.empty() ? "the mesh" : value.source);
  value.mesh = std::make_shared<const geom::Mesh>(std::move(read.mesh));
  value.unit = read.unit;
  value.deviation = read.deviation;
  value.bent_quads = std::move(read.bent_quads);
  value.notes.insert(value.notes.end(), read.notes.begin(), read.notes.end());
  return value;
}

CertifiedSetValue decompose(const py::object& mesh, const py::object& epsilon_map,
                            const py::kwargs& given) {
  py::dict keywords = given;
  certify::SetOptions options;
  std::set<std::string> stated = take_options(certify::set_options(), keywords, options);
  if (!epsilon_map.is_none()) stated.insert(certify::kRegionsOption);
  const RunKeywords running = take_run_keywords(keywords);
  require_all_taken("decompose", keywords, keywords_of(certify::set_options()));
  require_none(certify::contradiction(options, stated));
  options.request.regions = regions_of(epsilon_map);
  certify::SetRequest r = certify::request_of(options);
  MeshValue value = mesh_of(mesh, "mesh");
  if (r.scale != 1) value = scaled(std::move(value), r.scale);
  r = certify::in_unit_of_file(std::move(r), value.unit, value.notes);
  using Diagonal = geom::PrepareOptions::Diagonal;
  r.preparation.quads = value.bent_quads;
  r.preparation.diagonal =
      r.direction == certify::SetRequest::Direction::Outer ? Diagonal::Outward : Diagonal::Inward;
  r.source = std::filesystem::path(value.source).filename().string();
  // Of STEP and IGES the exact faces are what is covered.
  if (value.deviation > 0 && r.hold_exact_faces &&
      r.direction == certify::SetRequest::Direction::Outer) {
    if (!r.wrap) r.wrap.emplace();
    r.wrap->where_needed = false;
    r.wrap->clearance = value.deviation;
  }
  Watch watch(running.progress);
  return run(running.threads, [&] {
    CertifiedSetValue out;
    out.notes = value.notes;
    if (!value.sha256.empty()) out.file = value.source;
    out.mesh = value.mesh;
    out.preparation = r.preparation;
    const certify::SetCache cache(certify::SetCache::default_folder());
    auto found = certify::find_or_certify(
        *value.mesh, value.sha256, r, running.no_cache ? nullptr : &cache,
        {watch.hook(), [&](const std::string& text) { out.notes.push_back(text); }});
    if (!found) throw certify::TooCoarse(value.source.empty() ? "the mesh" : value.source);
    const certify::SetCertificate& c = found->set.certificate();
    const double diagonal = c.wrap ? c.wrap->diagonal : c.diagonal;
    if (std::string text = certify::warning_of(r.wanted_epsilon(), diagonal); !text.empty())
      out.notes.push_back(std::move(text));
    out.made = found->set;
    out.cached = found->cached;
    return out;
  });
}

constexpr const char* kConvexSetDoc =
    R"(Decomposes a solid into few convex bodies whose union provably contains it.

Options and defaults are those of bcd-decompose (docs/algorithms/convex-decomposition.md). A mesh
read from STEP or IGES is wrapped, so that its exact faces are covered.

Parameters
----------
mesh : mesh
epsilon_map : name of a file, or list of dict, optional
    Regions (boxes, half-spaces and balls in the coordinates of the bodies) with an epsilon each, as
    `bcd-decompose --epsilon-map` reads them, or its "regions": no point of the bodies in one is
    farther than that from the solid, and elsewhere `epsilon` counts (docs/formats.md, "Regions").
{keywords}

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
  for (const py::handle item : value) {
    const auto body = py::reinterpret_borrow<py::object>(item);
    const std::string name = io::default_name(set->bodies.size());
    if (auto points = points_of_core(body))
      set->bodies.push_back({name, {*std::move(points), {}}});
    else
      set->bodies.push_back({name, *mesh_of(body, "bodies").mesh});
  }
  return set;
}

py::list bodies_of(const std::shared_ptr<const geom::ConvexSet>& set) {
  py::list out;
  for (const geom::ConvexBody& body : set->bodies)
    out.append(MeshValue{.mesh = {set, &body.core}, .source = body.name});
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
  out["epsilon"] = p.epsilon ? py::object(py::float_(*p.epsilon)) : py::object(py::none());
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
  {
    py::options signatures;
    signatures.disable_function_signatures();  // the table's
    const std::string text =
        document("decompose", "mesh: object, *, epsilon_map: object = None",
                 keywords_of(certify::set_options()), "kaboum.CertifiedSet", kConvexSetDoc);
    module.def("decompose", &decompose, py::arg("mesh"), py::kw_only(),
               py::arg("epsilon_map") = py::none(), text.c_str());
  }
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
