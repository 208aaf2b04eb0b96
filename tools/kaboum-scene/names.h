#pragma once

#include <kaboum/scene/scene_maker.h>

#include <map>
#include <string>
#include <vector>

/// Things of a scene as a command line names them.
namespace kaboum::tools {

/// "NAME=FILE".
/// @throws Error{InvalidArgument} naming the option.
scene::NamedFile parse_named_file(const std::string& text, const char* option);

/// "NAME=KIND:SIZES": box:X,Y,Z, sphere:R, cylinder:R,LENGTH, capsule:R,LENGTH or plane:X,Y,Z.
/// @param unit  that sizes are brought into
/// @throws Error{InvalidArgument} naming the option.
scene::NamedPrimitive parse_primitive(const std::string& text, const char* option,
                                      const std::string& unit);

/// "NAME=POSE" for each, see robot::parse_pose.
/// @throws Error{InvalidArgument} naming the option.
std::map<std::string, geom::Transform> parse_places(const std::vector<std::string>& texts,
                                                    const char* option);

/// "NAME=FACTOR" for each.
/// @throws Error{InvalidArgument} naming the option.
std::map<std::string, double> parse_scales(const std::vector<std::string>& texts,
                                           const char* option);

}  // namespace kaboum::tools
