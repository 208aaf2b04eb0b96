// Any bytes given to parse_mesh either make a valid mesh or throw Error. The first byte selects the
// format. FBX, which assimp reads, is left out: its own robustness is not ours to fuzz.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <array>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using kaboum::io::Format;
  constexpr std::array kFormats = {Format::Stl,  Format::Obj, Format::Ply,     Format::Off,
                                   Format::Vrml, Format::X3d, Format::Collada, Format::ThreeMf,
                                   Format::Glb,  Format::Gltf};
  if (size == 0) return 0;
  const Format format = kFormats[data[0] % kFormats.size()];
  const std::span<const char> bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const kaboum::io::ReadResult result = kaboum::io::parse_mesh(bytes, format, "fuzz");
    if (result.mesh.triangles.empty()) std::abort();
    for (const auto& t : result.mesh.triangles)
      for (const std::uint32_t corner : t)
        if (corner >= result.mesh.vertices.size()) std::abort();
    for (const auto& p : result.mesh.vertices)
      if (!p.allFinite()) std::abort();
  } catch (const kaboum::Error& e) {
    if (e.code() == kaboum::ErrorCode::Internal) std::abort();
  }
  return 0;
}
