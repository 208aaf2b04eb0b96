// External functions outside of the planner's process: shared libraries and programs, good and
// broken in every way; each ends with a sentence that names function and state.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/external/plugin.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <chrono>

namespace kaboum::external {
namespace {

plan::ExternalBindings plugin(double seconds = 20) {
  return load_plugin(KABOUM_BROKEN_PLUGIN, {seconds});
}

/// A step that asks `g`, of the state's own configuration.
plan::Model model(const plan::ExternalBindings& all, const std::string& g) {
  return plan::load({"t.kpl",
                     "types: conf handle\nconstants: conf start\nfunctions: at : conf\n"
                     "predicates: done\nexternals: " +
                         g + "(conf) : conf\naction go preconds: let ?y = extern(" + g +
                         "(at)) effects: add(Kf, at = ?y), add(Kf, done)\n"
                         "init: K(at = start), K(!done)\ngoal: K(done)",
                     plan::Language::Kpl},
                    nullptr, all);
}

/// What solving ends with; the error's code as well.
std::pair<std::string, ErrorCode> complaint(const plan::ExternalBindings& all,
                                            const std::string& g) {
  try {
    solve(model(all, g), {});
  } catch (const Error& e) {
    return {e.what(), e.code()};
  }
  return {"no error", ErrorCode::InvalidArgument};
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(Plugin, AnswersAsIfItWereInTheProcess) {
  const plan::ExternalBindings all = plugin();
  const plan::Model m = model(all, "good");
  const plan::Solution s = solve(m, {});
  ASSERT_EQ(s.outcome, plan::Outcome::Solved);
  ASSERT_EQ(s.plan.nodes[0].calls.size(), 1U);
  EXPECT_EQ(s.plan.nodes[0].calls[0].value, "after start");
  EXPECT_EQ(s.plan.nodes[0].calls[0].payload, "path\n\"of\" it");
  EXPECT_TRUE(check(m, s.plan).valid);
  EXPECT_FALSE(all.at("ofNames").reads_state());
  EXPECT_TRUE(all.at("good").reads_state());
  EXPECT_EQ(solve(model(all, "ofNames"), {}).plan.nodes.at(0).calls.at(0).value, "named start");
  EXPECT_EQ(solve(model(all, "none"), {}).outcome, plan::Outcome::Unsolvable);
}

TEST(Plugin, WhatIsBrokenIsNamedWithTheState) {
  struct Case {
    const char *function, *says;
    ErrorCode code = ErrorCode::InvalidInput;
  };
  for (const Case& c :
       {Case{"crash", "it ended by signal 11"}, Case{"throws", "no robot at start"},
        Case{"throwsNumber", "it threw what is no std::exception"},
        Case{"fickle", "returned another value when it was called again"},
        Case{"wrongType", "it returned '', no constant of its type (conf)"},
        Case{"stubborn", "it reads 'nowhere', but the model has no function"},
        Case{"endless", "no answer within 0.3 s; it was ended", ErrorCode::LimitReached}}) {
    const auto started = std::chrono::steady_clock::now();
    const auto [text, code] =
        complaint(plugin(std::string(c.function) == "endless" ? 0.3 : 20), c.function);
    expect_says(text, c.says);
    expect_says(text, std::string("external function '") + c.function + "(start)'");
    expect_says(text, "in a state where at = start");
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_EQ(code, c.code) << text;
    EXPECT_LT(std::chrono::steady_clock::now() - started, std::chrono::minutes(1)) << c.function;
  }
}

TEST(Plugin, WhatCannotBeLoadedIsSaid) {
  const auto says = [](const std::string& file) {
    try {
      load_plugin(file);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  expect_says(says("nothing.so"), "nothing.so: cannot be loaded");
  expect_says(says("libm.so.6"), "cannot be loaded");
  EXPECT_THROW(load_plugin(KABOUM_BROKEN_PLUGIN, {0}), Error);
}

TEST(Process, ACallWithoutAnEndIsEndedAndNamedWithTheState) {
  const std::string hello = R"(echo '{"kaboum_externals": 1, "functions": ["g"]}'; read q; )";
  const std::string ask = R"(echo '{"read": "at", "arguments": []}'; read answer; )";
  const auto [text, code] =
      complaint(start_process(hello + ask + "while :; do :; done", {0.3}), "g");
  expect_says(text, "external function 'g(start)'");
  expect_says(text, "no answer within 0.3 s; it was ended");
  expect_says(text, "in a state where at = start");
  EXPECT_EQ(code, ErrorCode::LimitReached);
  expect_says(
      complaint(start_process(hello + ask + R"(echo '{"error": "no licence"}'; read x)", {9}), "g")
          .first,
      "'g(start)' failed: no licence, in a state where at = start");
}

TEST(Process, FunctionsOfArgumentsAloneDoNotReadTheState) {
  const std::string hello = R"(echo '{"kaboum_externals": 1, "of_arguments": ["g"]}'; )";
  const std::string loop = "while read q; do ";
  const auto good = start_process(hello + loop + R"(echo '{"value": "c"}'; done)", {9});
  EXPECT_FALSE(good.at("g").reads_state());
  EXPECT_EQ(solve(model(good, "g"), {}).outcome, plan::Outcome::Solved);
  expect_says(
      complaint(start_process(hello + loop + R"(echo '{"read": "at"}'; read x; done)", {9}), "g")
          .first,
      "it reads 'at', but is among the functions 'of_arguments' alone");
}

}  // namespace
}  // namespace kaboum::external
