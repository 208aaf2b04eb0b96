// The option --engine of kaboum-check: contacts as a collision library of others sees them.

#include "engine.h"

#include <kaboum/engines/engine_options.h>

#include <algorithm>
#include <sstream>

namespace kaboum::tools {
namespace {

using Pair = std::array<world::Item, 2>;

bool is_own(const CheckOptions& o) { return o.engine.library == engines::Library::Own; }

std::string words_of(const world::World& world, const Pair& pair) {
  return world.name_of(pair[0]) + " and " + world.name_of(pair[1]);
}

Json to_json(const world::World& world, const Pair& pair) {
  return {world.name_of(pair[0]), world.name_of(pair[1])};
}

std::vector<Pair> pairs_of(const std::vector<world::Contact>& contacts) {
  std::vector<Pair> out;
  out.reserve(contacts.size());
  for (const world::Contact& contact : contacts) out.push_back(contact.items);
  return out;
}

bool has(const std::vector<Pair>& pairs, const Pair& pair) {
  return std::ranges::find(pairs, pair) != pairs.end();
}

/// User CPU seconds of looking at all states once, for whether they are free: the mean of as many
/// times as a quarter of a second has.
double seconds_of(const world::Checker& checker, const std::vector<world::WorldState>& states,
                  const world::Checker::Options& options) {
  constexpr double kLeast = 0.25;
  constexpr int kMostTimes = 1000;
  world::Scratch scratch;
  const double start = user_seconds();
  for (int times = 1;; ++times) {
    for (const world::WorldState& state : states)
      static_cast<void>(checker.is_free(state, scratch, options));
    const double taken = user_seconds() - start;
    if (taken >= kLeast || times == kMostTimes) return taken / times;
  }
}

/// What both say of states.
class Comparison {
 public:
  Comparison(const CheckOptions& o, const world::World& world) : o_(o), world_(world) {}

  /// Says and reports where the contacts of a state differ.
  void add(const std::vector<Pair>& own, const std::vector<Pair>& engine, const std::string& before,
           const std::function<void(const std::string&)>& say, Json& report) {
    Json differences = Json::array();
    const std::string name = engines::name_of(o_.engine.library);
    const auto tell = [&](const Pair& pair, const std::string& yes, const std::string& no) {
      say(before + words_of(world_, pair) + ": in contact by " + yes + ", not by " + no);
      differences.push_back({{"pair", to_json(world_, pair)}, {"in_contact_by", yes}});
    };
    for (const Pair& pair : own)
      if (!has(engine, pair)) tell(pair, "own", name);
    for (const Pair& pair : engine)
      if (!has(own, pair)) tell(pair, name, "own");
    differing_ += differences.empty() ? 0 : 1;
    report["differences"] = std::move(differences);
  }

  void finish(const std::vector<world::WorldState>& states, const world::Checker& own,
              const world::Checker& engine, const std::function<void(const std::string&)>& say,
              Json& report) const {
    const double of_own = seconds_of(own, states, o_.state),
                 of_engine = seconds_of(engine, states, o_.state);
    const auto count = static_cast<double>(states.size());
    const std::string name = engines::name_of(o_.engine.library);
    std::ostringstream line;
    line.precision(3);
    line << "own and " << name << " agree on all pairs of " << states.size() - differing_ << " of "
         << states.size() << (states.size() == 1 ? " state" : " states") << "; user CPU: own "
         << 1e6 * of_own / count << " us, " << name << " " << 1e6 * of_engine / count << " us each";
    say(line.str());
    report["comparison"] = {{"states", states.size()},
                            {"differing", differing_},
                            {"user_seconds", {{"own", of_own}, {name, of_engine}}}};
  }

