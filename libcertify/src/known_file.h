#pragma once

#include <kaboum/certify/cache_folder.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// What reading a file gave before, so that a cached result is found without reading it: large files
// take longer to read than all else. Internal to kaboum_certify.
namespace kaboum::certify {

struct KnownFile {
  std::string sha256;     ///< of the file's bytes
  std::string mesh_hash;  ///< SetCache::hash_of its triangles
  std::vector<std::string> notes;
  std::string unit;
};

/// What is known of a file with the bytes that it has now.
/// @param format  by default by extension
/// @param scale   of its coordinates (io::scale)
/// @throws Error{InvalidInput} when it cannot be read.
std::optional<KnownFile> find_known(const CacheFolder& cache, const std::filesystem::path& file,
                                    std::optional<io::Format> format, double scale);

/// Keeps what reading gave; nothing where other files were read, too, or where the file is so small
/// that reading it takes no time.
/// @param bytes, sha256  of the file when it was read; the mesh is what it was scaled to.
void store_known(const CacheFolder& cache, const std::filesystem::path& file,
                 std::optional<io::Format> format, double scale, std::size_t bytes,
                 const std::string& sha256, const std::string& mesh_hash,
                 const io::ReadResult& read);

}  // namespace kaboum::certify
