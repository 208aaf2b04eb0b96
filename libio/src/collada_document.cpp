// COLLADA's references between elements, and its counts and numbers.
#include "collada_document.h"

#include <array>

#include "names.h"
#include "text.h"

namespace kaboum::io {
namespace {

/// Elements that are referred to by their id.
constexpr std::array<std::string_view, 6> kReferred = {"float_array", "geometry", "node",
                                                       "source",      "vertices", "visual_scene"};

/// Of <technique> in <extra>: programs' own data on names, layers, looks, lights, cameras and
/// bones.
constexpr std::array<std::string_view, 19> kProfiles = {"AUTODESK",
                                                        "BLENDER",
                                                        "FCOLLADA",
                                                        "GOOGLEEARTH",
                                                        "MAX3D",
                                                        "MAYA",
                                                        "NVIDIA_FXCOMPOSER",
                                                        "NvidiaFXComposer",
                                                        "OGRE",
                                                        "OpenCOLLADA",
                                                        "OpenCOLLADA3dsMax",
                                                        "OpenCOLLADAMaya",
                                                        "OpenCOLLADA_Maya",
                                                        "RENDERMONKEY",
                                                        "SKETCHUP",
                                                        "SketchUp",
                                                        "XSI",
                                                        "blender",
                                                        "sketchup"};

}  // namespace

double ColladaDocument::metres_of(const XMLElement& unit) const {
  const double value = number(unit, attribute(unit, "meter").value_or("1"));
  if (!(value > 0)) fail(unit, "a unit of " + shortest_digits(value) + " metres");
  return value;
}

void ColladaDocument::index(const XMLElement& parent, double metres) {
  for (const XMLElement* e = parent.FirstChildElement(); e != nullptr;
       e = e->NextSiblingElement()) {
    if (is_named(*e, "extra")) continue;
    if (is_named(*e, "unit") && metres_of(*e) != metres)
      fail(*e, "a part has another unit than the file; export with one unit");
    if (is_named(*e, "geometry")) ++geometry_count_;
    const auto id = attribute(*e, "id");
    if (id && contains(kReferred, e->Name())) {
      const auto [entry, is_new] = ids_.try_emplace({e->Name(), *id}, e);
      if (!is_new) entry->second = nullptr;
    }
    index(*e, metres);
  }
}

const tinyxml2::XMLElement& ColladaDocument::referred(const XMLElement& e, const char* name,
                                                      std::string_view kind) const {
  const std::string_view url = need(e, name);
  if (!url.starts_with('#'))
    fail(e,
         tag(e) + " refers to another file, " + in_quotes(url) + "; export the scene as one file");
  const auto found = ids_.find({kind, url.substr(1)});
  if (found == ids_.end())
    fail(e, "there is no <" + std::string(kind) + "> " + in_quotes(url.substr(1)) +
                "; the file is damaged");
  if (found->second == nullptr)
    fail(e, "there are several <" + std::string(kind) + "> " + in_quotes(url.substr(1)) +
                "; export with names that are unique");
  return *found->second;
}

void ColladaDocument::check_count(const XMLElement& e, std::uint64_t actual,
                                  const std::string& what) const {
  const std::uint64_t stated = natural(e, "count", std::nullopt);
  if (stated != actual)
    fail(e, tag(e) + " states " + std::to_string(stated) + " " + what + ", but holds " +
                std::to_string(actual) + "; the file is damaged");
}

std::uint64_t ColladaDocument::natural(const XMLElement& e, const char* name,
                                       std::optional<std::uint64_t> otherwise) const {
  const auto value = attribute(e, name);
  if (!value && otherwise) return *otherwise;
  const std::int64_t number = integer(e, need(e, name));
  if (number < 0 || number > 0xFFFFFFFFLL)
    fail(e, "the number " + in_quotes(*value) + " is out of range; the file is damaged");
  return static_cast<std::uint64_t>(number);
}

void ColladaDocument::check_extra(const XMLElement& extra) const {
  each(extra, [&](const XMLElement& e) {
    if (is_named(e, "asset")) return;
    if (!is_named(e, "technique")) fail_unknown(e);
    const std::string_view profile = need(e, "profile");
    if (!contains(kProfiles, profile))
      fail(e, "extra data of the profile " + in_quotes(profile) +
                  " is not known and might hold geometry; export without it");
    // By this, a joint's scale does not reach its children.
    const XMLElement* const compensate = e.FirstChildElement("segment_scale_compensate");
    if (compensate != nullptr && text(*compensate) != "0" && text(*compensate) != "false")
      fail(*compensate,
           "joints that compensate scales are not supported; apply transforms before "
           "exporting");
  });
}

std::vector<std::uint32_t> ColladaDocument::integers(const XMLElement& e) const {
  const std::string text = XmlDocument::text(e);
  std::string_view words = text;
  std::vector<std::uint32_t> values;
  for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
    const std::int64_t value = integer(e, word);
    if (value < 0 || value > 0xFFFFFFFFLL)
      fail(e, "the index " + in_quotes(word) + " is out of range; the file is damaged");
    values.push_back(static_cast<std::uint32_t>(value));
  }
  return values;
}

}  // namespace kaboum::io
