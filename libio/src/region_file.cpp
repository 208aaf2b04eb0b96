// JSON that says how near bodies are to be in regions.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/region_file.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

namespace kaboum::io {
namespace {

using nlohmann::json;

constexpr const char* kMapForm =
    "give {\"regions\": [{\"epsilon\": \"0.2%\", \"box\": [[0, 0, 0], [1, 1, 1]]}, …]}, each with "
    "one of box, half_space and ball";
constexpr const char* kFrameForm =
    "give {\"regions\": [{\"frame\": \"hand\", \"radius\": 0.1, \"epsilon\": \"0.2%\"}, …]}, each "
    "with a frame and one of radius, box, half_space and ball, or with a link";

/// One region of the text.
class RegionReader {
 public:
  /// @param name  that messages call it by, after that of the text, unless it states one itself
  /// @param form  how regions of the text are to look
  RegionReader(const json& entry, std::string text, std::string name, const char* form)
      : entry_(entry), text_(std::move(text)), name_(std::move(name)), form_(form) {}

  geom::RequestedRegion read() const {
    geom::RequestedRegion out;
    take(out, nullptr, nullptr);
    return out;
  }

  /// @pre the last of the regions may be this one
  /// @throws Error{InvalidInput} where another one has its name: verdicts are told apart by it
  template <class Regions>
  void require_own_name(const Regions& regions) const {
    for (std::size_t i = 0; i + 1 < regions.size(); ++i)
      if (regions[i].name == regions.back().name)
        fail("the name " + regions[i].name + " is another region's: give each a name of its own");
  }

  /// A region of a robot, or a link.
  void read(geom::FrameRegions& all) const {
    geom::FrameRegions::Fixed out;
    std::optional<std::string> frame, link;
    out.place = std::string(text_).append(": ").append(name_);
    const bool has_shape = take(out, &frame, &link);
    out.epsilon = out.epsilon.in("m");
    if (link) {
      if (frame || has_shape) fail("a link is meant as a whole: it has an epsilon only");
      all.links.push_back({*link, out.epsilon, out.place});
      return;
    }
    if (!frame) fail("frame is missing: the name of a link that the region is fixed to");
    out.frame = *frame;
    all.regions.push_back(std::move(out));
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(ErrorCode::InvalidInput,
                std::string(text_).append(": ").append(name_).append(": ").append(why));
  }

  /// @param frame, link  of a robot's; null: it has none
  /// @return whether it has a shape, which all but whole links need
  bool take(geom::RequestedRegion& out, std::optional<std::string>* frame,
            std::optional<std::string>* link) const {
    if (!entry_.is_object()) fail(form_);
    int shapes = 0;
    out.name = name_;
    for (const auto& [key, value] : entry_.items()) {
      if (key == "name") {
        out.name = std::string("'").append(text_of(value, "name")).append("'");
      } else if (key == "epsilon") {
        out.epsilon = length(value);
      } else if (key == "box" || key == "half_space" || key == "ball") {
        ++shapes;
        out.region = key == "box" ? box(value) : key == "ball" ? ball(value) : half_space(value);
      } else if (frame != nullptr && key == "radius") {
        ++shapes;
        out.region = about({0, 0, 0}, value);
      } else if (frame != nullptr && (key == "frame" || key == "link")) {
        *(key == "frame" ? frame : link) = text_of(value, key.c_str());
      } else if (key == "frame" || key == "link") {
        fail("a mesh has no frames and no links: '" + key + "' is for robots");
      } else {
        fail("there is no member '" + key + "'; " + form_);
      }
    }
    if (shapes != 1 && (link == nullptr || !*link || shapes > 1))
      fail(frame != nullptr
               ? "one of radius, box, half_space and ball is needed, and no other one, or a link"
               : "one of box, half_space and ball is needed, and no other one");
    if (!(out.epsilon.value > 0)) fail("epsilon is missing");
    return shapes == 1;
  }

  std::string text_of(const json& value, const char* name) const {
    if (!value.is_string()) fail(std::string(name) + " is no text");
    return value.get<std::string>();
  }

  Length length(const json& value) const {
    if (value.is_number() && value.get<double>() > 0 && std::isfinite(value.get<double>()))
      return {value.get<double>()};
    if (value.is_string())
      if (const auto parsed = parse_length(value.get<std::string>())) return *parsed;
    fail("epsilon must be a positive number, or a text such as \"0.2%\" or \"2mm\"");
  }

  double number(const json& value, const char* name) const {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(std::string(name) + " must be a number");
    return value.get<double>();
  }

