// Integrals of polynomials of degree two over solids, in exact numbers: a closed surface's are sums
// over the tetrahedra of its triangles with the origin. docs/algorithms/inertia.md.

#include <kaboum/geom/moments.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Eigenvalues>

#include "exact_integrals.h"

namespace kaboum::geom {

using namespace exact_integrals;

namespace {

Bounds bounds_of(const Range& a) {
  return {CGAL::to_interval(a.lower).first, CGAL::to_interval(a.upper).second};
}

double middle_of(const Range& a) { return CGAL::to_double((a.lower + a.upper) / Rational(2)); }

/// π, to 2^-150.
const Range& pi() {
  static const Range value = [] {
    const Rational sum = Rational(3.141592653589793116) + Rational(1.224646799147353207e-16) +
                         Rational(-2.994769809718339666e-33);
    return widened(sum, Rational(0x1p-150));
  }();
  return value;
}

Integrals scaled(const Integrals& a, const Vec3& factors) {
  const std::array<Rational, 3> s{Rational(factors.x()), Rational(factors.y()),
                                  Rational(factors.z())};
  Rational volume = s[0] * s[1] * s[2];
  if (volume < 0) volume = -volume;
  Integrals out;
  out.one = Range(volume) * a.one;
  for (int i = 0; i < 3; ++i) out.first[i] = Range(volume * s[i]) * a.first[i];
  for (int p = 0; p < 6; ++p)
    out.second[p] = Range(volume * s[kPairs[p].first] * s[kPairs[p].second]) * a.second[p];
  return out;
}

Rational magnitude(const Range& a) { return std::max(a.upper, Rational(-a.lower)); }

Integrals turned(const Integrals& a, const Eigen::Matrix3d& linear) {
  if (linear.isIdentity(0)) return a;
  std::array<std::array<Rational, 3>, 3> r;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r[i][k] = Rational(linear(i, k));
  // The rotation that is meant differs by a matrix D of a norm of at most e: what D adds to R m and
  // to R M Rᵀ is bounded by norms of m and M, which sums of absolute values bound.
  const Rational e(3 * 0x1p-46);
  Rational first = 0, second = 0;
  for (const Range& x : a.first) first += e * magnitude(x);
  for (int p = 0; p < 6; ++p) second += Rational(p < 3 ? 3 : 6) * e * magnitude(a.second[p]);
  Integrals out;
  out.one = a.one;
  for (int i = 0; i < 3; ++i) {
    Range sum;
    for (int k = 0; k < 3; ++k) sum = sum + Range(r[i][k]) * a.first[k];
    out.first[i] = widened(sum, first);
  }
  for (int p = 0; p < 6; ++p) {
    const auto [i, k] = kPairs[p];
    Range sum;
    for (int m = 0; m < 3; ++m)
      for (int n = 0; n < 3; ++n) sum = sum + Range(r[i][m] * r[k][n]) * a.product(m, n);
    out.second[p] = widened(sum, second);
  }
  return out;
}

MassOf<Range> mass_of(const Integrals& a, const Range& density) {
  MassOf<Range> out;
  out.mass = density * a.one;
  const Range per_volume = inverse(a.one);
  for (int i = 0; i < 3; ++i) out.centre[i] = a.first[i] * per_volume;
  std::array<Range, 6> c;  // about the centre
  for (int p = 0; p < 6; ++p) {
    const auto [i, k] = kPairs[p];
    c[p] = density * (a.second[p] - a.first[i] * a.first[k] * per_volume);
    if (i == k && c[p].lower < 0) c[p].lower = 0;
  }
  for (int i = 0; i < 3; ++i) out.inertia[i] = c[(i + 1) % 3] + c[(i + 2) % 3];
  for (int p = 3; p < 6; ++p) out.inertia[p] = -c[p];
  return out;
}

Integrals middle_of(const Integrals& a) {
  const auto middle = [](const Range& x) { return Range((x.lower + x.upper) / Rational(2)); };
  Integrals out;
  out.one = middle(a.one);
  std::ranges::transform(a.first, out.first.begin(), middle);
  std::ranges::transform(a.second, out.second.begin(), middle);
  return out;
}

/// True if a body can have it: no main moment is above the sum of the others.
bool is_of_body(const MassOf<double>& m) {
  const auto& [xx, yy, zz, xy, xz, yz] = m.inertia;
  Eigen::Matrix3d inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> found(inertia, Eigen::EigenvaluesOnly);
  const Vec3& main = found.eigenvalues();
  return main[0] > 0 && main[0] + main[1] >= main[2];
}

template <class To, class Convert>
MassOf<To> converted(const MassOf<Range>& from, const Convert& convert) {
  MassOf<To> out;
  out.mass = convert(from.mass);
  std::ranges::transform(from.centre, out.centre.begin(), convert);
  std::ranges::transform(from.inertia, out.inertia.begin(), convert);
  return out;
}

}  // namespace

namespace {

/// Of a shape whose middle planes are planes of symmetry.
Integrals symmetric(const Range& one, const std::array<Range, 3>& squares) {
  Integrals out;
  out.one = one;
  std::ranges::copy(squares, out.second.begin());
  return out;
}

Integrals cylinder(const Rational& r, const Rational& l) {
  const Rational area = r * r, side = area * area * l / Rational(4);
  return symmetric(pi() * Range(area * l), {pi() * Range(side), pi() * Range(side),
                                            pi() * Range(area * l * l * l / Rational(12))});
}

}  // namespace

Moments::Moments() : numbers_(std::make_shared<const Numbers>()) {}

Moments Moments::of_box(const Vec3& edges) {
  const std::array<Rational, 3> e{Rational(edges.x()), Rational(edges.y()), Rational(edges.z())};
  const Rational volume = e[0] * e[1] * e[2];
  std::array<Range, 3> squares;
  for (int i = 0; i < 3; ++i) squares[i] = volume * e[i] * e[i] / Rational(12);
  Moments out;
  out.numbers_ = std::make_shared<const Numbers>(Numbers{symmetric(volume, squares), {}});
  return out;
}

Moments Moments::of_ellipsoid(const Vec3& half) {
  const std::array<Rational, 3> a{Rational(half.x()), Rational(half.y()), Rational(half.z())};
  const Range volume = pi() * Range(a[0] * a[1] * a[2] * Rational(4) / Rational(3));
  std::array<Range, 3> squares;
  for (int i = 0; i < 3; ++i) squares[i] = volume * Range(a[i] * a[i] / Rational(5));
  Moments out;
  out.numbers_ = std::make_shared<const Numbers>(Numbers{symmetric(volume, squares), {}});
  return out;
}

Moments Moments::of_cylinder(double radius, double length) {
  Moments out;
  out.numbers_ =
      std::make_shared<const Numbers>(Numbers{cylinder(Rational(radius), Rational(length)), {}});
  return out;
}

Moments Moments::of_capsule(double radius, double length) {
  const Rational r(radius), l(length);
  Integrals all = cylinder(r, l);
  // Half balls at the ends: ∫ (z + l/2)² over the upper one, twice; ∫ z over it is π r⁴ / 4.
  const Rational cube = r * r * r;
  const Range ball = pi() * Range(cube * Rational(4) / Rational(3));
  const Range square = ball * Range(r * r / Rational(5));
  all += symmetric(ball, {square, square,
                          square + pi() * Range(cube * r * l / Rational(2)) +
                              ball * Range(l * l / Rational(4))});
  Moments out;
  out.numbers_ = std::make_shared<const Numbers>(Numbers{all, {}});
  return out;
}

Moments Moments::scaled(const Vec3& factors) const {
  Moments out;
  out.numbers_ = std::make_shared<const Numbers>(Numbers{geom::scaled(numbers_->sum, factors),
                                                         geom::scaled(numbers_->surplus, factors),
                                                         numbers_->overlaps});
  return out;
}

Moments Moments::moved(const Transform& pose) const {
  const auto move = [&](const Integrals& a) {
    return shifted(turned(a, pose.linear), pose.translation);
  };
  Moments out;
  out.numbers_ = std::make_shared<const Numbers>(
      Numbers{move(numbers_->sum), numbers_->overlaps ? move(numbers_->surplus) : Integrals(),
              numbers_->overlaps});
  return out;
}

Moments& Moments::operator+=(const Moments& other) {
  Numbers sum = *numbers_;
  sum.sum += other.numbers_->sum;
  sum.surplus += other.numbers_->surplus;
  sum.overlaps = sum.overlaps || other.overlaps();
  numbers_ = std::make_shared<const Numbers>(std::move(sum));
  return *this;
}

void Moments::note_overlap(const Box3& box) {
  if (!geom::has_volume(box)) return;
  Numbers more = *numbers_;
  more.surplus += of_parts(box);
  more.overlaps = true;
  numbers_ = std::make_shared<const Numbers>(std::move(more));
}

bool Moments::overlaps() const { return numbers_->overlaps; }

bool Moments::has_volume() const { return numbers_->of_solid().one.lower > 0; }

namespace {

/// @param density_of  that of a volume
template <class DensityOf>
MassProperties properties_of(const Integrals& solid, const Integrals& sum,
                             const DensityOf& density_of) {
  const auto value_of = [&](const Integrals& a) {
    return converted<double>(mass_of(a, density_of(a.one)),
                             [](const Range& x) { return middle_of(x); });
  };
  MassProperties out{converted<Bounds>(mass_of(solid, density_of(solid.one)), bounds_of),
                     value_of(middle_of(solid))};
  if (!is_of_body(out.value)) out.value = value_of(middle_of(sum));
  out.is_of_body = is_of_body(out.value);
  return out;
}

}  // namespace

MassProperties Moments::with_density(double density) const {
  return properties_of(numbers_->of_solid(), numbers_->sum,
                       [density](const Range& /*volume*/) { return Range{Rational(density)}; });
}

MassProperties Moments::with_mass(double mass) const {
  const Range m{Rational(mass)};
  MassProperties out = properties_of(numbers_->of_solid(), numbers_->sum,
                                     [&](const Range& volume) { return m * inverse(volume); });
  out.bounds.mass = {mass, mass};
  out.value.mass = mass;
  return out;
}

}  // namespace kaboum::geom
