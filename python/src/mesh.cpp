// Meshes: arrays in and out, files.

#include "mesh.h"

#include <kaboum/geom/float32.h>

#include <algorithm>
#include <filesystem>

#include "arguments.h"
#include "running.h"

namespace kaboum::python {
namespace {

static_assert(sizeof(geom::Vec3) == 3 * sizeof(double));
static_assert(sizeof(geom::Triangle) == 3 * sizeof(std::uint32_t));

[[noreturn]] void refuse(const char* argument, const std::string& why) {
  throw Error(ErrorCode::InvalidArgument, std::string(argument) + ": " + why);
}

/// @return #rows, of an array that has three columns
std::size_t rows_of(const py::array& array, const char* argument, const char* what) {
  if (array.ndim() == 2 && array.shape(1) == 3) return static_cast<std::size_t>(array.shape(0));
  std::string shape;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    shape += (i == 0 ? "" : " x ") + std::to_string(array.shape(i));
  const bool quads = array.ndim() == 2 && array.shape(1) == 4;
  refuse(argument, std::string(what) + " must be an array of n x 3 numbers, not " +
                       (shape.empty() ? "a single value" : shape) +
                       (quads ? "; split quadrilaterals into triangles" : ""));
}

template <class Index>
std::vector<geom::Triangle> copy_faces(const py::array& value, const char* argument,
                                       std::size_t vertices) {
  const auto array = py::array_t<Index, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) throw py::error_already_set();
  std::vector<geom::Triangle> out(rows_of(array, argument, "faces"));
  const Index* index = array.data();
  for (std::size_t t = 0; t < out.size(); ++t)
    for (std::uint32_t& v : out[t]) {
      const Index i = *index++;
      if (static_cast<std::uint64_t>(i) >= vertices)  // so are those below 0
        throw Error(ErrorCode::InvalidInput, std::string(argument) + ": face " + std::to_string(t) +
                                                 " names vertex " + std::to_string(i) +
                                                 ", but there are " + std::to_string(vertices));
      v = static_cast<std::uint32_t>(i);
    }
  return out;
}

geom::Mesh mesh_from(const py::object& vertices, const py::object& faces, const char* argument) {
  geom::Mesh mesh;
  mesh.vertices = points_of(vertices, argument);
  if (mesh.vertices.size() >= 0xFFFFFFFE) refuse(argument, "it has too many vertices");
  const py::array indices = py::array::ensure(faces);
  if (!indices) {
    PyErr_Clear();
    refuse(argument, "faces must be an array of n x 3 whole numbers");
  }
  const char kind = indices.dtype().kind();
  if (kind != 'i' && kind != 'u' && indices.size() > 0)
    refuse(argument, "faces must be whole numbers (indices of vertices)");
  mesh.triangles = kind == 'u' ? copy_faces<std::uint64_t>(indices, argument, mesh.vertices.size())
                               : copy_faces<std::int64_t>(indices, argument, mesh.vertices.size());
  return mesh;
}

MeshValue read(const std::string& path, std::optional<io::Format> known) {
  return run(0, [&] {
    std::vector<char> bytes;
    io::ReadResult read = io::read_mesh(path, known, &bytes);
    MeshValue out{std::make_shared<geom::Mesh>(std::move(read.mesh)), path, io::sha256(bytes),
                  read.unit, std::move(read.notes)};
    if (read.collapsed_triangles > 0)
      out.notes.push_back(std::to_string(read.collapsed_triangles) +
                          " triangles with repeated corners bound nothing and are left out");
    out.bent_quads = std::move(read.bent_quads);
    if (io::is_cad(read.format)) {
      out.deviation = read.deviation;
      out.exact_faces = read.exact_faces;
      out.format = read.format;
    }
    return out;
  });
}

bool is_float32(const geom::Mesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const geom::Vec3& v) { return geom::is_float32(v); });
}

