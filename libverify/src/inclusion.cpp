// Exact inclusion of one solid, or surface, in another: winding numbers beside every cell of the
// offending faces. docs/algorithms/exact-inclusion.md.
#include <kaboum/base/error.h>
#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <mutex>
#include <set>

#include "allowance.h"
#include "arrangement.h"
#include "cell_sample.h"
#include "nearest.h"
#include "parallel.h"
#include "point_in_solid.h"
#include "uncut_values.h"
#include "witness.h"

namespace kaboum::verify {
namespace {

class Decision {
 public:
  Decision(const MeshPair& meshes, const InclusionOptions& options)
      : meshes_(meshes),
        options_(options),
        allowance_(options.max_work.value_or(
            options.surface_only ? std::numeric_limits<double>::infinity()
                                 : usual_work(meshes.count(kInside) + meshes.count(kOutside)))),
        arrangement_(meshes, {options.max_contacts, options.max_pairs}, &allowance_) {}

  /// Closed chains: the solid claim and, for the inner chain's faces, the surface claim.
  void decide_closed() {
    say("pairs of triangles");
    arrangement_.need_mutual();
    for (const int chain : {kInside, kOutside}) {
      say(chain == kInside ? "inner sides of the inner mesh" : "outer sides of the outer mesh");
      const std::vector<std::uint32_t> failing = first_level(chain);
      if (failing.empty()) continue;
      if (chain == kInside) surface(failing);
      say("cells against their own mesh");
      second_level(chain, failing);
    }
  }

  /// The outer mesh is closed, the inner one need not be: the surface claim only.
  void decide_surface() {
    say("pairs of triangles");
    arrangement_.need_mutual();
    surface(first_level(kInside));
  }

