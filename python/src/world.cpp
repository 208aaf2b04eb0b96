// Worlds: kaboum.World, as kaboum-check and kaboum-move.

#include <kaboum/base/parse_length.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/filter/batch_checker.h>
#include <kaboum/io/point_cloud.h>
#include <kaboum/motion/goals.h>
#include <kaboum/motion/keep_options.h>
#include <kaboum/motion/path_options.h>
#include <kaboum/motion/roadmap.h>
#include <kaboum/motion/sampled_path.h>
#include <kaboum/page/world_picture.h>
#include <kaboum/world/check_options.h>
#include <kaboum/world/cloud.h>
#include <kaboum/world/finger_paths.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/margins.h>
#include <kaboum/world/regions.h>
#include <kaboum/world/scene.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "arguments.h"
#include "mesh.h"
#include "pictures.h"
#include "request_options.h"
#include "running.h"
#include "scene.h"

namespace kaboum::python {
namespace {

/// Batch checkers of a world's robots, made when they are first needed.
struct BatchCheckers {
  std::mutex mutex;
  std::map<std::size_t, std::shared_ptr<const filter::BatchChecker>> of;
};

/// A scene and its checker, which refers to it. It never changes.
struct WorldValue {
  std::shared_ptr<const world::SceneFile> scene;
  std::shared_ptr<const world::Checker> checker;
  std::string margins;  ///< in words
  std::shared_ptr<BatchCheckers> batches = std::make_shared<BatchCheckers>();

  [[nodiscard]] const world::World& world() const { return scene->world; }
};

/// Things in contact in one state.
struct ContactList {
  WorldValue in;
  world::WorldState state;
  std::vector<world::Contact> contacts;
};

struct MotionValue {
  WorldValue in;
  world::MotionAnswer answer;
  std::vector<motion::PathConstraint> constraints;
  motion::ConstraintAnswer kept;

  [[nodiscard]] bool holds() const {
    return answer.outcome == world::MotionAnswer::Outcome::Free &&
           kept.outcome == motion::ConstraintAnswer::Outcome::Kept;
  }
};

struct PathValue {
  WorldValue in;
  std::size_t robot = 0;
  double resolution = 0;  ///< that it was found with
  motion::PathAnswer answer;
  std::vector<motion::PathConstraint> constraints;
};

struct TrajectoryValue {
  motion::SampledPath made;
  robot::Robot robot;
};

std::vector<Keyword> motion_keywords() {
  return keywords_of(world::motion_options()) + keywords_of(motion::keep_options());
}
std::vector<Keyword> path_keywords() {
  return keywords_of(motion::path_options()) + keywords_of(motion::keep_options());
}

std::size_t robot_index(const world::World& world, const std::optional<std::string>& name) {
  return world::robot_named(world, name.value_or(""));
}

/// n x k values, a row for each configuration; one configuration may be given without its row.
/// @throws Error{InvalidArgument} naming the argument: another shape, numbers that are no doubles
/// or
///   not finite
robot::Path rows_of(const py::object& value, std::size_t variables, const char* name, bool& one) {
  py::array given = array_from(value);
  if (!given) PyErr_Clear();
  one = given && given.ndim() == 1;
  if (one) given = given.reshape({py::ssize_t{1}, given.shape(0)});
  if (!given || given.ndim() != 2 || static_cast<std::size_t>(given.shape(1)) != variables)
    throw Error(ErrorCode::InvalidArgument,
                std::string(name) + " must be " + std::to_string(variables) +
                    " values, one for each variable, or rows of so many");
  require_doubles(given, name);
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) throw py::error_already_set();
  robot::Path out;
  const double* q = array.data();
  for (py::ssize_t i = 0; i < array.shape(0); ++i, q += variables) {
    if (i % 65536 == 65535 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    out.emplace_back(q, q + variables);
    if (!std::ranges::all_of(out.back(), [](double x) { return std::isfinite(x); }))
      throw Error(ErrorCode::InvalidArgument,
                  std::string(name) + " has a value that is not finite");
  }
  return out;
}

py::array_t<double> rows_array(const robot::Path& path) {
  const std::size_t columns = path.empty() ? 0 : path.front().size();
  py::array_t<double> out({path.size(), columns});
  for (std::size_t i = 0; i < path.size(); ++i)
    for (std::size_t k = 0; k < columns; ++k) out.mutable_at(i, k) = path[i][k];
  return out;
}

py::dict dict_of(const world::World& world, const world::Contact& contact) {
  py::dict out;
  out["pair"] = py::make_tuple(world.name_of(contact.items[0]), world.name_of(contact.items[1]));
  out["certain"] = contact.certain;
  out["epsilon"] = contact.epsilon;
  out["margin"] = contact.margin;
  out["place"] = array_of(contact.place);
  const auto point = contact.substituted ? std::nullopt : [&] {
    const auto first = world.point_of(contact.items[0], contact.bodies.a);
    return first ? first : world.point_of(contact.items[1], contact.bodies.b);
  }();
  out["point"] = point ? py::object(py::int_(*point)) : py::object(py::none());
  out["depth"] = contact.depth
                     ? py::object(py::make_tuple(contact.depth->lower, contact.depth->upper))
                     : py::object(py::none());
  return out;
}

world::WorldState state_at(const WorldValue& in, std::size_t robot, const std::vector<double>& q) {
  world::WorldState state = initial_state(in.world());
  state.q[robot] = q;
  return state;
}

WorldValue read_world(const py::object& scene, const py::kwargs& given) {
  world::MarginRequest margin;
  take_keywords("World", world::margin_options(), given, margin, Runs::Briefly);
  std::optional<world::SceneFile> made = scene_file_of(scene);
  const auto file = path_of(scene);
  if (!made && !file)
    throw Error(ErrorCode::InvalidArgument,
                "scene must be a kaboum.Scene, a str or an os.PathLike");
  return run(0, [&] {
    WorldValue out;
    auto read =
        std::make_shared<world::SceneFile>(made ? std::move(*made) : world::read_scene(*file));
    read->world.margins = world::margins_of(read->world, margin);
    out.scene = std::move(read);
    out.margins = words_of(margin);
    out.checker = std::make_shared<const world::Checker>(out.scene->world);
    return out;
  });
}

/// Points of a file or of an array; such as are none are refused, or left out.
io::PointCloud cloud_of(const py::object& points, bool drop_invalid) {
  io::PointCloud out;
  const auto file = path_of(points);
  if (file) {
    out = run(0, [&] { return io::read_point_cloud(*file); });
    if (out.has_viewpoint)
      throw Error(ErrorCode::InvalidInput,
                  *file +
                      ": its VIEWPOINT is not applied, and says not in which frame the points "
                      "are; read them, place them and give the array");
  } else {
    const py::array given = array_from(points);
    if (!given) PyErr_Clear();
    if (!given || given.ndim() != 2 || given.shape(1) != 3)
      throw Error(ErrorCode::InvalidArgument, "points must be the name of a file or n x 3 numbers");
    require_doubles(given, "points");
    const auto array =
        py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!array) throw py::error_already_set();
    const double* p = array.data();
    for (py::ssize_t i = 0; i < array.shape(0); ++i, p += 3) {
      const geom::Vec3 point(p[0], p[1], p[2]);
      if (!point.allFinite()) {
        if (out.invalid++ == 0) out.first_invalid = static_cast<std::size_t>(i + 1);
        continue;
      }
      out.points.push_back(point);
      out.numbers.push_back(static_cast<std::uint32_t>(i + 1));
    }
  }
  if (out.invalid > 0 && !drop_invalid)
    throw Error(file ? ErrorCode::InvalidInput : ErrorCode::InvalidArgument,
                (file ? *file : std::string("points")) + ": point " +
                    std::to_string(out.first_invalid) +
                    " has a coordinate that is NaN or infinite; drop_invalid=True leaves such out");
  return out;
}

WorldValue with_cloud(const WorldValue& in, const py::object& points, const py::object& radius,
                      const std::string& name, const py::object& pose,
                      const std::vector<std::string>& allow, bool drop_invalid) {
  io::PointCloud read = cloud_of(points, drop_invalid);
  const geom::Transform place = pose.is_none() ? geom::Transform() : pose_from(pose);
  OptionDescription described = world::cloud_radius_option();
  described.name = "radius";
  const auto length = parse_length(text_of(described, radius).value_or(""));
  if (!length) throw Error(ErrorCode::InvalidArgument, "radius must be a length");
  return run(0, [&] {
    WorldValue out;
    auto scene = std::make_shared<world::SceneFile>(*in.scene);
    add_cloud(scene->world, {.name = name,
                             .points = std::move(read.points),
                             .numbers = std::move(read.numbers),
                             .radius = length->in(in.world().unit).of(0),
                             .pose = place,
                             .allow = allow});
    out.scene = std::move(scene);
    out.margins = in.margins;
    out.checker = std::make_shared<const world::Checker>(out.scene->world);
    return out;
  });
}

/// Calls `look` for every row of configurations, and says how many it has been called for.
template <class Look>
void for_rows(const robot::Path& rows, Watch& watch, const Look& look) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i % 16 == 0)
      watch(std::to_string(i) + " of " + std::to_string(rows.size()) + " configurations");
    look(rows[i]);
  }
}

