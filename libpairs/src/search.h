#pragma once

#include <kaboum/pairs/decide.h>

#include <cstdint>
#include <memory>
#include <queue>
#include <vector>

#include "contact.h"

namespace kaboum::pairs::detail {

/// The shapes of one link, ready to be asked.
struct Shapes {
  std::unique_ptr<Surface> outer, inner_or_none;
  bool shows = true;   ///< false: nothing is known to lie in the shapes, so no contact is shown
  bool loose = false;  ///< outer is much more than inner: it does not tell where links meet
  [[nodiscard]] const Surface& inner() const { return inner_or_none ? *inner_or_none : *outer; }
};

/// What two links do over all values of the joints between them: contacts are looked for; boxes of
/// values are halved, that of the least lower bound first, until the links are proved apart in all.
class Search {
 public:
  Search(const robot::Robot& robot, std::uint32_t a, std::uint32_t b, const Shapes& of_a,
         const Shapes& of_b, std::size_t samples);

  /// Whether the whole box of the limits is enough for a proof.
  void begin(const std::function<bool()>& stop);
  /// Looks at some more places all over the limits, and goes on to others from those where the
  /// links are near. Each time at as many as before; from the second time on with exact distances.
  void look_for_contacts(const std::function<bool()>& stop);
  /// Goes on with the proof for so many boxes, or until so many pairs of clusters were looked at.
  void go_on(std::size_t boxes, std::size_t work, const std::function<bool()>& stop);
  /// Of a contact that was shown: looks for deeper ones, and whether the links meet everywhere.
  void look_deeper(const std::function<bool()>& stop);
  /// The surfaces are apart everywhere by more than a distance, which others have proved.
  void take_apart(double distance, const std::function<bool()>& stop);

  /// Nothing more comes of it.
  [[nodiscard]] bool decided() const {
    return verdict_ != Verdict::Open || (exhausted_ && searched_);
  }
  /// The surfaces are proved apart, but one link may be in what the other one shuts off.
  [[nodiscard]] bool shut_off() const { return shut_off_; }
  [[nodiscard]] std::size_t boxes() const { return looked_; }
  [[nodiscard]] Verdict verdict() const { return verdict_; }
  [[nodiscard]] Bracket nearest() const;
  [[nodiscard]] Bracket depth() const { return depth_; }
  /// Of the best configuration, a value per variable of the chain.
  [[nodiscard]] const std::vector<double>& values() const { return best_values_; }
  [[nodiscard]] const Chain& chain() const { return chain_; }
  /// Distance from a point on the joint's axis, the only joint's of the chain, beyond which nothing
  /// was found to meet in the middle of the limits; and the point in both frames.
  struct Joint {
    double beyond;
    Vec3 in_a, in_b;
  };
  [[nodiscard]] std::optional<Joint> joint() const;

 private:
  /// Clusters of both that are not proved apart in a box.
  struct Item {
    std::uint32_t a, b;
    Vec3 direction;
  };
  using Items = std::vector<Item>;
  struct Box {
    double lower;
    std::uint64_t order;
    std::vector<double> middle, half;
    std::shared_ptr<const Items> items;
    std::size_t widest;  ///< the variable to halve
    bool operator<(const Box& o) const {
      return lower != o.lower ? lower > o.lower : order > o.order;
    }
  };

  /// Looks at a box. Nothing is left of it, or it waits to be halved.
  void look_at(std::vector<double> middle, std::vector<double> half, const Items& items);
  std::size_t widest(const BoxMotion& motion, const Item& worst) const;
  /// Where the search for contacts pulls the links: a point that b carries, and where it shall be.
  struct Pull {
    Vec3 from, to;    ///< in the frame of a
    double distance;  ///< what shall become less
    bool apart;       ///< the hulls are; else the distance is that of their middles
  };
  /// A point of a and one of b, each in its link's frame.
  struct Target {
    Vec3 in_a, in_b;
  };
  [[nodiscard]] Pull pull(const std::vector<double>& values, const Target* target);
  /// Values at which the point is nearer to where it shall be: a step of damped least squares
  /// (Levenberg, Marquardt), within the limits.
  [[nodiscard]] std::vector<double> stepped(const std::vector<double>& values, const Pull& pull,
                                            double damping);
  /// Steps until a contact is shown or no more comes of it, by hulls, or towards one target.
  /// @return whether one is shown
  bool approach(std::vector<double> values, const Target* target);
  /// Points of triangles, the i-th ones.
  [[nodiscard]] Target target(std::size_t i) const;
  /// Values spread over the limits; the first ones are in their middle.
  [[nodiscard]] std::vector<double> sample(std::size_t i, const Chain::Limits& limits) const;
  /// Takes values that show a contact, if these do.
  bool shows(const std::vector<double>& values, std::size_t most_steps);
  /// Looks at more samples. @return those that show no contact, the nearest ones first
  std::vector<std::vector<double>> look_at_samples(const std::function<bool()>& stop);
  /// Goes from values to others in which the links are nearer, by exact distances, until they touch
  /// or no more comes of it. @return whether they touch
  bool climb(std::vector<double> values, std::size_t most_steps);
  /// Keeps the values if the links are nearest there so far.
  Contact::Nearest measure(const std::vector<double>& values, std::size_t most_steps);
  /// From values that touch, to such that do so deeply.
  void show_contact(std::vector<double> values);
  /// Whether the links meet in all of the box: deeper than they move.
  bool meet_always(std::vector<double> middle, std::vector<double> half, std::size_t& left,
                   const std::function<bool()>& stop);
  void end_proof();
  /// The nearest values at which contacts may be shown.
  [[nodiscard]] std::vector<double> within_own_limits(std::vector<double> values) const;
  [[nodiscard]] bool stopped() const { return stop_ != nullptr && *stop_ && (*stop_)(); }

  Chain chain_;
  Contact outer_, inner_;
  bool shows_;  ///< inner meshes are there, so that contacts can be shown
  bool loose_;  ///< outer meshes do not tell where the links meet
  bool same_;   ///< the outer meshes are the inner ones
  std::size_t samples_, sampled_ = 0;
  std::size_t rounds_ = 0;  ///< of looking for contacts
  bool always_ = true;      ///< so far all places were contacts
  bool deepened_ = false;   ///< deeper contacts were looked for
  const HullTree *tree_a_, *tree_b_;
  mutable BoxMotion motion_;
  std::vector<double> middle_, half_, still_;  ///< of the limits; no width
  std::priority_queue<Box> open_;
  bool begun_ = false;
  bool exhausted_ = false;  ///< no proof is possible
  bool shut_off_ = false;
  bool searched_ = false;   ///< contacts were looked for
  std::size_t most_items_;  ///< of a box; then clusters are not cut any more
  std::uint64_t order_ = 0;
  std::size_t looked_ = 0, next_climb_ = 64;
  std::size_t work_ = 0;  ///< pairs of clusters that were looked at
  double proved_ = std::numeric_limits<double>::infinity();  ///< least bound of boxes that are done
  double nearest_ = std::numeric_limits<double>::infinity();
  std::vector<double> best_values_, apart_values_;  ///< apart: hulls do not meet, if not empty
  Bracket depth_{0, 0};
  Verdict verdict_ = Verdict::Open;
  const std::function<bool()>* stop_ = nullptr;  ///< of the call that goes on
};

}  // namespace kaboum::pairs::detail
