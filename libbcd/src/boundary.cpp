// Which parts of a mesh's triangles bound its solid: samples of the winding
// number beside them tell. docs/algorithms/convex-decomposition.md, "From
// inside".

#include "boundary.h"

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <array>
#include <limits>

namespace kaboum::bcd {
namespace {

using geom::Box3;
using geom::Triangle;

/// Halvings of a triangle, at most.
constexpr int kMostCuts = 24;
/// Samples are this share of the diagonal beside the triangle.
constexpr double kBeside = 1e-7;
/// Triangles that others cross are cut at least this small, as a share of the
/// diagonal.
constexpr double kCoarse = 0.05;

/// Whether two triangles meet; with `open`, in more than corners and sides, as
/// neighbours do. Those in one plane meet unless `open`.
bool meet(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t, bool open) {
  for (int turn = 0; turn < 2; ++turn) {
    const auto &edges = turn == 0 ? s : t, &face = turn == 0 ? t : s;
    std::array<int, 3> side{};
    for (std::size_t k = 0; k < 3; ++k)
      side[k] = static_cast<int>(geom::orient3d(face[0], face[1], face[2], edges[k]));
    if (side == std::array<int, 3>{0, 0, 0}) return !open;
    for (std::size_t k = 0; k < 3; ++k) {
      const int up = side[k], down = side[(k + 1) % 3];
      if (open ? up * down >= 0 : up * down > 0 || (up == 0 && down == 0)) continue;
      const Vec3 &p = edges[k], &q = edges[(k + 1) % 3];
      int least = 1, most = -1;
      for (std::size_t i = 0; i < 3; ++i) {
        const int of = static_cast<int>(geom::orient3d(p, q, face[i], face[(i + 1) % 3]));
        least = std::min(least, of);
        most = std::max(most, of);
      }
      if (open ? least == most && least != 0 : least * most >= 0) return true;
    }
  }
  return false;
}

/// Whether a part of triangle `whole` meets other triangles: neighbours, and
/// with `open` all, in more than corners and sides.
bool meets_another(const Mesh& mesh, const geom::Bvh& bvh, const Triangle& whole,
                   const std::array<Vec3, 3>& part, bool open) {
  Box3 box;
  for (const Vec3& p : part) box.extend(p);
  bool found = false;
  bvh.traverse(
      [&](const Box3& other) {
        return !found && (box.min.array() <= other.max.array()).all() &&
               (other.min.array() <= box.max.array()).all();
      },
      [&](std::uint32_t i) {
        if (found) return;
        const Triangle& t = mesh.triangles[i];
        std::size_t shared = 0;
        for (const std::uint32_t v : t) shared += std::count(whole.begin(), whole.end(), v);
        if (shared == 3) return;  // itself
        found = meet(part, {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]},
                     open || shared != 0);
      });
  return found;
}

/// Finds the parts of triangles, cut in halves, that bound the solid.
class BoundaryFinder {
 public:
  BoundaryFinder(const Mesh& mesh, const geom::WindingNumber& winding, double size,
                 std::optional<double> coarse)
      : mesh_(mesh), winding_(winding), size_(size), bvh_(mesh) {
    const double diagonal = geom::bounding_box(mesh).diagonal();
    step_ = kBeside * diagonal;
    coarse_ = std::max(size, coarse.value_or(kCoarse * diagonal));
    out_.mesh.vertices = mesh.vertices;
  }

  Boundary find(const std::vector<std::uint32_t>& doubtful) {
    std::vector<char> doubted(mesh_.triangles.size(), 0);
    for (const std::uint32_t t : doubtful) doubted[t] = 1;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& whole = mesh_.triangles[t];
      const bool crossed =
          doubted[t] == 0 && meets_another(mesh_, bvh_, whole, corners(whole), true);
      stack_.push_back({whole, 0});
      while (!stack_.empty()) {
        const Part part = stack_.back();
        stack_.pop_back();
        if (doubted[t] != 0)
          look_cautiously(whole, part);
        else
          look(part, crossed);
      }
    }
    return std::move(out_);
  }

