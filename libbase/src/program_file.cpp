// The file that code is from.

#include <dlfcn.h>
#include <kaboum/base/program_file.h>

namespace kaboum {

std::filesystem::path program_file(const void* address) {
  Dl_info here{};
  if (::dladdr(address, &here) == 0 || here.dli_fname == nullptr) return {};
  std::error_code error;
  std::filesystem::path file(here.dli_fname);
  // Of a program that is what it was called as, which need not name it: the system knows better.
  if (file.extension() != ".so") file = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error || !file.is_absolute()) return {};
  file = std::filesystem::canonical(file, error);
  return error ? std::filesystem::path() : file;
}

}  // namespace kaboum
