#include "pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "support/shapes.h"

namespace kaboum::test {
namespace {

using geom::Triangle;

int below(Random& random, int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
bool chance(Random& random, int percent) { return below(random, 100) < percent; }

Vec3 lattice_point(Random& random, int n) {
  return {static_cast<double>(below(random, n + 1)), static_cast<double>(below(random, n + 1)),
          static_cast<double>(below(random, n + 1))};
}

/// May be flat: then two sheets back to back.
Mesh tetrahedron(const std::array<Vec3, 4>& p) {
  const bool turned = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) < 0;
  Mesh mesh{{p[0], p[1], p[2], p[3]}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  return turned ? flipped(mesh) : mesh;
}

Mesh random_tetrahedron(Random& random, int n) {
  return tetrahedron({lattice_point(random, n), lattice_point(random, n), lattice_point(random, n),
                      lattice_point(random, n)});
}

/// Other diagonals in the quads of a box: pairs of triangles that share a longest edge.
Mesh with_flipped_diagonals(Mesh mesh, Random& random) {
  for (std::size_t i = 0; i + 1 < mesh.triangles.size(); ++i) {
    if (!chance(random, 30)) continue;
    Triangle &s = mesh.triangles[i], &t = mesh.triangles[i + 1];
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        if (s[j] != t[(k + 1) % 3] || s[(j + 1) % 3] != t[k]) continue;
        const std::uint32_t a = s[j], b = s[(j + 1) % 3], c = s[(j + 2) % 3], d = t[(k + 2) % 3];
        if (c == d) continue;
        s = {a, d, c};
        t = {d, b, c};
        j = k = 3;
      }
    }
  }
  return mesh;
}

Mesh random_box(Random& random, int n) {
  Vec3 a = lattice_point(random, n), b = lattice_point(random, n);
  const Vec3 low = a.cwiseMin(b);
  Vec3 size = a.cwiseMax(b) - low;
  for (int k = 0; k < 3; ++k) {
    if (size[k] == 0 && chance(random, 90)) size[k] = 1;
  }
  const int grid = 1 << below(random, 2);
  return translated(with_flipped_diagonals(box(size, grid), random), low);
}

/// Both sides of a triangle.
Mesh sheet(Random& random, int n) {
  Mesh mesh{{lattice_point(random, n), lattice_point(random, n), lattice_point(random, n)},
            {{0, 1, 2}, {0, 2, 1}}};
  return mesh;
}

/// Boundary of a random set of unit cubes; diagonals at random. With `walls`, faces between two
/// cubes are there twice, in opposite directions.
Mesh cubes(const std::set<std::array<int, 3>>& cells, bool walls, Random& random) {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> index;
  const auto vertex = [&](const std::array<int, 3>& p) {
    const auto [at, fresh] = index.emplace(p, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.emplace_back(p[0], p[1], p[2]);
    return at->second;
  };
  for (const auto& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int up = 0; up < 2; ++up) {
        std::array<int, 3> beside = cell;
        beside[axis] += up == 1 ? 1 : -1;
        if (!walls && cells.count(beside) != 0) continue;
        std::array<int, 3> p = cell;
        p[axis] += up;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<std::uint32_t, 4> q{};
        for (int k = 0; k < 4; ++k) {
          std::array<int, 3> r = p;
          r[u] += k == 1 || k == 2 ? 1 : 0;
          r[v] += k >= 2 ? 1 : 0;
          q[k] = vertex(r);
        }
        if (up == 0) std::swap(q[1], q[3]);
        const int s = below(random, 2);
        mesh.triangles.push_back({q[s], q[s + 1], q[s + 2]});
        mesh.triangles.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
      }
    }
  }
  return mesh;
}

std::set<std::array<int, 3>> random_cells(Random& random, int n, int percent) {
  std::set<std::array<int, 3>> cells;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        if (chance(random, percent)) cells.insert({x, y, z});
      }
    }
  }
  return cells;
}

