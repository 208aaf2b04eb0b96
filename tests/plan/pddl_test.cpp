// PDDL: problems of the usual kinds, written here, with optima known by construction.
#include <algorithm>

#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

Model pddl(const std::string& text) { return load({"t.pddl", text, Language::Pddl}, nullptr); }

std::uint64_t optimum(const Model& m) {
  const Solution s = solved(m, Algorithm::AStar);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(solved(m, Algorithm::Greedy).outcome, Outcome::Solved);
  return measure(m, s.plan).longest;
}

TEST(Pddl, BlocksReversingATowerOfFour) {
  // Each block moves once, straight to its place: four times one action to take and one to put.
  const Model m = pddl(slurp(std::string(KABOUM_DOMAINS) + "/../../tests/plan/data/blocks.pddl"));
  const std::uint64_t shortest = measure(m, solved(m, Algorithm::BreadthFirst).plan).longest;
  EXPECT_EQ(optimum(m), shortest);
  EXPECT_EQ(shortest, 8U);
}

std::string gripper(int balls) {
  std::string objects, init, goal;
  for (int i = 0; i < balls; ++i) {
    const std::string b = "b" + std::to_string(i);
    objects += " " + b;
    init += " (at " + b + " a)";
    goal += " (at " + b + " b)";
  }
  return "(define (domain gripper) (:requirements :strips :typing) (:types room ball gripper)"
         " (:predicates (robby ?r - room) (at ?b - ball ?r - room) (free ?g - gripper) (carry ?o - "
         "ball ?g - gripper))"
         " (:action move :parameters (?f ?t - room) :precondition (robby ?f) :effect (and (robby "
         "?t) (not (robby ?f))))"
         " (:action pick :parameters (?o - ball ?r - room ?g - gripper) :precondition (and (at ?o "
         "?r) (robby ?r) (free ?g))"
         "  :effect (and (carry ?o ?g) (not (at ?o ?r)) (not (free ?g))))"
         " (:action drop :parameters (?o - ball ?r - room ?g - gripper) :precondition (and (carry "
         "?o ?g) (robby ?r))"
         "  :effect (and (at ?o ?r) (free ?g) (not (carry ?o ?g)))))"
         "(define (problem p) (:domain gripper) (:objects a b - room left right - gripper" +
         objects +
         " - ball)"
         " (:init (robby a) (free left) (free right)" +
         init + ") (:goal (and" + goal + ")))";
}

TEST(Pddl, GripperOptima) {
  // Two balls a trip: n picks, n drops, and 2 ceil(n/2) - 1 moves.
  for (const int n : {1, 2, 3, 4, 5}) {
    const Model m = pddl(gripper(n));
    EXPECT_EQ(optimum(m), static_cast<std::uint64_t>(2 * n + 2 * ((n + 1) / 2) - 1));
  }
}

TEST(Pddl, LogisticsWithObjectFluentsAndCosts) {
  // A package goes by truck, plane and truck; one truck waits at its airport already.
  const Model m = pddl(
      "(define (domain logistics) (:requirements :typing :object-fluents :action-costs :adl)"
      " (:types thing place - object package vehicle - thing truck plane - vehicle city - object "
      "airport - place)"
      " (:predicates (in-city ?p - place ?c - city))"
      " (:functions (at ?t - thing) - object (total-cost) - number (fare ?a ?b - airport) - number)"
      " (:action load :parameters (?p - package ?v - vehicle ?l - place) :precondition (and (= (at "
      "?p) ?l) (= (at ?v) ?l))"
      "  :effect (and (assign (at ?p) ?v) (increase (total-cost) 1)))"
      " (:action unload :parameters (?p - package ?v - vehicle ?l - place) :precondition (and (= "
      "(at ?p) ?v) (= (at ?v) ?l))"
      "  :effect (and (assign (at ?p) ?l) (increase (total-cost) 1)))"
      " (:action drive :parameters (?t - truck ?a ?b - place ?c - city)"
      "  :precondition (and (= (at ?t) ?a) (in-city ?a ?c) (in-city ?b ?c) (not (= ?a ?b)))"
      "  :effect (and (assign (at ?t) ?b) (increase (total-cost) 2)))"
      " (:action fly :parameters (?t - plane ?a ?b - airport) :precondition (and (= (at ?t) ?a) "
      "(not (= ?a ?b)))"
      "  :effect (and (assign (at ?t) ?b) (increase (total-cost) (fare ?a ?b)))))"
      "(define (problem p) (:domain logistics)"
      " (:objects home shop - place north south - airport n s - city t1 t2 - truck jet - plane box "
      "- package)"
      " (:init (in-city home n) (in-city north n) (in-city shop s) (in-city south s) (= (at box) "
      "home) (= (at t1) north)"
      "  (= (at t2) south) (= (at jet) north) (= (fare north south) 10) (= (fare south north) 99) "
      "(= (total-cost) 0))"
      " (:goal (= (at box) shop)) (:metric minimize (total-cost)))");
  const Solution s = solved(m, Algorithm::AStar);
  ASSERT_EQ(s.outcome, Outcome::Solved);
  const PlanSize size = measure(m, s.plan);
  EXPECT_EQ(size.longest, 10U);  // 6 loads and unloads, 3 drives, 1 flight
  EXPECT_EQ(size.cost, 6 + 3 * 2 + 10);
}

