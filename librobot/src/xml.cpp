// One reader of XML for robots, by tinyxml2: errors name file and line.

#include "xml.h"

#include <kaboum/base/error.h>

#include <charconv>
#include <cmath>

namespace kaboum::robot {
namespace {

constexpr std::string_view kXmlBlanks = " \t\r\n";

/// For messages: without what would fill a screen.
std::string quoted(const std::string& text) {
  std::string out = "'";
  return out.append(text, 0, 60).append("'");
}

}  // namespace

void fail_at(const std::string& name, int line, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, name + ":" + std::to_string(line) + ": " + what);
}

void parse_xml(tinyxml2::XMLDocument& document, std::string_view text, const std::string& name) {
  if (text.find('\0') != std::string_view::npos)
    throw Error(ErrorCode::InvalidInput, name + ": not a text file");
  if (text.find_first_not_of(kXmlBlanks) == std::string_view::npos)
    throw Error(ErrorCode::InvalidInput, name + ": the file is empty; a URDF or RL file is needed");
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    fail_at(name, document.ErrorLineNum(),
            std::string("not well-formed XML (") +
                tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) + ")");
  if (document.RootElement() == nullptr)
    throw Error(ErrorCode::InvalidInput, name + ": no XML element");
}

std::string trimmed(const char* text) {
  const std::string_view out = text == nullptr ? "" : text;
  const std::size_t first = out.find_first_not_of(kXmlBlanks);
  if (first == std::string_view::npos) return {};
  return std::string(out.substr(first, out.find_last_not_of(kXmlBlanks) + 1 - first));
}

std::optional<double> finite_number(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kXmlBlanks);
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(kXmlBlanks) + 1 - first);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

void XmlFile::fail(const tinyxml2::XMLElement& element, const std::string& what) const {
  fail_at(name_, element.GetLineNum(), std::string("<") + element.Name() + ">: " + what);
}

const tinyxml2::XMLElement* XmlFile::only_child(const tinyxml2::XMLElement& element,
                                                const char* tag) const {
  const auto* child = element.FirstChildElement(tag);
  const auto* second = child != nullptr ? child->NextSiblingElement(tag) : nullptr;
  if (second != nullptr) fail(*second, std::string("a second one in <") + element.Name() + ">");
  return child;
}

std::string XmlFile::text(const tinyxml2::XMLElement& element, const char* key) const {
  const char* value = element.Attribute(key);
  if (value == nullptr) fail(element, std::string("needs the attribute '") + key + "'");
  return value;
}

double XmlFile::number(const tinyxml2::XMLElement& element, const char* key) const {
  const std::string value = text(element, key);
  const auto x = finite_number(value);
  if (!x) fail(element, std::string(key) + " is " + quoted(value) + ", no finite number");
  return *x;
}

double XmlFile::number(const tinyxml2::XMLElement& element, const char* key,
                       double otherwise) const {
  return element.Attribute(key) != nullptr ? number(element, key) : otherwise;
}

std::optional<std::vector<double>> finite_numbers(std::string_view text) {
  std::vector<double> out;
  for (std::size_t end = 0;;) {
    const std::size_t begin = text.find_first_not_of(kXmlBlanks, end);
    if (begin == std::string::npos) return out;
    end = std::min(text.find_first_of(kXmlBlanks, begin), text.size());
    const auto x = finite_number(text.substr(begin, end - begin));
    if (!x) return std::nullopt;
    out.push_back(*x);
  }
}

std::vector<double> XmlFile::numbers(const tinyxml2::XMLElement& element, const char* key,
                                     std::size_t count) const {
  const std::string value = text(element, key);
  auto out = finite_numbers(value);
  if (out && out->size() == count) return *std::move(out);
  fail(element, std::string(key) + " is " + quoted(value) + ", not " +
                    (count == 3 ? "three" : std::to_string(count)) + " finite numbers");
}

geom::Vec3 XmlFile::vector(const tinyxml2::XMLElement& element, const char* key) const {
  const std::vector<double> x = numbers(element, key, 3);
  return {x[0], x[1], x[2]};
}

geom::Vec3 XmlFile::vector(const tinyxml2::XMLElement& element, const char* key,
                           const geom::Vec3& otherwise) const {
  return element.Attribute(key) != nullptr ? vector(element, key) : otherwise;
}

}  // namespace kaboum::robot
