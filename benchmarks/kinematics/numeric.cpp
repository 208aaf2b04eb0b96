// Numeric inverse kinematics beside Orocos KDL's: how often a configuration within the limits is
// found, and in which time. Poses are those of random configurations within the limits.
#include <kaboum/kinematics/numeric.h>

#include <cstdio>
#include <ctime>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <numbers>

#include "arms.h"

namespace {

using namespace kaboum::test;

double seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seven axes as those of an anthropomorphic arm of 1.3 m.
DhArm seven_axes() {
  const double quarter = std::numbers::pi / 2;
  DhArm arm;
  arm.rows = {{0, .34, 0, -quarter}, {0, 0, 0, quarter}, {0, .4, 0, quarter}, {0, 0, 0, -quarter},
              {0, .4, 0, -quarter},  {0, 0, 0, quarter}, {0, .126, 0, 0}};
  return arm;
}

/// Six axes of no family: the wrist is offset.
DhArm offset_wrist() {
  DhArm arm = rv_6sl(true);
  arm.rows[3].a = 0.08;
  arm.rows[4].a = 0.05;
  return arm;
}

KDL::Chain chain_of(const DhArm& dh) {
  KDL::Chain chain;
  for (const Dh& r : dh.rows)
    chain.addSegment(
        KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::DH(r.a, r.alpha, r.d, r.theta)));
  return chain;
}

void compare(const char* name, const DhArm& dh, double limit, int poses) {
  Arm arm = arm_of(dh);
  for (Axis& axis : arm.axes) {
    axis.lower = -limit;
    axis.upper = limit;
  }
  const auto n = static_cast<unsigned>(arm.axes.size());
  const KDL::Chain chain = chain_of(dh);
  KDL::ChainFkSolverPos_recursive fk(chain);
  KDL::ChainIkSolverVel_pinv velocity(chain);
  KDL::JntArray lower(n), upper(n), start(n), found(n);
  for (unsigned i = 0; i < n; ++i) {
    lower(i) = -limit;
    upper(i) = limit;
  }
  KDL::ChainIkSolverPos_NR_JL newton(chain, lower, upper, fk, velocity, 100, 1e-9);
  KDL::ChainIkSolverPos_LMA lma(chain, 1e-9, 100);
  std::mt19937_64 random(1);
  double time[4] = {};
  int good[4] = {};
  for (int i = 0; i < poses; ++i) {
    const Transform target = kaboum::kinematics::forward(arm, random_joints(random, n, limit));
    const std::vector<double> first = random_joints(random, n, limit);
    KDL::Frame frame;
    for (int r = 0; r < 3; ++r) {
      frame.p(r) = target.translation[r];
      for (int c = 0; c < 3; ++c) frame.M(r, c) = target.linear(r, c);
    }
    for (unsigned k = 0; k < n; ++k) start(k) = first[k];
    const auto judge = [&](int which, double begin, bool done, const std::vector<double>& q) {
      time[which] += seconds() - begin;
      good[which] +=
          done && within_limits(arm, q) &&
          kaboum::kinematics::difference(kaboum::kinematics::forward(arm, q), target).position <
              1e-6;
    };
    const auto values = [&] {
      return std::vector<double>(found.data.data(), found.data.data() + n);
    };
    double begin = seconds();
    bool done = newton.CartToJnt(start, frame, found) >= 0;
    judge(0, begin, done, values());
    begin = seconds();
    done = lma.CartToJnt(start, frame, found) >= 0;
    judge(1, begin, done, values());
    NumericOptions options;
    options.first = first;
    options.starts = 1;
    for (int which = 2; which < 4; ++which) {
      begin = seconds();
      const auto ours = solve_numeric(arm, target, options);
      judge(which, begin, ours.has_value(), ours ? ours->q : first);
      options.starts = 50;
    }
  }
  const char* const solvers[] = {"KDL Newton-Raphson with limits", "KDL Levenberg-Marquardt",
                                 "ours, one start", "ours, 50 starts"};
  for (int which = 0; which < 4; ++which)
    std::printf("%-22s %-32s %6.2f %%  %8.1f us\n", name, solvers[which],
                100.0 * good[which] / poses, 1e6 * time[which] / poses);
}

}  // namespace

int main() {
  compare("RV-6SL", rv_6sl(true), 2.5, 1000);
  compare("six axes, offset wrist", offset_wrist(), 2.5, 1000);
  compare("seven axes", seven_axes(), 2.5, 1000);
}