std::vector<ContactList> contacts_at(const WorldValue& in, std::size_t robot,
                                     const robot::Path& rows,
                                     const world::Checker::Options& options, Watch& watch) {
  return run(0, [&] {
    world::Scratch scratch;
    std::vector<ContactList> out;
    for_rows(rows, watch, [&](const std::vector<double>& q) {
      ContactList& list = out.emplace_back(ContactList{in, state_at(in, robot, q), {}});
      list.contacts = in.checker->find_contacts(list.state, scratch, options);
    });
    return out;
  });
}

/// Depths take longer than contacts: they are measured when somebody asks.
std::vector<world::Contact> with_depths(const ContactList& list) {
  return run(0, [&] {
    world::Scratch scratch;
    std::vector<world::Contact> out = list.contacts;
    for (world::Contact& contact : out)
      list.in.checker->measure_depth(contact, list.state, scratch);
    return out;
  });
}

py::object check(const WorldValue& in, const py::object& q, const std::optional<std::string>& robot,
                 const py::kwargs& given) {
  world::Checker::Options options;
  const RunKeywords running =
      take_keywords("check", world::state_options(), given, options, Runs::Alone);
  const std::size_t index = robot_index(in.world(), robot);
  bool one = false;
  const robot::Path rows =
      rows_of(q, in.world().robots[index].kinematics.variables.size(), "q", one);
  const world::WorldState start = initial_state(in.world());
  for (std::size_t i = 0; i < rows.size(); ++i)
    static_cast<void>(finger_room_along(in.world(), index, start.attachments, {&rows[i], 1},
                                        "row " + std::to_string(i + 1)));
  Watch watch(running.progress);
  std::vector<ContactList> made = contacts_at(in, index, rows, options, watch);
  if (one) return py::cast(std::move(made.front()));
  return py::cast(std::move(made));
}

/// Names of the pairs that own predicates or a library of others see in contact.
py::object contact_pairs(const WorldValue& in, const py::object& q,
                         const std::optional<std::string>& robot, const py::kwargs& given) {
  engines::EngineRequest request;
  const RunKeywords running =
      take_keywords("contact_pairs", engines::engine_options(), given, request, Runs::Alone);
  const std::size_t index = robot_index(in.world(), robot);
  bool one = false;
  const robot::Path rows =
      rows_of(q, in.world().robots[index].kinematics.variables.size(), "q", one);
  Watch watch(running.progress);
  const auto lists = run(0, [&] {
    const auto substitute = engines::make_substitute(
        in.world(), in.scene->inputs.empty() ? std::string() : in.scene->inputs.front(), request);
    const world::Checker engine(in.world(), nullptr, substitute.get());
    world::Scratch scratch;
    std::vector<std::vector<std::array<std::string, 2>>> out;
    for_rows(rows, watch, [&](const std::vector<double>& row) {
      out.emplace_back();
      for (const auto& contact : engine.find_contacts(state_at(in, index, row), scratch, {}))
        out.back().push_back(
            {in.world().name_of(contact.items[0]), in.world().name_of(contact.items[1])});
    });
    return out;
  });
  py::list made;
  for (const auto& list : lists) {
    py::list pairs;
    for (const auto& [a, b] : list) pairs.append(py::make_tuple(a, b));
    if (one) return pairs;
    made.append(pairs);
  }
  return made;
}

/// What is free with fingers as they are given is so wherever they stop within what the grasps of
/// what is held allow, or counts as contact.
/// @param path_of  what is asked of each
void look_at_fingers(const WorldValue& in, std::size_t robot, world::MotionOptions options,
                     const std::function<robot::Path(std::size_t)>& path_of,
                     std::vector<std::uint8_t>& free) {
  const world::WorldState state = initial_state(in.world());
  if (!holds_by_fingers(state)) return;
  options.where = false;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const robot::Path path = path_of(i);
    const std::string what = path.size() == 1 ? "row " + std::to_string(i + 1)
                                              : "motion " + std::to_string(i + 1) + ", row";
    const auto paths = paths_with_fingers(in.world(), state, robot, path, what);
    if (paths.empty() || free[i] == 0) continue;
    const world::MotionAnswer answer = check_motions(*in.checker, state, paths, options);
    free[i] = answer.outcome == world::MotionAnswer::Outcome::Free ? 1 : 0;
  }
}

/// Below so many rows, making a batch checker takes longer than it saves.
constexpr std::size_t kFewRows = 20000;
constexpr std::size_t kFewRowsAtOnce = 1U << 12, kRowsAtOnce = 1U << 18;

