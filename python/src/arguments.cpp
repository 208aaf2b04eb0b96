// Keyword arguments: lengths, names, paths.

#include "arguments.h"

#include <kaboum/base/option.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/region_file.h>
#include <kaboum/robot/base_pose.h>

#include <cmath>

namespace kaboum::python {
namespace {

[[noreturn]] void refuse_rounding(const py::array& array, const std::string& name,
                                  py::ssize_t entry) {
  const py::ssize_t row = entry / array.shape(1), column = entry % array.shape(1);
  const py::object number = array[py::make_tuple(row, column)];
  throw Error(ErrorCode::InvalidArgument,
              name + "[" + std::to_string(row) + ", " + std::to_string(column) + "] is " +
                  py::str(number).cast<std::string>() + ", which is no float64; round it first");
}

/// @param back  a double as a Number; nullopt where it is none
template <class Number, class Back>
void require_same(const py::array& given, const std::string& name, const Back& back) {
  const auto array = py::array_t<Number, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) throw py::error_already_set();
  const Number* const first = array.data();
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    const std::optional<Number> same = back(static_cast<double>(first[i]));
    const bool is_nan = first[i] != first[i];  // refused where it matters
    if (!is_nan && same != first[i]) refuse_rounding(given, name, i);
  }
}

}  // namespace

py::array array_from(const py::object& value) {
  py::array plain = py::array::ensure(value);
  const bool listed = py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
  if (!plain || !listed || plain.dtype().kind() != 'f') return plain;
  py::array exact =
      py::module_::import("numpy").attr("array")(value, py::arg("dtype") = py::dtype("O"));
  return exact.ndim() == plain.ndim() && exact.size() == plain.size() ? exact : plain;
}

void require_doubles(const py::array& array, const std::string& name) {
  const char kind = array.dtype().kind();
  // As NumPy says it: pybind11 before 2.12 reads NumPy 2's descriptors wrongly.
  const auto size = array.attr("itemsize").cast<py::ssize_t>();
  const auto refuse = [&] { throw Error(ErrorCode::InvalidArgument, name + " must be numbers"); };
  if (kind == 'f' && size > 8) {
    require_same<long double>(array, name,
                              [](double x) { return std::optional(static_cast<long double>(x)); });
  } else if (kind == 'i' && size > 4) {
    require_same<std::int64_t>(array, name, [](double x) {
      return x >= 0x1p63 ? std::nullopt : std::optional(static_cast<std::int64_t>(x));
    });
  } else if (kind == 'u' && size > 4) {
    require_same<std::uint64_t>(array, name, [](double x) {
      return x >= 0x1p64 ? std::nullopt : std::optional(static_cast<std::uint64_t>(x));
    });
  } else if (kind == 'O') {
    py::ssize_t i = 0;
    for (const py::handle x : array.attr("ravel")()) {
      if (PyFloat_CheckExact(x.ptr())) {
        ++i;
        continue;
      }
      if (PyNumber_Check(x.ptr()) == 0 || PyComplex_Check(x.ptr()) != 0) refuse();
      PyObject* const number = PyNumber_Float(x.ptr());
      if (number == nullptr) throw py::error_already_set();
      if (!py::reinterpret_steal<py::object>(number).equal(x)) refuse_rounding(array, name, i);
      ++i;
    }
  } else if (kind != 'f' && kind != 'i' && kind != 'u' && array.size() > 0) {
    refuse();
  }
}

std::optional<double> number_of(const py::handle& value) {
  if (PyNumber_Check(value.ptr()) == 0 || PyBool_Check(value.ptr()) ||
      PyComplex_Check(value.ptr()) != 0)
    return std::nullopt;
  const double out = PyFloat_AsDouble(value.ptr());
  if (out != -1 || PyErr_Occurred() == nullptr) {
    if (!std::isnan(out) && !py::float_(out).equal(value))
      throw Error(ErrorCode::InvalidArgument,
                  py::str(value).cast<std::string>() + " is no float64; round it first");
    return out;
  }
  PyErr_Clear();  // arrays of several numbers, integers beyond doubles
  return std::nullopt;
}

std::optional<Length> length_of(const py::object& value, const char* argument) {
  if (value.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(value)) {
    if (const auto length = parse_length(value.cast<std::string>())) return length;
  } else if (const auto number = number_of(value)) {
    if (*number > 0 && std::isfinite(*number)) return Length{*number, false};
  }
  throw Error(ErrorCode::InvalidArgument, std::string(argument) +
                                              " must be a positive number, a length with its unit "
                                              "such as '5mm', or a percentage of the "
                                              "diagonal such as '0.5%', not " +
                                              py::repr(value).cast<std::string>());
}

