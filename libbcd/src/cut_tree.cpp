// Pieces of a solid in a binary tree of cuts.
// docs/algorithms/convex-decomposition.md, "Cells" and "Search".

#include "cut_tree.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "principal_box.h"

namespace kaboum::bcd {
namespace {

/// Half the overlap of neighbouring pieces with `safety` 1, as a share of the
/// largest coordinate (docs/algorithms/convex-decomposition.md, "Rounding").
constexpr double kShift = 0x1p-36;
/// Where both halves are as far as the whole was, but for this share, it might
/// go on in twice as many pieces each time: not after so many such cuts.
constexpr double kNearer = 0.99;
constexpr int kMostStaleCuts = 8;
/// Halvings of an offset when bodies are split, besides those of cuts.
constexpr int kMoreRefinements = 2;

double shift_of(const SolidField& solid, double safety) {
  double magnitude = 0;
  for (const Vec3& p : solid.mesh().vertices)
    magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  return kShift * safety * magnitude;
}

}  // namespace

CutTree::CutTree(const SolidField& solid, const SearchOptions& options, double safety)
    : solid_(solid), shift_(shift_of(solid, safety)), chooser_(solid, options, shift_) {
  add_leaf(whole(solid), -1);
}

CutTree::CutTree(const CutTree& same, const SolidField& solid)
    : solid_(solid),
      shift_(same.shift_),
      chooser_(solid, same.chooser_.options(), shift_),
      choices_(same.choices_) {
  add_leaf(whole(solid), -1);
}

void CutTree::add_leaf(Piece&& piece, int parent) {
  Node node = make_node(std::move(piece), solid_);
  node.parent = parent;
  nodes_.push_back(std::move(node));
  ++leaf_count_;
}

void CutTree::reestimate() {
  for (Node& n : nodes_)
    if (!n.hull.empty()) n.concavity = estimate_concavity(n.hull, solid_, cut_scratch().builder);
}

void CutTree::reestimate(const SolidField::Witness& witness) {
  only_worst_ = false;
  const Vec3& at = witness.point;
  const double near = witness.near();
  std::vector<Node*> judged;
  for (Node& n : nodes_) {
    if (n.hull.empty()) continue;
    Box3 box;
    for (const Vec3& p : n.hull) box.extend(p);
    if ((at.array() > box.min.array() - near).all() && (at.array() < box.max.array() + near).all())
      judged.push_back(&n);
  }
  parallel_for(std::size_t{0}, judged.size(), [&](std::size_t i) {
    add_witness(judged[i]->hull, solid_, witness, cut_scratch().builder, judged[i]->concavity);
  });
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

std::optional<Plane> CutTree::choose(int leaf) {
  chooser_.prepare();
  const Node& node = nodes_[leaf];
  return node.piece.polygons() == 0 ? std::nullopt : chooser_.choose(node);
}

bool CutTree::cut(int leaf) {
  only_worst_ = false;
  return cut_chosen(leaf, choose(leaf));
}

/// @return whether there is a plane.
bool CutTree::cut_chosen(int leaf, const std::optional<Plane>& plane) {
  if (plane) {
    cut_by(leaf, *plane);
  } else {
    nodes_[leaf].stuck = true;
  }
  return plane.has_value();
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
  if (!std::isfinite(chooser_.score(node, plane, 0))) return false;
  cut(leaf, plane);
  return true;
}

void CutTree::cut(int leaf, const Plane& plane) {
  only_worst_ = false;
  cut_by(leaf, plane);
}

void CutTree::cut_by(int leaf, const Plane& plane) {
  const Piece piece = std::move(nodes_[leaf].piece);
  CutScratch& s = cut_scratch();
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
  // Where both halves are as far as the whole was, it might go on in twice as
  // many pieces each time.
  const Node& whole = nodes_[leaf];
  if (whole.lower < 0 || whole.upper < 0) return;
  const double far = kNearer * whole.concavity.worst;
  const bool stale =
      std::min(nodes_[whole.lower].concavity.worst, nodes_[whole.upper].concavity.worst) > far;
  for (const int half : {whole.lower, whole.upper}) {
    nodes_[half].stale_cuts = whole.stale_cuts + (stale ? 1 : 0);
    nodes_[half].stuck = nodes_[half].stale_cuts >= kMostStaleCuts;
  }
}

Side CutTree::side_of(int node, const Plane& plane) const {
  // Slivers left by an earlier cut along the plane are no reason for another
  // one.
  const double least = CutChooser::kThinnest * shift_;
  bool below = false, above = false;
  for (const Vec3& p : nodes_[node].hull) {
    const double height = plane.height(p);
    below = below || height < -least;
    above = above || height > least;
  }
  if (below && above) return Side::Both;
  return above ? Side::Upper : Side::Lower;
}

/// Of what is in the nodes, along n.
std::pair<double, double> CutTree::extent_of(const std::vector<int>& nodes, const Vec3& n) const {
  std::pair<double, double> out{std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
  for (const int node : nodes) {
    const auto [low, high] = extent(nodes_[node].hull, n);
    out = {std::min(out.first, low), std::max(out.second, high)};
  }
  return out;
}

/// The larger distance of the two hulls that a plane leaves of the nodes;
/// infinite where there are not two, or from `limit` on.
double CutTree::worst_half(const std::vector<int>& nodes, const Plane& plane, double limit) const {
  CutScratch& s = cut_scratch();
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
    if (side == Side::Both &&
        append_sides(nodes_[node].piece, plane, solid_, shift_, s.lower, s.upper))
      continue;
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
}

std::optional<CutTree::Split> CutTree::find_split(const std::vector<int>& nodes,
                                                  const Vec3& direction, double limit) const {
  const SearchOptions& options = chooser_.options();
  std::vector<Vec3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (direction.norm() > 0) directions.insert(directions.begin(), direction.normalized());
  std::vector<Split> list;
  for (const Vec3& n : directions) {
    const auto [low, high] = extent_of(nodes, n);
    for (int i = 1; i <= options.offsets; ++i)
      list.push_back({{n, low + (high - low) * i / (options.offsets + 1)}});
  }
  const auto evaluate = [&](std::vector<Split>& splits) {
    parallel_for(std::size_t{0}, splits.size(), [&](std::size_t i) {
      splits[i].worst = worst_half(nodes, splits[i].plane, limit);
    });
  };
  const auto better = [](const Split& a, const Split& b) { return a.worst < b.worst; };
  evaluate(list);
  Split best = *std::min_element(list.begin(), list.end(), better);
  if (!(best.worst < limit)) return std::nullopt;
  const auto [low, high] = extent_of(nodes, best.plane.n);
  double step = 0.5 * (high - low) / (options.offsets + 1);
  for (int r = 0; r < kMoreRefinements + options.refinements; ++r, step *= 0.5) {
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

/// The plane for the worst leaf: the known one where all was done so far as when it was chosen.
std::optional<Plane> CutTree::choose_for_worst(int leaf) {
  if (!only_worst_) return choose(leaf);
  if (chosen_ == choices_.size()) {
    const std::uint64_t before = solid_.work().done();
    const std::optional<Plane> plane = choose(leaf);
    choices_.push_back({plane, solid_.work().done() - before});
  } else {
    solid_.work().add(choices_[chosen_].work);
  }
  return choices_[chosen_++].plane;
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
    if (cut_chosen(worst, choose_for_worst(worst))) return true;
  }
}

}  // namespace kaboum::bcd