/// Rows one after the other; a single one is repeated.
std::vector<double> joined(const robot::Path& rows, std::size_t first, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double>& row = rows[rows.size() == 1 ? 0 : first + i];
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

/// Calls decide(first, how_many) for parts of `count` things. Ctrl-C is seen between parts, so
/// these take about a tenth of a second.
template <class Decide>
void for_parts(std::size_t count, std::size_t few, const Decide& decide) {
  std::size_t at_once = few;
  for (std::size_t first = 0; first < count;) {
    const std::size_t some = std::min(at_once, count - first);
    const auto begin = std::chrono::steady_clock::now();
    decide(first, some);
    first += some;
    const bool quick = std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(50);
    at_once = quick ? std::min(2 * at_once, kRowsAtOnce) : std::max(at_once / 2, few);
  }
}

py::array_t<bool> bools_of(const std::vector<std::uint8_t>& free) {
  py::array_t<bool> out = row_of<bool>(free.size());
  for (std::size_t i = 0; i < free.size(); ++i)
    out.mutable_at(static_cast<py::ssize_t>(i)) = free[i] != 0;
  return out;
}

/// Null for less than `few` rows, where none was made before.
std::shared_ptr<const filter::BatchChecker> batch_checker(const WorldValue& in, std::size_t robot,
                                                          std::size_t rows, std::size_t few) {
  const std::scoped_lock lock(in.batches->mutex);
  auto& made = in.batches->of[robot];
  if (!made && rows >= few)
    made = std::make_shared<const filter::BatchChecker>(*in.checker, initial_state(in.world()),
                                                        robot, filter::BatchChecker::Options{});
  return made;
}

/// Whether each configuration is free with fingers as they are given.
void look_at_all(const WorldValue& in, std::size_t index, const robot::Path& rows, Watch& watch,
                 std::vector<std::uint8_t>& free) {
  const auto batch = batch_checker(in, index, rows.size(), kFewRows);
  if (!batch) {
    world::Scratch scratch;
    std::size_t i = 0;
    for_rows(rows, watch, [&](const std::vector<double>& row) {
      free[i++] = in.checker->is_free(state_at(in, index, row), scratch) ? 1 : 0;
    });
    return;
  }
  for_parts(rows.size(), kFewRowsAtOnce, [&](std::size_t first, std::size_t count) {
    watch(std::to_string(first) + " of " + std::to_string(rows.size()) + " configurations");
    batch->decide(joined(rows, first, count), {free.data() + first, count});
  });
}

py::array_t<bool> are_free(const WorldValue& in, const py::object& q,
                           const std::optional<std::string>& robot, const py::object& progress) {
  const std::size_t index = robot_index(in.world(), robot);
  const std::size_t variables = in.world().robots[index].kinematics.variables.size();
  bool one = false;
  const robot::Path rows = rows_of(q, variables, "q", one);
  Watch watch(progress);
  std::vector<std::uint8_t> free(rows.size());
  run(0, [&] {
    look_at_all(in, index, rows, watch, free);
    look_at_fingers(
        in, index, {}, [&](std::size_t i) { return robot::Path{rows[i]}; }, free);
  });
  return bools_of(free);
}

/// Below so many motions, making a batch checker takes longer than it saves.
constexpr std::size_t kFewMotions = 1000;
constexpr std::size_t kFewMotionsAtOnce = 1U << 8;

py::array_t<bool> motions_are_free(const WorldValue& in, const py::object& starts,
                                   const py::object& goals, const std::optional<std::string>& robot,
                                   const py::kwargs& given) {
  world::MotionOptions options;
  const RunKeywords running =
      take_keywords("motions_are_free", world::motion_options(), given, options, Runs::Alone);
  const std::size_t index = robot_index(in.world(), robot);
  const std::size_t variables = in.world().robots[index].kinematics.variables.size();
  bool one_start = false, one_goal = false;
  const robot::Path from = rows_of(starts, variables, "starts", one_start),
                    to = rows_of(goals, variables, "goals", one_goal);
  if (!one_start && !one_goal && from.size() != to.size())
    throw Error(ErrorCode::InvalidArgument,
                "starts and goals must have equally many rows, not " + std::to_string(from.size()) +
                    " and " + std::to_string(to.size()) + "; one of them may be a single row");
  const std::size_t count = one_start ? to.size() : from.size();
  Watch watch(running.progress);
  std::vector<std::uint8_t> free(count);
  const auto path_of = [&](std::size_t i) {
    return robot::Path{from[one_start ? 0 : i], to[one_goal ? 0 : i]};
  };
  run(0, [&] {
    const auto tell = [&](std::size_t done) {
      watch(std::to_string(done) + " of " + std::to_string(count) + " motions");
    };
    const auto batch = batch_checker(in, index, count, kFewMotions);
    if (batch) {
      for_parts(count, kFewMotionsAtOnce, [&](std::size_t first, std::size_t some) {
        tell(first);
        batch->decide_motions(joined(from, first, some), joined(to, first, some),
                              {free.data() + first, some}, options);
      });
    } else {
      world::Scratch scratch;
      options.where = false;
      options.scratch = &scratch;
      options.progress = watch.hook();
      for (std::size_t i = 0; i < count; ++i) {
        if (i % 16 == 0) tell(i);
        free[i] =
            world::check_motion(*in.checker, initial_state(in.world()), index, path_of(i), options)
                        .outcome == world::MotionAnswer::Outcome::Free
                ? 1
                : 0;
      }
      options.scratch = nullptr;
    }
    look_at_fingers(in, index, options, path_of, free);
  });
  return bools_of(free);
}

/// The path of a robot, or those of a dict by the robots' names.
std::vector<world::RobotPath> paths_of(const world::World& world, const py::object& path,
                                       const std::optional<std::string>& robot) {
  std::vector<world::RobotPath> out;
  const auto add = [&](std::size_t index, const py::object& rows, const std::string& name) {
    bool one = false;
    out.push_back(
        {index,
         rows_of(rows, world.robots[index].kinematics.variables.size(), name.c_str(), one),
         {}});
  };
  if (!py::isinstance<py::dict>(path)) {
    add(robot_index(world, robot), path, "path");
    return out;
  }
  if (robot)
    throw Error(ErrorCode::InvalidArgument, "robot: a dict of paths names the robots itself");
  for (const auto& [key, rows] : path.cast<py::dict>()) {
    const std::string name = py::str(key).cast<std::string>();
    add(robot_index(world, name), py::reinterpret_borrow<py::object>(rows), "path['" + name + "']");
  }
  return out;
}

MotionValue check_motion(const WorldValue& in, const py::object& path,
                         const std::optional<std::string>& robot, const py::kwargs& given) {
  world::MotionOptions options;
  motion::KeepRequest keep;
  py::dict keywords = given;
  take_options(world::motion_options(), keywords, options);
  take_options(motion::keep_options(), keywords, keep);
  const RunKeywords running = take_run_keywords(keywords, Runs::Alone);
  require_all_taken("check_motion", keywords, motion_keywords(), Runs::Alone);
  std::vector<world::RobotPath> paths = paths_of(in.world(), path, robot);
  if (paths.size() > 1 && !keep.keep.empty())
    throw Error(ErrorCode::InvalidArgument, "keep is for one robot that moves, not for several");
  Watch watch(running.progress);
  options.progress = watch.hook();
  return run(0, [&] {
    MotionValue out{in, {}, {}, {}};
    const world::WorldState state = initial_state(in.world());
    std::vector<std::vector<motion::PathConstraint>> constraints;  // errors come first
    for (const auto& [index, rows, around] : paths) {
      if (rows.empty()) throw Error(ErrorCode::InvalidArgument, "a path without waypoints");
      constraints.push_back(
          constraints_of(in.world(), state, index, rows.front(), {&rows.back(), 1}, keep));
    }
    for (auto& [index, rows, around] : paths)
      around = finger_room_along(in.world(), index, state.attachments, rows, "waypoint");
    if (paths.size() == 1) options.around = paths[0].around;
    out.answer = paths.size() == 1 ? world::check_motion(*in.checker, state, paths[0].robot,
                                                         paths[0].path, options)
                                   : world::check_motions(*in.checker, state, paths, options);
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const auto& [index, rows, around] = paths[i];
      if (constraints[i].empty()) continue;
      out.constraints = constraints[i];
      out.kept = check_constraints(in.world().robots[index], rows, out.constraints, options);
      if (out.kept.outcome != motion::ConstraintAnswer::Outcome::Kept) break;
    }
    return out;
  });
}

/// A configuration of a robot; None: where it is at first, its home but for fingers that hold
/// something.
std::vector<double> start_of(const world::World& world, std::size_t index,
                             const py::object& start) {
  const world::RobotModel& robot = world.robots[index];
  if (start.is_none()) return initial_state(world).q[index];
  bool one = false;
  robot::Path rows = rows_of(start, robot.kinematics.variables.size(), "start", one);
  if (!one) throw Error(ErrorCode::InvalidArgument, "start must be one configuration");
  return rows.front();
}

