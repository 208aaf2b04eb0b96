// XML for the readers of 3MF, X3D and COLLADA: tinyxml2, and the checks that it leaves to its
// users.

#include "xml.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "source.h"
#include "text.h"

namespace kaboum::io {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::ptrdiff_t kMostItems = 60'000'000;  // about 100 bytes each in tinyxml2's tree
constexpr std::size_t kMostAttributes = 64;        // of one element

bool is_blank(std::string_view text) {
  return text.find_first_not_of(kBlanks) == std::string_view::npos;
}

/// A tag with very many attributes, or nullptr: tinyxml2 compares all pairs of them. Quotation
/// marks are counted between '<' and the '>' that ends the tag; comments and the like are passed
/// over.
const char* crowded_tag(std::string_view text) {
  constexpr std::array<std::array<std::string_view, 2>, 3> kOther = {
      {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}}};
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::size_t first = at;
    const std::string_view rest = text.substr(at);
    const auto other =
        std::ranges::find_if(kOther, [&](const auto& marks) { return rest.starts_with(marks[0]); });
    if (other != kOther.end()) {
      at = text.find((*other)[1], at);
      continue;
    }
    std::size_t attributes = 0;
    for (++at; at < text.size() && text[at] != '>'; ++at) {
      if (text[at] != '"' && text[at] != '\'') continue;
      if (++attributes > kMostAttributes) return text.data() + first;
      at = std::min(text.find(text[at], at + 1), text.size() - 1);
    }
  }
  return nullptr;
}

}  // namespace

