// Bodies as they are written: what of them is simplified, rounded outwards, thickened and measured.
// docs/algorithms/convex-decomposition.md, "Fewer vertices" and "Rounding".

#include "finish.h"

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/width.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "concavity.h"
#include "facet_hull.h"
#include "outward.h"
#include "thicken.h"

namespace kaboum::bcd {

double largest_excess(const std::vector<Finished>& bodies) {
  double out = 0;
  for (const Finished& f : bodies) out = std::max(out, f.excess.upper);
  return out;
}

bool are_within(const std::vector<Finished>& bodies, double epsilon) {
  return !bodies.empty() && epsilon < kUnbounded && largest_excess(bodies) <= epsilon;
}

std::size_t vertices_of(const std::vector<Finished>& bodies) {
  std::size_t sum = 0;
  for (const Finished& f : bodies) sum += f.hull.vertices.size();
  return sum;
}

bool fits(const std::vector<Finished>& bodies, const CoverOptions& options) {
  return !bodies.empty() && bodies.size() <= options.max_bodies.value_or(kUnlimited) &&
         vertices_of(bodies) <= options.max_total_vertices.value_or(kUnlimited);
}

Finisher::Finisher(SearchState& state) : state_(state) {
  double magnitude = 0;
  for (const Vec3& p : state.solid().mesh().vertices)
    magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  point_error_ = kPointError * state.options().safety * magnitude;
}

std::vector<Finished> Finisher::finish(std::vector<Body>& bodies, double free_cost,
                                       double decisive) {
  std::vector<Finished> out(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) out[i].body = std::move(bodies[i]);
  std::vector<std::size_t> open = recall(out, free_cost, decisive);
  const std::vector<std::size_t> fresh = open;
  find_required(out, fresh);
  std::vector<Simplified> shapes(bodies.size());
  // Where simplification took too much, no vertex more than needed is left out.
  for (const bool first : {true, false}) {
    Round round = make_hulls(out, open, shapes, free_cost, first);
    ExcessOptions how = excess_options(open.size());
    if (decisive > 0) how.worth_measuring = kWorthMeasuring;
    const std::vector<Excess> measured =
        measure(round.hulls, state_.solid(), how, kMeasuredFloor * decisive,
                decisive > 0 ? decisive : kUnbounded);
    std::vector<std::size_t> failed;
    for (std::size_t i = 0; i < open.size(); ++i) {
      Finished& f = out[open[i]];
      if (f.hull.vertices.empty() || measured[i].upper < f.excess.upper) {
        f.hull = std::move(round.hulls[i]);
        f.excess = measured[i];
        f.thickened = round.thickened[i] != 0;
      }
      if (decisive > 0 && f.excess.upper > decisive &&
          shapes[open[i]].needed.size() > shapes[open[i]].vertices.size())
        failed.push_back(open[i]);
    }
    open = std::move(failed);
    if (open.empty()) break;
  }
  keep(out, fresh, decisive);
  return out;
}

/// Bodies of the same pieces come up again and again while their number is searched for.
/// @return those that are not known to be near enough
std::vector<std::size_t> Finisher::recall(std::vector<Finished>& bodies, double free_cost,
                                          double decisive) {
  const std::array<double, 2> asked{free_cost, decisive};
  if (decisive > 0 && known_for_ != asked) {
    known_.clear();
    known_for_ = asked;
  }
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto at = decisive > 0 ? known_.find(bodies[i].body.leaves) : known_.end();
    if (at == known_.end()) {
      open.push_back(i);
      continue;
    }
    bodies[i].hull = at->second.hull;
    bodies[i].excess = at->second.excess;
    bodies[i].thickened = at->second.thickened;
  }
  return open;
}

void Finisher::keep(const std::vector<Finished>& bodies, const std::vector<std::size_t>& which,
                    double decisive) {
  if (!(decisive > 0)) return;
  for (const std::size_t i : which) {
    const Finished& f = bodies[i];
    if (f.excess.upper <= decisive)
      known_.emplace(f.body.leaves, Finished{{}, f.hull, f.excess, f.thickened});
  }
}

