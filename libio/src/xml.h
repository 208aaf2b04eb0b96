#pragma once

#include <tinyxml2.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io {

/// A well-formed XML document and how to speak of places in it. Internal to kaboum_io.
///
/// tinyxml2 expands no entities but the five of XML itself and opens no files. What it lets pass
/// although two parsers could understand it differently is refused: attributes given twice, a
/// second root element, document types with declarations of their own.
class XmlDocument {
 public:
  /// @param name  of the file, or of the part of a file, for messages.
  /// @throws Error{InvalidInput} naming the line; Error{LimitReached} on more than 60 million
  ///   elements and attributes.
  XmlDocument(std::string_view text, std::string name);

  [[nodiscard]] const tinyxml2::XMLElement& root() const { return *xml_.RootElement(); }

  /// The beginning of its line in the text, which has to be there still.
  [[nodiscard]] const char* where(const tinyxml2::XMLNode& node) const;

  /// Throws Error{InvalidInput} "<name>: line <n>: <what>".
  [[noreturn]] void fail(const tinyxml2::XMLNode& where, const std::string& what) const;

  /// The element is not known: it might hold geometry.
  [[noreturn]] void fail_unknown(const tinyxml2::XMLElement& element) const;

  /// An attribute that has to be there.
  [[nodiscard]] std::string_view need(const tinyxml2::XMLElement& element, const char* name) const;

  /// The number in `token`, which is part of `element`; it has to be finite.
  [[nodiscard]] double number(const tinyxml2::XMLElement& element, std::string_view token) const;
  [[nodiscard]] std::int64_t integer(const tinyxml2::XMLElement& element,
                                     std::string_view token) const;

  /// The element's text without comments. Fails when there are elements in it.
  [[nodiscard]] std::string text(const tinyxml2::XMLElement& element) const;

  /// Calls `visit(child)` for the elements in `parent`; fails when there is text between them.
  template <typename Visit>
  void each(const tinyxml2::XMLElement& parent, const Visit& visit) const {
    for (const tinyxml2::XMLNode* n = parent.FirstChild(); n != nullptr; n = n->NextSibling()) {
      if (n->ToText() != nullptr) refuse_text(*n);
      if (n->ToElement() != nullptr) visit(*n->ToElement());
    }
  }

 private:
  void check(const tinyxml2::XMLNode& parent) const;
  void refuse_text(const tinyxml2::XMLNode& node) const;

  std::string name_;
  tinyxml2::XMLDocument xml_;
  std::vector<const char*> lines_;
};

/// "<name>", for messages.
std::string tag(const tinyxml2::XMLElement& element);

/// The attribute's value, if it is there.
std::optional<std::string_view> attribute(const tinyxml2::XMLElement& element, const char* name);

inline bool is_named(const tinyxml2::XMLElement& element, std::string_view name) {
  return element.Name() == name;
}

/// An element's or attribute's name with the namespace that its prefix stands for.
struct QualifiedName {
  std::string_view space;  ///< URI; empty for none
  std::string_view local;
  bool operator==(const QualifiedName&) const = default;
};
QualifiedName qualified(const tinyxml2::XMLElement& element);
/// Attributes without prefix are in no namespace.
QualifiedName qualified(const tinyxml2::XMLElement& element,
                        const tinyxml2::XMLAttribute& attribute);
/// What `prefix` stands for at this element; nullopt when it is not declared.
std::optional<std::string_view> namespace_of(const tinyxml2::XMLElement& element,
                                             std::string_view prefix);

/// Takes the next of the words between white space off the front of `text`; empty at its end.
std::string_view next_word(std::string_view& text);

}  // namespace kaboum::io
