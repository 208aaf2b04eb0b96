// Closed splines of CAD files, bounded between parameters on both sides of where they start: every
// point by OpenCASCADE's own evaluator lies in the box of the hulls.

#include "exact_curve.h"

#include <gtest/gtest.h>
#include <Geom_BSplineCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>

#include <Eigen/Geometry>
#include <cmath>

namespace kaboum::io {
namespace {

constexpr int kPoles = 12;

/// A closed spline of 12 poles round the z-axis, no two parts of which are alike; it repeats with
/// the period 12, from the parameter `begin` on.
Handle(Geom_BSplineCurve) ring(double begin) {
  TColgp_Array1OfPnt poles(1, kPoles);
  TColStd_Array1OfReal knots(1, kPoles + 1);
  TColStd_Array1OfInteger times(1, kPoles + 1);
  times.Init(1);
  for (int i = 1; i <= kPoles; ++i) {
    const double angle = 2 * M_PI * i / kPoles, radius = 4 + i % 3 + 0.1 * i;
    poles(i) = gp_Pnt(radius * std::cos(angle), radius * std::sin(angle), std::sin(3 * angle));
  }
  for (int i = 1; i <= kPoles + 1; ++i) knots(i) = begin + i - 1;
  return new Geom_BSplineCurve(poles, knots, times, 3, true);
}

TEST(ExactCurve, AClosedSplineIsBoundedBeyondItsStart) {
  for (const double begin : {0.0, -7.5, 100.0}) {
    const Handle(Geom_BSplineCurve) curve = ring(begin);
    const auto exact = ExactCurve<3>::of(Handle(Geom_Curve)(curve));
    ASSERT_TRUE(exact.has_value());
    EXPECT_EQ(exact->period(), kPoles);
    for (double a = begin - 2 * kPoles; a < begin + 2 * kPoles; a += 0.75)
      for (const double length : {0.5, 3.0, 11.5, 12.0, 30.0}) {
        Eigen::AlignedBox3d box, whole;
        std::vector<Eigen::Vector3d> hull;
        for (const auto& [from, to] : exact->folded(a, a + length)) {
          EXPECT_LE(from, to);
          exact->add_hull(from, to, hull);
        }
        for (const Eigen::Vector3d& p : hull) box.extend(p);
        for (int i = 0; i <= 40; ++i) {
          const gp_Pnt p = curve->Value(a + length * i / 40);
          EXPECT_LT(box.exteriorDistance(Eigen::Vector3d(p.X(), p.Y(), p.Z())), 1e-9)
              << "at " << a + length * i / 40 << " of " << a << " to " << a + length;
        }
        // A part is not bounded by the whole.
        for (int i = 0; i < 60; ++i) {
          const gp_Pnt p = curve->Value(begin + 0.2 * i);
          whole.extend(Eigen::Vector3d(p.X(), p.Y(), p.Z()));
        }
        if (length < 1) {
          EXPECT_LT(box.sizes().norm(), 0.6 * whole.sizes().norm());
        }
      }
  }
}

}  // namespace
}  // namespace kaboum::io