void refuse_name(const char* argument, const std::string& name,
                 const std::vector<std::string>& known) {
  std::string text = std::string(argument) + " must be ";
  for (std::size_t i = 0; i < known.size(); ++i)
    text += (i == 0 ? "'" : i + 1 == known.size() ? " or '" : ", '") + known[i] + "'";
  throw Error(ErrorCode::InvalidArgument,
              text + ", not '" + name + "'" + did_you_mean(name, known));
}

std::optional<io::Format> format_of(const std::optional<std::string>& name, const char* argument) {
  if (!name) return std::nullopt;
  if (const auto format = io::format_from_name(*name)) return format;
  refuse_name(argument, *name, io::readable_formats());
}

std::optional<std::string> path_of(const py::object& value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (!py::hasattr(value, "__fspath__")) return std::nullopt;
  return py::str(value.attr("__fspath__")()).cast<std::string>();
}

std::string json_text(const py::object& value, const std::string& of) {
  const auto list_of = [](const py::object& o) -> py::object { return o.attr("tolist")(); };
  try {
    return py::module_::import("json")
        .attr("dumps")(value, py::arg("allow_nan") = false,
                       py::arg("default") = py::cpp_function(list_of))
        .cast<std::string>();
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError) &&
        !error.matches(PyExc_AttributeError))
      throw;
  }
  throw Error(ErrorCode::InvalidArgument,
              of + ": numbers must be finite, and all else texts, lists and dicts by name");
}

namespace {

/// What `read` makes of a file, or `parse` of a list.
/// @param example  of a region
template <class Read, class Parse>
auto map_of(const py::object& epsilon_map, const char* example, const Read& read,
            const Parse& parse) -> decltype(read(std::string())) {
  if (epsilon_map.is_none()) return {};
  if (const auto file = path_of(epsilon_map)) return read(*file);
  if (!py::isinstance<py::list>(epsilon_map))
    throw Error(ErrorCode::InvalidArgument,
                std::string("epsilon_map must be the name of a file, or a list of dicts, each a "
                            "region: ") +
                    example);
  py::dict all;
  all["regions"] = epsilon_map;
  return parse(json_text(all, "epsilon_map"), "epsilon_map");
}

}  // namespace

std::vector<geom::RequestedRegion> regions_of(const py::object& epsilon_map) {
  return map_of(epsilon_map, "{'epsilon': '0.2%', 'box': [[0, 0, 0], [1, 1, 1]]}", io::read_regions,
                io::parse_regions);
}

geom::FrameRegions frame_regions_of(const py::object& epsilon_map) {
  return map_of(epsilon_map, "{'frame': 'hand', 'radius': 0.1, 'epsilon': '0.2%'}",
                io::read_frame_regions, io::parse_frame_regions);
}

std::vector<std::string> spelled(std::vector<std::string> notes) {
  for (std::string& note : notes) note = remedy_of_python(note);
  return notes;
}

std::string required_path(const py::object& value, const char* argument) {
  const auto path = path_of(value);
  if (!path)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a str or an os.PathLike");
  return *path;
}

std::vector<double> numbers_of(const py::object& given, const char* name) {
  const py::array array = array_from(given);
  if (!array || array.ndim() != 1) {
    PyErr_Clear();
    throw Error(ErrorCode::InvalidArgument, std::string(name) + " must be a row of numbers");
  }
  require_doubles(array.attr("reshape")(1, -1).cast<py::array>(), name);
  const auto doubles =
      py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!doubles) throw py::error_already_set();
  std::vector<double> out(doubles.data(), doubles.data() + doubles.size());
  for (const double x : out)
    if (!std::isfinite(x))
      throw Error(ErrorCode::InvalidArgument,
                  std::string(name) + " has a value that is not finite");
  return out;
}

geom::Transform pose_from(const py::object& pose) {
  const py::array array = array_from(pose);
  if (!array) PyErr_Clear();
  std::vector<double> numbers;
  if (array && array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4) {
    const std::vector<double> m = numbers_of(array.attr("reshape")(16), "pose");
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
      throw Error(ErrorCode::InvalidArgument, "pose: the matrix's last row must be 0, 0, 0, 1");
    numbers = {m[3], m[7], m[11], m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
  } else {
    numbers = numbers_of(pose, "pose");
  }
  std::string text;
  for (const double x : numbers)
    text += (text.empty() ? "" : ",") + py::repr(py::float_(x)).cast<std::string>();
  return robot::parse_pose(text, "pose");
}

}  // namespace kaboum::python
