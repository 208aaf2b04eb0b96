#include "prepared_original.h"

#include <kaboum/bcd/closure.h>
#include <kaboum/geom/prepare.h>

namespace kaboum::tools {

PreparedOriginal prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool close) {
  geom::PrepareOptions options;
  options.drop_sheets = drop_sheets;
  geom::Prepared prepared = geom::prepare(mesh, options);
  PreparedOriginal out{std::move(prepared.mesh), std::move(prepared.notes), 0,
                       std::move(prepared.source)};
  if (!close || prepared.closed) return out;
  const std::size_t before = out.mesh.triangles.size();
  out.mesh = bcd::close_holes(out.mesh);
  out.filled_triangles = out.mesh.triangles.size() - before;
  out.notes.push_back("its holes are filled with " + std::to_string(out.filled_triangles) +
                      " triangles, as bcd-decompose does: the claims are about that solid");
  return out;
}

}  // namespace kaboum::tools
