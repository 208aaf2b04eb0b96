#pragma once

#include <kaboum/io/xml_kind.h>

#include <string>

namespace kaboum::tools {

/// What to do with a document of this kind where a mesh is to come; empty for None.
std::string route_to_mesh(io::XmlKind kind, const std::string& path);

}  // namespace kaboum::tools
