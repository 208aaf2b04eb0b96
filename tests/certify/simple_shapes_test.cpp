// Capsules and boxes as a URDF has them, against the bodies that they hold, in 60 digits.
#include <gtest/gtest.h>
#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot_folder/simple_shapes.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <random>
#include <regex>
#include <sstream>

namespace kaboum::robot_folder {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                           boost::multiprecision::et_off>;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using RealTurn = Eigen::Matrix<Real, 3, 3>;

constexpr const char* kLink =
    R"(<robot name="r"><link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>)";

/// A shape as the file has it.
struct Written {
  std::string kind;
  Real3 place;
  RealTurn turn;
  Real3 size;  ///< of a box; else radius, length
};

Real3 three(const std::string& text) {
  std::istringstream in(text);
  double x = 0, y = 0, z = 0;
  in >> x >> y >> z;
  return {Real(x), Real(y), Real(z)};
}

RealTurn turn_of(const Real3& rpy) {
  const auto about = [](int axis, const Real& angle) {
    RealTurn out = RealTurn::Identity();
    const int i = (axis + 1) % 3, k = (axis + 2) % 3;
    out(i, i) = out(k, k) = cos(angle);
    out(k, i) = sin(angle);
    out(i, k) = -out(k, i);
    return out;
  };
  return about(2, rpy[2]) * about(1, rpy[1]) * about(0, rpy[0]);
}

/// The rotation of a quaternion w, x, y, z of any length.
RealTurn turn_of_quaternion(const std::string& text) {
  std::istringstream in(text);
  double w = 0, x = 0, y = 0, z = 0;
  in >> w >> x >> y >> z;
  const Real n = sqrt(Real(w) * w + Real(x) * x + Real(y) * y + Real(z) * z);
  const Real a = w / n, b = x / n, c = y / n, d = z / n;
  RealTurn out;
  out << 1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c), 2 * (b * c + a * d),
      1 - 2 * (b * b + d * d), 2 * (c * d - a * b), 2 * (b * d - a * c), 2 * (c * d + a * b),
      1 - 2 * (b * b + c * c);
  return out;
}

/// The file of some bodies.
std::string text_with(ShapeFormat format, const std::vector<robot::LinkBody>& bodies) {
  static const robot::RobotFile robot = [] {
    robot::RobotFile out;
    out.path = "r.urdf";
    out.text = kLink;
    out.robot = robot::parse_urdf(kLink, "r.urdf");
    return out;
  }();
  certify::RobotRequest request;
  request.set.epsilon = Length{0.5};
  static const certify::CertifiedBodies certified = certify::certify_bodies(robot, request);
  return text_of_shapes(format, robot, {}, certified, simple_shapes(bodies), "", "bodies.urdf")
      .text;
}

/// What the MJCF of some bodies has.
std::vector<Written> written_as_mjcf(const std::vector<robot::LinkBody>& bodies) {
  const std::string text = text_with(ShapeFormat::Mjcf, bodies);
  static const std::regex geom("<geom ([^>]*)/>");
  const auto attribute = [](const std::string& of, const std::string& name) {
    std::smatch found;
    return std::regex_search(of, found, std::regex("\\b" + name + "=\"([^\"]*)\"")) ? found[1].str()
                                                                                    : std::string();
  };
  std::vector<Written> out;
  for (std::sregex_iterator i(text.begin(), text.end(), geom), end; i != end; ++i) {
    const std::string of = (*i)[1];
    const std::string quat = attribute(of, "quat"), pos = attribute(of, "pos");
    Written one{attribute(of, "type"), pos.empty() ? Real3(Real3::Zero()) : three(pos),
                quat.empty() ? RealTurn(RealTurn::Identity()) : turn_of_quaternion(quat),
                three(attribute(of, "size") + " 0 0")};
    if (one.kind == "box") one.size *= Real(2);
    if (one.kind == "capsule") one.size[1] *= Real(2);
    out.push_back(one);
  }
  return out;
}