void Finisher::measure_largest(std::vector<Finished>& bodies) const {
  const ExcessOptions how = excess_options(bodies.size());
  double known = 0;
  for (const Finished& f : bodies) known = std::max(known, f.excess.lower);
  known = (1 + how.relative_gap) * known + how.absolute_gap;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].excess.upper > known) open.push_back(i);
  if (open.empty()) return;
  std::vector<Mesh> hulls;
  hulls.reserve(open.size());
  for (const std::size_t i : open) hulls.push_back(bodies[i].hull);
  const std::vector<Excess> measured = measure(hulls, state_.solid(), how, known);
  for (std::size_t i = 0; i < open.size(); ++i)
    if (measured[i].upper < bodies[open[i]].excess.upper) bodies[open[i]].excess = measured[i];
}

/// @param first  whether shapes are simplified now; else those that have been are left as they were
/// with the vertices allowed.
Finisher::Round Finisher::make_hulls(const std::vector<Finished>& bodies,
                                     const std::vector<std::size_t>& open,
                                     std::vector<Simplified>& shapes, double free_cost,
                                     bool first) const {
  const CoverOptions& options = state_.options();
  Round round{std::vector<Mesh>(open.size()), std::vector<char>(open.size(), 0)};
  parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
    const Body& body = bodies[open[i]].body;
    Simplified& shape = shapes[open[i]];
    if (options.max_facets) {
      round.hulls[i] =
          facet_hull(required_of(body), *options.max_facets, options.max_vertices,
                     options.effort == Effort::Fast ? PlaneSteps::Turning : PlaneSteps::Exchange);
    } else if (first) {
      if (!body.concavity.flat)
        shape = simplify(body.hull, options.max_vertices, free_cost / body.concavity.weight,
                         state_.solid());
      round.hulls[i] = rounded(body, shape, options.max_vertices);
    } else {
      round.hulls[i] = rounded(body, {shape.needed, 0, {}}, options.max_vertices);
    }
    if (options.min_thickness > 0 || options.max_aspect)
      round.thickened[i] = thicken(round.hulls[i]) ? 1 : 0;
  });
  return round;
}

void Finisher::simplify_hulls(std::vector<Finished>& bodies, double epsilon) {
  struct Open {
    std::size_t body, low;
  };
  std::vector<std::size_t> all(bodies.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  find_required(bodies, all);  // leaves may have been cut since the bodies were finished
  std::vector<Open> open;
  for (std::size_t i = 0; i < bodies.size(); ++i) open.push_back({i, kTooFewVertices});
  for (;;) {
    if (state_.spent(kFinishing)) return;
    std::erase_if(open,
                  [&](const Open& o) { return bodies[o.body].hull.vertices.size() <= o.low + 1; });
    if (open.empty()) return;
    ExcessOptions how = excess_options(open.size());
    how.cutoff = std::max(epsilon, largest_excess(bodies));
    std::vector<Mesh> hulls(open.size());
    parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
      const Finished& f = bodies[open[i].body];
      const std::size_t most = (open[i].low + f.hull.vertices.size()) / 2;
      hulls[i] = rounded(f.body, simplify(f.body.hull, most, 0, state_.solid()), most);
    });
    const std::vector<Excess> measured =
        measure(hulls, state_.solid(), how, kMeasuredFloor * epsilon, epsilon);
    for (std::size_t i = 0; i < open.size(); ++i) {
      Finished& f = bodies[open[i].body];
      const std::size_t tried = (open[i].low + f.hull.vertices.size()) / 2;
      if (hulls[i].vertices.size() <= tried &&
          measured[i].upper <= std::max(epsilon, f.excess.upper)) {
        f.hull = std::move(hulls[i]);
        f.excess = measured[i];
      } else {
        open[i].low = tried;
      }
    }
  }
}

