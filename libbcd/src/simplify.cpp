#include "simplify.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <unordered_map>

#include "facet_tree.h"
#include "point_tree.h"
#include "principal_prism.h"

namespace kaboum::bcd {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
/// Links of no more edges are looked at in full, others by samples.
constexpr std::size_t kFewEdges = 64;
/// Vertices above which not every contraction is the cheapest.
constexpr std::size_t kMany = 384;

struct HalfSpace {
  Vec3 n;  // unit
  double d;
  [[nodiscard]] double height(const Vec3& p) const { return n.dot(p) - d; }
};

/// Sum of weighted squared distances to planes: vᵀAv − 2bᵀv + c.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  void add(const HalfSpace& h, double weight) {
    a += weight * h.n * h.n.transpose();
    b += weight * h.d * h.n;
  }
  void add(const Quadric& q) {
    a += q.a;
    b += q.b;
  }
};

double size_of(std::span<const Vec3> points) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  return box.diagonal();
}

/// What adds no more to a hull is all the same.
double negligible(double free_cost, double size) {
  return std::clamp(0.02 * free_cost, 1e-5 * size, 2e-4 * size);
}

class Contractor {
 public:
  Contractor(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
             const Solid& solid)
      : solid_(solid),
        near_(PointTree::ordered(points)),
        original_(near_),
        size_(size_of(points)),
        vertices_(points) {
    star_.resize(points.size());
    version_.assign(points.size(), 0);
    quadric_.resize(points.size());
    alive_ = points.size();
    large_ = alive_ > kMany;
    std::vector<FacetTree::Facet> facets;
    for (const Triangle& t : triangles) {
      HalfSpace h;
      if (!plane(points[t[0]], points[t[1]], points[t[2]], h)) {
        add_triangle(t);
        continue;
      }
      facets.push_back({h.n, h.d});
      const double area = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm() +
                          1e-6 * size_ * size_;
      for (const std::uint32_t v : t) quadric_[v].add(h, area);
      add_triangle(t);
      know_tangents(t, h);
    }
    facets_.emplace(std::move(facets), points[0], size_);
  }

  /// Contracts edges in any order, those first that bring a vertex little beyond the hull, while
  /// there are more vertices than `cap`: of many, which go first matters little, and looking for
  /// the cheapest each time would take long. What is far less than `free_cost` is all the same.
  void thin_out(std::size_t cap, double free_cost) {
    struct Tried {
      std::uint64_t stamp;
      double growth;  ///< or less than it is
      Vec3 position;
    };
    std::unordered_map<std::uint64_t, Tried> known;  // by edge
    for (double growth = negligible(free_cost, size_); growth < 1e-2 * size_ && alive_ > cap;
         growth *= 4) {
      const std::size_t old = vertices_.size();
      // The vertices that are new join the end.
      for (std::uint32_t v = 0; v < vertices_.size() && alive_ > cap; ++v) {
        if (star_[v].size() > kFewEdges) continue;
        const std::vector<std::uint32_t> star = star_[v];
        for (const std::uint32_t t : star) {
          Entry e{};
          e.a = v;
          for (int k = 0; k < 3; ++k)
            if (triangles_[t][k] == v) e.b = triangles_[t][(k + 1) % 3];
          const bool tried = e.b < v && v < old;
          if (tried || in_fan(e.a, e.b)) continue;
          const auto key = std::minmax(e.a, e.b);
          const std::uint64_t stamp = version_[e.a] + version_[e.b];
          Tried& last = known[std::uint64_t{key.first} << 32U | key.second];
          if (last.growth == 0 || last.stamp != stamp) {
            last = {stamp, std::numeric_limits<double>::infinity(), Vec3::Zero()};
            if (position(e.a, e.b, last.position)) last.growth = growth;
          }
          if (last.growth > growth) continue;
          last.growth = facets_->beyond(last.position, growth, growth);
          e.position = last.position;
          if (last.growth <= growth && contract(e)) break;
        }
      }
    }
  }

