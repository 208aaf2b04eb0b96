// Poses that singular configurations make: what made a pose is an answer, in a family, or it is
// said that the answer is not complete.
#include <gtest/gtest.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/numeric.h>
#include <kaboum/kinematics/solution_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <iostream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>

#include "arms.h"

namespace kaboum::test {
namespace {

constexpr double kHalfTurn = std::numbers::pi, kQuarter = kHalfTurn / 2;

struct NamedArm {
  const char* name;
  DhArm dh;
};

DhArm of_rows(std::vector<Dh> rows) {
  DhArm out;
  out.rows = std::move(rows);
  return out;
}

std::vector<NamedArm> arms() {
  std::vector<NamedArm> out;
  out.push_back({"UR5", of_rows({{0, .089159, 0, kQuarter},
                                 {0, 0, -.425, 0},
                                 {0, 0, -.39225, 0},
                                 {0, .10915, 0, kQuarter},
                                 {0, .09465, 0, -kQuarter},
                                 {0, .0823, 0, 0}})});
  out.push_back({"KR 120", of_rows({{0, -.675, .35, kQuarter},
                                    {0, 0, 1.15, 0},
                                    {-kQuarter, 0, -.041, -kQuarter},
                                    {0, -1, 0, kQuarter},
                                    {0, 0, 0, -kQuarter},
                                    {0, -.215, 0, kHalfTurn}})});
  out.push_back({"Puma 560", of_rows({{0, .67, 0, kQuarter},
                                      {0, 0, .4318, 0},
                                      {0, .15005, .0203, -kQuarter},
                                      {0, .4318, 0, kQuarter},
                                      {0, 0, 0, -kQuarter},
                                      {0, .06, 0, 0}})});
  // The wrist reaches axis 1, and folds into the shoulder.
  out.push_back({"folding", of_rows({{0, .3, 0, -kQuarter},
                                     {0, 0, .5, 0},
                                     {0, 0, 0, -kQuarter},
                                     {0, .5, 0, kQuarter},
                                     {0, 0, 0, kQuarter},
                                     {0, .1, 0, 0}})});
  out.push_back({"folding, beside axis 1", of_rows({{0, .3, .2, -kQuarter},
                                                    {0, 0, .5, 0},
                                                    {0, 0, .3, -kQuarter},
                                                    {0, .4, 0, kQuarter},
                                                    {0, 0, 0, kQuarter},
                                                    {0, .1, 0, 0}})});
  // Three parallel axes with the wrist on axis 1, links of one length, with and without what
  // follows them.
  for (const double beyond : {.09465, 0.0})
    out.push_back({"parallel, folding", of_rows({{0, .1, 0, kQuarter},
                                                 {0, 0, .4, 0},
                                                 {0, 0, .4, 0},
                                                 {0, 0, 0, kQuarter},
                                                 {0, beyond, 0, -kQuarter},
                                                 {0, .0823, 0, 0}})});
  out.push_back({"five axes", of_rows({{0, .147, .033, kQuarter},
                                       {kQuarter, 0, .155, 0},
                                       {0, 0, .135, 0},
                                       {kQuarter, 0, 0, kQuarter},
                                       {0, .2, 0, 0}})});
  out.push_back({"five axes, folding", of_rows({{0, .147, 0, kQuarter},
                                                {0, 0, .15, 0},
                                                {0, 0, .15, 0},
                                                {0, 0, 0, kQuarter},
                                                {0, .2, 0, 0}})});
  return out;
}

double angle_of(const ClosedForm& form, const std::vector<double>& q, std::size_t joint) {
  return form.sign[joint] * q[joint] + form.offset[joint];
}
void set_angle(const ClosedForm& form, std::vector<double>& q, std::size_t joint, double angle) {
  q[joint] = std::remainder(form.sign[joint] * (angle - form.offset[joint]), 2 * kHalfTurn);
}

enum Kinds : unsigned { kAligned = 1, kStraight = 2, kFolded = 4, kOnAxis = 8 };

/// Turns joint 2 so that the wrist is on axis 1. @return false: it does not reach it.
bool put_on_axis(const ClosedForm& form, std::vector<double>& q) {
  if (std::abs(form.lateral) > 1e-12) return false;
  using Complex = std::complex<double>;
  const Complex i(0, 1);
  Complex end = form.a2;
  if (form.family == Family::SphericalWrist) {
    end += form.forearm * std::exp(i * (angle_of(form, q, 2) + form.bend));
  } else {
    end += form.a3 * std::exp(i * angle_of(form, q, 2));
    end += (form.a4 - i * form.d5) * std::exp(i * (angle_of(form, q, 2) + angle_of(form, q, 3)));
  }
  const double cosine = -form.a1 / std::abs(end);
  if (!(std::abs(cosine) <= 1)) return false;
  set_angle(form, q, 1, std::acos(cosine) - std::arg(end));
  return true;
}

/// Turns joints 2 and 4 of five so that the wrist is on axis 1 and axis 5 along it.
bool put_upright_on_axis(const ClosedForm& form, std::vector<double>& q, bool flip) {
  if (std::abs(form.lateral) > 1e-12) return false;
  const double sum = flip ? kHalfTurn : 0, elbow = angle_of(form, q, 2);
  const std::complex<double> end = form.a2 + std::polar(form.a3, elbow);
  const double cosine = (-form.a1 - form.a4 * std::cos(sum)) / std::abs(end);
  if (!(std::abs(cosine) <= 1)) return false;
  const double shoulder = std::acos(cosine) - std::arg(end);
  set_angle(form, q, 1, shoulder);
  set_angle(form, q, 3, sum - shoulder - elbow);
  return true;
}

/// Makes a configuration singular, but for `off()`. @return false: the arm has none of that kind.
template <class Off>
bool make_singular(const ClosedForm& form, std::vector<double>& q, unsigned kinds, bool flip,
                   const Off& off) {
  const bool five = form.family == Family::FiveAxes;
  if ((kinds & kAligned) != 0) {
    if (five && (kinds & kOnAxis) == 0) return false;
    if (!five) set_angle(form, q, 4, (flip ? kHalfTurn : 0) + off());
  }
  const double bend = form.family == Family::SphericalWrist ? form.bend : 0;
  const double second = form.family == Family::SphericalWrist ? form.forearm : form.a3;
  if ((kinds & kStraight) != 0) set_angle(form, q, 2, -bend + off());
  if ((kinds & kFolded) != 0) {
    if (std::abs(form.a2 - second) > 1e-12) return false;
    set_angle(form, q, 2, kHalfTurn - bend + off());
  }
  if ((kinds & kOnAxis) != 0) {
    const bool upright = five && (kinds & kAligned) != 0;
    if (!(upright ? put_upright_on_axis(form, q, flip) : put_on_axis(form, q))) return false;
    q[1] += off();
  }
  return true;
}

void limit(Arm& arm, const std::vector<double>& q, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto room = [&] {
    const double kind = unit(random);
    return kind < 0.03 ? 0 : kind < 0.1 ? 1e-3 * unit(random) : 2 * unit(random);
  };
  const double wide = unit(random);
  for (std::size_t i = 0; i < q.size(); ++i) {
    arm.axes[i].lower = wide < 0.2 ? -2 * kHalfTurn : q[i] - room();
    arm.axes[i].upper = wide < 0.2 ? 2 * kHalfTurn : q[i] + room();
  }
}

bool reaches(const DhArm& dh, const Solution& s, const Transform& target, std::size_t n) {
  const PoseError error = difference(reference_pose(dh, {s.q.begin(), s.q.begin() + n}), target);
  return error.position < 1.01e-9 * reach(arm_of(dh)) && error.rotation < 1.01e-9;
}

/// How well a configuration that is made of numbers is known besides. [rad]
constexpr double kKnown = 1e-9;

/// A complete answer's solutions are known at least so well.
double known_to(const Solution& s) { return std::max(kKnown, std::min(s.accuracy, 1e-5)); }

/// Whether q is among the isolated solutions, or in the families' ranges.
bool holds(const SolutionSet& set, const std::vector<double>& q) {
  for (const Solution& s : set.isolated)
    if (turn_distance(s.q.data(), q) <= known_to(s)) return true;
  for (const SolutionFamily& family : set.families) {
    bool in = true;
    for (std::size_t k = 0; k < family.free.size() && in; ++k) {
      bool one = false;
      for (std::size_t r = 0; r < family.ranges.size(); ++r) {
        if (family.free.size() > 1 && r != k) continue;
        const JointRange& range = family.ranges[r];
        for (int turn = -2; turn <= 2; ++turn) {
          const double value = q[family.free[k]] + turn * 2 * kHalfTurn;
          one |= value > range.lower - 1.2e-5 && value < range.upper + 1.2e-5;
        }
      }
      in = one;
    }
    if (in) return true;
  }
  return false;
}

/// Whether q itself is returned, where its own values are what free joints keep.
bool returns(const SolutionSet& set, const std::vector<double>& q) {
  for (const Solution& s : set.isolated)
    if (turn_distance(s.q.data(), q) <= known_to(s)) return true;
  for (const SolutionFamily& family : set.families)
    for (const Solution& s : family.representatives)
      if (turn_distance(s.q.data(), q) < 1e-5) return true;
  return false;
}

/// So near that what is only nearly singular may be past it.
bool is_at_limit(const Arm& arm, const std::vector<double>& q) {
  for (std::size_t i = 0; i < q.size(); ++i)
    if (q[i] < arm.axes[i].lower + 1e-6 || q[i] > arm.axes[i].upper - 1e-6) return true;
  return false;
}

bool has_any(const Arm& arm, const SolutionSet& set, std::size_t n) {
  if (!set.families.empty()) return true;
  for (const Solution& s : set.isolated)
    if (nearest_copy(arm, std::span(s.q).first(n), std::vector<double>(n))) return true;
  return false;
}

/// KABOUM_TRIALS multiplies them.
int trials(int count) {
  const char* times = std::getenv("KABOUM_TRIALS");
  return count * (times != nullptr ? std::max(1, std::atoi(times)) : 1);
}

struct Count {
  int poses = 0, complete = 0, families = 0, empty = 0;
  std::map<std::string, int> reasons;

