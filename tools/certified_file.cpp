#include "certified_file.h"

#include <filesystem>

#include "cli.h"

namespace kaboum::tools {

std::optional<CertifiedFile> certify_file(const std::string& file, const std::string& format,
                                          certify::SetRequest request,
                                          const certify::SetCache* cache,
                                          const certify::Hooks& hooks) {
  std::vector<char> bytes;
  io::ReadResult read = io::read_mesh(file, format_for(file, format, "--input-format"), &bytes);
  if (hooks.note)
    for (const std::string& text : read.notes) hooks.note(text);
  request.source = std::filesystem::path(file).filename().string();
  CertifiedFile out{io::sha256(bytes), std::move(read.notes), std::move(read.other_files), {}};
  auto found = naming(
      file, [&] { return certify::find_or_certify(read.mesh, out.sha256, request, cache, hooks); });
  if (!found) return std::nullopt;
  out.found = std::move(*found);
  return out;
}

std::string too_coarse(const std::string& file) {
  return file +
         ": float32 is too coarse so far from the origin (or for this epsilon); move the mesh to "
         "the origin";
}

}  // namespace kaboum::tools