  /// The same within what is allowed, triangles that few others cut first.
  void decide_surface_within_allowance() {
    say("pairs of triangles");
    std::vector<std::uint32_t> order = faces_of(kInside);
    const auto at = [&](const CellSample& sample, Side side) {
      return winding(meshes_, sample, side, kOutside);
    };
    std::vector<char> bad(meshes_.count(kInside), 0);
    const auto holds = [&](const CellSample& sample) {
      if (at(sample, kInner) >= 1 || at(sample, kOuter) >= 1) return true;
      report(surface_, bad[sample.face], sample, kOuter);
      return false;
    };
    try {
      arrangement_.need_mutual();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::LimitReached) throw;
      // What sticks out in the middle is known without them.
      allowance_.loop(order.size(), [&](std::size_t i) { holds(middle_sample(order[i])); });
      for (const std::uint32_t f : order)
        if (bad[f - meshes_.begin(kInside)] == 0) left_out_.insert(f);
      return;
    }
    const auto values = [&](Side side) {
      return uncut_values(
          arrangement_, kInside, mask_of(kOutside), side,
          [&](const CellSample& sample) { return at(sample, side); }, samples_, allowance_);
    };
    say("triangles");
    const std::vector<int> inner = values(kInner), outer = values(kOuter);
    settle_or_cut(kInside);
    const Contacts& contacts = arrangement_.contacts(kInside, kOutside);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t f, std::uint32_t g) {
      return contacts.cuts(f).size() < contacts.cuts(g).size();
    });
    decide_each(order, [&](std::uint32_t f) {
      if ((inner[f] != kCut && inner[f] >= 1) || (outer[f] != kCut && outer[f] >= 1)) return;
      // Its middle is in, or beside, one of its cells: most that stick out need no cutting.
      if (holds(middle_sample(f))) visit(f, mask_of(kOutside), decided(f), holds);
    });
  }

  /// Open chains with one border: w_inner ≤ w_outer.
  void decide_difference() {
    say("pairs of triangles");
    arrangement_.need_mutual();
    arrangement_.need_own(kInside);
    arrangement_.need_own(kOutside);
    for (const int chain : {kInside, kOutside}) {
      say("cells");
      const Side side = test_side(chain);
      const auto value = [&](const CellSample& sample) {
        return winding_difference(meshes_, sample, side);
      };
      const std::vector<int> values =
          uncut_values(arrangement_, chain, 3, side, value, samples_, allowance_);
      const std::uint32_t begin = meshes_.begin(chain);
      std::vector<char> bad(values.size(), 0);
      decide_each(faces_of(chain), [&](std::uint32_t f) {
        const std::size_t i = f - begin;
        if (values[i] != kCut) {
          if (values[i] < 0) report(solid_, bad[i], middle_sample(f), side);
          return;
        }
        visit(f, 3, {}, [&](const CellSample& sample) {
          if (value(sample) >= 0) return true;
          report(solid_, bad[i], sample, side);
          return false;
        });
      });
    }
  }

  /// The surface claim for the inner chain's triangles without area: the segments and points that
  /// they are.
  /// @pre the claim was decided for those with area
  void decide_without_area() {
    std::vector<Face> thin = meshes_.repeated(kInside);
    for (std::uint32_t f = meshes_.begin(kInside); f < meshes_.end(kInside); ++f)
      if (meshes_.face(f).axis < 0) thin.push_back(meshes_.face(f));
    if (thin.empty()) return;
    say("triangles without area");
    std::set<std::uint32_t> open = left_out_;  // faces that need not lie in the outer solid
    for (const Offence& offence : surface_.list) open.insert(offence.face);
    const std::vector<char> undone = allowance_.loop(thin.size(), [&](std::size_t i) {
      if (const std::optional<Vec3> at = outside_of(thin[i], open)) {
        const std::lock_guard lock(surface_.mutex);
        thin_.try_emplace(thin[i].source, *at);
      }
    });
    for (std::size_t i = 0; i < undone.size(); ++i) thin_left_out_ += undone[i] != 0 ? 1 : 0;
  }

  /// Turns what was found into answers; claims that nothing refutes keep theirs.
  void conclude(Inclusion& result) {
    conclude(result.solid, solid_, false, result.relative,
             result.relative ? "the inner mesh winds more often about a point than the outer one"
                             : "a part of the inner solid is outside the outer one");
    conclude(result.surface, surface_, true, false,
             "a part of the inner mesh's surface is outside the outer solid");
    result.samples = samples_;
    result.left_out = left_out_.size() + thin_left_out_;
    result.limited = result.limited || result.left_out > 0;
    result.contacts = arrangement_.mutual_cuts();
  }

 private:
  void say(const char* what) const {
    if (options_.progress) options_.progress(what);
  }

  void visit(std::uint32_t f, OperandMask mask, std::span<const std::uint32_t> decided,
             const SampleVisitor& visitor) {
    visit_samples(arrangement_, f, mask, options_.max_pieces, decided,
                  [&](const CellSample& sample) {
                    ++samples_;
                    return visitor(sample);
                  });
  }

  /// body(f) for faces, as far as is allowed; those that are not decided are noted.
  template <class Body>
  void decide_each(const std::vector<std::uint32_t>& faces, const Body& body) {
    const std::vector<char> undone =
        allowance_.loop(faces.size(), [&](std::size_t i) { body(faces[i]); });
    for (std::size_t i = 0; i < undone.size(); ++i)
      if (undone[i] != 0) left_out_.insert(faces[i]);
  }

  [[nodiscard]] std::vector<std::uint32_t> faces_of(int chain) const {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = meshes_.begin(chain); f < meshes_.end(chain); ++f)
      if (meshes_.face(f).axis >= 0) faces.push_back(f);
    return faces;
  }

  /// The side of a chain's faces on which an offending region can lie.
  static Side test_side(int chain) { return chain == kInside ? kInner : kOuter; }
  /// Whether the other chain's winding number alone shows that there is no offence.
  static bool passes(int chain, int other) { return chain == kInside ? other >= 1 : other <= 0; }
  /// Whether the own winding number completes an offence, the other's having failed.
  static bool offends(int chain, int own) { return chain == kInside ? own >= 1 : own <= 0; }

  /// Own winding numbers of a chain on one side of its faces.
  std::vector<int> own_values(int chain, Side side) {
    arrangement_.need_own(chain);
    const auto own = [&](const CellSample& sample) {
      return winding(meshes_, sample, side, chain);
    };
    return uncut_values(arrangement_, chain, mask_of(chain), side, own, samples_, allowance_);
  }

  /// Where faces of both chains lie in one plane, the own winding number of the other chain's face
  /// decides the cell that it covers, which saves cutting along its edges. Worth while only where
  /// there is much of that.
  void prepare_settled(int chain) {
    decided_.clear();
    std::array<std::size_t, 2> coplanar{};  // pairs that are oriented alike, and oppositely
    const std::uint32_t begin = meshes_.begin(chain), end = meshes_.end(chain);
    const Contacts& contacts = arrangement_.contacts(chain, 1 - chain);
    for (std::uint32_t f = begin; f < end; ++f) {
      for (const Contacts::Cut& cut : contacts.cuts(f))
        if (cut.coplanar) ++coplanar[alike(f, cut.by) ? 0 : 1];
    }
    const std::size_t all = coplanar[0] + coplanar[1];
    if (all == 0 || all < options_.settle_from) return;
    const int other = 1 - chain;
    const Side side = test_side(chain);
    decided_.resize(meshes_.count(other), 0);
    for (const int turned : {0, 1}) {
      if (coplanar[turned] == 0) continue;  // nobody would ask for it
      const std::vector<int> values = own_values(other, turned == 0 ? side : -side);
      for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] != kCut && passes(chain, values[i]))
          decided_[i] |= static_cast<std::uint8_t>(turned == 0 ? 1 : 2);
    }
  }

  /// Whether two coplanar faces look the same way.
  [[nodiscard]] bool alike(std::uint32_t f, std::uint32_t g) const {
    const Face &face = meshes_.face(f), &by = meshes_.face(g);
    const bool upward = by.axis == face.axis
                            ? by.upward
                            : orient2d(face.axis, meshes_.corner(g, 0), meshes_.corner(g, 1),
                                       meshes_.corner(g, 2)) == Sign::Positive;
    return upward == face.upward;
  }

  /// The same; where that is too much work, all cells are cut.
  void settle_or_cut(int chain) {
    try {
      prepare_settled(chain);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::LimitReached) throw;
      decided_.clear();
    }
  }

  /// Coplanar faces that decide the cells of f that they cover.
  [[nodiscard]] std::vector<std::uint32_t> decided(std::uint32_t f) const {
    std::vector<std::uint32_t> result;
    if (decided_.empty()) return result;
    const Face& face = meshes_.face(f);
    const int other = 1 - face.chain;
    for (const Contacts::Cut& cut : arrangement_.contacts(face.chain, other).cuts(f)) {
      if (!cut.coplanar) continue;
      const std::uint8_t wanted = alike(f, cut.by) ? 1 : 2;
      if ((decided_[cut.by - meshes_.begin(other)] & wanted) != 0) result.push_back(cut.by);
    }
    return result;
  }

  /// Faces with a cell that the other chain's winding number does not decide.
  std::vector<std::uint32_t> first_level(int chain) {
    const int other = 1 - chain;
    const Side side = test_side(chain);
    const auto value = [&](const CellSample& sample) {
      return winding(meshes_, sample, side, other);
    };
    other_values_ =
        uncut_values(arrangement_, chain, mask_of(other), side, value, samples_, allowance_);
    settle_or_cut(chain);
    const std::uint32_t begin = meshes_.begin(chain);
    std::vector<char> fails(other_values_.size(), 0);
    decide_each(faces_of(chain), [&](std::uint32_t f) {
      const std::size_t i = f - begin;
      if (other_values_[i] != kCut) {
        fails[i] = static_cast<char>(!passes(chain, other_values_[i]));
        return;
      }
      visit(f, mask_of(other), decided(f), [&](const CellSample& sample) {
        fails[i] = static_cast<char>(!passes(chain, value(sample)));
        return fails[i] == 0;
      });
    });
    std::vector<std::uint32_t> failing;
    for (std::uint32_t i = 0; i < fails.size(); ++i) {
      if (fails[i] != 0) failing.push_back(begin + i);
    }
    return failing;
  }

  /// Decides the faces that the first level left open with the own winding number.
  void second_level(int chain, const std::vector<std::uint32_t>& failing) {
    const int other = 1 - chain;
    const Side side = test_side(chain);
    const std::vector<int> values = own_values(chain, side);
    const auto own = [&](const CellSample& sample) {
      return winding(meshes_, sample, side, chain);
    };
    const std::uint32_t begin = meshes_.begin(chain);
    std::vector<char> bad(meshes_.count(chain), 0);
    decide_each(failing, [&](std::uint32_t f) {
      const int own_value = values[f - begin], other_value = other_values_[f - begin];
      // The own number is the same all over the face and harmless.
      if (own_value != kCut && !offends(chain, own_value)) return;
      if (own_value != kCut && other_value != kCut) {
        return report(solid_, bad[f - begin], middle_sample(f), side);
      }
      visit(f, 3, {}, [&](const CellSample& sample) {
        const int o = other_value != kCut ? other_value : winding(meshes_, sample, side, other);
        if (passes(chain, o)) return true;
        if (!offends(chain, own_value != kCut ? own_value : own(sample))) return true;
        report(solid_, bad[f - begin], sample, side);
        return false;
      });
    });
  }

  /// Surface claim for the inner chain's faces whose inner sides are not all within the outer
  /// solid: their outer sides must be.
  void surface(const std::vector<std::uint32_t>& failing) {
    if (failing.empty()) return;
    const auto at = [&](const CellSample& sample, Side side) {
      return winding(meshes_, sample, side, kOutside);
    };
    const std::vector<int> outer_values = uncut_values(
        arrangement_, kInside, mask_of(kOutside), kOuter,
        [&](const CellSample& sample) { return at(sample, kOuter); }, samples_, allowance_);
    std::vector<char> bad(meshes_.count(kInside), 0);
    decide_each(failing, [&](std::uint32_t f) {
      if (outer_values[f] != kCut) {
        if (outer_values[f] < 1) report(surface_, bad[f], middle_sample(f), kOuter);
        return;
      }
      visit(f, mask_of(kOutside), {}, [&](const CellSample& sample) {
        if (at(sample, kInner) >= 1 || at(sample, kOuter) >= 1) return true;
        report(surface_, bad[f], sample, kOuter);
        return false;
      });
    });
  }

  /// A point of a triangle without area that is not in the outer solid. What is an edge, or a
  /// corner, of a face that lies in it does as well.
  [[nodiscard]] std::optional<Vec3> outside_of(const Face& thin,
                                               const std::set<std::uint32_t>& open) const {
    std::array<std::uint32_t, 3> v = thin.v;
    // Along a line this is the order on it.
    std::sort(v.begin(), v.end(), [&](std::uint32_t a, std::uint32_t b) {
      const Vec3 &p = meshes_.point(a), &q = meshes_.point(b);
      return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    });
    const auto is_held = [&](std::uint32_t a, std::uint32_t b) {
      const auto around = meshes_.around_edge(a, b);
      return std::any_of(around.begin(), around.end(), [&](std::uint32_t f) {
        const Face& face = meshes_.face(f);
        return face.chain == kInside && face.axis >= 0 && face.place_of(a) >= 0 &&
               face.place_of(b) >= 0 && !open.contains(f);
      });
    };
    if (is_held(v[0], v[2])) return std::nullopt;
    for (const auto& [a, b] : {std::pair{v[0], v[1]}, {v[1], v[2]}}) {
      if (is_held(a, b) || (a == b && v[0] != v[2])) continue;
      if (auto at = segment_outside(meshes_, kOutside, meshes_.point(a), meshes_.point(b)))
        return at;
    }
    return std::nullopt;
  }

  struct Offences {
    std::mutex mutex;
    std::vector<Offence> list;
  };

  void report(Offences& offences, char& flag, const CellSample& sample, Side side) {
    flag = 1;
    const std::lock_guard lock(offences.mutex);
    offences.list.push_back({sample.face, side, position(meshes_, sample)});
  }

  void conclude(Claim& claim, Offences& offences, bool on_surface, bool relative,
                const char* reason) {
    if (claim.answer != Answer::Verified) return;
    std::sort(offences.list.begin(), offences.list.end(), [&](const Offence& a, const Offence& b) {
      const Face &f = meshes_.face(a.face), &g = meshes_.face(b.face);
      return f.chain != g.chain ? f.chain < g.chain : f.source < g.source;
    });
    for (const Offence& offence : offences.list) {
      const Face& face = meshes_.face(offence.face);
      (face.chain == kInside ? claim.inner_triangles : claim.outer_triangles)
          .push_back(face.source);
    }
    const bool thin = on_surface && !thin_.empty();
    if (thin) {
      for (const auto& [source, at] : thin_) claim.inner_triangles.push_back(source);
      std::sort(claim.inner_triangles.begin(), claim.inner_triangles.end());
    }
    if (offences.list.empty() && !thin) return;
    claim.answer = Answer::Refuted;
    claim.reason = reason;
    say("a witness");
    claim.witness = offences.list.empty()
                        ? thin_witness()
                        : find_witness(meshes_, offences.list, on_surface, relative);
  }

  /// The farthest of what triangles without area have outside.
  [[nodiscard]] Witness thin_witness() const {
    const NearestTriangle nearest(meshes_, kOutside);
    std::optional<Witness> best;
    const auto look_at = [&](const Vec3& p, bool exact) {
      const double depth = nearest.distance(p);
      if (!best || (exact != best->exact ? exact : depth > best->depth))
        best = Witness{p, depth, exact};
    };
    const auto look_at_corners = [&](const Face& face) {
      if (!thin_.contains(face.source)) return;
      for (const std::uint32_t v : face.v)
        if (winding_at(meshes_, kOutside, meshes_.point(v)).value_or(1) <= 0)
          look_at(meshes_.point(v), true);
    };
    for (const Face& face : meshes_.repeated(kInside)) look_at_corners(face);
    for (std::uint32_t f = meshes_.begin(kInside); f < meshes_.end(kInside); ++f)
      if (meshes_.face(f).axis < 0) look_at_corners(meshes_.face(f));
    for (const auto& [source, at] : thin_) look_at(at, false);
    return {meshes_.point_outside(best->point), meshes_.length_outside(best->depth), best->exact};
  }

  const MeshPair& meshes_;
  const InclusionOptions& options_;
  Allowance allowance_;
  Arrangement arrangement_;
  std::set<std::uint32_t> left_out_;  // faces that a limit left undecided
  std::vector<int> other_values_;
  /// Per face of the other chain: bit 0, its own chain decides the side that the faces in question
  /// are tested on, if it is oriented like them; bit 1, if it is oriented the other way.
  std::vector<std::uint8_t> decided_;
  std::atomic<std::size_t> samples_ = 0;
  Offences solid_, surface_;
  /// Triangles without area, by their number, with a point that is not in the outer solid, rounded.
  std::map<std::uint32_t, Vec3> thin_;
  std::size_t thin_left_out_ = 0;
};

}  // namespace

