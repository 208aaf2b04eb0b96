#include <kaboum/bmesh/log.h>
#include <kaboum/geom/error.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace kaboum::bmesh {
namespace {

constexpr char kMagic[] = "KABOUM-BMESH-LOG 2\n";
constexpr std::size_t kMagicSize = sizeof(kMagic) - 1;
// A kind, then: Contract two vertices and a position, Flip four vertices.
constexpr std::size_t kContractSize = 1 + 2 * 4 + 3 * 8;
constexpr std::size_t kFlipSize = 1 + 4 * 4;

class Writer {
 public:
  template <class T>
  void number(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
    out.insert(out.end(), bytes, bytes + sizeof(T));
  }
  void text(const std::string& s) {
    number(static_cast<std::uint32_t>(s.size()));
    out.insert(out.end(), s.begin(), s.end());
  }
  void indices(const std::vector<std::uint32_t>& v) {
    number(static_cast<std::uint64_t>(v.size()));
    for (const std::uint32_t i : v) number(i);
  }
  std::vector<char> out;
};

class Reader {
 public:
  Reader(std::span<const char> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  template <class T>
  T number() {
    require(sizeof(T));
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + at_, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw, raw + sizeof(T));
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }
  std::string text() {
    const auto n = number<std::uint32_t>();
    require(n);
    std::string s(bytes_.data() + at_, n);
    at_ += n;
    return s;
  }
  std::uint64_t count(std::size_t item_size) {
    const auto n = number<std::uint64_t>();
    if (n > (bytes_.size() - at_) / item_size) truncated();
    return n;
  }
  std::vector<std::uint32_t> indices() {
    std::vector<std::uint32_t> v(count(4));
    for (std::uint32_t& i : v) i = number<std::uint32_t>();
    return v;
  }
  void magic() {
    if (bytes_.size() < kMagicSize || std::memcmp(bytes_.data(), kMagic, kMagicSize) != 0)
      fail("is not a log of bmesh-decimate (it does not begin with \"KABOUM-BMESH-LOG 2\")");
    at_ = kMagicSize;
  }
  void end() {
    if (at_ != bytes_.size()) fail("has bytes after its end, at byte " + std::to_string(at_));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::InvalidInput, name_ + " " + what);
  }

 private:
  void require(std::size_t n) const {
    if (n > bytes_.size() - at_) truncated();
  }
  [[noreturn]] void truncated() const {
    fail("is truncated at byte " + std::to_string(bytes_.size()));
  }

  std::span<const char> bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace

void record_preparation(const geom::Prepared& prepared, std::size_t input_triangles, Log& log) {
  std::vector<char> kept(input_triangles, 0);
  for (std::size_t t = 0; t < prepared.source.size(); ++t) {
    kept[prepared.source[t]] = 1;
    if (prepared.turned[t] != 0) log.turned.push_back(prepared.source[t]);
  }
  log.turned.insert(log.turned.end(), prepared.turned_and_dropped.begin(),
                    prepared.turned_and_dropped.end());
  std::sort(log.turned.begin(), log.turned.end());
  for (std::uint32_t t = 0; t < input_triangles; ++t)
    if (kept[t] == 0) log.dropped.push_back(t);
}

std::vector<char> serialise_log(const Log& log) {
  Writer w;
  w.out.reserve(kMagicSize + 256 + kContractSize * log.steps.size() +
                4 * (log.dropped.size() + log.turned.size()));
  w.out.insert(w.out.end(), kMagic, kMagic + kMagicSize);
  w.number(static_cast<std::uint32_t>(log.direction));
  w.text(log.input_sha256);
  w.text(log.tool);
  w.indices(log.dropped);
  w.indices(log.turned);
  w.number(static_cast<std::uint64_t>(log.steps.size()));
  for (const Step& s : log.steps) {
    w.number(static_cast<std::uint8_t>(s.kind));
    w.number(s.kept);
    w.number(s.gone);
    if (s.kind == Step::Kind::Flip) {
      w.number(s.left);
      w.number(s.right);
      continue;
    }
    for (int k = 0; k < 3; ++k) w.number(s.position[k]);
  }
  return std::move(w.out);
}

Log parse_log(std::span<const char> bytes, const std::string& name) {
  Reader r(bytes, name);
  r.magic();
  Log log;
  const auto direction = r.number<std::uint32_t>();
  if (direction > static_cast<std::uint32_t>(Direction::Any)) r.fail("names an unknown direction");
  log.direction = static_cast<Direction>(direction);
  log.input_sha256 = r.text();
  log.tool = r.text();
  log.dropped = r.indices();
  log.turned = r.indices();
  log.steps.resize(r.count(kFlipSize));
  for (Step& s : log.steps) {
    const auto kind = r.number<std::uint8_t>();
    if (kind > static_cast<std::uint8_t>(Step::Kind::Flip)) r.fail("names an unknown kind of step");
    s.kind = static_cast<Step::Kind>(kind);
    s.kept = r.number<std::uint32_t>();
    s.gone = r.number<std::uint32_t>();
    if (s.kind == Step::Kind::Flip) {
      s.left = r.number<std::uint32_t>();
      s.right = r.number<std::uint32_t>();
      continue;
    }
    for (int k = 0; k < 3; ++k) s.position[k] = r.number<double>();
  }
  r.end();
  return log;
}

}  // namespace kaboum::bmesh
