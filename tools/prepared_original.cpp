#include "prepared_original.h"

#include <kaboum/geom/error.h>

#include "verdict.h"

namespace kaboum::tools {

geom::Prepared prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool fill) {
  geom::PrepareOptions options;
  options.drop_sheets = drop_sheets;
  options.holes = fill ? geom::Holes::Fill : geom::Holes::Keep;
  return geom::prepare(mesh, options);
}

std::optional<InsideOut> find_inside_out(const geom::Mesh& mesh) {
  try {
    const geom::Prepared prepared = prepare_original(mesh, true, false);
    if (prepared.inside_out.empty()) return {};
    InsideOut out{prepared.turned_components, prepared.inside_out.front(), geom::Vec3::Zero()};
    for (const std::uint32_t v : mesh.triangles[out.triangle]) out.at += mesh.vertices[v] / 3;
    return out;
  } catch (const Error&) {
    return {};
  }
}

std::string text_of(const InsideOut& found) {
  return std::to_string(found.parts) + (found.parts == 1 ? " part of it is" : " parts of it are") +
         " inside out (the first at triangle " + std::to_string(found.triangle) + ", at " +
         point(found.at) +
         "): as the file is, what that encloses is not in the solid, and nothing is decided about "
         "it; --prepare turns it and judges that solid";
}

}  // namespace kaboum::tools