  /// Contracts while there are more vertices than `cap`, then calls reached(), then contracts what
  /// costs at most `free_cost`. @return the largest cost of a contraction done.
  template <class Reached>
  double run(std::size_t cap, double free_cost, Reached&& reached) {
    double largest = 0;
    bool told = false;
    queued_ = true;
    few_ = alive_ <= cap + kFewEdges;
    push_all();
    while (!queue_.empty()) {
      if (!few_ && alive_ <= cap + kFewEdges) {
        few_ = true;
        push_all();
      }
      const Entry e = queue_.top();
      if (!told && alive_ <= cap && (e.cost > 0 || alive_ <= 12)) {
        reached();
        told = true;
      }
      // A dozen vertices are few enough: no distance is spent on fewer.
      if (alive_ <= cap && (e.cost > free_cost || alive_ <= 12)) break;
      if (alive_ <= 5) break;
      queue_.pop();
      if (star_[e.a].empty() || star_[e.b].empty()) continue;
      if (e.stamp != version_[e.a] + version_[e.b]) {
        if (adjacent(e.a, e.b)) push(e.a, e.b);
        continue;
      }
      if (e.guessed) {
        push(e.a, e.b, true);
        continue;
      }
      if (contract(e)) largest = std::max(largest, e.cost);
    }
    if (!told) reached();
    return largest;
  }

  [[nodiscard]] std::vector<Vec3> result() const {
    std::vector<Vec3> out;
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      if (!star_[v].empty()) out.push_back(vertices_[v]);
    return out;
  }
  [[nodiscard]] std::size_t count() const { return alive_; }

 private:
  struct Entry {
    double cost;
    std::uint32_t a, b;
    std::uint64_t stamp;
    bool guessed;  ///< the cost; there is no position
    Vec3 position = Vec3::Zero();
    bool operator<(const Entry& o) const {
      if (cost != o.cost) return cost > o.cost;
      return a != o.a ? a > o.a : b > o.b;
    }
  };

  static bool plane(const Vec3& a, const Vec3& b, const Vec3& c, HalfSpace& h) {
    const Vec3 u = b - a, w = c - a;
    const Vec3 n = u.cross(w);
    const double length = n.norm();
    if (!(length > 1e-14 * (u.squaredNorm() + w.squaredNorm()))) return false;
    h.n = n / length;
    h.d = h.n.dot(a);
    return true;
  }

