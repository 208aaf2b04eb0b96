// JSON that says how near bodies are to be in regions.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/region_file.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace kaboum::io {
namespace {

using nlohmann::json;

constexpr const char* kMapForm =
    "give {\"regions\": [{\"epsilon\": \"0.2%\", \"box\": [[0, 0, 0], [1, 1, 1]]}, …]}, each with "
    "one of box, half_space and ball";

/// One region of the text.
class RegionReader {
 public:
  /// @param name  that messages call it by, after that of the text, unless it states one itself
  RegionReader(const json& entry, std::string text, std::string name)
      : entry_(entry), text_(std::move(text)), name_(std::move(name)) {}

  geom::RequestedRegion read() const {
    if (!entry_.is_object()) fail(kMapForm);
    int shapes = 0;
    geom::RequestedRegion out;
    out.name = name_;
    for (const auto& [key, value] : entry_.items()) {
      if (key == "name") {
        if (!value.is_string()) fail("name is no text");
        out.name = std::string("'").append(value.get<std::string>()).append("'");
      } else if (key == "epsilon") {
        out.epsilon = length(value);
      } else if (key == "box" || key == "half_space" || key == "ball") {
        ++shapes;
        out.region = key == "box" ? box(value) : key == "ball" ? ball(value) : half_space(value);
      } else {
        fail("there is no member '" + key + "'; " + kMapForm);
      }
    }
    if (shapes != 1) fail("one of box, half_space and ball is needed, and no other one");
    if (!(out.epsilon.value > 0)) fail("epsilon is missing");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Error(ErrorCode::InvalidInput,
                std::string(text_).append(": ").append(name_).append(": ").append(why));
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
    geom::Region out;
    out.center = point(member(value, "center", 2), "center");
    out.radius = number(member(value, "radius", 2), "radius");
    if (!(out.radius > 0)) fail("radius must be above 0");
    return out;
  }

  const json& entry_;
  std::string text_, name_;
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

}  // namespace

std::vector<geom::RequestedRegion> parse_regions(std::string_view text, const std::string& name) {
  const json all = parse_json(text, name);
  if (!all.is_object() || all.size() != 1 || !all.contains("regions") ||
      !all["regions"].is_array() || all["regions"].empty())
    throw Error(ErrorCode::InvalidInput, name + ": " + kMapForm);
  std::vector<geom::RequestedRegion> out;
  for (const json& entry : all["regions"]) {
    const std::string region = "region " + std::to_string(out.size() + 1);
    out.push_back(RegionReader(entry, name, region).read());
  }
  return out;
}

std::vector<geom::RequestedRegion> read_regions(const std::string& file) {
  const std::vector<char> bytes = read_file(file);
  return parse_regions({bytes.data(), bytes.size()}, file == "-" ? "standard input" : file);
}

}  // namespace kaboum::io
