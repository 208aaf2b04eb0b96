// Contracting the edges of a convex hull outwards. docs/algorithms/convex-decomposition.md, "Fewer
// vertices"; positions as in [gaschler2016] Alg. 1, costs by the distance to the solid.

#include "contractor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kaboum::bcd {
namespace {

/// Links of no more edges are looked at in full, others by samples: round the tip of a cone of a
/// thousand facets, all pairs and all samples would take minutes. Work.FansOfThousandsAreOneBody.
constexpr std::size_t kFewEdges = 64;

// About what each step takes. [ns]
constexpr std::uint64_t kPositionWork = 500, kLinkEdgeWork = 100, kReplacedWork = 1000;

/// Rounding, as a share of the hull's size: far below float32's spacing, which comes last; the many
/// facets of large hulls are narrower.
constexpr double kRounding = 1e-10, kRoundingOfMany = 1e-8;
/// The same for positions and for half-spaces that are told apart.
constexpr double kPositionRounding = 1e-11, kSamePlane = 1e-12, kSameNormal = 1e-14;
/// Facets of a fan with as nearly the same plane are looked at once.
constexpr double kFlatNormal = 1e-15, kFlatHeight = 1e-3;
/// Least weight of a facet, as a share of the square of the hull's size, and of the edge's middle,
/// as a share of all weights: quadrics of flat stars would have no minimum.
constexpr double kLeastArea = 1e-6, kMiddleWeight = 1e-7;
/// The cost of growth beyond the hull: where the solid is near, and anywhere.
constexpr double kGrowthNear = 0.3, kGrowth = 0.02;
/// Positions farther from the hull than so many times its size are none.
constexpr double kMostGrowth = 2;
/// Guessed costs of an edge of a fan, as a share of its length: many vertices, few.
constexpr double kGuess = 1, kGuessFew = 0.1;
/// Rough contractions grow by no more than this share of the hull's size, in rounds that each allow
/// so many times as much.
constexpr double kMostRoughGrowth = 1e-2, kRoughStep = 4;

double size_of(std::span<const Vec3> points) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box.diagonal();
}

}  // namespace

/// Costs that do not matter: of what may be spent, within shares of the body's size.
constexpr double kNegligible = 0.02, kLeastNegligible = 1e-5, kMostNegligible = 2e-4;

double negligible(double free_cost, double size) {
  return std::clamp(kNegligible * free_cost, kLeastNegligible * size, kMostNegligible * size);
}

Contractor::Contractor(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                       const SolidField& solid, bool many)
    : solid_(solid),
      size_(size_of(points)),
      rounding_((many ? kRoundingOfMany : kRounding) * size_),
      near_(PointTree::ordered(points)),
      original_(near_),
      tangents_(original_, size_),
      mesh_(points, triangles),
      quadric_(points.size()) {
  std::vector<FacetTree::Facet> facets;
  for (const Triangle& t : triangles) {
    const std::array<Vec3, 3> corners{points[t[0]], points[t[1]], points[t[2]]};
    const auto h = beyond_triangle(corners[0], corners[1], corners[2]);
    if (!h) continue;
    facets.push_back({h->n, h->d});
    const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() +
                        kLeastArea * size_ * size_;
    for (const Index v : t) quadric_[v].add(*h, area);
    tangents_.add_facet(t, corners, *h);
  }
  facets_.emplace(std::move(facets), points[0], size_);
}

std::vector<Vec3> Contractor::vertices() const {
  std::vector<Vec3> out;
  for (Index v = 0; v < mesh_.slots(); ++v)
    if (mesh_.used(v)) out.push_back(mesh_[v]);
  return out;
}

bool Contractor::in_fan(Index a, Index b) const { return mesh_.valence(a, b) > kFewEdges; }

void Contractor::contract_roughly(std::size_t cap, double free_cost) {
  TriedEdges tried;
  for (double growth = negligible(free_cost, size_);
       growth < kMostRoughGrowth * size_ && mesh_.count() > cap; growth *= kRoughStep) {
    const std::size_t slots = mesh_.slots();
    // The vertices that are new join the end.
    for (Index v = 0; v < mesh_.slots() && mesh_.count() > cap; ++v)
      if (mesh_.star(v).size() <= kFewEdges) contract_round(v, slots, growth, tried);
  }
}

