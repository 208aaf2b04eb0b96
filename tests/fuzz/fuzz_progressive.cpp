// Any bytes given to parse_progressive either make a file whose levels are valid meshes, and which
// the checker verifies or refutes, or throw Error.

#include <kaboum/bmesh/progressive.h>
#include <kaboum/geom/error.h>

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace bmesh = kaboum::bmesh;
  try {
    const bmesh::Progressive p =
        bmesh::parse_progressive({reinterpret_cast<const char*>(data), size}, "fuzz");
    bmesh::replay_progressive(p.base, p);
    for (const std::size_t n : {std::size_t{4}, p.base.vertices.size() / 2}) {
      const kaboum::geom::Mesh mesh = bmesh::extract(p, n, "fuzz").mesh;
      for (const auto& t : mesh.triangles)
        for (const std::uint32_t corner : t)
          if (corner >= mesh.vertices.size()) std::abort();
      for (const auto& v : mesh.vertices)
        if (!v.allFinite()) std::abort();
    }
  } catch (const kaboum::Error& e) {
    if (e.code() == kaboum::ErrorCode::Internal) std::abort();
  }
  return 0;
}
