// Certified sets kept between runs.

#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>
#include <kaboum/certify/cache_folder.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>

#include <bit>
#include <string_view>

#include "cache_words.h"
#include "issuer.h"
#include "request.h"
#include "set_record.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

// An entry's content is the certificate in one line, and the container.
constexpr std::string_view kFormat = "KABOUM-SET 3";

/// The version of the bodies' kind, as a line.
std::string word_of_kind(const SetRequest& r) {
  if (r.body_kind == SetRequest::BodyKind::Polytopes) return {};
  std::string_view word = cache_words::kSimple;
  if (r.body_kind == SetRequest::BodyKind::Spheres)
    word = r.direction == SetRequest::Direction::Outer ? cache_words::kBalls
                                                       : cache_words::kInnerBalls;
  return std::string(word) + '\n';
}

/// @throws Error saying why the entry is not that of the key.
CertifiedSet read_entry(std::string_view rest, const SetCache::Key& key) {
  const auto fail = [](const char* why) -> void { throw Error(ErrorCode::InvalidInput, why); };
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos) fail("damaged");
  SetCertificate certificate = read_record(rest.substr(0, end));
  std::vector<char> container(rest.begin() + static_cast<std::ptrdiff_t>(end) + 1, rest.end());
  geom::ConvexSet set = io::parse_convex_set(container, io::Format::Glb, "the container");
  const bool outer = certificate.direction == SetRequest::Direction::Outer;
  geom::Provenance expected = key.origin;
  expected.epsilon = set.provenance.epsilon;
  expected.covers_solid = outer && certificate.subject.holes == 0;
  expected.covers_surface = outer && certificate.subject.dropped_sheets == 0;
  if ((certificate.wrap ? !key.clearance : key.clearance && !key.may_be_unwrapped) ||
      (certificate.wrap && certificate.wrap->clearance != *key.clearance) ||
      certificate.distance_upper != set.provenance.epsilon)
    fail("it claims another wrap, or another distance than its container");
  if (set.provenance != expected || certificate.bodies != set.bodies.size() ||
      (!key.has_radii && geom::margin_of(set) != 0.0))
    fail("its container is that of another input or of other options");
  return Issuer::issue(std::move(set), std::move(certificate), std::move(container));
}

}  // namespace

fs::path SetCache::default_folder() { return CacheFolder::default_folder(); }

std::string SetCache::hash_of(const geom::Mesh& mesh) {
  std::vector<char> bytes;
  const auto append = [&](const void* data, std::size_t size) {
    const auto* begin = static_cast<const char*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  const std::uint64_t vertices = mesh.vertices.size();
  append(&vertices, sizeof vertices);
  for (const geom::Vec3& v : mesh.vertices) append(v.data(), 3 * sizeof(double));
  for (const geom::Triangle& t : mesh.triangles) append(t.data(), sizeof t);
  return kaboum::sha256(bytes);
}

SetCache::Key SetCache::key_of(const geom::Mesh& mesh, const std::string& sha256,
                               const SetRequest& r) {
  return key_of(hash_of(mesh), sha256, r);
}

SetCache::Key SetCache::key_of(const std::string& mesh_hash, const std::string& sha256,
                               const SetRequest& r) {
  const double clearance = r.wrap ? r.wrap->clearance : 0;
  std::string quads;  // that are split so as to enclose, or to be enclosed
  if (r.preparation.diagonal != geom::PrepareOptions::Diagonal::AsGiven)
    for (const std::uint32_t quad : r.preparation.quads) quads += ' ' + std::to_string(quad);
  if (!quads.empty()) quads += '\n';
  const std::string text =
      mesh_hash + '\n' + std::to_string(std::bit_cast<std::uint64_t>(clearance)) + '\n' + sha256 +
      '\n' + r.parameters() + '\n' + quads + r.unit + '\n' + r.frame + '\n' + r.source + '\n' +
      (r.wrap && r.wrap->where_needed ? "wrapped where needed\n" : "") + word_of_kind(r) +
      (r.nearest ? "nearest\n" : "") + (r.regions.empty() ? "" : "regions 2\n") + KABOUM_VERSION +
      '\n' + std::string(cache_words::kSets) + '\n' + std::string(cache_words::kContainers) + '\n' +
      std::string(cache_words::kDecisions);
  return {kaboum::sha256(text), origin_of(r, sha256),
          r.wrap ? std::optional(clearance) : std::nullopt, r.wrap && r.wrap->where_needed,
          r.body_kind != SetRequest::BodyKind::Polytopes};
}

std::optional<CertifiedSet> SetCache::find(const Key& key, std::string& flaw) const {
  const auto content = CacheFolder(folder_).find(kFormat, key.hash, flaw);
  if (!content) return std::nullopt;
  try {
    return read_entry(*content, key);
  } catch (const Error& why) {
    flaw = (folder_ / key.hash).string() + ": " + why.what();
    return std::nullopt;
  }
}

void SetCache::store(const Key& key, const CertifiedSet& set) const {
  std::string content = write_record(set.certificate()) + "\n";
  content.append(set.bytes().begin(), set.bytes().end());
  CacheFolder(folder_).store(kFormat, key.hash, content);
}

std::optional<FoundSet> find_or_certify(const geom::Mesh& mesh, const std::string& sha256,
                                        const SetRequest& request, const SetCache* cache,
                                        const Hooks& hooks) {
  SetCache::Key key;
  if (cache != nullptr) {
    key = SetCache::key_of(mesh, sha256, request);
    std::string flaw;
    auto found = cache->find(key, flaw);
    if (hooks.note && !flaw.empty()) hooks.note("the cache's entry " + flaw + "; it is made again");
    if (found) {
      if (hooks.note)
        for (const std::string& text : found->certificate().notes) hooks.note(text);
      return FoundSet{std::move(*found), true};
    }
  }
  auto made = certify_set(mesh, sha256, request, hooks);
  if (!made) return std::nullopt;
  if (cache != nullptr) cache->store(key, *made);
  return FoundSet{std::move(*made), false};
}

}  // namespace kaboum::certify