/// @param search  what looks for the path: (state, start, goals, options)
template <class Search>
PathValue look_for_path(const WorldValue& in, std::size_t index, const py::object& start,
                        const py::object& goals, const py::kwargs& given, const Search& search) {
  motion::PathOptions options;
  motion::KeepRequest keep;
  py::dict keywords = given;
  take_options(motion::path_options(), keywords, options);
  take_options(motion::keep_options(), keywords, keep);
  const RunKeywords running = take_run_keywords(keywords, Runs::Alone);
  require_all_taken("find_path", keywords, path_keywords(), Runs::Alone);
  const std::size_t variables = in.world().robots[index].kinematics.variables.size();
  const std::vector<double> from = start_of(in.world(), index, start);
  bool one = false;
  const robot::Path to = rows_of(goals, variables, "goals", one);
  Watch watch(running.progress);
  options.check.progress = watch.hook();
  return run(0, [&] {
    const world::WorldState state = initial_state(in.world());
    // Fingers that hold something stay, and stop where they touch.
    robot::Path ends = to;
    ends.insert(ends.begin(), from);
    options.still = holding_joints(index, state.attachments);
    options.check.around =
        finger_room_along(in.world(), index, state.attachments, ends, "start or goal");
    options.constraints = constraints_of(in.world(), state, index, from, to, keep);
    return PathValue{in, index, options.check.resolution, search(state, from, to, options),
                     options.constraints};
  });
}

PathValue find_path(const WorldValue& in, const py::object& start, const py::object& goals,
                    const std::optional<std::string>& robot, const py::kwargs& given) {
  const std::size_t index = robot_index(in.world(), robot);
  return look_for_path(
      in, index, start, goals, given,
      [&](const auto& state, const auto& from, const auto& to, const auto& options) {
        return motion::find_path(*in.checker, state, index, from, to, options);
      });
}

/// Paths query after query, by a roadmap where one was made.
struct FinderValue {
  WorldValue in;
  std::size_t robot = 0;
  std::shared_ptr<const motion::PathFinder> finder;
  std::shared_ptr<const motion::Roadmap> roadmap = nullptr;
};

FinderValue path_finder(const WorldValue& in, const std::optional<std::string>& robot) {
  const std::size_t index = robot_index(in.world(), robot);
  return run(0, [&] {
    return FinderValue{
        in, index,
        std::make_shared<const motion::PathFinder>(*in.checker, initial_state(in.world()), index)};
  });
}

PathValue find_path_again(const FinderValue& f, const py::object& start, const py::object& goals,
                          const py::kwargs& given) {
  const std::shared_ptr<const motion::Roadmap> roadmap = f.roadmap;
  return look_for_path(f.in, f.robot, start, goals, given,
                       [&](const auto&, const auto& from, const auto& to, const auto& options) {
                         if (roadmap && !options.still.empty())
                           throw Error(ErrorCode::InvalidArgument,
                                       "a robot that holds something by a gripper with joints "
                                       "goes by no roadmap, whose edges move all joints: use a "
                                       "finder without one");
                         return roadmap ? roadmap->find(*f.finder, from, to, options)
                                        : f.finder->find(from, to, options);
                       });
}

void make_roadmap(FinderValue& f, std::size_t nodes, std::size_t neighbours, std::uint64_t seed,
                  const py::object& progress) {
  Watch watch(progress);
  motion::RoadmapOptions options{.seed = seed, .nodes = nodes, .neighbours = neighbours};
  options.check.progress = watch.hook();
  const auto finder = f.finder;
  f.roadmap = run(0, [&] { return std::make_shared<const motion::Roadmap>(*finder, options); });
}

void read_roadmap(FinderValue& f, const py::object& file) {
  const auto path = path_of(file);
  if (!path) throw Error(ErrorCode::InvalidArgument, "file must be the name of a file");
  const auto finder = f.finder;
  f.roadmap = run(0, [&] {
    const std::vector<char> bytes = io::read_file(*path);
    return std::make_shared<const motion::Roadmap>(
        motion::Roadmap::from_json({bytes.data(), bytes.size()}, *path, *finder));
  });
}

void write_roadmap(const FinderValue& f, const py::object& file) {
  const auto path = path_of(file);
  if (!path) throw Error(ErrorCode::InvalidArgument, "file must be the name of a file");
  if (!f.roadmap) throw Error(ErrorCode::InvalidArgument, "no roadmap was made or read");
  run(0, [&] { io::write_file(*path, f.roadmap->to_json()); });
}

py::array goals_array(const motion::Goals& goals, const world::RobotModel& robot) {
  const auto columns = static_cast<py::ssize_t>(robot.kinematics.variables.size());
  if (goals.configurations.empty())
    return py::array_t<double>(std::vector<py::ssize_t>{0, columns});
  return rows_array(goals.configurations);
}

py::array pose_goals(const WorldValue& in, const py::object& pose, const py::object& start,
                     const std::optional<std::string>& tool,
                     const std::optional<std::string>& robot, std::uint64_t seed,
                     const py::object& progress) {
  const std::size_t index = robot_index(in.world(), robot);
  const world::RobotModel& model = in.world().robots[index];
  const std::vector<double> from = start_of(in.world(), index, start);
  const geom::Transform target = pose_from(pose);
  Watch watch(progress);
  const motion::Goals goals = run(0, [&] {
    return motion::pose_goals(model, motion::moving_frame(model, tool.value_or("")), target, from,
                              seed, watch.hook());
  });
  return goals_array(goals, model);
}

py::array constraint_goals(const WorldValue& in, const std::string& name, const py::object& start,
                           const std::optional<std::string>& tool,
                           const std::optional<std::string>& robot, std::uint64_t seed) {
  const std::size_t index = robot_index(in.world(), robot);
  const world::RobotModel& model = in.world().robots[index];
  const std::vector<double> from = start_of(in.world(), index, start);
  const motion::Goals goals = run(0, [&] {
    return motion::preferred_goals(in.world(), index,
                                   motion::moving_frame(model, tool.value_or("")),
                                   in.world().constraint_set(name), from, seed);
  });
  return goals_array(goals, model);
}

TrajectoryValue trajectory_of(const PathValue& path, const py::kwargs& given) {
  motion::TrajectoryOptions options;
  const RunKeywords running =
      take_keywords("trajectory", motion::trajectory_options(), given, options, Runs::Alone);
  if (path.answer.outcome != motion::PathAnswer::Outcome::Found)
    throw Error(ErrorCode::InvalidArgument, "there is no path that could be carried out");
  Watch watch(running.progress);
  return run(0, [&] {
    const world::WorldState state = initial_state(path.in.world());
    const motion::MovingRobot moving{
        *path.in.checker, state, path.robot, path.constraints,
        finger_room_along(path.in.world(), path.robot, state.attachments, path.answer.path,
                          "waypoint")};
    return TrajectoryValue{motion::sample_path(moving, path.answer.path, options, path.resolution,
                                               motion::AngleUnit::Radians, watch.hook()),
                           moving.kinematics()};
  });
}

/// Whether a thing is in a region, and until when on a path.
struct InclusionValue {
  collide::Inclusion answer = collide::Inclusion::Included;
  std::optional<std::pair<std::size_t, double>> until;  ///< of motions that are not all inside

  [[nodiscard]] bool inside() const { return answer == collide::Inclusion::Included; }
};

py::object is_inside(const WorldValue& in, const std::string& what, const std::string& region,
                     const py::object& q, const std::optional<std::string>& robot,
                     const py::object& progress) {
  const world::InclusionQuestion question = world::inclusion_question(in.world(), what, region);
  robot::Path rows;
  std::size_t index = 0;
  bool one = true;
  if (!q.is_none()) {
    index = robot_index(in.world(), robot);
    rows = rows_of(q, in.world().robots[index].kinematics.variables.size(), "q", one);
  }
  Watch watch(progress);
  const std::vector<InclusionValue> answers = run(0, [&] {
    std::vector<InclusionValue> out;
    if (q.is_none())
      out.push_back({find_inclusion(*in.checker, initial_state(in.world()), question), {}});
    for_rows(rows, watch, [&](const std::vector<double>& row) {
      out.push_back({find_inclusion(*in.checker, state_at(in, index, row), question), {}});
    });
    return out;
  });
  if (one) return py::cast(answers.front());
  return py::cast(answers);
}

