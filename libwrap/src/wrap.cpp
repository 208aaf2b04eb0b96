// An enclosing closed mesh of any triangles: cells, their boundary, steps towards the input.
#include <kaboum/base/error.h>
#include <kaboum/wrap/wrap.h>

#include <cmath>

#include "boundary_of_cells.h"
#include "cells.h"
#include "fit.h"
#include "obstacle.h"
#include "simplify.h"
#include "surface.h"

namespace kaboum::wrap {
namespace {

void require_sound(const geom::Mesh& input, const WrapOptions& o) {
  for (const double length : {o.offset, o.seal})
    if (!(length > 0) || !std::isfinite(length))
      throw Error(ErrorCode::InvalidArgument, "the offset and the gap to seal must be above 0");
  if (!(o.clearance >= 0 && 3 * o.clearance <= o.offset))
    throw Error(ErrorCode::InvalidArgument,
                "the wrap's clearance must be between 0 and a third of its offset");
  if (input.triangles.empty())
    throw Error(ErrorCode::InvalidInput, "there are no triangles to wrap");
  geom::require_valid(input);
}

/// The surface may go into one layer of sealed cells: half a gap deep at most.
constexpr double kDepth = 0.5;

/// Cells outside, with those the input meets taken away, and the same with these.
struct Cells {
  BitGrid outside, open;
};

Cells cells_of(const Lattice& lattice, const geom::Mesh& input, double radius, double clearance) {
  BitGrid occupied = occupied_cells(lattice, input);
  if (clearance > 0) occupied = dilated(occupied, clearance / lattice.side * (1 + 1e-12) + 1e-12);
  BitGrid outside = dilated(flooded(dilated(occupied, radius)), radius);
  BitGrid open = dilated(outside, kDepth);
  for (int z = 0; z < lattice.size[2]; ++z) {
    for (int y = 0; y < lattice.size[1]; ++y) {
      const auto met = occupied.row(y, z);
      const auto out = outside.row(y, z);
      const auto either = open.row(y, z);
      for (std::size_t i = 0; i < met.size(); ++i) {
        either[i] |= met[i];
        out[i] &= ~met[i];
      }
    }
  }
  return {std::move(outside), std::move(open)};
}

}  // namespace

Wrap wrap(const geom::Mesh& input, const WrapOptions& options) {
  require_sound(input, options);
  const auto say = [&](const char* stage) {
    if (options.progress) options.progress(stage);
  };
  Wrap result;
  result.cell = side_above(options.seal / 2);
  const double radius = options.seal / 2 / result.cell;
  const int border = reach(radius) + reach(options.clearance / result.cell + 0.1) + 1;
  say("cells");
  const Lattice lattice = lattice_round(geom::bounding_box(input), result.cell, border,
                                        options.float32, options.max_cells);
  for (const int n : lattice.size)
    result.cells = (result.cells == 0 ? 1 : result.cells) * static_cast<std::size_t>(n);
  const Cells cells = cells_of(lattice, input, radius, options.clearance);
  say("boundary");
  geom::Mesh first = boundary_of_cells(lattice, cells.outside);
  result.first_triangles = first.triangles.size();
  const Obstacle obstacle(input, options.clearance);
  Surface surface(std::move(first), obstacle, options.float32);
  const Room room{lattice, cells.open, options.clearance, options.offset};
  Fit fit(surface, obstacle, room);
  say("vertices");
  fit.approach();
  say("edges");
  simplify(surface, obstacle, room, fit);
  fit.settle();
  fit.refine();
  fit.settle();
  simplify(surface, obstacle, room, fit);
  result.mesh = surface.mesh();
  return result;
}

}  // namespace kaboum::wrap
