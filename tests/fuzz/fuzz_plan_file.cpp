// Any text given to read_plan either makes a plan of the model, which is checked and written so
// that it reads back the same, or throws Error.

#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/plan.h>

#include "fuzz.h"

namespace {

// Its actions take one of two things; what is weighed branches.
constexpr const char* kDomain = R"(
predicates: held(object), heavy(object)
constants: a, b
action take(?o : object)
  preconds: K(!held(?o))
  effects: add(Kf, held(?o))
action weigh(?o : object)
  preconds: K(held(?o))
  effects: add(Kw, heavy(?o))
init: K(!held(a)), K(!held(b))
goal: K(held(a)) & K(held(b))
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kaboum;
  static const plan::Model model =
      plan::load({"weighing.kpl", kDomain, plan::Language::Kpl}, nullptr);
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::survive([&] {
    const plan::Plan p = plan::read_plan(model, text, "fuzz");
    plan::check(model, p, 10'000);
    plan::measure(model, p);
    if (!(plan::read_plan(model, plan::write_plan(model, p), "again") == p))
      fuzz::broken("plan file", "read back as another");
    plan::plan_text(model, p);
    plan::plan_dot(model, p);
  });
  return 0;
}
