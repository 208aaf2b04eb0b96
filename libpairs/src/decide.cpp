// All pairs of a robot's links, each searched in rounds until it is decided.

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/pairs/decide.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <mutex>

#include "numbers.h"
#include "search.h"
#include "swept.h"

namespace kaboum::pairs {
namespace {

using detail::kInfinite;
using detail::Search;
using detail::Shapes;
using detail::Surface;
using geom::Vec3;

/// Pairs of clusters that are looked at of one pair's parts away from their joint, and of each pair
/// in the first round of boxes.
constexpr std::size_t kAwayWork = 200'000, kFirstWork = 4'000;
constexpr std::size_t kWorkOfUnsure = 4 * kFirstWork;  ///< after which nothing more is sought
constexpr std::size_t kManyJoints = 3;
constexpr std::size_t kCoarseNodes = 50'000, kMostNodes = 3'000'000;  ///< of what links sweep

Shapes shapes_of(const LinkSurface& of) {
  Shapes out;
  if (of.outer.empty()) return out;
  using Solid = Surface::Solid;
  out.outer = std::make_unique<Surface>(of.outer, of.guess.empty() ? Solid::Wound : Solid::ShutOff);
  out.shows = !of.inner || !of.inner->empty();
  if (of.inner && out.shows) out.inner_or_none = std::make_unique<Surface>(*of.inner);
  out.loose = !of.guess.empty() && out.inner_or_none != nullptr;
  return out;
}

/// The same but for triangles whose corners are all within a distance from a point; no outer
/// surface: none is left.
Shapes away_from(const Shapes& shapes, const Vec3& point, double distance) {
  const auto cut = [&](const Surface& whole) {
    const bool reaches = std::ranges::any_of(whole.corners(), [&](std::uint32_t v) {
      return (whole.mesh().vertices[v] - point).norm() > distance;
    });
    return reaches ? std::make_unique<Surface>(whole, point, distance) : nullptr;
  };
  Shapes out;
  out.outer = cut(*shapes.outer);
  out.shows = shapes.shows;
  if (!shapes.inner_or_none) return out;
  out.inner_or_none = cut(*shapes.inner_or_none);
  out.shows = out.inner_or_none != nullptr;
  return out;
}

/// What is said of either surface, with its link's name. Empty: nothing is.
std::string said_of(const robot::Robot& robot, std::string LinkSurface::*what, const LinkSurface& a,
                    const LinkSurface& b) {
  std::string out;
  for (const LinkSurface* s : {&a, &b}) {
    if ((s->*what).empty()) continue;
    if (!out.empty()) out += "; ";
    out += "link '" + robot.links[s->link].name + "': " + s->*what;
  }
  return out;
}

/// What is proved of meshes that may lack something is not proved of the shapes.
template <typename Found>
void doubt(Found& found) {
  if (found.verdict == Verdict::Never) found.verdict = Verdict::Open;
  found.nearest.lower = 0;
}

/// A value per variable of the robot.
std::vector<double> configuration(const robot::Robot& robot, const Search& search) {
  std::vector<double> q;
  for (const robot::Variable& variable : robot.variables) {
    double value = 0;
    if (variable.lower) value = std::max(value, *variable.lower);
    if (variable.upper) value = std::min(value, *variable.upper);
    q.push_back(value);
  }
  const std::vector<std::uint32_t>& variables = search.chain().variables();
  for (std::size_t v = 0; v < variables.size() && v < search.values().size(); ++v)
    q[variables[v]] = search.values()[v];
  return q;
}

/// The parts of adjacent links that are not at their joint.
struct PartsAway {
  double beyond = 0;
  Shapes a, b;
  std::unique_ptr<Search> own;
  Search* search = nullptr;  ///< own, or that of the links; null: nothing is left of one of them