/// Blocks with four actions, from and to lists of towers, each bottom first.
std::string blocks(const std::vector<std::vector<int>>& from,
                   const std::vector<std::vector<int>>& to) {
  const auto name = [](int b) { return "b" + std::to_string(b); };
  const auto facts = [&](const std::vector<std::vector<int>>& towers, bool initial) {
    std::string text;
    for (const auto& t : towers)
      for (std::size_t i = 0; i < t.size(); ++i) {
        text += i == 0 ? " (ontable " + name(t[i]) + ")"
                       : " (on " + name(t[i]) + " " + name(t[i - 1]) + ")";
        if (initial && i + 1 == t.size()) text += " (clear " + name(t[i]) + ")";
      }
    return text;
  };
  std::string objects;
  for (const auto& t : from)
    for (const int b : t) objects += " " + name(b);
  return "(define (domain blocks) (:requirements :strips) (:predicates (on ?x ?y) (ontable ?x)"
         " (clear ?x) (handempty) (holding ?x))"
         "(:action pick-up :parameters (?x) :precondition (and (clear ?x) (ontable ?x) (handempty))"
         " :effect (and (not (ontable ?x)) (not (clear ?x)) (not (handempty)) (holding ?x)))"
         "(:action put-down :parameters (?x) :precondition (holding ?x)"
         " :effect (and (not (holding ?x)) (clear ?x) (handempty) (ontable ?x)))"
         "(:action stack :parameters (?x ?y) :precondition (and (holding ?x) (clear ?y))"
         " :effect (and (not (holding ?x)) (not (clear ?y)) (clear ?x) (handempty) (on ?x ?y)))"
         "(:action unstack :parameters (?x ?y) :precondition (and (on ?x ?y) (clear ?x) "
         "(handempty))"
         " :effect (and (holding ?x) (clear ?y) (not (clear ?x)) (not (handempty)) (not (on ?x "
         "?y)))))"
         "(define (problem p) (:domain blocks) (:objects" +
         objects + ") (:init (handempty)" + facts(from, true) + ") (:goal (and" + facts(to, false) +
         ")))";
}

TEST(Pddl, BlocksOptima) {
  // Two actions for every block that must move, and two more for each that must move twice.
  EXPECT_EQ(optimum(pddl(blocks({{1, 3}, {2}}, {{3, 2, 1}}))), 6U);  // Sussman's anomaly
  EXPECT_EQ(optimum(pddl(blocks({{1, 2, 3, 4, 5}}, {{5, 4, 3, 2, 1}}))), 10U);
  EXPECT_EQ(optimum(pddl(blocks({{1, 2, 3, 4, 5, 6}}, {{1, 6}, {2}, {3}, {4}, {5}}))), 12U);
  EXPECT_EQ(optimum(pddl(blocks({{1, 2}, {3, 4}}, {{3, 2}, {1, 4}}))), 6U);
  EXPECT_EQ(optimum(pddl(blocks({{1, 2, 3}}, {{2, 1, 3}}))), 8U);
  // A new block below a tower: all but the new one move twice.
  EXPECT_EQ(optimum(pddl(blocks({{2, 3, 4, 5}, {1}}, {{1, 2, 3, 4, 5}}))), 14U);
}

