#pragma once

#include <kaboum/robot/robot.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "xml.h"

// Default classes and rotations of MJCF. Internal to kaboum_robot.
namespace kaboum::robot {

using Attributes = std::map<std::string, std::string>;

/// Ways of stating a rotation that come before `quat`. MuJoCo 2.2.2 keeps those of a class beside
/// an element's own, and takes the last of these that is there.
inline constexpr std::array<const char*, 4> kOtherRotations{"axisangle", "xyaxes", "zaxis",
                                                            "euler"};

/// Attributes over those of a class: a rotation takes the place of the class's.
inline void lay_over(Attributes& below, const tinyxml2::XMLElement& element) {
  const auto rotates = [&](const char* key) { return element.Attribute(key) != nullptr; };
  if (std::ranges::any_of(kOtherRotations, rotates) || rotates("quat"))
    for (const char* key : kOtherRotations) below.erase(key);
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next())
    below[a->Name()] = a->Value();
}

/// Where in kOtherRotations the last is that an element states itself; -1: none.
inline int rotation_of(const tinyxml2::XMLElement& element) {
  int out = -1;
  for (int i = 0; i < static_cast<int>(kOtherRotations.size()); ++i)
    if (element.Attribute(kOtherRotations[static_cast<std::size_t>(i)]) != nullptr) out = i;
  return out;
}

/// Default classes: the attributes that elements of a kind have where they state none.
class DefaultClasses {
 public:
  explicit DefaultClasses(const std::string& name) : name_(name) { classes_["main"]; }

  /// @param element  a <default> of the root
  void read(const tinyxml2::XMLElement& element) {
    if (const char* name = element.Attribute("class"); name != nullptr) main_ = name;
    read_into(element, "main");
  }

  /// What an element says itself or by its class.
  [[nodiscard]] Attributes of(const tinyxml2::XMLElement& element,
                              const std::string& class_here) const {
    const char* own = element.Attribute("class");
    const auto& kinds = named(own != nullptr ? own : class_here, element);
    const auto found = kinds.find(element.Name());
    Attributes out = found == kinds.end() ? Attributes() : found->second;
    lay_over(out, element);
    return out;
  }

  /// Where in kOtherRotations the last is that a class of an element states, or one that this class
  /// is made from; -1: none.
  [[nodiscard]] int rotates(const tinyxml2::XMLElement& element,
                            const std::string& class_here) const {
    const char* own = element.Attribute("class");
    const std::string name = own != nullptr ? own : class_here;
    const auto found =
        rotations_.find({name.empty() || name == main_ ? "main" : name, element.Name()});
    return found == rotations_.end() ? -1 : found->second;
  }

  /// What a class says of elements of a kind. @pre there is the class
  [[nodiscard]] Attributes of_kind(const std::string& name, const std::string& tag) const {
    const Kinds& kinds = classes_.at(name.empty() || name == main_ ? "main" : name);
    const auto found = kinds.find(tag);
    return found == kinds.end() ? Attributes() : found->second;
  }
  /// Tags of elements that the class has something for.
  [[nodiscard]] std::vector<std::string> kinds_of_main() const {
    std::vector<std::string> out;
    for (const auto& [tag, unused] : classes_.at("main")) out.push_back(tag);
    return out;
  }
  /// The name of the class that all others are made from.
  [[nodiscard]] const std::string& main() const { return main_; }

  void require(const std::string& name, const tinyxml2::XMLElement& element) const {
    static_cast<void>(named(name, element));
  }

 private:
  using Kinds = std::map<std::string, Attributes>;  // by tag

  [[nodiscard]] const Kinds& named(const std::string& name,
                                   const tinyxml2::XMLElement& element) const {
    const auto found = classes_.find(name.empty() || name == main_ ? "main" : name);
    if (found == classes_.end())
      fail_at(name_, element.GetLineNum(), "there is no default class '" + name + "'");
    return found->second;
  }

  void read_into(const tinyxml2::XMLElement& element, const std::string& name) {
    Kinds& kinds = classes_[name];
    for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
      if (std::string_view(e->Name()) != "default") {
        lay_over(kinds[e->Name()], *e);
        int& last = rotations_.try_emplace({name, e->Name()}, -1).first->second;
        last = std::max(last, rotation_of(*e));
      }
    for (const auto* e = element.FirstChildElement("default"); e != nullptr;
         e = e->NextSiblingElement("default")) {
      const char* inner = e->Attribute("class");
      if (inner == nullptr) fail_at(name_, e->GetLineNum(), "a <default> without a class");
      if (!classes_.contains(inner)) {
        classes_[inner] = classes_[name];
        for (const auto& [tag, unused] : classes_[name])
          rotations_[{inner, tag}] = rotations_[{name, tag}];
      }
      read_into(*e, inner);
    }
  }

  const std::string& name_;
  std::string main_ = "main";
  std::map<std::string, Kinds> classes_;
  std::map<std::pair<std::string, std::string>, int> rotations_;  // by class and tag
};

/// The rotation of three turns. @param order  eulerseq: three of x, y, z (moving) and X, Y, Z
Mat3 rotation_from_euler(const Vec3& angles, const std::string& order);

}  // namespace kaboum::robot