  void add_triangle(const Triangle& t) {
    const auto index = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(t);
    live_.push_back(1);
    for (const std::uint32_t v : t) star_[v].push_back(index);
  }
  /// The triangle of the hull beyond an edge of one that is marked to go; none if it is marked too.
  [[nodiscard]] std::uint32_t across(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t t : star_[star_[a].size() < star_[b].size() ? a : b]) {
      const Triangle& w = triangles_[t];
      if (live_[t] == 1 &&
          ((w[0] == b && w[1] == a) || (w[1] == b && w[2] == a) || (w[2] == b && w[0] == a)))
        return t;
    }
    return kNone;
  }
  [[nodiscard]] bool in_fan(std::uint32_t a, std::uint32_t b) const {
    return star_[a].size() + star_[b].size() > kFewEdges;
  }
  [[nodiscard]] bool adjacent(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t t : star_[a])
      for (const std::uint32_t v : triangles_[t])
        if (v == b) return true;
    return false;
  }

  /// Plane through the vertices that touches the original hull, seen from the side of the star. An
  /// edge is asked for by all contractions round it: found once.
  bool tangent(std::uint32_t from, std::uint32_t to, HalfSpace& h) {
    const auto [at, fresh] = tangents_.try_emplace(std::uint64_t{from} << 32U | to);
    if (fresh) {
      HalfSpace found;
      if (find_tangent(vertices_[from], vertices_[to], found)) at->second = found;
    }
    if (at->second) h = *at->second;
    return at->second.has_value();
  }

  /// Of the hull's own edges, the plane is that of the facet there.
  void know_tangents(const Triangle& t, const HalfSpace& h) {
    std::array<double, 3> length{};
    for (int k = 0; k < 3; ++k) length[k] = (vertices_[t[(k + 1) % 3]] - vertices_[t[k]]).norm();
    const Vec3& a = vertices_[t[0]];
    const double area = (vertices_[t[1]] - a).cross(vertices_[t[2]] - a).norm();
    // A sliver's plane is left to a search.
    if (!(area > 1e-6 * *std::max_element(length.begin(), length.end()) * size_)) return;
    for (int k = 0; k < 3; ++k)
      tangents_.try_emplace(std::uint64_t{t[k]} << 32U | t[(k + 1) % 3], h);
  }

  bool find_tangent(const Vec3& u, const Vec3& w, HalfSpace& h) const {
    const Vec3 e = w - u;
    const double length = e.norm();
    if (!(length > 0)) return false;
    const double eps = 1e-12 * size_;
    Vec3 n = Vec3::Zero();
    double below = -1;  // boxes that are, hold nothing of interest
    bool found = false;
    original_.visit_above([&] { return std::pair<const Vec3&, double>(n, below); },
                          [&](const Vec3& p) {
                            const Vec3 r = p - u;
                            if (found && n.dot(r) <= eps) return true;
                            // Facet (p, u, w): normal (u − p) × (w − p) = r × … oriented with e and
                            // r.
                            const Vec3 m = e.cross(r);
                            const double size = m.norm();
                            if (size <= 1e-9 * length * size_) return true;
                            n = m / size;
                            below = n.dot(u);
                            found = true;
                            return true;
                          });
    if (!found) return false;
    h.n = n;
    h.d = n.dot(u);
    return true;
  }

  bool link(std::uint32_t a, std::uint32_t b,
            std::vector<std::array<std::uint32_t, 2>>& edges) const {
    edges.clear();
    int both = 0;
    for (const std::uint32_t x : {a, b}) {
      for (const std::uint32_t t : star_[x]) {
        const Triangle& v = triangles_[t];
        const bool has_a = v[0] == a || v[1] == a || v[2] == a;
        const bool has_b = v[0] == b || v[1] == b || v[2] == b;
        if (has_a && has_b) {
          ++both;
          continue;
        }
        int k = 0;
        while (v[k] != x) ++k;
        edges.push_back({v[(k + 1) % 3], v[(k + 2) % 3]});
      }
    }
    return both == 4 && edges.size() >= 3;
  }

  void push_all() {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (int k = 0; k < 3 && live_[t] == 1; ++k) {
        const std::uint32_t a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
        if (a < b) push(a, b);
      }
  }

  /// Round the tips of large fans costs are guessed at first: each contraction there changes all.
  void push(std::uint32_t a, std::uint32_t b, bool certain = false) {
    if (a > b) std::swap(a, b);
    Entry e{};
    e.a = a;
    e.b = b;
    e.stamp = version_[a] + version_[b];
    if (!certain && in_fan(a, b)) {
      e.guessed = true;
      e.cost = (few_ ? 0.1 : 1) * (vertices_[a] - vertices_[b]).norm();
      queue_.push(e);
      return;
    }
    if (place(a, b, e.position, e.cost)) queue_.push(e);
  }

  /// Cheapest position for the vertex that replaces a and b, and what it costs.
  bool place(std::uint32_t a, std::uint32_t b, Vec3& best, double& cost) {
    if (!position(a, b, best)) return false;
    const double growth = facets_->beyond(best);
    double reach = solid_.field(best);
    for (std::size_t i = 0; i < edges_.size(); i += 1 + edges_.size() / (kFewEdges + 1)) {
      const auto& [u, w] = edges_[i];
      const Vec3 &p = vertices_[u], &r = vertices_[w];
      reach = std::max({reach, solid_.field(0.5 * (best + p)), solid_.field((best + p + r) / 3),
                        solid_.field(0.6 * best + 0.2 * p + 0.2 * r)});
    }
    cost = std::max(reach, 0.3 * growth) + 0.02 * growth;
    return growth < 2 * size_;
  }

  /// The position beyond the planes round an edge with the least sum of squared distances; leaves
  /// the edges round it in edges_.
  bool position(std::uint32_t a, std::uint32_t b, Vec3& best) {
    if (!link(a, b, edges_)) return false;
    solid_.work().add(500 + 100 * edges_.size());
    constraints_.clear();
    // Round the tip of a cone of a thousand facets, all pairs and all samples would take minutes.
    const bool few = edges_.size() <= kFewEdges;
    for (const auto& [u, w] : edges_) {
      HalfSpace h;
      if (!tangent(u, w, h)) return false;
      bool known = false;
      for (std::size_t i = 0; few && i < constraints_.size(); ++i) {
        const HalfSpace& c = constraints_[i];
        known = known || (c.n.dot(h.n) > 1 - 1e-14 && std::abs(c.d - h.d) < 1e-12 * size_);
      }
      if (!known) constraints_.push_back(h);
    }
    Quadric q = quadric_[a];
    q.add(quadric_[b]);
    const Vec3 middle = 0.5 * (vertices_[a] + vertices_[b]);
    const double weight = 1e-7 * q.a.trace();
    q.a += weight * Eigen::Matrix3d::Identity();
    q.b += weight * middle;
    return minimise(q, best);
  }

  /// Minimiser of the quadric beyond all constraints. The one most violated joins the up to three
  /// that are active, and the minimiser for these alone is found among their subsets; the minimum
  /// grows each time, so none comes back.
  bool minimise(const Quadric& q, Vec3& best) const {
    const Eigen::Matrix3d inverse = q.a.inverse();
    if (!inverse.allFinite()) return false;
    const Vec3 free = inverse * q.b;
    const double eps = 1e-11 * size_;
    struct Active {
      const HalfSpace* plane = nullptr;
      Vec3 column = Vec3::Zero();
    };
    std::array<Active, 4> active;
    std::size_t count = 0;
    best = free;
    for (int step = 0; step < 60; ++step) {
      const HalfSpace* worst = nullptr;
      double least = -eps;
      for (const HalfSpace& h : constraints_) {
        const double height = h.height(best);
        if (height < least) {
          least = height;
          worst = &h;
        }
      }
      if (worst == nullptr) return true;
      active[count++] = {worst, inverse * worst->n};
      const auto good = [&](const Vec3& v) {
        for (std::size_t i = 0; i < count; ++i)
          if (active[i].plane->height(v) < -eps) return false;
        return true;
      };
      // The newcomer, alone, with one of the others, or with two.
      const Active& c = active[count - 1];
      const auto lack = [&](const Active& x) { return -x.plane->height(free); };
      std::array<Active, 4> next;
      std::size_t size = 0;
      const double gcc = c.plane->n.dot(c.column);
      const Vec3 alone = free + (lack(c) / gcc) * c.column;
      if (good(alone)) {
        best = alone;
        next[size++] = c;
      }
      for (std::size_t i = 0; i + 1 < count && size == 0; ++i) {
        const Active& x = active[i];
        const double gxx = x.plane->n.dot(x.column), gxc = x.plane->n.dot(c.column);
        const double det = gxx * gcc - gxc * gxc;
        if (!(det > 1e-12 * gxx * gcc)) continue;
        const double lx = (lack(x) * gcc - lack(c) * gxc) / det;
        const double lc = (lack(c) * gxx - lack(x) * gxc) / det;
        const Vec3 v = free + lx * x.column + lc * c.column;
        if (lx < 0 || lc < 0 || !good(v)) continue;
        best = v;
        next = {x, c};
        size = 2;
      }
      for (std::size_t i = 0; i + 1 < count && size == 0; ++i) {
        for (std::size_t j = i + 1; j + 1 < count && size == 0; ++j) {
          const HalfSpace &x = *active[i].plane, &y = *active[j].plane, &z = *c.plane;
          const Vec3 yz = y.n.cross(z.n), zx = z.n.cross(x.n), xy = x.n.cross(y.n);
          const double det = x.n.dot(yz);
          if (std::abs(det) < 1e-9) continue;
          const Vec3 v = (x.d * yz + y.d * zx + z.d * xy) / det;
          const Vec3 gradient = q.a * (v - free) / det;  // = Σ multiplier · normal
          const double tiny = 1e-12 * gradient.norm();
          if (gradient.dot(yz) < -tiny || gradient.dot(zx) < -tiny || gradient.dot(xy) < -tiny ||
              !good(v))
            continue;
          best = v;
          next = {active[i], active[j], c};
          size = 3;
        }
      }
      if (size == 0) return false;
      active = next;
      count = size;
    }
    return false;
  }

  bool contract(const Entry& e) {
    // Far below float32's spacing, which comes last; the many facets of large hulls are narrower.
    const double eps = (large_ ? 1e-8 : 1e-10) * size_;
    // Facets that the new vertex sees, and the star.
    std::vector<std::uint32_t> gone;
    const auto mark = [&](std::uint32_t t) {
      if (live_[t] != 1) return false;
      live_[t] = 2;
      gone.push_back(t);
      return true;
    };
    const auto undo = [&] {
      for (const std::uint32_t t : gone) live_[t] = 1;
      return false;
    };
    for (const std::uint32_t t : star_[e.a]) mark(t);
    for (const std::uint32_t t : star_[e.b]) mark(t);
    std::vector<std::array<std::uint32_t, 2>> horizon;
    for (std::size_t i = 0; i < gone.size(); ++i) {
      const Triangle v = triangles_[gone[i]];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t t = across(v[k], v[(k + 1) % 3]);
        if (t == kNone) continue;
        const Triangle& w = triangles_[t];
        HalfSpace h;
        const bool flat = !plane(vertices_[w[0]], vertices_[w[1]], vertices_[w[2]], h);
        if (flat || h.height(e.position) > -eps) mark(t);
      }
    }
    for (const std::uint32_t t : gone) {
      const Triangle& v = triangles_[t];
      for (int k = 0; k < 3; ++k)
        if (across(v[k], v[(k + 1) % 3]) != kNone) horizon.push_back({v[k], v[(k + 1) % 3]});
    }
    solid_.work().add(1000 * gone.size());
    if (horizon.size() < 3) return undo();
    // One loop: every vertex once.
    std::vector<std::uint32_t> ring{horizon[0][0]};
    std::sort(horizon.begin(), horizon.end());
    while (ring.size() <= horizon.size()) {
      const auto next = std::lower_bound(horizon.begin(), horizon.end(),
                                         std::array<std::uint32_t, 2>{ring.back(), 0});
      if (next == horizon.end() || (*next)[0] != ring.back() ||
          (next + 1 != horizon.end() && (*(next + 1))[0] == ring.back()))
        return undo();
      if ((*next)[1] == ring[0]) break;
      ring.push_back((*next)[1]);
    }
    if (ring.size() != horizon.size()) return undo();
    std::vector<Vec3> around;
    around.reserve(ring.size());
    for (const std::uint32_t v : ring) around.push_back(vertices_[v]);
    const PointTree round(around);
    HalfSpace last{Vec3::Zero(), 0};
    for (std::size_t i = 0; i < ring.size(); ++i) {
      HalfSpace h;
      if (!plane(around[i], around[(i + 1) % ring.size()], e.position, h)) return undo();
      // Large fans are often flat.
      const bool known = ring.size() > kFewEdges && h.n.dot(last.n) > 1 - 1e-15 &&
                         std::abs(h.d - last.d) < 1e-3 * eps;
      last = h;
      if (known) continue;
      if (round.any_above(h.n, h.d + eps) || original_.any_above(h.n, h.d + eps)) return undo();
    }
    Quadric q;
    for (const std::uint32_t v : {e.a, e.b}) q.add(quadric_[v]);
    std::vector<std::uint32_t> lost;
    for (const std::uint32_t t : gone)
      for (const std::uint32_t v : triangles_[t]) lost.push_back(v);
    std::sort(lost.begin(), lost.end());
    lost.erase(std::unique(lost.begin(), lost.end()), lost.end());
    for (const std::uint32_t t : gone) live_[t] = 0;
    for (const std::uint32_t v : lost)
      std::erase_if(star_[v], [&](std::uint32_t t) { return live_[t] == 0; });
    const auto fresh = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(e.position);
    star_.emplace_back();
    version_.push_back(0);
    for (std::size_t i = 0; i < ring.size(); ++i)
      add_triangle({ring[i], ring[(i + 1) % ring.size()], fresh});
    ++alive_;
    for (const std::uint32_t v : lost) {
      if (star_[v].empty()) {
        --alive_;
        if (v != e.a && v != e.b) q.add(quadric_[v]);
      } else {
        ++version_[v];
      }
    }
    quadric_.push_back(q);
    if (queued_)
      for (const std::uint32_t v : ring) push(fresh, v);
    return true;
  }

  const Solid& solid_;
  std::vector<Vec3> near_;  // the original's vertices, neighbours near each other
  PointTree original_;
  std::optional<FacetTree> facets_;                                       // original
  std::unordered_map<std::uint64_t, std::optional<HalfSpace>> tangents_;  // by edge
  double size_;
  std::vector<Vec3> vertices_;
  std::vector<std::vector<std::uint32_t>> star_;
  std::vector<std::uint64_t> version_;
  std::vector<Quadric> quadric_;
  std::vector<Triangle> triangles_;
  std::vector<char> live_;
  std::size_t alive_ = 0;
  bool large_ = false;   // at first
  bool queued_ = false;  // all edges are in the queue
  bool few_ = false;     // vertices are left, so that fans are worth a closer look
  std::priority_queue<Entry> queue_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<HalfSpace> constraints_;
};

