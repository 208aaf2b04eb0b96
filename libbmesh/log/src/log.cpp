// The log of a decimation as bytes: what preparation did, then the steps. docs/formats.md.

#include <kaboum/bmesh/log.h>

#include <algorithm>
#include <string_view>

#include "byte_stream.h"

namespace kaboum::bmesh {
namespace {

constexpr std::string_view kLogMagic = "KABOUM-BMESH-LOG 4\n";
// A kind, then: Contract two vertices and a position, Flip four vertices.
constexpr std::size_t kContractSize = 1 + 2 * 4 + 3 * 8;
constexpr std::size_t kFlipSize = 1 + 4 * 4;

}  // namespace

void record_preparation(const geom::PreparationReport& report, std::size_t input_triangles,
                        Log& log) {
  std::vector<char> kept(input_triangles, 0);
  for (std::size_t t = 0; t < report.source.size(); ++t) {
    kept[report.source[t]] = 1;
    if (report.reversed[t] != 0) log.reversed.push_back(report.source[t]);
  }
  log.reversed.insert(log.reversed.end(), report.reversed_and_dropped.begin(),
                      report.reversed_and_dropped.end());
  std::sort(log.reversed.begin(), log.reversed.end());
  for (std::uint32_t t = 0; t < input_triangles; ++t)
    if (kept[t] == 0) log.dropped.push_back(t);
  log.rims = report.rims;
  log.reversed_after_filling = report.reversed_after_filling;
}

void write_log(Writer& w, const Log& log) {
  w.out.reserve(w.out.size() + 256 + kContractSize * log.steps.size() +
                4 * (log.dropped.size() + log.reversed.size() + log.reversed_after_filling.size()));
  w.number(static_cast<std::uint32_t>(log.direction));
  w.text(log.input_sha256);
  w.text(log.tool);
  w.indices(log.dropped);
  w.indices(log.reversed);
  w.number(static_cast<std::uint64_t>(log.rims.size()));
  for (const auto& rim : log.rims) w.indices(rim);
  w.indices(log.reversed_after_filling);
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
}

Log read_log(Reader& r) {
  Log log;
  const auto direction = r.number<std::uint32_t>();
  if (direction > static_cast<std::uint32_t>(Direction::Any)) r.fail("names an unknown direction");
  log.direction = static_cast<Direction>(direction);
  log.input_sha256 = r.text();
  log.tool = r.text();
  log.dropped = r.indices();
  log.reversed = r.indices();
  log.rims.resize(r.count(sizeof(std::uint64_t)));
  for (auto& rim : log.rims) rim = r.indices();
  log.reversed_after_filling = r.indices();
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
  return log;
}

std::vector<char> serialise_log(const Log& log) {
  Writer w;
  w.out.assign(kLogMagic.begin(), kLogMagic.end());
  write_log(w, log);
  return std::move(w.out);
}

Log parse_log(std::span<const char> bytes, const std::string& name) {
  Reader r(bytes, name);
  r.refuse_earlier("KABOUM-BMESH-LOG ", {"1", "2", "3"}, "a log");
  r.magic(kLogMagic, "a log of bmesh-decimate");
  Log log = read_log(r);
  r.end();
  return log;
}

}  // namespace kaboum::bmesh
