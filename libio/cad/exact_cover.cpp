// How far the exact faces and edges of a shape may be from its triangles: proved, not measured.
// docs/algorithms/cad.md has the proof.
//
// The triangles of a face lie in its plane of parameters too. Their border there and the curves
// that bound the face (pcurves) differ by slivers. Triangles and slivers together hold every
// parameter of the face, as winding numbers say, whatever the triangles look like. Each such piece
// is convex: a bound of second derivatives and the distances of its corners bound the distance of
// its whole surface from one triangle. Pieces are halved where that is not enough, and triangles
// where the surface really is too far away.

#include "exact_cover.h"

#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <unordered_map>

#include "exact_curve.h"
#include "exact_surface.h"

namespace kaboum::io {
namespace {

using geom::Vec3;

constexpr int kRounds = 30;          ///< of making triangles finer
constexpr int kFlips = 20;           ///< passes of turning sides in each of these rounds
constexpr int kHalvings = 40;        ///< of a piece
constexpr int kHalvingsBetween = 6;  ///< while triangles are still made finer
constexpr double kRounding = 1e-11;  ///< of all evaluations, as a share of the largest coordinate
constexpr double kSlack = 1.25;      ///< a bound may be this many times a distance that is there
constexpr double kHelpful = 0.1;     ///< share of the wish that a side has to bend, to be halved
constexpr int kAreaParts = 4;        ///< of a triangle's sides, where areas are bounded
constexpr double kGap = 0.25;        ///< share of the wish that edges may be beside their faces
/// Pieces that are halved, for each triangle and on top of that; then bounds stay as they are.
constexpr std::size_t kPiecesPerTriangle = 40, kMorePieces = 400'000;
/// Triangles that are made, in those that there were and on top of that.
constexpr std::size_t kMoreTimes = 4, kMoreTriangles = 50'000;

Vec3 vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0;
  return (p - a - t * ab).norm();
}

using Corners = std::array<Vec3, 3>;

double distance_to_triangle(const Vec3& p, const Corners& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double twice = n.norm();
  bool above = twice > 0;
  for (int i = 0; i < 3 && above; ++i) above = n.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) >= 0;
  if (above) return std::abs(n.dot(p - t[0])) / twice;
  return std::min({distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]),
                   distance_to_segment(p, t[2], t[0])});
}

/// Tree of boxes round a face's triangles, built when it is asked first.
class NearTriangles {
 public:
  using Of = std::function<Corners(std::size_t)>;
  NearTriangles(Of of, std::size_t count) : of_(std::move(of)), count_(count) {}

  struct Nearest {
    std::size_t triangle = 0;
    double distance = std::numeric_limits<double>::infinity();
  };
  Nearest operator()(const Vec3& p) {
    if (nodes_.empty()) build();
    Nearest out;
    search(0, p, out);
    return out;
  }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t begin = 0, end = 0, left = 0;  ///< left: 0 of leaves; the right one follows it
  };

  void build() {
    corners_.resize(count_);
    order_.resize(count_);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    for (std::size_t t = 0; t < count_; ++t) corners_[t] = of_(t);
    nodes_.push_back({{}, 0, count_, 0});
    for (std::size_t i = 0; i < nodes_.size(); ++i) divide(i);
  }
  void divide(std::size_t i) {
    Eigen::AlignedBox3d box, middles;
    for (std::size_t k = nodes_[i].begin; k < nodes_[i].end; ++k) {
      const Corners& c = corners_[order_[k]];
      for (const Vec3& p : c) box.extend(p);
      middles.extend((c[0] + c[1] + c[2]) / 3);
    }
    nodes_[i].box = box;
    const std::size_t begin = nodes_[i].begin, end = nodes_[i].end;
    if (end - begin <= 4) return;
    int axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t k) {
      return order_.begin() + static_cast<std::ptrdiff_t>(k);
    };
    std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
      const auto key = [&](std::size_t t) {
        return corners_[t][0][axis] + corners_[t][1][axis] + corners_[t][2][axis];
      };
      return key(a) < key(b);
    });
    nodes_[i].left = nodes_.size();
    nodes_.push_back({{}, begin, middle, 0});
    nodes_.push_back({{}, middle, end, 0});
  }
  void search(std::size_t i, const Vec3& p, Nearest& out) const {
    const Node& node = nodes_[i];
    if (node.left == 0) {
      for (std::size_t k = node.begin; k < node.end; ++k) {
        const double d = distance_to_triangle(p, corners_[order_[k]]);
        if (d < out.distance) out = {order_[k], d};
      }
      return;
    }
    const double left = nodes_[node.left].box.exteriorDistance(p),
                 right = nodes_[node.left + 1].box.exteriorDistance(p);
    const std::size_t first = node.left + (right < left ? 1 : 0);
    const std::size_t second = node.left + (right < left ? 0 : 1);
    if (std::min(left, right) < out.distance) search(first, p, out);
    if (std::max(left, right) < out.distance) search(second, p, out);
  }

  Of of_;
  std::size_t count_;
  std::vector<Corners> corners_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

/// A convex polygon of parameters.
using Piece = std::vector<Vec2>;

Box2 box_of(const Piece& piece) {
  Box2 box;
  for (const Vec2& p : piece) box.extend(p);
  return box;
}

/// Its part where sign * (coordinate - at) <= 0.
Piece clipped(const Piece& piece, int axis, double at, double sign) {
  Piece out;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const Vec2 &p = piece[i], &q = piece[(i + 1) % piece.size()];
    const double dp = sign * (p[axis] - at), dq = sign * (q[axis] - at);
    if (dp <= 0) out.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      Vec2 x = p + (q - p) * (dp / (dp - dq));
      x[axis] = at;
      out.push_back(x);
    }
  }
  return out;
}

