#pragma once

#include <kaboum/certify/set_cache.h>
#include <kaboum/io/mesh_io.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::tools {

/// A mesh file's certified set.
struct CertifiedFile {
  std::string sha256;                    ///< of the file
  std::vector<std::string> read_notes;   ///< what its reader noted; noted already
  std::vector<std::string> other_files;  ///< read besides it
  certify::FoundSet found;
};

/// Reads the file and finds or certifies its set.
/// @param format   option of the command line; empty: by extension.
/// @param request  its source becomes the file's name.
/// @param cache    null: none.
/// @return nullopt when float32 is too coarse, see certify::certify_set.
/// @throws Error naming the file.
std::optional<CertifiedFile> certify_file(const std::string& file, const std::string& format,
                                          certify::SetRequest request,
                                          const certify::SetCache* cache,
                                          const certify::Hooks& hooks);

/// What is said of a file for which there is nothing.
std::string too_coarse(const std::string& file);

}  // namespace kaboum::tools
