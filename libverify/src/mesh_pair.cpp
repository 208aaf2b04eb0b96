// Two meshes with one set of vertices, scaled by a power of two.
// docs/algorithms/exact-inclusion.md, "Arithmetic".
#include "mesh_pair.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <string>

#include "curve.h"
#include "graph_vertex.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

/// Of points in the order of their places: number of each one among those that differ, in an order
/// along the curve; `points` becomes those.
std::vector<std::uint32_t> merge_equal(std::vector<Vec3>& points) {
  const std::vector<std::uint64_t> places = places_on_curve(points);
  std::vector<std::uint32_t> order = ordered_by(places);
  const auto less = [&](std::uint32_t i, std::uint32_t j) {
    return std::lexicographical_compare(points[i].begin(), points[i].end(), points[j].begin(),
                                        points[j].end());
  };
  std::vector<std::uint32_t> number(points.size());
  std::vector<Vec3> distinct;
  distinct.reserve(points.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && places[order[end]] == places[order[i]]) ++end;
    if (end - i > 1)
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(i),
                order.begin() + static_cast<std::ptrdiff_t>(end), less);
    for (std::size_t first = i; i < end; ++i) {
      if (i == first || points[order[i]] != points[order[i - 1]])
        distinct.push_back(points[order[i]]);
      number[order[i]] = static_cast<std::uint32_t>(distinct.size() - 1);
    }
  }
  points = std::move(distinct);
  return number;
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
  // Points of no triangle count for nothing, least of all for the scale.
  constexpr std::uint32_t kUnused = 0xFFFFFFFF;
  std::array<std::vector<std::uint32_t>, 2> number;
  points_.reserve(inside.vertices.size() + outside.vertices.size());
  for (int chain = 0; chain < 2; ++chain) {
    const geom::Mesh& mesh = *meshes[chain];
    number[chain].assign(mesh.vertices.size(), kUnused);
    for (const geom::Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) number[chain][v] = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (number[chain][v] == kUnused) continue;
      number[chain][v] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(Vec3(mesh.vertices[v] + Vec3::Zero()));  // −0 becomes +0
    }
  }
  rescale();
  const std::vector<std::uint32_t> same = merge_equal(points_);

  faces_.reserve(inside.triangles.size() + outside.triangles.size());
  for (int chain = 0; chain < 2; ++chain) {
    const geom::Mesh& mesh = *meshes[chain];
    std::vector<Face> faces;
    faces.reserve(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Face face{};
      for (int k = 0; k < 3; ++k) face.v[k] = same[number[chain][mesh.triangles[t][k]]];
      face.chain = static_cast<std::uint8_t>(chain);
      face.source = t;
      if (face.v[0] == face.v[1] || face.v[1] == face.v[2] || face.v[2] == face.v[0]) {
        face.axis = -1;
        repeated_[chain].push_back(face);
        continue;
      }
      faces.push_back(face);
    }
    add_faces(chain, faces);
    if (chain == kInside) split_ = static_cast<std::uint32_t>(faces_.size());
  }
  list_incidences();
  find_neighbours();
}

void MeshPair::add_faces(int chain, std::span<Face> faces) {
  std::vector<Bounds> boxes(faces.size());
  std::vector<Vec3> middles(faces.size());
  verify::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t f) {
    const auto& [a, b, c] = faces[f].v;
    faces[f].directions = set_axis(faces[f], points_[a], points_[b], points_[c]);
    boxes[f] = bounds_of(points_[a], points_[b], points_[c]);
    middles[f] = middle_of(boxes[f]);
  });
  const std::vector<std::uint64_t> places = places_on_curve(middles);
  std::vector<std::uint64_t> places_in_tree;
  std::vector<Bounds> boxes_in_tree;
  std::vector<std::uint32_t> items;
  places_in_tree.reserve(faces.size());
  boxes_in_tree.reserve(faces.size());
  items.reserve(faces.size());
  for (const std::uint32_t f : ordered_by(places)) {
    if (faces[f].axis < 0) {
      ++without_area_[chain];
    } else {
      places_in_tree.push_back(places[f]);
      boxes_in_tree.push_back(boxes[f]);
      items.push_back(static_cast<std::uint32_t>(faces_.size()));
    }
    faces_.push_back(faces[f]);
  }
  tree_[chain] = BoxTree(std::move(boxes_in_tree), std::move(items), places_in_tree);
}

