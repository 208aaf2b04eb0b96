#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collada_document.h"

namespace kaboum::io {

/// The faces of a <geometry>.
struct ColladaSurface {
  struct Face {
    std::uint32_t corners;  ///< how many
    const char* where;
  };
  std::vector<geom::Vec3> points;
  std::vector<std::uint32_t> corners;  ///< of all faces
  std::vector<Face> faces;
};

/// Reads the surfaces of a document's <geometry> elements. Internal to kaboum_io.
class ColladaGeometry {
 public:
  using XMLElement = tinyxml2::XMLElement;

  explicit ColladaGeometry(const ColladaDocument& xml) : xml_(xml) {}

  ColladaSurface read(const XMLElement& geometry);
  /// Sets of lines that were passed over.
  [[nodiscard]] std::size_t lines() const { return lines_; }

 private:
  /// Where the vertex is among the numbers of a corner.
  struct Layout {
    std::uint64_t stride = 0;
    std::optional<std::uint64_t> vertex = {};
  };

  void read_mesh(const XMLElement& mesh, ColladaSurface& surface);

  void read_vertices(const XMLElement& vertices, std::vector<geom::Vec3>& points);

  void read_points(const XMLElement& source, std::vector<geom::Vec3>& points);

  /// Places of X, Y and Z among the numbers of a vertex. Unnamed parameters are passed over.
  [[nodiscard]] std::array<std::uint64_t, 3> read_params(const XMLElement& accessor,
                                                         std::uint64_t stride) const;

  [[nodiscard]] std::vector<double> read_array(const XMLElement& array) const;

  [[nodiscard]] Layout read_inputs(const XMLElement& faces, const XMLElement& vertices) const;

  void read_faces(const XMLElement& faces, const XMLElement& vertices, ColladaSurface& surface);

  void add_faces(const XMLElement& list, std::span<const std::uint32_t> corners,
                 std::span<const std::uint32_t> sizes, ColladaSurface& surface) const;

  /// The vertices of a <p>, range-checked.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const XMLElement& list, const Layout& layout,
                                                      const ColladaSurface& surface) const;

  const ColladaDocument& xml_;
  std::size_t lines_ = 0;
};

}  // namespace kaboum::io
