#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io {

class Output;

/// True when float32 holds the value exactly.
bool is_float(double value);
bool all_float(const geom::Mesh& mesh);

/// @param original  the vertices' numbers in the caller's mesh, for the message.
/// @throws Error{OutputFailed} naming the first vertex that float32 cannot hold, and the remedy.
void require_float(const geom::Mesh& mesh, const std::vector<std::uint32_t>& original,
                   std::string_view format);

/// `comment` as one line of printable characters.
std::string one_line(std::string_view comment);

/// A line per vertex, then a line per triangle that begins with its number of corners, 3.
void write_lines(Output& out, const geom::Mesh& mesh);

/// Unit normal of a facet, rounded to float; zero when it has no area.
Eigen::Vector3f facet_normal(const geom::Mesh& mesh, const geom::Triangle& t);

}  // namespace kaboum::io
