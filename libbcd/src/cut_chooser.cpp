// Which plane a piece is cut by. docs/algorithms/convex-decomposition.md,
// "Search".

#include "cut_chooser.h"

#include <kaboum/base/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "principal_box.h"
#include "symmetry.h"

namespace kaboum::bcd {
namespace {

/// Plates are thinner than this share of their diagonal, or than their
/// distance; the score of cuts across them is multiplied, so that they come
/// last.
constexpr double kPlate = 1e-6, kPlatePenalty = 1e6;
/// A half that is so many times as bad as the whole needs no look at the other
/// one.
constexpr double kHopelessScore = 2;
/// So many cuts are scored at once, each no further than the best one of those before: a fixed
/// number, so that the work is the same on any number of threads.
constexpr std::size_t kAtOnce = 8;
/// A score of which nothing is known. Limits are widened by what rounding may lose in a score.
constexpr double kUnscored = std::numeric_limits<double>::infinity(), kRoundedUp = 1 + 0x1p-40;
/// A cut is given up where this share of what it leaves of the hull's facets is too much.
constexpr double kUncut = 0.9;
/// Cuts into halves of a volume have a score lower by the first share; in full
/// where the smaller one has one part of the second number.
constexpr double kBalanced = 0.6, kFullyBalanced = 4;
/// Normals that differ by less are the same when a cut is put into a face.
/// [rad]
constexpr double kSnapAngle = 0.01;
/// Principal axes as near to a coordinate axis, by the cosine, are none of
/// their own.
constexpr double kOwnAxis = 0.99;
/// A piece is itself symmetric where the solid's mirror is its middle, to this
/// share of its width.
constexpr double kOwnMirror = 0.01;
/// The field's slope below which a pit has no direction.
constexpr double kLeastSlope = 0.1;

}  // namespace

void CutChooser::prepare() {
  if (std::exchange(prepared_, true)) return;
  reflex_.find(solid_);
  if (options_.mirrors) mirrors_ = mirror_planes(solid_);
}

double CutChooser::score(const CutNode& node, const Plane& plane, double limit) const {
  const auto [low, high] = extent(node.hull, plane.n);
  const double thinnest = std::min(plane.d - low, high - plane.d);
  // Pieces as thin as their overlap are no smaller.
  if (thinnest < kThinnest * shift_) return std::numeric_limits<double>::infinity();
  // Plates are split into thinner ones only where nothing else helps: these
  // reach as far but for the thickness.
  Box3 box;
  for (const Vec3& p : node.hull) box.extend(p);
  const bool plate = thinnest < kPlate * box.diagonal() ||
                     high - low < node.concavity.worst / node.concavity.weight;
  const double penalty = plate ? kPlatePenalty : 1;
  CutScratch& s = cut_scratch();
  s.lower.clear();
  s.upper.clear();
  if (!append_sides(node.piece, plane, solid_, shift_, s.lower, s.upper))
    return std::numeric_limits<double>::infinity();
  const double most = kRoundedUp * limit / penalty;
  // ∫ d⁴ of a half that is too much by itself, whatever the other one is.
  const double too_much = most / (1 - kBalanced - options_.halving_bonus);
  const Concavity lower = estimate_fourth(
      s.lower, solid_, s.builder, [&](double) { return too_much; }, options_.density);
  if (lower.fourth > std::min(too_much, kHopelessScore * node.concavity.fourth))
    return penalty * lower.fourth;
  const auto preferred = [&](double upper) {
    return preference(std::min(lower.volume, upper), lower.volume + upper);
  };
  const Concavity upper = estimate_fourth(
      s.upper, solid_, s.builder,
      [&](double volume) { return most / preferred(volume) - lower.fourth; }, options_.density);
  return penalty * (lower.fourth + upper.fourth) * preferred(upper.volume);
}

double CutChooser::preference(double smaller, double volume) const {
  // Where no single cut helps, slicing off a little always seems to: cuts in
  // the middle are preferred up to a factor, for they bring the next cuts
  // nearer.
  const double balance = volume > 0 ? smaller / volume : 0;
  return 1 - kBalanced * std::min(1.0, kFullyBalanced * balance) -
         2 * options_.halving_bonus * balance;
}

double CutChooser::look_ahead(const CutNode& node, const Plane& plane) const {
  std::array<Piece, 2> parts;
  {
    CutScratch& s = cut_scratch();
    classify(node.piece, plane, solid_, shift_, s.height, s.side);
    for (const bool lower : {true, false})
      parts[lower ? 0 : 1] = clip(node.piece, plane, lower, shift_, solid_, s.height, s.side);
  }
  double sum = 0, volume = 0, least = std::numeric_limits<double>::infinity();
  for (Piece& part : parts) {
    if (part.empty()) return std::numeric_limits<double>::infinity();
    const CutNode child = make_node(std::move(part), solid_);
    double best = child.concavity.fourth;
    if (child.piece.polygons() > 0)
      for (const Candidate& c : candidates(child))
        best = std::min(best, score(child, c.plane, best));
    sum += best;
    volume += child.concavity.volume;
    least = std::min(least, child.concavity.volume);
  }
  return sum * preference(least, volume);
}

Plane CutChooser::snapped(const CutNode& node, const Plane& plane) const {
  Plane best = plane;
  const auto [low, high] = extent(node.hull, plane.n);
  double nearest = std::min(solid_.spacing(), 0.5 * (high - low) / (options_.offsets + 1));
  for (const std::uint32_t r : reflex_.crossing(node)) {
    const Plane& other = reflex_[r];
    const double sign = other.n.dot(plane.n) < 0 ? -1 : 1;
    if ((other.n - sign * plane.n).norm() > kSnapAngle) continue;
    const auto [lowest, highest] = extent(node.hull, other.n);
    if (std::min(other.d - lowest, highest - other.d) < kThinnest * shift_) continue;
    double apart = 0;
    for (const Vec3& p : node.hull)
      apart = std::max(apart, std::abs(other.height(p) - sign * plane.height(p)));
    if (apart >= nearest) continue;
    nearest = apart;
    best = other;
  }
  return best;
}

std::vector<CutChooser::Candidate> CutChooser::candidates(const CutNode& node) const {
  std::vector<Candidate> out;
  std::vector<Vec3> directions{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (const auto principal = principal_box(node.hull))
    for (int k = 0; k < 3; ++k)
      if (principal->axes.col(k).cwiseAbs().maxCoeff() < kOwnAxis)
        directions.emplace_back(principal->axes.col(k));
  for (const Vec3& n : directions) {
    const auto [low, high] = extent(node.hull, n);
    for (int i = 1; i <= options_.offsets; ++i)
      out.push_back({{n, low + (high - low) * i / (options_.offsets + 1)}});
  }
  // A part that is itself symmetric may best be cut into mirror images.
  for (const Plane& plane : mirrors_) {
    const auto [low, high] = extent(node.hull, plane.n);
    if (std::abs(0.5 * (low + high) - plane.d) < kOwnMirror * (high - low)) out.push_back({plane});
  }
  add_pit_planes(node, out);
  if (options_.reflex_planes > 0) {
    const std::vector<std::uint32_t> order = reflex_.crossing(node);
    for (std::size_t i = 0;
         i < order.size() && i < static_cast<std::size_t>(options_.reflex_planes); ++i)
      out.push_back({reflex_[order[i]]});
  }
  return out;
}

/// Planes that separate, or run through, the pit below the worst point.
void CutChooser::add_pit_planes(const CutNode& node, std::vector<Candidate>& out) const {
  const Vec3& x = node.concavity.at;
  const double step = solid_.spacing();
  Vec3 g;
  for (int k = 0; k < 3; ++k)
    g[k] = solid_.field(x + step * Vec3::Unit(k)) - solid_.field(x - step * Vec3::Unit(k));
  if (g.norm() > kLeastSlope * step) {
    g.normalize();
    const Vec3 y = x - node.concavity.worst / node.concavity.weight * g;
    out.push_back({{g, g.dot(y)}});
    const Vec3 u = g.unitOrthogonal(), w = g.cross(u);
    for (int k = 0; k < 4; ++k) {
      const double angle = 0.25 * M_PI * k;
      const Vec3 n = std::cos(angle) * u + std::sin(angle) * w;
      out.push_back({{n, n.dot(y)}});
    }
  }
}

CutChooser::Candidate CutChooser::best_in_two(const CutNode& node,
                                              std::vector<Candidate> list) const {
  std::stable_sort(list.begin(), list.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  list.resize(std::min(list.size(), static_cast<std::size_t>(options_.look_ahead)));
  std::vector<double> deep(list.size());
  parallel_for(std::size_t{0}, list.size(),
               [&](std::size_t i) { deep[i] = look_ahead(node, list[i].plane); });
  return list[static_cast<std::size_t>(std::min_element(deep.begin(), deep.end()) - deep.begin())];
}

double CutChooser::uncut(const CutNode& node, const std::vector<FacetShare>& facets,
                         const Plane& plane) {
  double sum = 0;
  for (const FacetShare& facet : facets) {
    const auto& [a, b, c] = facet.corners;
    const double x = plane.height(node.hull[a]), y = plane.height(node.hull[b]),
                 z = plane.height(node.hull[c]);
    if ((x <= 0 && y <= 0 && z <= 0) || (x >= 0 && y >= 0 && z >= 0)) sum += facet.fourth;
  }
  return sum;
}

/// Those first that leave least of the hull's facets, and of these the last ones, which faces of
/// the solid suggest: they are the best more often than not.
void CutChooser::evaluate(const CutNode& node, const std::vector<FacetShare>& facets,
                          std::vector<Candidate>& list, double limit) const {
  // Those that are looked into further have to be told apart.
  const bool all = options_.look_ahead > 1;
  struct Bound {
    double least;
    std::size_t index;
  };
  std::vector<Bound> order(list.size());
  const double share = kUncut * (1 - kBalanced - options_.halving_bonus);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t index = list.size() - 1 - i;
    order[i] = {share * uncut(node, facets, list[index].plane), index};
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const Bound& a, const Bound& b) { return a.least < b.least; });
  for (std::size_t begin = 0; begin < order.size() && (all || order[begin].least <= limit);) {
    const std::size_t end = all ? order.size() : std::min(order.size(), begin + kAtOnce);
    parallel_for(begin, end, [&](std::size_t i) {
      Candidate& c = list[order[i].index];
      c.score = score(node, c.plane, all ? kUnscored : limit);
    });
    for (; begin < end; ++begin) limit = std::min(limit, list[order[begin].index].score);
  }
}

std::optional<Plane> CutChooser::choose(const CutNode& node) const {
  std::vector<Candidate> list = candidates(node);
  const std::vector<FacetShare> facets = facet_shares(node.hull, solid_, cut_scratch().builder);
  evaluate(node, facets, list, kUnscored);
  const auto best_of = [](const std::vector<Candidate>& l) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < l.size(); ++i)
      if (l[i].score < l[best].score) best = i;
    return l[best];
  };
  if (list.empty()) return std::nullopt;
  Candidate best = best_of(list);
  if (!std::isfinite(best.score)) return std::nullopt;
  if (options_.look_ahead > 1) best = best_in_two(node, std::move(list));
  const auto [low, high] = extent(node.hull, best.plane.n);
  double step = 0.5 * (high - low) / (options_.offsets + 1);
  for (int r = 0; r < options_.refinements; ++r, step *= 0.5) {
    std::vector<Candidate> near;
    for (const double s : {-step, step})
      if (best.plane.d + s > low && best.plane.d + s < high)
        near.push_back({{best.plane.n, best.plane.d + s}});
    if (near.empty()) continue;
    evaluate(node, facets, near, best.score);
    const Candidate c = best_of(near);
    if (c.score < best.score) best = c;
  }
  return snapped(node, best.plane);
}

}  // namespace kaboum::bcd
