// Meshes of robots as they are judged.

#include <kaboum/base/sha256.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/robot_verdict.h>

#include <utility>

namespace kaboum::verify {

MeshFile read_mesh_file(const std::string& path, std::size_t exact_points) {
  MeshFile file{path, {}, {}};
  try {
    std::vector<char> bytes;
    io::ReadResult read = io::read_mesh(path, {}, &bytes);
    file.sha256 = sha256(bytes);
    if (exact_points > 0 && io::is_cad(read.format))
      file.exact = read_exact_points(bytes, read.format, path, exact_points, 1, read.exact_faces);
    file.mesh = std::move(read.mesh);
    file.quads = std::move(read.bent_quads);
    file.notes = std::move(read.notes);
  } catch (const Error& error) {
    if (!is_of_one_mesh(error)) throw;
    file.sha256 = sha256(io::read_file(path));
    file.error = error;
  }
  return file;
}

}  // namespace kaboum::verify
