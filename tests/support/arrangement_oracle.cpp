#include "arrangement_oracle.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace kaboum::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Flat = Kernel::Point_2;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Default,
                                                            CGAL::Exact_intersections_tag>;

struct Piece {
  Kernel::Triangle_3 triangle;
  CGAL::Bbox_3 box;
  bool of_inner;
};

/// Directed edges by coordinates; opposite ones cancel.
using Key = std::tuple<double, double, double>;
using Edges = std::map<std::pair<Key, Key>, long>;

void add_edges(const geom::Mesh& mesh, long factor, Edges& edges) {
  const auto key = [&](std::uint32_t v) {
    const geom::Vec3& p = mesh.vertices.at(v);
    return Key{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
  };
  for (const geom::Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Key a = key(t[k]), b = key(t[(k + 1) % 3]);
      if (a < b) edges[{a, b}] += factor;
      if (b < a) edges[{b, a}] -= factor;
    }
  }
}

bool balanced(const Edges& edges) {
  return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

void add_pieces(const geom::Mesh& mesh, bool of_inner, std::vector<Piece>& pieces) {
  for (const geom::Triangle& t : mesh.triangles) {
    const auto point = [&](int k) {
      const geom::Vec3& p = mesh.vertices[t[k]];
      return Point(p.x(), p.y(), p.z());
    };
    const Point a = point(0), b = point(1), c = point(2);
    if (CGAL::collinear(a, b, c)) continue;
    const Kernel::Triangle_3 triangle(a, b, c);
    pieces.push_back({triangle, triangle.bbox(), of_inner});
  }
}

/// Winding numbers by exact lines in one of a few directions. Candidates for a crossing are found
/// by interval boxes of the triangles' projections along the direction.
class Lines {
 public:
  explicit Lines(const std::vector<Piece>& pieces) : pieces_(pieces) {
    for (const auto& d : {std::array{911, 1733, 5381}, std::array{4801, -1201, 3301},
                          std::array{-1907, 5801, 2203}, std::array{3001, 2003, -5711},
                          std::array{-7919, -1013, 1117}, std::array{613, -6427, -1871}}) {
      directions_.push_back({Vector(d[0], d[1], d[2]), {}});
    }
  }

  struct Pair {
    int inner = 0, outer = 0;
  };

  /// Winding numbers just beside p, which lies in the interior of a cell of the triangle `at`: on
  /// its positive side, then on its negative one. Only those of closed chains mean anything.
  std::array<Pair, 2> beside(const Point& p, std::size_t at) {
    for (Direction& d : directions_) {
      const int rise = CGAL::sign(d.vector * normal(at));
      if (rise == 0) continue;
      Pair ahead, behind;
      if (!cross(p, d, at, ahead, behind)) continue;
      return rise > 0 ? std::array{ahead, behind} : std::array{behind, ahead};
    }
    throw std::logic_error("no line in general position");
  }

 private:
  struct Box {
    double low_u, high_u, low_v, high_v;
  };
  struct Direction {
    Vector vector;
    std::vector<Box> boxes;
  };

  [[nodiscard]] Vector normal(std::size_t i) const {
    const Kernel::Triangle_3& t = pieces_[i].triangle;
    return CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
  }

  static Box project(const Point& p, const Vector& d) {
    const auto u = CGAL::to_interval(p.x() * d.z() - p.z() * d.x());
    const auto v = CGAL::to_interval(p.y() * d.z() - p.z() * d.y());
    return {u.first, u.second, v.first, v.second};
  }

  void prepare(Direction& d) const {
    if (!d.boxes.empty()) return;
    for (const Piece& piece : pieces_) {
      Box box = project(piece.triangle[0], d.vector);
      for (int k = 1; k < 3; ++k) {
        const Box b = project(piece.triangle[k], d.vector);
        box = {std::min(box.low_u, b.low_u), std::max(box.high_u, b.high_u),
               std::min(box.low_v, b.low_v), std::max(box.high_v, b.high_v)};
      }
      d.boxes.push_back(box);
    }
  }

  /// Signed crossings ahead of and behind p. @return false when the line meets an edge.
  bool cross(const Point& p, Direction& d, std::size_t at, Pair& ahead, Pair& behind) const {
    prepare(d);
    const Box box = project(p, d.vector);
    const Point q = p + d.vector;
    const Kernel::Triangle_3& own = pieces_[at].triangle;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Box& b = d.boxes[i];
      if (b.low_u > box.high_u || b.high_u < box.low_u || b.low_v > box.high_v ||
          b.high_v < box.low_v) {
        continue;
      }
      const Kernel::Triangle_3& t = pieces_[i].triangle;
      std::array<CGAL::Orientation, 3> turn{};
      for (int k = 0; k < 3; ++k) turn[k] = CGAL::orientation(p, q, t[k], t[(k + 1) % 3]);
      const bool some_left = std::count(turn.begin(), turn.end(), CGAL::POSITIVE) != 0;
      const bool some_right = std::count(turn.begin(), turn.end(), CGAL::NEGATIVE) != 0;
      if (some_left && some_right) continue;
      if (turn[0] == CGAL::ZERO || turn[1] == CGAL::ZERO || turn[2] == CGAL::ZERO) return false;
      const CGAL::Orientation height = CGAL::orientation(t[0], t[1], t[2], p);
      if (height == CGAL::ZERO) {
        // The interior of a cell: only triangles of the same plane can be there, and p is beside
        // them, on the side that the line leads to.
        if (!CGAL::coplanar(own[0], own[1], own[2], t[0]) ||
            !CGAL::coplanar(own[0], own[1], own[2], t[1]) ||
            !CGAL::coplanar(own[0], own[1], own[2], t[2])) {
          throw std::logic_error("a cell that another triangle cuts");
        }
        continue;
      }
      const int along = CGAL::sign(d.vector * normal(i));
      // Going along d, w falls by one where d points out of the triangle's front.
      const bool is_ahead = (height == CGAL::NEGATIVE) == (along > 0);
      Pair& side = is_ahead ? ahead : behind;
      (pieces_[i].of_inner ? side.inner : side.outer) += is_ahead ? along : -along;
    }
    return true;
  }

  const std::vector<Piece>& pieces_;
  std::vector<Direction> directions_;
};

