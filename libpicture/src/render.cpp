// Meshes drawn in software.

#include <kaboum/base/error.h>
#include <kaboum/picture/render.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <vector>

namespace kaboum::picture {
namespace {

using geom::Vec3;
constexpr int kSamples = 2;  // per pixel and direction
constexpr double kLargest = 1e60;
constexpr float kFar = std::numeric_limits<float>::infinity();

/// The panel in samples.
struct Buffer {
  int width, height;
  std::vector<Colour> colour;
  std::vector<float> depth;
  std::vector<float> ink;  // how much an edge darkens the sample

  Buffer(int w, int h) : width(w), height(h) {
    const std::size_t size = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    colour.resize(size);
    depth.assign(size, kFar);
    ink.assign(size, 0.0F);
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

Colour times(const Colour& c, double f) {
  Colour result{};
  for (std::size_t k = 0; k < 3; ++k) result[k] = std::min(1.0F, c[k] * static_cast<float>(f));
  return result;
}

/// Key light from the viewer's upper right, weak fill light from the left, light from the sky.
double brightness(const Vec3& normal, const Camera& camera) {
  const Vec3 key = (0.55 * camera.right() + 0.75 * camera.up() + 0.75 * camera.back()).normalized();
  const Vec3 fill = (-0.9 * camera.right() - 0.1 * camera.up() + 0.4 * camera.back()).normalized();
  const double sky = 0.5 + 0.5 * normal.z();
  return 0.36 + 0.60 * std::max(0.0, normal.dot(key)) + 0.20 * std::max(0.0, normal.dot(fill)) +
         0.16 * sky;
}

/// `colour` holds the corners' colours.
void fill_triangle(Buffer& buffer, const Vec3& a, const Vec3& b, const Vec3& c,
                   const std::array<Colour, 3>& colour) {
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (!(std::abs(area) > 0)) return;
  const double inverse = 1 / area;
  const auto low = [](double x, double y, double z) {
    return static_cast<int>(std::clamp(std::ceil(std::min({x, y, z}) - 0.5), 0.0, 1e6));
  };
  const auto high = [](double x, double y, double z, int limit) {
    return static_cast<int>(
        std::clamp(std::floor(std::max({x, y, z}) - 0.5), -1.0, static_cast<double>(limit - 1)));
  };
  const int x1 = high(a.x(), b.x(), c.x(), buffer.width),
            y1 = high(a.y(), b.y(), c.y(), buffer.height);
  for (int y = low(a.y(), b.y(), c.y()); y <= y1; ++y) {
    for (int x = low(a.x(), b.x(), c.x()); x <= x1; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((b.x() - px) * (c.y() - py) - (b.y() - py) * (c.x() - px)) * inverse;
      const double v = ((c.x() - px) * (a.y() - py) - (c.y() - py) * (a.x() - px)) * inverse;
      if (!(u >= 0 && v >= 0 && u + v <= 1)) continue;
      const auto z = static_cast<float>(u * a.z() + v * b.z() + (1 - u - v) * c.z());
      const std::size_t i = buffer.index(x, y);
      if (z >= buffer.depth[i]) continue;
      buffer.depth[i] = z;
      for (std::size_t k = 0; k < 3; ++k)
        buffer.colour[i][k] =
            static_cast<float>(u * colour[0][k] + v * colour[1][k] + (1 - u - v) * colour[2][k]);
    }
  }
}

/// A line of about `thickness` samples where the surface does not hide it.
void draw_line(Buffer& buffer, const Vec3& a, const Vec3& b, double bias, double thickness,
               float darkness) {
  const Vec3 d = b - a;
  const bool steep = std::abs(d.y()) > std::abs(d.x());
  const int major = steep ? 1 : 0, minor = 1 - major;
  const double length = std::abs(d[major]);
  if (length == 0) return;
  const int limit = steep ? buffer.height : buffer.width,
            other = steep ? buffer.width : buffer.height;
  const double from = std::min(a[major], b[major]), to = std::max(a[major], b[major]);
  const double across = thickness * d.head<2>().norm() / length / 2;
  const int first = std::max(0, static_cast<int>(std::ceil(from - 0.5)));
  const int last = std::min(limit - 1, static_cast<int>(std::floor(to - 0.5)));
  for (int i = first; i <= last; ++i) {
    const double t = (i + 0.5 - a[major]) / d[major];
    const double centre = a[minor] + t * d[minor];
    const auto z = static_cast<float>(a.z() + t * d.z() - bias);
    const int j0 = std::max(0, static_cast<int>(std::floor(centre - across)));
    const int j1 = std::min(other - 1, static_cast<int>(std::floor(centre + across)));
    for (int j = j0; j <= j1; ++j) {
      const std::size_t at = steep ? buffer.index(j, i) : buffer.index(i, j);
      const double cover =
          std::min(centre + across, j + 1.0) - std::max(centre - across, static_cast<double>(j));
      if (z > buffer.depth[at] || cover <= 0) continue;
      buffer.ink[at] = std::max(buffer.ink[at], darkness * static_cast<float>(cover));
    }
  }
}

/// An edge and the normals on its two sides.
struct Side {
  Vec3 normal = Vec3::Zero();
  int uses = 0;
  bool sharp = false;
};

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

void draw_edges(Buffer& buffer, const geom::Mesh& mesh, const std::vector<Vec3>& image,
                const std::vector<Vec3>& normals, double bias, bool all) {
  std::unordered_map<std::uint64_t, Side> sides;
  sides.reserve(2 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      Side& side = sides[edge_key(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3])];
      if (side.uses > 0 && side.normal.dot(normals[i]) < 0.8) side.sharp = true;  // 37°
      side.normal = normals[i];
      ++side.uses;
    }
  }
  for (const auto& [key, side] : sides) {
    const bool sharp = side.sharp || side.uses == 1;
    if (!sharp && !all) continue;
    draw_line(buffer, image[key >> 32], image[key & 0xffffffffU], bias, sharp ? 2.0 : 1.2,
              sharp ? 0.75F : 0.38F);
  }
}

}  // namespace

Camera::Camera(const geom::Box3& box, const View& view, int width, int height) {
  const double azimuth = view.azimuth * std::numbers::pi / 180;
  const double elevation = view.elevation * std::numbers::pi / 180;
  back_ = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
           std::sin(elevation)};
  right_ = {-std::sin(azimuth), std::cos(azimuth), 0};
  up_ = back_.cross(right_);
  const Vec3 centre = box.empty() ? Vec3::Zero() : box.center();
  const double diagonal = box.diagonal() > 0 ? box.diagonal() : 1;
  distance_ = 4 * diagonal;
  eye_ = centre + distance_ * back_;
  // Fit the images of the box's corners.
  Eigen::Array2d low(1e300, 1e300), high(-1e300, -1e300);
  for (int i = 0; i < 8 && !box.empty(); ++i) {
    const Vec3 corner((i & 1) != 0 ? box.max.x() : box.min.x(),
                      (i & 2) != 0 ? box.max.y() : box.min.y(),
                      (i & 4) != 0 ? box.max.z() : box.min.z());
    const Vec3 image = project(corner);
    low = low.min(image.head<2>().array());
    high = high.max(image.head<2>().array());
  }
  if (box.empty()) low = -1, high = 1;
  const double margin = 0.05 * std::min(width, height);
  scale_ = std::min((width - 2 * margin) / std::max(high.x() - low.x(), 1e-300),
                    (height - 2 * margin) / std::max(high.y() - low.y(), 1e-300));
  middle_x_ = width / 2.0 - scale_ * (low.x() + high.x()) / 2;
  middle_y_ = height / 2.0 - scale_ * (low.y() + high.y()) / 2;
}

