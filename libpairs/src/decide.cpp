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

namespace kaboum::pairs {
namespace {

using detail::kInfinite;
using detail::Search;
using detail::Shapes;
using detail::Surface;
using geom::Mesh;
using geom::Vec3;

Shapes shapes_of(const Mesh& outer, const std::optional<Mesh>& inner) {
  Shapes out;
  if (outer.empty()) return out;
  out.outer = std::make_unique<Surface>(outer);
  out.shows = !inner || !inner->empty();
  if (inner && out.shows) out.inner_or_none = std::make_unique<Surface>(*inner);
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

/// Why nothing can be proved of what a pair has. Empty: it can.
std::string unsure_of(const robot::Robot& robot, const LinkSurface& a, const LinkSurface& b) {
  std::string out;
  for (const LinkSurface* s : {&a, &b}) {
    if (s->unsure.empty()) continue;
    if (!out.empty()) out += "; ";
    out += "link '" + robot.links[s->link].name + "': " + s->unsure;
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
std::optional<AwayFromJoint> look_away(const robot::Robot& robot,
                                       std::pair<std::uint32_t, std::uint32_t> links,
                                       const Shapes& a, const Shapes& b, const Search& whole,
                                       const DecideOptions& options,
                                       const std::function<bool()>& stop) {
  const std::optional<Search::Joint> joint = whole.joint();
  if (!joint || stop()) return std::nullopt;
  AwayFromJoint out;
  const double cut = joint->beyond * 1.05;
  out.beyond = cut * (1 + 0x1p-30);  // for the rounding of the point
  const Shapes of_a = away_from(a, joint->in_a, cut), of_b = away_from(b, joint->in_b, cut);
  if (!of_a.outer || !of_b.outer) {
    out.verdict = Verdict::Never;
    return out;
  }
  Search search(robot, links.first, links.second, of_a, of_b, options.samples);
  search.begin(stop);
  for (int i = 0; i < 3; ++i) search.look_for_contacts(stop);
  search.go_on(std::min<std::size_t>(options.most_boxes, 20'000), stop);
  out.verdict = search.verdict();
  out.nearest = search.nearest();
  out.q = configuration(robot, search);
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
  std::optional<AwayFromJoint> away;
};

DecidedPair found_of(const robot::Robot& robot, const Shaped& shaped, const LinkSurface& a,
                     const LinkSurface& b, Sought found) {
  DecidedPair pair;
  pair.a = a.link;
  pair.b = b.link;
  pair.relation = relation_of(robot, shaped, pair.a, pair.b);
  pair.adjacent = are_adjacent(robot, shaped, pair.a, pair.b);
  const std::string unsure = unsure_of(robot, a, b);
  if (found.search == nullptr) {
    pair.why = unsure;
    return pair;
  }
  pair.verdict = found.search->verdict();
  pair.nearest = found.search->nearest();
  pair.depth = found.search->depth();
  pair.boxes = found.search->boxes();
  pair.q = configuration(robot, *found.search);
  if (pair.verdict != Verdict::Never) pair.away = std::move(found.away);
  if (unsure.empty()) return pair;
  doubt(pair);
  if (pair.away) doubt(*pair.away);
  pair.depth.upper = pair.depth.lower > 0 ? kInfinite : 0;
  if (pair.verdict == Verdict::Open) pair.why = unsure;
  return pair;
}

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
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const std::vector<const LinkSurface*> surfaces = in_order(robot, given);
  std::vector<Shapes> shapes(surfaces.size());
  parallel_for(
      std::size_t{0}, surfaces.size(),
      [&](std::size_t i) { shapes[i] = shapes_of(surfaces[i]->outer, surfaces[i]->inner); },
      {.alone = true});
  Shaped shaped(robot.links.size(), 0);
  for (std::size_t l = 0; l < shaped.size(); ++l)
    shaped[l] = robot.links[l].collision.empty() ? 0 : 1;
  for (const LinkSurface* s : surfaces) shaped[s->link] = 1;

  std::vector<Sought> pairs;
  for (std::size_t a = 0; a < surfaces.size(); ++a)
    for (std::size_t b = a + 1; b < surfaces.size(); ++b)
      pairs.push_back({a, b, nullptr, std::nullopt});

  std::atomic<std::size_t> decided = 0;
  const auto stop = [&] {
    if (options.progress) options.progress(decided, pairs.size());
    if (options.stop && options.stop()) return true;
    return std::chrono::duration<double>(Clock::now() - begin).count() > options.most_seconds;
  };
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (shapes[pairs[i].a].outer && shapes[pairs[i].b].outer) left.push_back(i);
  const auto round = [&](const auto& work) {
    parallel_for(std::size_t{0}, left.size(),
                 [&](std::size_t i) {
                   Sought& pair = pairs[left[i]];
                   work(pair);
                   if (pair.search->decided()) ++decided;
                 },
                 {.alone = true});
    std::erase_if(left, [&](std::size_t i) { return pairs[i].search->decided(); });
  };
  round([&](Sought& pair) {
    pair.search = std::make_unique<Search>(robot, surfaces[pair.a]->link, surfaces[pair.b]->link,
                                           shapes[pair.a], shapes[pair.b], options.samples);
    pair.search->begin(stop);
  });
  round([&](Sought& pair) { pair.search->look_for_contacts(stop); });
  // Before pairs that are hard take all of the time.
  parallel_for(std::size_t{0}, pairs.size(),
               [&](std::size_t i) {
                 Sought& pair = pairs[i];
                 if (pair.search == nullptr || pair.search->verdict() == Verdict::Never) return;
                 const std::pair links(surfaces[pair.a]->link, surfaces[pair.b]->link);
                 if (relation_of(robot, shaped, links.first, links.second) == Relation::Adjacent)
                   pair.away = look_away(robot, links, shapes[pair.a], shapes[pair.b], *pair.search,
                                         options, stop);
               },
               {.alone = true});
  // More and more boxes, so that what is easy is decided before the time is up.
  for (std::size_t boxes = 500; !left.empty(); boxes *= 2) {
    const bool last = boxes >= options.most_boxes;
    if (boxes > 500) round([&](Sought& pair) { pair.search->look_for_contacts(stop); });
    round([&](Sought& pair) {
      const std::size_t most = std::min(boxes, options.most_boxes);
      if (pair.search->boxes() / 2 < most)
        pair.search->go_on(most - pair.search->boxes() / 2, stop);
    });
    if (last || stop()) break;
  }

  std::vector<DecidedPair> out(pairs.size());
  parallel_for(std::size_t{0}, pairs.size(),
               [&](std::size_t i) {
                 out[i] = found_of(robot, shaped, *surfaces[pairs[i].a], *surfaces[pairs[i].b],
                                   std::move(pairs[i]));
               },
               {.alone = true});
  return out;
}

}  // namespace kaboum::pairs