 private:
  struct Part {
    Triangle t;
    int depth;
  };
  [[nodiscard]] std::array<Vec3, 3> corners(const Triangle& t) const {
    const auto& v = out_.mesh.vertices;
    return {v[t[0]], v[t[1]], v[t[2]]};
  }

  /// Its two halves are looked at next. @return false if it is not longer than
  /// `limit`.
  bool halve(const Part& part, double limit) {
    const std::array<Vec3, 3> v = corners(part.t);
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if ((v[(i + 1) % 3] - v[i]).norm() > (v[(k + 1) % 3] - v[k]).norm()) k = i;
    if (part.depth >= kMostCuts || !((v[(k + 1) % 3] - v[k]).norm() > limit)) return false;
    const auto middle = static_cast<std::uint32_t>(out_.mesh.vertices.size());
    out_.mesh.vertices.emplace_back(0.5 * v[k] + 0.5 * v[(k + 1) % 3]);
    Part first{part.t, part.depth + 1}, second = first;
    first.t[(k + 1) % 3] = middle;
    second.t[k] = middle;
    stack_.push_back(second);
    stack_.push_back(first);
    return true;
  }

  struct Samples {
    int taken = 0, open = 0;
    int least = std::numeric_limits<int>::max();  ///< winding number; 0 on a triangle
  };

  /// Looks beside places of the part, until the first that is open unless
  /// `all`. None if it has no area.
  Samples sample(const std::array<Vec3, 3>& v, bool all) {
    Samples found;
    const Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    if (!(n.squaredNorm() > 0.5)) return found;
    const Vec3 center = (v[0] + v[1] + v[2]) / 3;
    for (const Vec3& p : {center, Vec3(0.8 * v[0] + 0.2 * center), Vec3(0.8 * v[1] + 0.2 * center),
                          Vec3(0.8 * v[2] + 0.2 * center)}) {
      if (found.open > 0 && !all) break;
      ++found.taken;
      for (const double side : {step_, -step_}) {
        const Vec3 z = p + side * n;
        const auto w = winding_(z);
        found.least = std::min(found.least, w.value_or(0));
        if (!w || *w > 0) continue;
        out_.outside.push_back(z);
        ++found.open;
        break;
      }
    }
    return found;
  }

  /// @param crossed  by others: what bounds the solid is told to `size_` then
  void look(const Part& part, bool crossed) {
    const Samples found = sample(corners(part.t), crossed);
    const bool mixed = found.open > 0 && found.open < found.taken;
    if (crossed && halve(part, mixed ? size_ : coarse_)) return;
    if (found.open > 0 || found.taken == 0) out_.mesh.triangles.push_back(part.t);
  }

  /// A part that no other triangle meets is on one side of all of them: any
  /// place tells. Where one does, a tip beyond it may be missed by all samples,
  /// with a winding number lower by 1.
  void look_cautiously(const Triangle& whole, const Part& part) {
    const bool met = meets_another(mesh_, bvh_, whole, corners(part.t), false);
    if (met && halve(part, size_)) return;
    const Samples found = sample(corners(part.t), false);
    if (found.taken == 0 || found.least <= (met ? 1 : 0)) out_.mesh.triangles.push_back(part.t);
  }

  const Mesh& mesh_;
  const geom::WindingNumber& winding_;
  double size_, step_ = 0, coarse_ = 0;
  geom::Bvh bvh_;
  std::vector<Part> stack_;
  Boundary out_;
};

}  // namespace

Boundary boundary_of(const Mesh& mesh, const geom::WindingNumber& winding, double size,
                     const std::vector<std::uint32_t>& doubtful, std::optional<double> coarse) {
  return BoundaryFinder(mesh, winding, size, coarse).find(doubtful);
}

}  // namespace kaboum::bcd
