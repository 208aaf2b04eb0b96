#pragma once

#include <kaboum/io/mesh_io.h>

#include <optional>
#include <string>

namespace kaboum::io {

/// The name of a unit of so many metres: one of kLengthUnits, where it is one but for the rounding
/// of one product or quotient; else "0.005 m", whose digits give the double back.
std::string unit_of_metres(double metres);

/// ReadResult::unit in metres; nullopt where it says nothing.
std::optional<double> metres_of(const std::string& unit);

/// Multiplies all coordinates by `factor`: each becomes the double nearest to the product. What is
/// claimed of the mesh later is about these. Vertices that become equal are merged, triangles that
/// have equal corners then are dropped and counted as collapsed; the unit that the file states
/// becomes that of the new coordinates; a note says what was done.
/// @param name  of the file, for messages.
/// @throws Error{InvalidArgument} unless the factor is positive and finite; Error{InvalidInput}
///   where a coordinate would leave the range of doubles, or no triangle is left.
void scale(ReadResult& read, double factor, const std::string& name);

/// A bound of distances from the mesh as read that holds of the mesh as scaled, too: the product,
/// rounded up, and what rounding the coordinates may have moved the triangles by. [length]
double scaled_bound(double bound, double factor, const geom::Mesh& scaled);

/// The factor in the record of what a result was made with ("--epsilon 1% --scale 0.001"); 1: none.
/// @param file  whose record it is, for the message.
/// @throws Error{InvalidInput} where the record states a factor that is no positive number.
double recorded_scale(const std::string& record, const std::string& file = "the set");

/// Refuses to judge a result beside another scale of its input than it was made with.
/// @param record  what the result's file says it was made with
/// @throws Error{InvalidInput} naming the result's file, and the option.
void require_recorded_scale(const std::string& file, const std::string& record, double factor);

/// Refuses to compare lengths of two units; files that state none are taken to be in the other's,
/// and units that differ by rounding alone are one.
/// @throws Error{InvalidInput} naming both files, and the factor that would make them alike.
void require_same_unit(const std::string& file, const std::string& unit,
                       const std::string& other_file, const std::string& other_unit);

}  // namespace kaboum::io
