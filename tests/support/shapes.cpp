#include "shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

namespace kaboum::test {
namespace {

using geom::Triangle;
constexpr double kTurn = 2 * std::numbers::pi;

std::uint32_t id(std::size_t i) { return static_cast<std::uint32_t>(i); }

void quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

Vec3 on_circle(int i, int count, double z) {
  const double angle = kTurn * (i % count) / count;
  return {std::cos(angle), std::sin(angle), z};
}

/// Quads between rings of equal size, each ring counter-clockwise seen from the next one's side.
void join_rings(Mesh& mesh, std::uint32_t lower, std::uint32_t upper, int count) {
  for (int i = 0; i < count; ++i) {
    const std::uint32_t j = id((i + 1) % count);
    quad(mesh, lower + id(i), lower + j, upper + j, upper + id(i));
  }
}

/// Tube through rings of points; closed in both directions.
Mesh ring_of_rings(int segments, int sides, const std::function<Vec3(int, int)>& point) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < sides; ++j) mesh.vertices.push_back(point(i, j));
  }
  for (int i = 0; i < segments; ++i) {
    const int next = (i + 1) % segments;
    for (int j = 0; j < sides; ++j) {
      const int k = (j + 1) % sides;
      quad(mesh, id(i * sides + j), id(next * sides + j), id(next * sides + k), id(i * sides + k));
    }
  }
  return mesh;
}

}  // namespace

Mesh icosphere(int level) {
  const double g = std::numbers::phi;
  Mesh mesh;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-g, g}) {
      mesh.vertices.emplace_back(0, s, t);
      mesh.vertices.emplace_back(s, t, 0);
      mesh.vertices.emplace_back(t, 0, s);
    }
  }
  for (Vec3& p : mesh.vertices) p.normalize();
  mesh = convex_hull(mesh.vertices);
  for (int step = 0; step < level; ++step) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto split = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, added] = middle.emplace(std::minmax(a, b), id(mesh.vertices.size()));
      if (added) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t ab = split(t[0], t[1]), bc = split(t[1], t[2]), ca = split(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

Mesh uv_sphere(int segments, int rings) {
  Mesh mesh;
  mesh.vertices.emplace_back(0, 0, -1);
  for (int r = 1; r <= rings; ++r) {
    const double latitude = std::numbers::pi * (static_cast<double>(r) / (rings + 1) - 0.5);
    for (int i = 0; i < segments; ++i) {
      Vec3 p = on_circle(i, segments, 0) * std::cos(latitude);
      p.z() = std::sin(latitude);
      mesh.vertices.push_back(p);
    }
  }
  mesh.vertices.emplace_back(0, 0, 1);
  const std::uint32_t top = id(mesh.vertices.size() - 1);
  const std::uint32_t last = top - id(segments);
  for (int i = 0; i < segments; ++i) {
    const std::uint32_t j = id((i + 1) % segments);
    mesh.triangles.push_back({0, 1 + j, 1 + id(i)});
    mesh.triangles.push_back({top, last + id(i), last + j});
  }
  for (int r = 0; r + 1 < rings; ++r) {
    join_rings(mesh, 1 + id(r * segments), 1 + id((r + 1) * segments), segments);
  }
  return mesh;
}

Mesh box(const Vec3& size, int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int end = 0; end < 2; ++end) {
      const std::uint32_t first = id(mesh.vertices.size());
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
          Vec3 p;
          p[axis] = end == 0 ? 0.0 : size[axis];
          p[u] = i == n ? size[u] : size[u] * i / n;
          p[v] = j == n ? size[v] : size[v] * j / n;
          mesh.vertices.push_back(p);
        }
      }
      const std::uint32_t row = id(n + 1);
      for (std::uint32_t i = 0; i < id(n); ++i) {
        for (std::uint32_t j = 0; j < id(n); ++j) {
          const std::uint32_t a = first + i * row + j, b = a + row, c = b + 1, d = a + 1;
          end == 1 ? quad(mesh, a, b, c, d) : quad(mesh, a, d, c, b);
        }
      }
    }
  }
  return welded(mesh);
}