/// A triangle's plane in two coordinates.
class Plane {
 public:
  explicit Plane(const Kernel::Triangle_3& t) : origin_(t[0]) {
    const Vector n = CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
    while (n[axis_] == 0) ++axis_;
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    slope_u_ = n[u] / n[axis_];
    slope_v_ = n[v] / n[axis_];
  }
  [[nodiscard]] Flat flat(const Point& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
  [[nodiscard]] Point lift(const Flat& p) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    std::array<Number, 3> x;
    x[u] = p.x();
    x[v] = p.y();
    x[axis_] = origin_[axis_] - slope_u_ * (p.x() - origin_[u]) - slope_v_ * (p.y() - origin_[v]);
    return {x[0], x[1], x[2]};
  }

 private:
  Point origin_;
  int axis_ = 0;
  Number slope_u_, slope_v_;
};

class Arrangement {
 public:
  explicit Arrangement(const std::vector<Piece>& pieces) : pieces_(pieces), lines_(pieces) {
    meeting_.resize(pieces.size());
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < pieces.size(); ++i) boxes.emplace_back(pieces[i].box, i);
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
      meeting_[a.info()].push_back(b.info());
      meeting_[b.info()].push_back(a.info());
    });
  }

  /// Decides all cells of triangle i.
  void look_at(std::size_t i, ArrangementVerdict& verdict) {
    const Kernel::Triangle_3& f = pieces_[i].triangle;
    const Plane plane(f);
    Delaunay cells;
    const std::array<Flat, 3> corner{plane.flat(f[0]), plane.flat(f[1]), plane.flat(f[2])};
    for (int k = 0; k < 3; ++k) cells.insert_constraint(corner[k], corner[(k + 1) % 3]);
    for (const std::size_t j : meeting_[i]) cut(cells, plane, f, pieces_[j].triangle, verdict);

    const CGAL::Orientation turn = CGAL::orientation(corner[0], corner[1], corner[2]);
    for (auto cell = cells.finite_faces_begin(); cell != cells.finite_faces_end(); ++cell) {
      const Flat centre = CGAL::centroid(cell->vertex(0)->point(), cell->vertex(1)->point(),
                                         cell->vertex(2)->point());
      if (CGAL::orientation(corner[0], corner[1], centre) != turn ||
          CGAL::orientation(corner[1], corner[2], centre) != turn ||
          CGAL::orientation(corner[2], corner[0], centre) != turn) {
        continue;
      }
      ++verdict.cells;
      const auto sides = lines_.beside(plane.lift(centre), i);
      for (const Lines::Pair& w : sides) {
        verdict.solid_faults += w.inner >= 1 && w.outer <= 0 ? 1 : 0;
        verdict.difference_faults += w.inner > w.outer ? 1 : 0;
      }
      if (pieces_[i].of_inner && sides[0].outer <= 0 && sides[1].outer <= 0) {
        ++verdict.surface_faults;
      }
    }
  }

 private:
  /// Inserts what `g` leaves on f's plane, as far as it matters for f.
  static void cut(Delaunay& cells, const Plane& plane, const Kernel::Triangle_3& f,
                  const Kernel::Triangle_3& g, ArrangementVerdict& verdict) {
    const auto on_plane = [&](const Point& p) {
      return CGAL::orientation(f[0], f[1], f[2], p) == CGAL::ZERO;
    };
    if (on_plane(g[0]) && on_plane(g[1]) && on_plane(g[2])) {
      if (!CGAL::do_intersect(f, g)) return;
      ++verdict.intersections;
      for (int k = 0; k < 3; ++k)
        cells.insert_constraint(plane.flat(g[k]), plane.flat(g[(k + 1) % 3]));
      return;
    }
    const auto meet = CGAL::intersection(f, g);
    if (!meet) return;
    ++verdict.intersections;
    if (const Point* p = boost::get<Point>(&*meet)) {
      cells.insert(plane.flat(*p));
    } else if (const Kernel::Segment_3* s = boost::get<Kernel::Segment_3>(&*meet)) {
      cells.insert_constraint(plane.flat(s->source()), plane.flat(s->target()));
    } else {
      throw std::logic_error("triangles of two planes that meet in an area");
    }
  }

  const std::vector<Piece>& pieces_;
  Lines lines_;
  std::vector<std::vector<std::size_t>> meeting_;
};

}  // namespace

