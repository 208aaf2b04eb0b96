// From the polygons of a file to triangles: vertices are merged, non-triangles triangulated, damage
// counted or refused.
#include "builder.h"

#include <kaboum/base/error.h>
#include <kaboum/io/file_unit.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <sstream>
#include <utility>

#include "polygon.h"

namespace kaboum::io {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr std::size_t kMostPoints = kNone - 1;

/// Mixes all bits of all coordinates (constants and finaliser of MurmurHash3).
std::uint32_t hash_of(const geom::Vec3& p) {
  std::uint64_t h = std::bit_cast<std::uint64_t>(p.x()) * 0x87C37B91114253D5U;
  h = (std::rotl(h, 31) ^ std::bit_cast<std::uint64_t>(p.y())) * 0x4CF5AD432745937FU;
  h = (std::rotl(h, 31) ^ std::bit_cast<std::uint64_t>(p.z())) * 0xFF51AFD7ED558CCDU;
  h ^= h >> 33;
  h *= 0xC4CEB9FE1A85EC53U;
  return static_cast<std::uint32_t>(h >> 32);
}

}  // namespace

Welder::Welder(std::size_t expected)
    : slots_(std::max<std::size_t>(1024, std::bit_ceil(2 * expected)), Slot{0, kNone}) {
  points_.reserve(expected);
}

std::uint32_t Welder::number_of(const geom::Vec3& position) {
  const geom::Vec3 p = position.array() + 0.0;  // −0 + 0 = +0
  const std::uint32_t hash = hash_of(p);
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hash & mask;
  for (; slots_[i].point != kNone; i = (i + 1) & mask)
    if (slots_[i].hash == hash && points_[slots_[i].point] == p) return slots_[i].point;
  const auto number = static_cast<std::uint32_t>(points_.size());
  slots_[i] = {hash, number};
  points_.push_back(p);
  if (2 * points_.size() > slots_.size()) grow();
  return number;
}

void Welder::grow() {
  std::vector<Slot> larger(4 * slots_.size(), Slot{0, kNone});
  const std::size_t mask = larger.size() - 1;
  for (const Slot& slot : slots_) {
    if (slot.point == kNone) continue;
    std::size_t i = slot.hash & mask;
    while (larger[i].point != kNone) i = (i + 1) & mask;
    larger[i] = slot;
  }
  slots_.swap(larger);
}

void MeshBuilder::add_point(const geom::Vec3& point, const char* where) {
  if (!point.allFinite())
    fail(source_, where,
         "vertex " + std::to_string(points_.size()) +
             " has a coordinate that is not finite; remove or repair this vertex");
  if (points_.size() >= kMostPoints)
    throw Error(ErrorCode::LimitReached,
                std::string(source_.name) + ": more than 2^32 - 2 vertices; split the mesh");
  points_.push_back(point);
}

void MeshBuilder::add_face(std::span<const std::uint32_t> corners, const char* where) {
  if (corners.size() < 3) {
    ++tiny_faces_;
  } else if (corners.size() == 3) {
    triangles_.push_back({corners[0], corners[1], corners[2]});
  } else {
    polygons_.push_back({triangles_.size(), polygon_corners_.size(), corners.size(), where});
    polygon_corners_.insert(polygon_corners_.end(), corners.begin(), corners.end());
  }
}

void MeshBuilder::adopt_welded_points(std::vector<geom::Vec3>&& points, std::size_t stored) {
  points_ = std::move(points);
  stored_points_ = stored;
  welded_ = true;
}

std::uint32_t MeshBuilder::corner(std::int64_t index, std::int64_t first, const char* where) const {
  const auto count = static_cast<std::int64_t>(points_.size());
  if (index < first || index - first >= count)
    fail(source_, where,
         "a face refers to vertex " + std::to_string(index) + ", but there are " +
             std::to_string(count) + " (counted from " + std::to_string(first) +
             "); the file is damaged, export it again");
  return static_cast<std::uint32_t>(index - first);
}

void MeshBuilder::set_unit(double metres) { unit_ = unit_of_metres(metres); }