/// The hull of points, in order.
Piece hull_of(Piece points) {
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  const auto right = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() <= 0;
  };
  Piece out;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = out.size();
    for (const Vec2& p : points) {
      while (out.size() >= base + 2 && right(out[out.size() - 2], out.back(), p)) out.pop_back();
      out.push_back(p);
    }
    out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

/// An edge of the shape, and the points of the mesh on it.
struct Line {
  std::optional<ExactCurve<3>> curve;  ///< none of edges that are a point, or only in surfaces
  bool point = false;                  ///< the edge is one point
  std::vector<double> t;
  std::vector<std::uint32_t> points;
  std::vector<double> bounds;  ///< of its pieces; below 0: not looked at
  std::vector<char> split;     ///< pieces to be halved after this round
  std::string name;

  /// Piece i becomes two.
  void halve(std::size_t i, double middle, std::uint32_t at) {
    const auto place = static_cast<std::ptrdiff_t>(i) + 1;
    t.insert(t.begin() + place, middle);
    points.insert(points.begin() + place, at);
    bounds[i] = -1;
    bounds.insert(bounds.begin() + place, -1);
  }
};

/// An edge where it bounds a face.
struct Border {
  int edge = 0;
  bool reversed = false, inner = false;
  ExactCurve<2> curve;
  std::vector<int> nodes;  ///< by the parameters of its line
};

struct FaceMesh {
  std::unique_ptr<ExactSurface> surface;
  std::vector<Vec2> uv;              ///< of nodes
  std::vector<std::uint32_t> point;  ///< of nodes
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> bounds;  ///< of triangles that need no others; below 0: not known
  std::vector<char> far;       ///< triangles to be made finer after this round
  std::vector<Border> borders;
  bool reversed = false;
  bool settled = false;  ///< looked at, and nothing has changed since
  double bound = 0;
  std::string name;
};

using Pair = std::pair<int, int>;

class Cover {
 public:
  Cover(const TopoDS_Shape& shape, double wish, double most) : wish_(wish), most_(most) {
    TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
    lines_.resize(static_cast<std::size_t>(edges_.Extent()) + 1);
    corner_.assign(static_cast<std::size_t>(vertices_.Extent()) + 1, kNone);
  }