/// Vertices of a convex hull whose own hull no other is farther beyond than `tolerance`: of each
/// facet's, the farthest joins, round by round. Thousands of corners of a disc come down to a few
/// hundred, and slivers, of no certain normals, with them.
std::vector<Vec3> main_vertices(std::span<const Vec3> hull, double tolerance) {
  const double size = size_of(hull);
  std::vector<std::uint32_t> open(hull.size());
  std::iota(open.begin(), open.end(), 0U);
  std::vector<Vec3> out;
  // First the extreme ones along the axes and the cube's diagonals.
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
    const Vec3 n(x, y, z);
    if (n.isZero()) continue;
    out.push_back(*std::max_element(hull.begin(), hull.end(), [&](const Vec3& p, const Vec3& q) {
      return n.dot(p) < n.dot(q);
    }));
  }
  geom::HullBuilder builder;
  for (int round = 0; round < 40; ++round) {
    if (!builder.build(out)) return {hull.begin(), hull.end()};
    std::vector<FacetTree::Facet> facets;
    for (const Triangle& t : builder.triangles()) {
      const Vec3& a = out[t[0]];
      const Vec3 n = (out[t[1]] - a).cross(out[t[2]] - a);
      const double length = n.norm();
      if (length > 0) facets.push_back({n / length, n.dot(a) / length});
    }
    const FacetTree tree(facets, out[0], size);
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> farthest;  // by facet
    std::erase_if(open, [&](std::uint32_t v) {
      const auto [height, facet] = tree.farthest(hull[v], tolerance);
      if (height <= tolerance) return true;  // the hull only grows
      auto& [most, at] = farthest[facet];
      if (height > most) {
        most = height;
        at = v;
      }
      return false;
    });
    if (farthest.empty()) return out;
    for (const auto& [facet, point] : farthest) out.push_back(hull[point.second]);
  }
  return {hull.begin(), hull.end()};
}

}  // namespace

