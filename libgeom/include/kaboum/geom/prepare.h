#pragma once

#include <kaboum/geom/solid_mesh.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::geom {

/// Treatment of an open mesh, which bounds no solid.
enum class Holes {
  Keep,    ///< it stays open
  Fill,    ///< fill_holes closes it, before orientation is judged
  Refuse,  ///< an error
};

struct PrepareOptions {
  bool drop_sheets = false;  ///< drop opposite coincident faces without volume, with a note
  Holes holes = Holes::Keep;
  bool keep_orientation = false;  ///< never turn a triangle

  /// Polygons of four corners that are not plane, each by the first of its two triangles, which
  /// follow each other in the input (io::ReadResult::bent_quads).
  std::vector<std::uint32_t> quads = {};
  /// Choice of the diagonal that splits these. Outward: the solid contains that of any other
  /// choice. Inward: it is contained in that.
  enum class Diagonal { AsGiven, Outward, Inward } diagonal = Diagonal::AsGiven;
};

/// An input triangle that is left out and that the solid need not hold.
struct LeftOut {
  std::uint32_t source;  ///< index in the input
  std::array<Vec3, 3> corners;
};

/// Origin of a prepared mesh in the input: nothing that a claim about it rests on.
struct PreparationReport {
  /// Per triangle of the prepared mesh: its index in the input. Triangles that fill holes are the
  /// mesh's last ones, and not in it: vertices that only those use are the last ones as well.
  std::vector<std::uint32_t> source;
  std::vector<char> reversed;  ///< per such triangle: orientation reversed
  std::vector<std::uint32_t>
      reversed_and_dropped;             ///< input triangles: turned first, dropped later
  std::uint32_t components = 0;         ///< connected by shared edges
  std::size_t collapsed_triangles = 0;  ///< dropped: repeated corners
  std::size_t dropped_copies = 0;       ///< dropped: identically oriented copies
  std::size_t cancelled_walls = 0;      ///< dropped: triangles in opposite pairs inside the solid
  /// Those, whose middles and corners are inside the solid while the rest of them need not be; and
  /// those with repeated corners, which are segments and points. Not sheets dropped on request.
  std::vector<LeftOut> left_out;
  std::size_t dropped_sheets = 0;  ///< dropped: triangles in opposite pairs outside, on request
  std::size_t reversed_components = 0;    ///< shells that were inside out, turned as a whole
  std::vector<std::uint32_t> inside_out;  ///< an input triangle of each of those
  std::size_t reversed_cavities = 0;      ///< shells turned along with those that they lie in
  std::size_t reversed_triangles = 0;     ///< against their neighbours or in a turned component
  std::size_t holes = 0;                  ///< filled
  /// Their vertices, in the order of fill_holes: vertex k of input triangle t is
  /// 3 t + k.
  std::vector<std::vector<std::uint32_t>> rims;
  /// Triangles that were turned after holes had been filled, ascending: input triangles, and
  /// numbered on from those the ones that fill holes.
  std::vector<std::uint32_t> reversed_after_filling;
  std::size_t filled_vertices = 0;  ///< that only triangles that fill holes use
  double largest_hole = 0;          ///< diagonal of its box [length]
  /// A place that surfaces enclose and that counts as outside, although it need not be a cavity:
  /// the first found, and noted.
  std::optional<Vec3> hollow;
  std::size_t quads_split_anew = 0;  ///< along the other diagonal
  /// True if it is a guess which solid is meant: a hole's rim runs along a wall, or triangles of a
  /// part that was open were turned to agree. Noted.
  bool guessed = false;
  /// What a search for loose triangles has found of the prepared mesh, if it was made: ascending.
  std::optional<std::vector<std::uint32_t>> loose;
  std::vector<std::string> notes;  ///< the same in words, for who made the file
};

/// A mesh whose solid is defined, and how it came from the input.
struct Prepared {
  /// Vertices in the order of their first use by the triangles left, as the input orients these.
  SolidMesh solid;
  PreparationReport report;
};

/// Finds triangles of a closed mesh. No other triangle cuts those that are not among them, nor lies
/// along their edges but for common ones, and the winding number on their inner side is 1 at least
/// (verify::find_loose_triangles).
using LooseTriangles = std::function<std::vector<std::uint32_t>(const Mesh&)>;

/// Gives the input a solid, or says why it has none. docs/algorithms/preparation.md states which
/// solid is meant, and proves that nothing of it is lost.
///
/// In this order:
/// - equal vertices are merged and triangles with repeated corners dropped;
/// - inconsistent neighbours are turned to agree;
/// - opposite coincident faces cancel;
/// - holes are filled, on request;
/// - shells that are inside out are turned, each by itself also where shells share walls;
/// - identically oriented copies are dropped where what is dropped is itself a closed chain and
///   nothing is oriented inwards.
///
/// A shell oriented inwards is a cavity, and stays one, if it lies in one shell oriented outwards,
/// in none of that one's other cavities, and meets none of these in more than corners and edges
/// that both have; exactly. Otherwise it is inside out. It is turned together with what lies inside
/// it if that nest has no solid of its own (a file inside out as a whole), else alone. A body
/// inside another body stays a body.
///
/// Claims about a result are claims about this mesh; the counts say how it differs from the input.
///
/// @param loose  asked, if there is one, of closed meshes in one piece: where no triangle is loose,
///   no place is inside out, and none is looked for. The result is the same.
/// @throws Error{InvalidInput} when no solid can be given: no triangles, a one-sided surface,
///   sheets (opposite coincident faces that lie in no solid, unless dropped on request), nothing
///   left, open with Holes::Refuse. Also when shells share a wall and cannot be told apart, or have
///   a hole in one of them when they had to be turned to agree. Also for coordinates beyond 1e60 or
///   an extent below 1e-60 (their products would overflow or vanish).
Prepared prepare(const Mesh& input, const PrepareOptions& options = {},
                 const LooseTriangles& loose = {});

}  // namespace kaboum::geom
