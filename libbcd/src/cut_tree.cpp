// Pieces of a solid, cut by planes that are chosen by what they leave between hulls and solid.
// docs/algorithms/convex-decomposition.md, "Search".

#include <kaboum/base/parallel.h>
#include <kaboum/geom/topology.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "cut_tree.h"
#include "principal_box.h"
#include "symmetry.h"

namespace kaboum::bcd {
namespace {

/// A plane's hull points on one side, with the cell's corners that lie inside the solid.
struct Scratch {
  geom::HullBuilder builder;
  std::vector<double> height;
  std::vector<Side> side;
  std::vector<Vec3> lower, upper;
  std::vector<char> mark;
};

Scratch& scratch() {
  static thread_local Scratch s;
  return s;
}

/// The least and the largest of the points' coordinates along n.
std::pair<double, double> extent(const std::vector<Vec3>& points, const Vec3& n) {
  std::pair<double, double> out{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  for (const Vec3& p : points) {
    out.first = std::min(out.first, n.dot(p));
    out.second = std::max(out.second, n.dot(p));
  }
  return out;
}

/// An edge where the solid bends inwards, with the outer normals beside it.
struct ReflexEdge {
  Vec3 a, b;
  Vec3 p, q;
  std::array<std::uint32_t, 2> triangles;
  double weight;
};

/// A plane through two reflex edges.
struct Neck {
  Plane plane;
  std::array<std::uint32_t, 4> triangles;
  double weight;
};

/// For the heaviest edges, planes through each and the nearest ones such that cutting there leaves
/// neither reflex: a tooth is cut off at its foot.
std::vector<Neck> necks(std::vector<ReflexEdge> edges, double diagonal) {
  constexpr std::size_t kMostEdges = 256, kNearest = 2;
  std::stable_sort(edges.begin(), edges.end(),
                   [](const ReflexEdge& e, const ReflexEdge& f) { return e.weight > f.weight; });
  if (edges.size() > kMostEdges) edges.resize(kMostEdges);
  std::vector<Neck> out;
  for (const ReflexEdge& e : edges) {
    std::vector<std::pair<double, Neck>> found;
    const Vec3 along = e.b - e.a, from = 0.5 * (e.a + e.b);
    for (const ReflexEdge& f : edges) {
      const Vec3 across = 0.5 * (f.a + f.b) - from;
      const double length = across.norm();
      const Vec3 n = along.cross(across);
      if (!(n.norm() > 0.1 * along.norm() * length)) continue;
      const double least = 1e-4 * length;
      if (across.dot(e.p) > least || across.dot(e.q) > least || across.dot(f.p) < -least ||
          across.dot(f.q) < -least)
        continue;
      const Plane plane{n.normalized(), n.normalized().dot(from)};
      if (std::max(std::abs(plane.height(f.a)), std::abs(plane.height(f.b))) > 1e-3 * length)
        continue;
      found.emplace_back(length,
                         Neck{plane,
                              {e.triangles[0], e.triangles[1], f.triangles[0], f.triangles[1]},
                              (e.weight + f.weight) * (1 - length / diagonal)});
    }
    const std::size_t kept = std::min(kNearest, found.size());
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 0; i < kept; ++i) out.push_back(found[i].second);
  }
  return out;
}

}  // namespace

CutTree::CutTree(const SolidField& solid, const SearchOptions& options, double safety)
    : solid_(solid), options_(options) {
  double magnitude = 0;
  for (const Vec3& p : solid.mesh().vertices)
    magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  shift_ = 0x1p-36 * safety * magnitude;
  add_leaf(whole(solid), -1);
}

void CutTree::find_planes() {
  if (std::exchange(planes_found_, true) || options_.choose) return;
  find_reflex_planes();
  if (options_.mirrors) mirrors_ = mirror_planes(solid_);
}

void CutTree::find_reflex_planes() {
  const Mesh& mesh = solid_.mesh();
  const std::vector<geom::EdgeUse> uses = geom::edge_uses(mesh);
  reflex_of_.resize(mesh.triangles.size());
  std::map<std::array<int, 4>, std::uint32_t> known;
  const auto plane_of = [&](std::uint32_t t, Plane& plane) {
    const auto& v = mesh.vertices;
    const Triangle& tri = mesh.triangles[t];
    const Vec3 n = (v[tri[1]] - v[tri[0]]).cross(v[tri[2]] - v[tri[0]]);
    const double length = n.norm();
    if (!(length > 0)) return false;
    plane.n = n / length;
    plane.d = plane.n.dot(v[tri[0]]);
    return true;
  };
  const auto number_of = [&](Plane plane, double weight) {
    // Opposite normals are the same cut.
    int axis = 0;
    plane.n.cwiseAbs().maxCoeff(&axis);
    if (plane.n[axis] < 0) {
      plane.n = -plane.n;
      plane.d = -plane.d;
    }
    const double center = plane.n.dot(solid_.box().center());
    const std::array<int, 4> key{
        static_cast<int>(std::lround(200 * plane.n.x())),
        static_cast<int>(std::lround(200 * plane.n.y())),
        static_cast<int>(std::lround(200 * plane.n.z())),
        static_cast<int>(std::lround(500 * (plane.d - center) / solid_.diagonal()))};
    const auto [at, fresh] = known.emplace(key, static_cast<std::uint32_t>(reflex_.size()));
    if (fresh) reflex_.push_back({plane, weight});
    return at->second;
  };
  std::vector<ReflexEdge> edges;
  for (std::size_t i = 0; i + 1 < uses.size(); ++i) {
    if (uses[i].lo != uses[i + 1].lo || uses[i].hi != uses[i + 1].hi) continue;
    const std::uint32_t s = uses[i].triangle, t = uses[i + 1].triangle;
    Plane p, q;
    if (!plane_of(s, p) || !plane_of(t, q)) continue;
    const std::uint32_t apex = mesh.triangles[t][(uses[i + 1].corner + 2) % 3];
    const double sine = p.n.cross(q.n).norm();
    const double cosine = p.n.dot(q.n);
    if (p.height(mesh.vertices[apex]) <= 0) continue;
    if (std::atan2(sine, cosine) < 0.25) continue;
    const Vec3 &a = mesh.vertices[uses[i].lo], &b = mesh.vertices[uses[i].hi];
    const double weight = (b - a).norm() * std::atan2(sine, cosine);
    edges.push_back({a, b, p.n, q.n, {s, t}, weight});
    for (const Plane& plane : {p, q}) {
      const std::uint32_t number = number_of(plane, 0);
      reflex_of_[s].push_back(number);
      reflex_of_[t].push_back(number);
      reflex_[number].weight = std::max(reflex_[number].weight, weight);
    }
    Vec3 across = p.n - q.n;
    if (across.norm() > 0.05) {
      Plane bisector;
      bisector.n = across.normalized();
      bisector.d = bisector.n.dot(0.5 * a + 0.5 * b);
      const std::uint32_t number = number_of(bisector, 0);
      reflex_of_[s].push_back(number);
      reflex_of_[t].push_back(number);
      reflex_[number].weight = std::max(reflex_[number].weight, 0.5 * weight);
    }
  }
  for (const Neck& neck : necks(std::move(edges), solid_.diagonal())) {
    const std::uint32_t number = number_of(neck.plane, 0);
    for (const std::uint32_t t : neck.triangles) reflex_of_[t].push_back(number);
    reflex_[number].weight = std::max(reflex_[number].weight, neck.weight);
  }
}

CutTree::Node CutTree::node_of(Piece&& piece) const {
  Node node;
  geom::HullBuilder& builder = scratch().builder;
  const std::vector<Vec3> points = piece.hull_points();
  node.concavity = estimate_concavity(points, solid_, builder);
  if (!node.concavity.flat) {
    for (const std::uint32_t v : builder.vertices()) node.hull.push_back(points[v]);
  } else {
    node.hull = points;
  }
  node.piece = std::move(piece);
  return node;
}

void CutTree::add_leaf(Piece&& piece, int parent) {
  Node node = node_of(std::move(piece));
  node.parent = parent;
  nodes_.push_back(std::move(node));
  ++leaf_count_;
}

void CutTree::reestimate() {
  for (Node& n : nodes_)
    if (!n.hull.empty()) n.concavity = estimate_concavity(n.hull, solid_, scratch().builder);
}

void CutTree::reestimate(const SolidField::Witness& witness) {
  const Vec3& at = witness.point;
  const double near = witness.near();
  for (Node& n : nodes_) {
    if (n.hull.empty()) continue;
    Box3 box;
    for (const Vec3& p : n.hull) box.extend(p);
    if ((at.array() < box.min.array() - near).any() || (at.array() > box.max.array() + near).any())
      continue;
    n.concavity = estimate_concavity(n.hull, solid_, scratch().builder);
  }
}

std::vector<int> CutTree::leaves() const { return leaves(std::numeric_limits<std::size_t>::max()); }

std::vector<int> CutTree::leaves(std::size_t count) const {
  // Nodes are in the order of the cuts; children of one cut are neighbours.
  const int all = static_cast<int>(nodes_.size());
  int end = 1;
  for (std::size_t reached = 1; end < all && reached < count;) {
    const int parent = nodes_[end].parent;
    while (end < all && nodes_[end].parent == parent) {
      if (end == nodes_[parent].upper && nodes_[parent].lower >= 0) ++reached;
      ++end;
    }
  }
  std::vector<int> out;
  for (int i = 0; i < end; ++i) {
    const Node& n = nodes_[i];
    if ((n.lower < 0 || n.lower >= end) && (n.upper < 0 || n.upper >= end)) out.push_back(i);
  }
  return out;
}

std::vector<int> CutTree::nodes_within(double distance, std::vector<int> nodes) const {
  std::vector<int> out;
  while (!nodes.empty()) {
    const int node = nodes.back();
    nodes.pop_back();
    if (is_leaf(node) || nodes_[node].concavity.worst <= distance) {
      out.push_back(node);
    } else {
      append_children(node, nodes);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

void CutTree::append_children(int node, std::vector<int>& out) const {
  for (const int child : {nodes_[node].lower, nodes_[node].upper})
    if (child >= 0) out.push_back(child);
}

void CutTree::leaves_below(int node, std::vector<int>& out) const {
  const Node& n = nodes_[node];
  if (is_leaf(node)) out.push_back(node);
  if (n.lower >= 0) leaves_below(n.lower, out);
  if (n.upper >= 0) leaves_below(n.upper, out);
}

double CutTree::worst() const {
  double worst = 0;
  for (const Node& n : nodes_)
    if (n.lower < 0 && !n.stuck) worst = std::max(worst, n.concavity.worst);
  return worst;
}

bool CutTree::part(const Piece& piece, const Plane& plane, std::vector<Vec3>& lower,
                   std::vector<Vec3>& upper) const {
  Scratch& s = scratch();
  classify(piece, plane, solid_, shift_, s.height, s.side);
  s.mark.assign(piece.points.size(), 0);
  solid_.work().add(40 * piece.polygons());
  bool any[2]{};
  for (std::size_t f = 0; f < s.side.size(); ++f) {
    const std::uint32_t first = piece.start[f], last = piece.start[f + 1];
    if (s.side[f] != Side::Both) {
      const char bit = s.side[f] == Side::Lower ? 1 : 2;
      any[bit - 1] = true;
      for (std::uint32_t k = first; k < last; ++k) s.mark[piece.corner[k]] |= bit;
      continue;
    }
    any[0] = any[1] = true;
    for (std::uint32_t k = first; k < last; ++k) {
      const std::uint32_t a = piece.corner[k];
      const std::uint32_t b = piece.corner[k + 1 < last ? k + 1 : first];
      const double ha = s.height[a], hb = s.height[b];
      s.mark[a] |= static_cast<char>((ha <= 0 ? 1 : 0) | (ha >= 0 ? 2 : 0));
      if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0)) {
        const Vec3 p = piece.points[a] + (ha / (ha - hb)) * (piece.points[b] - piece.points[a]);
        lower.push_back(p);
        upper.push_back(p);
      }
    }
  }
  if (!any[0] || !any[1]) return false;
  for (std::size_t i = 0; i < piece.points.size(); ++i) {
    if ((s.mark[i] & 1) != 0) lower.push_back(piece.points[i]);
    if ((s.mark[i] & 2) != 0) upper.push_back(piece.points[i]);
  }
  const Cell& cell = piece.cell;
  for (std::size_t i = 0; i < cell.corners.size(); ++i)
    if (piece.inside[i] != 0)
      (plane.height(cell.corners[i]) <= 0 ? lower : upper).push_back(cell.corners[i]);
  for (const auto& [a, b] : cell.edges()) {
    const double ha = plane.height(cell.corners[a]), hb = plane.height(cell.corners[b]);
    if (!((ha < 0 && hb > 0) || (ha > 0 && hb < 0))) continue;
    const Vec3 p = cell.corners[a] + (ha / (ha - hb)) * (cell.corners[b] - cell.corners[a]);
    if (solid_.field(p) >= -0.25 * solid_.spacing()) continue;
    lower.push_back(p);
    upper.push_back(p);
  }
  return true;
}

double CutTree::score(const Node& node, const Plane& plane) const {
  const auto [low, high] = extent(node.hull, plane.n);
  const double thinnest = std::min(plane.d - low, high - plane.d);
  // Pieces as thin as their overlap are no smaller.
  if (thinnest < 8 * shift_) return std::numeric_limits<double>::infinity();
  // Plates are split into thinner ones only where nothing else helps: these reach as far but for
  // the thickness.
  Box3 box;
  for (const Vec3& p : node.hull) box.extend(p);
  const bool plate = thinnest < 1e-6 * box.diagonal() || high - low < node.concavity.worst;
  const double penalty = plate ? 1e6 : 1;
  Scratch& s = scratch();
  s.lower.clear();
  s.upper.clear();
  if (!part(node.piece, plane, s.lower, s.upper)) return std::numeric_limits<double>::infinity();
  const double limit = node.concavity.fourth;
  const Concavity lower = estimate_concavity(s.lower, solid_, s.builder, true);
  if (lower.fourth > 2 * limit) return penalty * lower.fourth;
  const Concavity upper = estimate_concavity(s.upper, solid_, s.builder, true);
  return penalty * (lower.fourth + upper.fourth) *
         preference(std::min(lower.volume, upper.volume), lower.volume + upper.volume);
}

double CutTree::preference(double smaller, double volume) const {
  // Where no single cut helps, slicing off a little always seems to: cuts in the middle are
  // preferred up to a factor, for they bring the next cuts nearer.
  const double balance = volume > 0 ? smaller / volume : 0;
  return 1 - 0.6 * std::min(1.0, 4 * balance) - 2 * options_.halving_bonus * balance;
}

double CutTree::look_ahead(const Node& node, const Plane& plane) const {
  std::array<Piece, 2> parts;
  {
    Scratch& s = scratch();
    classify(node.piece, plane, solid_, shift_, s.height, s.side);
    for (const bool lower : {true, false})
      parts[lower ? 0 : 1] = clip(node.piece, plane, lower, shift_, solid_, s.height, s.side);
  }
  double sum = 0, volume = 0, least = std::numeric_limits<double>::infinity();
  for (Piece& part : parts) {
    if (part.empty()) return std::numeric_limits<double>::infinity();
    const Node child = node_of(std::move(part));
    double best = child.concavity.fourth;
    if (child.piece.polygons() > 0)
      for (const Candidate& c : candidates(child)) best = std::min(best, score(child, c.plane));
    sum += best;
    volume += child.concavity.volume;
    least = std::min(least, child.concavity.volume);
  }
  return sum * preference(least, volume);
}

std::vector<std::uint32_t> CutTree::reflex_planes(const Node& node) const {
  Box3 box;
  for (const Vec3& p : node.hull) box.extend(p);
  const double least = 1e-4 * box.diagonal();
  std::map<std::uint32_t, double> weight;
  for (const std::uint32_t t : node.piece.source)
    for (const std::uint32_t r : reflex_of_[t]) weight[r] += reflex_[r].weight;
  std::vector<std::pair<double, std::uint32_t>> order;
  for (const auto& [r, w] : weight) {
    const auto [low, high] = extent(node.hull, reflex_[r].plane.n);
    if (low < reflex_[r].plane.d - least && high > reflex_[r].plane.d + least)
      order.emplace_back(-w, r);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> out;
  out.reserve(order.size());
  for (const auto& [w, r] : order) out.push_back(r);
  return out;
}

Plane CutTree::snapped(const Node& node, const Plane& plane) const {
  Plane best = plane;
  const auto [low, high] = extent(node.hull, plane.n);
  double nearest = std::min(solid_.spacing(), 0.5 * (high - low) / (options_.offsets + 1));
  for (const std::uint32_t r : reflex_planes(node)) {
    const Plane& other = reflex_[r].plane;
    const double sign = other.n.dot(plane.n) < 0 ? -1 : 1;
    if ((other.n - sign * plane.n).norm() > 0.01) continue;
    const auto [lowest, highest] = extent(node.hull, other.n);
    if (std::min(other.d - lowest, highest - other.d) < 8 * shift_) continue;
    double apart = 0;
    for (const Vec3& p : node.hull)
      apart = std::max(apart, std::abs(other.height(p) - sign * plane.height(p)));
    if (apart >= nearest) continue;
    nearest = apart;
    best = other;
  }
  return best;
}

std::vector<CutTree::Candidate> CutTree::candidates(const Node& node) const {
  std::vector<Candidate> out;
  std::vector<Vec3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (const auto principal = principal_box(node.hull))
    for (int k = 0; k < 3; ++k)
      if (principal->axes.col(k).cwiseAbs().maxCoeff() < 0.99)
        directions.emplace_back(principal->axes.col(k));
  for (const Vec3& n : directions) {
    const auto [low, high] = extent(node.hull, n);
    for (int i = 1; i <= options_.offsets; ++i)
      out.push_back({{n, low + (high - low) * i / (options_.offsets + 1)}});
  }
  // A part that is itself symmetric may best be cut into mirror images.
  for (const Plane& plane : mirrors_) {
    const auto [low, high] = extent(node.hull, plane.n);
    if (std::abs(0.5 * (low + high) - plane.d) < 0.01 * (high - low)) out.push_back({plane});
  }
  // Planes that separate, or run through, the pit below the worst point.
  const Vec3& x = node.concavity.at;
  const double step = solid_.spacing();
  Vec3 g;
  for (int k = 0; k < 3; ++k)
    g[k] = solid_.field(x + step * Vec3::Unit(k)) - solid_.field(x - step * Vec3::Unit(k));
  if (g.norm() > 0.1 * step) {
    g.normalize();
    const Vec3 y = x - node.concavity.worst * g;
    out.push_back({{g, g.dot(y)}});
    const Vec3 u = g.unitOrthogonal(), w = g.cross(u);
    for (int k = 0; k < 4; ++k) {
      const double angle = 0.25 * M_PI * k;
      const Vec3 n = std::cos(angle) * u + std::sin(angle) * w;
      out.push_back({{n, n.dot(y)}});
    }
  }
  if (options_.reflex_planes > 0) {
    const std::vector<std::uint32_t> order = reflex_planes(node);
    for (std::size_t i = 0;
         i < order.size() && i < static_cast<std::size_t>(options_.reflex_planes); ++i)
      out.push_back({reflex_[order[i]].plane});
  }
  return out;
}

CutTree::Candidate CutTree::best_in_two(const Node& node, std::vector<Candidate> list) const {
  std::stable_sort(list.begin(), list.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  list.resize(std::min(list.size(), static_cast<std::size_t>(options_.look_ahead)));
  std::vector<double> deep(list.size());
  parallel_loop(std::size_t{0}, list.size(),
                [&](std::size_t i) { deep[i] = look_ahead(node, list[i].plane); });
  return list[static_cast<std::size_t>(std::min_element(deep.begin(), deep.end()) - deep.begin())];
}

void CutTree::evaluate(const Node& node, std::vector<Candidate>& list) const {
  parallel_loop(std::size_t{0}, list.size(),
                [&](std::size_t i) { list[i].score = score(node, list[i].plane); });
}

bool CutTree::cut(int leaf) {
  find_planes();
  const Node& node = nodes_[leaf];
  if (node.piece.polygons() == 0) {
    nodes_[leaf].stuck = true;
    return false;
  }
  if (options_.choose) {
    const std::optional<Plane> plane = options_.choose(node.piece.cell, node.hull);
    if (plane) {
      cut(leaf, *plane);
    } else {
      nodes_[leaf].stuck = true;
    }
    return plane.has_value();
  }
  std::vector<Candidate> list = candidates(node);
  evaluate(node, list);
  const auto best_of = [](const std::vector<Candidate>& l) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < l.size(); ++i)
      if (l[i].score < l[best].score) best = i;
    return l[best];
  };
  if (list.empty()) {
    nodes_[leaf].stuck = true;
    return false;
  }
  Candidate best = best_of(list);
  if (!std::isfinite(best.score)) {
    nodes_[leaf].stuck = true;
    return false;
  }
  if (options_.look_ahead > 1) best = best_in_two(node, std::move(list));
  const auto [low, high] = extent(node.hull, best.plane.n);
  double step = 0.5 * (high - low) / (options_.offsets + 1);
  for (int r = 0; r < options_.refinements; ++r, step *= 0.5) {
    std::vector<Candidate> near;
    for (const double s : {-step, step})
      if (best.plane.d + s > low && best.plane.d + s < high)
        near.push_back({{best.plane.n, best.plane.d + s}});
    if (near.empty()) continue;
    evaluate(node, near);
    const Candidate c = best_of(near);
    if (c.score < best.score) best = c;
  }
  cut(leaf, snapped(node, best.plane));
  return true;
}

bool CutTree::halve(int leaf) {
  const Node& node = nodes_[leaf];
  const auto box = principal_box(node.hull);
  if (node.piece.polygons() == 0 || !box) return false;
  int axis = 0;
  (box->high - box->low).maxCoeff(&axis);
  Plane plane;
  plane.n = box->axes.col(axis);
  plane.d = plane.n.dot(box->mean) + 0.5 * (box->low[axis] + box->high[axis]);
  if (!std::isfinite(score(node, plane))) return false;
  cut(leaf, plane);
  return true;
}

void CutTree::cut(int leaf, const Plane& plane) {
  const Piece piece = std::move(nodes_[leaf].piece);
  Scratch& s = scratch();
  classify(piece, plane, solid_, shift_, s.height, s.side);
  Piece lower = clip(piece, plane, true, shift_, solid_, s.height, s.side);
  Piece upper = clip(piece, plane, false, shift_, solid_, s.height, s.side);
  nodes_[leaf].plane = plane;
  nodes_[leaf].piece = {};
  --leaf_count_;
  if (!lower.empty()) {
    add_leaf(std::move(lower), leaf);
    nodes_[leaf].lower = static_cast<int>(nodes_.size()) - 1;
  }
  if (!upper.empty()) {
    add_leaf(std::move(upper), leaf);
    nodes_[leaf].upper = static_cast<int>(nodes_.size()) - 1;
  }
  // Where both halves are as far as the whole was, it might go on in twice as many pieces each
  // time.
  const Node& whole = nodes_[leaf];
  if (whole.lower < 0 || whole.upper < 0) return;
  constexpr int kMostStaleCuts = 8;
  const double far = 0.99 * whole.concavity.worst;
  const bool stale =
      std::min(nodes_[whole.lower].concavity.worst, nodes_[whole.upper].concavity.worst) > far;
  for (const int half : {whole.lower, whole.upper}) {
    nodes_[half].stale_cuts = whole.stale_cuts + (stale ? 1 : 0);
    nodes_[half].stuck = nodes_[half].stale_cuts >= kMostStaleCuts;
  }
}

Side CutTree::side_of(int node, const Plane& plane) const {
  // Slivers left by an earlier cut along the plane are no reason for another one.
  const double least = 8 * shift_;
  bool below = false, above = false;
  for (const Vec3& p : nodes_[node].hull) {
    const double height = plane.height(p);
    below = below || height < -least;
    above = above || height > least;
  }
  if (below && above) return Side::Both;
  return above ? Side::Upper : Side::Lower;
}

std::optional<CutTree::Split> CutTree::find_split(const std::vector<int>& nodes,
                                                  const Vec3& direction, double limit) const {
  std::vector<Vec3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (direction.norm() > 0) directions.insert(directions.begin(), direction.normalized());
  const auto range = [&](const Vec3& n) {
    std::pair<double, double> out{std::numeric_limits<double>::infinity(),
                                  -std::numeric_limits<double>::infinity()};
    for (const int node : nodes) {
      const auto [low, high] = extent(nodes_[node].hull, n);
      out = {std::min(out.first, low), std::max(out.second, high)};
    }
    return out;
  };
  const auto worst = [&](const Plane& plane) {
    Scratch& s = scratch();
    s.lower.clear();
    s.upper.clear();
    std::vector<int> open = nodes;
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      const Side side = side_of(node, plane);
      if (side == Side::Both && !is_leaf(node)) {
        append_children(node, open);
        continue;
      }
      if (side == Side::Both && part(nodes_[node].piece, plane, s.lower, s.upper)) continue;
      const std::vector<Vec3>& hull = nodes_[node].hull;
      auto& to = side == Side::Lower ? s.lower : s.upper;
      to.insert(to.end(), hull.begin(), hull.end());
    }
    if (s.lower.empty() || s.upper.empty() || spans_beyond(s.lower, solid_, limit) ||
        spans_beyond(s.upper, solid_, limit))
      return std::numeric_limits<double>::infinity();
    const double lower = estimate_concavity(s.lower, solid_, s.builder, true, limit).worst;
    if (lower >= limit) return std::numeric_limits<double>::infinity();
    const double upper = estimate_concavity(s.upper, solid_, s.builder, true, limit).worst;
    return upper >= limit ? std::numeric_limits<double>::infinity() : std::max(lower, upper);
  };
  std::vector<Split> list;
  for (const Vec3& n : directions) {
    const auto [low, high] = range(n);
    for (int i = 1; i <= options_.offsets; ++i)
      list.push_back({{n, low + (high - low) * i / (options_.offsets + 1)}});
  }
  const auto evaluate = [&](std::vector<Split>& splits) {
    parallel_loop(std::size_t{0}, splits.size(),
                  [&](std::size_t i) { splits[i].worst = worst(splits[i].plane); });
  };
  const auto better = [](const Split& a, const Split& b) { return a.worst < b.worst; };
  evaluate(list);
  Split best = *std::min_element(list.begin(), list.end(), better);
  if (!(best.worst < limit)) return std::nullopt;
  const auto [low, high] = range(best.plane.n);
  double step = 0.5 * (high - low) / (options_.offsets + 1);
  for (int r = 0; r < 2 + options_.refinements; ++r, step *= 0.5) {
    list.clear();
    for (const double s : {-step, step})
      list.push_back({{best.plane.n, std::clamp(best.plane.d + s, low, high)}});
    evaluate(list);
    best = std::min(best, *std::min_element(list.begin(), list.end(), better), better);
  }
  return best;
}

void CutTree::split(std::vector<int> nodes, const Plane& plane, std::vector<int>& lower,
                    std::vector<int>& upper) {
  while (!nodes.empty()) {
    const int node = nodes.back();
    nodes.pop_back();
    const Side side = side_of(node, plane);
    if (side != Side::Both) {
      (side == Side::Upper ? upper : lower).push_back(node);
      continue;
    }
    if (is_leaf(node)) {
      cut(node, plane);
      if (nodes_[node].lower >= 0) lower.push_back(nodes_[node].lower);
      if (nodes_[node].upper >= 0) upper.push_back(nodes_[node].upper);
    } else {
      append_children(node, nodes);
    }
  }
  std::sort(lower.begin(), lower.end());
  std::sort(upper.begin(), upper.end());
}

bool CutTree::cut_worst() {
  for (;;) {
    int worst = -1;
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
      const Node& n = nodes_[i];
      if (n.lower >= 0 || n.upper >= 0 || n.stuck) continue;
      if (worst < 0 || n.concavity.worst > nodes_[worst].concavity.worst) worst = i;
    }
    if (worst < 0 || nodes_[worst].concavity.worst <= 0) return false;
    if (cut(worst)) return true;
  }
}

}  // namespace kaboum::bcd
