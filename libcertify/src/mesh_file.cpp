// Mesh files: read, then certified; errors name them.

#include <kaboum/base/sha256.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/io/file_unit.h>

#include "known_file.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

/// The triangles of a file; those of a CAD file stand for its exact faces, which a wrap holds.
io::ReadResult read_triangles(const fs::path& file, std::optional<io::Format> format,
                              std::vector<char>& bytes, SetRequest& request) {
  io::ReadResult read = io::read_mesh(file, format, &bytes);
  io::scale(read, request.scale, file == "-" ? "standard input" : file.string());
  const bool outer = request.direction == SetRequest::Direction::Outer;
  hold_exact_faces(read, outer && request.hold_exact_faces, request.wrap);
  return read;
}

void say(const std::vector<std::string>& notes, const Hooks& hooks) {
  if (!hooks.note) return;
  for (const std::string& text : notes) hooks.note(text);
}

/// Why float32 does not do for what lies round a mesh.
std::string words_of(const geom::Mesh& mesh, const std::optional<Length>& epsilon,
                     const SpacingShares& shares, const std::string& remedy) {
  const geom::Box3 box = geom::bounding_box(mesh);
  std::optional<double> length;
  if (epsilon) length = epsilon->of(box.diagonal());
  if (const auto shortage = too_coarse(box, length, shares))
    return reason_of(*shortage) + "; " + remedy + remedy_of(*shortage);
  return "float32 is too coarse for what lies round it, so far from the origin and for this "
         "epsilon; " +
         remedy + "move the mesh to the origin, or allow a larger epsilon";
}

void warn(const SetRequest& request, const SetCertificate& c, const Hooks& hooks) {
  const double diagonal = c.wrap ? c.wrap->diagonal : c.diagonal;
  if (const std::string text = warning_of(request.wanted_epsilon(), diagonal); !text.empty())
    say({text}, hooks);
}

bool has_exact_faces(const fs::path& file, std::optional<io::Format> format) {
  if (!format) format = io::format_from_name(file.extension().string());
  return format && io::is_cad(*format);
}

/// The result of an earlier run, where the file has the bytes that it had then.
std::optional<CertifiedFile> find_file(const fs::path& file, std::optional<io::Format> format,
                                       const SetRequest& request, const SetCache& cache,
                                       const Hooks& hooks) {
  if (file == "-" || has_exact_faces(file, format)) return std::nullopt;
  const std::optional<KnownFile> known =
      find_known(CacheFolder(cache.folder()), file, format, request.scale);
  if (!known) return std::nullopt;
  std::string flaw;
  std::vector<std::string> notes = known->notes;
  const SetRequest asked = in_unit_of_file(request, known->unit, notes);
  auto set = cache.find(SetCache::key_of(known->mesh_hash, known->sha256, asked), flaw);
  if (!set) return std::nullopt;
  say(notes, hooks);
  say(set->certificate().notes, hooks);
  warn(asked, set->certificate(), hooks);
  return CertifiedFile{known->sha256, std::move(notes), {}, {std::move(*set), true}};
}

}  // namespace

TooCoarse::TooCoarse(const std::string& file)
    : Error(ErrorCode::InvalidInput,
            file +
                ": float32 is too coarse so far from the origin, or for this epsilon; move the "
                "mesh to the origin, or allow a larger epsilon") {}

TooCoarse::TooCoarse(const std::string& file, const geom::Mesh& mesh,
                     const std::optional<Length>& epsilon, const SpacingShares& shares,
                     const std::string& remedy)
    : Error(ErrorCode::InvalidInput, file + ": " + words_of(mesh, epsilon, shares, remedy)) {}

CertifiedFile certify_file(const fs::path& file, std::optional<io::Format> format,
                           SetRequest request, const SetCache* cache, const Hooks& hooks) {
  request.source = file.filename().string();
  if (cache != nullptr)
    if (auto found = find_file(file, format, request, *cache, hooks)) return std::move(*found);
  std::vector<char> bytes;
  io::ReadResult read = read_triangles(file, format, bytes, request);
  std::vector<std::string> notes = read.notes;
  request = in_unit_of_file(std::move(request), read.unit, notes);
  say(notes, hooks);
  request.preparation.quads = read.bent_quads;
  request.preparation.diagonal = request.direction == SetRequest::Direction::Outer
                                     ? geom::PrepareOptions::Diagonal::Outward
                                     : geom::PrepareOptions::Diagonal::Inward;
  const std::string sha256 = kaboum::sha256(bytes);
  if (cache != nullptr && file != "-" && !io::is_cad(read.format))
    store_known(CacheFolder(cache->folder()), file, format, request.scale, bytes.size(), sha256,
                SetCache::hash_of(read.mesh), read);
  auto found = [&] {
    try {
      return find_or_certify(read.mesh, sha256, request, cache, hooks);
    } catch (const Error& error) {
      throw Error(error.code(),
                  (file == "-" ? "standard input" : file.string()) + ": " + error.what());
    }
  }();
  if (!found) {
    const std::optional<Length> epsilon = request.wanted_epsilon();
    throw TooCoarse(file.string(), read.mesh, epsilon, epsilon ? kSetSpacing : kMeshSpacing);
  }
  warn(request, found->set.certificate(), hooks);
  return {sha256, std::move(notes), std::move(read.other_files), std::move(*found)};
}

}  // namespace kaboum::certify
