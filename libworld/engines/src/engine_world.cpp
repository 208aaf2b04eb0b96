// A world in a collision library of others.

#include <kaboum/base/error.h>
#include <kaboum/engines/engine_world.h>
#include <kaboum/geom/turned_box.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/exact_meshes.h>

#include <algorithm>
#include <mutex>

namespace kaboum::engines {

using world::Item;
using world::WorldState;

namespace {

class EngineWorld : public world::Substitute {
 public:
  EngineWorld(const world::World& world, const EngineRequest& request,
              const std::vector<std::pair<Item, geom::Mesh>>& meshes)
      : step_(request.step) {
    for (const world::RobotModel& robot : world.robots) {
      Robot& mine = robots_.emplace_back(Robot{robot.kinematics, robot.base, {}, things_});
      for (const world::LinkShape& shape : robot.shapes) mine.links.push_back(shape.link);
      things_ += robot.shapes.size();
    }
    first_object_ = things_;
    things_ += world.objects.size();
    things_at_.resize(things_);
    links_.resize(robots_.size());
    collider_ = make_collider(request.library, things_);
    if (request.shapes == Shapes::Meshes) {
      for (const auto& [item, mesh] : meshes) {
        if (mesh.triangles.empty()) continue;
        collider_->add(number_of(item), mesh);
        things_at_[number_of(item)].box.own.extend(geom::bounding_box(mesh));
      }
    } else {
      for (std::size_t r = 0; r < world.robots.size(); ++r)
        for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) add_set(world, {r, s});
      for (std::size_t o = 0; o < world.objects.size(); ++o) add_set(world, {Item::kObject, o});
    }
  }

  std::vector<std::size_t> find_meeting(const WorldState& state,
                                        const std::vector<std::array<Item, 2>>& pairs,
                                        bool all) override {
    const std::scoped_lock lock(mutex_);
    place(state, pairs);
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::size_t a = number_of(pairs[k][0]), b = number_of(pairs[k][1]);
      if (!things_at_[a].box.meets(things_at_[b].box) || !meet(a, b)) continue;
      out.push_back(k);
      if (!all) break;
    }
    return out;
  }

  [[nodiscard]] double step() const override { return step_; }

 private:
  struct Robot {
    robot::Robot kinematics;
    geom::Transform base;
    std::vector<std::uint32_t> links;  ///< of its shapes
    std::size_t first = 0;             ///< number of its first shape
  };

  [[nodiscard]] std::size_t number_of(const Item& item) const {
    return (item.robot == Item::kObject ? first_object_ : robots_[item.robot].first) + item.index;
  }

  void add_set(const world::World& world, const Item& item) {
    const world::BoundingSet& set = world.outer(item);
    const std::size_t thing = number_of(item);
    for (std::size_t i = 0; i < set.size(); ++i) {
      collider_->add(thing, set.body(i));
      // Round bodies may be given as polytopes round them, which reach a little farther.
      const double more = 0.02 * set.body(i).radius;
      geom::Box3 box = geom::bounding_box(set.body(i));
      box.min.array() -= more;
      box.max.array() += more;
      things_at_[thing].box.own.extend(box);
    }
  }

  /// Where a thing is.
  struct Place {
    geom::TurnedBox box;
    geom::Transform pose;
    bool known = false;  ///< to the collider, too
    bool placed = false, looked_at = false;
  };

  bool meet(std::size_t a, std::size_t b) {
    for (const std::size_t thing : {a, b}) {
      Place& at = things_at_[thing];
      if (!at.known) collider_->put(thing, at.pose);
      at.known = true;
    }
    return collider_->meet(a, b);
  }

  /// Finds where the things of the pairs are.
  void place(const WorldState& state, const std::vector<std::array<Item, 2>>& pairs) {
    for (Place& at : things_at_) at.looked_at = false;
    for (std::vector<geom::Transform>& links : links_) links.clear();
    for (const std::array<Item, 2>& pair : pairs)
      for (const Item& item : pair) {
        Place& at = things_at_[number_of(item)];
        if (at.looked_at) continue;
        const bool first = !at.placed;
        at.looked_at = at.placed = true;
        const geom::Transform pose = pose_of(item, state);
        if (!first && pose.linear == at.pose.linear && pose.translation == at.pose.translation)
          continue;  // it rests
        at.pose = pose;
        at.known = false;
        at.box.put(pose);
      }
  }

  geom::Transform link_pose(std::size_t robot, std::uint32_t link, const WorldState& state) {
    if (links_[robot].empty()) links_[robot] = forward(robots_[robot].kinematics, state.q[robot]);
    return robots_[robot].base * links_[robot][link];
  }

  geom::Transform pose_of(const Item& item, const WorldState& state) {
    if (item.robot != Item::kObject)
      return link_pose(item.robot, robots_[item.robot].links[item.index], state);
    if (const auto& held = state.attachments[item.index])
      return link_pose(held->robot, held->link, state) * held->pose;
    return state.poses[item.index];
  }

  double step_;
  std::vector<Robot> robots_;
  std::size_t things_ = 0, first_object_ = 0;
  std::unique_ptr<Collider> collider_;
  std::mutex mutex_;  ///< of all that follows, and the collider
  std::vector<Place> things_at_;
  std::vector<std::vector<geom::Transform>> links_;
};

}  // namespace

std::string words_of(const EngineRequest& request) {
  if (request.library == Library::Own) return {};
  return "by " + title_of(request.library) + " on " +
         (request.shapes == Shapes::Sets ? "bounding sets" : "exact meshes") + ", not certified";
}

std::shared_ptr<world::Substitute> make_substitute(
    const world::World& world, const EngineRequest& request,
    const std::vector<std::pair<Item, geom::Mesh>>& meshes) {
  if (request.library == Library::Own) return nullptr;
  if (!(request.step > 0))
    throw Error(ErrorCode::InvalidArgument, "«engine-step»: must be above 0");
  return std::make_shared<EngineWorld>(world, request, meshes);
}

std::shared_ptr<world::Substitute> make_substitute(const world::World& world,
                                                   const std::filesystem::path& scene,
                                                   const EngineRequest& request) {
  std::vector<std::pair<Item, geom::Mesh>> meshes;
  if (request.library != Library::Own && request.shapes == Shapes::Meshes) {
    if (!is_built(request.library)) static_cast<void>(make_collider(request.library, 0));
    if (scene.empty())
      throw Error(ErrorCode::InvalidArgument,
                  "«engine-shapes=meshes»: meshes are found from the scene's file only");
    for (world::ExactMesh& exact : world::exact_meshes(world, scene, request.packages))
      meshes.emplace_back(exact.item, std::move(exact.mesh));
  }
  return make_substitute(world, request, meshes);
}

}  // namespace kaboum::engines