void write(const py::object& mesh, const py::object& path, const std::optional<std::string>& format,
           const std::string& precision) {
  const MeshValue value = mesh_of(mesh, "mesh");
  const auto file = path_of(path);
  if (!file) refuse("path", "it must be a str or an os.PathLike");
  auto known = format_of(format, "format");
  if (!known) known = io::format_from_name(std::filesystem::path(*file).extension().string());
  if (!known) refuse("path", "no format is known by the extension of '" + *file + "'; give format");
  if (precision != "auto" && precision != "float" && precision != "double")
    refuse_name("precision", precision, {"auto", "float", "double"});
  run(0, [&] {
    geom::require_valid(*value.mesh);
    const bool fine = precision == "double" ||
                      (precision == "auto" && io::holds_double(*known) && !is_float32(*value.mesh));
    io::write_file(
        *file, io::serialise_mesh(*value.mesh, *known,
                                  {.double_precision = fine, .comment = "KABouM " KABOUM_VERSION}));
  });
}

std::string describe(const MeshValue& m) {
  return "<kaboum.Mesh of " + std::to_string(m.mesh->vertices.size()) + " vertices, " +
         std::to_string(m.mesh->triangles.size()) + " faces>";
}

void bind_mesh_class(py::module_& module) {
  py::class_<MeshValue>(module, "Mesh", R"(A triangle mesh, which never changes.

It may be given wherever a mesh is expected, here and to libraries that take `vertices` and `faces`.)")
      .def(py::init([](const py::object& vertices, const py::object& faces) {
             return MeshValue{std::make_shared<geom::Mesh>(mesh_from(vertices, faces, "Mesh"))};
           }),
           py::arg("vertices"), py::arg("faces"), R"(Copies the arrays.

Parameters
----------
vertices : n x 3 numbers
    In any unit of length; results have the same one. Nothing is rounded: numbers of other types
    than float64 (integers, long doubles) must be float64 numbers.
faces : m x 3 whole numbers
    Indices of vertices, counter-clockwise seen from outside.

Raises
------
Error
    'invalid_argument' on other shapes and on numbers that are no float64, naming the first;
    'invalid_input' on indices out of range.)")
      .def_property_readonly(
          "vertices", [](const MeshValue& m) { return vertices_of(m.mesh); },
          "n x 3 float64, a view that cannot be written. [length]")
      .def_property_readonly(
          "faces", [](const MeshValue& m) { return faces_of(m.mesh); },
          "m x 3 uint32, a view that cannot be written.")
      .def_readonly("source", &MeshValue::source, "Name of the file it was read from, or ''.")
      .def_readonly("sha256", &MeshValue::sha256, "Of that file, or ''.")
      .def_readonly("unit", &MeshValue::unit,
                    "Unit of length where the file states it or its format has one, else ''.")
      .def_readonly("deviation", &MeshValue::deviation,
                    "Of STEP and IGES: the exact faces, which the faces here stand for, are no "
                    "farther from them. Else 0. [length]")
      .def_property_readonly("notes", notes_of(&MeshValue::notes),
                             "What a user should know of the reading.")
      .def_property_readonly(
          "volume", [](const MeshValue& m) { return geom::signed_volume(*m.mesh); },
          "Signed volume, rounded. [length^3]")
      .def_property_readonly(
          "diagonal", [](const MeshValue& m) { return geom::bounding_box(*m.mesh).diagonal(); },
          "Diagonal of the bounding box, which percentages refer to. [length]")
      .def("__repr__", &describe);
}

}  // namespace

std::vector<geom::Vec3> points_of(const py::object& value, const char* argument) {
  const py::array given = array_from(value);
  if (!given) {
    PyErr_Clear();
    refuse(argument, "vertices must be numbers");
  }
  const std::size_t rows = rows_of(given, argument, "vertices");
  require_doubles(given, std::string(argument) + ": vertices");
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) {
    PyErr_Clear();
    refuse(argument, "vertices must be numbers");
  }
  std::vector<geom::Vec3> out(rows);
  const double* p = array.data();
  for (geom::Vec3& v : out) {
    v = Eigen::Map<const geom::Vec3>(p);
    p += 3;
  }
  return out;
}

