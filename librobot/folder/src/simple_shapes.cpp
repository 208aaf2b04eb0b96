// Spheres, capsules and boxes of robots in the formats of engines.
#include <kaboum/robot/sdf.h>
#include <kaboum/robot_folder/new_shapes.h>
#include <kaboum/robot_folder/simple_shapes.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "collision_urdf.h"

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;

using geom::Vec3;
using Kind = SimpleShape::Kind;

/// Of lengths: more than what a dozen operations and a rotation from its angles, or from the
/// quaternion that stands for them, err by: 510 · 2^-53 (docs/algorithms/capsules-and-boxes.md,
/// "Robots").
constexpr double kPoseRounding = 0x1p-43;

/// Angles whose rotation is about that of the matrix.
Vec3 rpy_of(const Eigen::Matrix3d& m) {
  return {std::atan2(m(2, 1), m(2, 2)), std::asin(std::clamp(-m(2, 0), -1.0, 1.0)),
          std::atan2(m(1, 0), m(0, 0))};
}

double largest_of(const std::vector<Vec3>& points) {
  double out = 0;
  for (const Vec3& p : points) out = std::max(out, p.norm());
  return out;
}

SimpleShape sphere_of(const robot::LinkBody& body) {
  const double error = kPoseRounding * (body.points[0].norm() + body.margin);
  return {Kind::Sphere, body.link, body.points[0], Vec3::Zero(), Vec3(body.margin + error, 0, 0)};
}

/// The capsule whose axis is along the rotation of angles, round balls of the margin about the two
/// points: both are measured along it, however well the angles fit.
SimpleShape capsule_of(const robot::LinkBody& body) {
  const Vec3 along = body.points[1] - body.points[0];
  // The angle from z; its cosine would not tell small ones apart.
  const Vec3 rpy(0, std::atan2(std::hypot(along.x(), along.y()), along.z()),
                 std::atan2(along.y(), along.x()));
  const Eigen::Matrix3d turn = robot::rotation_from_rpy(rpy.x(), rpy.y(), rpy.z());
  const Vec3 a = turn.transpose() * body.points[0], b = turn.transpose() * body.points[1];
  const double length = std::abs(b.z() - a.z()),
               beside = 0.5 * std::hypot(b.x() - a.x(), b.y() - a.y());
  const double error = kPoseRounding * (largest_of(body.points) + length + body.margin);
  return {Kind::Capsule, body.link, turn * (0.5 * (a + b)), rpy,
          Vec3(body.margin + beside + error, length, 0)};
}

/// The box along the rotation of angles, round balls of the margin about the points.
SimpleShape box_along(const robot::LinkBody& body, const Vec3& rpy) {
  const Eigen::Matrix3d turn = robot::rotation_from_rpy(rpy.x(), rpy.y(), rpy.z());
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : body.points) {
    const Vec3 q = turn.transpose() * p;
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const double error = kPoseRounding * (largest_of(body.points) + body.margin);
  return {Kind::Box, body.link, turn * (0.5 * (low + high)), rpy,
          high - low + Vec3::Constant(2 * (body.margin + error))};
}

SimpleShape box_of(const robot::LinkBody& body) {
  const std::vector<Vec3>& p = body.points;
  SimpleShape best = box_along(body, Vec3::Zero());
  for (std::size_t i = 1; i < p.size(); ++i)
    for (std::size_t k = 1; k < p.size(); ++k) {
      if (i == k) continue;
      Eigen::Matrix3d axes;
      axes.col(0) = (p[i] - p[0]).normalized();
      const Vec3 other = p[k] - p[0] - (p[k] - p[0]).dot(axes.col(0)) * axes.col(0);
      axes.col(1) = other.normalized();
      axes.col(2) = axes.col(0).cross(axes.col(1));
      if (!axes.allFinite() || !(axes.determinant() > 0.9)) continue;
      const SimpleShape one = box_along(body, rpy_of(axes));
      if (one.size.prod() < best.size.prod() * (1 - 1e-9)) best = one;
    }
  return best;
}

/// How far the box reaches beyond the body at most, by its corners.
double beyond_of(const SimpleShape& box, const robot::LinkBody& body) {
  const Eigen::Matrix3d turn = robot::rotation_from_rpy(box.rpy.x(), box.rpy.y(), box.rpy.z());
  double out = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 half = 0.5 * box.size;
    const Vec3 corner = box.center + turn * Vec3((i & 1) != 0 ? half.x() : -half.x(),
                                                 (i & 2) != 0 ? half.y() : -half.y(),
                                                 (i & 4) != 0 ? half.z() : -half.z());
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& p : body.points) nearest = std::min(nearest, (p - corner).norm());
    out = std::max(out, nearest);
  }
  return out * (1 + 1e-12);
}

void add_shape(tinyxml2::XMLElement& link, const SimpleShape& shape) {
  if (shape.kind == Kind::Box) {
    add_collision(link, shape.center, shape.rpy)
        ->InsertNewChildElement("box")
        ->SetAttribute("size", decimals(shape.size).c_str());
    return;
  }
  const std::string radius = decimal(shape.size.x()), length = decimal(shape.size.y());
  const auto add = [&](const char* kind, const Vec3& center, const Vec3& rpy) {
    tinyxml2::XMLElement* round = add_collision(link, center, rpy)->InsertNewChildElement(kind);
    round->SetAttribute("radius", radius.c_str());
    if (std::string_view(kind) != "sphere") round->SetAttribute("length", length.c_str());
  };
  if (shape.kind == Kind::Sphere) return add("sphere", shape.center, shape.rpy);
  if (has_capsules(*link.GetDocument())) return add("capsule", shape.center, shape.rpy);
  for (const robot::Geometry& part : robot::parts_of_capsule(geometry_of(shape)))
    if (part.shape == robot::Geometry::Shape::Sphere)
      add("sphere", part.origin.translation, Vec3::Zero());
    else
      add("cylinder", shape.center, shape.rpy);
}

