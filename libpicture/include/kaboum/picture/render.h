#pragma once

#include <kaboum/picture/image.h>

#include <kaboum/geom/mesh.h>

#include <span>
#include <vector>

namespace kaboum::picture {

/// Where the camera stands: a long way off, looking at the box's centre, z upwards.
struct View {
  double azimuth = -50;   ///< degrees from the x axis towards y
  double elevation = 28;  ///< degrees above the horizon
};

/// A camera that sees the whole box in a panel of the given size.
class Camera {
 public:
  Camera(const geom::Box3& box, const View& view, int width, int height);

  /// Pixel coordinates (x right, y down) and a depth that grows away from the viewer and is linear
  /// on the image of a plane.
  [[nodiscard]] geom::Vec3 project(const geom::Vec3& p) const;
  [[nodiscard]] const geom::Vec3& right() const { return right_; }
  [[nodiscard]] const geom::Vec3& up() const { return up_; }
  [[nodiscard]] const geom::Vec3& back() const { return back_; }  ///< towards the viewer
  [[nodiscard]] const geom::Vec3& eye() const { return eye_; }

 private:
  geom::Vec3 right_, up_, back_, eye_;
  double scale_ = 1, distance_ = 1, middle_x_ = 0, middle_y_ = 0;
};

struct Style {
  Colour surface{0.66F, 0.68F, 0.71F};
  bool edges = false;    ///< draw every edge; otherwise only sharp ones and borders
  bool outlines = true;  ///< draw sharp edges and borders
  /// One colour per vertex, blended across triangles, instead of `surface`; empty: none.
  std::span<const Colour> vertex_colours;
  std::vector<Colour> of_triangle;  ///< per triangle, in place of `surface`; or empty
};

/// Whether the surface hides no more than `slack` (relative to the box's diagonal) in front of the
/// point from the camera.
bool sees(const Camera& camera, const geom::Mesh& mesh, const geom::Vec3& point, double slack);

/// Draws the mesh into the panel whose left edge is at `left`: flat shading, z-buffer, two by two
/// samples per pixel. Back faces are shown in dull red, so a wrong orientation is seen.
/// @pre indices in range; coordinates finite.
void draw_mesh(Image& image, int left, int top, int width, int height, const geom::Mesh& mesh,
               const Camera& camera, const Style& style);

}  // namespace kaboum::picture
