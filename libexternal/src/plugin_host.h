#pragma once

#include <string>

#include <kaboum/external/line_channel.h>

namespace kaboum::external {

/// Loads a shared library and answers for its functions until there are no more questions. What
/// goes wrong is told through the socket.
void serve_plugin(const std::string& file, LineSocket& lines);

}  // namespace kaboum::external
