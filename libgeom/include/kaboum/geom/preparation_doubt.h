#pragma once

#include <kaboum/geom/prepare.h>

#include <string>

namespace kaboum::geom {

/// Why the solid that preparing gave need not be all that the triangles enclose, in one clause;
/// empty: it is.
inline std::string doubt_about(const PreparationReport& report) {
  if (report.hollow)
    return "its surface crosses itself, and part of what it encloses is inside out, and would "
           "count as outside";
  return report.guessed ? "it is open, and which solid is meant would be a guess" : "";
}

}  // namespace kaboum::geom