/// Logistics with predicates: packages at places of one city, to a place of the other.
std::string logistics(int packages) {
  std::string objects, init, goal;
  for (int i = 0; i < packages; ++i) {
    const std::string p = "p" + std::to_string(i);
    objects += " " + p;
    init += " (at " + p + " home)";
    goal += " (at " + p + " shop)";
  }
  return "(define (domain logistics) (:requirements :strips :typing) (:types package vehicle - "
         "thing"
         " truck plane - vehicle airport - place city thing place - object)"
         " (:predicates (at ?t - thing ?p - place) (in ?p - package ?v - vehicle) (in-city ?p - "
         "place ?c - city))"
         " (:action load :parameters (?p - package ?v - vehicle ?l - place) :precondition (and (at "
         "?p ?l) (at ?v ?l)) :effect (and (not (at ?p ?l)) (in ?p ?v)))"
         " (:action unload :parameters (?p - package ?v - vehicle ?l - place) :precondition (and "
         "(in ?p ?v) (at ?v ?l)) :effect (and (not (in ?p ?v)) (at ?p ?l)))"
         " (:action drive :parameters (?t - truck ?a ?b - place ?c - city) :precondition (and (at "
         "?t ?a) (in-city ?a ?c) (in-city ?b ?c)) :effect (and (not (at ?t ?a)) (at ?t ?b)))"
         " (:action fly :parameters (?t - plane ?a ?b - airport) :precondition (at ?t ?a) :effect "
         "(and (not (at ?t ?a)) (at ?t ?b))))"
         "(define (problem p) (:domain logistics) (:objects home shop - place north south - airport"
         " n s - city t1 t2 - truck jet - plane" +
         objects +
         " - package) (:init (in-city home n) (in-city north n) (in-city shop s) (in-city south s)"
         " (at t1 north) (at t2 south) (at jet south)" +
         init + ") (:goal (and" + goal + ")))";
}

TEST(Pddl, LogisticsOptima) {
  // Drives there and back, two flights, one drive; and six loads and unloads for each package.
  for (const int n : {1, 2, 3})
    EXPECT_EQ(optimum(pddl(logistics(n))), static_cast<std::uint64_t>(5 + 6 * n));
}

TEST(Pddl, ObserveAndOneof) {
  const Model m = pddl(
      "(define (domain wumpus) (:requirements :typing :contingent) (:types door)"
      " (:predicates (safe ?d - door) (out))"
      " (:action listen :parameters (?d - door) :observe (safe ?d))"
      " (:action leave :parameters (?d - door) :precondition (safe ?d) :effect (out)))"
      "(define (problem p) (:domain wumpus) (:objects a b c - door) (:init (oneof (safe a) (safe "
      "b))) (:goal (out)))");
  const Solution s = solved(m, Algorithm::BreadthFirst);
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(m, s.plan).leaves, 2U);
  EXPECT_EQ(measure(m, s.plan).longest, 2U);
}

TEST(Pddl, AVariableBeginsAWordOfItsOwn) {
  const Model m = pddl(
      "(define (domain d) (:requirements :strips :typing) (:types aircraft city)"
      " (:predicates (at?a - aircraft?c - city))"
      " (:action fly :parameters (?a - aircraft?b?c - city) :precondition (and (at?a?b))"
      " :effect (and (at?a?c) (not (at?a?b)))))"
      "(define (problem p) (:domain d) (:objects plane - aircraft x y - city) (:init (at plane x))"
      " (:goal (at plane y)))");
  EXPECT_EQ(optimum(m), 1U);
}

TEST(Pddl, APredicateNamedAllLeavesTheWorldClosed) {
  const std::string text =
      "(define (domain d) (:predicates (all) (p ?x)) (:action f :parameters (?x)"
      " :precondition (not (p ?x)) :effect (and (p ?x) (all))))"
      "(define (problem q) (:domain d) (:objects a b) (:init (p a)) (:goal (and (all) (p b))))";
  EXPECT_EQ(optimum(pddl(text)), 1U);
  const std::string kpl = convert({"t.pddl", text, Language::Pddl}, nullptr, Language::Kpl);
  EXPECT_EQ(optimum(model_of(kpl)), 1U);
}

