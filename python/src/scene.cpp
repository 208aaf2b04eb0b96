// Scenes: kaboum.Scene, made in process; make_scene and update_scene, as kaboum-scene.

#include "scene.h"

#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/scene/scene_draft.h>
#include <kaboum/scene/scene_options.h>
#include <kaboum/scene/scene_update.h>
#include <kaboum/world/primitive.h>

#include <memory>

#include "convex_set.h"
#include "request_options.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

struct SceneValue {
  std::shared_ptr<scene::SceneDraft> draft;
};

std::string object_called(const std::string& name) { return "object '" + name + "'"; }

std::vector<double> pose_of(const py::object& at, const std::string& name) {
  std::vector<double> out;
  try {
    out = at.cast<std::vector<double>>();
  } catch (const py::cast_error&) {
  }
  if (out.size() != 3 && out.size() != 6 && out.size() != 7)
    throw Error(
        ErrorCode::InvalidArgument,
        "at of '" + name +
            "' must be x, y, z; or these and roll, pitch, yaw; or these and a quaternion x, "
            "y, z, w");
  return out;
}

/// A pose as scene files state it.
py::dict pose_dict(const py::object& at, const std::string& name) {
  const std::vector<double> numbers = pose_of(at, name);
  const auto list = [&](std::size_t from, std::size_t to) {
    py::list out;
    for (std::size_t i = from; i < to; ++i) out.append(numbers[i]);
    return out;
  };
  py::dict out;
  out["position"] = list(0, 3);
  if (numbers.size() == 6) out["rpy"] = list(3, 6);
  if (numbers.size() == 7) out["quaternion"] = list(3, 7);
  return out;
}

/// A mesh's file and what it refers to, as they are now.
std::vector<std::filesystem::path> sources_of(const std::string& file) {
  std::vector<std::filesystem::path> out;
  if (file.empty()) return out;
  out.emplace_back(file);
  for (const std::string& other : io::read_mesh(file).other_files) out.emplace_back(other);
  return out;
}

bool is_made(const py::object& shape) { return py::isinstance<CertifiedSetValue>(shape); }

/// A dict as of scene files: {"sphere": {"radius": 0.1}}.
bool is_primitive(const py::object& shape) { return py::isinstance<py::dict>(shape); }

/// Refuses options that no mesh is made into a set with.
void require_mesh(const py::dict& options, bool all_made) {
  if (!options.empty() && all_made)
    throw Error(ErrorCode::InvalidArgument,
                "options of `decompose` are for meshes: this is a set that was made already");
}

/// A CertifiedSet, or one made of a mesh. @param given  options for a mesh
scene::SceneSet set_from(const py::object& shape, const py::dict& given, const char* direction,
                         const std::string& unit) {
  py::object made = shape;
  if (!is_made(shape)) {
    const py::dict options = given.attr("copy")();
    if (!options.contains("unit")) options["unit"] = unit;
    if (!options.contains("direction")) options["direction"] = direction;
    made = py::module_::import("kaboum").attr("decompose")(shape, **options);
  }
  const auto& value = made.cast<const CertifiedSetValue&>();
  using Direction = certify::SetRequest::Direction;
  const bool outer = value.made.certificate().direction == Direction::Outer;
  if (outer != (std::string(direction) == "outer"))
    throw Error(ErrorCode::InvalidArgument, std::string("an ") + direction +
                                                " set is needed: decompose with direction '" +
                                                direction + "'");
  return run(0, [&] { return scene::SceneSet{value.made, sources_of(value.file)}; });
}

py::dict dict_of_made(const scene::MadeScene& made) {
  py::dict out;
  std::vector<std::string> containers;
  for (const std::filesystem::path& path : made.containers) containers.push_back(path.string());
  out["containers"] = containers;
  out["inputs"] = made.inputs;
  out["sizes"] = made.sizes;
  out["bad_links"] = made.bad_links;
  out["notes"] = spelled(made.notes);
  return out;
}

// A draft waits for other threads that use it: not with the interpreter's lock.
std::string unit_of(const SceneValue& scene) {
  return run(0, [&] { return scene.draft->unit(); });
}

std::string file_of(const SceneValue& scene) {
  return run(0, [&] { return scene.draft->file().string(); });
}

