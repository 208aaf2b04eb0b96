// Any bytes given to parse_progressive either make a file whose levels are valid meshes, and which
// the checker verifies or refutes, or throw Error.

#include <kaboum/base/error.h>
#include <kaboum/bmesh/extract.h>
#include <kaboum/verify/replay.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace bmesh = kaboum::bmesh;
  namespace verify = kaboum::verify;
  // The checksum is mended, or hardly anything would be looked at.
  std::vector<char> bytes(data, data + size);
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(sum >> (8 * i)));
  try {
    const bmesh::Progressive p = bmesh::parse_progressive(bytes, "fuzz");
    verify::replay_progressive(p.base, p);
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
