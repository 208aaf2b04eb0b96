#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/length.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/region.h>
#include <kaboum/geom/transform.h>
#include <kaboum/io/mesh_io.h>
#include <pybind11/numpy.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bindings.h"

/// Values of keyword arguments, which have the tools' names and meanings.
namespace kaboum::python {

/// The value of a number, also NumPy's; nullopt for all else, True, False and arrays of several
/// too.
/// @throws Error{InvalidArgument} for a number that is no double: nothing is rounded
std::optional<double> number_of(const py::handle& value);

/// A number, or a text as the tools take it ('1%', '0.002'); None: nullopt.
/// @throws Error{InvalidArgument} naming the argument.
std::optional<Length> length_of(const py::object& value, const char* argument);

/// @throws Error{InvalidArgument} naming the names that there are.
[[noreturn]] void refuse_name(const char* argument, const std::string& name,
                              const std::vector<std::string>& known);

/// What a name stands for.
template <class Value, std::size_t N>
Value value_of(const std::array<std::pair<const char*, Value>, N>& names, const std::string& name,
               const char* argument) {
  std::vector<std::string> known;
  for (const auto& [text, value] : names) {
    if (name == text) return value;
    known.emplace_back(text);
  }
  refuse_name(argument, name, known);
}

/// Of a name ('stl', 'ply-ascii'), or else of a file name's extension; None and no extension:
/// nullopt.
std::optional<io::Format> format_of(const std::optional<std::string>& name, const char* argument);

/// What an array or a list of numbers holds, nothing rounded: NumPy itself makes float64 of a list
/// in which whole numbers and others stand together. Null with an error set: it is none.
py::array array_from(const py::object& value);

/// Checks that nothing is rounded when a two-dimensional array becomes one of doubles: numbers of
/// other types must be doubles all the same.
/// @param name  what it is, for messages
/// @throws Error{InvalidArgument} naming the first that is none
void require_doubles(const py::array& array, const std::string& name);

/// A row of numbers, all of them finite doubles.
/// @throws Error{InvalidArgument} naming the argument
std::vector<double> numbers_of(const py::object& given, const char* name);

/// A pose of x, y, z and roll, pitch, yaw, a quaternion or a matrix, row by row; or of a 4 x 4
/// matrix.
/// @throws Error{InvalidArgument} where it is none of these
geom::Transform pose_from(const py::object& pose);

/// JSON of what Python states; arrays become lists.
/// @param of  whose it is, for messages
/// @throws Error{InvalidArgument} for what is no JSON
std::string json_text(const py::object& value, const std::string& of);

/// The argument epsilon_map: of a file of regions, or of a list of dicts of the same shape; None:
/// no regions.
/// @throws Error as io::read_regions
std::vector<geom::RequestedRegion> regions_of(const py::object& epsilon_map);

/// The same of a robot. @throws Error as io::read_frame_regions
geom::FrameRegions frame_regions_of(const py::object& epsilon_map);

/// Notes of libraries with options as Python names them.
std::vector<std::string> spelled(std::vector<std::string> notes);

/// The property of a value's notes.
template <class Value>
auto notes_of(std::vector<std::string> Value::*notes) {
  return [notes](const Value& value) { return spelled(value.*notes); };
}

/// A str or os.PathLike as a path; nullopt: it is neither.
std::optional<std::string> path_of(const py::object& value);
/// The same. @throws Error{InvalidArgument} naming the argument: it is neither
std::string required_path(const py::object& value, const char* argument);

}  // namespace kaboum::python
