#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "cut_node.h"
#include "reflex_planes.h"

namespace kaboum::bcd {

struct SearchOptions {
  int offsets = 7;  ///< per direction
  int reflex_planes = 10;
  int refinements = 2;       ///< halvings of the best plane's offset
  bool mirrors = true;       ///< try the solid's planes of symmetry
  Density density = kDense;  ///< of the samples that cuts are scored by
  /// Of this many of the best cuts, the one is taken after which the next cuts
  /// bring most; ≤ 1: the best by itself.
  int look_ahead = 1;
  /// Bonus of a cut that halves a piece's volume, as a share of its score: for
  /// a given number of bodies, it makes them more alike. By an error bound,
  /// where slices are needed that only faces of the solid give, it has led to
  /// hundreds of bodies too many.
  double halving_bonus = 0;
};

/// Chooses planes to cut pieces by: of those that the solid and the piece
/// suggest, the one after which both hulls are nearest to the solid.
class CutChooser {
 public:
  /// @param shift  half the overlap of neighbouring pieces. [length]
  CutChooser(const SolidField& solid, const SearchOptions& options, double shift)
      : solid_(solid), options_(options), shift_(shift) {}

  /// Pieces thinner than so many times `shift` are no smaller.
  static constexpr double kThinnest = 8;

  /// Finds the planes that the solid itself suggests, once.
  void prepare();
  /// Nothing where no plane makes the piece better. @pre prepared
  [[nodiscard]] std::optional<Plane> choose(const CutNode& node) const;
  /// ∫ d⁴ of both halves' hulls, lower for cuts that are preferred; infinite
  /// for none.
  /// @param limit  above it, any larger number is given.
  [[nodiscard]] double score(const CutNode& node, const Plane& plane,
                             double limit = std::numeric_limits<double>::infinity()) const;
  /// ∫ d⁴ of the facets of a node's hull that a plane does not cut: they are facets of the halves'
  /// hulls, but for coplanar ones and how densely they are sampled.
  [[nodiscard]] static double uncut(const CutNode& node, const std::vector<FacetShare>& facets,
                                    const Plane& plane);
  [[nodiscard]] const SearchOptions& options() const { return options_; }

 private:
  struct Candidate {
    Plane plane;
    double score = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] std::vector<Candidate> candidates(const CutNode& node) const;
  void add_pit_planes(const CutNode& node, std::vector<Candidate>& out) const;
  /// A reflex edge's plane nearly the same, if there is one: scores, which the
  /// grid's spacing makes rough, do not tell a cut along a face from one just
  /// beside it.
  [[nodiscard]] Plane snapped(const CutNode& node, const Plane& plane) const;
  /// The score after the best cut of each half besides.
  [[nodiscard]] double look_ahead(const CutNode& node, const Plane& plane) const;
  /// Factor ≤ 1 of a cut's score, given the smaller half's volume and both.
  [[nodiscard]] double preference(double smaller, double volume) const;
  /// @param facets  of the node's hull
  /// @param limit  as of score
  void evaluate(const CutNode& node, const std::vector<FacetShare>& facets,
                std::vector<Candidate>& list, double limit) const;
  /// The best by `look_ahead` among the few that are best by themselves.
  [[nodiscard]] Candidate best_in_two(const CutNode& node, std::vector<Candidate> list) const;

  const SolidField& solid_;
  SearchOptions options_;
  double shift_;
  bool prepared_ = false;
  std::vector<Plane> mirrors_;
  ReflexPlanes reflex_;
};

}  // namespace kaboum::bcd
