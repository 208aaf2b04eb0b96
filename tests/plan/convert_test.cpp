// Conversions: what is written is read back and has the same plans.
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

std::string data(const std::string& file) {
  return slurp(std::string(KABOUM_DOMAINS) + "/../../tests/plan/data/" + file);
}

std::string plan_of(const std::string& text, Language language) {
  const Model m = load({"t", text, language}, nullptr);
  return plan_text(m, solved(m, Algorithm::BreadthFirst).plan);
}

TEST(Convert, KplIsAFixedPoint) {
  for (const char* name : {"stacked", "force-sensing", "bartender", "circular-rearrange",
                           "bimanual-assembly", "remove"}) {
    const Text d{"d.kpl", slurp(std::string(KABOUM_DOMAINS) + "/" + name + "/domain.kpl"),
                 Language::Kpl};
    const Text p{"p.kpl", made(name, "2"), Language::Kpl};
    const std::string once = convert(d, &p, Language::Kpl);
    EXPECT_EQ(convert({"o.kpl", once, Language::Kpl}, nullptr, Language::Kpl), once);
    EXPECT_EQ(plan_of(once, Language::Kpl), plan_of(d.text + p.text, Language::Kpl)) << name;
  }
}

TEST(Convert, XmlIsReadAndWritten) {
  const std::string xml = data("sensing.xml");
  const std::string plan = plan_of(xml, Language::Xml);
  EXPECT_NE(plan.find("if spillable(o1):"), std::string::npos);
  const std::string kpl = convert({"d.xml", xml, Language::Xml}, nullptr, Language::Kpl);
  EXPECT_EQ(plan_of(kpl, Language::Kpl), plan);
  const std::string again = convert({"d.kpl", kpl, Language::Kpl}, nullptr, Language::Xml);
  EXPECT_EQ(plan_of(again, Language::Xml), plan);
}

TEST(Convert, PddlIsReadAndWritten) {
  const std::string pddl = data("blocks.pddl");
  const std::string plan = plan_of(pddl, Language::Pddl);
  const std::string kpl = convert({"d.pddl", pddl, Language::Pddl}, nullptr, Language::Kpl);
  EXPECT_EQ(plan_of(kpl, Language::Kpl), plan);
  const std::string again = convert({"d.kpl", kpl, Language::Kpl}, nullptr, Language::Pddl);
  EXPECT_EQ(plan_of(again, Language::Pddl), plan);
}

TEST(Convert, NamesWhatCannotBeSaid) {
  const Text d{"d.kpl",
               slurp(std::string(KABOUM_DOMAINS) + "/remove/domain.kpl") + made("remove", "2"),
               Language::Kpl};
  EXPECT_THROW(convert(d, nullptr, Language::Pddl), Error);
  EXPECT_THROW(convert(d, nullptr, Language::Xml), Error);
}

TEST(Show, TextDotAndSvgNameEveryAction) {
  const Model m = scenario("force-sensing", "2");
  const Plan plan = solved(m, Algorithm::BreadthFirst).plan;
  for (const std::string& text : {plan_text(m, plan), plan_dot(m, plan), plan_svg(m, plan)})
    for (const Plan::Node& n : plan.nodes)
      EXPECT_NE(text.find(step_text(m, n.action)), std::string::npos);
}

}  // namespace
}  // namespace kaboum::plan::test
