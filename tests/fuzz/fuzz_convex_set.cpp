// Any bytes given to parse_convex_set either make a set of valid bodies, which its container holds
// to the bit, or throw Error. The first byte selects the format.

#include <kaboum/io/convex_io.h>

#include <array>

#include "fuzz.h"

namespace {

using namespace kaboum;
using io::Format;

void require_valid(const geom::ConvexSet& set) {
  for (const geom::ConvexBody& body : set.bodies) {
    if (!(body.radius >= 0)) fuzz::broken("radius", std::to_string(body.radius));
    const bool is_rounded = body.radius > 0 && !body.core.vertices.empty();
    if (body.core.empty() && !is_rounded) fuzz::broken("empty body", body.name);
    for (const geom::Triangle& t : body.core.triangles)
      for (const std::uint32_t corner : t)
        if (corner >= body.core.vertices.size()) fuzz::broken("index", body.name);
    for (const geom::Vec3& v : body.core.vertices)
      if (!v.allFinite()) fuzz::broken("coordinate", body.name);
  }
}

void require_same(const geom::ConvexSet& a, const geom::ConvexSet& b) {
  if (a.bodies.size() != b.bodies.size()) fuzz::broken("read back", "another set");
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    if (a.bodies[i].core.vertices != b.bodies[i].core.vertices ||
        a.bodies[i].core.triangles != b.bodies[i].core.triangles ||
        a.bodies[i].radius != b.bodies[i].radius)
      fuzz::broken("read back", "body " + a.bodies[i].name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kFormats = {Format::Glb, Format::Gltf, Format::Obj};
  if (size == 0) return 0;
  const std::span<const char> bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  fuzz::survive([&] {
    const geom::ConvexSet set =
        io::parse_convex_set(bytes, kFormats[data[0] % kFormats.size()], "fuzz");
    require_valid(set);
    const std::vector<char> written = io::serialise_convex_set(set, io::SetFormat::Glb);
    const geom::ConvexSet once = io::parse_convex_set(written, Format::Glb, "written");
    // Vertices are numbered by their first use when read: the second time, nothing moves.
    require_same(once, io::parse_convex_set(io::serialise_convex_set(once, io::SetFormat::Glb),
                                            Format::Glb, "again"));
  });
  return 0;
}
