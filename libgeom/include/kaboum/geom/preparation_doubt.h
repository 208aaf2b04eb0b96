#pragma once

#include <kaboum/geom/prepare.h>

#include <algorithm>
#include <string>

namespace kaboum::geom {

/// Why the solid that preparing gave need not be all that the triangles enclose, in one clause;
/// empty: it is. What preparing notes as a warning is a guess: a hole's rim runs along a wall, or
/// triangles of a part that was open were turned to agree.
inline std::string doubt_about(const PreparationReport& report) {
  if (report.hollow)
    return "its surface crosses itself, and part of what it encloses is inside out, and would "
           "count "
           "as outside";
  const bool guessed = std::any_of(report.notes.begin(), report.notes.end(),
                                   [](const auto& note) { return note.starts_with("WARNING: "); });
  return guessed ? "it is open, and which solid is meant would be a guess" : "";
}

}  // namespace kaboum::geom
