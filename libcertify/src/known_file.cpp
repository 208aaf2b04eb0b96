// Files that were read before, told by all their bytes, their names and the readers' version.

#include "known_file.h"

#include <kaboum/base/error.h>
#include <kaboum/base/length.h>
#include <kaboum/base/sha256.h>

#include <nlohmann/json.hpp>

#include "cache_words.h"

namespace kaboum::certify {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kKind = "KABOUM-FILE 1";
constexpr std::size_t kReadAtOnce = std::size_t{1} << 15;  ///< [bytes]

std::string key_of_file(const std::filesystem::path& file, std::optional<io::Format> format,
                        double scale, const std::string& sha256) {
  // The name: notes may have it, and the format is that of its extension.
  return kaboum::sha256(std::string(kKind) + '\n' + sha256 + '\n' + file.string() + '\n' +
                        std::to_string(format ? static_cast<int>(*format) : -1) + '\n' +
                        Length{scale}.text() + '\n' + KABOUM_VERSION + '\n' +
                        std::string(cache_words::kReaders));
}

}  // namespace

std::optional<KnownFile> find_known(const CacheFolder& cache, const std::filesystem::path& file,
                                    std::optional<io::Format> format, double scale) {
  const std::string sha256 = kaboum::sha256(io::read_file(file));
  std::string flaw;  // it is written again
  const auto content = cache.find(kKind, key_of_file(file, format, scale, sha256), flaw);
  if (!content) return std::nullopt;
  try {
    const Json json = Json::parse(*content);
    return KnownFile{sha256, json.at("mesh").get<std::string>(),
                     json.at("notes").get<std::vector<std::string>>(),
                     json.at("unit").get<std::string>()};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

void store_known(const CacheFolder& cache, const std::filesystem::path& file,
                 std::optional<io::Format> format, double scale, std::size_t bytes,
                 const std::string& sha256, const std::string& mesh_hash,
                 const io::ReadResult& read) {
  // Of files with quads that are not plane more counts than what is kept here. Assimp may be
  // another one the next time.
  if (!read.other_files.empty() || bytes < kReadAtOnce || !read.bent_quads.empty() ||
      read.format == io::Format::Assimp)
    return;
  const Json json = {{"mesh", mesh_hash}, {"notes", read.notes}, {"unit", read.unit}};
  cache.store(kKind, key_of_file(file, format, scale, sha256),
              json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace kaboum::certify
