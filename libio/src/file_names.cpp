// Names of files: plain characters only, and no name twice.

#include <kaboum/io/file_names.h>

#include <algorithm>

namespace kaboum::io {
namespace {

std::string lower(std::string s) {
  std::transform(s.begin(), s.end(), s.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return s;
}

}  // namespace

std::string plain_file_name(const std::string& wish) {
  std::string name;
  for (const char c : wish) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    name += plain ? c : '_';
  }
  if (name.empty() || name.front() == '.') name = std::string("_").append(name);
  return name;
}

std::string FileNames::unique(const std::string& wish) {
  const std::string name = plain_file_name(wish);
  std::string result = name;
  for (int i = 2; !taken_.insert(lower(result)).second; ++i)
    result = name + "-" + std::to_string(i);
  return result;
}

void FileNames::reserve(const std::string& name) { taken_.insert(lower(name)); }

}  // namespace kaboum::io