void MeshPair::list_incidences() {
  first_.assign(points_.size() + 1, 0);
  for (const Face& face : faces_)
    for (const std::uint32_t v : face.v) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  incident_.resize(3 * faces_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    for (const std::uint32_t v : faces_[f].v) incident_[next[v]++] = f;
  }
}

namespace {

/// A face's edge, seen from its lower vertex.
struct HalfEdge {
  std::uint32_t to, face;
  std::uint8_t edge;
  std::int8_t flow;  ///< 1: runs to `to`; −1: from there
};

/// The edges that go from a vertex to higher ones, those to the same vertex together.
void list_edges(const MeshPair& meshes, std::uint32_t v, std::vector<HalfEdge>& edges) {
  edges.clear();
  for (const std::uint32_t f : meshes.around(v)) {
    const Face& face = meshes.face(f);
    const int k = face.v[0] == v ? 0 : face.v[1] == v ? 1 : 2, before = (k + 2) % 3;
    const std::uint32_t to = face.v[(k + 1) % 3], from = face.v[before];
    if (to > v) edges.push_back({to, f, static_cast<std::uint8_t>(k), 1});
    if (from > v) edges.push_back({from, f, static_cast<std::uint8_t>(before), -1});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.to != b.to ? a.to < b.to : a.face < b.face;
  });
}

}  // namespace

void MeshPair::find_neighbours() {
  neighbours_.resize(faces_.size());
  std::array<std::atomic<std::size_t>, 3> open{};
  // One edge's faces, which are in the order of their numbers: the inside chain's come first.
  const auto look_at = [&](std::span<const HalfEdge> edge, std::array<std::size_t, 3>& unbalanced) {
    const HalfEdge* split = edge.data();
    std::array<int, 2> flow{};
    for (const HalfEdge& h : edge) {
      flow[faces_[h.face].chain] += h.flow;
      if (faces_[h.face].chain == kInside) ++split;
    }
    for (int c = 0; c < 2; ++c) unbalanced[c] += flow[c] != 0 ? 1 : 0;
    unbalanced[2] += flow[0] != flow[1] ? 1 : 0;
    const HalfEdge* last = edge.data() + edge.size();
    for (const auto& [begin, end] : {std::pair{edge.data(), split}, {split, last}}) {
      if (end - begin != 2 || begin[0].flow == begin[1].flow) continue;
      for (int i = 0; i < 2; ++i)
        neighbours_[begin[i].face][begin[i].edge] = {begin[1 - i].face, begin[1 - i].edge,
                                                     edge.size() == 2};
    }
  };
  verify::parallel_ranges(points_.size(), [&](std::size_t first, std::size_t last) {
    std::vector<HalfEdge> edges;
    std::array<std::size_t, 3> unbalanced{};
    for (std::size_t v = first; v < last; ++v) {
      list_edges(*this, static_cast<std::uint32_t>(v), edges);
      for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].to == edges[i].to) ++end;
        look_at({edges.data() + i, end - i}, unbalanced);
        i = end;
      }
    }
    for (int k = 0; k < 3; ++k) open[k] += unbalanced[k];
  });
  for (int k = 0; k < 3; ++k) unbalanced_[k] = open[k];
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

std::vector<Face> MeshPair::in_order_of_sources(int chain) const {
  std::vector<Face> faces(faces_.begin() + begin(chain), faces_.begin() + end(chain));
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.source < b.source; });
  faces.insert(faces.begin(), repeated_[chain].begin(), repeated_[chain].end());
  return faces;
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
