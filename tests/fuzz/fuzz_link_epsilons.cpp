// Any text given to the reader of --epsilons either makes a length or a percentage above 0 for
// links that the robot has, or throws Error.

#include <cmath>

#include "../../tools/robots/link_epsilons.h"
#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kaboum;
  robot::Robot arm;
  arm.links = {{"base_link", {}, {}}, {"wrist_1", {}, {}}, {"wrist_2", {}, {}}};
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::survive([&] {
    for (const auto& [link, length] : tools::parse_epsilons(text, "fuzz", arm))
      if (!arm.find_link(link) || !(length.value > 0) || !std::isfinite(length.value))
        fuzz::broken("an epsilon", link);
  });
  return 0;
}