Mesh cylinder(int segments, double height, int side_rows, int cap_rings) {
  Mesh mesh;
  const auto ring = [&](double radius, double z) {
    const std::uint32_t first = id(mesh.vertices.size());
    for (int i = 0; i < segments; ++i) {
      Vec3 p = on_circle(i, segments, 0) * radius;
      p.z() = z;
      mesh.vertices.push_back(p);
    }
    return first;
  };
  std::vector<std::uint32_t> rims;
  for (int r = 0; r <= side_rows; ++r) {
    rims.push_back(ring(1, r == side_rows ? height : height * r / side_rows));
    if (r > 0) join_rings(mesh, rims[rims.size() - 2], rims.back(), segments);
  }
  for (const bool top : {false, true}) {
    std::uint32_t rim = top ? rims.back() : rims.front();
    const double z = top ? height : 0.0;
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(top ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    if (cap_rings == 0) {
      for (int i = 1; i + 1 < segments; ++i) triangle(rim, rim + id(i), rim + id(i + 1));
      continue;
    }
    for (int r = cap_rings - 1; r > 0; --r) {
      const std::uint32_t inner = ring(static_cast<double>(r) / cap_rings, z);
      for (int i = 0; i < segments; ++i) {
        const std::uint32_t j = id((i + 1) % segments);
        triangle(rim + id(i), rim + j, inner + j);
        triangle(rim + id(i), inner + j, inner + id(i));
      }
      rim = inner;
    }
    const std::uint32_t middle = id(mesh.vertices.size());
    mesh.vertices.emplace_back(0, 0, z);
    for (int i = 0; i < segments; ++i) triangle(rim + id(i), rim + id((i + 1) % segments), middle);
  }
  return mesh;
}

Mesh cone(int segments, double height) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) mesh.vertices.push_back(on_circle(i, segments, 0));
  mesh.vertices.emplace_back(0, 0, height);
  for (int i = 0; i < segments; ++i) {
    mesh.triangles.push_back({id(i), id((i + 1) % segments), id(segments)});
    if (i > 0 && i + 1 < segments) mesh.triangles.push_back({0, id(i + 1), id(i)});
  }
  return mesh;
}

Mesh torus(double major, double minor, int segments, int sides) {
  return ring_of_rings(segments, sides, [&](int i, int j) {
    const double a = kTurn * i / segments, b = kTurn * j / sides;
    const double r = major + minor * std::cos(b);
    return Vec3(r * std::cos(a), r * std::sin(a), minor * std::sin(b));
  });
}

Mesh tube(const std::function<Vec3(double)>& curve, double radius, int segments, int sides) {
  return ring_of_rings(segments, sides, [&](int i, int j) {
    const double t = kTurn * i / segments, b = kTurn * j / sides;
    const Vec3 middle = curve(t);
    const Vec3 along = (curve(t + 1e-4) - curve(t - 1e-4)).normalized();
    const Vec3 away = (middle - middle.dot(along) * along).normalized();  // from the origin
    return Vec3(middle + radius * (std::cos(b) * away + std::sin(b) * away.cross(along)));
  });
}

Mesh torus_knot(int p, int q, double radius, int segments, int sides) {
  return tube(
      [&](double t) {
        const double r = 1 + 0.4 * std::cos(q * t);
        return Vec3(r * std::cos(p * t), r * std::sin(p * t), 0.4 * std::sin(q * t));
      },
      radius, segments, sides);
}

Mesh grid(int n, const std::function<double(double, double)>& height) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      mesh.vertices.emplace_back(x, y, height(x, y));
    }
  }
  const std::uint32_t row = id(n + 1);
  for (std::uint32_t i = 0; i < id(n); ++i) {
    for (std::uint32_t j = 0; j < id(n); ++j) {
      const std::uint32_t a = i * row + j;
      quad(mesh, a, a + row, a + row + 1, a + 1);
    }
  }
  return mesh;
}

