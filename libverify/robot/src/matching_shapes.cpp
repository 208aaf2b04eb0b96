// Which shapes of a result are to hold which of the original's, and what follows where they do not.
#include <kaboum/verify/matching_shapes.h>
#include <kaboum/verify/motion_alike.h>

#include <algorithm>

namespace kaboum::verify {

using robot::Geometry;

std::vector<MatchedShapes> match_shapes(const std::vector<Geometry>& original,
                                        const std::vector<Geometry>& result) {
  std::vector<MatchedShapes> out;
  std::vector<char> seen(original.size(), 0);
  for (std::size_t i = 0; i < original.size(); ++i) {
    if (seen[i] != 0) continue;
    const Geometry& g = original[i];
    MatchedShapes match;
    if (g.shape != Geometry::Shape::Mesh) match.originals.push_back(i);
    for (std::size_t k = i; k < original.size() && g.shape == Geometry::Shape::Mesh; ++k) {
      if (!same_frame(g, original[k])) continue;
      seen[k] = 1;
      match.originals.push_back(k);
    }
    for (std::size_t k = 0; k < result.size(); ++k)
      if (same_frame(g, result[k])) match.there.push_back(k);
    match.elsewhere = result.size() - match.there.size();
    out.push_back(std::move(match));
  }
  return out;
}

Answer find_again(const Geometry& shape, const MatchedShapes& match) {
  if (!match.there.empty()) return Answer::Verified;
  return match.elsewhere == 0 && !robot::is_flat(shape) ? Answer::Refuted : Answer::Undecided;
}

Answer beside_others(Answer held, const MatchedShapes& match) {
  return held == Answer::Refuted && match.elsewhere > 0 ? Answer::Undecided : held;
}

std::size_t count_strangers(const std::vector<Geometry>& original,
                            const std::vector<Geometry>& result) {
  return static_cast<std::size_t>(
      std::count_if(result.begin(), result.end(), [&](const Geometry& h) {
        return std::none_of(original.begin(), original.end(),
                            [&](const Geometry& g) { return same_frame(g, h); });
      }));
}

ScaledBound scaled_bound(const Length& epsilon, double diagonal, const geom::Vec3& scale) {
  if (epsilon.percent) return {epsilon.of(diagonal), false};
  return {epsilon.in("m").value / scale.maxCoeff(), scale.minCoeff() < scale.maxCoeff()};
}

Answer answer_of(const HeldDistance& distance, const ScaledBound& bound) {
  if (!distance.claim) return Answer::Undecided;
  const Answer answer = distance.claim->answer;
  return answer == Answer::Refuted && bound.uneven ? Answer::Undecided : answer;
}

}  // namespace kaboum::verify