TEST(Pddl, NamesWhatIsNotSupported) {
  const std::string head = "(define (domain d) (:requirements ";
  EXPECT_NE(complaint(head + ":durative-actions))", Language::Pddl)
                .find("unsupported requirement ':durative-actions'"),
            std::string::npos);
  for (const char* numeric : {":fluents", ":numeric-fluents", ":constraints", ":preferences"})
    EXPECT_NE(complaint(head + numeric + "))", Language::Pddl)
                  .find(std::string("unsupported requirement '") + numeric),
              std::string::npos);
  EXPECT_NE(complaint("(define (domain d) (:axiom (p) (q)))", Language::Pddl)
                .find("unsupported section ':axiom'"),
            std::string::npos);
  EXPECT_NE(complaint("(define (domain d)\n  (:predicates (p)", Language::Pddl)
                .find("bad.pddl:2:3: error: '(' is never closed"),
            std::string::npos);
}

/// A hoist stands in areas and lifts what is a crate or a box, no cart.
std::string storage(const std::string& more) {
  return "(define (domain storage) (:requirements :typing)"
         " (:types area thing - object crate box cart - thing)"
         " (:predicates (in ?x - (either area crate box) ?y - area) (up ?x - (either crate box))"
         "  (cart-in ?c - cart ?a - area))"
         " (:action lift :parameters (?x - (either crate box) ?a - area)"
         "  :precondition (in ?x ?a) :effect (and (up ?x) (not (in ?x ?a))))" +
         more +
         ")(define (problem p) (:domain storage) (:objects a b - area c - crate d - box e - cart)"
         " (:init (in a b) (in c a) (in d a) (cart-in e a))"
         " (:goal (forall (?x - (either crate box)) (up ?x))))";
}

TEST(Pddl, TypesOfEitherAreUnions) {
  const Model m = pddl(storage(""));
  EXPECT_EQ(optimum(m), 2U);
  const auto named = [](const Type& t) { return t.name == "either_crate_box"; };
  const auto type = std::find_if(m.types.begin(), m.types.end(), named);
  ASSERT_NE(type, m.types.end());
  EXPECT_EQ(type->objects.size(), 2U);
  EXPECT_EQ(std::count_if(m.types.begin(), m.types.end(), named), 1);
  // A problem may name the union of its domain again.
  const std::string text = storage("");
  const std::size_t at = text.find("(define (problem");
  const Text domain{"d.pddl", text.substr(0, at), Language::Pddl};
  const Text problem{"p.pddl", text.substr(at), Language::Pddl};
  EXPECT_EQ(optimum(load(domain, &problem)), 2U);
  // In kpl as in PDDL again.
  const std::string kpl = convert(domain, &problem, Language::Kpl);
  EXPECT_NE(kpl.find("either_crate_box = crate | box;"), std::string::npos);
  EXPECT_EQ(optimum(model_of(kpl)), 2U);
  EXPECT_EQ(optimum(pddl(convert({"t.kpl", kpl, Language::Kpl}, nullptr, Language::Pddl))), 2U);
}

TEST(Pddl, ATypeBelowObjectMayBeNamedAgainBelowAnother) {
  const auto text = [](const std::string& types) {
    return "(define (domain d) (:requirements :typing) (:types " + types +
           ") (:predicates (p ?x - surface)) (:action f :parameters (?x - area) :precondition ()"
           " :effect (p ?x)))"
           "(define (problem q) (:domain d) (:objects a - area) (:init) (:goal (p a)))";
  };
  EXPECT_EQ(optimum(pddl(text("surface area - object area crate - surface"))), 1U);
  EXPECT_EQ(optimum(pddl(text("surface - object area crate - surface area - object"))), 1U);
  EXPECT_NE(complaint(text("surface place - object area - place area - surface"), Language::Pddl)
                .find("type 'area' has two parents"),
            std::string::npos);
}

TEST(Pddl, TypesOfEitherAreChecked) {
  const auto refused = [](const std::string& action, const std::string& why) {
    EXPECT_NE(complaint(storage(action), Language::Pddl).find(why), std::string::npos)
        << complaint(storage(action), Language::Pddl);
  };
  // A cart is none of them, and what may be a cart may not be one.
  refused(" (:action f :parameters (?c - cart) :precondition (up ?c) :effect (up ?c))",
          "'c' is of type cart, expected either_crate_box");
  refused(" (:action f :parameters (?c - thing) :precondition () :effect (up ?c))",
          "'c' is of type thing, expected either_crate_box");
  refused(" (:action f :parameters (?c - (either)) :precondition () :effect (up ?c))",
          "expected a type, or (either TYPE ...)");
  refused(" (:action f :parameters (?c - (either crate bag)) :precondition () :effect (up ?c))",
          "unknown type 'bag'");
  refused(" (:constants f - (either crate box))", "(either ...) is not supported here");
  EXPECT_NE(complaint("types: a, b; u = a | b; v = u | a\npredicates: p\ngoal: K(p)")
                .find("'u' is a union of types itself"),
            std::string::npos);
  EXPECT_NE(complaint("types: a, b; u = a | b; v : u\npredicates: p\ngoal: K(p)")
                .find("'u' is a union of types: it has no subtypes"),
            std::string::npos);
  EXPECT_NE(complaint("types: a, b; u = a | b\nconstants: u x\npredicates: p\ngoal: K(p)")
                .find("a constant is of one"),
            std::string::npos);
}

