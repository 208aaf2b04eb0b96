#include "set_cache.h"

#include <kaboum/geom/error.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

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

// An entry is the name of this format, the hash of what follows, the hash of the key, the report in
// one line, and the container; the first four end with a line feed.
constexpr std::string_view kFormat = "KABOUM-SET 2\n";
constexpr std::size_t kHash = 64;

}  // namespace

SetCache::SetCache(const std::string& key) : key_(io::sha256({key.data(), key.size()})) {
  const fs::path where = directory();
  if (!where.empty()) path_ = where / (key_ + ".set");
}

std::optional<SetCache::Entry> SetCache::find(std::string& flaw) const {
  flaw.clear();
  std::error_code error;
  if (path_.empty() || !fs::is_regular_file(path_, error)) return std::nullopt;
  std::vector<char> bytes;
  try {
    bytes = io::read_file(path_);
  } catch (const Error&) {
    return std::nullopt;
  }
  const auto useless = [&](const char* why) {
    flaw = path_.string() + ": " + why;
    return std::nullopt;
  };
  std::string_view rest(bytes.data(), bytes.size());
  const auto take_hash = [&] {
    const std::string_view hash = rest.substr(0, kHash);
    rest.remove_prefix(std::min(kHash + 1, rest.size()));
    return hash;
  };
  if (!rest.starts_with(kFormat)) return useless("damaged, or of another version");
  rest.remove_prefix(kFormat.size());
  const std::string_view stated = take_hash();
  if (io::sha256(rest) != stated) return useless("damaged");
  if (take_hash() != key_) return useless("the result of another input or of other options");
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos) return useless("damaged");
  Entry entry;
  entry.report = Json::parse(rest.substr(0, end), nullptr, false);
  if (!entry.report.is_object()) return useless("damaged");
  entry.container.assign(rest.begin() + static_cast<std::ptrdiff_t>(end) + 1, rest.end());
  return entry;
}

void SetCache::store(const Entry& entry) const {
  if (path_.empty()) return;
  std::string rest =
      key_ + "\n" + entry.report.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  rest.append(entry.container.begin(), entry.container.end());
  const std::string bytes = std::string(kFormat) + io::sha256(rest) + "\n" + rest;
  std::error_code error;
  fs::create_directories(path_.parent_path(), error);
  try {
    io::write_file(path_, bytes);
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a cache is a convenience
  }
}

}  // namespace kaboum::tools