  void add(const TopoDS_Face& face) {
    faces_.emplace_back();
    FaceMesh& f = faces_.back();
    f.name = "face " + std::to_string(faces_.size() + result_.bare_faces);
    TopLoc_Location location;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull() || mesh->NbTriangles() == 0 || !mesh->HasUVNodes()) {
      ++result_.bare_faces;
      faces_.pop_back();
      return;
    }
    std::string kind;
    f.surface = ExactSurface::of(BRep_Tool::Surface(face), kind);
    if (f.surface == nullptr)
      throw std::runtime_error(f.name + ": surfaces of its kind (" + kind + ") cannot be bounded");
    f.reversed = face.Orientation() == TopAbs_REVERSED;
    const int nodes = mesh->NbNodes();
    f.point.assign(nodes, kNone);
    for (int i = 1; i <= nodes; ++i) {
      const gp_Pnt2d uv = mesh->UVNode(i);
      f.uv.emplace_back(uv.X(), uv.Y());
    }
    const auto place = [&](int node) {
      return vector_of(mesh->Node(node + 1).Transformed(location.Transformation()));
    };
    add_borders(face, mesh, location, place);
    for (int i = 0; i < nodes; ++i)
      if (f.point[i] == kNone) f.point[i] = new_point(place(i));
    for (int t = 1; t <= mesh->NbTriangles(); ++t) {
      std::array<int, 3> n{};
      mesh->Triangle(t).Get(n[0], n[1], n[2]);
      f.triangles.push_back({n[0] - 1, n[1] - 1, n[2] - 1});
    }
    f.bounds.assign(f.triangles.size(), -1);
    if (!is_filled(f)) throw std::runtime_error(f.name + ": its triangles do not fill its border");
  }

  ExactCover run() {
    if (result_.bare_faces > 0) return std::move(result_);
    const std::size_t before = count_triangles();
    pieces_left_ = kPiecesPerTriangle * before + kMorePieces;
    bound_gaps();
    if (result_.gap > most_)
      throw std::runtime_error(result_.widest + ": its curve can only be said to be within " +
                               std::to_string(result_.gap) + " mm of the face");
    // Where edges are beside their faces, finer triangles come no nearer to both.
    wish_ = std::max(wish_, 2 * result_.gap);
    pieces_left_ = kPiecesPerTriangle * before + kMorePieces;
    for (int round = 0;; ++round) {
      most_halvings_ = round == 0 || !refine_ ? kHalvings : kHalvingsBetween;
      refine_ =
          refine_ && round < kRounds && count_triangles() <= kMoreTimes * before + kMoreTriangles;
      bound_edges();
      bool settled = true;
      for (FaceMesh& f : faces_) {
        if (!f.settled) bound_face(f);
        settled = settled && f.settled;
      }
      if (!refine_) break;
      if (make_finer()) continue;
      if (settled) break;
      refine_ = false;  // once more, to bound what cannot be made finer
    }
    deliver();
    return std::move(result_);
  }

 private:
  static constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);

  std::uint32_t new_point(const Vec3& p) {
    result_.points.push_back(p);
    largest_ = std::max(largest_, p.cwiseAbs().maxCoeff());
    return static_cast<std::uint32_t>(result_.points.size() - 1);
  }
  [[nodiscard]] const Vec3& point(std::uint32_t i) const { return result_.points[i]; }
  [[nodiscard]] Corners corners(const FaceMesh& f, std::size_t t) const {
    const auto& n = f.triangles[t];
    return {point(f.point[n[0]]), point(f.point[n[1]]), point(f.point[n[2]])};
  }
  [[nodiscard]] std::size_t count_triangles() const {
    std::size_t sum = 0;
    for (const FaceMesh& f : faces_) sum += f.triangles.size();
    return sum;
  }

  // --- taking over the mesh of OpenCASCADE ---

  /// The point of a vertex: one for all that end there.
  std::uint32_t corner(const TopoDS_Vertex& vertex) {
    std::uint32_t& known = corner_[vertices_.FindIndex(vertex)];
    if (known == kNone) known = new_point(vector_of(BRep_Tool::Pnt(vertex)));
    return known;
  }

  template <class Place>
  void add_borders(const TopoDS_Face& given, const Handle(Poly_Triangulation) & mesh,
                   const TopLoc_Location& location, const Place& place) {
    FaceMesh& f = faces_.back();
    const TopoDS_Face face = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(at.Current());
      const int index = edges_.FindIndex(edge);
      Line& line = lines_[index];
      line.name = "edge " + std::to_string(index);
      Handle(Poly_PolygonOnTriangulation) polygon =
          BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
      if (polygon.IsNull() || polygon->Parameters().IsNull())
        throw std::runtime_error(line.name + " of " + f.name + " has no points");
      if (line.t.empty()) add_line(line, edge, *polygon);
      Border border = border_of(edge, face, line, f.name);
      border.edge = index;
      // Of a seam's two polygons, the mesher may have named either first.
      const Handle(Poly_PolygonOnTriangulation) other =
          BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Reversed()), mesh, location);
      if (other != polygon && !other.IsNull() && other->NbNodes() == polygon->NbNodes() &&
          off(f, border, line, *other) < off(f, border, line, *polygon))
        polygon = other;
      const Handle(TColStd_HArray1OfReal) t = polygon->Parameters();
      bool same = static_cast<int>(line.t.size()) == polygon->NbNodes();
      for (int i = 0; i < polygon->NbNodes() && same; ++i) {
        same = std::abs(t->Value(t->Lower() + i) - line.t[i]) <= 1e-9 * (1 + std::abs(line.t[i]));
        const int node = polygon->Node(i + 1) - 1;
        border.nodes.push_back(node);
        if (line.points[i] == kNone) line.points[i] = new_point(place(node));
        f.point[node] = line.points[i];
      }
      if (!same)
        throw std::runtime_error(line.name + " has other points on " + f.name + " than elsewhere");
      f.borders.push_back(std::move(border));
    }
  }

  /// How far nodes are from where the edge's curve has them, in parameters.
  static double off(const FaceMesh& f, const Border& border, const Line& line,
                    const Poly_PolygonOnTriangulation& polygon) {
    double sum = 0;
    for (int i = 0; i < polygon.NbNodes() && i < static_cast<int>(line.t.size()); ++i)
      sum += (f.uv[polygon.Node(i + 1) - 1] - border.curve.value(line.t[i])).norm();
    return sum;
  }

  static void check_range(const Line& line, std::pair<double, double> domain,
                          const std::string& what) {
    if (!std::isfinite(domain.first)) return;
    const double slack = 1e-9 * (1 + std::abs(domain.first) + std::abs(domain.second));
    if (line.t.front() < domain.first - slack || line.t.back() > domain.second + slack)
      throw std::runtime_error(line.name + " is longer than " + what);
  }

  static Border border_of(const TopoDS_Edge& edge, const TopoDS_Face& face, const Line& line,
                          const std::string& name) {
    Border out;
    out.reversed = edge.Orientation() == TopAbs_REVERSED;
    out.inner = edge.Orientation() != TopAbs_FORWARD && !out.reversed;
    double from = 0, to = 0;
    const Handle(Geom2d_Curve) flat = BRep_Tool::CurveOnSurface(edge, face, from, to);
    if (flat.IsNull())
      throw std::runtime_error(line.name + " has no curve in the surface of " + name);
    auto curve = ExactCurve<2>::of(flat);
    if (!curve)
      throw std::runtime_error(line.name + ": its curve in the surface of " + name + " (" +
                               flat->DynamicType()->Name() + ") cannot be bounded");
    check_range(line, curve->domain(), "its curve in the surface of " + name);
    out.curve = std::move(*curve);
    return out;
  }

  void add_line(Line& line, const TopoDS_Edge& edge, const Poly_PolygonOnTriangulation& polygon) {
    const Handle(TColStd_HArray1OfReal)& t = polygon.Parameters();
    const int count = polygon.NbNodes();
    for (int i = 0; i < count; ++i) line.t.push_back(t->Value(t->Lower() + i));
    for (int i = 0; i + 1 < count; ++i)
      if (!(line.t[i] < line.t[i + 1]))
        throw std::runtime_error(line.name + " has points out of order");
    line.points.assign(count, kNone);
    line.bounds.assign(count - 1, -1);
    line.points.front() = corner(TopExp::FirstVertex(edge));
    line.points.back() = corner(TopExp::LastVertex(edge));
    line.point = BRep_Tool::Degenerated(edge);
    if (line.point) {
      line.points.assign(count, line.points.front());
      return;
    }
    double from = 0, to = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, from, to);
    if (curve.IsNull()) return;
    line.curve = ExactCurve<3>::of(curve);
    if (!line.curve)
      throw std::runtime_error(line.name + ": curves of its kind (" + curve->DynamicType()->Name() +
                               ") cannot be bounded");
    check_range(line, line.curve->domain(), "its curve");
  }

  /// Whether the borders of the triangles add up to the polygons of the edges: then every parameter
  /// that these wind round is in a triangle.
  static bool is_filled(const FaceMesh& f) {
    std::map<Pair, int> sum;
    const auto add = [&](int a, int b, int sign) {
      if (a < b) sum[{a, b}] += sign;
      if (b < a) sum[{b, a}] -= sign;
    };
    for (const auto& t : f.triangles)
      for (int i = 0; i < 3; ++i) add(t[i], t[(i + 1) % 3], 1);
    for (const Border& b : f.borders)
      for (std::size_t i = 0; i + 1 < b.nodes.size() && !b.inner; ++i)
        add(b.nodes[i], b.nodes[i + 1], b.reversed ? 1 : -1);
    return std::all_of(sum.begin(), sum.end(), [](const auto& e) { return e.second == 0; });
  }

  // --- edges ---

  void bound_edges() {
    for (Line& line : lines_) {
      line.split.assign(line.bounds.size(), 0);
      if (!line.curve) continue;
      for (std::size_t i = 0; i < line.bounds.size(); ++i) {
        if (line.bounds[i] >= 0) continue;
        bool far = false;
        const double bound =
            bound_curve(*line.curve, line.t[i], line.t[i + 1],
                        {point(line.points[i]), point(line.points[i + 1])}, wish_, 0, far);
        line.split[i] = far && refine_ ? 1 : 0;
        if (line.split[i] == 0) line.bounds[i] = bound;
      }
    }
  }

  /// No point of the curve between two parameters is farther from the chord.
  /// @param far  becomes true where a point is farther than wished
  double bound_curve(const ExactCurve<3>& curve, double a, double b,
                     const std::array<Vec3, 2>& chord, double aim, int depth, bool& far) {
    std::vector<Vec3> hull;
    curve.add_hull(a, b, hull);
    double bound = 0;
    for (const Vec3& p : hull) bound = std::max(bound, distance_to_segment(p, chord[0], chord[1]));
    ++result_.pieces;
    const double middle = 0.5 * (a + b);
    if (bound <= aim || depth > kHalvings || !(a < middle && middle < b)) return bound;
    const double there = distance_to_segment(curve.value(middle), chord[0], chord[1]);
    if (there > wish_) {
      far = true;
      if (refine_) return bound;
    }
    aim = std::max(aim, kSlack * there);
    if (bound <= aim || pieces_left_ == 0) return bound;
    --pieces_left_;
    return std::max(bound_curve(curve, a, middle, chord, aim, depth + 1, far),
                    bound_curve(curve, middle, b, chord, aim, depth + 1, far));
  }

  // --- faces ---

  struct Look {
    const FaceMesh& f;
    NearTriangles near;
    bool far = false;  ///< a point is farther than wished
    bool own = true;   ///< the first triangle was near enough
    bool cut = false;  ///< bounds are not as good as they could be
  };

  void bound_face(FaceMesh& f) {
    turn_sides(f);
    Look look{
        f, NearTriangles([this, &f](std::size_t t) { return corners(f, t); }, f.triangles.size())};
    f.far.assign(f.triangles.size(), 0);
    f.bound = 0;
    f.settled = true;
    for (std::size_t t = 0; t < f.triangles.size(); ++t) {
      const auto& n = f.triangles[t];
      if (f.bounds[t] < 0) {
        look.far = false;
        look.own = true;
        const double bound = bound_piece({f.uv[n[0]], f.uv[n[1]], f.uv[n[2]]}, t, look, wish_, 0);
        f.far[t] = look.far && refine_ ? 1 : 0;
        if (f.far[t] != 0) f.settled = false;
        if (look.own && !look.far) f.bounds[t] = bound;
        f.bound = std::max(f.bound, bound);
      } else {
        f.bound = std::max(f.bound, f.bounds[t]);
      }
    }
    if (look.cut) f.settled = false;
    std::map<Pair, std::size_t> beside;
    for (std::size_t t = 0; t < f.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i)
        beside[std::minmax({f.triangles[t][i], f.triangles[t][(i + 1) % 3]})] = t;
    for (const Border& b : f.borders) {
      Line& line = lines_[b.edge];
      for (std::size_t i = 0; i + 1 < b.nodes.size(); ++i) {
        const int p = b.nodes[i], q = b.nodes[i + 1];
        const auto at = beside.find(std::minmax({p, q}));
        look.far = false;
        const double bound = bound_sliver(b.curve, line.t[i], line.t[i + 1], f.uv[p], f.uv[q],
                                          at == beside.end() ? 0 : at->second, look, wish_, 0);
        f.bound = std::max(f.bound, bound);
        if (!look.far || !refine_) continue;
        line.split[i] = 1;
        f.settled = false;
      }
    }
  }

  /// Triangles that are near enough by themselves get their bound; sides of others are turned.
  void turn_sides(FaceMesh& f) {
    bool all = true;
    const auto look = [&] {
      all = true;
      for (std::size_t t = 0; t < f.triangles.size(); ++t) {
        if (f.bounds[t] >= 0) continue;
        const auto& n = f.triangles[t];
        const Box2 box = box_of({f.uv[n[0]], f.uv[n[1]], f.uv[n[2]]});
        const ExactSurface& s = *f.surface;
        double bound = std::numeric_limits<double>::infinity();
        if (s.domain().contains(box) && !s.kink(0, box.min().x(), box.max().x()) &&
            !s.kink(1, box.min().y(), box.max().y())) {
          bound = 0;
          for (const int i : n)
            bound = std::max(bound, (s.value(f.uv[i]) - point(f.point[i])).norm());
          bound += bend(s, box);
          ++result_.pieces;
        }
        if (bound <= wish_) f.bounds[t] = bound;
        all = all && f.bounds[t] >= 0;
      }
    };
    look();
    for (int pass = 0; pass < kFlips && !all && flip(f); ++pass) look();
  }

  /// How far the surface over a piece in the box may be from what its corners span (Lemma 2).
  static double bend(const ExactSurface& s, const Box2& box) {
    const SurfaceDerivatives d = s.derivatives(box);
    const double w = box.sizes().x(), h = box.sizes().y();
    return (d.uu * w * w + 2 * d.uv * w * h + d.vv * h * h) / 8;
  }

  /// No point of the surface over the piece is farther from the face's triangles.
  double bound_piece(Piece piece, std::size_t hint, Look& look, double aim, int depth) {
    const ExactSurface& s = *look.f.surface;
    Box2 box = box_of(piece);
    if (!s.domain().contains(box)) {
      for (int axis = 0; axis < 2; ++axis) {
        piece = clipped(piece, axis, s.domain().min()[axis], -1);
        piece = clipped(piece, axis, s.domain().max()[axis], 1);
      }
      if (piece.empty()) return 0;
      box = box_of(piece);
    }
    for (int axis = 0; axis < 2; ++axis)
      if (const auto kink = s.kink(axis, box.min()[axis], box.max()[axis]))
        return halves(piece, axis, *kink, hint, look, aim, depth);
    ++result_.pieces;
    const SurfaceDerivatives d = s.derivatives(box);
    const Vec2 size = box.sizes();
    const double error =
        (d.uu * size.x() * size.x() + 2 * d.uv * size.x() * size.y() + d.vv * size.y() * size.y()) /
        8;
    std::vector<Vec3> at;
    at.reserve(piece.size());
    for (const Vec2& p : piece) at.push_back(s.value(p));
    const auto from = [&](std::size_t t) {
      const Corners c = corners(look.f, t);
      double most = 0;
      for (const Vec3& p : at) most = std::max(most, distance_to_triangle(p, c));
      return most;
    };
    double off = from(hint);
    if (off + error <= aim) return off + error;
    look.own = false;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : at) middle += p;
    middle /= static_cast<double>(at.size());
    const std::size_t other = look.near(middle).triangle;
    if (other != hint) {
      const double off_other = from(other);
      if (off_other < off) {
        off = off_other;
        hint = other;
      }
    }
    if (off + error <= aim || depth > kHalvings || pieces_left_ == 0) return off + error;
    if (depth > most_halvings_) {
      look.cut = true;
      return off + error;
    }
    double there = 0;
    for (const Vec3& p : at) there = std::max(there, look.near(p).distance);
    if (there > wish_) {
      look.far = true;
      if (refine_) return off + error;
    }
    aim = std::max(aim, kSlack * there);
    if (off + error <= aim) return off + error;
    --pieces_left_;
    double u = d.uu * size.x() * size.x(), v = d.vv * size.y() * size.y();
    if (off > aim || !(u + v > 0)) {  // it reaches beyond the triangle
      u = d.u * size.x();
      v = d.v * size.y();
    }
    int axis = u >= v ? 0 : 1;
    if (!halves_differ(box, axis)) axis = 1 - axis;
    if (!halves_differ(box, axis)) return off + error;
    return std::min(off + error,
                    halves(piece, axis, box.center()[axis], hint, look, aim, depth + 1));
  }

  static bool halves_differ(const Box2& box, int axis) {
    return box.min()[axis] < box.center()[axis] && box.center()[axis] < box.max()[axis];
  }

  double halves(const Piece& piece, int axis, double at, std::size_t hint, Look& look, double aim,
                int depth) {
    double bound = 0;
    for (const double sign : {1.0, -1.0}) {
      Piece half = clipped(piece, axis, at, sign);
      if (!half.empty()) bound = std::max(bound, bound_piece(half, hint, look, aim, depth));
    }
    return bound;
  }

  /// No point of the surface between a piece of the border's curve and the line from node to node
  /// is farther from the face's triangles.
  double bound_sliver(const ExactCurve<2>& curve, double a, double b, const Vec2& p, const Vec2& q,
                      std::size_t hint, Look& look, double aim, int depth) {
    Piece hull{p, q};
    curve.add_hull(a, b, hull);
    if (std::all_of(hull.begin(), hull.end(), [&](const Vec2& x) { return x == p || x == q; }))
      return 0;
    bool ignored = false;
    std::swap(ignored, look.far);
    const std::size_t left = pieces_left_;
    pieces_left_ = 0;
    const double bound = bound_piece(hull_of(hull), hint, look, aim, 0);
    pieces_left_ = left;
    std::swap(ignored, look.far);
    const double middle = 0.5 * (a + b);
    if (bound <= aim || depth > kHalvings || !(a < middle && middle < b)) return bound;
    const Vec2 m = curve.value(middle);
    const double there = look.near(look.f.surface->value(m)).distance;
    if (there > wish_) {
      look.far = true;
      if (refine_) return bound;
    }
    aim = std::max(aim, kSlack * there);
    if (bound <= aim || pieces_left_ == 0) return bound;
    --pieces_left_;
    const double parts = std::max({bound_sliver(curve, a, middle, p, m, hint, look, aim, depth + 1),
                                   bound_sliver(curve, middle, b, m, q, hint, look, aim, depth + 1),
                                   bound_piece(hull_of({p, m, q}), hint, look, aim, 0)});
    return std::min(bound, parts);
  }

  // --- finer triangles ---

  using Halves = std::map<Pair, int>;  ///< pairs of nodes, and the node between them

  /// Halves what is too far from the exact shape. False where nothing is.
  bool make_finer() {
    std::vector<Halves> halves(faces_.size());
    for (std::size_t k = 0; k < faces_.size(); ++k) choose(faces_[k], halves[k]);
    bool any = false;
    for (std::size_t e = 1; e < lines_.size(); ++e)
      for (const char split : lines_[e].split) any = any || split != 0;
    for (const Halves& h : halves) any = any || !h.empty();
    if (!any) return false;
    halve_lines(halves);
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      FaceMesh& f = faces_[k];
      for (auto& [pair, node] : halves[k])
        if (node < 0) node = new_node(f, 0.5 * (f.uv[pair.first] + f.uv[pair.second]), kNone);
      if (!halves[k].empty()) halve_triangles(f, halves[k]);
    }
    return true;
  }

  int new_node(FaceMesh& f, const Vec2& uv, std::uint32_t at) {
    f.uv.push_back(uv);
    f.point.push_back(at == kNone ? new_point(f.surface->value(uv)) : at);
    return static_cast<int>(f.uv.size() - 1);
  }

  /// Of each far triangle the side along which the surface bends most.
  void choose(const FaceMesh& f, Halves& halves) {
    std::map<Pair, std::vector<std::pair<int, std::size_t>>> on;  // pieces of edges
    if (std::count(f.far.begin(), f.far.end(), 1) == 0) return;
    for (const Border& b : f.borders)
      for (std::size_t i = 0; i + 1 < b.nodes.size(); ++i)
        on[std::minmax({b.nodes[i], b.nodes[i + 1]})].emplace_back(b.edge, i);
    for (std::size_t t = 0; t < f.triangles.size(); ++t) {
      if (f.far[t] == 0) continue;
      const auto& n = f.triangles[t];
      const SurfaceDerivatives d =
          f.surface->derivatives(box_of({f.uv[n[0]], f.uv[n[1]], f.uv[n[2]]}));
      double most = -1;
      Pair side;
      for (int i = 0; i < 3; ++i) {
        const Vec2 by = (f.uv[n[(i + 1) % 3]] - f.uv[n[i]]).cwiseAbs();
        const double bend =
            d.uu * by.x() * by.x() + 2 * d.uv * by.x() * by.y() + d.vv * by.y() * by.y();
        if (!(bend > most)) continue;
        most = bend;
        side = std::minmax({n[i], n[(i + 1) % 3]});
      }
      if (most / 8 < kHelpful * wish_) continue;
      const auto at = on.find(side);
      if (at == on.end()) {
        halves[side] = -1;
      } else {
        for (const auto& [edge, i] : at->second) lines_[edge].split[i] = 1;
      }
    }
  }

  /// Edges get one new point for all faces that they bound.
  void halve_lines(std::vector<Halves>& halves) {
    std::vector<std::vector<std::uint32_t>> middle(lines_.size());
    for (std::size_t e = 1; e < lines_.size(); ++e) {
      const Line& line = lines_[e];
      middle[e].assign(line.split.size(), kNone);
      for (std::size_t i = 0; i < line.split.size(); ++i) {
        if (line.split[i] == 0) continue;
        if (line.point) middle[e][i] = line.points[i];
        if (line.curve)
          middle[e][i] = new_point(line.curve->value(0.5 * (line.t[i] + line.t[i + 1])));
      }
    }
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      FaceMesh& f = faces_[k];
      for (Border& b : f.borders) {
        const Line& line = lines_[b.edge];
        std::vector<int> nodes;
        for (std::size_t i = 0; i < b.nodes.size(); ++i) {
          nodes.push_back(b.nodes[i]);
          if (i + 1 == b.nodes.size() || line.split[i] == 0) continue;
          f.settled = false;
          const auto [at, fresh] =
              halves[k].try_emplace(std::minmax({b.nodes[i], b.nodes[i + 1]}), -1);
          if (at->second < 0) {
            std::uint32_t& p = middle[b.edge][i];
            at->second = new_node(f, b.curve.value(0.5 * (line.t[i] + line.t[i + 1])), p);
            p = f.point[at->second];
          }
          nodes.push_back(at->second);
        }
        b.nodes = std::move(nodes);
      }
    }
    for (std::size_t e = 1; e < lines_.size(); ++e) {
      Line& line = lines_[e];
      for (std::size_t i = line.split.size(); i-- > 0;)
        if (line.split[i] != 0) line.halve(i, 0.5 * (line.t[i] + line.t[i + 1]), middle[e][i]);
    }
  }

  static void halve_triangles(FaceMesh& f, const Halves& halves) {
    f.settled = false;
    std::vector<std::array<int, 3>> triangles;
    std::vector<double> bounds;
    const auto add = [&](int a, int b, int c) {
      triangles.push_back({a, b, c});
      bounds.push_back(-1);
    };
    for (std::size_t t = 0; t < f.triangles.size(); ++t) {
      std::array<int, 3> n = f.triangles[t], m{};
      int count = 0;
      for (int i = 0; i < 3; ++i) {
        const auto at = halves.find(std::minmax({n[i], n[(i + 1) % 3]}));
        m[i] = at == halves.end() ? -1 : at->second;
        count += m[i] >= 0 ? 1 : 0;
      }
      if (count == 0) {
        triangles.push_back(n);
        bounds.push_back(f.bounds[t]);
        continue;
      }
      // The first side is halved; of two, the first and the second.
      while (m[0] < 0 || (count == 2 && m[1] < 0)) {
        std::rotate(n.begin(), n.begin() + 1, n.end());
        std::rotate(m.begin(), m.begin() + 1, m.end());
      }
      if (count == 1) {
        add(n[0], m[0], n[2]);
        add(m[0], n[1], n[2]);
      } else if (count == 2) {
        add(m[0], n[1], m[1]);
        add(n[0], m[0], m[1]);
        add(n[0], m[1], n[2]);
      } else {
        for (int i = 0; i < 3; ++i) add(n[i], m[i], m[(i + 2) % 3]);
        add(m[0], m[1], m[2]);
      }
    }
    f.triangles = std::move(triangles);
    f.bounds = std::move(bounds);
  }

  /// Turns sides along which the surface bends more than along the other diagonal of the two
  /// triangles. The sum of the triangles' borders stays as it is. False where nothing was turned.
  static bool flip(FaceMesh& f) {
    const auto bend_of = [&f](int a, int b) {
      return bend(*f.surface, box_of({f.uv[a], f.uv[b]}));
    };
    const auto area = [&f](int a, int b, int c) {
      const Vec2 p = f.uv[b] - f.uv[a], q = f.uv[c] - f.uv[a];
      return p.x() * q.y() - p.y() * q.x();
    };
    std::unordered_map<std::uint64_t, std::size_t> on;  // corners 3 t + i, by directed side
    const auto key = [](int a, int b) {
      return (static_cast<std::uint64_t>(a) << 32U) | static_cast<std::uint32_t>(b);
    };
    for (std::size_t t = 0; t < f.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i)
        on[key(f.triangles[t][i], f.triangles[t][(i + 1) % 3])] = 3 * t + i;
    std::vector<char> turned(f.triangles.size(), 0);
    bool any = false;
    for (std::size_t t = 0; t < f.triangles.size(); ++t) {
      for (int i = 0; i < 3 && turned[t] == 0; ++i) {
        const int a = f.triangles[t][i], b = f.triangles[t][(i + 1) % 3],
                  c = f.triangles[t][(i + 2) % 3];
        const auto at = on.find(key(b, a));
        if (at == on.end()) continue;
        const std::size_t other = at->second / 3;
        if (turned[other] != 0 || (f.bounds[t] >= 0 && f.bounds[other] >= 0)) continue;
        const int d = f.triangles[other][(at->second % 3 + 2) % 3];
        if (other == t || c == d || on.count(key(c, d)) > 0 || on.count(key(d, c)) > 0) continue;
        if (!(area(c, a, d) > 0 && area(d, b, c) > 0)) continue;
        if (!(bend_of(c, d) < 0.9 * bend_of(a, b))) continue;
        f.triangles[t] = {c, a, d};
        f.triangles[other] = {d, b, c};
        f.bounds[t] = f.bounds[other] = -1;
        turned[t] = turned[other] = 1;
        any = true;
      }
    }
    return any;
  }

  // --- edges beside their faces ---

  /// No point of the edge's curve is farther from the surface's curve at the same parameter.
  double bound_gap(const ExactCurve<3>& curve, const ExactCurve<2>& flat, const ExactSurface& s,
                   double a, double b, double aim, int depth) {
    std::optional<double> kink = curve.kink(a, b);
    if (!kink) kink = flat.kink(a, b);
    if (kink)
      return std::max(bound_gap(curve, flat, s, a, *kink, aim, depth),
                      bound_gap(curve, flat, s, *kink, b, aim, depth));
    const double ends = std::max((curve.value(a) - s.value(flat.value(a))).norm(),
                                 (curve.value(b) - s.value(flat.value(b))).norm());
    Piece hull;
    flat.add_hull(a, b, hull);
    const Box2 box = box_of(hull);
    const auto c = curve.derivatives(a, b);
    const auto f = flat.derivatives(a, b);
    const SurfaceDerivatives d = s.derivatives(box);
    const double u = f.first.x(), v = f.first.y(), h = b - a;
    double error = (c.first.norm() + d.u * u + d.v * v) * h / 2;
    if (!s.kink(0, box.min().x(), box.max().x()) && !s.kink(1, box.min().y(), box.max().y())) {
      const double second = c.second.norm() + d.uu * u * u + 2 * d.uv * u * v + d.vv * v * v +
                            d.u * f.second.x() + d.v * f.second.y();
      error = std::min(error, second * h * h / 8);
    }
    ++result_.pieces;
    aim = std::max(aim, 2 * ends);
    const double middle = 0.5 * (a + b);
    if (ends + error <= aim || depth > kHalvings || pieces_left_ == 0 ||
        !(a < middle && middle < b))
      return ends + error;
    --pieces_left_;
    return std::min(ends + error, std::max(bound_gap(curve, flat, s, a, middle, aim, depth + 1),
                                           bound_gap(curve, flat, s, middle, b, aim, depth + 1)));
  }

  void bound_gaps() {
    for (const FaceMesh& f : faces_)
      for (const Border& b : f.borders) {
        const Line& line = lines_[b.edge];
        if (!line.curve) continue;
        for (std::size_t i = 0; i + 1 < line.t.size(); ++i)
          worse(bound_gap(*line.curve, b.curve, *f.surface, line.t[i], line.t[i + 1], kGap * wish_,
                          0),
                line.name + " beside " + f.name, result_.gap, result_.widest);
      }
  }

  static void worse(double bound, const std::string& name, double& most, std::string& which) {
    if (!(bound > most)) return;
    most = bound;
    which = name;
  }

  // --- areas ---

  /// Lemma 3: of the surface over all triangles, and over what the border has besides.
  static AreaBounds area_of(const FaceMesh& f, const std::vector<Line>& lines) {
    AreaBounds out;
    for (const auto& n : f.triangles)
      add_area(*f.surface, {f.uv[n[0]], f.uv[n[1]], f.uv[n[2]]}, out);
    for (const Border& b : f.borders) {
      const std::vector<double>& t = lines[b.edge].t;
      for (std::size_t i = 0; i + 1 < b.nodes.size() && !b.inner; ++i)
        out.error += sliver_area(*f.surface, b.curve, t[i], t[i + 1], f.uv[b.nodes[i]],
                                 f.uv[b.nodes[i + 1]]);
    }
    return out;
  }

  static void add_area(const ExactSurface& s, const std::array<Vec2, 3>& q, AreaBounds& out) {
    const Vec2 a = q[1] - q[0], b = q[2] - q[0];
    const double det = a.x() * b.y() - a.y() * b.x(), sign = det < 0 ? -1 : 1;
    const Box2 box = box_of({q[0], q[1], q[2]});
    const SurfaceDerivatives d = s.derivatives(box);
    if (!s.domain().contains(box) || s.kink(0, box.min().x(), box.max().x()) ||
        s.kink(1, box.min().y(), box.max().y())) {
      const double most = std::abs(det) / 2 * d.u * d.v;
      out.value += sign * most / 2;
      out.error += most / 2;
      return;
    }
    constexpr int k = kAreaParts;
    std::array<std::array<Vec3, k + 1>, k + 1> at;
    for (int i = 0; i <= k; ++i)
      for (int j = 0; i + j <= k; ++j)
        at[i][j] = s.value(q[0] + a * (1.0 * i / k) + b * (1.0 * j / k));
    const double w = box.sizes().x() / k, h = box.sizes().y() / k;
    const double turn = (d.uu * w + d.uv * h) / 2 * d.v + d.u * (d.uv * w + d.vv * h) / 2;
    const double r = (d.uu * w * w + 2 * d.uv * w * h + d.vv * h * h) / 4;
    const auto add = [&](const Vec3& o, const Vec3& x, const Vec3& y) {
      const Vec3 ox = x - o, oy = y - o;
      out.value += sign * ox.cross(oy).norm() / 2;
      out.error += std::abs(det) / (2 * k * k) * turn + (ox.norm() * r + r * oy.norm() + r * r) / 2;
    };
    for (int i = 0; i < k; ++i)
      for (int j = 0; i + j < k; ++j) {
        add(at[i][j], at[i + 1][j], at[i][j + 1]);
        if (i + j + 1 < k) add(at[i + 1][j + 1], at[i][j + 1], at[i + 1][j]);
      }
  }

  /// No more lies between a piece of the border's curve and the line from node to node.
  static double sliver_area(const ExactSurface& s, const ExactCurve<2>& curve, double a, double b,
                            const Vec2& p, const Vec2& q) {
    Piece hull{p, q};
    curve.add_hull(a, b, hull);
    const SurfaceDerivatives d = s.derivatives(box_of(hull));
    const auto length = [&d](const Vec2& by) {
      return d.u * std::abs(by.x()) + d.v * std::abs(by.y());
    };
    const auto c = curve.derivatives(a, b);
    const double h = b - a;
    const double ends = std::max(length(curve.value(a) - p), length(curve.value(b) - q));
    const double bow = curve.kink(a, b) ? h * length(c.first) : h * h / 8 * length(c.second);
    return (ends + bow) * std::max(h * length(c.first), length(q - p));
  }

  // --- the result ---

  void deliver() {
    for (const FaceMesh& f : faces_) {
      worse(f.bound, f.name, result_.distance, result_.farthest);
      result_.areas.push_back(area_of(f, lines_));
      for (const auto& n : f.triangles) {
        geom::Triangle t{f.point[n[0]], f.point[n[1]], f.point[n[2]]};
        if (f.reversed) std::swap(t[1], t[2]);
        result_.triangles.push_back(t);
      }
      result_.ends.push_back(result_.triangles.size());
    }
    for (const Line& line : lines_)
      for (const double bound : line.bounds)
        if (line.curve) worse(bound, line.name, result_.distance, result_.farthest);
    result_.distance += kRounding * largest_;
  }

  double wish_, most_;
  ExactCover result_;
  TopTools_IndexedMapOfShape edges_, vertices_;
  std::vector<Line> lines_;  ///< by number of the edge
  std::vector<FaceMesh> faces_;
  std::vector<std::uint32_t> corner_;
  double largest_ = 0;
  bool refine_ = true;
  int most_halvings_ = kHalvings;
  std::size_t pieces_left_ = 0;
};

}  // namespace

ExactCover cover_exact_shape(const TopoDS_Shape& shape, double wish, double most) {
  Cover cover(shape, wish, most);
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    cover.add(TopoDS::Face(at.Current()));
  return cover.run();
}

}  // namespace kaboum::io