InclusionValue stays_inside(const WorldValue& in, const std::string& what,
                            const std::string& region, const py::object& path,
                            const std::optional<std::string>& robot, const py::kwargs& given) {
  world::MotionOptions options;
  const RunKeywords running =
      take_keywords("stays_inside", world::motion_options(), given, options, Runs::Alone);
  const world::InclusionQuestion question = world::inclusion_question(in.world(), what, region);
  const std::size_t index = robot_index(in.world(), robot);
  bool one = false;
  const robot::Path rows =
      rows_of(path, in.world().robots[index].kinematics.variables.size(), "path", one);
  Watch watch(running.progress);
  options.progress = watch.hook();
  return run(0, [&] {
    const world::MotionInclusion found =
        find_inclusion(*in.checker, initial_state(in.world()), index, rows, question, options);
    InclusionValue out{found.answer, {}};
    if (!out.inside()) out.until.emplace(found.segment, found.share);
    return out;
  });
}

py::object nearest(const WorldValue& in, const py::object& q,
                   const std::optional<std::string>& robot, const py::kwargs& given) {
  world::Checker::Options options;
  const RunKeywords running =
      take_keywords("nearest", world::state_options(), given, options, Runs::Alone);
  const std::size_t index = robot_index(in.world(), robot);
  bool one = false;
  const robot::Path rows =
      rows_of(q, in.world().robots[index].kinematics.variables.size(), "q", one);
  if (!one) throw Error(ErrorCode::InvalidArgument, "q must be one configuration");
  Watch watch(running.progress);
  options.progress = [&] { watch("distances of pairs"); };
  const auto found = run(0, [&] {
    world::Scratch scratch;
    return in.checker->find_nearest(state_at(in, index, rows.front()), scratch, options);
  });
  if (!found) return py::none();
  py::dict out;
  out["pair"] =
      py::make_tuple(in.world().name_of(found->items[0]), in.world().name_of(found->items[1]));
  out["lower"] = found->clearance.lower;
  out["upper"] = found->clearance.upper;
  return out;
}

py::bytes draw_world(const WorldValue& in, const py::object& q, const py::object& file,
                     const std::optional<std::string>& robot, const py::kwargs& given) {
  world::Checker::Options options;
  take_keywords("draw", world::state_options(), given, options, Runs::Briefly);
  const std::size_t index = robot_index(in.world(), robot);
  bool one = false;
  const robot::Path rows =
      rows_of(q, in.world().robots[index].kinematics.variables.size(), "q", one);
  if (!one) throw Error(ErrorCode::InvalidArgument, "q must be one configuration");
  return png_bytes(file, [&] {
    world::Scratch scratch;
    const world::WorldState state = state_at(in, index, rows.front());
    return page::picture_of(*in.checker, state, in.checker->find_contacts(state, scratch, options));
  });
}

/// What is known of a robot's pairs of links.
struct LinkPairsValue {
  WorldValue in;
  std::size_t robot = 0;
  std::vector<world::LinkPair> pairs;

  [[nodiscard]] const world::RobotModel& model() const { return in.world().robots[robot]; }
  [[nodiscard]] py::tuple names(const world::LinkPair& pair) const {
    return py::make_tuple(model().kinematics.links[pair.a].name,
                          model().kinematics.links[pair.b].name);
  }
};

LinkPairsValue link_pairs(const WorldValue& in, const std::optional<std::string>& robot,
                          const py::kwargs& given) {
  world::PairOptions options;
  const RunKeywords running =
      take_keywords("link_pairs", world::pair_options(), given, options, Runs::Alone);
  LinkPairsValue out{in, robot_index(in.world(), robot), {}};
  Watch watch(running.progress);
  options.stop = [&] {
    watch("pairs of links");
    return false;
  };
  out.pairs = run(0, [&] { return examine_pairs(out.model(), options); });
  return out;
}

void bind_inclusion_and_pairs(py::module_& module) {
  py::class_<InclusionValue>(module, "Inclusion",
                             "Whether a thing is in a region: true if and only if it is certain.")
      .def("__bool__", &InclusionValue::inside)
      .def_property_readonly(
          "answer", [](const InclusionValue& v) { return world::name_of(v.answer); },
          "'inside', 'not certainly inside' or 'undecided'.")
      .def_property_readonly(
          "until",
          [](const InclusionValue& v) -> py::object {
            if (!v.until) return py::none();
            return py::make_tuple(v.until->first, v.until->second);
          },
          "Of a motion, where it stops being certain: a waypoint, counted from 0, and the share of "
          "the way to the next; or None.")
      .def("__repr__", [](const InclusionValue& v) {
        return std::string("<kaboum.Inclusion: ") + world::name_of(v.answer) + ">";
      });
  py::class_<LinkPairsValue>(module, "LinkPairs", "What is known of all pairs of a robot's links.")
      .def("__len__", [](const LinkPairsValue& v) { return v.pairs.size(); })
      .def_property_readonly(
          "pairs",
          [](const LinkPairsValue& v) {
            py::list out;
            for (const world::LinkPair& pair : v.pairs) {
              py::dict one;
              one["links"] = v.names(pair);
              one["reason"] = pair.reason ? py::object(py::str(world::name_of(*pair.reason)))
                                          : py::object(py::none());
              one["contact_found"] = pair.meets;
              one["contact_always"] = pair.meets_always;
              out.append(one);
            }
            return out;
          },
          "Dicts: 'links', 'reason' why the pair needs no check, or None; 'contact_found' "
          "somewhere, 'contact_always'.")
      .def_property_readonly(
          "never_in_contact",
          [](const LinkPairsValue& v) {
            std::vector<world::AllowedPair> proofs;
            py::list pairs;
            for (const world::LinkPair& pair : v.pairs) {
              if (pair.reason != world::AllowedPair::Reason::Never) continue;
              proofs.push_back({pair.a, pair.b, *pair.reason});
              pairs.append(py::list(v.names(pair)));
            }
            py::dict out;
            out["proved_for"] = world::proof_hash(v.model(), proofs);
            out["pairs"] = pairs;
            return out;
          },
          "What a scene says of the pairs that are proved never to touch.")
      .def_property_readonly(
          "srdf",
          [](const LinkPairsValue& v) {
            return world::to_srdf(v.model(), world::pairs_without_check(v.model(), v.pairs));
          },
          "The pairs that need no check, as <disable_collisions> of an SRDF.")
      .def("__repr__", [](const LinkPairsValue& v) {
        return "<kaboum.LinkPairs of " + std::to_string(v.pairs.size()) + " pairs>";
      });
}

const char* outcome_of(const world::MotionAnswer& answer) {
  using Outcome = world::MotionAnswer::Outcome;
  return answer.outcome == Outcome::Free      ? "free"
         : answer.outcome == Outcome::Contact ? "contact"
                                              : "undecided";
}

