// External functions of another program, asked by JSON lines.

#include <kaboum/base/error.h>
#include <kaboum/external/process.h>

#include <memory>

#include "asked_process.h"

namespace kaboum::external {

plan::ExternalBindings start_process(const std::string& command, const ProcessOptions& options) {
  if (!(options.most_seconds > 0))
    throw Error(ErrorCode::InvalidArgument, "the time for an answer is not above 0");
  const auto process =
      std::make_shared<AskedProcess>("program '" + command + "'", options, command);
  return AskedProcess::bindings(process);
}

}  // namespace kaboum::external
