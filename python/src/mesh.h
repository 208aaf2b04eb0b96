#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>
#include <pybind11/numpy.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.h"

/// Meshes that Python holds.
namespace kaboum::python {

/// Shared and never changed, so that arrays may look into it.
struct MeshValue {
  std::shared_ptr<const geom::Mesh> mesh;
  std::string source = {}, sha256 = {};  ///< of the file it was read from; else empty
  std::string unit = {};                 ///< where the file states it
  std::vector<std::string> notes = {};   ///< of the reader
  double deviation = 0;  ///< of exact faces from the triangles; 0: there are none [length]
  std::size_t exact_faces = 0;
  std::vector<std::uint32_t> bent_quads = {};  ///< io::ReadResult::bent_quads
  std::optional<io::Format> format = {};       ///< of the file, where it has exact faces
};

struct PreparedValue {
  std::shared_ptr<const geom::Prepared> prepared;

  [[nodiscard]] std::shared_ptr<const geom::Mesh> mesh() const {
    return {prepared, &prepared->solid.mesh()};
  }
};

/// A Mesh or Prepared; the name of a file; a pair of vertices and faces; or whatever has `vertices`
/// and `faces` as trimesh.Trimesh does.
/// @param argument  that errors name
/// @throws Error{InvalidArgument} on anything else; Error{InvalidInput} on indices out of range;
///   as io::read_mesh.
MeshValue mesh_of(const py::object& value, const char* argument);

/// The rows of an array of n x 3 numbers, which must be doubles all the same where they are of
/// another type.
/// @throws Error{InvalidArgument} naming the argument
std::vector<geom::Vec3> points_of(const py::object& value, const char* argument);

/// A view of values that `owner` keeps, which cannot be written: nothing is copied.
template <class Scalar>
py::array_t<Scalar> view_of(const Scalar* data, std::vector<py::ssize_t> shape,
                            std::shared_ptr<const void> owner) {
  auto* kept = new std::shared_ptr<const void>(std::move(owner));
  const py::capsule base(kept,
                         [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  py::array_t<Scalar> out(std::move(shape), data, base);
  out.attr("setflags")(py::arg("write") = false);
  return out;
}

py::array_t<double> vertices_of(const std::shared_ptr<const geom::Mesh>& mesh);
py::array_t<std::uint32_t> faces_of(const std::shared_ptr<const geom::Mesh>& mesh);

/// An array of n values, copied where there are some to copy. By its shape: pybind11 before 2.12
/// takes the strides of an array that is made by its size from NumPy's descriptors, which are
/// others from NumPy 2 on, so that all values would be at one place.
template <class Scalar>
py::array_t<Scalar> row_of(std::size_t n, const Scalar* values = nullptr) {
  return py::array_t<Scalar>(std::vector<py::ssize_t>{static_cast<py::ssize_t>(n)}, values);
}

/// An array of three numbers.
py::array_t<double> array_of(const geom::Vec3& p);

}  // namespace kaboum::python
