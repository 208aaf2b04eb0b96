#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "source.h"
#include "xml.h"

namespace kaboum::io {

/// A COLLADA document whose elements refer to each other. Internal to kaboum_io.
class ColladaDocument : public XmlDocument {
 public:
  using XMLElement = tinyxml2::XMLElement;

  explicit ColladaDocument(const Source& source)
      : XmlDocument(source.bytes, std::string(source.name)) {}

  /// Length of a <unit>.
  [[nodiscard]] double metres_of(const XMLElement& unit) const;

  /// Finds what can be referred to; all parts have to have the unit `metres`.
  void index(double metres) { index(root(), metres); }
  /// How many <geometry> there are.
  [[nodiscard]] std::size_t geometry_count() const { return geometry_count_; }

  /// The `kind` element that an attribute of `e` refers to.
  [[nodiscard]] const XMLElement& referred(const XMLElement& e, const char* name,
                                           std::string_view kind) const;

  /// The count that the file states is the count that is there.
  void check_count(const XMLElement& e, std::uint64_t actual, const std::string& what) const;

  /// A natural number below 2^32 in an attribute.
  [[nodiscard]] std::uint64_t natural(const XMLElement& e, const char* name,
                                      std::optional<std::uint64_t> otherwise) const;

  /// Vendors' data beside the standard's: fails unless their profiles are known to hold and move no
  /// surface.
  void check_extra(const XMLElement& extra) const;

  /// The natural numbers below 2^32 in an element's text.
  [[nodiscard]] std::vector<std::uint32_t> integers(const XMLElement& e) const;

 private:
  /// Finds what can be referred to, wherever it is; tinyxml2 limits the depth.
  void index(const XMLElement& parent, double metres);

  std::map<std::pair<std::string_view, std::string_view>, const XMLElement*> ids_;
  std::size_t geometry_count_ = 0;
};

}  // namespace kaboum::io
