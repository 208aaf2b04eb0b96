#pragma once

#include <kaboum/base/parallel.h>

namespace kaboum::geom {
using kaboum::parallel_calls;
using kaboum::parallel_loop;
}  // namespace kaboum::geom