void add_entry(SceneValue& scene, const char* list, const py::object& entry) {
  const std::string text = json_text(entry, list);
  run(0, [&] { scene.draft->add_entry(list, text); });
}

std::string path_text(const py::object& path, const char* argument) {
  const auto file = path_of(path);
  if (!file)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a str or an os.PathLike");
  return *file;
}

void add_robot(SceneValue& scene, const std::string& name, const py::object& robot,
               const py::object& at, const py::kwargs& members) {
  if (!py::isinstance<CertifiedValue>(robot))
    throw Error(ErrorCode::InvalidArgument, "robot must be a kaboum.CertifiedRobot");
  const auto& value = robot.cast<const CertifiedValue&>();
  if (!at.is_none()) members["base"] = pose_dict(at, name);
  const std::string text = json_text(members, "robot '" + name + "'");
  run(0, [&] { scene.draft->add_robot(name, value.file, value.made, text); });
}

void add_object(SceneValue& scene, const std::string& name, const py::object& shape,
                const py::object& at, const py::object& inner, const py::object& features,
                const py::object& grasps, const py::kwargs& options) {
  const bool primitive = is_primitive(shape);
  require_mesh(options, primitive || (is_made(shape) && (inner.is_none() || is_made(inner))));
  if (primitive && !inner.is_none())
    throw Error(ErrorCode::InvalidArgument, "inner: a primitive has its own inner set");
  const std::string unit = unit_of(scene);
  py::dict members;
  if (!at.is_none()) members["pose"] = pose_dict(at, name);
  if (!features.is_none()) members["features"] = features;
  if (!grasps.is_none()) members["grasps"] = grasps;
  const std::string text = json_text(members, object_called(name));
  if (primitive) {
    const std::string sizes = json_text(shape, object_called(name));
    run(0, [&] { scene.draft->add_primitive_object(name, sizes, text); });
    return;
  }
  scene::SceneSet outer = set_from(shape, options, "outer", unit);
  std::optional<scene::SceneSet> in;
  // With the same options: a set of another scale, or of the sheets too, is not inside the other.
  if (!inner.is_none()) in = set_from(inner, options, "inner", unit);
  run(0, [&] { scene.draft->add_object(name, std::move(outer), std::move(in), text); });
}

void add_region(SceneValue& scene, const std::string& name, const py::object& shape,
                const py::object& at, const py::kwargs& options) {
  require_mesh(options, is_made(shape) || is_primitive(shape));
  py::dict members;
  if (!at.is_none()) members["pose"] = pose_dict(at, name);
  const std::string region = "region '" + name + "'", text = json_text(members, region);
  if (is_primitive(shape)) {
    const std::string primitive = json_text(shape, region);
    run(0, [&] { scene.draft->add_primitive_region(name, primitive, text); });
    return;
  }
  scene::SceneSet inner = set_from(shape, options, "inner", unit_of(scene));
  run(0, [&] { scene.draft->add_region(name, std::move(inner), text); });
}

/// Files by name; of what is described by its sizes, a primitive, where those are taken.
std::vector<scene::NamedFile> files_of(const py::object& given, const char* argument,
                                       std::vector<scene::NamedPrimitive>* primitives = nullptr) {
  std::vector<scene::NamedFile> out;
  if (given.is_none()) return out;
  if (!py::isinstance<py::dict>(given))
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a dict of names and files");
  for (const auto& [key, shape] : given.cast<py::dict>()) {
    const auto value = py::reinterpret_borrow<py::object>(shape);
    const std::string name = py::str(key);
    if (primitives != nullptr && is_primitive(value))
      primitives->push_back({name, world::parse_primitive(json_text(value, object_called(name)),
                                                          object_called(name))});
    else
      out.push_back({name, path_text(value, argument)});
  }
  return out;
}