ReadResult MeshBuilder::finish(Format format, bool single_precision) {
  ReadResult result;
  result.format = format;
  result.single_precision = single_precision;
  result.file_vertices = welded_ ? stored_points_ : points_.size();
  result.notes = std::move(notes_);
  result.unit = unit_;
  if (tiny_faces_ > 0)
    result.notes.push_back(counted(tiny_faces_, "face with fewer than three corners was",
                                   "faces with fewer than three corners were") +
                           " ignored.");
  split_polygons(result);
  if (triangles_.empty())
    fail(source_, "no triangles; the file holds no surface, or it is not of the stated format");
  weld(result);
  if (result.mesh.triangles.empty())
    fail(source_, "no triangles: all " + std::to_string(result.file_triangles) +
                      " have two or more equal corners; export the mesh with more digits");
  return result;
}

/// Replaces the polygons by triangles, in the file's order.
void MeshBuilder::split_polygons(ReadResult& result) {
  result.file_triangles = triangles_.size();
  if (polygons_.empty()) return;
  // Hostile polygons cannot stall the reader: a few seconds.
  PolygonSplitter splitter(600'000'000);
  std::vector<geom::Triangle> all, pieces;
  all.reserve(triangles_.size() + polygon_corners_.size());
  std::vector<geom::Vec3> positions;
  std::size_t taken = 0, fans = 0;
  const char* first_fan = nullptr;
  const auto triangle = [this](std::size_t i) {
    return triangles_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  for (const Polygon& polygon : polygons_) {
    all.insert(all.end(), triangle(taken), triangle(polygon.triangles_before));
    taken = polygon.triangles_before;
    const std::uint32_t* const corners = polygon_corners_.data() + polygon.first_corner;
    positions.clear();
    for (std::size_t i = 0; i < polygon.corners; ++i) positions.push_back(points_[corners[i]]);
    if (!splitter.split(positions, pieces) && ++fans == 1) first_fan = polygon.where;
    if (splitter.exhausted())
      throw Error(ErrorCode::LimitReached,
                  std::string(source_.name) + ": " + place(source_, polygon.where) +
                      ": splitting the polygons into triangles takes too long (this one has " +
                      std::to_string(polygon.corners) + " corners); export the mesh as triangles");
    if (const double bend = bend_of(positions); bend > 0) {
      ++result.bent_polygons;
      result.largest_bend = std::max(result.largest_bend, bend);
      if (positions.size() == 4 && pieces.size() == 2)
        result.bent_quads.push_back(static_cast<std::uint32_t>(all.size()));
    }
    for (const geom::Triangle& t : pieces)
      all.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
    result.file_triangles += polygon.corners - 2;
    if (pieces.empty()) {  // all corners are in one or two places
      for (std::size_t i = 0; i + 2 < polygon.corners; ++i)
        all.push_back({corners[i], corners[i + 1], corners[i + 2]});
    } else {
      result.collapsed_triangles += polygon.corners - 2 - pieces.size();
    }
  }
  all.insert(all.end(), triangle(taken), triangles_.end());
  triangles_.swap(all);
  result.split_polygons = polygons_.size();
  if (fans > 0)
    result.notes.push_back(counted(fans, "polygon is", "polygons are") +
                           " not simple or without area (first: " + place(source_, first_fan) +
                           ") and became a plain fan of triangles.");
}

/// What the rounding of a file's numbers bends is not worth a note.
void MeshBuilder::note_bends(ReadResult& result) {
  constexpr double kWorth = 1e-6;  // of the diagonal
  if (!(result.largest_bend > kWorth * geom::bounding_box(result.mesh).diagonal())) return;
  std::ostringstream bend;
  bend.precision(3);
  bend << result.largest_bend;
  result.notes.push_back(
      counted(result.bent_polygons, "polygon is not plane", "polygons are not plane") +
      ", by up to " + bend.str() +
      ", so that the ways of splitting them differ: one of four corners is split "
      "from its first to its third corner, a convex one like a fan from its first "
      "corner, others by ear clipping.");
}

/// Drops triangles with equal corners that are edges, or corners, of others. Of those that are
/// segments and points apart from all others each stays once: they may stick out of something. A
/// mesh of nothing else is left empty.
void MeshBuilder::drop_collapsed(ReadResult& result) {
  const auto collapsed = [](const geom::Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  };
  if (std::ranges::none_of(triangles_, collapsed)) return;
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  const auto edge = [](std::uint32_t a, std::uint32_t b) { return Edge(std::minmax(a, b)); };
  const auto own_edge = [&](const geom::Triangle& t) {
    return edge(t[0], t[0] != t[1] ? t[1] : t[2]);
  };
  std::vector<Edge> wanted;  // edges that collapsed triangles are
  for (const geom::Triangle& t : triangles_)
    if (collapsed(t)) wanted.push_back(own_edge(t));
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<char> held(wanted.size(), 0), used(points_.size(), 0);
  const auto hold = [&](const Edge& e) {
    const auto found = std::ranges::lower_bound(wanted, e);
    if (found != wanted.end() && *found == e)
      held[static_cast<std::size_t>(found - wanted.begin())] = 1;
  };
  bool any = false;
  for (const geom::Triangle& t : triangles_) {
    if (collapsed(t)) continue;
    any = true;
    for (std::size_t k = 0; k < 3; ++k) {
      used[t[k]] = 1;
      hold(edge(t[k], t[(k + 1) % 3]));
    }
  }
  std::size_t apart = 0;
  // Segments before points, which may be their ends.
  for (const bool points : {false, true}) {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const auto& [a, b] = wanted[i];
      if ((a == b) != points || held[i] != 0 || (points && used[a] != 0)) {
        if ((a == b) == points) held[i] = 1;
        continue;
      }
      used[a] = used[b] = 1;
      ++apart;
    }
  }
  std::erase_if(triangles_, [&](const geom::Triangle& t) {
    if (!collapsed(t)) return false;
    const auto found = std::ranges::lower_bound(wanted, own_edge(t));
    char& is_held = held[static_cast<std::size_t>(found - wanted.begin())];
    return !any || std::exchange(is_held, char{1}) != 0;
  });
  if (any && apart > 0)
    result.notes.push_back(counted(apart, "triangle with equal corners is a segment or point",
                                   "triangles with equal corners are segments or points") +
                           " that no other triangle has; " +
                           (apart == 1 ? "it counts" : "they count") + " as such.");
}

