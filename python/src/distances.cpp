// Distances: kaboum.hausdorff and write_heatmap, as hausdorff-eval.

#include <kaboum/distance/compare_options.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/page/distance_page.h>

#include <filesystem>

#include "arguments.h"
#include "convex_set.h"
#include "mesh.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

struct Distances {
  distance::Compared found;
  double diagonal = 0;
};

py::dict one_way(const distance::OneWay& way) {
  py::dict out;
  out["max"] = py::make_tuple(way.max.max_lower, way.max.max_upper);
  out["at"] = array_of(way.max.at);
  out["nearest"] = array_of(way.nearest);
  out["mean"] = way.sampled.mean.value;
  out["mean_error"] = way.sampled.mean.standard_error;
  out["rms"] = way.sampled.rms.value;
  out["rms_error"] = way.sampled.rms.standard_error;
  out["within_gap"] = way.max.within_gap;
  return out;
}

/// A set where there is one, in a file too; else a mesh.
distance::Shape shape_of(const py::object& value, const char* name) {
  distance::Shape out{name, {}, {}};
  const bool set = py::isinstance<SetValue>(value) || py::isinstance<CertifiedSetValue>(value) ||
                   (py::isinstance<py::list>(value) && py::len(value) != 2);
  if (set)
    out.set = *set_of(value);
  else if (const auto path = path_of(value))
    out.set = io::find_convex_set(*path);
  if (!out.set) out.mesh = *mesh_of(value, name).mesh;
  return out;
}

Distances hausdorff(const py::object& a, const py::object& b, const py::kwargs& given) {
  distance::CompareOptions options;
  const RunKeywords running =
      take_keywords("hausdorff", distance::compare_options(), given, options, Runs::Threads);
  distance::Shape first = shape_of(a, "a"), second = shape_of(b, "b");
  Watch watch(running.progress);
  options.progress = watch.hook();
  return run(running.threads, [&] {
    const distance::Comparison comparison(std::move(first), std::move(second), options);
    return Distances{comparison.measure(), comparison.diagonal()};
  });
}

/// What a shape is called on a page.
std::string name_of(const py::object& shape, const char* argument) {
  const auto path = path_of(shape);
  return path ? std::filesystem::path(*path).filename().string() : argument;
}

Distances write_heatmap(const py::object& file, const py::object& a, const py::object& b,
                        const py::kwargs& given) {
  const std::string path = required_path(file, "file");
  if (!page::is_heatmap(path))
    throw Error(ErrorCode::InvalidArgument, "file: give a .png, .html or .ply file, not " + path);
  distance::CompareOptions options;
  const RunKeywords running =
      take_keywords("write_heatmap", distance::compare_options(), given, options, Runs::Threads);
  distance::Shape first = shape_of(a, "a"), second = shape_of(b, "b");
  const std::array<std::string, 2> names{name_of(a, "a"), name_of(b, "b")};
  Watch watch(running.progress);
  options.progress = watch.hook();
  return run(running.threads, [&] {
    const distance::Comparison comparison(std::move(first), std::move(second), options);
    Distances out{comparison.measure(), comparison.diagonal()};
    watch("colours");
    io::write_file(path, page::heatmap(path, {comparison, out.found, names, options.solid}));
    return out;
  });
}

void bind_distances_class(py::module_& module) {
  py::class_<Distances>(module, "Distances",
                        R"(Distances between two shapes; brackets are certified. [length])")
      .def_property_readonly(
          "lower", [](const Distances& d) { return d.found.lower(); },
          "The Hausdorff distance is at least this.")
      .def_property_readonly(
          "upper", [](const Distances& d) { return d.found.upper(); },
          "The Hausdorff distance is at most this.")
      .def_property_readonly(
          "minimum",
          [](const Distances& d) { return py::make_tuple(d.found.min.lower, d.found.min.upper); },
          "Bracket of the smallest distance.")
      .def_property_readonly(
          "a_to_b", [](const Distances& d) { return one_way(d.found.a_to_b); },
          "A dict: 'max' (a bracket), reached at 'at', whose nearest point is "
          "'nearest'; 'mean' and 'rms' with standard errors 'mean_error' and "
          "'rms_error', which are estimates; 'within_gap'.")
      .def_property_readonly(
          "b_to_a", [](const Distances& d) { return one_way(d.found.b_to_a); },
          "The same the other way.")
      .def_readonly("diagonal", &Distances::diagonal, "Of the bounding box of both.")
      .def("__repr__", [](const Distances& d) {
        return "<kaboum.Distances: Hausdorff distance in [" +
               py::repr(py::float_(d.found.lower())).cast<std::string>() + ", " +
               py::repr(py::float_(d.found.upper())).cast<std::string>() + "]>";
      });
}

constexpr const char* kDistancesDoc =
    R"(Distances between two surfaces, or two solids, both ways, as hausdorff-eval.

Parameters
----------
a, b : mesh, or ConvexSet, whose union's boundary counts
{keywords}

Raises
------
Error
    'invalid_input': no triangles, numbers that are not finite, no solid.)";

constexpr const char* kHeatmapDoc =
    R"(Measures distances as `hausdorff`, and draws them, as `hausdorff-eval --heatmap`.

Parameters
----------
file : path
    .png draws both shapes with a scale, .html is a page that shows them in a browser, .ply is the
    first one with colours and the distance as `quality`.
a, b
    As for `hausdorff`.
{keywords}

Returns
-------
Distances)";

}  // namespace

void bind_distances(py::module_& module) {
  bind_distances_class(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text =
      document("hausdorff", "a: object, b: object", keywords_of(distance::compare_options()),
               "kaboum.Distances", kDistancesDoc, Runs::Threads);
  module.def("hausdorff", &hausdorff, py::arg("a"), py::arg("b"), text.c_str());
  const std::string drawing = document("write_heatmap", "file: object, a: object, b: object",
                                       keywords_of(distance::compare_options()), "kaboum.Distances",
                                       kHeatmapDoc, Runs::Threads);
  module.def("write_heatmap", &write_heatmap, py::arg("file"), py::arg("a"), py::arg("b"),
             drawing.c_str());
}

}  // namespace kaboum::python