ArrangementVerdict arrangement_verdict(const geom::Mesh& inner, const geom::Mesh& outer) {
  ArrangementVerdict verdict;
  Edges of_inner, of_outer, of_difference;
  add_edges(inner, 1, of_inner);
  add_edges(outer, 1, of_outer);
  add_edges(outer, 1, of_difference);
  add_edges(inner, -1, of_difference);
  verdict.inner_closed = balanced(of_inner);
  verdict.outer_closed = balanced(of_outer);
  verdict.same_border = balanced(of_difference);

  std::vector<Piece> pieces;
  add_pieces(inner, true, pieces);
  add_pieces(outer, false, pieces);
  Arrangement arrangement(pieces);
  for (std::size_t i = 0; i < pieces.size(); ++i) arrangement.look_at(i, verdict);

  if (verdict.inner_closed && verdict.outer_closed) verdict.solid = verdict.solid_faults == 0;
  if (verdict.same_border) verdict.difference = verdict.difference_faults == 0;
  if (verdict.outer_closed) verdict.surface = verdict.surface_faults == 0;
  return verdict;
}

geom::Mesh with_area(geom::Mesh mesh) {
  std::erase_if(mesh.triangles, [&](const geom::Triangle& t) {
    const auto point = [&](int k) {
      const geom::Vec3& p = mesh.vertices[t[k]];
      return Point(p.x(), p.y(), p.z());
    };
    return CGAL::collinear(point(0), point(1), point(2));
  });
  return mesh;
}

}  // namespace kaboum::test
