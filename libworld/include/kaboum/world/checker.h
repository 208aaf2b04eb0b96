#pragma once

#include <kaboum/collide/penetration.h>
#include <kaboum/sweep/motion.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>

namespace kaboum::world {

namespace detail {
class LinkPoses;

/// Items that an item before them may collide with.
struct PairRow {
  std::size_t item = 0;
  std::vector<std::uint64_t> others;  ///< bit j % 64 of word j / 64
};
}  // namespace detail

/// Two things whose bounding sets meet, or are not farther apart than their margin.
struct Contact {
  std::array<Item, 2> items;
  collide::BodyPair bodies;  ///< of their outer sets
  /// True if the solids certainly collide: inner sets meet, or the outer ones are exact (ε = 0, no
  /// margin) and do. Else they are at most `epsilon` apart.
  bool certain = false;
  /// Sum of both ε, errors of places and the margin included. [length]
  double epsilon = 0;
  double margin = 0;          ///< that the two are to be kept from each other [length]
  Vec3 place = Vec3::Zero();  ///< a point of it, rounded, in the world [length]
  /// True if a substitute found it (Checker): only the items are known.
  bool substituted = false;
  /// How deep the sets are in each other, where Checker::measure_depth was asked. `upper` bounds
  /// the depth of the solids, too.
  std::optional<collide::Penetration> depth = {};
};

/// Memory of one thread: places of bodies, and what separated pairs last time. It changes how long
/// answers take, not what they are.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(Scratch&&) noexcept;
  Scratch& operator=(Scratch&&) noexcept;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

 private:
  friend class Checker;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Is told what a checker is asked, by who measures that.
class Observer {
 public:
  Observer() = default;
  virtual ~Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  /// Called by find_contact, find_contacts, is_free and are_apart.
  virtual void asked(const WorldState& state) = 0;
  /// Called by check_motion; by find_obstacles too, with the things that it looks at.
  virtual void asked(const WorldState& state, std::size_t robot,
                     const std::vector<std::vector<double>>& path,
                     const std::vector<Item>* things) = 0;
};

/// Decides in a checker's place which things collide: a collision library of others
/// (kaboum::engines). Nothing that is so decided is certified. Threads may share it.
class Substitute {
 public:
  Substitute() = default;
  virtual ~Substitute() = default;
  Substitute(const Substitute&) = delete;
  Substitute& operator=(const Substitute&) = delete;
  /// Numbers of those of the pairs that collide, ascending: of all, or at most of one.
  /// @pre the state fits the world, and no item of the pairs is absent.
  [[nodiscard]] virtual std::vector<std::size_t> find_meeting(
      const WorldState& state, const std::vector<std::array<Item, 2>>& pairs, bool all) = 0;
  /// Motions are looked at at instants: in between no point of what moves goes farther than this,
  /// which proves nothing of the time between. > 0 [length]
  [[nodiscard]] virtual double step() const = 0;
};

/// Collision of all that is in a world, by the bounded predicates of libcollide
/// (docs/algorithms/bounded-predicates.md). Looked at are robots' links against objects, other
/// robots and themselves, except allowed pairs and contacts, and carried objects like links. Pairs
/// of objects that rest are looked at on request. Const throughout: threads may share it.
class Checker {
 public:
  /// Refers to the world, which must not change (its margins neither), and to the observer, if
  /// there is one: threads may share the checker as far as they may share that.
  /// @param substitute  decides contacts of states and motions instead, and nothing is certified of
  ///   them: "free" is what it says, at the instants that it is asked about. Distances, depths,
  ///   places and regions stay those of the bounding sets. May be null.
  /// @throws Error{InvalidArgument} for a substitute where margins are to be kept: it knows none.
  explicit Checker(const World& world, Observer* observer = nullptr,
                   Substitute* substitute = nullptr);

  struct Options {
    bool resting = false;  ///< pairs of objects that rest, too
    /// Called by find_nearest before each pair; what it throws ends the work.
    std::function<void()> progress = {};
  };

  /// The first pair in contact; nullopt: free, for certain.
  /// @throws Error{InvalidArgument} for states that do not fit the world, values that are not
  ///   finite, poses that are no rotations.
  [[nodiscard]] std::optional<Contact> find_contact(const WorldState& state, Scratch& scratch,
                                                    const Options& options) const;
  [[nodiscard]] std::optional<Contact> find_contact(const WorldState& state,
                                                    Scratch& scratch) const {
    return find_contact(state, scratch, Options{});
  }

  /// True if find_contact finds nothing; what is in contact is not looked into.
  /// @throws as find_contact
  [[nodiscard]] bool is_free(const WorldState& state, Scratch& scratch,
                             const Options& options) const;
  [[nodiscard]] bool is_free(const WorldState& state, Scratch& scratch) const {
    return is_free(state, scratch, Options{});
  }

  /// True if none of some pairs is in contact, as find_contacts decides each of them: for who knows
  /// of the others. A substitute is not asked. @pre no item of the pairs is absent
  /// @throws as find_contact
  [[nodiscard]] bool are_apart(const WorldState& state, std::span<const std::array<Item, 2>> pairs,
                               Scratch& scratch) const;

  /// All pairs in contact.
  [[nodiscard]] std::vector<Contact> find_contacts(const WorldState& state, Scratch& scratch,
                                                   const Options& options) const;

  /// Measures how deep the items of a contact are in each other in a state.
  /// @throws as find_contact
  void measure_depth(Contact& contact, const WorldState& state, Scratch& scratch) const;

