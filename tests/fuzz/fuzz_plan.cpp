// Any text given to the planner's readers either makes a model or throws Error; what is read can be
// written and read again; a short search ends, and its plan is valid. The first byte selects the
// language.

#include <kaboum/base/error.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace kaboum::plan;

[[noreturn]] void broken(const char* what, const char* detail) {
  std::fprintf(stderr, "%s: %s\n", what, detail);
  std::abort();
}

void try_text(const Text& text) {
  std::string kpl;
  try {
    kpl = convert(text, nullptr, Language::Kpl);
  } catch (const kaboum::Error&) {
    kpl.clear();  // unreadable, or not to be said in kpl
  }
  if (!kpl.empty()) {
    try {
      if (convert({"again", kpl, Language::Kpl}, nullptr, Language::Kpl) != kpl)
        broken("not a fixed point", kpl.c_str());
    } catch (const kaboum::Error& e) {
      broken("written text cannot be read", e.what());
    }
  }
  const Model model = load(text, nullptr);
  SolveOptions options;
  options.algorithm = static_cast<Algorithm>(text.text.size() % 5);
  options.timeout = 0.05;
  options.max_memory = std::size_t{32} << 20U;
  const Solution s = solve(model, options);
  if (s.outcome != Outcome::Solved) return;
  const CheckResult r = check(model, s.plan, 10'000);
  if (!r.valid) broken("invalid plan", r.violation.c_str());
  if (!(read_plan(model, write_plan(model, s.plan), "plan") == s.plan))
    broken("plan file", "read back as another");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kLanguages = {Language::Kpl, Language::Pddl};
  if (size == 0) return 0;
  const Text text{"fuzz", std::string(reinterpret_cast<const char*>(data) + 1, size - 1),
                  kLanguages[data[0] % kLanguages.size()]};
  try {
    try_text(text);
  } catch (const kaboum::Error& e) {
    if (e.code() == kaboum::ErrorCode::Internal) broken("internal error", e.what());
  }
  return 0;
}
