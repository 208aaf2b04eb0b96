#pragma once

#include <kaboum/base/error.h>
#include <kaboum/certify/float32_shortage.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// A mesh file's certified set.
struct CertifiedFile {
  std::string sha256;                    ///< of the file
  std::vector<std::string> read_notes;   ///< of its reader and its unit; noted already
  std::vector<std::string> other_files;  ///< read besides it
  FoundSet found;
};

/// float32 cannot hold bodies as near to this file's mesh as asked for (certify_set).
class TooCoarse : public Error {
 public:
  explicit TooCoarse(const std::string& file);
  /// With figures, and a remedy that helps.
  /// @param remedy  what else helps
  TooCoarse(const std::string& file, const geom::Mesh& mesh, const std::optional<Length>& epsilon,
            const SpacingShares& shares, const std::string& remedy = "");
};

/// Reads the file and finds or certifies its set. Where the file or its format states a unit, the
/// set says that unit of the vertices as read, whatever the request says: in a note where that is
/// another one. A CAD file's triangles stand for its exact faces (io::ReadResult::deviation): an
/// outer set holds these, as SetRequest::hold_exact_faces asks, and how far they may be from the
/// triangles counts towards epsilon.
/// @param format   by default by extension.
/// @param request  its source becomes the file's name.
/// @param cache    null: none.
/// @throws Error naming the file, as find_or_certify; TooCoarse.
CertifiedFile certify_file(const std::filesystem::path& file, std::optional<io::Format> format,
                           SetRequest request, const SetCache* cache = nullptr,
                           const Hooks& hooks = {});

}  // namespace kaboum::certify
