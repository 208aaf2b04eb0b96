// Mesh files: read, then certified; errors name them.

#include <kaboum/certify/mesh_file.h>
#include <kaboum/io/cad.h>

namespace kaboum::certify {
namespace {

/// The triangles of a file; those of a CAD file stand for its exact faces, which a wrap holds.
io::ReadResult read_triangles(const std::filesystem::path& file, std::optional<io::Format> format,
                              std::vector<char>& bytes, SetRequest& request) {
  if (format || !io::is_cad_file(file)) return io::read_mesh(file, format, &bytes);
  io::CadResult cad = io::read_cad(file, &bytes);
  if (request.wrap) request.wrap->clearance = cad.deviation;
  return std::move(cad.read);
}

}  // namespace

TooCoarse::TooCoarse(const std::string& file)
    : Error(ErrorCode::InvalidInput,
            file +
                ": float32 is too coarse so far from the origin (or for this epsilon); move the "
                "mesh to the origin") {}

CertifiedFile certify_file(const std::filesystem::path& file, std::optional<io::Format> format,
                           SetRequest request, const SetCache* cache, const Hooks& hooks) {
  std::vector<char> bytes;
  io::ReadResult read = read_triangles(file, format, bytes, request);
  if (hooks.note)
    for (const std::string& text : read.notes) hooks.note(text);
  request.source = file.filename().string();
  if (!read.unit.empty() && read.unit != request.unit) {
    if (hooks.note && !request.unit.empty())
      hooks.note("Its vertices are in " + read.unit + " as read, and so is its set, not in " +
                 request.unit + ".");
    request.unit = read.unit;
  }
  const std::string sha256 = io::sha256(bytes);
  auto found = [&] {
    try {
      return find_or_certify(read.mesh, sha256, request, cache, hooks);
    } catch (const Error& error) {
      throw Error(error.code(),
                  (file == "-" ? "standard input" : file.string()) + ": " + error.what());
    }
  }();
  if (!found) throw TooCoarse(file.string());
  return {sha256, std::move(read.notes), std::move(read.other_files), std::move(*found)};
}

}  // namespace kaboum::certify
