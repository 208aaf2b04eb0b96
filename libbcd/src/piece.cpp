// What of a solid lies in a cell, and what a plane leaves of it on either side. The claim that
// hulls of pieces cover the solid: docs/algorithms/convex-decomposition.md, "Cells".

#include "piece.h"

#include <algorithm>
#include <cmath>

namespace kaboum::bcd {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// Cut points by edge: open addressing on the pair of points.
class EdgeMap {
 public:
  explicit EdgeMap(std::size_t expected) {
    std::size_t size = 64;
    while (size < 3 * expected) size *= 2;
    slots_.assign(size, {kNone, kNone, kNone});
  }
  /// The entry of the pair (a < b), kNone when new.
  std::uint32_t& at(std::uint32_t a, std::uint32_t b) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    Slot& slot = find(a, b);
    if (slot.a == kNone) {
      slot.a = a;
      slot.b = b;
      ++used_;
    }
    return slot.value;
  }

 private:
  struct Slot {
    std::uint32_t a, b, value;
  };
  Slot& find(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = (std::uint64_t{a} << 32U | b) * 0x9E3779B97F4A7C15U;
    std::size_t i = (key >> 20U) & (slots_.size() - 1);
    while (slots_[i].a != kNone && (slots_[i].a != a || slots_[i].b != b))
      i = (i + 1) & (slots_.size() - 1);
    return slots_[i];
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size(), Slot{kNone, kNone, kNone});
    old.swap(slots_);
    for (const Slot& s : old)
      if (s.a != kNone) find(s.a, s.b) = s;
  }
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

/// Whether a corner is one of the solid's part in the cell, given a point a little inside the cell,
/// so that surfaces through the corner itself do not count.
bool corner_inside(const SolidField& solid, const Vec3& p) {
  if (!(p.array() > solid.box().min.array()).all() || !(p.array() < solid.box().max.array()).all())
    return false;
  return solid.contains(p);
}

}  // namespace

bool Piece::empty() const {
  return source.empty() && std::find(inside.begin(), inside.end(), 1) == inside.end();
}

std::vector<Vec3> Piece::hull_points() const {
  std::vector<Vec3> out = points;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (inside[i] != 0) out.push_back(cell.corners[i]);
  return out;
}

Piece whole(const SolidField& solid) {
  const Mesh& mesh = solid.mesh();
  Piece piece;
  piece.points = mesh.vertices;
  piece.exact.assign(piece.points.size(), 1);
  piece.start.push_back(0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    piece.corner.insert(piece.corner.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    piece.start.push_back(static_cast<std::uint32_t>(piece.corner.size()));
    piece.source.push_back(t);
  }
  // Wider than the solid: no corner lies in it.
  const Vec3 margin = Vec3::Constant(0.02 * solid.diagonal());
  piece.cell = Cell::of({solid.box().min - margin, solid.box().max + margin});
  piece.inside.assign(8, 0);
  return piece;
}

void classify(const Piece& piece, const Plane& plane, const SolidField& solid, double shift,
              std::vector<double>& height, std::vector<Side>& side) {
  height.resize(piece.points.size());
  for (std::size_t i = 0; i < height.size(); ++i) height[i] = plane.height(piece.points[i]);
  side.resize(piece.polygons());
  for (std::size_t f = 0; f < side.size(); ++f) {
    double low = height[piece.corner[piece.start[f]]], high = low;
    for (std::uint32_t k = piece.start[f] + 1; k < piece.start[f + 1]; ++k) {
      const double h = height[piece.corner[k]];
      low = std::min(low, h);
      high = std::max(high, h);
    }
    if (high > shift && low < -shift) {
      side[f] = Side::Both;
    } else if (high > shift || low < -shift) {
      side[f] = high > shift ? Side::Upper : Side::Lower;
    } else {
      const Triangle& t = solid.mesh().triangles[piece.source[f]];
      const auto& v = solid.mesh().vertices;
      side[f] = (v[t[1]] - v[t[0]]).cross(v[t[2]] - v[t[0]]).dot(plane.n) >= 0 ? Side::Lower
                                                                               : Side::Upper;
    }
  }
}

Piece clip(const Piece& piece, const Plane& plane, bool lower, double shift,
           const SolidField& solid, const std::vector<double>& height,
           const std::vector<Side>& side) {
  Piece out;
  out.start.push_back(0);
  std::vector<std::uint32_t> number(piece.points.size(), kNone);
  const Side mine = lower ? Side::Lower : Side::Upper;
  const double sign = lower ? 1 : -1;
  EdgeMap cuts(static_cast<std::size_t>(4 * std::sqrt(static_cast<double>(side.size()))));
  const auto keep = [&](std::uint32_t v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(out.points.size());
      out.points.push_back(piece.points[v]);
      out.exact.push_back(piece.exact[v]);
    }
    out.corner.push_back(number[v]);
  };
  for (std::size_t f = 0; f < side.size(); ++f) {
    if (side[f] != mine && side[f] != Side::Both) continue;
    const std::uint32_t first = piece.start[f], last = piece.start[f + 1];
    if (side[f] == mine) {
      for (std::uint32_t k = first; k < last; ++k) keep(piece.corner[k]);
    } else {
      for (std::uint32_t k = first; k < last; ++k) {
        const std::uint32_t a = piece.corner[k];
        const std::uint32_t b = piece.corner[k + 1 < last ? k + 1 : first];
        const double ha = sign * height[a] - shift, hb = sign * height[b] - shift;
        if (ha <= 0) keep(a);
        if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0)) {
          std::uint32_t& cut = cuts.at(std::min(a, b), std::max(a, b));
          if (cut == kNone) {
            cut = static_cast<std::uint32_t>(out.points.size());
            const double s = a < b ? ha / (ha - hb) : hb / (hb - ha);
            const Vec3 &p = piece.points[std::min(a, b)], &q = piece.points[std::max(a, b)];
            out.points.emplace_back(p + s * (q - p));
            out.exact.push_back(0);
          }
          out.corner.push_back(cut);
        }
      }
    }
    const std::size_t size = out.corner.size() - out.start.back();
    if (size < 3) {
      out.corner.resize(out.start.back());
      continue;
    }
    out.start.push_back(static_cast<std::uint32_t>(out.corner.size()));
    out.source.push_back(piece.source[f]);
  }
  out.cell = clip(piece.cell, plane, lower, shift);
  // Beyond the overlap, which neighbours' faces may lie in: a corner that touches them spans a pit.
  for (const Vec3& p : out.cell.inward(4 * shift))
    out.inside.push_back(corner_inside(solid, p) ? 1 : 0);
  return out;
}

}  // namespace kaboum::bcd
