// Two meshes with one set of vertices, scaled by a power of two.
// docs/algorithms/exact-inclusion.md, "Arithmetic".
#include "mesh_pair.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>

#include "parallel.h"

namespace kaboum::verify {
namespace {

/// Smallest number of each point among equal ones.
std::vector<std::uint32_t> merge_equal(const std::vector<Vec3>& points) {
  // A hash table with open addressing; equal coordinates have equal bits once −0 is gone.
  std::size_t capacity = 64;
  while (capacity < 2 * points.size()) capacity *= 2;
  constexpr std::uint32_t kEmpty = 0xFFFFFFFF;
  std::vector<std::uint32_t> table(capacity, kEmpty), same(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(points[i][k])) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
    std::size_t slot = hash & (capacity - 1);
    while (table[slot] != kEmpty && points[table[slot]] != points[i])
      slot = (slot + 1) & (capacity - 1);
    if (table[slot] == kEmpty) table[slot] = i;
    same[i] = table[slot];
  }
  return same;
}

/// The axis along which the face's projection is largest, by rounded arithmetic; another one if
/// that turns out to be exactly zero.
void find_axis(Face& face, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](int i, int j) { return std::abs(normal[i]) > std::abs(normal[j]); });
  face.axis = -1;
  for (const int axis : axes) {
    const Sign sign = orient2d(axis, a, b, c);
    if (sign == Sign::Zero) continue;
    face.axis = axis;
    face.upward = sign == Sign::Positive;
    return;
  }
}

Bounds bounds_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  Bounds box;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min({a[k], b[k], c[k]});
    box.high[k] = std::max({a[k], b[k], c[k]});
  }
  return box;
}

}  // namespace

MeshPair::MeshPair(const geom::Mesh& inside, const geom::Mesh& outside) {
  const std::array<const geom::Mesh*, 2> meshes{&inside, &outside};
  for (const geom::Mesh* mesh : meshes) geom::require_valid(*mesh);
  if (inside.vertices.size() + outside.vertices.size() >= 0xFFFFFFFF ||
      inside.triangles.size() + outside.triangles.size() >= 0xFFFFFFFF / 3) {
    throw Error(ErrorCode::LimitReached, "more than 2^32 / 3 triangles");
  }
  points_.reserve(inside.vertices.size() + outside.vertices.size());
  for (const geom::Mesh* mesh : meshes) {
    // Points of no triangle count for nothing, least of all for the scale.
    std::vector<char> used(mesh->vertices.size(), 0);
    for (const geom::Triangle& t : mesh->triangles)
      for (const std::uint32_t v : t) used[v] = 1;
    for (std::size_t v = 0; v < used.size(); ++v)
      points_.push_back(used[v] != 0 ? Vec3(mesh->vertices[v] + Vec3::Zero())  // −0 becomes +0
                                     : Vec3(Vec3::Zero()));
  }
  rescale();
  const std::vector<std::uint32_t> same = merge_equal(points_);

  std::uint32_t offset = 0;
  faces_.reserve(inside.triangles.size() + outside.triangles.size());
  for (int chain = 0; chain < 2; ++chain) {
    const geom::Mesh& mesh = *meshes[chain];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Face face{};
      for (int k = 0; k < 3; ++k) face.v[k] = same[offset + mesh.triangles[t][k]];
      face.chain = static_cast<std::uint8_t>(chain);
      face.source = t;
      if (face.v[0] == face.v[1] || face.v[1] == face.v[2] || face.v[2] == face.v[0]) {
        face.axis = -1;
        repeated_[chain].push_back(face);
        continue;
      }
      faces_.push_back(face);
    }
    offset += static_cast<std::uint32_t>(mesh.vertices.size());
    if (chain == kInside) split_ = static_cast<std::uint32_t>(faces_.size());
  }
  verify::parallel_for(std::size_t{0}, faces_.size(), [&](std::size_t f) {
    Face& face = faces_[f];
    find_axis(face, points_[face.v[0]], points_[face.v[1]], points_[face.v[2]]);
  });

  first_.assign(points_.size() + 1, 0);
  for (const Face& face : faces_) {
    for (const std::uint32_t v : face.v) ++first_[v + 1];
    if (face.axis < 0) ++without_area_[face.chain];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  incident_.resize(3 * faces_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    for (const std::uint32_t v : faces_[f].v) incident_[next[v]++] = f;
  }

  const auto build_tree = [&](int chain) {
    std::vector<Bounds> boxes;
    std::vector<std::uint32_t> items;
    boxes.reserve(count(chain));
    items.reserve(count(chain));
    for (std::uint32_t f = begin(chain); f < end(chain); ++f) {
      if (faces_[f].axis < 0) continue;
      boxes.push_back(bounds_of(corner(f, 0), corner(f, 1), corner(f, 2)));
      items.push_back(f);
    }
    tree_[chain] = BoxTree(std::move(boxes), std::move(items));
  };
  verify::parallel_invoke([&] { build_tree(kInside); }, [&] { build_tree(kOutside); });
}

void MeshPair::rescale() {
  double largest = 0;
  for (const Vec3& p : points_) {
    if (p.allFinite()) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  if (largest == 0) {
    scaled_ = true;
    return;
  }
  const int exponent = std::ilogb(largest);
  if (exponent < -1000 || exponent > 1000) return;
  const double scale = std::ldexp(1.0, -exponent);
  const auto survives = [&](double x) { return !std::isfinite(x) || (x * scale) / scale == x; };
  for (const Vec3& p : points_) {
    if (!survives(p.x()) || !survives(p.y()) || !survives(p.z())) return;
  }
  for (Vec3& p : points_) p *= scale;
  scale_ = scale;
  scaled_ = true;
}

std::size_t MeshPair::unbalanced(OperandMask chains, bool difference) const {
  std::size_t result = 0;
  std::vector<std::pair<std::uint32_t, int>> sums;  // per vertex: upper neighbour, flow
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    sums.clear();
    for (const std::uint32_t f : around(v)) {
      const Face& face = faces_[f];
      if ((chains & mask_of(face.chain)) == 0) continue;
      const int weight = difference && face.chain == kInside ? -1 : 1;
      const int k = face.v[0] == v ? 0 : face.v[1] == v ? 1 : 2;
      const std::uint32_t to = face.v[(k + 1) % 3], from = face.v[(k + 2) % 3];
      if (to > v) sums.emplace_back(to, weight);
      if (from > v) sums.emplace_back(from, -weight);
    }
    std::sort(sums.begin(), sums.end());
    for (std::size_t i = 0; i < sums.size();) {
      int sum = 0;
      const std::uint32_t other = sums[i].first;
      for (; i < sums.size() && sums[i].first == other; ++i) sum += sums[i].second;
      if (sum != 0) ++result;
    }
  }
  return result;
}

double MeshPair::largest_coordinate() const {
  double largest = 0;
  for (const Face& face : faces_) {
    for (const std::uint32_t v : face.v) {
      largest = std::max(largest, points_[v].cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

}  // namespace kaboum::verify
