// External functions outside of the planner's process: shared libraries and programs, good and
// broken in every way; each ends with a sentence that names function and state.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/external/plugin.h>
#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>

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

/// What was chosen comes across: it is chosen anew, and no proof rests on it.
TEST(Plugin, ChoosesAmongSeveralThings) {
  const auto ending_with = [&](const std::string& last) {
    return plan::load({"t.kpl",
                       "types: conf handle\nconstants: conf start\nfunctions: at : conf\n"
                       "predicates: chosen, done\nexternals: choose(conf) : conf; " +
                           last +
                           "(conf) : conf\n"
                           "action go preconds: K(!chosen) & let ?y = extern(choose(at))\n"
                           "effects: add(Kf, at = ?y), add(Kf, chosen)\n"
                           "action end preconds: K(chosen) & let ?y = extern(" +
                           last +
                           "(at)) effects: add(Kf, done)\n"
                           "init: K(at = start), K(!chosen), K(!done)\ngoal: K(done)",
                       plan::Language::Kpl},
                      nullptr, plugin());
  };
  const plan::Model m = ending_with("fits");
  const plan::Solution s = solve(m, {});
  ASSERT_EQ(s.outcome, plan::Outcome::Solved) << s.limit;
  EXPECT_EQ(s.plan.choices, (plan::Choices{{"choose(start)", 2}}));
  EXPECT_TRUE(check(m, s.plan).valid);
  EXPECT_EQ(solve(ending_with("none"), {}).outcome, plan::Outcome::Limit);
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
        Case{"badWord", "the value that it returned is not UTF-8"},
        Case{"badPayload", "the payload that it returned is not UTF-8"},
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
  expect_says(says("nothing.so"), "plug-in 'nothing.so': cannot be loaded");
  expect_says(says("libm.so.6"), "cannot be loaded");
  EXPECT_THROW(load_plugin(KABOUM_BROKEN_PLUGIN, {0}), Error);
  setenv("KABOUM_BROKEN_ENTRY", "1", 1);
  expect_says(says(KABOUM_BROKEN_PLUGIN),
              "kaboum_externals_1 failed: it threw what is no std::exception");
  unsetenv("KABOUM_BROKEN_ENTRY");
}

/// Kills a child that does `work` when it has said "endless" on standard error. @return whether all
/// that have its standard error end then.
bool ends_with_its_planner(const std::function<void()>& work) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  const pid_t planner = fork();
  if (planner == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    work();
    _exit(0);
  }
  close(ends[1]);
  std::string said;
  char c = 0;
  while (said.find("endless\n") == std::string::npos && read(ends[0], &c, 1) == 1) said += c;
  EXPECT_NE(said.find("endless\n"), std::string::npos) << said;
  kill(planner, SIGKILL);
  waitpid(planner, nullptr, 0);
  pollfd end{ends[0], 0, 0};  // the other end is closed
  const bool ended = poll(&end, 1, 20'000) == 1;
  close(ends[0]);
  return ended;
}

TEST(Process, NothingOutlivesThePlanner) {
  EXPECT_TRUE(ends_with_its_planner([] { complaint(plugin(600), "endless"); }));
  EXPECT_TRUE(ends_with_its_planner(
      [] { start_process("echo endless >&2; sleep 600 & sleep 601", {600}); }));
  // Nor does one of several, each of which was started with the files of those before.
  EXPECT_TRUE(ends_with_its_planner([] {
    const plan::ExternalBindings first = plugin(600), second = plugin(600);
    complaint(second, "endless");
  }));
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

/// Programs that answer by a shell's `case` over the question, offered as functions of the state
/// and of arguments alone.
std::vector<plan::ExternalBindings> both_ways(const std::string& cases) {
  std::vector<plan::ExternalBindings> out;
  for (const std::string list : {"functions", "of_arguments"})
    out.push_back(start_process(R"(echo '{"kaboum_externals": 1, ")" + list +
                                    R"(": ["g"]}'; while read q; do case "$q" in )" + cases +
                                    " esac; done",
                                {20}));
  return out;
}

TEST(Process, BothListsHaveSeedsAttemptsReasonsAndPayloads) {
  for (const auto& all : both_ways(R"(*'"attempt":2'*'"seed":'[1-9]*) )"
                                   R"(echo '{"value": "c", "payload": "of 3"}';; )"
                                   R"(*) echo '{"not_found": "no sample yet"}';;)")) {
    const plan::Model m = model(all, "g");
    plan::SolveOptions options;
    options.seed = 7;
    const plan::Solution s = solve(m, options);
    ASSERT_EQ(s.outcome, plan::Outcome::Solved);
    EXPECT_EQ(s.plan.nodes.at(0).calls.at(0).payload, "of 3");
    EXPECT_EQ(s.plan.seed, 7U);
    EXPECT_EQ(s.plan.attempts, 3U);
    EXPECT_TRUE(check(m, s.plan).valid);
    options.attempts = 2;
    const plan::Solution none = solve(m, options);
    EXPECT_EQ(none.outcome, plan::Outcome::Limit);
    expect_says(none.limit, "g(start): no sample yet");
  }
  for (const auto& all : both_ways(R"(*) echo '{"impossible": "in the way"}';;)"))
    EXPECT_EQ(solve(model(all, "g"), {}).outcome, plan::Outcome::Unsolvable);
}

TEST(Process, WhatItsFirstLineSaysIsItsOwn) {
  const auto says = [](const std::string& command) {
    try {
      start_process(command, {20});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  expect_says(says(R"(echo '{"error": "no licence"}')"), "program 'echo ");
  expect_says(says(R"(echo '{"error": "no licence"}')"), "': no licence");
  expect_says(says(R"(echo '{"kaboum_externals": 1, "functions": ["f", "g"], )"
                   R"("of_arguments": ["g"]}')"),
              "it offers the function 'g' twice");
  expect_says(says(R"(echo '{"kaboum_externals": 1, "functions": ["f", "f"]}')"),
              "it offers the function 'f' twice");
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