Mesh moebius_strip(int segments, int rows) {
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j <= rows; ++j) {
      const double a = kTurn * i / segments, s = 0.4 * (2.0 * j / rows - 1);
      const double r = 1 + s * std::cos(a / 2);
      mesh.vertices.emplace_back(r * std::cos(a), r * std::sin(a), s * std::sin(a / 2));
    }
  }
  const int row = rows + 1;
  for (int i = 0; i < segments; ++i) {
    for (int j = 0; j < rows; ++j) {
      const bool seam = i + 1 == segments;
      const int c = seam ? rows - j : (i + 1) * row + j;  // the half turn reverses the row
      const int d = seam ? rows - j - 1 : c + 1;
      quad(mesh, id(i * row + j), id(c), id(d), id(i * row + j + 1));
    }
  }
  return mesh;
}

Mesh merged(const std::vector<Mesh>& parts) {
  Mesh mesh;
  for (const Mesh& part : parts) {
    const std::uint32_t first = id(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& t : part.triangles) {
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return mesh;
}

Mesh welded(const Mesh& mesh) {
  Mesh result;
  std::map<std::tuple<double, double, double>, std::uint32_t> index;
  for (const Triangle& t : mesh.triangles) {
    Triangle u{};
    for (int i = 0; i < 3; ++i) {
      const Vec3& p = mesh.vertices[t[i]];
      const auto [it, added] = index.emplace(std::tuple(p.x() + 0.0, p.y() + 0.0, p.z() + 0.0),
                                             id(result.vertices.size()));
      if (added) result.vertices.push_back(p);
      u[i] = it->second;
    }
    result.triangles.push_back(u);
  }
  return result;
}

Mesh flipped(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Mesh translated(Mesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.vertices) p += by;
  return mesh;
}

Mesh scaled(Mesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.vertices) p = p.cwiseProduct(by).eval();
  return mesh;
}

Mesh rotated(Mesh mesh, double angle) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(angle, Vec3(0.31, -0.52, 0.79).normalized()).toRotationMatrix();
  for (Vec3& p : mesh.vertices) p = (rotation * p).eval();
  return mesh;
}

Mesh noisy(Mesh mesh, double amplitude, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (Vec3& p : mesh.vertices) {
    p *= 1 + amplitude * (static_cast<double>(random()) / 2147483648.0 - 1.0);
  }
  return mesh;
}

Mesh to_float(Mesh mesh) {
  for (Vec3& p : mesh.vertices) p = p.cast<float>().cast<double>().eval();
  return mesh;
}

Mesh without(const Mesh& mesh, const std::function<bool(const Vec3&)>& drop) {
  Mesh kept;
  kept.vertices = mesh.vertices;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 sum = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
    if (!drop(sum / 3)) kept.triangles.push_back(t);
  }
  return welded(kept);
}

Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t first = id(result.vertices.size());
    for (const std::uint32_t c : t) result.vertices.push_back(mesh.vertices[c]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

Mesh with_t_junctions(const Mesh& mesh, int count, std::uint32_t seed) {
  Mesh result = mesh;
  std::mt19937 random(seed);
  for (int i = 0; i < count; ++i) {
    const std::size_t at = random() % result.triangles.size();
    const auto [a, b, c] = result.triangles[at];
    const std::uint32_t m = id(result.vertices.size());
    result.vertices.push_back(0.5 * result.vertices[a] + 0.5 * result.vertices[b]);
    result.triangles[at] = {a, m, c};
    result.triangles.push_back({m, b, c});
    result.triangles.push_back({a, b, m});  // between a → b of the neighbour and its halves
  }
  return result;
}

Mesh with_repeated_vertices(const Mesh& mesh, int count, std::uint32_t seed) {
  Mesh result = mesh;
  std::mt19937 random(seed);
  for (int i = 0; i < count; ++i) {
    const std::size_t at = random() % result.triangles.size();
    const auto [a, b, c] = result.triangles[at];
    const std::uint32_t copy = id(result.vertices.size());
    result.vertices.push_back(result.vertices[a]);
    result.triangles[at] = {copy, b, c};
    result.triangles.push_back({a, b, copy});
    result.triangles.push_back({a, copy, c});
  }
  return result;
}

}  // namespace kaboum::test