void bind_answers(py::module_& module) {
  py::class_<ContactList>(module, "Contacts",
                          "Pairs in contact at one configuration; true where there is none: the "
                          "configuration is free, for certain.")
      .def("__bool__", [](const ContactList& c) { return c.contacts.empty(); })
      .def("__len__", [](const ContactList& c) { return c.contacts.size(); })
      .def_property_readonly(
          "pairs",
          [](const ContactList& c) {
            py::list out;
            for (const world::Contact& contact : with_depths(c))
              out.append(dict_of(c.in.world(), contact));
            return out;
          },
          "Dicts of 'pair', 'certain' (else they are within 'epsilon'), 'epsilon', 'place', and "
          "'depth': a "
          "bracket of the penetration depth of the sets, or None. "
          "[length]")
      .def("__repr__", [](const ContactList& c) {
        return "<kaboum.Contacts: " +
               (c.contacts.empty() ? std::string("free") : std::to_string(c.contacts.size())) + ">";
      });
  py::class_<MotionValue>(
      module, "MotionCheck",
      "Whether a motion is free, and keeps what was asked for; true if and only "
      "if it does, at every instant.")
      .def("__bool__", &MotionValue::holds)
      .def_property_readonly(
          "outcome", [](const MotionValue& m) { return outcome_of(m.answer); },
          "'free', 'contact' or 'undecided' (max_intervals was reached).")
      .def_property_readonly(
          "free_until",
          [](const MotionValue& m) { return py::make_tuple(m.answer.segment, m.answer.share); },
          "Where it stops being certainly free: a waypoint, counted from 0, and the share of the "
          "way to the next.")
      .def_property_readonly(
          "contact",
          [](const MotionValue& m) -> py::object {
            if (!m.answer.contact) return py::none();
            return dict_of(m.in.world(), *m.answer.contact);
          },
          "The first contact that was found, as in `Contacts.pairs`, or None.")
      .def_property_readonly(
          "kept",
          [](const MotionValue& m) -> py::object {
            if (m.constraints.empty()) return py::none();
            return py::str(name_of(m.kept.outcome));
          },
          "Of what was to be kept: 'kept', 'broken' or 'undecided'; None: nothing was.")
      .def_property_readonly(
          "kept_until",
          [](const MotionValue& m) { return py::make_tuple(m.kept.segment, m.kept.share); },
          "As `free_until`, where 'broken' or 'undecided' was found.")
      .def_property_readonly(
          "deviation",
          [](const MotionValue& m) -> py::object {
            if (m.kept.outcome == motion::ConstraintAnswer::Outcome::Kept) return py::none();
            return py::str(describe(m.kept, m.constraints));
          },
          "What was not kept, in words, or None.")
      .def("__repr__", [](const MotionValue& m) {
        const std::string kept =
            m.constraints.empty() ? "" : std::string(", ") + name_of(m.kept.outcome);
        return std::string("<kaboum.MotionCheck: ") + outcome_of(m.answer) + kept + ">";
      });
}

/// What of an instant, a row for each sample.
py::array instants(const TrajectoryValue& t, std::vector<double> motion::Instant::*what) {
  const motion::Trajectory& trajectory = t.made.trajectory;
  robot::Path rows;
  rows.reserve(trajectory.samples());
  for (std::size_t k = 0; k < trajectory.samples(); ++k)
    rows.push_back(trajectory.instant(k).*what);
  return rows_array(rows);
}

void bind_trajectory(py::module_& module) {
  py::class_<TrajectoryValue>(module, "Trajectory",
                              "A path in time, from rest to rest along each of its segments, or "
                              "through blended corners. Its samples were decided free, with "
                              "straight lines between them.")
      .def("__len__", [](const TrajectoryValue& t) { return t.made.trajectory.samples(); })
      .def_property_readonly(
          "duration", [](const TrajectoryValue& t) { return t.made.trajectory.duration(); }, "[s]")
      .def_property_readonly(
          "rate", [](const TrajectoryValue& t) { return t.made.trajectory.rate(); },
          "Samples per second: sample k is at k / rate.")
      .def_property_readonly(
          "positions",
          [](const TrajectoryValue& t) {
            robot::Path rows;
            for (std::size_t k = 0; k < t.made.trajectory.samples(); ++k)
              rows.push_back(t.made.trajectory.sample(k));
            return rows_array(rows);
          },
          "n x k float64: a row for each sample. [rad or length]")
      .def_property_readonly(
          "velocities",
          [](const TrajectoryValue& t) { return instants(t, &motion::Instant::velocity); },
          "n x k float64, as `positions`, by time.")
      .def_property_readonly(
          "accelerations",
          [](const TrajectoryValue& t) { return instants(t, &motion::Instant::acceleration); },
          "n x k float64, as `velocities`, by time.")
      .def(
          "write",
          [](const TrajectoryValue& t, const py::object& file) {
            const auto path = path_of(file);
            if (!path) throw Error(ErrorCode::InvalidArgument, "file must be the name of a file");
            const auto format = motion::message_format(*path);
            io::write_file(*path,
                           format ? motion::to_joint_trajectory(t.made.trajectory, t.robot, *format)
                                  : t.made.csv);
          },
          py::arg("file"),
          "Writes the samples: the bytes of `kaboum-move --trajectory`. CSV, or a JointTrajectory "
          "of ROS 2 where the name ends with .yaml, .yml or .json.")
      .def_property_readonly(
          "blends", [](const TrajectoryValue& t) { return t.made.blends; },
          "Share of its segments that the blend at each waypoint takes; 0: it stops there. Empty "
          "without blends.")
      .def_property_readonly(
          "between_samples", [](const TrajectoryValue& t) { return t.made.between_samples; },
          "How far from the straight lines between its samples all is certified, of each joint, "
          "where it is bent: the curve is nearer; 0 without blends. [rad or length]")
      .def("__repr__", [](const TrajectoryValue& t) {
        return "<kaboum.Trajectory of " + std::to_string(t.made.trajectory.samples()) + " samples>";
      });
}

constexpr const char* kTrajectoryDoc =
    R"(The path in time, from rest to rest along each segment or, with `blend`, through its corners,
as `kaboum-move --trajectory`.

Parameters
----------
{keywords}

Raises
------
Error
    'invalid_argument' where there is no path, for names of no joint and velocities above the robot
    file's; 'limit_reached' for more than 5,000,000 samples, and where these pass too near to be
    certified.)";

void bind_path(py::module_& module) {
  bind_trajectory(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string trajectory_text =
      document("trajectory", "self: kaboum.Path", keywords_of(motion::trajectory_options()),
               "kaboum.Trajectory", kTrajectoryDoc, Runs::Alone);
  py::class_<PathValue>(module, "Path",
                        "A path that is free at every instant, or why there is none; true where "
                        "one was found.")
      .def(
          "__bool__",
          [](const PathValue& p) { return p.answer.outcome == motion::PathAnswer::Outcome::Found; })
      .def_property_readonly(
          "outcome", [](const PathValue& p) { return motion::name_of(p.answer.outcome); },
          "'found', or why there is none. Only 'found' says something of all paths.")
      .def_property_readonly(
          "waypoints", [](const PathValue& p) { return rows_array(p.answer.path); },
          "n x k float64: a row for each waypoint, straight in joint space between.")
      .def_property_readonly(
          "goal",
          [](const PathValue& p) -> py::object {
            if (p.answer.outcome != motion::PathAnswer::Outcome::Found) return py::none();
            return py::int_(p.answer.goal);
          },
          "Which goal it leads to, counted from 0.")
      .def_property_readonly(
          "straight", [](const PathValue& p) { return p.answer.straight; },
          "Whether the straight line was free.")
      .def_property_readonly(
          "contact",
          [](const PathValue& p) -> py::object {
            if (!p.answer.contact) return py::none();
            return dict_of(p.in.world(), *p.answer.contact);
          },
          "What start or goal touches, or None.")
      .def_property_readonly(
          "kept",
          [](const PathValue& p) {
            if (p.answer.outcome != motion::PathAnswer::Outcome::Found) return std::string();
            return words_of(p.constraints, p.answer.deviations);
          },
          "The constraints that it keeps and how far it is off, in words; empty: none were asked "
          "for.")
      .def_property_readonly(
          "broken",
          [](const PathValue& p) -> py::object {
            if (!p.answer.broken) return py::none();
            return py::str(describe(*p.answer.broken, p.constraints));
          },
          "What start or goal does not keep, in words, or None.")
      .def_property_readonly(
          "blockers",
          [](const PathValue& p) {
            py::list out;
            for (const motion::Blocker& b : p.answer.blockers)
              out.append(py::make_tuple(p.in.world().name_of(b.items[0]),
                                        p.in.world().name_of(b.items[1]), b.times));
            return out;
          },
          "What stood in the way most often: tuples of two names and a count.")
      .def("trajectory", &trajectory_of, trajectory_text.c_str())
      .def("__len__", [](const PathValue& p) { return p.answer.path.size(); })
      .def("__repr__", [](const PathValue& p) {
        return "<kaboum.Path: " + std::string(motion::name_of(p.answer.outcome)) + ">";
      });
}

constexpr const char* kFinderPathDoc =
    R"(As `World.find_path`: the same is claimed of the path, which may be another one. By the roadmap,
where there is one; where that leads nowhere, or constraints are to be kept, by trees.

Parameters
----------
start : array
    k values; None: home.
goals : array
    k values, or n x k.
{keywords}
)";