TEST(Pddl, AStaticPredicateOfAMillionAtomsIsClosedOnlyWhereThatCanBeTold) {
  // sum(a, b, c) has 1.3 million atoms, of which 109 hold; nothing asks whether one is false.
  constexpr int kNumbers = 110;
  std::string objects, facts;
  for (int i = 0; i < kNumbers; ++i) {
    objects += " n" + std::to_string(i);
    if (i + 1 < kNumbers)
      facts += " (sum n" + std::to_string(i) + " n1 n" + std::to_string(i + 1) + ")";
  }
  const Text domain{"d.pddl",
                    "(define (domain d) (:predicates (at ?x) (sum ?x ?y ?z))\n(:action step "
                    ":parameters (?x ?y ?z) :precondition (and (at ?x) (sum ?x ?y ?z)) :effect "
                    "(and (not (at ?x)) (at ?z))))",
                    Language::Pddl};
  const auto outcome = [&](const std::string& from, const std::string& to, std::uint64_t steps) {
    const Text problem{"p.pddl",
                       "(define (problem p) (:domain d) (:objects" + objects + ") (:init (at " +
                           from + ")" + facts + ") (:goal (at " + to + ")))",
                       Language::Pddl};
    const Model model = load(domain, &problem);
    EXPECT_LT(model.initial.size(), 1000U);
    const Solution s = solved(model, Algorithm::Greedy);
    if (s.outcome == Outcome::Solved) {
      EXPECT_EQ(measure(model, s.plan).longest, steps);
    }
    return s.outcome;
  };
  EXPECT_EQ(outcome("n3", "n40", 37), Outcome::Solved);
  EXPECT_EQ(outcome("n40", "n3", 0), Outcome::Unsolvable) << "it is still a proof";
}

TEST(Pddl, AStaticPredicateOfManyAtomsNeedsNotToBeListed) {
  // of(a, b, c) has 27 million atoms, of which one holds and none can change.
  std::string objects;
  for (int i = 0; i < 300; ++i) objects += " x" + std::to_string(i);
  const std::string text =
      "(define (domain d) (:requirements :strips) (:predicates (of ?a ?b ?c) (p ?a))"
      " (:action f :parameters (?a ?b ?c) :precondition (and (of ?a ?b ?c) (p ?a))"
      "  :effect (p ?c)))(define (problem q) (:domain d) (:objects" +
      objects + ") (:init (of x0 x1 x2) (p x0)) (:goal (p x2)))";
  EXPECT_EQ(solved(pddl(text), Algorithm::Greedy).outcome, Outcome::Solved);
  // The table of its atoms is not made where there is no memory for it.
  SolveOptions little;
  little.max_memory = 100U << 20U;
  const Solution s = solve(pddl(text), little);
  EXPECT_EQ(s.outcome, Outcome::Limit);
  EXPECT_EQ(s.limit, "memory limit reached");
}

TEST(Pddl, ParametersOfAnActionAreLimited) {
  const auto text = [](int parameters) {
    std::string names, precondition;
    for (int i = 0; i < parameters; ++i) {
      names += " ?x" + std::to_string(i);
      precondition += " (p ?x" + std::to_string(i) + ")";
    }
    return "(define (domain d) (:requirements :strips) (:predicates (p ?a) (q))"
           " (:action f :parameters (" +
           names + ") :precondition (and" + precondition +
           ") :effect (q)))(define (problem r) (:domain d) (:objects a b) (:init (p a)) (:goal "
           "(q)))";
  };
  EXPECT_EQ(solved(pddl(text(24)), Algorithm::Greedy).outcome, Outcome::Solved);
  EXPECT_NE(complaint(text(65), Language::Pddl).find("more than 64 parameters"), std::string::npos);
}

