// Values of scene files, with the place in every message.

#include "scene_values.h"

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/robot/robot.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace kaboum::world::detail {

using Kind = Located::Kind;

namespace {
/// Beyond that, rounding of doubles is not small against any robot.
constexpr double kFarthest = 1e9;
}  // namespace

void SceneValues::fail(const Located& at, const std::string& what) const {
  throw Error(ErrorCode::InvalidInput, name_ + ": " + place_in_text(text_, at.at) + ": " + what);
}

void SceneValues::known(const Located& object, const std::vector<std::string>& names) const {
  if (object.kind != Kind::Object)
    fail(object, std::string("an object is expected, not ") + name_of(object.kind));
  for (std::size_t i = 0; i < object.names.size(); ++i) {
    const std::string& name = object.names[i];
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw Error(ErrorCode::InvalidInput, name_ + ": " + place_in_text(text_, object.names_at[i]) +
                                             ": '" + name + "' is not known here" +
                                             did_you_mean(name, names));
  }
}

const Located* SceneValues::find(const Located& object, const char* name) {
  for (std::size_t i = 0; i < object.names.size(); ++i)
    if (object.names[i] == name) return &object.values[i];
  return nullptr;
}

const Located& SceneValues::need(const Located& object, const char* name) const {
  if (const Located* value = find(object, name)) return *value;
  fail(object, std::string("'") + name + "' is missing");
}

const std::vector<Located>& SceneValues::list(const Located& object, const char* name) const {
  static const std::vector<Located> kNone;
  const Located* value = find(object, name);
  return value == nullptr ? kNone : array(*value);
}

const std::vector<Located>& SceneValues::array(const Located& value) const {
  if (value.kind != Kind::Array)
    fail(value, std::string("an array is expected, not ") + name_of(value.kind));
  return value.items;
}

const std::string& SceneValues::string(const Located& value) const {
  if (value.kind != Kind::String)
    fail(value, std::string("a string is expected, not ") + name_of(value.kind));
  if (value.text.empty()) fail(value, "an empty string");
  return value.text;
}

double SceneValues::number(const Located& value) const {
  if (value.kind != Kind::Number || !std::isfinite(value.number))
    fail(value, std::string("a number is expected, not ") + name_of(value.kind));
  return value.number;
}

std::vector<double> SceneValues::numbers(const Located& value, std::size_t count) const {
  std::vector<double> out;
  for (const Located& item : array(value)) out.push_back(number(item));
  if (out.size() != count)
    fail(value, std::to_string(count) + " numbers are expected, not " + std::to_string(out.size()));
  return out;
}

Vec3 SceneValues::vector(const Located& value) const {
  const std::vector<double> v = numbers(value, 3);
  for (std::size_t i = 0; i < 3; ++i)
    if (!(std::abs(v[i]) <= kFarthest))
      fail(value.items[i], "a number from -1e9 to 1e9 is expected");
  return {v[0], v[1], v[2]};
}

Vec3 SceneValues::unit_vector(const Located& value) const {
  const Vec3 v = vector(value);
  if (!(v.norm() > 1e-100)) fail(value, "a direction of length 0");
  return v.normalized();
}

Primitive SceneValues::primitive(const Located& value) const {
  using P = Primitive::Kind;
  constexpr std::array kKinds{P::Box, P::Sphere, P::Cylinder, P::Capsule, P::Plane};
  std::vector<std::string> names;
  names.reserve(kKinds.size());
  for (const P kind : kKinds) names.emplace_back(world::name_of(kind));
  known(value, names);
  if (value.names.size() != 1)
    fail(value, "one of 'box', 'sphere', 'cylinder', 'capsule' and 'plane' is expected");
  const Located& sizes = value.values.front();
  const auto length = [&](const Located& at, double x) {
    if (!(x > 0 && x <= kFarthest)) fail(at, "a length above 0, up to 1e9, is expected");
    return x;
  };
  Primitive out;
  for (const P kind : kKinds)
    if (value.names.front() == world::name_of(kind)) out.kind = kind;
  if (out.kind == P::Box || out.kind == P::Plane) {
    known(sizes, {"size"});
    const Located& size = need(sizes, "size");
    out.size = vector(size);
    for (std::size_t i = 0; i < 3; ++i) length(size.items[i], out.size[static_cast<int>(i)]);
    return out;
  }
  known(sizes, out.kind == P::Sphere ? std::vector<std::string>{"radius"}
                                     : std::vector<std::string>{"radius", "length"});
  const auto member = [&](const char* name) {
    const Located& at = need(sizes, name);
    return length(at, number(at));
  };
  out.radius = member("radius");
  if (out.kind != P::Sphere) out.length = member("length");
  return out;
}

Transform SceneValues::pose(const Located& object) const {
  Transform out;
  if (const Located* position = find(object, "position")) out.translation = vector(*position);
  const Located *rpy = find(object, "rpy"), *quaternion = find(object, "quaternion");
  if (rpy != nullptr && quaternion != nullptr)
    fail(*quaternion, "give either 'rpy' or 'quaternion', not both");
  if (rpy != nullptr) {
    const Vec3 angles = vector(*rpy);
    if (!angles.isZero(0))
      out.linear = robot::rotation_from_rpy(angles.x(), angles.y(), angles.z());
  }
  if (quaternion != nullptr) {
    const std::vector<double> q = numbers(*quaternion, 4);
    const Eigen::Quaterniond r(q[3], q[0], q[1], q[2]);
    if (!(std::abs(r.norm() - 1) < 1e-3))
      fail(*quaternion, "a quaternion [x, y, z, w] of length 1 is expected");
    if (!r.vec().isZero(0)) out.linear = r.normalized().toRotationMatrix();
  }
  return out;
}

Transform SceneValues::pose_member(const Located& object, const char* name) const {
  const Located* value = find(object, name);
  if (value == nullptr) return {};
  known(*value, {"position", "rpy", "quaternion"});
  return pose(*value);
}

}  // namespace kaboum::world::detail

namespace kaboum::world {

Primitive parse_primitive(const std::string& text, const std::string& name) {
  return detail::SceneValues(text, name).primitive(detail::parse_located(text, name));
}

}  // namespace kaboum::world
