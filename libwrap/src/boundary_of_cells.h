#pragma once

#include <kaboum/geom/mesh.h>

#include "cells.h"

namespace kaboum::wrap {

/// The boundary between the cells outside and the others, seen from outside: two triangles for each
/// face. Where more than two faces meet at an edge, those that bound the same outer cell are
/// joined; where several fans meet in a corner of the lattice, each has a vertex of its own. So
/// every edge has two triangles.
/// @pre no cell at the lattice's border is inside
geom::Mesh boundary_of_cells(const Lattice& lattice, const BitGrid& outside);

}  // namespace kaboum::wrap
