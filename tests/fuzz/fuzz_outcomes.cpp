// Any text given to the reader of outcomes of sensing either makes some, under which a model is
// planned for and a plan carried out, or throws Error.

#include <kaboum/plan/load.h>
#include <kaboum/plan/outcomes.h>
#include <kaboum/plan/replay.h>
#include <kaboum/plan/solve.h>

#include "fuzz.h"

namespace {

using namespace kaboum;

// Whether a thing is heavy is sensed, and where it is.
constexpr const char* kDomain = R"(types: thing, place
constants: thing a, b; place shelf, floor
predicates: heavy(thing), found(thing)
functions: where(thing) : place
action weigh(?o : thing)
  preconds: !Kw(heavy(?o))
  effects: add(Kw, heavy(?o))
action look(?o : thing)
  preconds: K(heavy(?o)) & !Kv(where(?o))
  effects: add(Kv, where(?o)), add(Kf, found(?o))
action lift(?o : thing)
  preconds: K(!heavy(?o)) & K(where(?o) = shelf)
  effects: add(Kf, found(?o))
action see(?o : thing)
  preconds: K(!heavy(?o)) & !Kv(where(?o))
  effects: add(Kv, where(?o))
action search(?o : thing)
  preconds: K(!heavy(?o)) & K(where(?o) = floor)
  effects: add(Kf, found(?o))
init: K(!found(a)), K(!found(b))
goal: K(found(a)) & K(found(b))
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const plan::Model model =
      plan::load({"weighing.kpl", kDomain, plan::Language::Kpl}, nullptr);
  static const plan::Plan plan = [] {
    plan::Solution solution = plan::solve(model, {});
    if (solution.outcome != plan::Outcome::Solved) fuzz::broken("the domain", "has no plan");
    return std::move(solution.plan);
  }();
  fuzz::survive([&] {
    const std::string text(reinterpret_cast<const char*>(data), size);
    plan::RunOptions run;
    run.outcomes = plan::RunOptions::Outcomes::Given;
    run.given = plan::parse_outcomes(text, "fuzz");
    plan::SolveOptions options;
    options.assumed = run.given;
    if (plan::solve(model, options).outcome != plan::Outcome::Solved)
      fuzz::broken("no plan under", text);
    plan::run(model, plan, run, [](const plan::RunStep&) {});
  });
  return 0;
}