/// Opposite triangles of one mesh cancel.
Mesh cancelled(const Mesh& mesh) {
  const Mesh w = welded(mesh);
  std::map<Triangle, int> count;
  const auto turned = [](Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  for (const Triangle& t : w.triangles) {
    const Triangle back = turned({t[0], t[2], t[1]});
    if (const auto at = count.find(back); at != count.end() && at->second > 0) {
      --at->second;
    } else {
      ++count[turned(t)];
    }
  }
  Mesh result{w.vertices, {}};
  for (const auto& [t, n] : count) result.triangles.insert(result.triangles.end(), n, t);
  return result;
}

Mesh random_part(Random& random, int n) {
  switch (below(random, 12)) {
    case 0:
    case 1:
    case 2:
      return random_tetrahedron(random, n);
    case 3:
    case 4:
    case 5:
      return random_box(random, n);
    case 6:
      return sheet(random, n);
    case 7:
      return flipped(random_box(random, n));
    case 8:
      return flipped(random_tetrahedron(random, n));
    case 9:
      return cubes(random_cells(random, std::min(n, 2), 60), chance(random, 30), random);
    case 10: {
      Mesh mesh = with_t_junctions(scaled(random_box(random, n), Vec3::Constant(2)), 3,
                                   static_cast<std::uint32_t>(random()));
      return mesh;
    }
    default: {
      const Mesh mesh = random_tetrahedron(random, n);
      return merged({mesh, mesh});
    }
  }
}

Mesh random_chain(Random& random, int n, int parts) {
  std::vector<Mesh> list;
  for (int i = 0; i < parts; ++i) list.push_back(random_part(random, n));
  Mesh mesh = merged(list);
  if (chance(random, 30)) mesh = cancelled(mesh);
  if (chance(random, 15)) mesh = subdivided(mesh);
  return mesh;
}

/// What surely adds to the winding number or leaves it: the pair's claim stays or becomes true.
Mesh grown(const Mesh& mesh, Random& random, int n) {
  std::vector<Mesh> list{mesh};
  const int more = 1 + below(random, 2);
  for (int i = 0; i < more; ++i)
    list.push_back(chance(random, 50) ? random_tetrahedron(random, n) : random_box(random, n));
  return merged(list);
}

/// Moves vertices of a welded mesh on the lattice.
Mesh jumbled(const Mesh& mesh, Random& random, int count) {
  Mesh result = welded(mesh);
  for (int i = 0; i < count && !result.vertices.empty(); ++i) {
    Vec3& p = result.vertices[random() % result.vertices.size()];
    p[below(random, 3)] += chance(random, 50) ? 1 : -1;
  }
  return result;
}

/// The tetrahedra between the triangles round one vertex and a point: replaces the star by the cone
/// from a neighbouring lattice point, by adding the difference as a chain.
Mesh with_cone(const Mesh& mesh, Random& random, int n) {
  Mesh result = welded(mesh);
  if (result.triangles.empty()) return result;
  const Triangle t = result.triangles[random() % result.triangles.size()];
  const Vec3 apex = lattice_point(random, n);
  return merged({result, tetrahedron({result.vertices[t[0]], result.vertices[t[1]],
                                      result.vertices[t[2]], apex})});
}

std::tuple<double, double, double> key(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Moves vertex v along the mean normal of its triangles by `distance`.
void displace(Mesh& mesh, std::uint32_t v, double distance) {
  Vec3 normal = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    if (std::find(t.begin(), t.end(), v) == t.end()) continue;
    normal += (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                  .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  }
  if (normal.norm() > 0) mesh.vertices[v] += distance * normal.normalized();
}

/// Replaces an edge of two triangles by the other diagonal; `inwards` if that takes from the solid.
/// @return false if there is none among some tries.
bool flip_edge(Mesh& mesh, bool inwards, Random& random) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> of_edge;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      of_edge[{mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]}].push_back(i);
  }
  for (int attempt = 0; attempt < 200; ++attempt) {
    const std::size_t i = random() % mesh.triangles.size();
    Triangle s = mesh.triangles[i];
    std::rotate(s.begin(), s.begin() + below(random, 3), s.end());
    const auto other = of_edge.find({s[1], s[0]});
    if (other == of_edge.end() || other->second.size() != 1) continue;
    const Triangle& t = mesh.triangles[other->second[0]];
    std::uint32_t d = t[0];
    for (const std::uint32_t v : t) {
      if (v != s[0] && v != s[1]) d = v;
    }
    const auto& x = mesh.vertices;
    const double volume = (x[s[1]] - x[s[0]]).cross(x[s[2]] - x[s[0]]).dot(x[d] - x[s[0]]);
    if (d == s[2] || (inwards ? volume >= 0 : volume <= 0)) continue;
    mesh.triangles[i] = {s[0], d, s[2]};
    mesh.triangles[other->second[0]] = {d, s[1], s[2]};
    return true;
  }
  return false;
}

/// Leaves out one of the components that hang together by vertices.
void drop_component(Mesh& mesh, Random& random) {
  std::vector<std::uint32_t> label(mesh.vertices.size());
  for (std::uint32_t i = 0; i < label.size(); ++i) label[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t least = std::min({label[t[0]], label[t[1]], label[t[2]]});
      for (const std::uint32_t v : t) {
        changed = changed || label[v] != least;
        label[v] = least;
      }
    }
  }
  const std::uint32_t gone = label[mesh.triangles[random() % mesh.triangles.size()][0]];
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return label[t[0]] == gone; });
}

}  // namespace

