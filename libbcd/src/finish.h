#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "excess.h"
#include "search_state.h"
#include "simplify.h"

namespace kaboum::bcd {

/// A body as it is written: its hull with float32 coordinates, and the bracket of its distance.
struct Finished {
  Body body;
  Mesh hull;
  Excess excess;
  bool thickened = false;
};

/// Largest upper bound of any of them; 0 for none. [length]
double largest_excess(const std::vector<Finished>& bodies);
/// Whether there are bodies, and nothing more is asked for than `epsilon`.
bool are_within(const std::vector<Finished>& bodies, double epsilon);
std::size_t vertices_of(const std::vector<Finished>& bodies);
/// Whether the limits of bodies and vertices hold.
bool fits(const std::vector<Finished>& bodies, const CoverOptions& options);

/// Turns unions of pieces into the bodies that are written: simplified, rounded outwards so that
/// they contain what their pieces hold of the solid, thickened, and measured.
class Finisher {
 public:
  explicit Finisher(SearchState& state);

  /// Takes the bodies' hulls. @param decisive  where given, it is told of every body whether it
  /// goes farther; else only the largest excess is exact. [length]
  std::vector<Finished> finish(std::vector<Body>& bodies, double free_cost, double decisive = 0);

  /// Measures bodies anew that were only told to be no farther than another one, where that one is
  /// gone: the largest excess is exact again.
  void measure_largest(std::vector<Finished>& bodies) const;

  /// As few vertices as epsilon allows each body, by bisection of their number.
  void simplify_hulls(std::vector<Finished>& bodies, double epsilon);

 private:
  /// Of a round of finishing, by body that is still open.
  struct Round {
    std::vector<Mesh> hulls;
    std::vector<char> thickened;
  };
  [[nodiscard]] ExcessOptions excess_options(std::size_t bodies) const;
  void find_required(const std::vector<Finished>& bodies, const std::vector<std::size_t>& which);
  std::vector<std::size_t> recall(std::vector<Finished>& bodies, double free_cost, double decisive);
  void keep(const std::vector<Finished>& bodies, const std::vector<std::size_t>& which,
            double decisive);
  bool thicken(Mesh& hull) const;
  [[nodiscard]] std::vector<Vec3> required_of(const Body& body) const;
  [[nodiscard]] Mesh rounded(const Body& body, const Simplified& shape, std::size_t most) const;
  Round make_hulls(const std::vector<Finished>& bodies, const std::vector<std::size_t>& open,
                   std::vector<Simplified>& shapes, double free_cost, bool first) const;

  SearchState& state_;
  double point_error_ = 0;                     // of computed points, per coordinate [length]
  std::map<int, std::vector<Vec3>> required_;  // points that a leaf's body contains, by leaf
  // Bodies finished with known_for_ and found near enough, by the nodes that they are made of.
  std::map<std::vector<int>, Finished> known_;
  std::array<double, 2> known_for_{};  // free cost, and what is decisive [length]
};

}  // namespace kaboum::bcd