py::dict make_scene(const py::object& path, const py::object& robots, const py::object& objects,
                    const py::object& regions, const py::object& at,
                    const std::map<std::string, double>& scale, const py::kwargs& given) {
  scene::SceneMaker maker;
  const RunKeywords running =
      take_keywords("make_scene", scene::scene_options(), given, maker, Runs::Cached);
  bring_lengths_into(maker.options.sets.unit, scene::scene_options(), maker);
  maker.scene = path_text(path, "path");
  maker.robots = files_of(robots, "robots");
  maker.objects = files_of(objects, "objects", &maker.primitives);
  maker.regions = files_of(regions, "regions");
  if (!at.is_none())
    for (const auto& [name, pose] : at.cast<py::dict>()) {
      std::string text;
      const std::string of = py::str(name);
      for (const double x : pose_of(py::reinterpret_borrow<py::object>(pose), of))
        text += (text.empty() ? "" : ",") + py::repr(py::float_(x)).cast<std::string>();
      maker.places.emplace(of, robot::parse_pose(text, "at " + of));
    }
  for (const auto& [name, factor] : scale) {
    if (!(factor >= 1e-9 && factor <= 1e9))
      throw Error(ErrorCode::InvalidArgument,
                  "scale of '" + name + "' must be a number from 1e-9 to 1e9");
    maker.scales.emplace(name, factor);
  }
  Watch watch(running.progress);
  maker.options.progress = watch.hook();
  return dict_of_made(run(running.threads, [&] {
    const certify::SetCache cache(certify::SetCache::default_folder());
    if (!running.no_cache) maker.options.cache = &cache;
    return scene::make_scene(maker);
  }));
}

py::dict update_scene(const py::object& path, const py::kwargs& given) {
  scene::SceneMaker asked;
  const RunKeywords running =
      take_keywords("update_scene", scene::update_options(), given, asked, Runs::Cached);
  Watch watch(running.progress);
  const std::string file = path_text(path, "path");
  return dict_of_made(run(running.threads, [&] {
    const certify::SetCache cache(certify::SetCache::default_folder());
    return scene::update_scene(
        {file, asked.options.packages, running.no_cache ? nullptr : &cache, watch.hook()});
  }));
}

py::dict dict_of_added(const scene::AddedFeatures& added) {
  py::dict names, kept, without, unchecked;
  for (const scene::AddedFeatures::OfObject& object : added.objects) {
    const py::str name(object.object);
    names[name] = object.names;
    if (!object.kept.empty()) kept[name] = object.kept;
    if (!object.shortfall.empty()) without[name] = object.shortfall;
    if (!object.unchecked.empty()) unchecked[name] = object.unchecked;
  }
  py::dict out;
  out["names"] = names;
  out["kept"] = kept;
  out["without"] = without;
  out["unchecked"] = unchecked;
  out["notes"] = spelled(added.notes);
  return out;
}

/// The objects that are named; None: all, which is empty.
std::vector<std::string> objects_given(const py::object& objects) {
  if (objects.is_none()) return {};
  if (py::isinstance<py::str>(objects)) return {objects.cast<std::string>()};
  std::vector<std::string> out;
  bool all_are_names = py::isinstance<py::iterable>(objects);
  if (all_are_names)
    for (const py::handle one : objects) {
      all_are_names = all_are_names && py::isinstance<py::str>(one);
      if (all_are_names) out.push_back(one.cast<std::string>());
    }
  if (!all_are_names)
    throw Error(ErrorCode::InvalidArgument, "objects must be a str or a sequence of str");
  if (out.empty())
    throw Error(ErrorCode::InvalidArgument,
                "objects is empty: name some, or leave it out for all objects");
  return out;
}

/// Has what a table's request derives written into a scene.
template <typename Request>
py::dict add_derived(const char* function, const std::vector<Option<Request>>& table,
                     scene::AddedFeatures (*add)(const std::filesystem::path&,
                                                 const std::vector<std::string>&, const Request&),
                     const py::object& path, const py::object& objects, const py::kwargs& given) {
  Request request;
  take_keywords(function, table, given, request, Runs::Briefly);
  const std::string file = path_text(path, "path");
  const std::vector<std::string> names = objects_given(objects);
  return dict_of_added(run(0, [&] { return add(file, names, request); }));
}

py::dict add_grasps(const py::object& path, const py::object& objects, const py::kwargs& given) {
  return add_derived("add_grasps", scene::grasp_options(), scene::add_grasps, path, objects, given);
}

py::dict add_places(const py::object& path, const py::object& objects, const py::kwargs& given) {
  return add_derived("add_places", scene::place_options(), scene::add_places, path, objects, given);
}

constexpr const char* kGraspsDoc =
    R"(Derives grasps of objects from the faces and round sides of their sets, free of contact with the
hand, and writes them into the scene, single poses and families: `kaboum-scene grasps`.

