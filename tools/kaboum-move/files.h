#pragma once

#include <string>

#include "request.h"

/// The files that kaboum-move writes: what was certified is what they hold.
namespace kaboum::tools {

/// A path as it is written and as any program reads it back.
struct WrittenPath {
  std::string csv;
  robot::Path path;
};

/// In radians the path itself is read back; in degrees one that differs by roundings, which is
/// certified anew. @throws Error{LimitReached} where that fails.
WrittenPath write_path(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                       const world::Checker& checker);

struct Execution {
  std::string text;     ///< of the file
  std::string summary;  ///< one line: how long it takes, and what decides the file anew
  Json report;
};

/// The samples as they are written are certified anew, with straight lines between them.
/// @throws Error{LimitReached} where that fails, or there would be too many.
Execution execute(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                  const world::Checker& checker);

}  // namespace kaboum::tools
