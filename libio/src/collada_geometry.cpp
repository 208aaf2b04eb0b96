// The faces of COLLADA's meshes: triangles, polygons, strips and fans, and their positions.
#include "collada_geometry.h"

#include <algorithm>
#include <string>
#include <utility>

namespace kaboum::io {

ColladaSurface ColladaGeometry::read(const XMLElement& geometry) {
  ColladaSurface surface;
  bool has_content = false;
  xml_.each(geometry, [&](const XMLElement& e) {
    const std::string_view name = e.Name();
    if (name == "extra") xml_.check_extra(e);
    if (name == "asset" || name == "extra") return;
    if (std::exchange(has_content, true)) xml_.fail(e, "a geometry with two contents");
    if (name == "mesh") {
      read_mesh(e, surface);
    } else if (name == "spline") {
      ++lines_;
    } else if (name == "convex_mesh" || name == "brep") {
      xml_.fail(e, tag(e) + " is not supported; export the scene as meshes");
    } else {
      xml_.fail_unknown(e);
    }
  });
  return surface;
}

void ColladaGeometry::read_mesh(const XMLElement& mesh, ColladaSurface& surface) {
  const XMLElement* vertices = nullptr;
  xml_.each(mesh, [&](const XMLElement& e) {
    if (!is_named(e, "vertices")) return;
    if (vertices != nullptr) xml_.fail(e, "a mesh with two <vertices>");
    vertices = &e;
  });
  if (vertices == nullptr) xml_.fail(mesh, "a mesh without <vertices>; the file is damaged");
  read_vertices(*vertices, surface.points);
  xml_.each(mesh, [&](const XMLElement& e) {
    const std::string_view name = e.Name();
    if (name == "triangles" || name == "polylist" || name == "polygons" || name == "trifans" ||
        name == "tristrips") {
      read_faces(e, *vertices, surface);
    } else if (name == "lines" || name == "linestrips") {
      ++lines_;
    } else if (name == "extra") {
      xml_.check_extra(e);
    } else if (name != "source" && name != "vertices") {
      xml_.fail_unknown(e);
    }
  });
}

void ColladaGeometry::read_vertices(const XMLElement& vertices, std::vector<geom::Vec3>& points) {
  const XMLElement* position = nullptr;
  xml_.each(vertices, [&](const XMLElement& e) {
    if (is_named(e, "extra")) {
      xml_.check_extra(e);
      return;
    }
    if (!is_named(e, "input")) xml_.fail_unknown(e);
    if (xml_.need(e, "semantic") != "POSITION") return;
    if (position != nullptr) xml_.fail(e, "vertices with two positions");
    position = &e;
  });
  if (position == nullptr) xml_.fail(vertices, "vertices without positions");
  read_points(xml_.referred(*position, "source", "source"), points);
}

void ColladaGeometry::read_points(const XMLElement& source, std::vector<geom::Vec3>& points) {
  const XMLElement* const technique = source.FirstChildElement("technique_common");
  const XMLElement* const accessor =
      technique != nullptr ? technique->FirstChildElement("accessor") : nullptr;
  if (accessor == nullptr || accessor->NextSiblingElement() != nullptr)
    xml_.fail(source, "positions without one <accessor>; the file is damaged");
  const XMLElement& array = xml_.referred(*accessor, "source", "float_array");
  const std::vector<double> values = read_array(array);
  const std::uint64_t count = xml_.natural(*accessor, "count", std::nullopt);
  const std::uint64_t stride = xml_.natural(*accessor, "stride", 1);
  const std::uint64_t offset = xml_.natural(*accessor, "offset", 0);
  const std::array<std::uint64_t, 3> axes = read_params(*accessor, stride);
  // The values are in memory, so none of this overflows.
  if (offset > values.size() || count * std::max<std::uint64_t>(stride, 1) > values.size() - offset)
    xml_.fail(*accessor, "an accessor takes more numbers than there are (" +
                             std::to_string(values.size()) + "); the file is damaged");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t first = offset + i * stride;
    points.emplace_back(values[first + axes[0]], values[first + axes[1]], values[first + axes[2]]);
  }
}

std::array<std::uint64_t, 3> ColladaGeometry::read_params(const XMLElement& accessor,
                                                          std::uint64_t stride) const {
  std::array<std::optional<std::uint64_t>, 3> axes;
  std::uint64_t number = 0;
  xml_.each(accessor, [&](const XMLElement& e) {
    if (!is_named(e, "param")) xml_.fail_unknown(e);
    constexpr std::array<std::string_view, 3> kNames = {"X", "Y", "Z"};
    for (std::size_t k = 0; k < 3; ++k) {
      if (attribute(e, "name") != kNames[k]) continue;
      if (axes[k]) xml_.fail(e, "positions with two parameters " + in_quotes(kNames[k]));
      axes[k] = number;
    }
    ++number;
  });
  if (!axes[0] || !axes[1] || !axes[2] || number > stride)
    xml_.fail(accessor,
              "positions need the parameters X, Y and Z, no more than the stride; "
              "export again");
  return {*axes[0], *axes[1], *axes[2]};
}

