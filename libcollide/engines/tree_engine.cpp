// Our trees of bodies with another library's test of two bodies, to compare with.

#include <ccd/ccd.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_indep.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>
#include <kaboum/collide/body_tree.h>
#include <kaboum/collide/separation.h>
#include "engine.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace kaboum::collide {
namespace {

fcl::Transform3d transform_of(const geom::Transform& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.linear;
  t.translation() = pose.translation;
  return t;
}

/// FCL's test of two convex bodies; Solver: with libccd, or FCL's own.
template <typename Solver>
class FclPairs {
 public:
  using Body = std::shared_ptr<fcl::Convexd>;

  static Body body_of(const geom::Mesh& mesh) {
    auto faces = std::make_shared<std::vector<int>>();
    for (const geom::Triangle& t : mesh.triangles) {
      faces->push_back(3);
      for (const std::uint32_t v : t) faces->push_back(static_cast<int>(v));
    }
    return std::make_shared<fcl::Convexd>(
        std::make_shared<const std::vector<fcl::Vector3d>>(mesh.vertices),
        static_cast<int>(mesh.triangles.size()), faces, true);
  }

  void place(const geom::Transform& pose) { pose_ = transform_of(pose); }

  bool operator()(const Body& a, const Body& b) const {
    return solver_.shapeIntersect(*a, fcl::Transform3d::Identity(), *b, pose_, nullptr);
  }

 private:
  Solver solver_;
  fcl::Transform3d pose_;
};

/// libccd without FCL.
class CcdPairs {
 public:
  using Body = SupportPoints;

  static Body body_of(const geom::Mesh& mesh) { return Body(mesh); }

  void place(const geom::Transform& pose) { pose_ = pose; }

  bool operator()(const Body& a, const Body& b) const {
    const PosedBody still{&a, nullptr}, moved{&b, &pose_};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    ccd.max_iterations = 500;
    ccd.mpr_tolerance = 1e-6;
    return ccdMPRIntersect(&still, &moved, &ccd) != 0;
  }

 private:
  /// A body and its pose.
  struct PosedBody {
    const Body* body;
    const geom::Transform* pose;  ///< none: in its place
  };

  static void write(const PosedBody& placed, const geom::Vec3& point, ccd_vec3_t* out) {
    const geom::Vec3 p = placed.pose != nullptr ? geom::Vec3(*placed.pose * point) : point;
    ccdVec3Set(out, p.x(), p.y(), p.z());
  }

  static void center(const void* object, ccd_vec3_t* out) {
    const auto& placed = *static_cast<const PosedBody*>(object);
    write(placed, placed.body->center(), out);
  }

  static void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
    const auto& placed = *static_cast<const PosedBody*>(object);
    geom::Vec3 d(direction->v[0], direction->v[1], direction->v[2]);
    if (placed.pose != nullptr) d = placed.pose->linear.transpose() * d;
    write(placed, placed.body->support(d), out);
  }

  geom::Transform pose_;
};

/// A tree of bodies for every link and one for the scene.
template <typename Pairs, bool kDirections>
class TreeEngine : public Engine {
 public:
  explicit TreeEngine(const Model& model) : scene_(model.scene) {
    std::uint32_t links = 0;
    for (const Part& part : model.robot) links = std::max(links, part.link + 1);
    for (std::uint32_t link = 0; link < links; ++link) {
      std::vector<geom::Mesh> bodies;
      for (const Part& part : model.robot)
        if (part.link == link) bodies.push_back(part.mesh);
      robot_.emplace_back(bodies);
    }
    poses_.resize(links);
  }

  void place(const std::vector<geom::Transform>& poses) override {
    for (std::size_t link = 0; link < robot_.size(); ++link) poses_[link] = poses[link];
  }

  bool collide() override {
    for (std::size_t link = 0; link < robot_.size(); ++link) {
      const Object& object = robot_[link];
      pairs_.place(poses_[link]);
      if (any_pair(scene_.tree, object.tree, poses_[link], [&](int i, int j) {
            return !(kDirections && find_separating_direction(scene_.vertices[i],
                                                              object.vertices[j], poses_[link])) &&
                   pairs_(scene_.bodies[i], object.bodies[j]);
          }))
        return true;
    }
    return false;
  }

  double distance() override { return std::numeric_limits<double>::quiet_NaN(); }

 private:
  struct Object {
    explicit Object(const std::vector<geom::Mesh>& meshes) : tree(meshes) {
      for (const geom::Mesh& mesh : meshes) {
        bodies.push_back(Pairs::body_of(mesh));
        vertices.emplace_back(mesh);
      }
    }
    BodyTree tree;
    std::vector<typename Pairs::Body> bodies;
    std::vector<SupportPoints> vertices;
  };

  Object scene_;
  std::vector<Object> robot_;
  std::vector<geom::Transform> poses_;
  Pairs pairs_;
};

}  // namespace

std::unique_ptr<Engine> make_fcl_tree(const Model& model) {
  return std::make_unique<TreeEngine<FclPairs<fcl::detail::GJKSolver_libccdd>, false>>(model);
}

std::unique_ptr<Engine> make_fcl_own_tree(const Model& model) {
  return std::make_unique<TreeEngine<FclPairs<fcl::detail::GJKSolver_indepd>, false>>(model);
}

std::unique_ptr<Engine> make_ccd_tree(const Model& model) {
  return std::make_unique<TreeEngine<CcdPairs, false>>(model);
}

std::unique_ptr<Engine> make_fcl_directions(const Model& model) {
  return std::make_unique<TreeEngine<FclPairs<fcl::detail::GJKSolver_libccdd>, true>>(model);
}

std::unique_ptr<Engine> make_ccd_directions(const Model& model) {
  return std::make_unique<TreeEngine<CcdPairs, true>>(model);
}

}  // namespace kaboum::collide
