#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bindings.h"

/// Pictures and pages of results.
namespace kaboum::python {

/// Writes a picture or a page, by the extension of the file's name: .png or .html.
/// @param picture  its bytes; empty: there is none, only a page
/// @throws Error{InvalidArgument} for other names
void write_preview(const py::object& file, const std::function<std::string()>& page,
                   const std::function<std::vector<char>()>& picture);

/// The bytes of a PNG, which are written into a file unless that is None.
/// @throws Error{InvalidArgument} for other names than of a PNG
py::bytes png_bytes(const py::object& file, const std::function<std::vector<char>()>& picture);

}  // namespace kaboum::python