  geom::Vec3 point(const json& value, const char* name) const {
    if (!value.is_array() || value.size() != 3) fail(std::string(name) + " must be three numbers");
    return {number(value[0], name), number(value[1], name), number(value[2], name)};
  }

  const json& member(const json& of, const char* name, std::size_t count) const {
    if (!of.is_object() || !of.contains(name) || of.size() != count)
      fail(std::string("half_space has normal and offset, ball has center and radius, and no "
                       "other members: ") +
           name + " is looked for");
    return of.at(name);
  }

  geom::Region box(const json& value) const {
    if (!value.is_array() || value.size() != 2) fail("box must be two corners");
    const geom::Vec3 low = point(value[0], "box"), high = point(value[1], "box");
    if (!(low.array() <= high.array()).all()) fail("box: the lower corner comes first");
    return geom::box_region({low, high});
  }

  geom::Region half_space(const json& value) const {
    const geom::Vec3 normal = point(member(value, "normal", 2), "normal");
    const double length = normal.norm();
    if (!(length > 1e-100 && length < 1e100)) fail("normal must have a direction");
    geom::Region out;
    out.sides = {{normal / length, number(member(value, "offset", 2), "offset") / length}};
    return out;
  }

  geom::Region ball(const json& value) const {
    return about(point(member(value, "center", 2), "center"), member(value, "radius", 2));
  }

  geom::Region about(const geom::Vec3& center, const json& radius) const {
    geom::Region out;
    out.center = center;
    out.radius = number(radius, "radius");
    if (!(out.radius > 0)) fail("radius must be above 0");
    return out;
  }

  const json& entry_;
  std::string text_, name_;
  const char* form_;
};

/// Refuses members that are given twice, of which a parser would take the last one.
/// @throws Error{InvalidInput} naming the text and the region
json parse_json(std::string_view text, const std::string& name) {
  using Event = json::parse_event_t;
  constexpr int kRegionDepth = 2;  // brackets round the one that begins a region
  std::size_t regions = 0;         // that have begun
  std::vector<std::set<std::string>> members;
  const auto fail = [&](const std::string& why) -> void {
    const std::string place =
        members.size() > 1 ? "region " + std::to_string(regions) + ": " : std::string();
    throw Error(ErrorCode::InvalidInput, std::string(name).append(": ").append(place).append(why));
  };
  if (is_nested_too_deep(text)) fail(describe_json_depth());
  const auto look = [&](int depth, Event event, json& value) {
    if (event == Event::object_start) {
      members.emplace_back();
      if (depth == kRegionDepth) ++regions;
    }
    if (event == Event::object_end) members.pop_back();
    if (event == Event::key && !members.back().insert(value.get<std::string>()).second)
      fail("'" + value.get<std::string>() + "' is given twice");
    return true;
  };
  json out;
  try {
    out = json::parse(text, look);
  } catch (const json::parse_error& error) {
    fail(describe_json_damage(text, error.byte));
  } catch (const json::exception&) {
    fail("a number in it is out of range");
  }
  return out;
}

/// Calls `take` with each region of a text.
template <class Take>
void for_each_region(std::string_view text, const std::string& name, const char* form,
                     const Take& take) {
  const json all = parse_json(text, name);
  if (!all.is_object() || all.size() != 1 || !all.contains("regions") ||
      !all["regions"].is_array() || all["regions"].empty())
    throw Error(ErrorCode::InvalidInput, name + ": " + form);
  std::size_t count = 0;
  for (const json& entry : all["regions"])
    take(RegionReader(entry, name, "region " + std::to_string(++count), form));
}

/// What `parse` makes of a file.
template <class Parse>
auto of_file(const std::string& file, const Parse& parse) {
  const std::vector<char> bytes = read_file(file);
  return parse(std::string_view(bytes.data(), bytes.size()), file == "-" ? "standard input" : file);
}

}  // namespace

std::vector<geom::RequestedRegion> parse_regions(std::string_view text, const std::string& name) {
  std::vector<geom::RequestedRegion> out;
  for_each_region(text, name, kMapForm, [&](const RegionReader& one) {
    out.push_back(one.read());
    one.require_own_name(out);
  });
  return out;
}

std::vector<geom::RequestedRegion> read_regions(const std::string& file) {
  return of_file(file, parse_regions);
}

geom::FrameRegions parse_frame_regions(std::string_view text, const std::string& name) {
  geom::FrameRegions out;
  for_each_region(text, name, kFrameForm, [&](const RegionReader& one) {
    one.read(out);
    one.require_own_name(out.regions);
  });
  return out;
}

geom::FrameRegions read_frame_regions(const std::string& file) {
  return of_file(file, parse_frame_regions);
}

}  // namespace kaboum::io
