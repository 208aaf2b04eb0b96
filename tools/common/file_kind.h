#pragma once

#include <string>

/// What kind of file somebody names, for messages about files of another kind.
namespace kaboum::tools {

enum class FileKind {
  Spheres,  ///< of a robot's links: cuRobo's YAML, XRDF, SRDF
  Robot,    ///< URDF, xacro, MJCF, SDF
  Mesh,     ///< a mesh, or a set of bodies of one
  Other,    ///< none of these, as far as the name tells
};

/// By the name.
FileKind kind_of(const std::string& path);

/// "a file of spheres", "a robot", "a mesh or a set of bodies"; of Other "a file of another kind".
const char* in_words(FileKind kind);

}  // namespace kaboum::tools