constexpr const char* kMakeRoadmapDoc =
    R"(Makes a roadmap, in place of one that there is: free configurations, joined by straight motions
that are free at every instant.

Parameters
----------
nodes : int
    Configurations; fewer where few that are drawn are free.
neighbours : int
    That each is joined to.
seed : int
    Of the configurations.
progress
    As of `World.find_path`.)";

void bind_path_finder(py::module_& module) {
  py::class_<FinderValue> finder(module, "PathFinder",
                                 R"(Paths of a robot of a world, query after query.

What queries share is made once, which takes about a tenth of a second. Paths are the same whatever
was asked before.)");
  finder
      .def_property_readonly(
          "nodes", [](const FinderValue& f) { return f.roadmap ? f.roadmap->nodes() : 0; },
          "Of the roadmap; 0: there is none.")
      .def_property_readonly(
          "edges", [](const FinderValue& f) { return f.roadmap ? f.roadmap->edges() : 0; },
          "Of the roadmap.")
      .def("make_roadmap", &make_roadmap, py::kw_only(), py::arg("nodes") = 1000,
           py::arg("neighbours") = 12, py::arg("seed") = 1, py::arg("progress") = py::none(),
           kMakeRoadmapDoc)
      .def("read_roadmap", &read_roadmap, py::arg("file"),
           "Takes a roadmap that `write_roadmap` wrote; one of another scene is refused "
           "('invalid_input').")
      .def("write_roadmap", &write_roadmap, py::arg("file"),
           "Writes the roadmap (docs/formats.md).")
      .def("__repr__", [](const FinderValue& f) {
        return "<kaboum.PathFinder of " + f.in.world().robots[f.robot].name + ">";
      });
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text = document("find_path", "self: object, start: object, goals: object, *",
                                    path_keywords(), "kaboum.Path", kFinderPathDoc, Runs::Alone);
  finder.def("find_path", &find_path_again, py::arg("start"), py::arg("goals"), text.c_str());
}

using WorldClass = py::class_<WorldValue>;

constexpr const char* kCheckDoc =
    R"(All contacts of the world with a robot at a configuration, the other robots at home.

Limits of joints are not looked at: a configuration beyond them may be free. `find_path` keeps them.
Fingers that hold something are taken as `q` has them, which has to be within what the grasp allows:
else 'invalid_argument' is raised. Whether all is free wherever they stop is what `are_free` says.

Parameters
----------
q : array
    k values, or n x k: then a list is returned.
robot : str, optional
    Its name, where the scene has several.
{keywords}
)";

constexpr const char* kMotionDoc =
    R"(Whether a robot may move along straight segments of joint values: at every instant, not at samples.

Limits of joints are not looked at.

Parameters
----------
path : array or dict
    n x k, a row for each waypoint. Of robots that move at once: a dict of such arrays by their
    names, with equally many rows.
robot : str, optional
{keywords}
)";

constexpr const char* kMotionsDoc =
    R"(Of n straight motions in joint space, n bools: whether each is free at every instant, for certain.

The answers are those of `check_motion`, also wherever fingers that hold something stop. Limits of
joints are not looked at.

Parameters
----------
starts, goals : array
    n x k, a row for each motion; k values stand for n equal rows.
robot : str, optional
{keywords}
)";

constexpr const char* kPathDoc =
    R"(A path from a configuration to one of several, certified free at every instant.

Parameters
----------
start : array
    k values; None: home.
goals : array
    k values, or n x k.
robot : str, optional
{keywords}
)";

constexpr const char* kCloudDoc =
    R"(The world with points of a sensor as one more object, a ball for each.

What is free of it is apart from every ball, for certain; contacts have the number of a point, as
`kaboum-check --cloud`.

Parameters
----------
points : array or path
    n x 3, or a file (.ply, .pcd, .npy, .xyz, .txt, .asc, .csv). [length]
radius : float
    How far from a point what the sensor saw may be. > 0 [length]
name : str
    Of the object.
pose : array, optional
    Where the points' frame is, as of `pose_goals`.
allow : list of str
    Links, as 'ROBOT/LINK', whose contacts with points are none.
drop_invalid : bool
    Leave out points with coordinates that are NaN or infinite; else they are refused.

Returns
-------
World)";

constexpr const char* kInsideDoc =
    R"(Whether a thing is in a region of the scene, as `kaboum-check --inside`.

Parameters
----------
what : str
    An object, 'ROBOT/LINK', or a robot: all its links and what it carries.
region : str
q : array, optional
    k values, or n x k: then a list is returned. By default all robots are at home.
robot : str, optional
    Whose configurations these are, where the scene has several.
progress
    As of `check`.

Returns
-------
Inclusion)";

constexpr const char* kPoseGoalsDoc =
    R"(Configurations within the limits with which a robot's tool has a pose: goals of `find_path`.

Parameters
----------
pose : array
    Of the tool in the world: a 4 x 4 matrix, or x, y, z and roll, pitch, yaw, a quaternion or a
    matrix, row by row.
start : array, optional
    Joints that do not move the tool keep their values of it; home by default.
tool : str, optional
    Of the robot; the only one by default, of a robot without tools its last link.
robot : str, optional
    Its name, where the scene has several.
seed : int
    Of the numeric search, where there is no closed form.
progress
    As of `check`.

Returns
-------
array
    n x k, a row for each; none where none was found.)";

constexpr const char* kConstraintGoalsDoc =
    R"(Configurations that meet constraints of the scene, drawn at random: goals of `find_path`.

Parameters
----------
name : str
    Of the constraints.
start, tool, robot, seed
    As of `pose_goals`.

Returns
-------
array
    n x k, a row for each, at most 16; none where none was found.)";

constexpr const char* kStaysDoc =
    R"(Whether a thing stays in a region along a path, at every instant.

Parameters
----------
what, region
    As of `is_inside`.
path, robot
    As of `check_motion`.
{keywords}

Returns
-------
Inclusion)";

constexpr const char* kNearestDoc =
    R"(The pair that is nearest at a configuration, the other robots at home.

Parameters
----------
q : array
    A value for each variable.
robot : str, optional
{keywords}

Returns
-------
dict or None
    'pair' and a certified bracket 'lower', 'upper' of its sets' distance, negative where they meet;
    None where no pair is looked at. [length])";

constexpr const char* kDrawDoc =
    R"(A picture of the world with a robot at a configuration, as `kaboum-check --preview`.

Robots are grey, objects blue, what is in contact orange, and the bodies that meet red.

Parameters
----------
q : array
    A value for each variable.
file : path, optional
    The picture is written into it as well.
robot : str, optional
{keywords}

Returns
-------
bytes
    A PNG.)";

constexpr const char* kContactPairsDoc =
    R"(Which pairs are in contact, as `kaboum-check --engine` sees them.

What a library of others says is not certified: no pair does not mean free. Own predicates know
more about contacts: `check`.

Parameters
----------
q : array
    A value for each variable, or rows of so many.
robot : str, optional
{keywords}

Returns
-------
list
    Of pairs of names; of rows, a list of these.)";

constexpr const char* kPairsDoc =
    R"(Pairs of a robot's links: which never touch, or need no check, as `kaboum-scene pairs`.

