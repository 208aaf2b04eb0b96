// Things of a scene as a command line names them.

#include "names.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/robot/base_pose.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "common/arguments.h"

namespace kaboum::tools {

scene::NamedFile parse_named_file(const std::string& text, const char* option) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size() ||
      text.find('/') < equals)
    throw Error(ErrorCode::InvalidArgument,
                std::string(option) + ": NAME=FILE is expected, not '" + text + "'");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

scene::NamedPrimitive parse_primitive(const std::string& text, const char* option,
                                      const std::string& unit) {
  using Kind = world::Primitive::Kind;
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::InvalidArgument,
                std::string(option) +
                    ": NAME=box:X,Y,Z, sphere:R, cylinder:R,LENGTH, capsule:R,LENGTH or "
                    "plane:X,Y,Z is expected, not '" +
                    text + "'" + why);
  };
  const auto equals = text.find('='), colon = text.find(':');
  if (equals == std::string::npos || equals == 0 || colon == std::string::npos || colon < equals)
    refuse("");
  const std::string kind = text.substr(equals + 1, colon - equals - 1);
  std::vector<double> sizes;
  for (std::size_t begin = colon + 1, end = 0; end < text.size(); begin = end + 1) {
    end = std::min(text.find(',', begin), text.size());
    const std::optional<Length> length = parse_length(text.substr(begin, end - begin));
    if (!length || length->percent)
      refuse("; sizes are lengths in " + unit + ", or with a unit, as in 40cm");
    sizes.push_back(length->in(unit).value);
    if (!(sizes.back() >= 1e-9 && sizes.back() <= 1e9))
      refuse("; sizes are from 1e-9 to 1e9 " + unit);
  }
  scene::NamedPrimitive out{text.substr(0, equals), {}};
  world::Primitive& p = out.primitive;
  const auto need = [&](std::size_t count) {
    if (sizes.size() != count)
      refuse("; " + kind + " has " + std::to_string(count) + (count == 1 ? " size" : " sizes"));
  };
  if (kind == "box" || kind == "plane") {
    need(3);
    p.kind = kind == "box" ? Kind::Box : Kind::Plane;
    p.size = {sizes[0], sizes[1], sizes[2]};
  } else if (kind == "sphere") {
    need(1);
    p.kind = Kind::Sphere;
    p.radius = sizes[0];
  } else if (kind == "cylinder" || kind == "capsule") {
    need(2);
    p.kind = kind == "cylinder" ? Kind::Cylinder : Kind::Capsule;
    p.radius = sizes[0];
    p.length = sizes[1];
  } else {
    refuse("");
  }
  return out;
}

std::map<std::string, geom::Transform> parse_places(const std::vector<std::string>& texts,
                                                    const char* option) {
  std::map<std::string, geom::Transform> out;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorCode::InvalidArgument,
                  std::string(option) + ": NAME=POSE is expected, not '" + text + "'");
    const std::string name = text.substr(0, equals);
    if (!out.emplace(name, robot::parse_pose(text.substr(equals + 1), option + (" " + name)))
             .second)
      throw Error(ErrorCode::InvalidArgument,
                  std::string(option) + ": '" + name + "' is placed twice");
  }
  return out;
}

std::map<std::string, double> parse_scales(const std::vector<std::string>& texts,
                                           const char* option) {
  std::map<std::string, double> out;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    std::string factor = equals == std::string::npos ? "" : text.substr(equals + 1);
    if (const std::string why = number_from(1e-9, 1e9)(factor); equals == 0 || !why.empty())
      throw Error(ErrorCode::InvalidArgument, std::string(option) +
                                                  ": NAME=FACTOR is expected, not '" + text + "'" +
                                                  (factor.empty() ? "" : "; the factor " + why));
    if (!out.emplace(text.substr(0, equals), parse_length(factor)->value).second)
      throw Error(ErrorCode::InvalidArgument,
                  std::string(option) + ": '" + text.substr(0, equals) + "' is scaled twice");
  }
  return out;
}

}  // namespace kaboum::tools
