// Certified sets of links kept between runs: entries hold the container that was decided, and the
// set that was read back from it, which takes no time to read.

#include "link_cache.h"

#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

#include "cache_words.h"
#include "issuer.h"

namespace kaboum::certify {
namespace {

constexpr std::string_view kLinkKind = "KABOUM-LINK 1";
/// Of fewer points, sets are made in the time of finding them.
constexpr std::size_t kFewPoints = 200;

/// Values one after the other, lists and texts after their lengths.
class Writer {
 public:
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&v, sizeof v);
  }
  template <class T>
  void list(const std::vector<T>& values) {
    value(std::uint64_t{values.size()});
    if constexpr (std::is_same_v<T, geom::Vec3>) {
      for (const geom::Vec3& p : values) append(p.data(), 3 * sizeof(double));
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      append(values.data(), values.size() * sizeof(T));
    }
  }
  void text(std::string_view s) {
    value(std::uint64_t{s.size()});
    append(s.data(), s.size());
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string bytes_;
};

/// What a Writer wrote. All throw Error{InvalidInput} where the bytes end before.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T value() {
    T v;
    take(&v, sizeof v);
    return v;
  }
  template <class T>
  std::vector<T> list() {
    std::vector<T> out(count(std::is_same_v<T, geom::Vec3> ? 3 * sizeof(double) : sizeof(T)));
    if constexpr (std::is_same_v<T, geom::Vec3>) {
      for (geom::Vec3& p : out) take(p.data(), 3 * sizeof(double));
    } else {
      take(out.data(), out.size() * sizeof(T));
    }
    return out;
  }
  std::string text() {
    const std::size_t size = count(1);
    std::string out(rest_.substr(0, size));
    rest_.remove_prefix(size);
    return out;
  }
  /// A length of a list whose elements take so many bytes.
  std::size_t count(std::size_t each) {
    const auto n = value<std::uint64_t>();
    if (n > rest_.size() / each) fail();
    return static_cast<std::size_t>(n);
  }
  void end() const {
    if (!rest_.empty()) fail();
  }

 private:
  [[noreturn]] static void fail() { throw Error(ErrorCode::InvalidInput, "damaged"); }
  void take(void* to, std::size_t size) {
    if (size > rest_.size()) fail();
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  std::string_view rest_;
};

std::string key_of(const LinkCase& link) {
  Writer w;
  for (const std::string_view word :
       {kLinkKind, std::string_view(KABOUM_VERSION), cache_words::kLinks, cache_words::kDecisions})
    w.text(word);
  w.value(std::endian::native);
  w.value(std::uint64_t{link.certificate.link});
  w.value(std::uint64_t{link.certificate.shapes});
  w.value(link.certificate.distance);
  const geom::Provenance& p = link.claims;
  for (const std::string& word :
       {p.source, p.source_sha256, p.tool, p.parameters, p.unit, p.frame, p.direction})
    w.text(word);
  w.value(p.covers_solid);
  w.value(p.covers_surface);
  w.value(std::uint64_t{link.bodies.size()});
  for (const robot::LinkBody& body : link.bodies) {
    w.text(body.name);
    w.value(body.margin);
    w.list(body.points);
  }
  return sha256({w.bytes().data(), w.bytes().size()});
}

}  // namespace

LinkCache::LinkCache(const CacheFolder* folder, const LinkCase& link)
    : folder_(folder), link_(link) {
  std::size_t points = 0;
  for (const robot::LinkBody& body : link.bodies) points += body.points.size();
  if (points < kFewPoints) folder_ = nullptr;
  if (folder_ != nullptr) key_ = key_of(link);
}

std::optional<CertifiedLink> LinkCache::find(std::string& flaw) const {
  flaw.clear();
  if (folder_ == nullptr) return std::nullopt;
  const auto content = folder_->find(kLinkKind, key_, flaw);
  if (!content) return std::nullopt;
  try {
    Reader r(*content);
    geom::ConvexSet set;
    set.provenance = link_.claims;
    const auto epsilon = r.value<double>();
    if (!(epsilon >= 0 && std::isfinite(epsilon)))
      throw Error(ErrorCode::InvalidInput, "an epsilon that is no length");
    set.provenance.epsilon = epsilon;
    for (std::size_t n = r.count(1); n > 0; --n) {
      geom::ConvexBody& body = set.bodies.emplace_back();
      body.name = r.text();
      body.core.vertices = r.list<geom::Vec3>();
      body.core.triangles = r.list<geom::Triangle>();
    }
    std::vector<char> container = r.list<char>();
    r.end();
    return Issuer::issue(std::move(set), LinkCertificate(link_.certificate), std::move(container));
  } catch (const Error& why) {
    flaw = key_ + ": " + why.what();
    return std::nullopt;
  }
}

void LinkCache::store(const CertifiedLink& made) const {
  const geom::ConvexSet& set = made.artefact();
  geom::Provenance expected = link_.claims;
  expected.epsilon = set.provenance.epsilon;
  ensure(geom::margin_of(set) == 0.0 && set.provenance == expected,
         "a link's set claims something else");
  if (folder_ == nullptr) return;
  Writer w;
  w.value(set.provenance.epsilon.value());
  w.value(std::uint64_t{set.bodies.size()});
  for (const geom::ConvexBody& body : set.bodies) {
    w.text(body.name);
    w.list(body.core.vertices);
    w.list(body.core.triangles);
  }
  w.list(made.bytes());
  folder_->store(kLinkKind, key_, w.bytes());
}

}  // namespace kaboum::certify
