// Winding number of a mesh at a point: signed crossings of a ray, with ties broken by symbolic
// perturbation.
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace kaboum::geom {
namespace {

/// Side of p = (x, y, z) with respect to the directed line a → b seen from above, given the exact
/// one. Zeros are broken as if p were at (x + ε, y + ε²); a pair of points with equal projection
/// has no sides and gives 0.
int perturbed_side(const Vec3& a, const Vec3& b, Sign s) {
  if (s != Sign::Zero) return static_cast<int>(s);
  // Derivative of (b−a)×(p−a) by p.x is −(b.y−a.y), by p.y it is b.x−a.x.
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  if (a.x() != b.x()) return b.x() > a.x() ? 1 : -1;
  return 0;
}

/// Exact test whether p, known to lie in the triangle's plane, lies in the triangle: it must in
/// each of the three axis projections that do not collapse the triangle.
bool on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  bool projected = false;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto side = [&](const Vec3& s, const Vec3& e, const Vec3& x) {
      return orient2d(s[u], s[v], e[u], e[v], x[u], x[v]);
    };
    const Sign turn = side(a, b, c);
    if (turn == Sign::Zero) continue;
    projected = true;
    const Sign away = turn == Sign::Positive ? Sign::Negative : Sign::Positive;
    if (side(a, b, p) == away || side(b, c, p) == away || side(c, a, p) == away) return false;
  }
  if (projected) return true;
  // A segment or a point: p must be collinear with it in all projections and within its box.
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto collinear = [&](const Vec3& s, const Vec3& e) {
      return orient2d(s[u], s[v], e[u], e[v], p[u], p[v]) == Sign::Zero;
    };
    if (!collinear(a, b) || !collinear(b, c) || !collinear(c, a)) return false;
  }
  Box3 box;
  box.extend(a);
  box.extend(b);
  box.extend(c);
  return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
}

}  // namespace

WindingNumber::WindingNumber(const Mesh& mesh, std::shared_ptr<const Bvh> hierarchy)
    : mesh_(mesh), bvh_(hierarchy ? std::move(hierarchy) : std::make_shared<const Bvh>(mesh)) {}

/// What a triangle is to the ray upwards from p.
struct WindingNumber::Hit {
  int crossing = 0;  ///< ±1: it is crossed
  bool on = false;   ///< p lies on it
};

WindingNumber::Hit WindingNumber::hit(const Vec3& p, std::uint32_t index) const {
  const Triangle& t = mesh_.triangles[index];
  const Vec3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
  if (p.z() > std::max({a.z(), b.z(), c.z()})) return {};
  // On different sides of two edges seen from above, p is neither below nor above the triangle.
  const Sign over_ab = orient2d(a.x(), a.y(), b.x(), b.y(), p.x(), p.y());
  const Sign over_bc = orient2d(b.x(), b.y(), c.x(), c.y(), p.x(), p.y());
  if (over_ab != Sign::Zero && over_bc != Sign::Zero && over_ab != over_bc) return {};
  const Sign over_ca = orient2d(c.x(), c.y(), a.x(), a.y(), p.x(), p.y());
  if (over_ca != Sign::Zero && ((over_ab != Sign::Zero && over_ab != over_ca) ||
                                (over_bc != Sign::Zero && over_bc != over_ca)))
    return {};
  Hit out;
  const Sign height = orient3d(a, b, c, p);
  out.on = height == Sign::Zero && on_triangle(a, b, c, p);
  const int ab = perturbed_side(a, b, over_ab);
  if (ab == 0 || perturbed_side(b, c, over_bc) != ab || perturbed_side(c, a, over_ca) != ab)
    return out;
  // The ray crosses the triangle's interior, or p is on its plane. The normal points up when
  // the projection is counter-clockwise; p is below the triangle when it is on the side away
  // from an upward normal.
  const Sign below = ab > 0 ? Sign::Negative : Sign::Positive;
  if (height == below) out.crossing = ab;
  return out;
}

namespace {

/// Whether the ray upwards from p meets the box.
bool meets(const Box3& box, const Vec3& p) {
  return p.z() <= box.max.z() && p.x() >= box.min.x() && p.x() <= box.max.x() &&
         p.y() >= box.min.y() && p.y() <= box.max.y();
}

/// Tells the triangles that are met again, in hierarchies in which they are several times.
class Once {
 public:
  Once(const Bvh& bvh, const Mesh& mesh) : needed_(bvh.order().size() > mesh.triangles.size()) {}
  bool first(std::uint32_t triangle) {
    if (!needed_) return true;
    if (std::find(seen_.begin(), seen_.end(), triangle) != seen_.end()) return false;
    seen_.push_back(triangle);
    return true;
  }

 private:
  bool needed_;
  std::vector<std::uint32_t> seen_;  // few: those that the ray crosses
};

}  // namespace

std::optional<int> WindingNumber::weighted(const Vec3& p,
                                           std::span<const std::int8_t> weight) const {
  int winding = 0;
  bool on_surface = false;
  Once once(*bvh_, mesh_);
  bvh_->traverse([&](const Box3& box) { return !on_surface && meets(box, p); },
                 [&](std::uint32_t index) {
                   const int factor = weight.empty() ? 1 : weight[index];
                   if (factor == 0 || on_surface) return;
                   const Hit h = hit(p, index);
                   on_surface = h.on;
                   if (h.crossing != 0 && once.first(index)) winding += factor * h.crossing;
                 });
  if (on_surface) return std::nullopt;
  return winding;
}

void WindingNumber::crossings(const Vec3& p,
                              const std::function<void(std::uint32_t, int)>& visit) const {
  Once once(*bvh_, mesh_);
  bvh_->traverse([&](const Box3& box) { return meets(box, p); },
                 [&](std::uint32_t index) {
                   const Hit h = hit(p, index);
                   if ((!h.on && h.crossing == 0) || !once.first(index)) return;
                   if (h.on) visit(index, 0);
                   if (h.crossing != 0) visit(index, h.crossing);
                 });
}

}  // namespace kaboum::geom
