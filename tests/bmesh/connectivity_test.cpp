#include "connectivity.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include <kaboum/geom/topology.h>
#include "support/families.h"

namespace {

using kaboum::bmesh::Connectivity;
using kaboum::geom::Triangle;

// Random contractions, against a plain list of triangles.
TEST(Connectivity, ContractsLikeAPlainList) {
  std::mt19937_64 random(41);
  for (const auto& family : kaboum::test::closed_families()) {
    if (family.mesh.triangles.size() > 1500) continue;
    const auto mesh = kaboum::geom::weld(family.mesh);
    std::vector<Triangle> proper;
    for (const Triangle& t : mesh.triangles)
      if (t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) proper.push_back(t);
    Connectivity fast(mesh.vertices.size(), proper);
    std::map<std::uint32_t, Triangle> plain;
    for (std::uint32_t t = 0; t < proper.size(); ++t) plain[t] = proper[t];
    for (int step = 0; step < 60 && plain.size() > 4; ++step) {
      auto it = plain.begin();
      std::advance(it, static_cast<std::ptrdiff_t>(random() % plain.size()));
      const std::uint32_t kept = it->second[random() % 3];
      std::uint32_t gone = it->second[random() % 3];
      if (kept == gone) continue;
      fast.contract(kept, gone);
      for (auto j = plain.begin(); j != plain.end();) {
        for (std::uint32_t& v : j->second)
          if (v == gone) v = kept;
        const Triangle& t = j->second;
        j = t[0] == t[1] || t[1] == t[2] || t[0] == t[2] ? plain.erase(j) : std::next(j);
      }
      EXPECT_FALSE(fast.used(gone));
    }
    std::map<std::uint32_t, std::set<std::uint32_t>> around;
    for (std::uint32_t t = 0; t < fast.size(); ++t) {
      ASSERT_EQ(fast.alive(t), plain.contains(t)) << family.name;
      if (!fast.alive(t)) continue;
      ASSERT_EQ(fast[t], plain[t]) << family.name;
      for (const std::uint32_t v : fast[t]) around[v].insert(t);
    }
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      std::set<std::uint32_t> found;
      fast.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
        EXPECT_EQ(fast[t][k], v);
        EXPECT_TRUE(found.insert(t).second);
      });
      ASSERT_EQ(found, around[v]) << family.name;
    }
  }
}

}  // namespace
