#include "set_cache.h"

#include <kaboum/geom/error.h>

#include <algorithm>
#include <cstdlib>

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

fs::path directory() {
  const auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  if (fs::path p = variable("KABOUM_CACHE"); !p.empty()) return p;
  if (const fs::path p = variable("XDG_CACHE_HOME"); p.is_absolute()) return p / "kaboum";
  if (const fs::path p = variable("HOME"); !p.empty()) return p / ".cache" / "kaboum";
  return {};
}

}  // namespace

SetCache::SetCache(const std::string& key) {
  const fs::path where = directory();
  if (!where.empty()) path_ = where / (io::sha256({key.data(), key.size()}) + ".set");
}

// An entry is the hash of the rest, a line feed, the report in one line, and the container.
std::optional<SetCache::Entry> SetCache::find() const {
  std::error_code error;
  if (path_.empty() || !fs::is_regular_file(path_, error)) return std::nullopt;
  std::vector<char> bytes;
  try {
    bytes = io::read_file(path_);
  } catch (const Error&) {
    return std::nullopt;
  }
  constexpr std::size_t kHash = 64;
  if (bytes.size() <= kHash + 1) return std::nullopt;
  const std::span<const char> rest = std::span<const char>(bytes).subspan(kHash + 1);
  const std::string stated(bytes.begin(), bytes.begin() + kHash);
  if (io::sha256(rest) != stated) return std::nullopt;
  const auto end = std::find(rest.begin(), rest.end(), '\n');
  if (end == rest.end()) return std::nullopt;
  Entry entry;
  entry.report = Json::parse(rest.begin(), end, nullptr, false);
  if (entry.report.is_discarded()) return std::nullopt;
  entry.container.assign(end + 1, rest.end());
  return entry;
}

void SetCache::store(const Entry& entry) const {
  if (path_.empty()) return;
  std::string rest = entry.report.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  rest.append(entry.container.begin(), entry.container.end());
  const std::string bytes = io::sha256({rest.data(), rest.size()}) + "\n" + rest;
  std::error_code error;
  fs::create_directories(path_.parent_path(), error);
  try {
    io::write_file(path_, {bytes.data(), bytes.size()});
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a cache is a convenience
  }
}

}  // namespace kaboum::tools
