// Surfaces of VRML 97 and X3D: points, and faces as polygons, strips and fans of them.
#include "scene_shapes.h"

#include <algorithm>
#include <array>
#include <string>

#include "scene_nodes.h"

namespace kaboum::io {
namespace {

/// The field that says which points make faces; empty when their order does.
std::string_view index_name(std::string_view type) {
  if (type == "IndexedFaceSet") return "coordIndex";
  if (type.starts_with("Indexed")) return "index";
  if (type == "TriangleStripSet") return "stripCount";
  if (type == "TriangleFanSet") return "fanCount";
  return "";
}

}  // namespace

void ShapeReader::read_shape(const SceneNode& node, const Placement& placement) {
  for (const SceneField& field : node.fields) {
    if (field.name == "geometry") {
      if (const SceneNode* const geometry = fields_.only(field))
        read_geometry(*geometry, placement);
    } else if (field.name == "appearance") {
      const SceneNode* const appearance = fields_.only(field);
      if (appearance != nullptr && appearance->type != "Appearance")
        fields_.fail_field(node, field);
    } else if (!contains(kGroupFields, field.name) && !fields_.read_common(field)) {
      fields_.fail_field(node, field);
    }
  }
}

void ShapeReader::read_geometry(const SceneNode& node, const Placement& placement) {
  if (contains(kLines, node.type)) {
    ++lines_;
    return;
  }
  if (node.type == "Box") {
    read_box(node, placement);
    return;
  }
  if (!contains(kSurfaces, node.type))
    fields_.fail_at(node.where, "the geometry node " + in_quotes(node.type) +
                                    " is not supported; export the scene as IndexedFaceSet");
  bool counter_clockwise = true;
  const SceneField* coordinates = nullptr;
  const SceneField* index = nullptr;
  for (const SceneField& field : node.fields) {
    if (field.name == "coord") {
      coordinates = &field;
    } else if (field.name == "ccw") {
      counter_clockwise = fields_.read_bool(field);
    } else if (field.name == index_name(node.type)) {
      index = &field;
    } else if (!contains(kSurfaceFields, field.name)) {
      fields_.fail_field(node, field);
    }
  }
  if (index != nullptr) copier_.spend(index->text);
  points_.clear();
  if (coordinates != nullptr)
    if (const SceneNode* const points = fields_.only(*coordinates)) read_points(*points);
  copier_.add_points(points_, placement, outermost(node.where));
  read_faces(node, index, !counter_clockwise);
}

void ShapeReader::read_box(const SceneNode& node, const Placement& placement) {
  geom::Vec3 size(2, 2, 2);  // ISO/IEC 14772-1, 6.8
  for (const SceneField& field : node.fields) {
    if (field.name == "size") {
      fields_.read_vector(field, size);
    } else if (field.name != "solid" && !fields_.read_common(field)) {
      fields_.fail_field(node, field);
    }
  }
  if (!(size.minCoeff() > 0))
    fields_.fail_at(node.where, "a Box has a size of three lengths above 0");
  points_.clear();
  for (unsigned i = 0; i < 8; ++i)
    points_.emplace_back((i & 1U) != 0 ? size.x() / 2 : -size.x() / 2,
                         (i & 2U) != 0 ? size.y() / 2 : -size.y() / 2,
                         (i & 4U) != 0 ? size.z() / 2 : -size.z() / 2);
  const char* const where = outermost(node.where);
  copier_.spend(8);
  copier_.add_points(points_, placement, where);
  using Side = std::array<std::uint32_t, 4>;
  for (const Side& side : {Side{0, 4, 6, 2}, Side{1, 3, 7, 5}, Side{0, 1, 5, 4}, Side{2, 6, 7, 3},
                           Side{0, 2, 3, 1}, Side{4, 5, 7, 6}})
    copier_.add_face(side, where);
}

void ShapeReader::read_points(const SceneNode& node) {
  if (node.type != "Coordinate" && node.type != "CoordinateDouble")
    fields_.fail_at(node.where, in_quotes(node.type) +
                                    " where 'Coordinate' is expected; export the "
                                    "scene with plain coordinates");
  for (const SceneField& field : node.fields) {
    if (field.name == "point") {
      std::string_view text = field.text;
      copier_.spend(text);
      for (auto v = fields_.next_value(text); !v.empty(); v = fields_.next_value(text)) {
        geom::Vec3 p;
        p.x() = fields_.number(field, v);
        p.y() = fields_.number(field, fields_.next_value(text));
        p.z() = fields_.number(field, fields_.next_value(text));
        points_.push_back(p);
      }
    } else if (!fields_.read_common(field)) {
      fields_.fail_field(node, field);
    }
  }
}

void ShapeReader::read_faces(const SceneNode& node, const SceneField* index, bool reversed) {
  const std::string_view type = node.type;
  const Run run = type.ends_with("StripSet") ? Run::Strip
                  : type.ends_with("FanSet") ? Run::Fan
                                             : Run::Polygon;
  const std::size_t corners = type.ends_with("QuadSet") ? 4 : 3;
  const bool separated = type == "IndexedFaceSet" || run != Run::Polygon;
  const char* const where = index != nullptr ? index->where : node.where;
  if (type.starts_with("Indexed")) {
    if (index == nullptr) return;
    read_indices(*index, separated ? 0 : corners, run, reversed);
    return;
  }
  // Points in order: in runs of stated lengths, or all alike.
  std::vector<std::int64_t> counts;
  if (run != Run::Polygon) {
    if (index != nullptr) counts = fields_.read_integers(*index);
  } else {
    counts.assign(points_.size() / corners, static_cast<std::int64_t>(corners));
  }
  std::uint64_t sum = 0;
  for (const std::int64_t count : counts) {
    if (count < 3 || count > 0xFFFFFFFFLL)
      fields_.fail_at(where, "a run of " + std::to_string(count) + " points; the file is damaged");
    sum += static_cast<std::uint64_t>(count);
  }
  if (sum != points_.size())
    fields_.fail_at(where, std::string(type) + " has " + std::to_string(points_.size()) +
                               " points, but faces of " + std::to_string(sum) +
                               "; the file is damaged");
  std::uint32_t next = 0;
  for (const std::int64_t count : counts) {
    corners_.clear();
    for (std::int64_t i = 0; i < count; ++i) corners_.push_back(next++);
    add_run(run, reversed, where);
  }
}

void ShapeReader::read_indices(const SceneField& index, std::size_t size, Run run, bool reversed) {
  corners_.clear();
  const char* last = index.where;
  std::string_view text = index.text;
  for (auto v = fields_.next_value(text); !v.empty(); v = fields_.next_value(text)) {
    const std::int64_t i = fields_.integer(index, v);
    if (fields_.has_places()) last = v.data();
    if (i == -1 && size == 0) {
      add_run(run, reversed, last);
      continue;
    }
    if (i < 0 || static_cast<std::uint64_t>(i) >= points_.size())
      fields_.fail_value(index, v,
                         "a face refers to vertex " + std::to_string(i) + ", but there are " +
                             std::to_string(points_.size()) +
                             " (counted from 0); the file is damaged");
    corners_.push_back(static_cast<std::uint32_t>(i));
    if (corners_.size() == size) add_run(run, reversed, last);
  }
  if (!corners_.empty() && size != 0)
    fields_.fail_at(index.where, "the last face has " + std::to_string(corners_.size()) +
                                     " corners; the file is damaged");
  add_run(run, reversed, last);
}

void ShapeReader::add_run(Run run, bool reversed, const char* where) {
  if (run == Run::Polygon) {
    if (reversed) std::ranges::reverse(corners_);
    if (!corners_.empty()) copier_.add_face(corners_, outermost(where));
  } else {
    for (std::size_t i = 2; i < corners_.size(); ++i) {
      std::array triangle = {corners_[run == Run::Fan ? 0 : i - 2], corners_[i - 1], corners_[i]};
      // Every other triangle of a strip runs backwards.
      if ((run == Run::Strip && i % 2 == 1) != reversed) std::swap(triangle[0], triangle[1]);
      copier_.add_face(triangle, outermost(where));
    }
  }
  corners_.clear();
}

}  // namespace kaboum::io
