// Bytes of meshes, read back and compared before anything is said of them.

#include <kaboum/base/error.h>
#include <kaboum/certify/mesh_bytes.h>

namespace kaboum::certify {
namespace {

/// The bytes must read back as the result's triangles.
void check_readback(const std::vector<char>& bytes, io::Format format, const geom::Mesh& mesh) {
  if (mesh.triangles.empty()) return;
  const io::ReadResult back = io::parse_mesh(bytes, format, "the result");
  std::size_t at = 0;
  const auto collapsed = [&](const geom::Triangle& t) {
    return mesh.vertices[t[0]] == mesh.vertices[t[1]] ||
           mesh.vertices[t[1]] == mesh.vertices[t[2]] || mesh.vertices[t[2]] == mesh.vertices[t[0]];
  };
  for (const geom::Triangle& t : mesh.triangles) {
    if (collapsed(t)) continue;
    ensure(at < back.mesh.triangles.size(), "the written mesh lost a triangle");
    for (int k = 0; k < 3; ++k)
      ensure(back.mesh.vertices[back.mesh.triangles[at][k]] == mesh.vertices[t[k]],
             "a coordinate changed when it was written");
    ++at;
  }
  ensure(at == back.mesh.triangles.size(), "the written mesh gained a triangle");
}

}  // namespace

std::vector<char> serialise_checked(const geom::Mesh& mesh, io::Format format,
                                    bool double_precision, const std::string& comment) {
  io::WriteOptions options;
  options.double_precision = double_precision;
  options.comment = comment;
  std::vector<char> bytes = io::serialise_mesh(mesh, format, options);
  check_readback(bytes, format, mesh);
  return bytes;
}

}  // namespace kaboum::certify
