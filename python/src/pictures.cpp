// Pictures: kaboum.draw, as mesh-picture; how pictures and pages are written.

#include "pictures.h"

#include <kaboum/io/convex_io.h>
#include <kaboum/picture/bodies.h>
#include <kaboum/picture/panels.h>
#include <kaboum/picture/png_file.h>

#include <filesystem>

#include "arguments.h"
#include "convex_set.h"
#include "mesh.h"
#include "request_options.h"
#include "running.h"

namespace kaboum::python {
namespace {

std::string extension_of(const std::string& file) {
  return std::filesystem::path(file).extension().string();
}

/// A mesh, or the bodies of a set.
geom::Mesh shape_of(const py::object& value) {
  const auto path = path_of(value);
  const bool set =
      path ? io::format_from_name(extension_of(*path)) == io::Format::Glb
           : py::isinstance<SetValue>(value) || py::isinstance<CertifiedSetValue>(value);
  if (set) return picture::surfaces_of(*set_of(value));
  return *mesh_of(value, "shapes").mesh;
}

py::bytes draw(const py::object& shapes, const py::object& file, const py::kwargs& given) {
  picture::PanelOptions options;
  take_keywords("draw", picture::panel_options(), given, options, Runs::Briefly);
  std::vector<geom::Mesh> meshes;
  if (py::isinstance<py::list>(shapes))
    for (const py::handle shape : shapes)
      meshes.push_back(shape_of(py::reinterpret_borrow<py::object>(shape)));
  else
    meshes.push_back(shape_of(shapes));
  return png_bytes(file, [&] { return picture::encode_png(draw_panels(meshes, options)); });
}

constexpr const char* kPicturesDoc =
    R"(Draws shapes side by side, one camera for all, as mesh-picture.

Parameters
----------
shapes : mesh, ConvexSet, or list of these
    Files that end with .glb are sets.
file : path, optional
    A .png, which is written.
{keywords}

Returns
-------
bytes
    Of the PNG.)";

}  // namespace

void write_preview(const py::object& file, const std::function<std::string()>& page,
                   const std::function<std::vector<char>()>& picture) {
  const std::string path = required_path(file, "file");
  const std::string extension = extension_of(path);
  if (extension == ".html") {
    run(0, [&] { io::write_file(path, page()); });
  } else if (extension == ".png" && picture) {
    run(0, [&] { io::write_file(path, picture()); });
  } else {
    throw Error(ErrorCode::InvalidArgument,
                std::string(picture ? "a picture or a page" : "a page") +
                    " is written: give a name that ends with " + (picture ? ".png or " : "") +
                    ".html, not " + path);
  }
}

py::bytes png_bytes(const py::object& file, const std::function<std::vector<char>()>& picture) {
  std::string path;
  if (!file.is_none()) {
    path = required_path(file, "file");
    if (extension_of(path) != ".png")
      throw Error(ErrorCode::InvalidArgument,
                  "a PNG is written: give a name that ends with .png, not " + path);
  }
  const std::vector<char> bytes = run(0, [&] {
    std::vector<char> out = picture();
    if (!path.empty()) io::write_file(path, out);
    return out;
  });
  return {bytes.data(), bytes.size()};
}

void bind_pictures(py::module_& module) {
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text =
      document("draw", "shapes: object, file: object = None", keywords_of(picture::panel_options()),
               "bytes", kPicturesDoc, Runs::Briefly);
  module.def("draw", &draw, py::arg("shapes"), py::arg("file") = py::none(), text.c_str());
}

}  // namespace kaboum::python
