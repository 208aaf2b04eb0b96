// A mesh as the programs that simplify prepare it.

#include "prepared_original.h"

namespace kaboum::tools {

geom::Prepared prepare_original(const geom::Mesh& mesh, bool drop_sheets, bool fill) {
  geom::PrepareOptions options;
  options.drop_sheets = drop_sheets;
  options.holes = fill ? geom::Holes::Fill : geom::Holes::Keep;
  return geom::prepare(mesh, options);
}

}  // namespace kaboum::tools
