#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/pairs/relation.h>
#include <kaboum/robot/robot.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Pairs of a robot's links, decided by exact meshes over all values of the joints between them.
/// docs/algorithms/pairs.md has the proofs.
namespace kaboum::pairs {

/// A link's shapes as meshes, in its frame. The solid of a mesh is all of its triangles, and what
/// those of a closed one wind about; of a guess, all that its triangles shut off. Nothing else is
/// asked of a mesh.
struct LinkSurface {
  std::uint32_t link = 0;
  geom::Mesh outer;  ///< holds the shapes: that pairs never touch is proved of it
  /// Lies in them: contacts are shown by it. None: the outer one does. Empty: no contact is shown.
  std::optional<geom::Mesh> inner;
  /// Why the outer mesh may lack something of the shapes: "a plane was not read". No pair of the
  /// link is "never" then, however far its meshes are apart; the outer mesh may be empty.
  std::string unsure = {};
  /// Why it is not certain which solid the outer mesh means: "the surface crosses itself". Its
  /// surface is among the mesh's triangles, so it is no more than they shut off from what is far
  /// away. That is what "never" is proved of.
  std::string guess = {};
};

struct DecideOptions {
  std::size_t most_boxes = 300'000;  ///< of joint values that are looked at for one pair
  std::size_t samples = 300;         ///< places at which contacts of a pair are looked for at first
  /// Whether links a and b, a < b, are a pair to decide. None: all are.
  std::function<bool(std::uint32_t a, std::uint32_t b)> wanted = {};
  /// After so long nothing more is proved. [s]
  double most_seconds = 60;
  std::function<bool()> stop = {};  ///< often called; true: nothing more is proved. May throw
  /// Often called, by several threads: how many pairs are decided, of how many. May throw.
  std::function<void(std::size_t decided, std::size_t all)> progress = {};
};

/// A lower and an upper bound. [length]
struct Bracket {
  double lower = 0, upper = std::numeric_limits<double>::infinity();
};

enum class Verdict {
  Never,     ///< proved: in no configuration within the limits
  Always,    ///< proved: in all of them
  CanTouch,  ///< a configuration shows it
  Open,      ///< none of that was found
};
/// "never", "always", "can touch", "open".
const char* name_of(Verdict verdict);

/// What is known of two links' parts that are farther than a distance from a point of the joint
/// between them. The point rests on both.
struct AwayFromJoint {
  double beyond = 0;  ///< [length]
  Verdict verdict = Verdict::Open;
  Bracket nearest;
  std::vector<double> q;  ///< as DecidedPair
};

struct DecidedPair {
  std::uint32_t a = 0, b = 0;  ///< links, a < b
  Relation relation = Relation::Moving;
  bool adjacent = false;  ///< one joint connects them, fixed or not
  Verdict verdict = Verdict::Open;
  /// Of the smallest distance within the limits; 0 where they touch.
  Bracket nearest;
  /// The configuration that shows a contact, or in which they were found nearest; a value per
  /// variable of the robot, all others 0 or the nearest that their limits have.
  std::vector<double> q;
  /// Of the penetration in that configuration, where they touch: no translation of one by less than
  /// `lower` parts the two; one by `upper` does.
  Bracket depth{0, 0};
  std::size_t boxes = 0;              ///< that were looked at
  std::optional<AwayFromJoint> away;  ///< of adjacent links that touch
  std::string why = {};  ///< of an open pair, where it could not be decided: what is not known
  /// Open as the time or the boxes were used up; more of them may decide it.
  bool unfinished = false;
};

/// Whether contacts of a pair say nothing: fixed joints connect the links, or one joint does, and
/// they never touch away from it. Of a joint that slides there is no such place.
bool is_connected(const DecidedPair& pair);

/// All pairs, of those that are wanted, of links that have a surface or are unsure, ordered by a,
/// then b. The same for any number of threads, unless the time is up.
/// @throws Error{InvalidArgument} for a link with two surfaces, or that the robot does not have.
std::vector<DecidedPair> decide_pairs(const robot::Robot& robot,
                                      const std::vector<LinkSurface>& surfaces,
                                      const DecideOptions& options);

/// The same in one configuration instead of all that the limits have: those that never touch are
/// apart there, those that always do or can touch there. What is at a joint is as in decide_pairs.
/// @param q  a value per variable, within the limits or not
/// @throws Error{InvalidArgument} for another number of values, and as decide_pairs
std::vector<DecidedPair> decide_pairs_at(const robot::Robot& robot, const std::vector<double>& q,
                                         const std::vector<LinkSurface>& surfaces,
                                         const DecideOptions& options);

/// "0.5,-1.2,0": the shortest texts that read back as the same numbers.
std::string text_of(const std::vector<double>& q);

}  // namespace kaboum::pairs