Inclusion verify_inclusion(const geom::Mesh& inner, const geom::Mesh& outer,
                           const InclusionOptions& options) {
  if (options.max_work && !(*options.max_work > 0))
    throw Error(ErrorCode::InvalidArgument, "max_work must be positive");
  const MeshPair meshes(inner, outer);
  Inclusion result;
  result.inner_open_edges = meshes.unbalanced(kInside);
  result.outer_open_edges = meshes.unbalanced(kOutside);
  result.inner_closed = result.inner_open_edges == 0;
  result.outer_closed = result.outer_open_edges == 0;
  result.triangles_without_area = meshes.without_area(kInside) + meshes.without_area(kOutside) +
                                  meshes.repeated(kInside).size() +
                                  meshes.repeated(kOutside).size();
  const bool same_border = meshes.same_border();

  // Claims that have a meaning count as true until they are refuted.
  const auto undefined = [](Claim& claim, const char* why) {
    claim.answer = Answer::Undefined;
    claim.reason = why;
  };
  result.solid.answer = Answer::Verified;
  result.surface.answer = Answer::Verified;
  if (!result.outer_closed) undefined(result.surface, "the outer mesh is not closed");
  if (!result.inner_closed || !result.outer_closed) {
    result.relative = same_border;
    if (!same_border)
      undefined(result.solid, "the meshes are not closed and have different borders");
  }

  // Nothing is no part of anything, and what has no area has no solid.
  if (inner.triangles.empty()) {
    undefined(result.solid, "the inner mesh has no triangles");
    undefined(result.surface, "the inner mesh has no triangles");
    return result;
  }
  const bool has_area = !meshes.tree(kInside).empty();
  if (!has_area) {
    result.relative = false;
    undefined(result.solid, "no triangle of the inner mesh has an area, so that it has no solid");
  }

  if (options.surface_only) {
    result.relative = false;
    undefined(result.solid, "only the surface claim was asked for");
  }

  Decision decision(meshes, options);
  try {
    if (!has_area) {
      // segments and points only
    } else if (options.surface_only) {
      if (result.outer_closed) decision.decide_surface_within_allowance();
    } else if (result.relative) {
      decision.decide_difference();
    } else if (result.inner_closed && result.outer_closed) {
      decision.decide_closed();
    } else if (result.outer_closed) {
      decision.decide_surface();
    }
    if (result.outer_closed) decision.decide_without_area();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::LimitReached) throw;
    result.limited = true;
  }
  decision.conclude(result);
  for (Claim* claim : {&result.solid, &result.surface}) {
    if (!result.limited || claim->answer != Answer::Verified) continue;
    claim->answer = Answer::Undecided;
    claim->reason =
        result.left_out > 0
            ? std::to_string(result.left_out) +
                  " triangles were not decided within the work, and the pieces of one, that are "
                  "allowed"
            : "more contacts between triangles, or pieces of one, than the limits allow";
  }
  return result;
}

const char* name_of(Answer answer) {
  switch (answer) {
    case Answer::Verified:
      return "verified";
    case Answer::Refuted:
      return "refuted";
    case Answer::Undecided:
      return "undecided";
    case Answer::Undefined:
      break;
  }
  return "undefined";
}

}  // namespace kaboum::verify