TEST(Pddl, ManyParametersAreJoined) {
  // 30^9 instances, of which the road admits one for each place: found from the facts that hold.
  std::string objects, init;
  for (int i = 0; i < 30; ++i) {
    objects += " x" + std::to_string(i);
    if (i > 0) init += " (road x" + std::to_string(i - 1) + " x" + std::to_string(i) + ")";
  }
  const Model m = pddl(
      "(define (domain walk) (:requirements :strips :typing :negative-preconditions) (:types place)"
      " (:predicates (road ?a ?b - place) (at ?a - place) (closed ?a - place))"
      " (:action walk :parameters (?i ?h ?g ?f ?e ?d ?c ?b ?a - place)"
      "  :precondition (and (road ?a ?b) (road ?b ?c) (road ?c ?d) (road ?d ?e) (road ?e ?f) (road "
      "?f "
      "?g) (road ?g ?h) (road ?h ?i) (not (closed ?i)) (at ?a))"
      "  :effect (and (at ?b) (not (at ?a)))))"
      "(define (problem p) (:domain walk) (:objects" +
      objects + " - place) (:init (at x0) (closed x25)" + init + ") (:goal (at x17)))");
  const Solution s = solve(m, {Algorithm::Greedy, 0, 0, {}});
  ASSERT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(m, s.plan).longest, 17U);
  EXPECT_EQ(s.statistics.ground_actions, 17U);
}

TEST(Pddl, ATypeThatIsLeftOutIsMeantWhereObjectsAreOfIt) {
  const std::string domain =
      "(define (domain d) (:types obj) (:predicates (in ?o ?b) (full ?b)) (:action put :parameters "
      "(?o - obj ?b - bin) :effect (and (in ?o ?b) (full ?b))))";
  const auto problem = [](const std::string& type) {
    return "(define (problem p) (:domain d) (:objects a - obj b - " + type +
           ") (:init) (:goal (and (in a b) (full b))))";
  };
  const auto read = [&](const std::string& type) {
    const Text p{"p.pddl", problem(type), Language::Pddl};
    return load({"d.pddl", domain, Language::Pddl}, &p);
  };
  EXPECT_EQ(solved(read("bin"), Algorithm::Greedy).outcome, Outcome::Solved);
  EXPECT_THROW(read("bni"), Error);
  EXPECT_THROW(read("obj"), Error);
}

TEST(Pddl, SensorsAndInvariants) {
  // A traveller sees at each place whether the roads from there are open; one of two is.
  const Model m = pddl(
      "(define (domain ctp) (:requirements :typing :equality) (:types place road) (:predicates (on "
      "?p - place ?r - road) (open ?r - road) (at ?p - place)) (:action go :parameters (?p ?q - "
      "place ?r - road) :precondition (and (at ?p) (on ?p ?r) (on ?q ?r) (open ?r)) :effect (and "
      "(not (at ?p)) (at ?q))) (:sensor see :parameters (?p - place ?r - road) :condition (and (at "
      "?p) (on ?p ?r)) :sense (open ?r))) (define (problem p) (:domain ctp) (:objects a b - place "
      "r s - road) (:init (at a) (on a r) (on b r) (on a s) (on b s) (invariant (open r) (open s)) "
      "(invariant (not (open r)) (not (open s)))) (:hidden (open r)) (:goal (at b)))");
  const Solution s = solved(m, Algorithm::Greedy);
  EXPECT_EQ(s.outcome, Outcome::Solved);
  EXPECT_EQ(measure(m, s.plan).leaves, 2U);
}

TEST(Pddl, InvariantsThatHoldAnywayOpenNothing) {
  for (const char* law : {"", "(invariant (at a) (at b))", "(invariant (not (at b)) (at a))"}) {
    const Model m =
        pddl(std::string(
                 "(define (domain d) (:requirements :strips :typing) (:types place) (:constants "
                 "a b - place) (:predicates (at ?p - place) (open)) (:action look :parameters () "
                 ":precondition (at a) :observe (open)) (:action round :parameters () "
                 ":precondition (and (at a) (not (at b))) :effect (and (not (at a)) (at b)))) "
                 "(define (problem p) (:domain d) (:init ") +
             law + " (at a) (unknown (open))) (:goal (at b)))");
    EXPECT_EQ(solved(m, Algorithm::Greedy).outcome, Outcome::Solved) << law;
  }
}

}  // namespace
}  // namespace kaboum::plan::test