/// A capsule of next to no length.
bool is_short(const SimpleShape& shape) {
  constexpr double kShort = 1e-9;
  return shape.kind == Kind::Capsule && !(shape.size.y() > kShort * shape.size.x());
}

/// The shape, or for a capsule of next to no length a sphere: MJCF refuses lengths of 0.
SimpleShape engine_shape(SimpleShape shape) {
  if (!is_short(shape)) return shape;
  shape.kind = Kind::Sphere;
  shape.size.x() = (shape.size.x() + shape.size.y()) * (1 + 1e-15);
  return shape;
}

/// By link, for engines' formats.
std::map<std::size_t, std::vector<robot::Primitive>> primitives_of(
    const certify::CertifiedBodies& bodies, const SimpleShapes& shapes) {
  std::map<std::size_t, std::vector<robot::Primitive>> out;
  for (const robot::LinkShape& shape : bodies.certificate().shapes) out[shape.link];
  for (const SimpleShape& given : shapes.shapes) {
    const SimpleShape shape = engine_shape(given);
    out[shape.link].push_back({geometry_of(shape), shape.rpy});
  }
  return out;
}

/// The text of a document with a comment in its root.
std::string with_comment(const std::string& text, const std::string& comment) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  document.RootElement()->InsertFirstChild(document.NewComment(comment_of_xml(comment).c_str()));
  return text_of(document);
}

}  // namespace

SimpleShapes simple_shapes(const std::vector<robot::LinkBody>& bodies) {
  SimpleShapes out;
  for (const robot::LinkBody& body : bodies) {
    if (body.points.size() > 2) {
      out.shapes.push_back(box_of(body));
      out.beyond = std::max(out.beyond, beyond_of(out.shapes.back(), body));
      continue;
    }
    out.shapes.push_back(body.points.size() == 1 ? sphere_of(body) : capsule_of(body));
    const SimpleShape& made = out.shapes.back();
    // A short capsule's sphere reaches beyond it by its length.
    const double more = is_short(made) ? made.size.y() * (1 + 1e-12) + 1e-15 * made.size.x() : 0;
    out.beyond = std::max(out.beyond, made.size.x() + more - body.margin);
  }
  return out;
}

robot::Geometry geometry_of(const SimpleShape& shape) {
  using Shape = robot::Geometry::Shape;
  robot::Geometry out;
  out.origin = {robot::rotation_from_rpy(shape.rpy.x(), shape.rpy.y(), shape.rpy.z()),
                shape.center};
  out.shape = shape.kind == Kind::Box      ? Shape::Box
              : shape.kind == Kind::Sphere ? Shape::Sphere
                                           : Shape::Capsule;
  const double radius = shape.size.x(), length = shape.size.y();
  out.size = shape.kind == Kind::Box      ? shape.size
             : shape.kind == Kind::Sphere ? Vec3(Vec3::Constant(radius))
                                          : Vec3(radius, length, length);
  return out;
}

std::optional<ShapeFormat> shape_format_of(const std::string& file) {
  const std::string extension = fs::path(file).extension().string();
  if (extension == ".urdf") return ShapeFormat::Urdf;
  if (extension == ".xml" || extension == ".mjcf") return ShapeFormat::Mjcf;
  if (extension == ".sdf") return ShapeFormat::Sdf;
  return std::nullopt;
}

robot::ModelText text_of_shapes(ShapeFormat format, const robot::RobotFile& robot,
                                const robot::ShapeChoice& choice,
                                const certify::CertifiedBodies& bodies, const SimpleShapes& shapes,
                                const std::string& parameters, const std::string& file) {
  using Format = robot::RobotFile::Format;
  const std::string origin = origin_of("Spheres, capsules and boxes", robot, parameters);
  if (format == ShapeFormat::Urdf) {
    const auto add = [&](tinyxml2::XMLElement& link, std::uint32_t index) {
      for (const SimpleShape& shape : shapes.shapes)
        if (shape.link == index) add_shape(link, shape);
    };
    return {urdf_with(robot, bodies, add, origin, file), {}};
  }
  const fs::path folder = folder_of(file);
  const auto primitives = primitives_of(bodies, shapes);
  const bool sdf = format == ShapeFormat::Sdf;
  if (robot.format == (sdf ? Format::Sdf : Format::Mjcf)) {
    robot::ShapeEdit edit;
    edit.visual = choice.visual;
    const fs::path from = fs::absolute(robot.path).parent_path();
    edit.moved = [&](const std::string& name) { return moved_reference(name, from, folder); };
    edit.primitives = primitives;
    const std::string name = robot.path.string();
    return {with_comment(sdf ? robot::sdf_with_shapes(robot.text, name, edit)
                             : robot::mjcf_with_shapes(robot.text, name, edit),
                         origin),
            {}};
  }
  robot::Model model = new_model(robot, choice, NewShapes(robot.robot.links.size()), folder, {},
                                 sdf ? KeptNames::Moved : KeptNames::Files);
  for (const auto& [link, own] : primitives) {
    std::vector<robot::Geometry>& collision = model.robot.links[link].collision;
    collision.clear();
    for (const robot::Primitive& one : own) collision.push_back(one.geometry);
  }
  robot::ModelText out = sdf ? robot::to_sdf(model) : robot::to_mjcf(model);
  out.text = with_comment(out.text, origin);
  return out;
}

}  // namespace kaboum::robot_folder
