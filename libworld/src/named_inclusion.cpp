// Whether what names stand for lies in regions.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/regions.h>

#include <algorithm>
#include <utility>

namespace kaboum::world {
namespace {

/// A robot is inside with all that it has and carries: what has shapes but no set cannot be told.
void require_whole(const RobotModel& robot) {
  for (std::uint32_t l = 0; l < robot.kinematics.links.size(); ++l) {
    const robot::Link& link = robot.kinematics.links[l];
    if (link.collision.empty() && link.visual.empty()) continue;
    if (std::none_of(robot.shapes.begin(), robot.shapes.end(),
                     [&](const LinkShape& shape) { return shape.link == l; }))
      throw Error(ErrorCode::InvalidInput,
                  "of robot '" + robot.name + "' link '" + link.name +
                      "' has shapes but no set, so it is not known whether it is inside: name "
                      "the links that are to be inside one by one");
  }
}

std::vector<Item> items_named(const World& world, const std::string& name) {
  if (const auto object = world.find_object(name)) return {{Item::kObject, *object}};
  std::vector<Item> out;
  std::vector<std::string> names;
  for (const Object& object : world.objects) names.push_back(object.name);
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    names.push_back(world.robots[r].name);
    if (name == world.robots[r].name) {
      require_whole(world.robots[r]);
      for (std::size_t i = 0; i < world.objects.size(); ++i)
        if (world.attachments[i] && world.attachments[i]->robot == r)
          out.push_back({Item::kObject, i});
    }
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
      names.push_back(world.name_of({r, s}));
      if (name == world.robots[r].name || name == names.back()) out.push_back({r, s});
    }
  }
  if (!out.empty()) return out;
  throw Error(ErrorCode::InvalidArgument,
              "the scene has no object, link or robot '" + name + "'" + did_you_mean(name, names));
}

}  // namespace

InclusionQuestion inclusion_question(const World& world, const std::string& what,
                                     const std::string& region) {
  InclusionQuestion out{what, region, items_named(world, what), 0};
  std::vector<std::string> names;
  for (const Region& r : world.regions) names.push_back(r.name);
  const auto found = std::ranges::find(names, region);
  if (found == names.end())
    throw Error(ErrorCode::InvalidArgument,
                "the scene has no region '" + region + "'" + did_you_mean(region, names));
  out.region = static_cast<std::size_t>(found - names.begin());
  return out;
}

const char* name_of(collide::Inclusion answer) {
  using collide::Inclusion;
  return answer == Inclusion::Included      ? "inside"
         : answer == Inclusion::NotIncluded ? "not certainly inside"
                                            : "undecided";
}

void combine(collide::Inclusion& all, collide::Inclusion one) {
  using collide::Inclusion;
  if (all != Inclusion::NotIncluded && one != Inclusion::Included) all = one;
}

collide::Inclusion find_inclusion(const Checker& checker, const WorldState& state,
                                  const InclusionQuestion& question) {
  collide::Inclusion all = collide::Inclusion::Included;
  for (const Item& item : question.items)
    combine(all, find_inclusion(checker, state, item, question.region));
  return all;
}

MotionInclusion find_inclusion(const Checker& checker, const WorldState& state, std::size_t robot,
                               const robot::Path& path, const InclusionQuestion& question,
                               const MotionOptions& options) {
  using collide::Inclusion;
  Inclusion all = Inclusion::Included;
  MotionInclusion first;
  std::size_t intervals = 0;
  for (const Item& item : question.items) {
    const MotionInclusion one =
        find_inclusion(checker, state, robot, path, item, question.region, options);
    combine(all, one.answer);
    intervals += one.intervals;
    const bool earlier = std::pair(one.segment, one.share) < std::pair(first.segment, first.share);
    if (one.answer != Inclusion::Included && (first.answer == Inclusion::Included || earlier))
      first = one;
  }
  first.answer = all;
  first.intervals = intervals;
  return first;
}

}  // namespace kaboum::world