  void print(const std::string& what) const {
    std::cout << what << ": " << poses << " poses, " << complete << " complete, " << families
              << " with families, " << empty << " proved empty\n";
    for (const auto& [reason, times] : reasons)
      std::cout << "  " << times << ": " << reason << '\n';
  }
};

/// Poses of one arm that are `off` from singular ones; nullopt: by something else for each kind,
/// for some by nothing.
void attack(const NamedArm& named, std::optional<double> off, int trials, std::uint64_t seed,
            Count& count) {
  const DhArm& dh = named.dh;
  Arm arm = arm_of(dh);
  const auto form = recognise(arm);
  ASSERT_TRUE(form) << named.name;
  const std::size_t n = dh.rows.size();
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<unsigned> kinds(1, 15);
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> q = random_joints(random, n, kHalfTurn);
    const unsigned kind = kinds(random);
    if ((kind & kStraight) != 0 && (kind & kFolded) != 0) continue;
    const double side = random() % 2 == 0 ? 1 : -1;
    const auto some_off = [&] {
      if (off) return side * *off;
      std::uniform_real_distribution<double> power(-15, -3);
      return random() % 3 == 0 ? 0 : (random() % 2 == 0 ? 1 : -1) * std::pow(10, power(random));
    };
    if (!make_singular(*form, q, kind, random() % 2 == 0, some_off)) continue;
    const Transform target = reference_pose(dh, q);
    ClosedForm limited = *form;
    limit(limited.arm, q, random);
    std::ostringstream trace;
    trace.precision(17);
    trace << named.name << ", kind " << kind << ", trial " << trial << ", off " << off.value_or(-1);
    for (std::size_t i = 0; i < n; ++i)
      trace << "\n  " << q[i] << " in [" << limited.arm.axes[i].lower << ", "
            << limited.arm.axes[i].upper << "]";
    SCOPED_TRACE(trace.str());
    SolutionSetOptions options;
    const SolutionSet set = solve_set(limited, target, options);
    ++count.poses;
    count.complete += set.complete ? 1 : 0;
    if (!set.complete) ++count.reasons[set.reason];
    count.families += set.families.empty() ? 0 : 1;
    EXPECT_TRUE(holds(set, q) || !set.complete);
    EXPECT_EQ(set.complete, set.reason.empty());
    for (const Solution& s : set.isolated) EXPECT_TRUE(reaches(dh, s, target, n));
    for (const SolutionFamily& family : set.families) {
      EXPECT_FALSE(family.representatives.empty());
      for (const Solution& s : family.representatives) {
        EXPECT_TRUE(reaches(dh, s, target, n));
        for (std::size_t i = 0; i < n; ++i) {
          EXPECT_GE(s.q[i], limited.arm.axes[i].lower);
          EXPECT_LE(s.q[i], limited.arm.axes[i].upper);
        }
      }
    }
    std::copy(q.begin(), q.end(), options.solve.reference.begin());
    const SolutionSet near = solve_set(limited, target, options);
    EXPECT_TRUE(returns(near, q) || !near.complete || is_at_limit(limited.arm, q));
    options.limits = false;
    const SolutionSet all = solve_set(limited, target, options);
    EXPECT_TRUE(holds(all, q) || !all.complete);
    // Other limits: what is said to have nothing within them has nothing.
    limit(limited.arm, random_joints(random, n, kHalfTurn), random);
    options = {};
    const SolutionSet other = solve_set(limited, target, options);
    if (!other.complete || has_any(limited.arm, other, n)) continue;
    ++count.empty;
    NumericOptions numeric;
    numeric.starts = 4;
    numeric.bound = 1e-13;  // closed forms are as exact
    numeric.iterations = 60;
    if (const auto found = solve_numeric(limited.arm, target, numeric)) {
      Solution s;
      std::copy(found->q.begin(), found->q.end(), s.q.begin());
      EXPECT_FALSE(reaches(dh, s, target, n) && within_limits(limited.arm, found->q))
          << "numerically " << testing::PrintToString(found->q);
    }
  }
}

TEST(SolutionSet, WhatMadeASingularPoseIsInTheAnswer) {
  Count count;
  std::uint64_t seed = 1;
  for (const NamedArm& arm : arms()) attack(arm, 0, trials(200), seed++, count);
  EXPECT_GT(count.poses, 600);
  EXPECT_GT(count.complete, count.poses * 6 / 10);
  EXPECT_GT(count.families, count.poses / 2);
  EXPECT_GT(count.empty, count.poses / 10);
  count.print("singular");
}

TEST(SolutionSet, NearSingularPosesAreNeverCompleteWithoutWhatMadeThem) {
  std::uint64_t seed = 100;
  for (double off = 1e-4; off > 1e-15; off /= 10) {
    Count count;
    for (const NamedArm& arm : arms()) attack(arm, off, trials(20), seed++, count);
    count.print(std::to_string(std::log10(off)) + " from singular");
  }
}

TEST(SolutionSet, PosesNearSeveralSingularPlacesAreNeverCompleteWithoutWhatMadeThem) {
  std::uint64_t seed = 200;
  Count count;
  for (const NamedArm& arm : arms()) attack(arm, std::nullopt, trials(200), seed++, count);
  EXPECT_GT(count.poses, 600);
  EXPECT_GT(count.complete, count.poses / 10);
  count.print("nearly singular");
}

TEST(SolutionSet, RandomArms) {
  std::mt19937_64 random(5);
  Count count;
  for (int i = 0; i < trials(30); ++i)
    for (const Family family : {Family::SphericalWrist, Family::ParallelAxes, Family::FiveAxes})
      attack({name_of(family), random_arm(family, random)}, 0, 10, random(), count);
  EXPECT_GT(count.complete, count.poses * 3 / 4);
  count.print("random arms");
}

}  // namespace
}  // namespace kaboum::test