Grasps of the tool that were derived so before are replaced where some are found. Whether an arm
gets there, and whether fingers or a cup reach the faces, is not looked at.

Parameters
----------
path : str or path
objects : str or sequence of str, optional
    By default all.
{keywords}

Returns
-------
dict
    'names': by object, those of its grasps. 'kept': by object, of those that were derived before,
    where none are found. 'without': by object, why none are found, or that nothing of the hand was
    looked at. 'unchecked': by object, links of the hand that were not looked at. 'notes'.)";

constexpr const char* kPlacesDoc =
    R"(Derives points on which objects stand ('bottom') and on which others are put ('top', 'top2', …),
and the surfaces that look up ('face', 'face2', …), from level faces of their sets, and writes them
into the scene: `kaboum-scene places`.

Parameters
----------
path : str or path
objects : str or sequence of str, optional
    By default all.
{keywords}

Returns
-------
dict
    'names': by object, those of what was derived. 'kept': by object, of those that it
    had. 'without': by object, what it has not. 'unchecked': empty. 'notes'.)";

constexpr const char* kSceneDoc =
    R"(Robots, objects and regions with certified sets, put together in process (docs/scene.md).

`World` takes it as it is; `write` makes the files that the programs read. Lengths are in its unit,
angles in radians. Several threads may use it at once.)";

constexpr const char* kAddRobotDoc =
    R"(Adds a robot.

Parameters
----------
name : str
robot : CertifiedRobot
    Of all links that have shapes.
at : sequence of float, optional
    Where its base stands: x, y, z; and roll, pitch, yaw or a quaternion x, y, z, w.
**members
    What else scene files say of robots: `home`, `limits`, `tools`, `grippers`, `features`,
    `allowed_contacts`.)";

constexpr const char* kAddObjectDoc =
    R"(Adds an object.

Parameters
----------
name : str
shape : CertifiedSet, mesh or dict
    A mesh is decomposed. A dict is a primitive, as in scene files: {'box': {'size': [x, y, z]}},
    {'sphere': {'radius': r}}, 'cylinder' or 'capsule' with 'radius' and 'length', 'plane' with
    'size'.
at : sequence of float, optional
    Where it stands: x, y, z; and roll, pitch, yaw or a quaternion x, y, z, w.
inner : CertifiedSet or mesh, optional
    A set inside it, so that contacts can be certain; of the same mesh, at the same scale.
features, grasps : list of dict, optional
    As in scene files.
**options
    Of `decompose`, for a mesh: the same for `shape` and `inner`, so that one is inside the other.)";

constexpr const char* kSceneWriteDoc =
    R"(Writes the scene (.json or .yaml), and its sets into a folder of its name beside it.

Parameters
----------
path : str or path
    In a folder that is there.
force : bool
    Replace a scene that exists, or one that has changed since it was read or written here.

Returns
-------
dict
    'containers': written. 'inputs': files that sets were made from, and 'sizes' of objects and
    regions, of those that were added. 'bad_links': of robots, that are not held as asked for.
    'notes'.)";

constexpr const char* kMakeDoc =
    R"(Makes a scene of URDFs and meshes, with the convex sets that it needs: `kaboum-scene make`.

Parameters
----------
path : str or path
    The scene to write (.json or .yaml); sets go into a folder beside it.
robots, objects, regions : dict, optional
    By name, files: URDFs, meshes. An object may be a primitive, a dict as of `Scene.add_object`.
at : dict, optional
    By name, where things stand: x, y, z; and roll, pitch, yaw or a quaternion x, y, z, w.
scale : dict
    By name, what the coordinates of an object's or region's mesh are multiplied by.
{keywords}

Returns
-------
dict
    As `Scene.write`.)";

constexpr const char* kUpdateDoc =
    R"(Makes those sets of a scene anew that are out of date: `kaboum-scene update`.

Parameters
----------
path : str or path
{keywords}

Returns
-------
dict
    As `Scene.write`; no containers where nothing is out of date.)";