/// Contracts an edge of v that grows by no more than this, if there is one.
/// @param slots  vertices before are old: their edges have been tried from the first end.
void Contractor::contract_round(Index v, std::size_t slots, double growth, TriedEdges& tried) {
  const std::vector<Index> star = mesh_.star(v);
  for (const Index t : star) {
    Index w = 0;
    for (int k = 0; k < 3; ++k)
      if (mesh_.triangle(t)[k] == v) w = mesh_.triangle(t)[(k + 1) % 3];
    if ((w < v && v < slots) || in_fan(v, w)) continue;
    const auto key = std::minmax(v, w);
    const std::uint64_t version = mesh_.version(v, w);
    Attempt& last = tried[std::uint64_t{key.first} << 32U | key.second];
    if (last.growth == 0 || last.version != version) {
      last = {version, std::numeric_limits<double>::infinity(), Vec3::Zero()};
      if (find_position(v, w, last.position)) last.growth = growth;
    }
    if (last.growth > growth) continue;
    last.growth = facets_->beyond(last.position, growth, growth);
    if (last.growth <= growth && contract(v, w, last.position)) return;
  }
}

void Contractor::begin(std::size_t cap) {
  queued_ = true;
  few_ = mesh_.count() <= cap + kFewEdges;
  push_all();
}

/// The edge with the least cost that is known of; null when there is none.
const Contractor::Entry* Contractor::next(std::size_t cap) {
  if (queue_.empty()) return nullptr;
  if (!few_ && mesh_.count() <= cap + kFewEdges) {
    few_ = true;
    push_all();
  }
  return &queue_.top();
}

/// Contracts that edge, if it still is one and its cost is certain. @return the cost; 0 if not.
double Contractor::contract_next() {
  const Entry e = queue_.top();
  queue_.pop();
  if (!mesh_.used(e.a) || !mesh_.used(e.b)) return 0;
  if (e.version != mesh_.version(e.a, e.b)) {
    if (mesh_.adjacent(e.a, e.b)) push(e.a, e.b);
    return 0;
  }
  if (e.guessed) {
    push(e.a, e.b, true);
    return 0;
  }
  return contract(e.a, e.b, e.position) ? e.cost : 0;
}

void Contractor::push_all() {
  for (Index t = 0; t < mesh_.triangle_slots(); ++t)
    for (int k = 0; k < 3 && mesh_.alive(t); ++k) {
      const Index a = mesh_.triangle(t)[k], b = mesh_.triangle(t)[(k + 1) % 3];
      if (a < b) push(a, b);
    }
}

/// Round the tips of large fans costs are guessed at first: each contraction there changes all.
void Contractor::push(Index a, Index b, bool certain) {
  if (a > b) std::swap(a, b);
  Entry e{};
  e.a = a;
  e.b = b;
  e.version = mesh_.version(a, b);
  if (!certain && in_fan(a, b)) {
    e.guessed = true;
    e.cost = (few_ ? kGuessFew : kGuess) * (mesh_[a] - mesh_[b]).norm();
    queue_.push(e);
    return;
  }
  if (place(a, b, e.position, e.cost)) queue_.push(e);
}

/// Cheapest position for the vertex that replaces a and b, and what it costs.
bool Contractor::place(Index a, Index b, Vec3& best, double& cost) {
  if (!find_position(a, b, best)) return false;
  const double growth = facets_->beyond(best);
  double distance = solid_.field(best);
  for (std::size_t i = 0; i < link_.size(); i += 1 + link_.size() / (kFewEdges + 1)) {
    const auto& [u, w] = link_[i];
    const Vec3 &p = mesh_[u], &r = mesh_[w];
    distance = std::max({distance, solid_.field(0.5 * (best + p)), solid_.field((best + p + r) / 3),
                         solid_.field(0.6 * best + 0.2 * p + 0.2 * r)});
  }
  cost = std::max(distance, kGrowthNear * growth) + kGrowth * growth;
  return growth < kMostGrowth * size_;
}