geom::Vec3 Camera::project(const geom::Vec3& p) const {
  const Vec3 q = p - eye_;
  const double away = -q.dot(back_);
  // Depth −1/away is linear on the images of planes; shifted and scaled for float's sake.
  return {middle_x_ + scale_ * q.dot(right_) / away, middle_y_ - scale_ * q.dot(up_) / away,
          1 - distance_ / away};
}

bool sees(const Camera& camera, const geom::Mesh& mesh, const geom::Vec3& point, double slack) {
  const Vec3 ray = camera.eye() - point;
  const double least = slack * geom::bounding_box(mesh).diagonal() / ray.norm();
  for (const geom::Triangle& t : mesh.triangles) {
    // Möller and Trumbore's intersection, from the point to the eye.
    const Vec3 &a = mesh.vertices[t[0]], e1 = mesh.vertices[t[1]] - a, e2 = mesh.vertices[t[2]] - a;
    const Vec3 p = ray.cross(e2), s = point - a, q = s.cross(e1);
    const double determinant = e1.dot(p);
    if (determinant == 0) continue;
    const double u = s.dot(p) / determinant, v = ray.dot(q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && e2.dot(q) / determinant > least) return false;
  }
  return true;
}

void draw_mesh(Image& image, int left, int top, int width, int height, const geom::Mesh& mesh,
               const Camera& camera, const Style& style) {
  Buffer buffer(kSamples * width, kSamples * height);
  std::vector<Vec3> projected;
  projected.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) {
    Vec3 q = camera.project(p);
    q.head<2>() *= kSamples;
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kLargest || !q.allFinite() ||
        q.cwiseAbs().maxCoeff() > kLargest)
      throw Error(ErrorCode::InvalidInput,
                  "a vertex with a coordinate that is not finite, or beyond 1e60, cannot be drawn");
    projected.push_back(q);
  }
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size());
  for (const geom::Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    normals.push_back(normal);
    const bool front = normal.dot(camera.eye() - a) >= 0;
    const Colour surface =
        style.of_triangle.empty() ? style.surface : style.of_triangle[normals.size() - 1];
    const double light = brightness(front ? normal : Vec3(-normal), camera);
    std::array<Colour, 3> base;
    base.fill(times(front ? surface : Colour{0.62F, 0.36F, 0.34F}, light));
    if (!style.vertex_colours.empty())
      for (std::size_t k = 0; k < 3; ++k) base[k] = times(style.vertex_colours[t[k]], light);
    fill_triangle(buffer, projected[t[0]], projected[t[1]], projected[t[2]], base);
  }
  if (style.edges || style.outlines)
    draw_edges(buffer, mesh, projected, normals, 8e-4, style.edges);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Colour& pixel = image.at(left + x, top + y);
      Colour sum{};
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const std::size_t i =
            buffer.index(kSamples * x + s % kSamples, kSamples * y + s / kSamples);
        const Colour& c = buffer.depth[i] < kFar ? buffer.colour[i] : pixel;
        for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k] * (1 - buffer.ink[i]);
      }
      for (std::size_t k = 0; k < 3; ++k) pixel[k] = sum[k] / (kSamples * kSamples);
    }
  }
}

}  // namespace kaboum::picture