std::vector<MeshPair> mutants(const MeshPair& pair, std::uint64_t seed, int count) {
  Random random(seed);
  geom::Box3 all;
  std::set<std::tuple<double, double, double>> of_inner, of_outer;
  for (const Vec3& p : pair.inner.vertices) of_inner.insert(key(p)), all.extend(p);
  for (const Vec3& p : pair.outer.vertices) of_outer.insert(key(p)), all.extend(p);
  std::vector<MeshPair> result;
  while (static_cast<int>(result.size()) < count) {
    MeshPair mutant = pair;
    mutant.name += " mutant " + std::to_string(result.size());
    const bool out = chance(random, 70);
    Mesh& mesh = out ? mutant.outer : mutant.inner;
    const auto& others = out ? of_inner : of_outer;
    const int kind = below(random, 10);
    if (kind == 0) {
      drop_component(mesh, random);
      mutant.name += " component";
    } else if (kind <= 2) {
      if (!flip_edge(mesh, chance(random, 80) == out, random)) continue;
      mutant.name += " flip";
    } else {
      std::uint32_t v = 0;
      for (int attempt = 0; attempt < 30; ++attempt) {
        v = static_cast<std::uint32_t>(random() % mesh.vertices.size());
        if (kind <= 4 || others.count(key(mesh.vertices[v])) != 0) break;
      }
      const int digits = 3 + below(random, 8);
      displace(mesh, v, (out ? -1 : 1) * std::pow(10.0, -digits) * all.diagonal());
      mutant.name += " vertex 1e-" + std::to_string(digits);
    }
    result.push_back(std::move(mutant));
  }
  return result;
}

Mesh block_chain(const std::vector<std::array<int, 3>>& cells) {
  Random random(1);
  return cubes({cells.begin(), cells.end()}, false, random);
}

Mesh subdivided(const Mesh& mesh) {
  Mesh result{mesh.vertices, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
  const auto between = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, fresh] =
        middle.emplace(std::minmax(a, b), static_cast<std::uint32_t>(result.vertices.size()));
    if (fresh) result.vertices.emplace_back(0.5 * result.vertices[a] + 0.5 * result.vertices[b]);
    return at->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t a = between(t[0], t[1]), b = between(t[1], t[2]), c = between(t[2], t[0]);
    for (const Triangle& s :
         {Triangle{t[0], a, c}, Triangle{t[1], b, a}, Triangle{t[2], c, b}, Triangle{a, b, c}}) {
      result.triangles.push_back(s);
    }
  }
  return result;
}

MeshPair lattice_pair(std::uint64_t seed) {
  Random random(seed);
  const int n = 1 + below(random, 4);
  const std::string name = "lattice " + std::to_string(seed);
  const Mesh a = random_chain(random, n, 1 + below(random, 3));
  switch (below(random, 10)) {
    case 0:
    case 1:  // nothing to do with each other
      return {name + " unrelated", a, random_chain(random, n, 1 + below(random, 3))};
    case 2:
      return {name + " grown", a, grown(a, random, n)};
    case 3: {  // a claim about a mesh that is taken from another
      const Mesh b = random_chain(random, n, 2);
      return {name + " grown twice", grown(b, random, n), grown(b, random, n)};
    }
    case 4:
      return {name + " jumbled", a, jumbled(a, random, 1 + below(random, 2))};
    case 5:
      return chance(random, 50) ? MeshPair{name + " subdivided", a, subdivided(a)}
                                : MeshPair{name + " coarser", subdivided(a), a};
    case 6: {  // subsets of cubes
      const int m = 1 + below(random, 3);
      const auto big = random_cells(random, m, 80);
      auto small = big;
      for (auto i = small.begin(); i != small.end();)
        i = chance(random, 35) ? small.erase(i) : std::next(i);
      if (chance(random, 30)) small.insert({below(random, m), below(random, m), below(random, m)});
      return {name + " cubes", cubes(small, chance(random, 20), random),
              cubes(big, chance(random, 40), random)};
    }
    case 7: {  // a box round all or nearly all
      const Mesh b = box(Vec3::Constant(n), 1 + below(random, 2));
      return {name + " in box", a, chance(random, 30) ? merged({b, random_part(random, n)}) : b};
    }
    case 8:
      return {name + " cone", a, with_cone(a, random, n)};
    default:
      return {name + " cone and sheet", merged({a, sheet(random, n)}), with_cone(a, random, n)};
  }
}

