#pragma once

#include <kaboum/certify/link_verdict.h>

#include <optional>
#include <string>
#include <vector>

/// What came of a robot's links, as a table of a terminal page.
namespace kaboum::tools {

/// A line of the table.
struct LinkLine {
  std::string name;
  std::size_t bodies = 0;
  std::optional<std::size_t> vertices;
  std::string epsilon;  ///< asked for
  double within = 0;    ///< certified: nothing is farther from the link's shapes [length]
  certify::Outcome outcome = certify::Outcome::Held;
  std::size_t dropped_sheets = 0;  ///< triangles of sheets dropped on request: they are outside
};

/// So many links have a line of their own.
inline constexpr std::size_t kLinesOfLinks = 11;

/// Lines of at most 80 columns; of many links those that are not as asked for and those with most
/// bodies, and one line for all others.
/// @param made  of what the links consist: "bodies"
/// @param unit  of lengths; of m they are shown in mm
std::vector<std::string> table_of(const std::vector<LinkLine>& links, const std::string& made,
                                  const std::string& unit);

}  // namespace kaboum::tools
