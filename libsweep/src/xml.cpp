#include "xml.h"

#include <kaboum/geom/error.h>

namespace kaboum::sweep {

void fail_at(const std::string& name, int line, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, name + ":" + std::to_string(line) + ": " + what);
}

void parse_xml(tinyxml2::XMLDocument& document, std::string_view text, const std::string& name) {
  if (text.find('\0') != std::string_view::npos)
    throw Error(ErrorCode::InvalidInput, name + ": not a text file");
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    fail_at(name, document.ErrorLineNum(),
            std::string("not well-formed XML (") +
                tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) + ")");
  if (document.RootElement() == nullptr)
    throw Error(ErrorCode::InvalidInput, name + ": no XML element");
}

}  // namespace kaboum::sweep
