// Malformed files: an error with a place, never a crash.
#include <random>

#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

/// Loading and a short search either work or raise Error.
void survive(const std::string& text, Language language) {
  try {
    const Model m = load({"hostile", text, language}, nullptr);
    SolveOptions options;
    options.timeout = 0.05;
    options.max_memory = 16 << 20;
    const Solution s = solve(m, options);
    if (s.outcome == Outcome::Solved) {
      const CheckResult r = check(m, s.plan);
      EXPECT_TRUE(r.valid) << r.violation << "\n" << text;
    }
  } catch (const Error& e) {
    EXPECT_NE(e.code(), ErrorCode::Internal) << e.what() << "\n" << text;
  }
}

std::string whole(const std::string& domain, const std::string& n) {
  return slurp(std::string(KABOUM_DOMAINS) + "/" + domain + "/domain.kpl") + made(domain, n);
}

void mutate(const std::string& good, Language language, std::uint32_t seed, int rounds) {
  std::mt19937 random(seed);
  for (int i = 0; i < rounds && !testing::Test::HasFailure(); ++i) {
    std::string text = good;
    for (std::uint32_t edits = 1 + random() % 3; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      const std::size_t length = std::min<std::size_t>(random() % 12, text.size() - at);
      switch (random() % 4) {
        case 0:
          text.erase(at, length);
          break;
        case 1:
          text.insert(at, text.substr(random() % text.size(), length));
          break;
        case 2:
          text[at] = static_cast<char>(random() % 256);
          break;
        default:
          text.insert(at, 1, "()!&|,;:=?K "[random() % 12]);
      }
      if (text.empty()) text = " ";
    }
    survive(text, language);
  }
}

TEST(Hostile, MutatedScenarios) {
  std::uint32_t seed = 1;
  for (const char* name : {"stacked", "force-sensing", "bartender", "circular-rearrange",
                           "bimanual-assembly", "remove"})
    mutate(whole(name, "2"), Language::Kpl, seed++, 150);
}

TEST(Hostile, MutatedPddl) {
  mutate(slurp(std::string(KABOUM_DOMAINS) + "/../../tests/plan/data/blocks.pddl"), Language::Pddl,
         8, 300);
}

TEST(Hostile, DeepNestingAndOddTexts) {
  survive(std::string(100000, '('), Language::Kpl);
  survive("goal: " + std::string(100000, '('), Language::Kpl);
  survive("goal: " + std::string(100000, '!'), Language::Kpl);
  survive(std::string(100000, '('), Language::Pddl);
  survive("", Language::Kpl);
  survive("", Language::Pddl);
  survive(std::string("goal: K(p\0)", 11), Language::Kpl);
}

/// Sizes that are no nonsense to the parser but would exhaust what comes after it.
TEST(Hostile, LargeButFlat) {
  std::string types = "types: t0";
  for (int i = 1; i < 200'000; ++i)
    types += ", t" + std::to_string(i) + " : t" + std::to_string(i - 1);
  survive(types + "\npredicates: p\ngoal: K(p)", Language::Kpl);
  std::string objects = "constants: c0";
  for (int i = 1; i < 3000; ++i) objects += ", c" + std::to_string(i);
  const std::string quantified = "forall(?a, ?b, ?c, ?d) (K(p(?a, ?b)) => add(Kf, p(?c, ?d)))";
  survive(objects + "\npredicates: p(object, object), q\naction a preconds: true effects: " +
              quantified + "\ngoal: K(q)",
          Language::Kpl);
  survive(objects +
              "\npredicates: p(object, object, object), q\ninit: LCW(p(?a, ?b, ?c))\n"
              "goal: K(q)",
          Language::Kpl);
  survive(objects +
              "\npredicates: p(object, object), q\n"
              "goal: forallK(?a, ?b, ?c) (K(p(?a, ?b)) | K(p(?b, ?c)))",
          Language::Kpl);
  std::string actions;
  for (int i = 0; i < 20'000; ++i)
    actions += "action a" + std::to_string(i) + " preconds: K(p) effects: add(Kf, p)\n";
  survive("predicates: p\n" + actions + "goal: K(p)", Language::Kpl);
  std::string conjunction = "goal: K(p)";
  for (int i = 0; i < 100'000; ++i) conjunction += " & K(p)";
  survive("predicates: p\n" + conjunction, Language::Kpl);
}

TEST(Hostile, PlansThatAreNone) {
  const Model m = scenario("stacked", "3");
  for (
      const char* text :
      {"", "{}", "[]", "null", "{\"format\": \"kaboum-plan\", \"version\": 1}",
       R"({"format":"kaboum-plan","version":1,"root":5,"nodes":[]})",
       R"({"format":"kaboum-plan","version":1,"root":0,"nodes":[{"next":"goal"}]})",
       R"({"format":"kaboum-plan","version":1,"root":0,"nodes":[{"action":"move","arguments":["o1"],"next":0}]})",
       R"({"format":"kaboum-plan","version":1,"root":-1,"nodes":{}})"})
    EXPECT_THROW(read_plan(m, text, "p.json"), Error) << text;
}

}  // namespace
}  // namespace kaboum::plan::test