void MeshBuilder::weld(ReadResult& result) {
  // Numbers of the positions in order of first use, counting collapsed triangles too.
  std::vector<std::uint32_t> number;
  Welder welder(welded_ ? 0 : points_.size());
  if (!welded_) {
    number.assign(points_.size(), kNone);
    for (geom::Triangle& t : triangles_) {
      for (std::uint32_t& corner : t) {
        if (number[corner] == kNone) number[corner] = welder.number_of(points_[corner]);
        corner = number[corner];
      }
    }
    std::size_t unused = 0;
    for (const std::uint32_t n : number) unused += n == kNone ? 1 : 0;
    if (unused > 0)
      result.notes.push_back(
          counted(unused, "vertex that no face uses was", "vertices that no face uses were") +
          " left out.");
    points_.swap(welder.points());
  }
  const std::size_t before = triangles_.size();
  const std::vector<geom::Triangle> all =
      result.bent_quads.empty() ? std::vector<geom::Triangle>() : triangles_;
  drop_collapsed(result);
  // Numbers of triangles that are left: both of a bent quad are.
  std::vector<std::uint32_t> left(all.size(), 0);
  for (std::size_t i = 0, j = 0; i < all.size() && j < triangles_.size(); ++i) {
    if (all[i] != triangles_[j]) continue;
    left[i] = static_cast<std::uint32_t>(j++);
  }
  for (std::uint32_t& t : result.bent_quads) t = left[t];
  result.collapsed_triangles += before - triangles_.size();
  if (triangles_.size() < before) {
    // Vertices that only collapsed triangles used go; the rest keeps its order of first use.
    number.assign(points_.size(), kNone);
    std::vector<geom::Vec3> kept;
    for (geom::Triangle& t : triangles_) {
      for (std::uint32_t& corner : t) {
        if (number[corner] == kNone) {
          number[corner] = static_cast<std::uint32_t>(kept.size());
          kept.push_back(points_[corner]);
        }
        corner = number[corner];
      }
    }
    points_.swap(kept);
  }
  result.mesh.vertices = std::move(points_);
  result.mesh.triangles = std::move(triangles_);
  note_bends(result);
}

}  // namespace kaboum::io
