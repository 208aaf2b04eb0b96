// Collision libraries of others: what they say of bodies and meshes away from contact, that sets
// which hold meshes are in contact where these are, and that nothing of it is taken for certified.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/world/motion_check.h>

#include <cmath>
#include <random>

#include "collide/pairs.h"
#include "worlds.h"

namespace kaboum::engines {
namespace {

using world::Checker;
using world::Item;
using world::WorldState;

std::vector<Library> built() {
  std::vector<Library> out;
  for (const Library library : {Library::Fcl, Library::Bullet, Library::Ode})
    if (is_built(library)) out.push_back(library);
  return out;
}

geom::ConvexBody body_of(geom::Mesh mesh) { return {"body", std::move(mesh), 0}; }

geom::Mesh scaled(geom::Mesh mesh, const geom::Vec3& about, double factor) {
  for (geom::Vec3& v : mesh.vertices) v = about + factor * (v - about);
  return mesh;
}

geom::Vec3 middle_of(const geom::Mesh& mesh) {
  geom::Vec3 out = geom::Vec3::Zero();
  for (const geom::Vec3& v : mesh.vertices) out += v / static_cast<double>(mesh.vertices.size());
  return out;
}

TEST(Engines, SayWhatTheOracleSaysOfBodiesOfAnySize) {
  for (const Library library : built()) {
    if (library == Library::Ode) continue;  // surfaces only
    for (const double size : {1.0, 0.02, 0.001, 300.0}) {
      std::mt19937_64 random(11);
      int meeting = 0, apart = 0;
      for (int i = 0; i < 400; ++i) {
        const geom::Mesh a = scaled(test::random_body(random, 0.6), geom::Vec3::Zero(), size),
                         b = scaled(test::random_body(random, 0.6), geom::Vec3::Zero(), size);
        geom::Transform pose = test::random_pose(random, 0.5);
        pose.translation *= size;
        const auto meet = [&](double factor) {
          return test::meet(scaled(a, middle_of(a), factor).vertices,
                            scaled(b, middle_of(b), factor).vertices, pose);
        };
        const bool surely = meet(0.97), perhaps = meet(1.03);
        if (surely != perhaps) continue;
        (surely ? meeting : apart) += 1;
        const auto collider = make_collider(library, 2);
        collider->add(0, body_of(a));
        collider->add(1, body_of(b));
        collider->put(0, {});
        collider->put(1, pose);
        EXPECT_EQ(collider->meet(0, 1), surely) << title_of(library) << ", " << size << ", " << i;
      }
      EXPECT_GT(meeting, 30);
      EXPECT_GT(apart, 30);
    }
  }
}

TEST(Engines, SetsAreInContactWhereTheMeshesInThemAre) {
  // Bodies of centimetres in metres, as fingers and parts are; sets a thousandth larger.
  for (const Library library : built()) {
    for (const double size : {0.03, 1.0}) {
      std::mt19937_64 random(12);
      int in_contact = 0, false_alarms = 0;
      for (int i = 0; i < 150; ++i) {
        std::array<std::vector<geom::Mesh>, 2> parts;
        for (std::vector<geom::Mesh>& thing : parts)
          for (int k = 0; k < 3; ++k)
            thing.push_back(scaled(test::random_body(random, 0.5), geom::Vec3::Zero(), size));
        const auto meshes = make_collider(library, 2), sets = make_collider(library, 2);
        for (std::size_t thing = 0; thing < 2; ++thing)
          for (const geom::Mesh& part : parts.at(thing)) {
            meshes->add(thing, part);
            sets->add(thing, body_of(scaled(part, middle_of(part), 1.001)));
          }
        meshes->put(0, {});
        sets->put(0, {});
        for (int k = 0; k < 8; ++k) {
          geom::Transform pose = test::random_pose(random, 1);
          pose.translation *= size;
          meshes->put(1, pose);
          sets->put(1, pose);
          bool meet = false;
          for (const geom::Mesh& a : parts[0])
            for (const geom::Mesh& b : parts[1])
              meet = meet || test::meet(a.vertices, b.vertices, pose);
          const bool seen = meshes->meet(0, 1);
          if (seen && !meet) ++false_alarms;
          // ODE looks at surfaces, of sets as well.
          if (library == Library::Ode ? !seen : !meet) continue;
          ++in_contact;
          EXPECT_TRUE(sets->meet(0, 1))
              << title_of(library) << ", " << size << ", " << i << ", " << k;
        }
      }
      EXPECT_GT(in_contact, 100) << title_of(library);
      // Bullet's GImpact sees contacts of triangles that are apart.
      if (library != Library::Bullet) {
        EXPECT_EQ(false_alarms, 0) << title_of(library) << ", " << size;
      }
    }
  }
}

TEST(Engines, RoundBodiesAreHeld) {
  // A ball and a capsule: what is given to a library holds them, and is hardly larger.
  geom::ConvexBody ball{"ball", {}, 0.25}, capsule{"capsule", {}, 0.125};
  ball.core.vertices = {geom::Vec3::Zero()};
  capsule.core.vertices = {{-1, 0, 0}, {1, 0, 0}};
  for (const Library library : built()) {
    const auto collider = make_collider(library, 2);
    collider->add(0, ball);
    collider->add(1, capsule);
    collider->put(0, {});
    for (const double turn : {0.0, 0.3, 1.1, 2.0}) {
      geom::Transform pose;
      pose.linear = Eigen::AngleAxisd(turn, geom::Vec3::UnitX()).toRotationMatrix();
      pose.translation = {0.1, 0, 0.37};
      collider->put(1, pose);
      EXPECT_TRUE(collider->meet(0, 1)) << title_of(library);
      pose.translation.z() = 0.385;  // 1.3 % of both radii
      collider->put(1, pose);
      EXPECT_FALSE(collider->meet(0, 1)) << title_of(library);
    }
  }
}

TEST(Engines, AreNamedAndRefused) {
  EXPECT_THROW(static_cast<void>(make_collider(Library::Own, 1)), Error);
  EXPECT_TRUE(is_built(Library::Own));
  EXPECT_EQ(words_of(EngineRequest{}), "");
  for (const Library library : {Library::Fcl, Library::Bullet, Library::Ode}) {
    EngineRequest request;
    request.library = library;
    EXPECT_TRUE(words_of(request).ends_with("on bounding sets, not certified"));
    if (is_built(library)) continue;
    try {
      static_cast<void>(make_collider(library, 1));
      ADD_FAILURE() << name_of(library);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::NotBuilt);
      EXPECT_NE(std::string(error.what()).find("-DKABOUM_WITH_"), std::string::npos);
    }
  }
}

world::World arm_among_boxes(const test::SceneFiles& files) {
  std::string text = "\"objects\": [";
  const std::vector<std::string> positions{"[2, 1.2, 0]", "[-1.5, 0.9, 0.3]", "[0.5, -2.2, 0]",
                                           "[9, 9, 9]"};
  for (std::size_t i = 0; i < positions.size(); ++i)
    text += std::string(i == 0 ? "" : ",").append("{\"name\": \"o").append(std::to_string(i)) +
            "\", \"pose\": {\"position\": " + positions[i] +
            "}, \"outer\": " + files.ref("box.glb") + "}";
  return files.world(files.scene(text + "]"));
}

WorldState random_state(const world::World& world, std::mt19937_64& random) {
  std::uniform_real_distribution<double> turn(-2.9, 2.9);
  WorldState state = initial_state(world);
  for (double& q : state.q[0]) q = turn(random);
  if (random() % 3 == 0) {
    world::Attachment held;
    held.link = 3;
    held.pose.translation = {1.6, 0, 0};
    state.attachments[3] = held;
  }
  return state;
}

bool has(const std::vector<world::Contact>& contacts, const std::array<Item, 2>& pair) {
  return std::ranges::any_of(contacts, [&](const auto& c) { return c.items == pair; });
}

TEST(Engines, AgreeWithOwnPredicatesAboutPairsOfAWorld) {
  const test::SceneFiles files;
  const world::World world = arm_among_boxes(files);
  world::World wider = world;  // own, with everything 1 mm more
  wider.margins.all = 1e-3;
  const Checker own(world), own_wider(wider);
  for (const Library library : built()) {
    const auto substitute = make_substitute(world, "", {.library = library});
    const Checker engine(world, nullptr, substitute.get());
    world::Scratch mine, wide, other;
    std::mt19937_64 random(13);
    std::size_t contacts = 0, differing = 0;
    for (int i = 0; i < 600; ++i) {
      const WorldState state = random_state(world, random);
      const auto found = engine.find_contacts(state, other, {});
      EXPECT_EQ(engine.is_free(state, other), found.empty());
      EXPECT_EQ(engine.find_contact(state, other).has_value(), !found.empty());
      const auto narrow = own.find_contacts(state, mine, {}),
                 all = own_wider.find_contacts(state, wide, {});
      contacts += narrow.size();
      for (const world::Contact& c : found) {
        EXPECT_TRUE(c.substituted);
        EXPECT_FALSE(c.certain);
        EXPECT_TRUE(has(all, c.items)) << title_of(library) << ", " << i;
      }
      for (const world::Contact& c : narrow) differing += has(found, c.items) ? 0 : 1;
    }
    EXPECT_GT(contacts, 200);
    // What barely touches is a matter of rounding; of ODE, what lies wholly inside.
    EXPECT_LE(differing, library == Library::Ode ? contacts / 20 : contacts / 500)
        << title_of(library);
  }
}

TEST(Engines, LookAtMotionsAtSamplesAndSaySo) {
  const test::SceneFiles files;
  const world::World world = arm_among_boxes(files);
  const Checker own(world);
  std::mt19937_64 random(14);
  std::uniform_real_distribution<double> step(-0.7, 0.7);
  for (const Library library : built()) {
    const auto substitute = make_substitute(world, "", {.library = library, .step = 0.02});
    const Checker engine(world, nullptr, substitute.get());
    int free = 0, contact = 0;
    for (int i = 0; i < 60; ++i) {
      const WorldState state = random_state(world, random);
      robot::Path path(3, state.q[0]);
      for (std::size_t k = 1; k < 3; ++k)
        for (std::size_t j = 0; j < 3; ++j) path[k][j] = path[k - 1][j] + step(random);
      const world::MotionAnswer said = check_motion(engine, state, 0, path, {}),
                                decided = check_motion(own, state, 0, path, {});
      using Outcome = world::MotionAnswer::Outcome;
      EXPECT_GT(said.samples, 0);
      EXPECT_EQ(decided.samples, 0);
      // The arm is 3 long: the samples are as dense as its end needs at least.
      double least = 0;
      for (std::size_t k = 1; k < 3; ++k)
        least += std::abs(path[k][2] - path[k - 1][2]) / 0.02 * 0.9;
      if (said.outcome == Outcome::Free) {
        ++free;
        EXPECT_GE(static_cast<double>(said.samples), least);
      } else {
        ++contact;
        ASSERT_TRUE(said.contact);
        EXPECT_TRUE(said.contact->substituted);
        EXPECT_NE(decided.outcome, Outcome::Free) << title_of(library) << ", " << i;
        WorldState there = state;
        for (std::size_t j = 0; j < 3; ++j) {
          const double from = path[said.contact_segment][j],
                       to = path[std::min<std::size_t>(said.contact_segment + 1, 2)][j];
          there.q[0][j] = said.contact_share < 1 ? from + said.contact_share * (to - from) : to;
        }
        world::Scratch scratch;
        EXPECT_FALSE(engine.is_free(there, scratch)) << title_of(library) << ", " << i;
      }
      const std::vector<Item> things{{Item::kObject, 0}, {Item::kObject, 1}, {Item::kObject, 2}};
      const auto in_the_way = find_obstacles(own, state, 0, path, things, {});
      for (const Item& thing : find_obstacles(engine, state, 0, path, things, {}))
        EXPECT_NE(std::ranges::find(in_the_way, thing), in_the_way.end());
    }
    EXPECT_GT(free, 5);
    EXPECT_GT(contact, 5);
    world::MotionOptions few;
    few.most_intervals = 3;
    const WorldState state = initial_state(world);
    EXPECT_EQ(check_motion(engine, state, 0, {state.q[0], {2.9, 2.9, 2.9}}, few).outcome,
              world::MotionAnswer::Outcome::Undecided);
  }
}

TEST(Engines, KnowNoMargins) {
  const test::SceneFiles files;
  world::World world = arm_among_boxes(files);
  world.margins.all = 0.1;
  for (const Library library : built()) {
    const auto substitute = make_substitute(world, "", {.library = library});
    EXPECT_THROW(Checker(world, nullptr, substitute.get()), Error);
    EXPECT_THROW(make_substitute(world, "", {.library = library, .shapes = Shapes::Meshes}), Error);
    EXPECT_THROW(make_substitute(world, "", {.library = library, .step = 0}), Error);
  }
}

}  // namespace
}  // namespace kaboum::engines
