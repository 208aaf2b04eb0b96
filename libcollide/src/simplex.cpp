// The point of a simplex nearest to the origin, by its Voronoi regions (C. Ericson: Real-time
// collision detection, 2005, §5.1, §9.5), from the products of its edges.

#include "simplex.h"

#include <cmath>

namespace kaboum::collide::detail {
namespace {

using geom::Vec3;

Face face_of(const Simplex& s, int i) {
  Face out;
  out.corner[0] = i;
  out.share[0] = 1;
  out.size = 1;
  out.point = s.vertex[i].w;
  return out;
}

Face face_of(const Simplex& s, int i, int j, double at) {
  Face out;
  out.corner[0] = i;
  out.corner[1] = j;
  out.share[0] = 1 - at;
  out.share[1] = at;
  out.size = 2;
  out.point = (1 - at) * s.vertex[i].w + at * s.vertex[j].w;
  return out;
}

Face nearest_of_segment(const Simplex& s, int i, int j) {
  const Vec3 e = s.vertex[j].w - s.vertex[i].w;
  const double along = -s.vertex[i].w.dot(e), length = e.squaredNorm();
  if (!(along > 0)) return face_of(s, i);
  if (!(along < length)) return face_of(s, j);
  return face_of(s, i, j, along / length);
}

Face nearest_of_edges(const Simplex& s, int i, int j, int k) {
  Face best = nearest_of_segment(s, i, j);
  for (const Face& face : {nearest_of_segment(s, j, k), nearest_of_segment(s, i, k)})
    if (face.point.squaredNorm() < best.point.squaredNorm()) best = face;
  return best;
}

/// Corners i < j < k, a, b, c below.
Face nearest_of_triangle(const Simplex& s, int i, int j, int k) {
  const Vec3 &a = s.vertex[i].w, &b = s.vertex[j].w, &c = s.vertex[k].w;
  const Vec3 ab = b - a, ac = c - a;
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
  // Towards the origin from a, from b, from c, along ab and along ac.
  const double b1 = -ab.dot(a), c1 = -ac.dot(a);
  if (b1 <= 0 && c1 <= 0) return face_of(s, i);
  const double b2 = b1 - bb, c2 = c1 - bc;
  if (b2 >= 0 && c2 <= b2) return face_of(s, j);
  const double to_c = bb * c1 - bc * b1;
  if (to_c <= 0 && b1 >= 0 && b2 <= 0) return face_of(s, i, j, b1 / bb);
  const double b3 = b1 - bc, c3 = c1 - cc;
  if (c3 >= 0 && b3 <= c3) return face_of(s, k);
  const double to_b = cc * b1 - bc * c1;
  if (to_b <= 0 && c1 >= 0 && c3 <= 0) return face_of(s, i, k, c1 / cc);
  const double all = bb * cc - bc * bc, to_a = all - to_b - to_c;
  if (to_a <= 0 && c2 >= b2 && b3 >= c3)
    return face_of(s, j, k, (c2 - b2) / ((c2 - b2) + (b3 - c3)));
  // Not where rounding was too large for it to be inside.
  if (!(to_a >= 0 && to_b >= 0 && to_c >= 0 && all > 0)) return nearest_of_edges(s, i, j, k);
  const double share = 1 / all;
  Face out;
  out.corner = {i, j, k, 0};
  out.share = {to_a * share, to_b * share, to_c * share, 0};
  out.size = 3;
  out.point = out.share[0] * a + out.share[1] * b + out.share[2] * c;
  return out;
}

Face nearest_of_tetrahedron(const Simplex& s) {
  const Vec3& d = s.vertex[3].w;
  const Vec3 a = s.vertex[0].w - d, b = s.vertex[1].w - d, c = s.vertex[2].w - d;
  // The origin's shares, of the corners opposite to the faces; negative beyond a face.
  const Vec3 n = b.cross(c);
  const double volume = n.dot(a), sign = volume < 0 ? -1 : 1;
  std::array<double, 4> share{-n.dot(d) * sign, -c.cross(a).dot(d) * sign,
                              -a.cross(b).dot(d) * sign, 0};
  share[3] = volume * sign - share[0] - share[1] - share[2];
  constexpr std::array<std::array<int, 3>, 4> kFaces{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};
  Face best;
  double least = 0;
  for (int opposite = 0; opposite < 4; ++opposite) {
    if (share[opposite] > 0 && volume != 0) continue;
    const auto& [i, j, k] = kFaces[opposite];
    const Face face = nearest_of_triangle(s, i, j, k);
    const double distance = face.point.squaredNorm();
    if (best.size > 0 && !(distance < least)) continue;
    least = distance;
    best = face;
  }
  if (best.size > 0) return best;
  const double sum = share[0] + share[1] + share[2] + share[3];
  best.size = 4;
  best.point = Vec3::Zero();
  for (int i = 0; i < 4; ++i) {
    best.share[i] = share[i] / sum;
    best.point += best.share[i] * s.vertex[i].w;
  }
  return best;
}

}  // namespace

Face nearest_face(const Simplex& s) {
  if (s.size == 4) return nearest_of_tetrahedron(s);
  if (s.size == 3) return nearest_of_triangle(s, 0, 1, 2);
  if (s.size == 2) return nearest_of_segment(s, 0, 1);
  return face_of(s, 0);
}

void keep(Simplex& s, const Face& face) {
  for (int i = 0; i < face.size; ++i) {
    s.share[i] = face.share[i];
    if (face.corner[i] != i) s.vertex[i] = s.vertex[face.corner[i]];
  }
  s.size = face.size;
}

}  // namespace kaboum::collide::detail
