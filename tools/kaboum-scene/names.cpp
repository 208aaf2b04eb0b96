// Things of a scene as a command line names them.

#include "names.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/robot/base_pose.h>

#include <CLI/CLI.hpp>

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
