// Convex sets as Wavefront OBJ: one `o` group per body.

#include <kaboum/geom/topology.h>

#include <limits>

#include "builder.h"
#include "bytes.h"
#include "convex_formats.h"
#include "formats.h"
#include "output.h"
#include "text.h"

namespace kaboum::io {
namespace {

/// Faces of a group; corners are indices into the file's vertices.
struct Group {
  std::string name;
  struct Face {
    std::size_t first, count;
    const char* where;
  };
  std::vector<Face> faces;
};

/// Splits the file into groups. The mesh reader has accepted it before, so what is checked there
/// (numbers, indices in range) holds here.
class GroupReader {
 public:
  explicit GroupReader(const Source& source)
      : source_(source), scan_(source, {.comments = true, .continuation = true}) {}

  std::vector<Group> read() {
    for (; !scan_.done(); scan_.skip_line()) {
      const std::string_view record = scan_.token_on_line();
      if (record == "v") {
        geom::Vec3 p;
        for (double& x : p) x = parse_coordinate(source_, scan_.token_on_line());
        points_.push_back(p);
      } else if (record == "o" || record == "g") {
        const std::string_view name = scan_.token_on_line();
        if (groups_.empty() || !groups_.back().faces.empty()) groups_.emplace_back();
        groups_.back().name = name;
      } else if (record == "f" || record == "fo") {
        read_face();
      }
    }
    if (!groups_.empty() && groups_.back().faces.empty()) groups_.pop_back();
    return std::move(groups_);
  }

  geom::Mesh mesh_of(const Group& group, std::vector<std::string>& notes) {
    MeshBuilder builder(source_);
    std::vector<std::uint32_t> corners;
    for (const Group::Face& face : group.faces) {
      corners.clear();
      for (std::size_t i = face.first; i < face.first + face.count; ++i) {
        std::uint32_t& number = number_[corners_[i]];
        if (number == kUnset) {
          number = static_cast<std::uint32_t>(used_.size());
          used_.push_back(corners_[i]);
          builder.add_point(points_[corners_[i]], face.where);
        }
        corners.push_back(number);
      }
      builder.add_face(corners, face.where);
    }
    for (const std::uint32_t v : used_) number_[v] = kUnset;
    used_.clear();
    ReadResult result = builder.finish(Format::Obj, false);
    for (std::string& note : result.notes) notes.push_back(group.name + ": " + note);
    return std::move(result.mesh);
  }

  void prepare_numbers() { number_.assign(points_.size(), kUnset); }

 private:
  static constexpr std::uint32_t kUnset = 0xFFFFFFFF;

  void read_face() {
    if (groups_.empty()) groups_.emplace_back();
    const char* const where = scan_.last();
    const std::size_t first = corners_.size();
    for (std::string_view token = scan_.token_on_line(); !token.empty();
         token = scan_.token_on_line()) {
      const std::int64_t index =
          parse_integer(source_, token.substr(0, token.find('/')), "a vertex index");
      const auto count = static_cast<std::int64_t>(points_.size());
      corners_.push_back(static_cast<std::uint32_t>(index < 0 ? count + index : index - 1));
    }
    groups_.back().faces.push_back({first, corners_.size() - first, where});
  }

  const Source& source_;
  Scanner scan_;
  std::vector<geom::Vec3> points_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> number_, used_;
};

}  // namespace

std::optional<geom::ConvexSet> read_obj_set(const Source& source, SetReadDetails& details) {
  read_obj(source);  // refuses what is damaged
  GroupReader reader(source);
  const std::vector<Group> groups = reader.read();
  if (groups.size() < 2) return std::nullopt;
  reader.prepare_numbers();
  geom::ConvexSet set;
  for (const Group& group : groups) {
    set.bodies.push_back({group.name.empty() ? default_name(set.bodies.size()) : group.name,
                          reader.mesh_of(group, details.notes)});
  }
  return set;
}

std::vector<char> write_obj_set(const geom::ConvexSet& set) {
  Output out;
  const std::string record =
      record_of(set).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  // A blank at the end: a backslash there would swallow the next line.
  out.text("# KABouM convex set, one object per body\n# " + one_line(record) + " \n");
  std::uint32_t first = 1;
  for (const geom::ConvexBody& body : set.bodies) {
    std::string name = one_line(body.name);
    for (char& c : name)
      if (c == ' ' || c == '#' || c == '\\') c = '_';
    out.text("o " + name + "\n");
    for (const geom::Vec3& p : body.core.vertices) {
      out.text("v");
      for (const double x : p) {
        out.text(" ");
        out.number(x);
      }
      out.text("\n");
    }
    for (const geom::Triangle& t : body.core.triangles) {
      out.text("f");
      for (const std::uint32_t corner : t) {
        out.text(" ");
        out.number(first + corner);
      }
      out.text("\n");
    }
    first += static_cast<std::uint32_t>(body.core.vertices.size());
  }
  return out.take();
}

}  // namespace kaboum::io
