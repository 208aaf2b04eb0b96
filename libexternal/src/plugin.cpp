// External functions of a shared library.

#include <dlfcn.h>
#include <kaboum/base/error.h>
#include <kaboum/external/plugin.h>

#include <exception>

namespace kaboum::external {

plan::ExternalBindings load_plugin(const std::string& file) {
  const auto fail = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidInput, file + ": " + what);
  };
  // A name without a slash would be looked for in the system's folders.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) fail(std::string("cannot be loaded: ") + dlerror());
  using Entry = void (*)(plan::ExternalBindings&);
  const auto entry = reinterpret_cast<Entry>(dlsym(library, kPluginEntry));
  if (entry == nullptr)
    fail(std::string("has no function ") + kPluginEntry + " (docs/planning/externals.md)");
  plan::ExternalBindings out;
  try {
    entry(out);
  } catch (const std::exception& error) {
    fail(std::string(kPluginEntry) + " failed: " + error.what());
  }
  if (out.empty()) fail(std::string(kPluginEntry) + " binds no functions");
  return out;
}

void merge(plan::ExternalBindings& all, plan::ExternalBindings more, const std::string& origin) {
  for (auto& [name, function] : more)
    if (!all.emplace(name, std::move(function)).second)
      throw Error(ErrorCode::InvalidInput,
                  "external function '" + name + "' is bound twice; the second time by " + origin);
}

}  // namespace kaboum::external