std::vector<double> ColladaGeometry::read_array(const XMLElement& array) const {
  const std::string text = xml_.text(array);
  std::string_view words = text;
  std::vector<double> values;
  for (auto word = next_word(words); !word.empty(); word = next_word(words))
    values.push_back(xml_.number(array, word));
  xml_.check_count(array, values.size(), "numbers");
  return values;
}

ColladaGeometry::Layout ColladaGeometry::read_inputs(const XMLElement& faces,
                                                     const XMLElement& vertices) const {
  Layout layout;
  xml_.each(faces, [&](const XMLElement& e) {
    if (!is_named(e, "input")) return;
    const std::uint64_t offset = xml_.natural(e, "offset", std::nullopt);
    if (offset > 1000) xml_.fail(e, "an offset out of range; the file is damaged");
    layout.stride = std::max(layout.stride, offset + 1);
    const std::string_view semantic = xml_.need(e, "semantic");
    if (semantic == "POSITION" || (semantic == "VERTEX" && layout.vertex))
      xml_.fail(e, "faces with two positions; export again");
    if (semantic != "VERTEX") return;
    if (&xml_.referred(e, "source", "vertices") != &vertices)
      xml_.fail(e, "faces of the vertices of another mesh; the file is damaged");
    layout.vertex = offset;
  });
  return layout;
}

void ColladaGeometry::read_faces(const XMLElement& faces, const XMLElement& vertices,
                                 ColladaSurface& surface) {
  const Layout layout = read_inputs(faces, vertices);
  const std::string_view kind = faces.Name();
  std::vector<std::uint32_t> sizes;  // of polylist
  std::vector<const XMLElement*> lists;
  bool has_sizes = false;
  xml_.each(faces, [&](const XMLElement& e) {
    if (is_named(e, "p")) {
      lists.push_back(&e);
    } else if (is_named(e, "vcount") && kind == "polylist") {
      if (std::exchange(has_sizes, true)) xml_.fail(e, "a second <vcount>");
      sizes = xml_.integers(e);
    } else if (is_named(e, "ph")) {
      xml_.fail(e, "polygons with holes are not supported; triangulate before exporting");
    } else if (is_named(e, "extra")) {
      xml_.check_extra(e);
    } else if (!is_named(e, "input")) {
      xml_.fail_unknown(e);
    }
  });
  if (!lists.empty() && !layout.vertex) xml_.fail(faces, "faces without vertices");
  if (kind == "triangles" || kind == "polylist") {
    if (lists.size() > 1) xml_.fail(*lists[1], "a second <p>; the file is damaged");
    const std::vector<std::uint32_t> corners =
        lists.empty() ? std::vector<std::uint32_t>{} : corners_of(*lists[0], layout, surface);
    if (kind == "triangles") {
      if (corners.size() % 3 != 0)
        xml_.fail(faces, "triangles of which one is not complete; the file is damaged");
      sizes.assign(corners.size() / 3, 3);
    }
    xml_.check_count(faces, sizes.size(), "faces");
    add_faces(lists.empty() ? faces : *lists[0], corners, sizes, surface);
    return;
  }
  xml_.check_count(faces, lists.size(), "<p>");
  for (const XMLElement* const list : lists) {
    const std::vector<std::uint32_t> corners = corners_of(*list, layout, surface);
    if (kind == "polygons") {
      const std::array size = {static_cast<std::uint32_t>(corners.size())};
      add_faces(*list, corners, size, surface);
      continue;
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const bool fan = kind == "trifans";
      const std::uint32_t a = corners[fan ? 0 : i - 2], b = corners[i - 1], c = corners[i];
      // Every other triangle of a strip runs backwards.
      const bool turned = !fan && i % 2 == 1;
      const std::array triangle = {turned ? b : a, turned ? a : b, c};
      add_faces(*list, triangle, std::array{3U}, surface);
    }
  }
}

void ColladaGeometry::add_faces(const XMLElement& list, std::span<const std::uint32_t> corners,
                                std::span<const std::uint32_t> sizes,
                                ColladaSurface& surface) const {
  std::uint64_t sum = 0;
  for (const std::uint32_t size : sizes) sum += size;
  if (sum != corners.size())
    xml_.fail(list, "faces of " + std::to_string(sum) + " corners, but there are " +
                        std::to_string(corners.size()) + "; the file is damaged");
  surface.corners.insert(surface.corners.end(), corners.begin(), corners.end());
  for (const std::uint32_t size : sizes) surface.faces.push_back({size, xml_.where(list)});
}

std::vector<std::uint32_t> ColladaGeometry::corners_of(const XMLElement& list, const Layout& layout,
                                                       const ColladaSurface& surface) const {
  const std::vector<std::uint32_t> all = xml_.integers(list);
  if (all.size() % layout.stride != 0)
    xml_.fail(list, std::to_string(all.size()) + " numbers for corners of " +
                        std::to_string(layout.stride) + " each; the file is damaged");
  std::vector<std::uint32_t> corners;
  for (std::size_t i = *layout.vertex; i < all.size(); i += layout.stride) {
    if (all[i] >= surface.points.size())
      xml_.fail(list, "a face refers to vertex " + std::to_string(all[i]) + ", but there are " +
                          std::to_string(surface.points.size()) +
                          " (counted from 0); the file is damaged");
    corners.push_back(all[i]);
  }
  return corners;
}

}  // namespace kaboum::io