XmlDocument::XmlDocument(std::string_view text, std::string name) : name_(std::move(name)) {
  const Source whole{text, name_, {}, true};
  if (text.find('\0') != std::string_view::npos)
    io::fail(whole, "not XML in UTF-8; the file is of another format or encoding");
  if (std::ranges::count_if(text, [](char c) { return c == '<' || c == '='; }) > kMostItems)
    throw Error(ErrorCode::LimitReached, name_ + ": more than " + std::to_string(kMostItems) +
                                             " elements and attributes; split the file");
  if (const char* const tag = crowded_tag(text))
    io::fail(whole, tag,
             "an element with more than " + std::to_string(kMostAttributes) +
                 " attributes; the file is damaged");
  const auto error = xml_.Parse(text.data(), text.size());
  if (error == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    io::fail(whole, "line " + std::to_string(xml_.ErrorLineNum()) +
                        ": elements are nested more than " +
                        std::to_string(::TINYXML2_MAX_ELEMENT_DEPTH) + " deep; flatten the scene");
  if (error != tinyxml2::XML_SUCCESS)
    io::fail(whole, "line " + std::to_string(xml_.ErrorLineNum()) + ": not well-formed XML (" +
                        tinyxml2::XMLDocument::ErrorIDToName(error) +
                        "); the file is damaged or of another format");
  if (xml_.RootElement() == nullptr)
    io::fail(whole, "no XML element; the file is of another format");
  const tinyxml2::XMLNode* const more = xml_.RootElement()->NextSiblingElement();
  if (more != nullptr) fail(*more, "a second root element; the file is damaged");
  check(xml_);
  lines_.push_back(text.data());
  for (const char& c : text)
    if (c == '\n') lines_.push_back(&c + 1);
}

const char* XmlDocument::where(const tinyxml2::XMLNode& node) const {
  const auto line = static_cast<std::size_t>(std::max(node.GetLineNum(), 1));
  return lines_[std::min(line, lines_.size()) - 1];
}

/// Everything in `parent`, at most as deep as tinyxml2 allows.
void XmlDocument::check(const tinyxml2::XMLNode& parent) const {
  for (const tinyxml2::XMLNode* n = parent.FirstChild(); n != nullptr; n = n->NextSibling()) {
    if (n->ToUnknown() != nullptr) {
      const std::string_view declaration = n->Value();
      if (parent.ToDocument() == nullptr || !declaration.starts_with("DOCTYPE") ||
          declaration.find('[') != std::string_view::npos)
        fail(*n, "declarations of entities and the like are not supported; export without them");
    } else if (n->ToText() != nullptr) {
      if (parent.ToDocument() != nullptr) refuse_text(*n);
    } else if (const tinyxml2::XMLElement* const e = n->ToElement()) {
      check(*e);
    }
  }
}

void XmlDocument::fail(const tinyxml2::XMLNode& where, const std::string& what) const {
  throw Error(ErrorCode::InvalidInput,
              name_ + ": line " + std::to_string(where.GetLineNum()) + ": " + what);
}

void XmlDocument::fail_unknown(const tinyxml2::XMLElement& element) const {
  fail(element, "the element " + tag(element) +
                    " is not known here and might hold geometry; export without it");
}

std::string_view XmlDocument::need(const tinyxml2::XMLElement& element, const char* name) const {
  const auto value = attribute(element, name);
  if (!value)
    fail(element, tag(element) + " has no attribute " + in_quotes(name) + "; the file is damaged");
  return *value;
}

double XmlDocument::number(const tinyxml2::XMLElement& element, std::string_view token) const {
  const std::optional<double> value = to_double(token);
  if (!value || !std::isfinite(*value))
    fail(element, tag(element) + ": " + in_quotes(token) +
                      (value ? " is not a finite double; repair or remove it"
                             : " is not a number; check that the file is complete"));
  return *value;
}

std::int64_t XmlDocument::integer(const tinyxml2::XMLElement& element,
                                  std::string_view token) const {
  std::int64_t value = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (stop == end && error == std::errc()) return value;
  fail(element, tag(element) + ": " + in_quotes(token) +
                    " where an integer is expected; the file is damaged");
}

std::string XmlDocument::text(const tinyxml2::XMLElement& element) const {
  std::string all;
  for (const tinyxml2::XMLNode* n = element.FirstChild(); n != nullptr; n = n->NextSibling()) {
    if (n->ToElement() != nullptr) fail_unknown(*n->ToElement());
    if (n->ToText() != nullptr) all.append(n->Value());
  }
  return all;
}

void XmlDocument::refuse_text(const tinyxml2::XMLNode& node) const {
  if (!is_blank(node.Value()))
    fail(node, "the text " + in_quotes(node.Value()) +
                   " where elements are expected; the file is damaged");
}

std::string tag(const tinyxml2::XMLElement& element) {
  return std::string("<").append(element.Name()).append(">");
}

std::optional<std::string_view> attribute(const tinyxml2::XMLElement& element, const char* name) {
  const char* const value = element.Attribute(name);
  if (value == nullptr) return std::nullopt;
  return value;
}

std::optional<std::string_view> namespace_of(const tinyxml2::XMLElement& element,
                                             std::string_view prefix) {
  if (prefix == "xml") return "http://www.w3.org/XML/1998/namespace";
  for (const tinyxml2::XMLNode* n = &element; n != nullptr && n->ToElement() != nullptr;
       n = n->Parent()) {
    for (const auto* a = n->ToElement()->FirstAttribute(); a != nullptr; a = a->Next()) {
      std::string_view name = a->Name();
      if (!name.starts_with("xmlns")) continue;
      name.remove_prefix(5);
      if (prefix.empty() ? name.empty() : name.starts_with(':') && name.substr(1) == prefix)
        return a->Value();
    }
  }
  return prefix.empty() ? std::optional<std::string_view>("") : std::nullopt;
}

QualifiedName qualified(const tinyxml2::XMLElement& element) {
  const std::string_view name = element.Name();
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return {*namespace_of(element, ""), name};
  return {namespace_of(element, name.substr(0, colon)).value_or("undeclared"),
          name.substr(colon + 1)};
}

QualifiedName qualified(const tinyxml2::XMLElement& element,
                        const tinyxml2::XMLAttribute& attribute) {
  const std::string_view name = attribute.Name();
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return {"", name};
  return {namespace_of(element, name.substr(0, colon)).value_or("undeclared"),
          name.substr(colon + 1)};
}

std::string_view next_word(std::string_view& text) {
  const std::size_t first = std::min(text.find_first_not_of(kBlanks), text.size());
  text.remove_prefix(first);
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace kaboum::io
