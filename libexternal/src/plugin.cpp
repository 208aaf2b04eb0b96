// External functions of a shared library, in a process of its own: a crash or a call without an end
// is that process's.

#include <kaboum/base/error.h>
#include <kaboum/external/plugin.h>

#include <memory>

#include "asked_process.h"
#include "plugin_host.h"

namespace kaboum::external {

plan::ExternalBindings load_plugin(const std::string& file, const ProcessOptions& options) {
  if (!(options.most_seconds > 0))
    throw Error(ErrorCode::InvalidArgument, "the time for an answer is not above 0");
  const auto process =
      std::make_shared<AskedProcess>("plug-in '" + file + "'", options, file,
                                     [&](LineSocket& lines) { serve_plugin(file, lines); });
  return AskedProcess::bindings(process);
}

void merge(plan::ExternalBindings& all, const plan::ExternalBindings& more,
           const std::string& origin) {
  for (const auto& [name, function] : more)
    if (!all.emplace(name, function).second)
      throw Error(ErrorCode::InvalidInput, std::string("external function '")
                                               .append(name)
                                               .append("' is bound twice; the second time by ")
                                               .append(origin));
}

}  // namespace kaboum::external
