#pragma once

#include <kaboum/geom/mesh.h>
#include <sys/resource.h>

#include <algorithm>
#include <map>
#include <utility>

namespace kaboum::benchmark {

/// User CPU time of this process so far. [s]
inline double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// Largest resident size of this process so far. [MB]
inline double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Every triangle cut into four near the middles of its edges: off them by a share of the edge's
/// length, lest the four be coplanar, which is easier to simplify than a scan of that size.
inline geom::Mesh subdivided(const geom::Mesh& mesh, double share = 0.02) {
  geom::Mesh out;
  out.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
  const auto between = [&](std::uint32_t a, std::uint32_t b) {
    const auto [it, fresh] =
        middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(out.vertices.size()));
    if (fresh) {
      const geom::Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
      const std::uint32_t hash = (std::min(a, b) * 2654435761U) ^ (std::max(a, b) * 40503U);
      geom::Vec3 off;
      for (int k = 0; k < 3; ++k) off[k] = ((hash >> (8 * k)) & 255U) / 127.5 - 1;
      out.vertices.emplace_back(0.5 * (p + q) + share * (q - p).norm() * off);
    }
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t x = between(a, b), y = between(b, c), z = between(c, a);
    out.triangles.insert(out.triangles.end(), {{a, x, z}, {x, b, y}, {z, y, c}, {x, y, z}});
  }
  return out;
}

}  // namespace kaboum::benchmark