/// The position beyond the planes round an edge with the least sum of squared distances; leaves the
/// edges round it in link_.
bool Contractor::find_position(Index a, Index b, Vec3& best) {
  if (!mesh_.link(a, b, link_)) return false;
  solid_.work().add(kPositionWork + kLinkEdgeWork * link_.size());
  half_spaces_.clear();
  const bool few = link_.size() <= kFewEdges;
  for (const auto& [u, w] : link_) {
    const HalfSpace* h = tangents_.through(u, w, mesh_[u], mesh_[w]);
    if (h == nullptr) return false;
    bool known = false;
    for (std::size_t i = 0; few && i < half_spaces_.size(); ++i) {
      const HalfSpace& c = half_spaces_[i];
      known =
          known || (c.n.dot(h->n) > 1 - kSameNormal && std::abs(c.d - h->d) < kSamePlane * size_);
    }
    if (!known) half_spaces_.push_back(*h);
  }
  PlaneQuadric q = quadric_[a];
  q.add(quadric_[b]);
  const Vec3 middle = 0.5 * (mesh_[a] + mesh_[b]);
  const double weight = kMiddleWeight * q.a.trace();
  q.a += weight * Eigen::Matrix3d::Identity();
  q.b += weight * middle;
  const std::optional<Vec3> found = minimise_beyond(q, half_spaces_, kPositionRounding * size_);
  if (found) best = *found;
  return found.has_value();
}

/// Puts a vertex in the place of a and b, and of the facets that it sees. @return false where the
/// hull would not be convex, or not contain the original.
bool Contractor::contract(Index a, Index b, const Vec3& position) {
  const std::vector<Index> marked = mark_visible(a, b, position);
  const std::optional<std::vector<Index>> ring = mesh_.ring_round(marked);
  solid_.work().add(kReplacedWork * marked.size());
  if (!ring || !contains_original(*ring, position)) {
    mesh_.unmark(marked);
    return false;
  }
  PlaneQuadric q;
  for (const Index v : {a, b}) q.add(quadric_[v]);
  std::vector<Index> vanished;
  const Index fresh = mesh_.replace(marked, *ring, position, vanished);
  for (const Index v : vanished)
    if (v != a && v != b) q.add(quadric_[v]);
  quadric_.push_back(q);
  if (queued_)
    for (const Index v : *ring) push(fresh, v);
  return true;
}

/// Marks the facets that see a position, and those round the edge.
std::vector<Contractor::Index> Contractor::mark_visible(Index a, Index b, const Vec3& position) {
  std::vector<Index> marked;
  const auto mark = [&](Index t) {
    if (mesh_.mark(t)) marked.push_back(t);
  };
  for (const Index t : mesh_.star(a)) mark(t);
  for (const Index t : mesh_.star(b)) mark(t);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const Triangle v = mesh_.triangle(marked[i]);
    for (int k = 0; k < 3; ++k) {
      const Index t = mesh_.across(v[k], v[(k + 1) % 3]);
      if (t == HullMesh::kNone) continue;
      const Triangle& w = mesh_.triangle(t);
      const auto h = beyond_triangle(mesh_[w[0]], mesh_[w[1]], mesh_[w[2]]);
      if (!h || h->height(position) > -rounding_) mark(t);
    }
  }
  return marked;
}

/// Whether no vertex is beyond the triangles from a position to the ring, the original's included.
bool Contractor::contains_original(const std::vector<Index>& ring, const Vec3& position) const {
  std::vector<Vec3> around;
  around.reserve(ring.size());
  for (const Index v : ring) around.push_back(mesh_[v]);
  const PointTree points(around);
  HalfSpace last;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto h = beyond_triangle(around[i], around[(i + 1) % ring.size()], position);
    if (!h) return false;
    // Large fans are often flat.
    const bool known = ring.size() > kFewEdges && h->n.dot(last.n) > 1 - kFlatNormal &&
                       std::abs(h->d - last.d) < kFlatHeight * rounding_;
    last = *h;
    if (known) continue;
    if (points.any_above(h->n, h->d + rounding_) || original_.any_above(h->n, h->d + rounding_))
      return false;
  }
  return true;
}

}  // namespace kaboum::bcd