MeshValue mesh_of(const py::object& value, const char* argument) {
  if (py::isinstance<MeshValue>(value)) return value.cast<MeshValue>();
  if (py::isinstance<PreparedValue>(value)) return {value.cast<PreparedValue>().mesh()};
  if (const auto path = path_of(value)) return read(*path, {});
  if ((py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) && py::len(value) == 2)
    return {
        std::make_shared<geom::Mesh>(mesh_from(value[py::int_(0)], value[py::int_(1)], argument))};
  if (py::hasattr(value, "vertices") && py::hasattr(value, "faces"))
    return {std::make_shared<geom::Mesh>(
        mesh_from(value.attr("vertices"), value.attr("faces"), argument))};
  refuse(argument,
         "a mesh is a kaboum.Mesh, the name of a file, a pair (vertices, faces), or something with "
         "vertices and faces, not " +
             py::str(py::type::of(value).attr("__name__")).cast<std::string>());
}

py::array_t<double> vertices_of(const std::shared_ptr<const geom::Mesh>& mesh) {
  return view_of(reinterpret_cast<const double*>(mesh->vertices.data()),
                 {static_cast<py::ssize_t>(mesh->vertices.size()), 3}, mesh);
}

py::array_t<std::uint32_t> faces_of(const std::shared_ptr<const geom::Mesh>& mesh) {
  return view_of(reinterpret_cast<const std::uint32_t*>(mesh->triangles.data()),
                 {static_cast<py::ssize_t>(mesh->triangles.size()), 3}, mesh);
}

py::array_t<double> array_of(const geom::Vec3& p) { return row_of(3, p.data()); }

void bind_meshes(py::module_& module) {
  bind_mesh_class(module);
  module.def(
      "read",
      [](const py::object& path, const std::optional<std::string>& format,
         const std::optional<std::string>& importer) {
        const auto file = path_of(path);
        if (!file) refuse("path", "it must be a str or an os.PathLike");
        if (importer && *importer != "assimp")
          refuse("importer", "it must be 'assimp', not '" + *importer + "'");
        if (importer && format)
          refuse("importer", "it is told the format by the file's name; leave format out");
        return read(*file, importer ? io::Format::Assimp : format_of(format, "format"));
      },
      py::arg("path"), py::kw_only(), py::arg("format") = py::none(),
      py::arg("importer") = py::none(), R"(Reads a mesh file.

Coordinates are the doubles nearest to the numbers in the file; equal vertices are merged.

Parameters
----------
path : str or os.PathLike
    STL, OBJ, PLY, OFF, VRML, X3D, COLLADA, 3MF, glTF, FBX, STEP or IGES.
format : str, optional
    'stl', 'ply', ...; by default by the extension.
importer : str, optional
    'assimp': have assimp read files of formats that have no reader here (3DS, LWO, AC3D, DXF, X,
    ...: docs/formats.md). It delivers float32 and leaves out without a message what it does not
    know: all that is claimed of the mesh is about the triangles that it delivered. Its notes say
    so.

Raises
------
Error
    'invalid_input' naming file and place; 'not_built'; 'limit_reached'.)");
  module.def("write", &write, py::arg("mesh"), py::arg("path"), py::kw_only(),
             py::arg("format") = py::none(), py::arg("precision") = "auto",
             R"(Writes a mesh so that the file holds either what it held before or all of the new.

Reading it back gives the same coordinates, bit for bit.

Parameters
----------
mesh : mesh
path : str or os.PathLike
format : str, optional
    By default by the extension.
precision : str
    'auto': float32, or float64 where float32 would change coordinates and the format can hold it;
    'float'; 'double'.

Raises
------
Error
    'output_failed' when the format cannot hold the coordinates, or the file cannot be written.)");
}

}  // namespace kaboum::python