  /// Certified bracket of the smallest signed distance of the pairs that are looked at, and that
  /// pair: of pairs whose sets meet it is the penetration depth, negated (Definition 1 of
  /// [gaschler2016]). Places are not those of the deepest point then.
  struct Nearest {
    std::array<Item, 2> items;
    collide::Clearance clearance;
  };
  [[nodiscard]] std::optional<Nearest> find_nearest(const WorldState& state, Scratch& scratch,
                                                    const Options& options) const;

  /// An item where it is in a state.
  struct PosedItem {
    Item item;
    collide::PosedSet place;
  };
  /// Places of all items.
  /// @throws as find_contact
  [[nodiscard]] std::vector<PosedItem> places(const WorldState& state) const {
    Scratch scratch;
    return places(state, items_, scratch);
  }
  /// Places of some, in their order. @pre none of them is absent.
  [[nodiscard]] std::vector<PosedItem> places(const WorldState& state,
                                              const std::vector<Item>& items,
                                              Scratch& scratch) const;

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] Observer* observer() const { return observer_; }
  [[nodiscard]] Substitute* substitute() const { return substitute_; }

  /// The pairs that are looked at in states with these attachments, in their order.
  [[nodiscard]] std::vector<std::array<Item, 2>> pairs(const WorldState& state,
                                                       const Options& options) const;
  /// True if a value for each variable of a robot is within its limits: pairs of links proved never
  /// to touch are not looked at there, and are elsewhere.
  [[nodiscard]] bool is_within_limits(std::size_t robot, const std::vector<double>& q) const;
  /// Vertices of the hull of a robot's shape or an object, in its frame.
  [[nodiscard]] const std::vector<Vec3>& hull_of(const Item& item) const { return hulls_.at(item); }
  /// Reach of a robot's shape.
  [[nodiscard]] const sweep::Reach& reach_of(std::size_t robot, std::size_t shape) const {
    return reaches_[robot][shape];
  }

 private:
  void place(const WorldState& state, Scratch& scratch) const;
  void start(Scratch::Impl& s) const;
  /// @param next  number of the robot's first item. @return one past its last one.
  std::size_t place_robot(const WorldState& state, std::size_t robot, std::size_t next,
                          Scratch::Impl& s) const;
  void place_object(const WorldState& state, std::size_t object, std::size_t item,
                    Scratch::Impl& s) const;
  double error_of_held(const WorldState& state, std::size_t object, std::size_t item,
                       Scratch::Impl& s) const;
  /// True if error_ holds for these values of a robot's variables.
  [[nodiscard]] bool is_usual(std::size_t robot, const std::vector<double>& q) const;

  /// Calls pair(i, j) for the numbers of items of pairs that are looked at until it is true; not
  /// for those whose bit in look(i), as in PairRow, is 0. All where that is null.
  template <typename Look, typename Pair>
  void visit(const WorldState& state, const Options& options, const Look& look,
             const Pair& pair) const;

  /// The bodies of a pair of placed items that meet, by the numbers of the items.
  [[nodiscard]] std::optional<collide::BodyPair> find_bodies(std::size_t i, std::size_t j,
                                                             double margin, Scratch::Impl& s) const;
  [[nodiscard]] double margin_of(const WorldState& state, std::size_t i, std::size_t j) const;

  /// Calls found(i, j, bodies, margin) for the pairs in contact until it is true.
  template <typename Found>
  void visit_meeting(const WorldState& state, Scratch& scratch, const Options& options,
                     const Found& found) const;
  /// Calls found(contact) for the pairs in contact until it is true.
  template <typename Found>
  void visit_contacts(const WorldState& state, Scratch& scratch, const Options& options,
                      const Found& found) const;

  /// What the substitute finds. @param all  else at most one
  [[nodiscard]] std::vector<Contact> substituted(const WorldState& state, const Options& options,
                                                 bool all) const;

  const World* world_;
  Observer* observer_;
  Substitute* substitute_;
  std::shared_ptr<const char> identity_ = std::make_shared<char>();  ///< of this and its copies
  std::vector<Item> items_;
  std::map<Item, std::vector<Vec3>> hulls_;
  std::vector<double> radius_;                      ///< of items_
  std::vector<std::vector<sweep::Reach>> reaches_;  ///< of the robots' shapes
  /// Places in items_ of pairs that may collide: with a robot's shape first, of two objects.
  std::vector<detail::PairRow> robot_rows_, object_rows_;
  /// Those of one robot that may collide beyond its limits only.
  std::vector<detail::PairRow> rows_within_limits_;
  std::vector<std::vector<double>> error_;  ///< of robots' shapes, for values from low_ to high_
  std::vector<std::vector<double>> low_, high_;
  std::vector<std::shared_ptr<const detail::LinkPoses>> kinematics_;  ///< of the robots
  std::vector<double> defects_;  ///< of their links' matrices, see defect_of
  double largest_margin_ = 0;    ///< of all pairs, rounded up [length]
};

/// Meaning of a contact, and its place.
/// @param margin  that the two are to be kept from each other
Contact contact_of(const World& world, const Item& a, const Item& b, const collide::PosedSet& at_a,
                   const collide::PosedSet& at_b, const collide::BodyPair& bodies, double margin);
/// What a substitute found of a pair.
Contact substituted_contact(const std::array<Item, 2>& pair);

}  // namespace kaboum::world