void bind_scene(py::module_& module) {
  py::class_<SceneValue>(module, "Scene", kSceneDoc)
      .def(py::init([](const std::string& unit) {
             return SceneValue{std::make_shared<scene::SceneDraft>(unit)};
           }),
           py::kw_only(), py::arg("unit") = "m", "An empty scene.")
      .def_static(
          "read",
          [](const py::object& path) {
            const std::string file = path_text(path, "path");
            return run(0, [&] {
              return SceneValue{std::make_shared<scene::SceneDraft>(scene::SceneDraft::read(file))};
            });
          },
          py::arg("path"), "A scene that was written; it is written where it was.")
      .def_property_readonly("unit", &unit_of, "Of length.")
      .def_property_readonly(
          "path",
          [](const SceneValue& s) -> py::object {
            const std::string file = file_of(s);
            if (file.empty()) return py::none();
            return py::str(file);
          },
          "Where it was read or written last, or None.")
      .def_property_readonly(
          "data",
          [](const SceneValue& s) {
            return py::module_::import("json").attr("loads")(
                run(0, [&] { return s.draft->json(); }));
          },
          "A dict: what the scene's file says.")
      .def("add_robot", &add_robot, py::arg("name"), py::arg("robot"), py::kw_only(),
           py::arg("at") = py::none(), kAddRobotDoc)
      .def("add_object", &add_object, py::arg("name"), py::arg("shape"), py::kw_only(),
           py::arg("at") = py::none(), py::arg("inner") = py::none(),
           py::arg("features") = py::none(), py::arg("grasps") = py::none(), kAddObjectDoc)
      .def("add_region", &add_region, py::arg("name"), py::arg("shape"), py::kw_only(),
           py::arg("at") = py::none(),
           "Adds a region: a shape as of `add_object`, whose inner set it is.")
      .def(
          "allow_contact",
          [](SceneValue& s, const std::string& a, const std::string& b) {
            py::list pair;
            pair.append(a);
            pair.append(b);
            add_entry(s, "allowed_contacts", pair);
          },
          py::arg("a"), py::arg("b"), "Lets 'OBJECT', 'ROBOT/LINK' or 'ROBOT' touch another one.")
      .def(
          "attach",
          [](SceneValue& s, const py::kwargs& members) { add_entry(s, "attachments", members); },
          "Has an object move with a robot: `object`, `robot`, `link`, `tool` or `gripper`, "
          "`grasp` "
          "or a pose, as in scene files.")
      .def(
          "write",
          [](SceneValue& s, const py::object& path, bool force) {
            const std::string file = path_text(path, "path");
            return dict_of_made(run(0, [&] { return s.draft->write(file, force); }));
          },
          py::arg("path"), py::kw_only(), py::arg("force") = false, kSceneWriteDoc)
      .def("__repr__", [](const SceneValue& s) {
        const std::string file = file_of(s);
        return "<kaboum.Scene" + (file.empty() ? "" : " '" + file + "'") + ">";
      });
}

}  // namespace

std::optional<world::SceneFile> scene_file_of(const py::object& value) {
  if (!py::isinstance<SceneValue>(value)) return std::nullopt;
  const auto& scene = value.cast<const SceneValue&>();
  return run(0, [&] { return scene.draft->world(); });
}

void bind_scenes(py::module_& module) {
  bind_scene(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string update_text =
      document("update_scene", "path: object", keywords_of(scene::update_options()), "dict",
               kUpdateDoc, Runs::Cached);
  module.def("update_scene", &update_scene, py::arg("path"), update_text.c_str());
  const std::string grasps_text =
      document("add_grasps", "path: object, objects: object = None",
               keywords_of(scene::grasp_options()), "dict", kGraspsDoc, Runs::Briefly);
  module.def("add_grasps", &add_grasps, py::arg("path"), py::arg("objects") = py::none(),
             grasps_text.c_str());
  const std::string places_text =
      document("add_places", "path: object, objects: object = None",
               keywords_of(scene::place_options()), "dict", kPlacesDoc, Runs::Briefly);
  module.def("add_places", &add_places, py::arg("path"), py::arg("objects") = py::none(),
             places_text.c_str());
  const std::string text = document(
      "make_scene",
      "path: object, *, robots: object = None, objects: object = None, regions: object = None, "
      "at: object = None, scale: dict = {}",
      keywords_of(scene::scene_options()), "dict", kMakeDoc);
  module.def("make_scene", &make_scene, py::arg("path"), py::kw_only(),
             py::arg("robots") = py::none(), py::arg("objects") = py::none(),
             py::arg("regions") = py::none(), py::arg("at") = py::none(),
             py::arg("scale") = py::dict(), text.c_str());
}

}  // namespace kaboum::python
