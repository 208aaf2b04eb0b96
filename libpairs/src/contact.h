#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>
#include <kaboum/pairs/decide.h>

#include <memory>
#include <span>
#include <vector>

#include "gap.h"

namespace kaboum::pairs::detail {

/// A link's surface, ready to be asked.
class Surface {
 public:
  /// What is solid.
  enum class Solid {
    Wound,    ///< what closed parts wind about once at least
    ShutOff,  ///< that, and perhaps more of what triangles shut off from far away
  };
  explicit Surface(Mesh mesh, Solid solid = Solid::Wound);
  /// The triangles of another surface that have a corner farther than a distance from a point. What
  /// is solid and how far that is, the other one says; asked are corners farther than that only.
  Surface(const Surface& whole, const Vec3& point, double distance);
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const HullTree& tree() const { return tree_; }
  /// A vertex of each connected part; of a surface that was cut, every corner.
  [[nodiscard]] const std::vector<std::uint32_t>& parts() const { return parts_; }
  /// Vertices of triangles.
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }
  /// How often closed parts wind about a point.
  struct Winding {
    int sum = 0;       ///< 1 and more: the point is of the solid, whatever the other parts are
    bool any = false;  ///< one of them does, be it a cavity's
  };
  [[nodiscard]] Winding winding(const Vec3& point) const;
  /// Whether a point is seen not to be solid: by the winding number or, where more may be, by a
  /// ray of some that meets no triangle. @pre it is on no triangle
  enum class Place {
    Outside,
    Inside,   ///< of the solid, whatever more there is
    Unclear,  ///< parts wind against each other, or all the rays meet triangles
  };
  [[nodiscard]] Place place(const Vec3& point, std::size_t rays) const;
  [[nodiscard]] Solid solid() const { return solid_; }
  /// The distance of a point from the triangles, from below; 0 where it is seen to be no more than
  /// `least`.
  [[nodiscard]] double distance(const Vec3& point, double least) const;
  /// Distances from the triangles.
  [[nodiscard]] const std::shared_ptr<const geom::DistanceQuery>& query() const { return query_; }

 private:
  [[nodiscard]] bool sees_out(const Vec3& point, std::size_t rays) const;

  const Surface* whole_ = nullptr;  ///< that this was cut from
  Solid solid_;
  Mesh mesh_;
  HullTree tree_;
  std::shared_ptr<const geom::Bvh> bvh_;
  std::shared_ptr<const geom::DistanceQuery> query_;
  geom::WindingNumber winding_;
  std::vector<std::uint32_t> part_of_;  ///< each triangle's
  std::vector<char> closed_;            ///< each part
  std::vector<std::uint32_t> parts_, corners_;
};

/// Two surfaces in one configuration.
class Contact {
 public:
  Contact(const Surface& a, const Surface& b, const Chain& chain)
      : a_(&a), b_(&b), gaps_(a.tree(), b.tree(), chain) {}

  [[nodiscard]] const Gaps& gaps() const { return gaps_; }
  [[nodiscard]] const Surface& a() const { return *a_; }
  [[nodiscard]] const Surface& b() const { return *b_; }

  /// The distance of the surfaces, by their triangles; 0 where some meet.
  struct Nearest {
    double lower = 0, upper = 0;
    Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  ///< in the frame of a
  };
  /// @param box   of which only the middle is looked at
  /// @param gap   between lower and upper that will do [length]
  /// @param most_steps  after which it is given up; the bracket is wider then
  [[nodiscard]] Nearest nearest(const BoxMotion& box, double gap, std::size_t most_steps) const;

  /// How deep the solids are certainly in each other: no translation by less parts them. 0: not
  /// known to meet. Rounding is taken off.
  /// @param most_corners  of each that are looked for in the other solid
  /// @param most_triangles  of pairs of triangles
  [[nodiscard]] double depth_below(const BoxMotion& box, std::size_t most_corners = 1'500,
                                   std::size_t most_triangles = 1'500) const;
  /// A depth as depth_below has it, of the first place that is found to have one. 0: none was found
  /// in so many steps down the trees.
  [[nodiscard]] double some_depth(const BoxMotion& box, std::size_t most_steps) const;
  /// The length of a translation that parts them.
  [[nodiscard]] double depth_above(const BoxMotion& box) const;
  /// The same, longer mostly, of few directions.
  [[nodiscard]] double depth_above_roughly(const BoxMotion& box) const;
  /// Largest distance of a corner from a point, of triangles whose hulls meet. @param point  in the
  /// frames of a and b
  [[nodiscard]] double farthest_meeting(const BoxMotion& box, const Vec3& in_a,
                                        const Vec3& in_b) const;
  /// Whether a part of one mesh is in the other one's solid; a proof together with one that the
  /// surfaces do not meet here, by more than rounding.
  enum class Held {
    Nothing,  ///< no part is in the other's solid, whichever of those it may mean
    Part,     ///< one is in the solid
    Unclear,  ///< one is where parts wind against each other: in a cavity, or a mesh is inside out;
              ///< or it may be shut off
  };
  [[nodiscard]] Held held(const BoxMotion& box) const;

 private:
  /// Calls look(triangle of a, triangle of b) for pairs that are not clearly apart, until it says
  /// false, or after so many steps down the trees.
  template <typename Look>
  void visit_meeting(const BoxMotion& box, std::size_t most_steps, const Look& look) const;
  [[nodiscard]] double margin_of(const BoxMotion& box, std::uint32_t of_a,
                                 std::uint32_t of_b) const;
  [[nodiscard]] double pierced(const BoxMotion& box, std::size_t most_triangles) const;
  /// @param few  that the corners are taken of at once, before those are left out that are far
  [[nodiscard]] double inside(const BoxMotion& box, std::size_t most_corners, bool few) const;
  /// What rounding takes off a depth.
  [[nodiscard]] double rounding() const { return 4 * gaps_.error() + 0x1p-36 * gaps_.reach(); }

  const Surface *a_, *b_;
  Gaps gaps_;
};

}  // namespace kaboum::pairs::detail