/// How bodies are measured: in fewer parts each where the work left is little, and all together in
/// no more than what is kept for the end allows, but some.
ExcessOptions Finisher::excess_options(std::size_t bodies) const {
  const Work& work = state_.solid().work();
  const double each =
      static_cast<double>(kWorkPerPart) * static_cast<double>(std::max<std::size_t>(1, bodies));
  const double kept = (1 - kFinishing) * work.most();
  const double fewest = std::clamp(kept / each, kFewestParts, kEnoughParts);
  ExcessOptions out;
  out.absolute_gap = kMeasuredGap * state_.solid().diagonal();
  const double left = work.most() - static_cast<double>(work.done());
  const double share = left / each;
  if (share < static_cast<double>(out.max_parts))
    out.max_parts = static_cast<std::size_t>(std::max(fewest, share));
  // Parts that take longer than usual are fewer.
  out.work = kWorkPerPart * out.max_parts;
  return out;
}

/// The points that a leaf's body has to contain, each leaf's once.
void Finisher::find_required(const std::vector<Finished>& bodies,
                             const std::vector<std::size_t>& which) {
  const CutTree& tree = state_.tree();
  std::vector<int> open;
  for (const std::size_t i : which)
    for (const int leaf : leaves_of(tree, bodies[i].body))
      if (required_.try_emplace(leaf).second) open.push_back(leaf);
  std::vector<std::vector<Vec3>*> place;
  place.reserve(open.size());
  for (const int leaf : open) place.push_back(&required_.at(leaf));
  parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
    *place[i] = outer_points(tree.nodes()[open[i]].piece, point_error_);
  });
}

/// Makes a body as thick as asked for, which its length may ask for, too. @return whether it was
/// not.
bool Finisher::thicken(Mesh& hull) const {
  // Each round adds to the length at most a few times what it adds to the width.
  constexpr int kRounds = 40;
  constexpr double kBeyond = 1.05;
  const CoverOptions& options = state_.options();
  const auto wanted = [&] {
    const double of_length =
        options.max_aspect ? geom::longest_upper(hull.vertices) / *options.max_aspect : 0;
    return std::max(options.min_thickness, of_length);
  };
  bool thin = false;
  for (int round = 0; round < kRounds; ++round) {
    const double least = wanted();
    if (geom::least_width(hull, least).lower >= least) return thin;
    thin = true;
    const double thickness = options.max_aspect ? std::max(options.min_thickness, kBeyond * least)
                                                : options.min_thickness;
    hull = bcd::thicken(std::move(hull), thickness, options.max_vertices, state_.solid());
  }
  ensure(geom::least_width(hull, wanted()).lower >= wanted(), "a body stayed too thin");
  return thin;
}

/// The points that a body has to contain, without those inside their hull.
std::vector<Vec3> Finisher::required_of(const Body& body) const {
  std::vector<Vec3> required;
  for (const int leaf : leaves_of(state_.tree(), body)) {
    const auto& points = required_.at(leaf);
    required.insert(required.end(), points.begin(), points.end());
  }
  ensure(!required.empty(), "a body that has to contain nothing");
  geom::HullBuilder builder;
  if (!builder.build(required)) return required;
  std::vector<Vec3> hull;
  for (const std::uint32_t v : builder.vertices()) hull.push_back(required[v]);
  return hull;
}

/// A body's simplified hull rounded outwards.
Mesh Finisher::rounded(const Body& body, const Simplified& shape, std::size_t most) const {
  const std::vector<Vec3> required = required_of(body);
  geom::HullBuilder builder;
  std::optional<Mesh> pushed;
  if (!body.concavity.flat) {
    pushed = push_out(shape.vertices, required, most);
    if (!pushed && shape.needed.size() > shape.vertices.size())
      pushed = push_out(shape.needed, required, most);
  }
  if (!pushed) return enclose(body.hull, required, most);
  if (body.hull.size() <= most) return *std::move(pushed);
  // Few vertices for what is long and thin: contractions leave it skew, or with edges like knives.
  std::optional<Mesh> prism = prism_round(required, most);
  if (!prism) return *std::move(pushed);
  const double far = estimate_concavity(pushed->vertices, state_.solid(), builder).worst;
  const bool nearer =
      estimate_concavity(prism->vertices, state_.solid(), builder, true, far).worst < far;
  return nearer ? *std::move(prism) : *std::move(pushed);
}

}  // namespace kaboum::bcd