  [[nodiscard]] AwayFromJoint found(const robot::Robot& robot) const {
    if (search == nullptr) return {beyond, Verdict::Never, {}, {}};
    return {beyond, search->verdict(), search->nearest(), configuration(robot, *search)};
  }
};

/// @param whole  what is sought of all of the links; all of them is away, if nothing meets where
///   the joint is in its middle
/// @param joint  of the two
std::unique_ptr<PartsAway> look_away(const robot::Robot& robot,
                                     std::pair<std::uint32_t, std::uint32_t> links, const Shapes& a,
                                     const Shapes& b, Search& whole,
                                     const std::optional<Search::Joint>& joint,
                                     const DecideOptions& options,
                                     const std::function<bool()>& stop) {
  if (!joint || stop()) return nullptr;
  auto out = std::make_unique<PartsAway>();
  const double cut = joint->beyond * 1.05;
  out->beyond = cut * (1 + 0x1p-30);  // for the rounding of the point
  if (cut > 0) {
    out->a = away_from(a, joint->in_a, cut);
    out->b = away_from(b, joint->in_b, cut);
    if (!out->a.outer || !out->b.outer) return out;
    out->own =
        std::make_unique<Search>(robot, links.first, links.second, out->a, out->b, options.samples);
    out->own->begin(stop);
  }
  out->search = cut > 0 ? out->own.get() : &whole;
  for (int i = 0; i < 3; ++i) out->search->look_for_contacts(stop);
  out->search->go_on(std::min<std::size_t>(options.most_boxes, 20'000), kAwayWork, stop);
  out->search->look_deeper(stop);
  return out;
}

/// Those that have something, by link.
/// @throws Error{InvalidArgument} when a link is not the robot's, or has two.
std::vector<const LinkSurface*> in_order(const robot::Robot& robot,
                                         const std::vector<LinkSurface>& given) {
  std::vector<const LinkSurface*> surfaces;
  for (const LinkSurface& surface : given) {
    if (surface.link >= robot.links.size())
      throw Error(ErrorCode::InvalidArgument, "a surface of a link that the robot does not have");
    if (!surface.outer.empty() || !surface.unsure.empty()) surfaces.push_back(&surface);
  }
  std::ranges::sort(surfaces, {}, [](const LinkSurface* s) { return s->link; });
  for (std::size_t i = 1; i < surfaces.size(); ++i)
    if (surfaces[i - 1]->link == surfaces[i]->link)
      throw Error(ErrorCode::InvalidArgument,
                  "two surfaces of link '" + robot.links[surfaces[i]->link].name + "'");
  return surfaces;
}

/// Two surfaces, and what is sought of them.
struct Sought {
  std::size_t a, b;
  std::unique_ptr<Search> search;
  std::unique_ptr<PartsAway> away;
  double apart = 0;  ///< a lower bound of the distance in all configurations [length]
};

DecidedPair found_of(const robot::Robot& robot, const Shaped& shaped, const LinkSurface& a,
                     const LinkSurface& b, Sought found) {
  DecidedPair pair;
  pair.a = a.link;
  pair.b = b.link;
  pair.relation = relation_of(robot, shaped, pair.a, pair.b);
  pair.adjacent = are_adjacent(robot, shaped, pair.a, pair.b);
  // Why nothing can be proved of what the pair has.
  const std::string unsure = said_of(robot, &LinkSurface::unsure, a, b);
  if (found.search == nullptr) {
    pair.why = unsure;
    return pair;
  }
  pair.verdict = found.search->verdict();
  pair.nearest = found.search->nearest();
  pair.depth = found.search->depth();
  pair.boxes = found.search->boxes();
  pair.unfinished = pair.verdict == Verdict::Open && !found.search->decided();
  pair.q = configuration(robot, *found.search);
  if (pair.verdict != Verdict::Never && found.away) pair.away = found.away->found(robot);
  if (pair.verdict == Verdict::Open && found.search->shut_off())
    pair.why = said_of(robot, &LinkSurface::guess, a, b);
  if (unsure.empty()) return pair;
  doubt(pair);
  if (pair.away) doubt(*pair.away);
  pair.depth.upper = pair.depth.lower > 0 ? kInfinite : 0;
  if (pair.verdict == Verdict::Open) pair.why = unsure;
  pair.unfinished = false;
  return pair;
}

/// A robot whose limits are one configuration.
robot::Robot standing(robot::Robot robot, const std::vector<double>& q) {
  if (q.size() != robot.variables.size())
    throw Error(ErrorCode::InvalidArgument, std::to_string(robot.variables.size()) +
                                                " values are expected, not " +
                                                std::to_string(q.size()));
  for (std::size_t v = 0; v < q.size(); ++v)
    robot.variables[v].lower = robot.variables[v].upper = q[v];
  for (robot::Joint& joint : robot.joints) joint.lower = joint.upper = std::nullopt;
  return robot;
}

/// All pairs of some surfaces' links, those that are not decided yet in rounds.
class Pairs {
 public:
  /// @param robot  whose limits have all configurations that are meant
  /// @param whole  the same robot, whose limits say where links meet at a joint
  Pairs(robot::Robot robot, const robot::Robot& whole, const std::vector<LinkSurface>& given,
        const DecideOptions& options)
      : robot_(std::move(robot)),
        whole_(whole),
        options_(options),
        surfaces_(in_order(robot_, given)) {
    shapes_.resize(surfaces_.size());
    std::vector<char> used(surfaces_.size(), 0);
    for (std::size_t a = 0; a < surfaces_.size(); ++a)
      for (std::size_t b = a + 1; b < surfaces_.size(); ++b) {
        if (options.wanted && !options.wanted(surfaces_[a]->link, surfaces_[b]->link)) continue;
        used[a] = used[b] = 1;
        pairs_.push_back({a, b, nullptr, nullptr, 0});
      }
    parallel_for(std::size_t{0}, surfaces_.size(),
                 [&](std::size_t i) {
                   if (used[i] != 0) shapes_[i] = shapes_of(*surfaces_[i]);
                 },
                 {.alone = true});
    shaped_.assign(robot_.links.size(), 0);
    for (std::size_t l = 0; l < shaped_.size(); ++l)
      shaped_[l] = robot_.links[l].collision.empty() ? 0 : 1;
    for (const LinkSurface* s : surfaces_) shaped_[s->link] = 1;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      if (shapes_[pairs_[i].a].outer && shapes_[pairs_[i].b].outer) left_.push_back(i);
  }

  std::vector<DecidedPair> decide() {
    const std::function<bool()> stop = [&] { return stopped(); };
    round([&](Sought& pair) {
      pair.search =
          std::make_unique<Search>(robot_, surfaces_[pair.a]->link, surfaces_[pair.b]->link,
                                   shapes_[pair.a], shapes_[pair.b], options_.samples);
      pair.search->begin(stop);
    });
    look_for_contacts(stop);
    sweep(kCoarseNodes, stop);
    // Before pairs that are hard take all of the time.
    look_away_from_joints(stop);
    // More and more of each, so that what is easy is decided before the time is up.
    std::size_t nodes = kCoarseNodes;
    for (std::size_t work = kFirstWork; !(left_.empty() && away_.empty()) && !stop(); work *= 2) {
      if (work > kFirstWork) look_for_contacts(stop);
      if (nodes < kMostNodes) sweep(nodes *= 4, stop);
      round([&](Sought& pair) {
        const std::size_t looked = pair.search->boxes() / 2;
        if (looked < options_.most_boxes && !unsure(pair))
          pair.search->go_on(options_.most_boxes - looked, work, stop);
      });
      // Of links that may lack something contacts are all that can be found.
      std::erase_if(left_, [&](std::size_t i) {
        const Sought& pair = pairs_[i];
        return pair.search->boxes() / 2 >= options_.most_boxes ||
               (unsure(pair) && work >= kWorkOfUnsure);
      });
      go_on_away(work, stop);
      // How deep comes when what is easy is decided.
      look_deeper(stop);
    }
    look_deeper(stop);
    return found();
  }

 private:
  [[nodiscard]] bool stopped() const {
    if (options_.progress) options_.progress(decided_, pairs_.size());
    if (options_.stop && options_.stop()) return true;
    const std::chrono::duration<double> passed = Clock::now() - begin_;
    return passed.count() > options_.most_seconds;
  }
  [[nodiscard]] bool unsure(const Sought& pair) const {
    return !surfaces_[pair.a]->unsure.empty() || !surfaces_[pair.b]->unsure.empty();
  }
  /// Does something to each pair that is left; those that are decided then are left no more.
  void round(const std::function<void(Sought&)>& work) {
    parallel_for(std::size_t{0}, left_.size(),
                 [&](std::size_t i) {
                   Sought& pair = pairs_[left_[i]];
                   work(pair);
                   if (pair.search->decided()) ++decided_;
                 },
                 {.alone = true});
    std::erase_if(left_, [&](std::size_t i) { return pairs_[i].search->decided(); });
  }
  void look_for_contacts(const std::function<bool()>& stop) {
    round([&](Sought& pair) { pair.search->look_for_contacts(stop); });
  }
  void look_deeper(const std::function<bool()>& stop) {
    parallel_for(std::size_t{0}, pairs_.size(),
                 [&](std::size_t i) {
                   if (pairs_[i].search != nullptr) pairs_[i].search->look_deeper(stop);
                 },
                 {.alone = true});
  }
  void sweep(std::size_t most_nodes, const std::function<bool()>& stop) {
    std::vector<std::uint32_t> links;
    std::vector<const Surface*> outer;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      links.push_back(surfaces_[i]->link);
      outer.push_back(surfaces_[i]->unsure.empty() ? shapes_[i].outer.get() : nullptr);
    }
    std::vector<std::size_t> open;
    std::vector<detail::PairOfSurfaces> sides;
    for (const std::size_t i : left_) {
      // Of few joints boxes prove more than finer grids.
      const bool few = pairs_[i].search->chain().joints().size() < kManyJoints;
      if (unsure(pairs_[i]) || (few && most_nodes > kCoarseNodes)) continue;
      open.push_back(i);
      sides.emplace_back(pairs_[i].a, pairs_[i].b);
    }
    const std::vector<double> apart =
        detail::apart_by_sweeping(robot_, links, outer, sides, most_nodes, stop);
    for (std::size_t i = 0; i < open.size(); ++i) pairs_[open[i]].apart = apart[i];
    round([&](Sought& pair) { pair.search->take_apart(pair.apart, stop); });
  }
  void look_away_from_joints(const std::function<bool()>& stop) {
    parallel_for(
        std::size_t{0}, pairs_.size(),
        [&](std::size_t i) {
          Sought& pair = pairs_[i];
          if (pair.search == nullptr || pair.search->verdict() == Verdict::Never) return;
          const std::pair links(surfaces_[pair.a]->link, surfaces_[pair.b]->link);
          if (relation_of(robot_, shaped_, links.first, links.second) != Relation::Adjacent) return;
          const Shapes &a = shapes_[pair.a], &b = shapes_[pair.b];
          const std::optional<Search::Joint> joint =
              Search(whole_, links.first, links.second, a, b, 0).joint();
          pair.away = look_away(robot_, links, a, b, *pair.search, joint, options_, stop);
        },
        {.alone = true});
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      if (pairs_[i].away && pairs_[i].away->own) away_.push_back(i);
    leave_decided_away();
  }
  void leave_decided_away() {
    std::erase_if(away_, [&](std::size_t i) {
      const Search& search = *pairs_[i].away->search;
      return search.decided() || search.boxes() / 2 >= options_.most_boxes || unsure(pairs_[i]) ||
             pairs_[i].search->verdict() == Verdict::Never;
    });
  }
  void go_on_away(std::size_t work, const std::function<bool()>& stop) {
    parallel_for(std::size_t{0}, away_.size(),
                 [&](std::size_t i) {
                   Search& search = *pairs_[away_[i]].away->search;
                   search.look_for_contacts(stop);
                   search.go_on(options_.most_boxes - search.boxes() / 2, work, stop);
                   search.look_deeper(stop);
                 },
                 {.alone = true});
    leave_decided_away();
  }
  std::vector<DecidedPair> found() {
    std::vector<DecidedPair> out(pairs_.size());
    parallel_for(std::size_t{0}, pairs_.size(),
                 [&](std::size_t i) {
                   out[i] = found_of(robot_, shaped_, *surfaces_[pairs_[i].a],
                                     *surfaces_[pairs_[i].b], std::move(pairs_[i]));
                 },
                 {.alone = true});
    return out;
  }

  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin_ = Clock::now();
  robot::Robot robot_;
  const robot::Robot& whole_;
  const DecideOptions& options_;
  std::vector<const LinkSurface*> surfaces_;
  std::vector<Shapes> shapes_;
  Shaped shaped_;
  std::vector<Sought> pairs_;
  std::vector<std::size_t> left_;  ///< of the pairs
  std::vector<std::size_t> away_;  ///< those that are open away from their joint
  std::atomic<std::size_t> decided_ = 0;
};

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Never:
      return "never";
    case Verdict::Always:
      return "always";
    case Verdict::CanTouch:
      return "can touch";
    default:
      return "open";
  }
}

bool is_connected(const DecidedPair& pair) {
  return pair.relation == Relation::Fixed ||
         (pair.relation == Relation::Adjacent && pair.away && pair.away->verdict == Verdict::Never);
}

std::string text_of(const std::vector<double>& q) {
  std::string out;
  for (const double value : q) {
    std::array<char, 32> text{};
    const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
    if (!out.empty()) out += ',';
    out.append(text.data(), end.ptr);
  }
  return out;
}

std::vector<DecidedPair> decide_pairs(const robot::Robot& robot,
                                      const std::vector<LinkSurface>& given,
                                      const DecideOptions& options) {
  return Pairs(robot, robot, given, options).decide();
}

std::vector<DecidedPair> decide_pairs_at(const robot::Robot& robot, const std::vector<double>& q,
                                         const std::vector<LinkSurface>& given,
                                         const DecideOptions& options) {
  return Pairs(standing(robot, q), robot, given, options).decide();
}

}  // namespace kaboum::pairs