Parameters
----------
robot : str, optional
{keywords}

Returns
-------
LinkPairs)";

/// Questions whose options stand in tables.
void bind_questions_with_options(WorldClass& world) {
  py::options signatures;
  signatures.disable_function_signatures();  // the tables'
  const auto text = [](const char* function, const std::string& positional, const auto& options,
                       const char* result, const char* doc) {
    return document(function, "self: object, " + positional + "*, robot: object = None",
                    keywords_of(options), result, doc, Runs::Alone);
  };
  const std::string check_text =
      text("check", "q: object, ", world::state_options(), "object", kCheckDoc);
  const std::string nearest_text =
      text("nearest", "q: object, ", world::state_options(), "object", kNearestDoc);
  const std::string draw_text =
      document("draw", "self: object, q: object, file: object = None, *, robot: object = None",
               keywords_of(world::state_options()), "bytes", kDrawDoc, Runs::Briefly);
  const std::string robot_text = "*, robot: object = None";
  const std::string motion_text =
      document("check_motion", "self: object, path: object, " + robot_text, motion_keywords(),
               "kaboum.MotionCheck", kMotionDoc, Runs::Alone);
  const std::string motions_text =
      document("motions_are_free", "self: object, starts: object, goals: object, " + robot_text,
               keywords_of(world::motion_options()), "numpy.ndarray", kMotionsDoc, Runs::Alone);
  const std::string path_text =
      document("find_path", "self: object, start: object, goals: object, " + robot_text,
               path_keywords(), "kaboum.Path", kPathDoc, Runs::Alone);
  const std::string stays_text = text("stays_inside", "what: str, region: str, path: object, ",
                                      world::motion_options(), "kaboum.Inclusion", kStaysDoc);
  const std::string pairs_text =
      text("link_pairs", "", world::pair_options(), "kaboum.LinkPairs", kPairsDoc);
  const std::string contact_text =
      text("contact_pairs", "q: object, ", engines::engine_options(), "object", kContactPairsDoc);
  const auto robot = py::arg("robot") = py::none();
  world.def("check", &check, py::arg("q"), py::kw_only(), robot, check_text.c_str())
      .def("check_motion", &check_motion, py::arg("path"), py::kw_only(), robot,
           motion_text.c_str())
      .def("motions_are_free", &motions_are_free, py::arg("starts"), py::arg("goals"),
           py::kw_only(), robot, motions_text.c_str())
      .def("find_path", &find_path, py::arg("start"), py::arg("goals"), py::kw_only(), robot,
           path_text.c_str())
      .def("stays_inside", &stays_inside, py::arg("what"), py::arg("region"), py::arg("path"),
           py::kw_only(), robot, stays_text.c_str())
      .def("nearest", &nearest, py::arg("q"), py::kw_only(), robot, nearest_text.c_str())
      .def("draw", &draw_world, py::arg("q"), py::arg("file") = py::none(), py::kw_only(), robot,
           draw_text.c_str())
      .def("link_pairs", &link_pairs, py::kw_only(), robot, pairs_text.c_str())
      .def("contact_pairs", &contact_pairs, py::arg("q"), py::kw_only(), robot,
           contact_text.c_str());
}

void bind_questions(WorldClass& world) {
  world
      .def(
          "are_free", &are_free, py::arg("q"), py::kw_only(), py::arg("robot") = py::none(),
          py::arg("progress") = py::none(),
          "Of n x k values, n bools: whether each configuration is free, for certain; with fingers "
          "that hold something wherever they stop within what the grasp allows. 'invalid_argument' "
          "where a row has them elsewhere.")
      .def("with_cloud", &with_cloud, py::arg("points"), py::arg("radius"), py::kw_only(),
           py::arg("name") = "cloud", py::arg("pose") = py::none(),
           py::arg("allow") = std::vector<std::string>(), py::arg("drop_invalid") = false,
           kCloudDoc)
      .def("is_inside", &is_inside, py::arg("what"), py::arg("region"), py::arg("q") = py::none(),
           py::kw_only(), py::arg("robot") = py::none(), py::arg("progress") = py::none(),
           kInsideDoc)
      .def("path_finder", &path_finder, py::kw_only(), py::arg("robot") = py::none(),
           "What finds paths of a robot query after query, faster than `find_path` does.")
      .def("pose_goals", &pose_goals, py::arg("pose"), py::kw_only(), py::arg("start") = py::none(),
           py::arg("tool") = py::none(), py::arg("robot") = py::none(), py::arg("seed") = 1,
           py::arg("progress") = py::none(), kPoseGoalsDoc)
      .def("constraint_goals", &constraint_goals, py::arg("name"), py::kw_only(),
           py::arg("start") = py::none(), py::arg("tool") = py::none(),
           py::arg("robot") = py::none(), py::arg("seed") = 1, kConstraintGoalsDoc);
  bind_questions_with_options(world);
}

constexpr const char* kWorldDoc =
    R"(Of a Scene, or of its file (docs/scene.md).

Parameters
----------
scene : Scene or path
{keywords}
)";

void bind_init(WorldClass& world) {
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text =
      document("__init__", "self: kaboum.World, scene: object",
               keywords_of(world::margin_options()), "None", kWorldDoc, Runs::Briefly);
  world.def(py::init(&read_world), py::arg("scene"), text.c_str());
}

void bind_world(py::module_& module) {
  WorldClass world(
      module, "World",
      R"(Robots and objects of a scene by their bounding sets, as kaboum-check and kaboum-move read it.

It never changes. Angles are in radians, lengths in the scene's unit.)");
  bind_init(world);
  world
      .def_property_readonly(
          "unit", [](const WorldValue& w) { return w.world().unit; }, "Of length.")
      .def_readonly("margins", &WorldValue::margins,
                    "That things are kept apart by, in words; empty: by none.")
      .def_property_readonly(
          "robots",
          [](const WorldValue& w) {
            std::vector<std::string> out;
            for (const world::RobotModel& robot : w.world().robots) out.push_back(robot.name);
            return out;
          },
          "Names.")
      .def_property_readonly(
          "objects",
          [](const WorldValue& w) {
            std::vector<std::string> out;
            for (const world::Object& object : w.world().objects) out.push_back(object.name);
            return out;
          },
          "Names.")
      .def_property_readonly(
          "regions",
          [](const WorldValue& w) {
            std::vector<std::string> out;
            for (const world::Region& region : w.world().regions) out.push_back(region.name);
            return out;
          },
          "Names.")
      .def_property_readonly(
          "notes", [](const WorldValue& w) { return spelled(w.scene->notes); },
          "What a user should know of the scene.")
      .def(
          "variables",
          [](const WorldValue& w, const std::optional<std::string>& robot) {
            std::vector<std::string> out;
            for (const robot::Variable& v :
                 w.world().robots[robot_index(w.world(), robot)].kinematics.variables)
              out.push_back(v.name);
            return out;
          },
          py::arg("robot") = py::none(), "Names of what a configuration has values for.")
      .def(
          "home",
          [](const WorldValue& w, const std::optional<std::string>& robot) {
            const std::vector<double>& home = w.world().robots[robot_index(w.world(), robot)].home;
            return row_of(home.size(), home.data());
          },
          py::arg("robot") = py::none(), "The configuration that the scene gives a robot.")
      .def("__repr__", [](const WorldValue& w) {
        return "<kaboum.World of " + std::to_string(w.world().robots.size()) + " robots and " +
               std::to_string(w.world().objects.size()) + " objects>";
      });
  bind_questions(world);
}

}  // namespace

void bind_worlds(py::module_& module) {
  bind_answers(module);
  bind_inclusion_and_pairs(module);
  bind_path(module);
  bind_path_finder(module);
  bind_world(module);
}

}  // namespace kaboum::python