/// What the URDF of some bodies has.
std::vector<Written> written(const std::vector<robot::LinkBody>& bodies) {
  const std::string text = text_with(ShapeFormat::Urdf, bodies);
  static const std::regex shape(
      "<origin xyz=\"([^\"]*)\" rpy=\"([^\"]*)\"/>\\s*<geometry>\\s*<(\\w+) "
      "(?:size|radius)=\"([^\"]*)\"(?: length=\"([^\"]*)\")?");
  std::vector<Written> out;
  for (std::sregex_iterator i(text.begin(), text.end(), shape), end; i != end; ++i) {
    const std::smatch& m = *i;
    Written one{m[3], three(m[1]), turn_of(three(m[2])), Real3::Zero()};
    one.size = one.kind == "box" ? three(m[4]) : three(m[4].str() + " " + m[5].str() + " 0");
    out.push_back(one);
  }
  return out;
}

/// By how much the radius of a cylinder and two spheres is more than what is known to be needed.
Real room(const std::vector<Written>& shapes, const robot::LinkBody& capsule) {
  EXPECT_EQ(shapes.size(), 3U);
  if (shapes.size() != 3 || shapes[0].kind != "cylinder") return -1;
  const Written& cylinder = shapes[0];
  const Real half = cylinder.size[1] / 2, radius = cylinder.size[0];
  Real farthest = 0;  // of the ends from the axis's segment; convex along the capsule's
  for (const geom::Vec3& p : capsule.points) {
    const Real3 q = cylinder.turn.transpose() * (p.cast<Real>() - cylinder.place);
    const Real beyond = std::max(Real(abs(q[2]) - half), Real(0));
    farthest = std::max(farthest, Real(sqrt(q[0] * q[0] + q[1] * q[1] + beyond * beyond)));
  }
  Real off = 0;  // of the spheres from its ends
  for (std::size_t i = 0; i < 2; ++i) {
    const Written& ball = shapes[1 + i];
    EXPECT_EQ(ball.kind, "sphere");
    EXPECT_EQ(ball.size[0], radius);
    const Real3 end = cylinder.place + (i == 0 ? Real(-half) : half) * Real3(cylinder.turn.col(2));
    off = std::max(off, Real((ball.place - end).norm()));
  }
  return radius - Real(capsule.margin) - farthest - off;
}

TEST(SimpleOutput, CapsulesHoldTheirBodiesHoweverLittleTheyAreTilted) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double tilt : {0.0, 1e-15, 1e-12, 1e-9, 3e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1})
    for (const double size : {1e-3, 1.0, 1e3})
      for (const int axis : {0, 1, 2})
        for (const double sign : {-1.0, 1.0}) {
          const geom::Vec3 middle =
              0.1 * size * geom::Vec3(unit(random), unit(random), unit(random));
          geom::Vec3 half =
              0.5 * size * tilt * geom::Vec3(unit(random), unit(random), unit(random));
          half[axis] = sign * 0.5 * size;
          robot::LinkBody body{"c", 0, {middle - half, middle + half}, 0.05 * size};
          for (geom::Vec3& p : body.points) p = p.cast<float>().cast<double>();
          const Real left = room(written({body}), body);
          EXPECT_GE(left, 0) << tilt << " " << size << " " << axis;
          EXPECT_LE(left, 1e-12 * size) << tilt << " " << size << " " << axis;
        }
}

/// How far the ends of a capsule are from a segment, less than the radius allows.
Real room_in(const Written& capsule, const robot::LinkBody& body) {
  const Real half = capsule.kind == "capsule" ? Real(capsule.size[1] / 2) : Real(0);
  Real farthest = 0;
  for (const geom::Vec3& p : body.points) {
    const Real3 q = capsule.turn.transpose() * (p.cast<Real>() - capsule.place);
    const Real beyond = std::max(Real(abs(q[2]) - half), Real(0));
    farthest = std::max(farthest, Real(sqrt(q[0] * q[0] + q[1] * q[1] + beyond * beyond)));
  }
  return capsule.size[0] - Real(body.margin) - farthest;
}

