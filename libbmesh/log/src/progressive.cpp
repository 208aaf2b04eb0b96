// Progressive files.

#include <kaboum/bmesh/progressive.h>

#include <algorithm>
#include <string_view>

#include "byte_stream.h"

namespace kaboum::bmesh {
namespace {

constexpr std::string_view kProgressiveMagic = "KABOUM-BMESH-PROGRESSIVE 4\n";

}  // namespace

std::vector<char> serialise_progressive(const Progressive& p) {
  Writer w;
  w.out.assign(kProgressiveMagic.begin(), kProgressiveMagic.end());
  w.out.reserve(w.out.size() + 24 * p.base.vertices.size() + 12 * p.base.triangles.size() +
                64 * p.levels.size() + 33 * p.log.steps.size() + 4096);
  write_log(w, p.log);
  w.number(static_cast<std::uint32_t>(p.double_precision));
  w.points(p.base.vertices);
  w.triangles(p.base.triangles);
  w.number(static_cast<std::uint64_t>(p.levels.size()));
  for (const Progressive::Level& level : p.levels)
    for (const std::size_t n : {level.requested, level.vertices, level.steps})
      w.number(static_cast<std::uint64_t>(n));
  w.checksum();
  return std::move(w.out);
}

Progressive parse_progressive(std::span<const char> bytes, const std::string& name) {
  Reader r(bytes, name);
  r.refuse_earlier("KABOUM-BMESH-PROGRESSIVE ", {"1", "2", "3"}, "a progressive file");
  r.magic(kProgressiveMagic, "a progressive file of bmesh-decimate");
  r.checksum();
  Progressive p;
  p.log = read_log(r);
  const auto precision = r.number<std::uint32_t>();
  if (precision > 1) r.fail("names an unknown precision");
  p.double_precision = precision == 1;
  p.base.vertices = r.points();
  p.base.triangles = r.triangles();
  for (const geom::Triangle& t : p.base.triangles)
    for (const std::uint32_t v : t)
      if (v >= p.base.vertices.size()) r.fail("has a triangle with a vertex that is not there");
  p.levels.resize(r.count(24));
  const Progressive::Level* before = nullptr;
  for (Progressive::Level& level : p.levels) {
    level.requested = r.number<std::uint64_t>();
    level.vertices = r.number<std::uint64_t>();
    level.steps = r.number<std::uint64_t>();
    if (level.steps > p.log.steps.size() ||
        (before != nullptr &&
         (level.requested >= before->requested || level.steps < before->steps)))
      r.fail("has levels out of order");
    before = &level;
  }
  r.end();
  return p;
}

}  // namespace kaboum::bmesh
