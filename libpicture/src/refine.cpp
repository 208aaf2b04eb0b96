// Triangles cut into small ones, to be coloured by what is measured at their corners.
#include <kaboum/picture/refine.h>

#include <kaboum/geom/topology.h>

#include <algorithm>
#include <cmath>

namespace kaboum::picture {
namespace {

using geom::Vec3;

/// Into how many parts the edges of a triangle are cut, so that none is longer than the limit.
int parts(const geom::Mesh& mesh, const geom::Triangle& t, double limit) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return limit > 0 ? std::max(1, static_cast<int>(std::ceil(longest / limit))) : 1;
}

}  // namespace

geom::Mesh refined(const geom::Mesh& mesh, double longest, double most_parts) {
  double limit = longest;
  for (; limit > 0 && limit < 100 * longest; limit *= 1.25) {
    double sum = 0;
    for (const geom::Triangle& t : mesh.triangles) {
      const double n = parts(mesh, t, limit);
      if (n > 1) sum += n * n;
    }
    if (sum <= most_parts) break;
  }
  geom::Mesh out;
  out.vertices = mesh.vertices;
  for (const geom::Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const int n = parts(mesh, t, limit);
    if (n <= 1) {
      out.triangles.push_back(t);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n - i; ++j)
        out.vertices.emplace_back(a + (static_cast<double>(i) / n) * (b - a) +
                                  (static_cast<double>(j) / n) * (c - a));
    const auto at = [&](int i, int j) {
      return first + static_cast<std::uint32_t>(i * (n + 1) - i * (i - 1) / 2 + j);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n - i; ++j) {
        out.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (j + 1 < n - i) out.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return geom::weld(out);
}

}  // namespace kaboum::picture
