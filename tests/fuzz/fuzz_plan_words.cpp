// Any text given to the readers of what plans say of a scene either makes places, configurations
// and motions of its things, or throws Error; answers kept between runs that are damaged are none.
// The first byte selects the kind.

#include <kaboum/manipulation/answer_cache.h>
#include <kaboum/manipulation/words.h>

#include "../../libexecution/src/motion_part.h"
#include "../world/worlds.h"
#include "fuzz.h"

namespace {

using namespace kaboum;

const world::World& cell() {
  static const test::SceneFiles files;
  static const world::World world = files.world(
      files.scene("\"objects\": [{\"name\": \"box\", \"outer\": " + files.ref("box.glb") +
                  "}, {\"name\": \"lid\", \"pose\": {\"position\": [5, 0, 0]}, \"outer\": " +
                  files.ref("box.glb") + "}]"));
  return world;
}

void look_at_place(const std::string& word) {
  const manipulation::ObjectPlace place = manipulation::place_of(word, cell(), 0);
  std::string written;
  if (place.attachment)
    written = manipulation::word_of(cell(), *place.attachment);
  else if (place.mounted_on)
    written = manipulation::word_of(cell(), *place.mounted_on, place.pose);
  else if (!place.absent)
    written = manipulation::word_of(place.pose);
  if (!written.empty()) manipulation::place_of(written, cell(), 0);
}

void look_at_motions(const std::string& payload) {
  execution::SimulationOptions options;
  for (const execution::MotionPart& part : execution::parts_of(payload, cell(), "fuzz")) {
    for (const auto& [object, link] : part.holds)
      if (object >= cell().objects.size() ||
          link >= cell().robots[part.robot].kinematics.links.size())
        fuzz::broken("held", "something else");
    if (!part.path.empty()) execution::trajectory_of(part, cell(), options);
  }
}

/// Knows nothing.
struct NoState final : plan::StateView {
  std::optional<std::string> value(const std::string& /*function*/,
                                   const std::vector<std::string>& /*arguments*/) override {
    return std::nullopt;
  }
  std::optional<bool> truth(const std::string& /*predicate*/,
                            const std::vector<std::string>& /*arguments*/) override {
    return std::nullopt;
  }
  bool has_term(const std::string& /*function*/,
                const std::vector<std::string>& /*arguments*/) override {
    return false;
  }
};

void look_at_answers(const std::string& text) {
  manipulation::AnswerCache cache(text);
  plan::ExternalBindings bindings;
  bindings["f"] = plan::ExternalBinding(
      [](const plan::Question& q) { return plan::Answer::found(q.arguments[0]); });
  NoState state;
  const std::vector<std::string> arguments{"a"};
  const auto functions = cache.wrap(bindings);
  (void)functions.at("f")({arguments, state, 1, 0});
  (void)cache.content();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::select(data, size, 4, [](int kind, const std::string& text) {
    switch (kind) {
      case 0:
        return look_at_place(text);
      case 1:
        manipulation::word_of(manipulation::configuration_of(text, cell().robots[0]));
        return;
      case 2:
        return look_at_motions(text);
      default:
        return look_at_answers(text);
    }
  });
}
