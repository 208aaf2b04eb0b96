// PDDL: problems of the usual kinds, written here, with optima known by construction.
#include "plan_test.h"

namespace kaboum::plan::test {
namespace {

Model pddl(const std::string& text) { return load({"t.pddl", text, Language::Pddl}, nullptr); }

std::uint64_t optimum(const Model& m) {
  const Solution s = solved(m, Algorithm::AStar);
  EXPECT_EQ(s.status, Status::Solved);
  EXPECT_EQ(solved(m, Algorithm::Greedy).status, Status::Solved);
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
  ASSERT_EQ(s.status, Status::Solved);
  const PlanSize size = measure(m, s.plan);
  EXPECT_EQ(size.longest, 10U);  // 6 loads and unloads, 3 drives, 1 flight
  EXPECT_EQ(size.cost, 6 + 3 * 2 + 10);
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
  ASSERT_EQ(s.status, Status::Solved);
  EXPECT_EQ(measure(m, s.plan).leaves, 2U);
  EXPECT_EQ(measure(m, s.plan).longest, 2U);
}

TEST(Pddl, NamesWhatIsNotSupported) {
  const std::string head = "(define (domain d) (:requirements ";
  EXPECT_NE(complaint(head + ":durative-actions))", Language::Pddl)
                .find("unsupported requirement ':durative-actions'"),
            std::string::npos);
  EXPECT_NE(complaint(head + ":derived-predicates))", Language::Pddl).find("':derived-predicates'"),
            std::string::npos);
  EXPECT_NE(complaint("(define (domain d) (:derived (p) (q)))", Language::Pddl)
                .find("unsupported section ':derived'"),
            std::string::npos);
  EXPECT_NE(complaint("(define (domain d)\n  (:predicates (p)", Language::Pddl)
                .find("bad.pddl:2:3: error: '(' is never closed"),
            std::string::npos);
}

}  // namespace
}  // namespace kaboum::plan::test
