#pragma once

// Reading XML files of robots, with messages that name the line. Internal to kaboum_robot.

#include <kaboum/geom/mesh.h>
#include <tinyxml2.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::robot {

/// Parses well-formed XML; documents nested deeper than tinyxml2 allows (100 elements) are refused.
/// @throws Error{InvalidInput} naming the line.
void parse_xml(tinyxml2::XMLDocument& document, std::string_view text, const std::string& name);

/// "file:line: what" as Error{InvalidInput}.
[[noreturn]] void fail_at(const std::string& name, int line, const std::string& what);

/// Text without the blanks round it; of none, nothing.
std::string trimmed(const char* text);

/// So many elements may come of what files include, and so deep may they include one another.
inline constexpr std::size_t kMostExpanded = 1'000'000;
inline constexpr std::size_t kMostNested = 32;

/// Does something with an element and all below it.
template <class Action>
void for_all(tinyxml2::XMLElement& element, const Action& action) {
  action(element);
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    for_all(*e, action);
}

/// A number written in decimal, blanks round it allowed; nullopt for anything else, infinity and
/// NaN too.
std::optional<double> finite_number(std::string_view text);

/// Numbers with blanks between them; nullopt where one is none.
std::optional<std::vector<double>> finite_numbers(std::string_view text);

/// One file: what its elements hold, or a message that names it and the line.
class XmlFile {
 public:
  /// @param name  of the file, for messages; outlives this.
  explicit XmlFile(const std::string& name) : name_(name) {}

  /// "file:line: <tag>: what" as Error{InvalidInput}.
  [[noreturn]] void fail(const tinyxml2::XMLElement& element, const std::string& what) const;

  /// The child of this tag; nullptr when there is none. Two are refused: readers differ in which of
  /// them they take.
  const tinyxml2::XMLElement* only_child(const tinyxml2::XMLElement& element,
                                         const char* tag) const;

  /// An attribute that must be there.
  std::string text(const tinyxml2::XMLElement& element, const char* key) const;
  /// A number that must be there.
  double number(const tinyxml2::XMLElement& element, const char* key) const;
  double number(const tinyxml2::XMLElement& element, const char* key, double otherwise) const;
  /// So many numbers with blanks between them.
  std::vector<double> numbers(const tinyxml2::XMLElement& element, const char* key,
                              std::size_t count) const;
  /// Three numbers with blanks between them.
  geom::Vec3 vector(const tinyxml2::XMLElement& element, const char* key) const;
  geom::Vec3 vector(const tinyxml2::XMLElement& element, const char* key,
                    const geom::Vec3& otherwise) const;

 private:
  const std::string& name_;
};

}  // namespace kaboum::robot
