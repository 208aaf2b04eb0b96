// A folder of results: entries by hash, checked by hash, the longest unused removed first.

#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>
#include <kaboum/certify/cache_folder.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fstream>

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

// An entry is a line that names its kind, the hash of what follows the next line feed, the hash of
// the key, and the content.
constexpr std::size_t kHash = 64;
constexpr const char* kExtension = ".set";

fs::path variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

bool is_hash(std::string_view text) {
  return text.size() == kHash && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

struct Parts {
  std::string_view kind, key, content;
};

/// @throws Error saying what is wrong
Parts split(std::string_view bytes) {
  const auto fail = [](const char* why) -> void { throw Error(ErrorCode::InvalidInput, why); };
  const std::size_t end = bytes.find('\n');
  if (!bytes.starts_with("KABOUM-") || end == std::string_view::npos)
    fail("damaged, or of another version");
  Parts parts{.kind = bytes.substr(0, end), .key = {}, .content = {}};
  std::string_view rest = bytes.substr(end + 1);
  if (rest.size() < 2 * kHash + 2 || rest[kHash] != '\n' || rest[2 * kHash + 1] != '\n')
    fail("damaged");
  const std::string_view stated = rest.substr(0, kHash);
  rest.remove_prefix(kHash + 1);
  if (kaboum::sha256(rest) != stated) fail("damaged");
  parts.key = rest.substr(0, kHash);
  parts.content = rest.substr(kHash + 1);
  return parts;
}

/// Left by a writer that was ended: io::write_file's temporary files, an hour old.
bool is_left_behind(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  if (!name.starts_with(".kaboum-") || !name.ends_with(".tmp")) return false;
  std::error_code error;
  const auto written = entry.last_write_time(error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(1);
}

}  // namespace

fs::path CacheFolder::default_folder() {
  if (fs::path p = variable("KABOUM_CACHE"); !p.empty()) return p;
  if (const fs::path p = variable("XDG_CACHE_HOME"); p.is_absolute()) return p / "kaboum";
  if (const fs::path p = variable("HOME"); !p.empty()) return p / ".cache" / "kaboum";
  return {};
}

std::uintmax_t CacheFolder::size_limit() {
  constexpr std::uintmax_t kDefault = std::uintmax_t{4} << 30U;
  const std::string text = variable("KABOUM_CACHE_SIZE").string();
  if (text.empty()) return kDefault;
  std::uintmax_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  constexpr std::array<std::pair<std::string_view, unsigned>, 5> kUnits{
      {{"", 0}, {"K", 10}, {"M", 20}, {"G", 30}, {"T", 40}}};
  for (const auto& [name, shift] : kUnits)
    if (error == std::errc() && unit == name && value <= (UINTMAX_MAX >> shift))
      return value << shift;
  throw Error(ErrorCode::InvalidArgument,
              "$KABOUM_CACHE_SIZE must be a size such as 500M or 2G, not " + text);
}

std::optional<std::string> CacheFolder::find(std::string_view kind, const std::string& key,
                                             std::string& flaw) const {
  flaw.clear();
  if (folder_.empty()) return std::nullopt;
  const fs::path path = folder_ / (key + kExtension);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  try {
    const std::vector<char> bytes = io::read_file(path);
    const Parts parts = split({bytes.data(), bytes.size()});
    if (parts.kind != kind) throw Error(ErrorCode::InvalidInput, "damaged, or of another version");
    if (parts.key != key)
      throw Error(ErrorCode::InvalidInput, "the result of another input or of other options");
    fs::last_write_time(path, fs::file_time_type::clock::now(), error);  // used
    return std::string(parts.content);
  } catch (const Error& why) {
    // One that was removed meanwhile is just not there.
    if (fs::is_regular_file(path, error)) flaw = path.string() + ": " + why.what();
    return std::nullopt;
  }
}

void CacheFolder::store(std::string_view kind, const std::string& key,
                        std::string_view content) const {
  if (folder_.empty()) return;
  const std::string rest = key + "\n" + std::string(content);
  const std::string bytes = std::string(kind) + "\n" + kaboum::sha256(rest) + "\n" + rest;
  std::error_code error;
  fs::create_directories(folder_, error);
  try {
    io::write_file(folder_ / (key + kExtension), bytes);
    // Looking at all entries takes longer than storing one; keys are as good as random.
    if (key.ends_with('0') && std::string_view("0123").find(key[kHash - 2]) != std::string::npos)
      prune(size_limit());
  } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a cache is a convenience
  }
}

std::vector<CacheFolder::Entry> CacheFolder::entries() const {
  std::vector<Entry> out;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(folder_, error)) {
    if (file.path().extension() != kExtension || !is_hash(file.path().stem().string())) continue;
    Entry entry{.path = file.path(), .bytes = 0, .used = {}};
    entry.bytes = file.file_size(error);
    if (!error) entry.used = file.last_write_time(error);
    if (!error) out.push_back(std::move(entry));  // others were removed meanwhile
  }
  std::sort(out.begin(), out.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.used, a.path) < std::tie(b.used, b.path);
  });
  return out;
}

std::vector<CacheFolder::Entry> CacheFolder::prune(std::uintmax_t most) const {
  std::vector<Entry> removed;
  const std::vector<Entry> all = entries();
  std::uintmax_t sum = 0;
  for (const Entry& entry : all) sum += entry.bytes;
  std::error_code error;
  for (const Entry& entry : all) {
    if (sum <= most) break;
    sum -= entry.bytes;
    if (fs::remove(entry.path, error)) removed.push_back(entry);
  }
  for (const fs::directory_entry& file : fs::directory_iterator(folder_, error))
    if (is_left_behind(file)) fs::remove(file.path(), error);
  return removed;
}

std::string CacheFolder::flaw_of(const Entry& entry) {
  try {
    const std::vector<char> bytes = io::read_file(entry.path);
    const Parts parts = split({bytes.data(), bytes.size()});
    return parts.key == entry.path.stem().string() ? "" : "it lies under another one's name";
  } catch (const Error& why) {
    return why.what();
  }
}

std::string CacheFolder::kind_of(const Entry& entry) {
  std::ifstream file(entry.path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  return line.starts_with("KABOUM-") && line.size() < 40 ? line : "";
}

}  // namespace kaboum::certify