 private:
  const CheckOptions& o_;
  const world::World& world_;
  std::size_t differing_ = 0;
};

const char* answer_of(bool contact) { return contact ? "contact seen" : "no contact seen"; }

}  // namespace

void require_engine_meaning(const CheckOptions& o) {
  const auto refuse = [](const std::string& text) {
    throw Error(ErrorCode::InvalidArgument, text);
  };
  if (is_own(o)) {
    for (const auto& option : engines::engine_options())
      if (option.name != "engine" && o.stated.contains(option.name))
        refuse("--" + option.name + " needs --engine with a library of others");
    if (o.compare) refuse("--compare needs --engine with a library of others");
    return;
  }
  if (o.stated.contains("engine-step") && o.paths.empty())
    refuse("--engine-step is for motions: give --path");
  if (o.stated.contains("resolution")) refuse("--resolution is of own answers; see --engine-step");
  if (o.distance || !o.inside.empty() || !o.preview.empty() || !o.keep.keep.empty() ||
      !o.margin.margins.empty())
    refuse(
        "--distance, --inside, --keep, --margin and --preview are answered by --engine own only");
  if (o.compare && !o.paths.empty())
    refuse(
        "--compare is for configurations: of a motion own knows every instant, and others know "
        "samples");
}

Json engine_json(const CheckOptions& o) {
  Json out = {{"name", engines::name_of(o.engine.library)},
              {"title", engines::title_of(o.engine.library)},
              {"shapes", value_of(engines::engine_options(), "engine-shapes", o.engine)},
              {"certified", false}};
  if (!o.paths.empty()) out["step"] = o.engine.step;
  return out;
}

int check_states_by_engine(const CheckOptions& o, const world::SceneFile& scene,
                           std::optional<std::size_t> robot, const robot::Path& values,
                           const std::function<void(const std::string&)>& say, Json& report) {
  const auto substitute = engines::make_substitute(scene.world, o.scene, o.engine);
  const world::Checker engine(scene.world, nullptr, substitute.get());
  std::optional<world::Checker> own;
  if (o.compare) own.emplace(scene.world);
  Comparison comparison(o, scene.world);
  std::vector<world::WorldState> states;
  Json entries = Json::array();
  world::Scratch scratch;
  bool contact = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    world::WorldState state = initial_state(scene.world);
    if (robot) state.q[*robot] = values[i];
    const std::string before =
        values.size() > 1 ? "configuration " + std::to_string(i + 1) + ": " : "";
    const std::vector<Pair> found = pairs_of(engine.find_contacts(state, scratch, o.state));
    Json one = {{"contact_seen", !found.empty()}, {"contacts", Json::array()}};
    for (const Pair& pair : found) {
      one["contacts"].push_back({{"answer", "contact seen"}, {"pair", to_json(scene.world, pair)}});
      say(before + words_of(scene.world, pair) + " meet, " + words_of(o.engine));
    }
    if (found.empty()) say(before + "no contact seen, " + words_of(o.engine));
    contact = contact || !found.empty();
    if (own) {
      const std::vector<Pair> ours = pairs_of(own->find_contacts(state, scratch, o.state));
      one["free_by_own"] = ours.empty();
      contact = contact || !ours.empty();
      comparison.add(ours, found, before, say, one);
    }
    entries.push_back(std::move(one));
    states.push_back(std::move(state));
  }
  report["configurations"] = std::move(entries);
  report["answer"] = answer_of(contact);
  if (own) comparison.finish(states, *own, engine, say, report);
  return contact ? kNo : kDone;
}

int check_paths_by_engine(const CheckOptions& o, const world::SceneFile& scene,
                          const std::vector<world::RobotPath>& paths,
                          const std::function<void(const std::string&)>& say, Json& report) {
  const auto substitute = engines::make_substitute(scene.world, o.scene, o.engine);
  const world::Checker engine(scene.world, nullptr, substitute.get());
  const world::MotionAnswer answer = [&] {
    Progress progress(o.common.quiet);
    world::MotionOptions told = o.motion;
    told.progress = [&](const std::string& stage) { progress.show(stage); };
    return check_motions(engine, initial_state(scene.world), paths, told);
  }();
  using Outcome = world::MotionAnswer::Outcome;
  const bool undecided = answer.outcome == Outcome::Undecided;
  report["waypoints"] = paths.front().path.size();
  report["answer"] = undecided ? "undecided" : answer_of(answer.contact.has_value());
  report["motion"] = {{"outcome", undecided ? "undecided" : answer_of(answer.contact.has_value())},
                      {"samples", answer.samples}};
  std::ostringstream line;
  line.precision(6);
  if (undecided) {
    line << "undecided: more than " << o.motion.most_intervals << " samples are needed";
  } else if (answer.contact) {
    const Pair& pair = answer.contact->items;
    report["motion"]["contact"] = {{"pair", to_json(scene.world, pair)},
                                   {"waypoint", answer.contact_segment + 1},
                                   {"share", answer.contact_share}};
    line << words_of(scene.world, pair) << " meet at waypoint " << answer.contact_segment + 1;
    if (answer.contact_share > 0)
      line << " + " << answer.contact_share << " of the way to the next";
  } else {
    line << "no contact seen at " << answer.samples << " samples, no point moving farther than "
         << o.engine.step << " in between";
  }
  say(line.str() + ", " + words_of(o.engine));
  return undecided ? kLimit : answer.contact ? kNo : kDone;
}

}  // namespace kaboum::tools