MeshPair bent_pair(std::uint64_t seed) {
  MeshPair pair = lattice_pair(seed);
  Random random(seed ^ 0x9e3779b97f4a7c15U);
  const int kind = below(random, 4);
  pair.name += " bent " + std::to_string(kind);
  std::map<std::tuple<double, double, double>, Vec3> moved;
  const auto odd = [&] {
    return 0.1 + 0.9 * std::ldexp(static_cast<double>(random() >> 11U), -53);
  };
  const Vec3 factor(odd(), odd(), odd());
  const double angle = 6 * odd();
  const Vec3 shift = std::ldexp(1.0, 4 * below(random, 8)) * Vec3(odd(), odd(), odd());
  const auto move = [&](const Vec3& p) {
    const auto [at, fresh] = moved.emplace(std::tuple(p.x(), p.y(), p.z()), p);
    if (!fresh) return at->second;
    Vec3& q = at->second;
    if (kind == 0) {  // a few units in the last place
      for (int k = 0; k < 3; ++k) {
        if (chance(random, 20)) q[k] = std::nextafter(q[k], chance(random, 50) ? 1e9 : -1e9);
      }
    } else if (kind == 1) {
      q = p.cwiseProduct(factor);
    } else if (kind == 2) {
      q = p + shift;
    } else {
      q = rotated(Mesh{{p}, {}}, angle).vertices[0];
    }
    return q;
  };
  for (Mesh* mesh : {&pair.inner, &pair.outer}) {
    for (Vec3& p : mesh->vertices) p = move(p);
  }
  return pair;
}

MeshPair open_pair(std::uint64_t seed) {
  MeshPair pair = lattice_pair(seed);
  Random random(seed ^ 0xc2b2ae3d27d4eb4fU);
  const auto take_out = [&](Mesh& mesh) {
    for (int i = 1 + below(random, 2); i > 0 && !mesh.triangles.empty(); --i) {
      mesh.triangles.erase(mesh.triangles.begin() +
                           static_cast<std::ptrdiff_t>(random() % mesh.triangles.size()));
    }
  };
  switch (below(random, 5)) {
    case 0:
      take_out(pair.inner);
      pair.name += " inner opened";
      break;
    case 1:
      take_out(pair.outer);
      pair.name += " outer opened";
      break;
    default: {  // the same faces are added to both: a border in common
      pair.name += " same border";
      Mesh patch = merged({random_part(random, 3), sheet(random, 3)});
      take_out(patch);
      Mesh turned = patch;
      if (chance(random, 30)) turned = subdivided(turned);  // another border after all
      pair.inner = merged({pair.inner, patch});
      pair.outer = merged({pair.outer, turned});
    }
  }
  return pair;
}

MeshPair permuted(const MeshPair& pair, std::uint64_t seed) {
  Random random(seed);
  std::array<int, 3> axis{0, 1, 2};
  std::shuffle(axis.begin(), axis.end(), random);
  std::array<double, 3> sign{};
  for (double& s : sign) s = chance(random, 50) ? 1 : -1;
  // Tiny numbers would be rounded by a small factor.
  const auto is_tiny = [](const Mesh& mesh) {
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3& p) {
      return (p.array() != 0 && p.array().abs() < 1e-250).any();
    });
  };
  const bool tiny = is_tiny(pair.inner) || is_tiny(pair.outer);
  const double scale = std::ldexp(1.0, tiny ? below(random, 31) : below(random, 61) - 30);
  const bool odd = (axis[1] != (axis[0] + 1) % 3) != (sign[0] * sign[1] * sign[2] < 0);
  MeshPair result = pair;
  result.name += " permuted " + std::to_string(seed);
  for (Mesh* mesh : {&result.inner, &result.outer}) {
    const Mesh old = *mesh;
    std::vector<std::uint32_t> place(old.vertices.size());
    for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
    std::shuffle(place.begin(), place.end(), random);
    for (std::uint32_t i = 0; i < place.size(); ++i) {
      Vec3& p = mesh->vertices[place[i]];
      for (int k = 0; k < 3; ++k) p[k] = scale * sign[k] * old.vertices[i][axis[k]];
    }
    for (Triangle& t : mesh->triangles) {
      for (std::uint32_t& v : t) {
        v = place[v];
        if (!chance(random, 10)) continue;
        mesh->vertices.push_back(mesh->vertices[v]);
        v = static_cast<std::uint32_t>(mesh->vertices.size() - 1);
      }
      if (odd) std::swap(t[1], t[2]);
      std::rotate(t.begin(), t.begin() + below(random, 3), t.end());
    }
    std::shuffle(mesh->triangles.begin(), mesh->triangles.end(), random);
  }
  return result;
}

}  // namespace kaboum::test