Simplified simplify(std::span<const Vec3> hull, std::size_t cap, double free_cost,
                    const Solid& solid) {
  Simplified out;
  out.vertices.assign(hull.begin(), hull.end());
  out.needed = out.vertices;
  if (hull.size() <= std::min<std::size_t>(cap, 4)) return out;
  const auto prism_round = [&] {
    const auto prism = PrincipalPrism::round(hull, cap);
    return prism ? prism->corners() : std::vector<Vec3>(hull.begin(), hull.end());
  };
  geom::HullBuilder builder;
  if (!builder.build(hull)) {
    // Flat: a prism is as good as anything.
    if (hull.size() > cap) out.needed = out.vertices = prism_round();
    return out;
  }
  if (const std::size_t all = builder.vertices().size(); all > kMany) {
    solid.work().add(10000 * all);
    builder.build(out.vertices = main_vertices(hull, negligible(free_cost, size_of(hull))));
  }
  const Mesh mesh = builder.mesh();
  Contractor contractor(mesh.vertices, mesh.triangles, solid);
  const auto result = [&] {
    return contractor.count() <= cap ? contractor.result() : prism_round();
  };
  contractor.thin_out(std::max(kMany, 6 * cap), free_cost);
  out.cost = contractor.run(cap, free_cost, [&] { out.needed = result(); });
  out.vertices = result();
  return out;
}

}  // namespace kaboum::bcd
