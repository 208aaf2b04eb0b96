// Keyword arguments: lengths, names, paths.

#include "arguments.h"

#include <kaboum/base/parse_length.h>
#include <kaboum/base/similar_name.h>

#include <cmath>

namespace kaboum::python {

std::optional<Length> length_of(const py::object& value, const char* argument) {
  if (value.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(value)) {
    if (const auto length = parse_length(value.cast<std::string>())) return length;
  } else if (PyNumber_Check(value.ptr()) != 0 && !PyBool_Check(value.ptr())) {
    const Length length{value.cast<double>(), false};
    if (length.value > 0 && std::isfinite(length.value)) return length;
  }
  throw Error(
      ErrorCode::InvalidArgument,
      std::string(argument) +
          " must be a positive number, or a percentage of the diagonal such as '0.5%', not " +
          py::repr(value).cast<std::string>());
}

std::optional<double> plain_length_of(const py::object& value, const char* argument) {
  const auto length = length_of(value, argument);
  if (!length) return std::nullopt;
  if (length->percent)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) +
                    " must be a length; there is no diagonal that it could be "
                    "a percentage of");
  return length->value;
}

void refuse_name(const char* argument, const std::string& name,
                 const std::vector<std::string>& known) {
  std::string text = std::string(argument) + " must be ";
  for (std::size_t i = 0; i < known.size(); ++i)
    text += (i == 0 ? "'" : i + 1 == known.size() ? " or '" : ", '") + known[i] + "'";
  throw Error(ErrorCode::InvalidArgument,
              text + ", not '" + name + "'" + did_you_mean(name, known));
}

geom::Holes holes_of(const std::string& name, bool may_keep) {
  static constexpr std::array<std::pair<const char*, geom::Holes>, 3> kHoles{
      {{"fill", geom::Holes::Fill}, {"refuse", geom::Holes::Refuse}, {"keep", geom::Holes::Keep}}};
  if (!may_keep && name == "keep") refuse_name("holes", name, {"fill", "refuse"});
  return value_of(kHoles, name, "holes");
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

}  // namespace kaboum::python