TEST(SimpleOutput, CapsulesAndBoxesOfMjcfHoldTheirBodies) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double tilt : {0.0, 1e-15, 1e-12, 1e-8, 1e-6, 1e-3, 0.1, 1.0})
    for (const double size : {1e-3, 1.0, 1e3})
      for (int turn = 0; turn < 6; ++turn) {
        const geom::Vec3 middle = 3 * size * geom::Vec3(unit(random), unit(random), unit(random));
        const Eigen::Matrix3d about =
            robot::rotation_about(geom::Vec3::Unit(turn % 3), std::acos(0.0) * turn) *
            robot::rotation_about(geom::Vec3(unit(random), unit(random), unit(random)).normalized(),
                                  tilt);
        robot::LinkBody capsule{"c", 0, {middle, middle + size * about.col(turn % 3)}, 0.05 * size};
        robot::LinkBody box{"b", 0, {}, 0.01 * size};
        for (int i = 0; i < 8; ++i)
          box.points.emplace_back(middle + size * about *
                                               geom::Vec3((i & 1) != 0 ? 0.5 : -0.5,
                                                          (i & 2) != 0 ? 0.1 : -0.1,
                                                          (i & 4) != 0 ? 0.3 : -0.3));
        const std::vector<Written> shapes = written_as_mjcf({capsule, box});
        ASSERT_EQ(shapes.size(), 2U);
        ASSERT_EQ(shapes[0].kind, "capsule");
        ASSERT_EQ(shapes[1].kind, "box");
        EXPECT_GE(room_in(shapes[0], capsule), 0) << tilt << " " << size << " " << turn;
        EXPECT_LE(room_in(shapes[0], capsule), 1e-11 * size) << tilt << " " << size << " " << turn;
        for (const geom::Vec3& p : box.points) {
          const Real3 q = shapes[1].turn.transpose() * (p.cast<Real>() - shapes[1].place);
          for (int k = 0; k < 3; ++k)
            EXPECT_LE(abs(q[k]) + Real(box.margin), shapes[1].size[k] / 2) << tilt << " " << turn;
        }
      }
  // Of next to no length: a sphere.
  for (const double length : {0.0, 1e-300, 1e-12, 1e-6}) {
    const geom::Vec3 at(3, -4, 5);
    const robot::LinkBody body{"c", 0, {at, at + length * geom::Vec3(1, 2, -2)}, 0.25};
    const std::vector<Written> shapes = written_as_mjcf({body});
    ASSERT_EQ(shapes.size(), 1U);
    EXPECT_EQ(shapes[0].kind, length > 1e-9 ? "capsule" : "sphere");
    EXPECT_GE(room_in(shapes[0], body), 0) << length;
  }
}

TEST(SimpleOutput, ShortCapsulesFarAwayAreHeld) {
  for (const double length : {0.0, 1e-300, 1e-12, 1e-6}) {
    const geom::Vec3 at(3, -4, 5);
    const robot::LinkBody body{"c", 0, {at, at + length * geom::Vec3(1, 2, -2)}, 0.25};
    EXPECT_GE(room(written({body}), body), 0) << length;
  }
}

TEST(SimpleOutput, BoxesHoldTheirPointsHoweverLittleTheyAreTilted) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double tilt : {0.0, 1e-15, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1, 1.0})
    for (int turn = 0; turn < 3; ++turn) {
      const geom::Vec3 middle(unit(random), unit(random), unit(random));
      const Eigen::Matrix3d about =
          robot::rotation_about(geom::Vec3::Unit(turn), std::acos(0.0) * turn) *
          robot::rotation_about(geom::Vec3(unit(random), unit(random), unit(random)).normalized(),
                                tilt);
      robot::LinkBody body{"b", 0, {}, 0.01};
      for (int i = 0; i < 8; ++i)
        body.points.emplace_back(middle + about * geom::Vec3((i & 1) != 0 ? 0.5 : -0.5,
                                                             (i & 2) != 0 ? 0.1 : -0.1,
                                                             (i & 4) != 0 ? 0.3 : -0.3));
      const std::vector<Written> shapes = written({body});
      ASSERT_EQ(shapes.size(), 1U);
      ASSERT_EQ(shapes[0].kind, "box");
      for (const geom::Vec3& p : body.points) {
        const Real3 q = shapes[0].turn.transpose() * (p.cast<Real>() - shapes[0].place);
        for (int k = 0; k < 3; ++k)
          EXPECT_LE(abs(q[k]) + Real(body.margin), shapes[0].size[k] / 2) << tilt << " " << turn;
      }
    }
}

}  // namespace
}  // namespace kaboum::robot_folder
