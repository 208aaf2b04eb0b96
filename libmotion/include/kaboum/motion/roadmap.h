#pragma once

#include <kaboum/motion/path_finder.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::motion {

struct RoadmapOptions {
  std::uint64_t seed = 1;
  std::size_t nodes = 1000;     ///< free configurations; fewer where few that are drawn are free
  std::size_t neighbours = 12;  ///< that each one is joined to, at most, besides those it is one of
  world::MotionOptions check = {};
};

/// Free configurations of a robot in one state of a scene, joined by straight motions that are free
/// at every instant: made once, for many queries. It is of use where much is in the way, as a query
/// then joins its ends to what is known. Const throughout: threads may share it.
class Roadmap {
 public:
  /// Draws configurations, and decides the motions between neighbours by several threads. The same
  /// on any number of threads and with any instruction set.
  /// @throws Error{InvalidArgument} for no nodes or neighbours; as filter::BatchChecker::decide
  Roadmap(const PathFinder& finder, const RoadmapOptions& options);

  /// As PathFinder::find, which is asked where the roadmap leads nowhere, or constraints are to be
  /// kept. What is returned has been decided as it is: nothing of the roadmap is trusted.
  /// @throws Error{InvalidArgument} as find_path; for a finder of another robot, or of a scene or a
  ///   state that is not that of the roadmap.
  [[nodiscard]] PathAnswer find(const PathFinder& finder, const std::vector<double>& start,
                                std::span<const std::vector<double>> goals,
                                const PathOptions& options) const;

  [[nodiscard]] std::size_t nodes() const;
  [[nodiscard]] std::size_t edges() const { return edges_.size(); }

  /// JSON, with an identity of the scene and its state (docs/formats.md).
  [[nodiscard]] std::string to_json() const;
  /// A roadmap as to_json writes it.
  /// @throws Error{InvalidInput} naming the member, for what is none, and for one of another scene,
  ///   state or robot than the finder's.
  static Roadmap from_json(std::string_view text, const std::string& name,
                           const PathFinder& finder);

 private:
  struct Edge {
    std::uint32_t a = 0, b = 0;
  };

  Roadmap() = default;
  void arrange();

  std::string scene_;  ///< its identity
  std::size_t variables_ = 0;
  std::vector<double> values_;  ///< of the nodes, one after the other
  std::vector<Edge> edges_;     ///< ascending
  /// Edges of each node: its neighbours are others_[first_[node]] to others_[first_[node + 1]].
  std::vector<std::uint32_t> first_, others_;
};

/// Identity of all that a checker's answers about a robot depend on, in a state, but for the
/// robot's own values: a hash.
std::string identity_of(const world::Checker& checker, const world::WorldState& state,
                        std::size_t robot);

}  // namespace kaboum::motion
