// Attached models of MJCF, written out as MuJoCo 4.0 attaches them:
// <https://mujoco.readthedocs.io/en/stable/XMLreference.html#body-attach>. tests/engines compares.
//
// What is attached comes into a frame of its own with the attached model's main class, all its
// names with the prefix. Assets and classes that it needs come with it, and so do the pairs,
// equalities, tendons, actuators and sensors that name nothing else. Angles are brought into the
// unit of the model that it is attached to.

#include <kaboum/base/error.h>
#include <kaboum/robot/mjcf.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <numbers>
#include <set>

#include "mjcf_classes.h"
#include "model_words.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr const char* kSave = "; have MuJoCo save the model as one (mj_saveLastXML)";

std::string attribute(const XMLElement& e, const char* key) {
  const char* value = e.Attribute(key);
  return value == nullptr ? std::string() : value;
}

/// Kinds of things that attributes name.
struct Reference {
  const char* key;
  const char* kind;
};
constexpr std::array kReferences{
    Reference{"body", "body"},         Reference{"body1", "body"},
    Reference{"body2", "body"},        Reference{"target", "body"},
    Reference{"joint", "joint"},       Reference{"joint1", "joint"},
    Reference{"joint2", "joint"},      Reference{"jointinparent", "joint"},
    Reference{"geom", "geom"},         Reference{"geom1", "geom"},
    Reference{"geom2", "geom"},        Reference{"site", "site"},
    Reference{"site1", "site"},        Reference{"site2", "site"},
    Reference{"refsite", "site"},      Reference{"cranksite", "site"},
    Reference{"slidersite", "site"},   Reference{"sidesite", "site"},
    Reference{"camera", "camera"},     Reference{"tendon", "tendon"},
    Reference{"tendon1", "tendon"},    Reference{"tendon2", "tendon"},
    Reference{"actuator", "actuator"}, Reference{"mesh", "mesh"},
    Reference{"material", "material"}, Reference{"texture", "texture"},
    Reference{"hfield", "hfield"},     Reference{"class", "class"},
    Reference{"childclass", "class"}};
/// Attributes that name things of a kind that another attribute states.
constexpr std::array kStated{Reference{"objname", "objtype"}, Reference{"refname", "reftype"}};

std::string stem_of(const std::string& file) {
  const std::size_t slash = file.find_last_of("/\\");
  const std::string name = slash == std::string::npos ? file : file.substr(slash + 1);
  return name.substr(0, name.rfind('.'));
}

/// What a <compiler> says of how the rest is read.
struct Settings {
  bool degrees = true;
  std::string euler = "xyz", meshes, textures;
  bool strips = false;
  std::map<std::string, std::string> others;
};

/// What MuJoCo takes where a compiler does not say it, of what changes a model's meaning.
const std::map<std::string, std::string>& usual_settings() {
  static const std::map<std::string, std::string> usual{
      {"autolimits", "true"},     {"inertiafromgeom", "auto"}, {"fitaabb", "false"},
      {"discardvisual", "false"}, {"fusestatic", "false"},     {"balanceinertia", "false"},
      {"boundmass", "0"},         {"boundinertia", "0"},       {"settotalmass", "-1"},
      {"coordinate", "local"},    {"alignfree", "false"},      {"inertiagrouprange", "0 5"}};
  return usual;
}

/// @param name  of the file, for messages
Settings settings_of(const XMLElement& root, const std::string& name) {
  Settings out;
  out.others = usual_settings();
  const auto require = [&](const XMLElement& e, bool known, const std::string& what) {
    if (!known) fail_at(name, e.GetLineNum(), "<compiler>: " + what);
  };
  for (const auto* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    if (const std::string v = attribute(*e, "angle"); !v.empty()) {
      require(*e, v == "radian" || v == "degree", "angle is '" + v + "', not radian or degree");
      out.degrees = v == "degree";
    }
    if (const std::string v = attribute(*e, "eulerseq"); !v.empty()) {
      require(*e, v.size() == 3 && v.find_first_not_of("xyzXYZ") == std::string::npos,
              "eulerseq is '" + v + "', not three of x, y, z, X, Y and Z");
      out.euler = v;
    }
    if (const std::string v = attribute(*e, "strippath"); !v.empty()) out.strips = v == "true";
    if (const std::string v = attribute(*e, "assetdir"); !v.empty()) out.meshes = out.textures = v;
    if (const std::string v = attribute(*e, "meshdir"); !v.empty()) out.meshes = v;
    if (const std::string v = attribute(*e, "texturedir"); !v.empty()) out.textures = v;
    for (auto& [key, value] : out.others)
      if (const std::string v = attribute(*e, key.c_str()); !v.empty()) value = v;
  }
  return out;
}

/// Names assets' files from the folder of the first model, and gives all a name.
void settle_assets(XMLElement& root, const std::string& name, const fs::path& folder) {
  const Settings settings = settings_of(root, name);
  for (XMLElement* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler"))
    for (const char* key : {"assetdir", "meshdir", "texturedir", "strippath"})
      e->DeleteAttribute(key);
  const auto moved = [&](std::string file, const std::string& of_kind) {
    std::ranges::replace(file, '\\', '/');
    if (settings.strips) file = file.substr(file.find_last_of('/') + 1);
    if (file.starts_with('/')) return file;
    return (folder / of_kind / file).lexically_normal().generic_string();
  };
  for (XMLElement* assets = root.FirstChildElement("asset"); assets != nullptr;
       assets = assets->NextSiblingElement("asset"))
    for (XMLElement* e = assets->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      if (tag == "model") continue;
      const std::string file = attribute(*e, "file");
      if (e->Attribute("name") == nullptr && !file.empty() && tag != "material")
        e->SetAttribute("name", stem_of(file).c_str());
      for (const char* key :
           {"file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"})
        if (const std::string value = attribute(*e, key); !value.empty())
          e->SetAttribute(
              key, moved(value, tag == "texture" ? settings.textures : settings.meshes).c_str());
    }
}

/// A model that others attach, with its own attachments written out.
struct SubModel {
  tinyxml2::XMLDocument document;
  std::string name;   ///< of the file, for messages
  std::string model;  ///< that it calls itself

  [[nodiscard]] XMLElement& root() { return *document.RootElement(); }
};

/// Angles of a model in the unit, and euler angles in the order, of another one.
class Converter {
 public:
  Converter(SubModel& model, const Settings& to)
      : model_(model),
        from_(settings_of(model.root(), model.name)),
        to_(to),
        classes_(model.name) {}

  void run() {
    for (const auto& [key, value] : from_.others)
      if (to_.others.at(key) != value)
        throw Error(ErrorCode::InvalidInput, contradiction(key, value));
    if (from_.degrees == to_.degrees && from_.euler == to_.euler) return;
    for (XMLElement* e = model_.root().FirstChildElement("default"); e != nullptr;
         e = e->NextSiblingElement("default"))
      classes_.read(*e);
    for (XMLElement* e = model_.root().FirstChildElement("worldbody"); e != nullptr;
         e = e->NextSiblingElement("worldbody"))
      convert(*e, "main");
    for (XMLElement* e = model_.root().FirstChildElement("default"); e != nullptr;
         e = e->NextSiblingElement("default"))
      for_all(*e, [&](XMLElement& one) { convert_default(one); });
  }

 private:
  [[noreturn]] void fail(const XMLElement& e, const std::string& what) const {
    fail_at(model_.name, e.GetLineNum(), std::string("<") + e.Name() + ">: " + what);
  }

  [[nodiscard]] std::string contradiction(const std::string& key, const std::string& value) const {
    return model_.name + ": its compiler has " + key + "=\"" + value +
           "\", the one of the model that it is attached to \"" + to_.others.at(key) +
           "\"; state the same" + kSave;
  }

  [[nodiscard]] double factor() const {
    if (from_.degrees == to_.degrees) return 1;
    return from_.degrees ? std::numbers::pi / 180 : 180 / std::numbers::pi;
  }

  [[nodiscard]] std::vector<double> numbers(const XMLElement& e, const char* key,
                                            const std::string& text) const {
    const auto out = finite_numbers(text);
    if (!out) fail(e, std::string(key) + " is '" + text.substr(0, 60) + "', no finite numbers");
    return *out;
  }

  static std::string text_of(const std::vector<double>& x) {
    std::string out;
    for (const double v : x) out += (out.empty() ? "" : " ") + digits(v);
    return out;
  }

  void scale(XMLElement& e, const char* key, const std::string& text) const {
    std::vector<double> x = numbers(e, key, text);
    for (double& v : x) v *= factor();
    e.SetAttribute(key, text_of(x).c_str());
  }

  [[nodiscard]] static std::string class_of(const XMLElement& e, const std::string& class_here) {
    if (const char* own = e.Attribute("childclass"); own != nullptr) return own;
    if (const char* own = e.Attribute("class"); own != nullptr) return own;
    return class_here;
  }

  void convert(XMLElement& section, const std::string& class_here) {
    for (XMLElement* e = section.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      if (tag == "replicate") {
        convert_replicate(*e);
      } else {
        turn(*e);
      }
      if (tag == "joint" && from_.degrees != to_.degrees) convert_joint(*e, class_here);
      if (tag == "body" || tag == "frame" || tag == "replicate")
        convert(*e, class_of(*e, class_here));
    }
  }

  void turn(XMLElement& e) const {
    if (const std::string text = attribute(e, "euler"); !text.empty()) {
      const std::vector<double> x = numbers(e, "euler", text);
      if (x.size() != 3) fail(e, "euler is not 3 numbers");
      const double unit = from_.degrees ? std::numbers::pi / 180 : 1;
      const auto [w, qx, qy, qz] =
          quaternion(rotation_from_euler({unit * x[0], unit * x[1], unit * x[2]}, from_.euler));
      e.DeleteAttribute("euler");
      e.SetAttribute("quat", digits({w, qx, qy, qz}).c_str());
    }
    if (const std::string text = attribute(e, "axisangle"); !text.empty()) {
      std::vector<double> x = numbers(e, "axisangle", text);
      if (x.size() != 4) fail(e, "axisangle is not 4 numbers");
      x[3] *= factor();
      e.SetAttribute("axisangle", text_of(x).c_str());
    }
  }

  void convert_replicate(XMLElement& e) const {
    const std::string text = attribute(e, "euler");
    if (text.empty()) return;
    const std::vector<double> x = numbers(e, "euler", text);
    if (from_.euler != to_.euler && std::ranges::count_if(x, [](double v) { return v != 0; }) > 0)
      fail(e, "it turns by euler angles in the order " + from_.euler +
                  ", where the model that it is attached to has " + to_.euler + kSave);
    scale(e, "euler", text);
  }

  /// What classes say of a joint's angles, whose unit depends on the joint, it says itself then.
  void convert_joint(XMLElement& e, const std::string& class_here) const {
    const Attributes a = classes_.of(e, class_here);
    const auto type = a.find("type");
    const bool turns = type == a.end() || type->second == "hinge" || type->second == "ball";
    for (const char* key : {"range", "ref", "springref"}) {
      const auto found = a.find(key);
      if (found == a.end()) continue;
      if (turns)
        scale(e, key, found->second);
      else
        e.SetAttribute(key, found->second.c_str());
    }
  }

  void convert_default(XMLElement& e) const {
    const std::string_view tag = e.Name();
    for (const char* key : {"euler", "axisangle"})
      if (e.Attribute(key) != nullptr)
        fail(e, std::string("a class that states ") + key +
                    ", whose unit or order is another one where it is attached" + kSave);
    if (tag == "joint" && from_.degrees != to_.degrees)
      for (const char* key : {"range", "ref", "springref"}) e.DeleteAttribute(key);
  }

  SubModel& model_;
  Settings from_;
  const Settings& to_;
  DefaultClasses classes_;
};

/// What MuJoCo takes where no class says it: a class of its own is to begin with these.
const std::map<std::string, std::string>* usual_attributes(const std::string& tag) {
  static const std::map<std::string, std::map<std::string, std::string>> usual{
      {"geom",
       {{"type", "sphere"},
        {"contype", "1"},
        {"conaffinity", "1"},
        {"condim", "3"},
        {"group", "0"},
        {"priority", "0"},
        {"size", "0 0 0"},
        {"solmix", "1"},
        {"friction", "1 0.005 0.0001"},
        {"margin", "0"},
        {"gap", "0"},
        {"density", "1000"},
        {"pos", "0 0 0"},
        {"fitscale", "1"},
        {"rgba", "0.5 0.5 0.5 1"},
        {"solref", "0.02 1"},
        {"solimp", "0.9 0.95 0.001 0.5 2"},
        {"shellinertia", "false"}}},
      {"joint",
       {{"type", "hinge"},
        {"group", "0"},
        {"pos", "0 0 0"},
        {"axis", "0 0 1"},
        {"stiffness", "0"},
        {"range", "0 0"},
        {"limited", "auto"},
        {"margin", "0"},
        {"ref", "0"},
        {"springref", "0"},
        {"armature", "0"},
        {"damping", "0"},
        {"frictionloss", "0"},
        {"solreflimit", "0.02 1"},
        {"solimplimit", "0.9 0.95 0.001 0.5 2"},
        {"solreffriction", "0.02 1"},
        {"solimpfriction", "0.9 0.95 0.001 0.5 2"},
        {"springdamper", "0 0"},
        {"actuatorfrclimited", "auto"},
        {"actuatorfrcrange", "0 0"}}},
      {"mesh",
       {{"scale", "1 1 1"},
        {"inertia", "legacy"},
        {"refpos", "0 0 0"},
        {"refquat", "1 0 0 0"},
        {"smoothnormal", "false"}}},
      {"site",
       {{"type", "sphere"},
        {"group", "0"},
        {"size", "0.005 0.005 0.005"},
        {"pos", "0 0 0"},
        {"rgba", "0.5 0.5 0.5 1"}}},
      {"material",
       {{"emission", "0"},
        {"specular", "0.5"},
        {"shininess", "0.5"},
        {"reflectance", "0"},
        {"rgba", "1 1 1 1"}}},
      {"motor",
       {{"ctrllimited", "auto"},
        {"forcelimited", "auto"},
        {"ctrlrange", "0 0"},
        {"forcerange", "0 0"},
        {"gear", "1 0 0 0 0 0"}}}};
  const auto found = usual.find(tag);
  return found == usual.end() ? nullptr : &found->second;
}

/// One model, what it attaches written out.
class Attacher {
 public:
  Attacher(XMLElement& root, const std::string& name, std::size_t& elements)
      : root_(root), name_(name), elements_(elements), settings_(settings_of(root, name)) {}

  void add_model(const std::string& called, std::unique_ptr<SubModel> model, const XMLElement& at) {
    Converter(*model, settings_).run();
    if (!models_.emplace(called, std::move(model)).second)
      fail(at, "there is a model '" + called + "' already");
  }

  void run() {
    for (XMLElement* e = root_.FirstChildElement("worldbody"); e != nullptr;
         e = e->NextSiblingElement("worldbody"))
      attach_in(*e);
    for (XMLElement* assets = root_.FirstChildElement("asset"); assets != nullptr;
         assets = assets->NextSiblingElement("asset"))
      while (XMLElement* e = assets->FirstChildElement("model")) assets->DeleteChild(e);
  }

 private:
  [[noreturn]] void fail(const XMLElement& e, const std::string& what) const {
    fail_at(name_, e.GetLineNum(), std::string("<") + e.Name() + ">: " + what);
  }

  void attach_in(XMLElement& section) {
    for (XMLElement* e = section.FirstChildElement(); e != nullptr;) {
      XMLElement* next = e->NextSiblingElement();
      if (std::string_view(e->Name()) == "attach") {
        section.InsertAfterChild(e, attached(*e));
        section.DeleteChild(e);
      } else {
        attach_in(*e);
      }
      e = next;
    }
  }

  /// A frame with what an <attach> stands for.
  XMLElement* attached(const XMLElement& e) {
    const std::string called = attribute(e, "model");
    const auto found = models_.find(called);
    if (found == models_.end()) fail(e, "there is no model '" + called + "' among the assets");
    SubModel& model = *found->second;
    const char* prefix = e.Attribute("prefix");
    if (prefix == nullptr) fail(e, "no prefix, which MuJoCo needs");
    names_.clear();
    attach_ = &e;
    DefaultClasses classes(model.name);
    for (const auto* d = model.root().FirstChildElement("default"); d != nullptr;
         d = d->NextSiblingElement("default"))
      classes.read(*d);
    XMLElement* frame = root_.GetDocument()->NewElement("frame");
    main_ = prefix + classes.main();
    frame->SetAttribute("childclass", main_.c_str());
    const std::string body = attribute(e, "body"), of_frame = attribute(e, "frame");
    if (!body.empty() && !of_frame.empty()) fail(e, "both a body and a frame");
    if (body.empty() && of_frame.empty()) {
      for (auto* world = model.root().FirstChildElement("worldbody"); world != nullptr;
           world = world->NextSiblingElement("worldbody"))
        for (auto* c = world->FirstChildElement(); c != nullptr; c = c->NextSiblingElement())
          add(*frame, *c, prefix);
    } else {
      const char* tag = body.empty() ? "frame" : "body";
      const std::string& name = body.empty() ? of_frame : body;
      XMLElement* part = find(model.root(), tag, name);
      if (part == nullptr) fail(e, "model '" + called + "' has no " + tag + " '" + name + "'");
      // The class that it has where it is.
      for (const auto* up = part->Parent()->ToElement(); up != nullptr;
           up = up->Parent()->ToElement())
        if (const char* inside = up->Attribute("childclass"); inside != nullptr) {
          frame->SetAttribute("childclass", (prefix + std::string(inside)).c_str());
          break;
        }
      add(*frame, *part, prefix);
    }
    bring(model, prefix, e);
    return frame;
  }

  static XMLElement* find(XMLElement& root, const char* tag, const std::string& name) {
    XMLElement* out = nullptr;
    for (auto* world = root.FirstChildElement("worldbody"); world != nullptr && out == nullptr;
         world = world->NextSiblingElement("worldbody"))
      for_all(*world, [&](XMLElement& e) {
        if (out == nullptr && std::string_view(e.Name()) == tag && attribute(e, "name") == name)
          out = &e;
      });
    return out;
  }

  void count(XMLElement& e) {
    for_all(e, [&](XMLElement&) {
      if (++elements_ > kMostExpanded)
        throw Error(ErrorCode::LimitReached, name_ + ": attached models multiply to more than " +
                                                 std::to_string(kMostExpanded) + " elements");
    });
  }

  /// A copy of a part of the tree, its names with the prefix.
  void add(XMLElement& to, XMLElement& part, const std::string& prefix) {
    count(part);
    XMLElement* copy = part.DeepClone(root_.GetDocument())->ToElement();
    to.InsertEndChild(copy);
    for_all(*copy, [&](XMLElement& e) {
      const std::string tag = e.Name();
      if (tag == "plugin") fail(*attach_, std::string("an attached model with plugins") + kSave);
      const std::string name = attribute(e, "name"), kind = tag == "freejoint" ? "joint" : tag;
      if (name.empty()) return;
      names_[kind].insert(name);
      if (!taken_.insert(kind + " " + prefix + name).second)
        fail(*attach_, "the name '" + prefix + name + "' of a " + kind +
                           " is used by what was attached before; attach it with another prefix");
    });
    for_all(*copy, [&](XMLElement& e) { give_prefix(e, prefix); });
  }

  void give_prefix(XMLElement& e, const std::string& prefix) {
    const auto put = [&](const char* key) {
      e.SetAttribute(key, (prefix + e.Attribute(key)).c_str());
    };
    if (e.Attribute("name") != nullptr) put("name");
    for (const auto& [key, kind] : kReferences) {
      const std::string value = attribute(e, key);
      if (value.empty()) continue;
      if (std::string_view(kind) == "body" && value == "world") continue;
      needed_[kind].insert(value);
      put(key);
    }
    for (const auto& [key, of] : kStated)
      if (e.Attribute(key) != nullptr && attribute(e, key) != "world") put(key);
  }

  // --- what comes with it -----------------------------------------------------------------------

  void bring(SubModel& model, const std::string& prefix, const XMLElement& e) {
    const auto [at, fresh] = prefixes_.emplace(prefix, &model);
    if (!fresh && at->second != &model)
      fail(e, "the prefix '" + prefix + "' is that of another model already");
    if (fresh) bring_classes(model, prefix, e);
    for (const char* section : {"contact", "equality", "tendon", "actuator", "sensor"})
      bring_section(model, section, prefix);
    bring_assets(model, prefix);
  }

  XMLElement& section(const char* tag) {
    XMLElement* e = root_.FirstChildElement(tag);
    if (e == nullptr) e = root_.InsertNewChildElement(tag);
    return *e;
  }

  void bring_classes(SubModel& model, const std::string& prefix, const XMLElement& at) {
    XMLElement* first = root_.FirstChildElement("default");
    if (first == nullptr) {
      first = root_.GetDocument()->NewElement("default");
      root_.InsertFirstChild(first);
    }
    XMLElement* made = root_.GetDocument()->NewElement("default");
    made->SetAttribute("class", main_.c_str());
    reset(*made, model, at);
    for (XMLElement* d = model.root().FirstChildElement("default"); d != nullptr;
         d = d->NextSiblingElement("default")) {
      count(*d);
      for (auto* c = d->FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
        XMLElement* copy = c->DeepClone(root_.GetDocument())->ToElement();
        for_all(*copy, [&](XMLElement& one) { give_prefix(one, prefix); });
        // A class has each kind of element once.
        XMLElement* there = made->FirstChildElement(c->Name());
        if (there == nullptr || std::string_view(c->Name()) == "default") {
          made->InsertEndChild(copy);
          continue;
        }
        for (const auto* a = copy->FirstAttribute(); a != nullptr; a = a->Next())
          there->SetAttribute(a->Name(), a->Value());
        root_.GetDocument()->DeleteNode(copy);
      }
    }
    first->InsertEndChild(made);
  }

  /// A class below the main one has what that one says; the attached model's has not.
  void reset(XMLElement& made, SubModel& model, const XMLElement& at) {
    DefaultClasses here(name_), there(model.name);
    for (const auto* d = root_.FirstChildElement("default"); d != nullptr;
         d = d->NextSiblingElement("default"))
      here.read(*d);
    for (const auto* d = model.root().FirstChildElement("default"); d != nullptr;
         d = d->NextSiblingElement("default"))
      there.read(*d);
    for (const std::string& tag : here.kinds_of_main()) {
      const Attributes own = there.of_kind("main", tag);
      const auto* usual = usual_attributes(tag);
      XMLElement* e = nullptr;
      for (const auto& [key, value] : here.of_kind("main", tag)) {
        if (own.contains(key)) continue;
        if (usual == nullptr || !usual->contains(key)) fail_inherited(at, key, tag);
        if (e == nullptr) e = made.InsertNewChildElement(tag.c_str());
        e->SetAttribute(key.c_str(), usual->at(key).c_str());
      }
    }
  }

  [[noreturn]] void fail_inherited(const XMLElement& at, const std::string& key,
                                   const std::string& tag) const {
    fail(at, "the main class states " + key + " of <" + tag +
                 ">, which the attached model would get; state it in a class of its own" + kSave);
  }

  /// Whether an element names only things that are attached.
  [[nodiscard]] bool is_whole(XMLElement& entry) const {
    bool whole = true;
    const auto has = [&](const std::string& kind, const std::string& name) {
      const auto found = names_.find(kind);
      return found != names_.end() && found->second.contains(name);
    };
    for_all(entry, [&](XMLElement& e) {
      for (const auto& [key, kind] : kReferences) {
        const std::string value = attribute(e, key);
        const std::string_view of = kind;
        if (value.empty() || of == "class" || of == "mesh" || of == "material" || of == "texture" ||
            of == "hfield" || (of == "body" && value == "world"))
          continue;
        whole = whole && has(kind, value);
      }
      for (const auto& [key, of] : kStated) {
        const std::string value = attribute(e, key);
        if (value.empty()) continue;
        std::string kind = attribute(e, of);
        if (kind == "xbody") kind = "body";
        whole = whole && (has(kind, value) || (kind == "body" && value == "world"));
      }
      for (const char* key : {"flex", "skin", "plugin", "instance", "bodies", "flex1", "flex2"})
        whole = whole && e.Attribute(key) == nullptr;
    });
    return whole;
  }

  /// Those of a section that name something of what is attached, and nothing else.
  void bring_section(SubModel& model, const std::string& tag, const std::string& prefix) {
    for (XMLElement* from = model.root().FirstChildElement(tag.c_str()); from != nullptr;
         from = from->NextSiblingElement(tag.c_str()))
      for (auto* c = from->FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
        if (!is_whole(*c) || !names_any(*c)) continue;
        count(*c);
        if (const std::string name = attribute(*c, "name"); !name.empty()) names_[tag].insert(name);
        XMLElement* copy = c->DeepClone(root_.GetDocument())->ToElement();
        section(tag.c_str()).InsertEndChild(copy);
        const std::string_view kind = copy->Name();
        for_all(*copy, [&](XMLElement& e) { give_prefix(e, prefix); });
        if (tag != "sensor" && kind != "exclude" && copy->Attribute("class") == nullptr)
          copy->SetAttribute("class", main_.c_str());
      }
  }

  [[nodiscard]] static bool names_any(XMLElement& entry) {
    bool any = false;
    for_all(entry, [&](XMLElement& e) {
      for (const auto& [key, kind] : kReferences)
        any = any || (e.Attribute(key) != nullptr && std::string_view(kind) != "class");
      for (const auto& [key, of] : kStated) any = any || e.Attribute(key) != nullptr;
    });
    return any;
  }

  /// Assets that what is attached names, or its classes do.
  void bring_assets(SubModel& model, const std::string& prefix) {
    for (const char* tag : {"material", "mesh", "hfield", "texture"})  // materials need textures
      for (XMLElement* assets = model.root().FirstChildElement("asset"); assets != nullptr;
           assets = assets->NextSiblingElement("asset"))
        for (XMLElement* c = assets->FirstChildElement(tag); c != nullptr;
             c = c->NextSiblingElement(tag)) {
          const std::string name = attribute(*c, "name");
          if (!needed_[tag].contains(name) || !assets_.insert({tag, prefix + name}).second)
            continue;
          count(*c);
          XMLElement* copy = c->DeepClone(root_.GetDocument())->ToElement();
          section("asset").InsertEndChild(copy);
          for_all(*copy, [&](XMLElement& e) { give_prefix(e, prefix); });
          if ((std::string_view(tag) == "mesh" || std::string_view(tag) == "material") &&
              copy->Attribute("class") == nullptr)
            copy->SetAttribute("class", main_.c_str());
        }
    needed_.clear();
  }

  XMLElement& root_;
  const std::string& name_;
  std::size_t& elements_;
  Settings settings_;
  std::map<std::string, std::unique_ptr<SubModel>> models_;
  std::map<std::string, SubModel*> prefixes_;
  std::set<std::pair<std::string, std::string>> assets_;  // tag, name
  std::set<std::string> taken_;
  const XMLElement* attach_ = nullptr;                   // that is being written out
  std::string main_;                                     // class, with its prefix
  std::map<std::string, std::set<std::string>> names_;   // that were attached, by kind
  std::map<std::string, std::set<std::string>> needed_;  // by what was copied, by kind
};

using FileText = std::function<std::string(const std::string& file)>;

bool attaches(const XMLElement& element) {
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view tag = e->Name();
    if (tag == "attach" || (tag == "model" && std::string_view(element.Name()) == "asset") ||
        attaches(*e))
      return true;
  }
  return false;
}

/// Bodies of what is attached that would be lost.
void require_rigid(const XMLElement& root, const std::string& name) {
  for (const auto* section = root.FirstChildElement("deformable"); section != nullptr;
       section = section->NextSiblingElement("deformable"))
    if (const auto* flex = section->FirstChildElement("flex"); flex != nullptr)
      fail_at(name, flex->GetLineNum(),
              "<flex>: flexible bodies have no shape that bodies could hold");
}

/// Counts elements, of which files that name others several times have too many. A file is as much
/// work as some elements.
void count_read(XMLElement& root, const std::string& name, std::size_t& elements) {
  constexpr std::size_t kFile = 100;
  elements += kFile;
  for_all(root, [&](XMLElement&) { ++elements; });
  if (elements > kMostExpanded)
    throw Error(ErrorCode::LimitReached, name +
                                             ": the models that it attaches, and those that they "
                                             "attach, have more than " +
                                             std::to_string(kMostExpanded) + " elements");
}

/// @param folder  of the model, from that of the first one
/// @param chain   files that this one is attached by, and itself
void write_out(XMLElement& root, const std::string& name, const fs::path& folder,
               const FileText& read, std::vector<std::string>& chain, std::size_t& elements) {
  settle_assets(root, name, folder);
  Attacher attacher(root, name, elements);
  for (XMLElement* assets = root.FirstChildElement("asset"); assets != nullptr;
       assets = assets->NextSiblingElement("asset"))
    for (XMLElement* e = assets->FirstChildElement("model"); e != nullptr;
         e = e->NextSiblingElement("model")) {
      std::string file = attribute(*e, "file");
      if (file.empty()) fail_at(name, e->GetLineNum(), "<model> without a file");
      std::ranges::replace(file, '\\', '/');
      const std::string path = (folder / file).lexically_normal().generic_string();
      if (std::ranges::find(chain, path) != chain.end())
        fail_at(name, e->GetLineNum(), "'" + path + "' is attached to itself, by way of others");
      if (chain.size() > kMostNested)
        fail_at(name, e->GetLineNum(),
                "models are attached more than " + std::to_string(kMostNested) + " deep");
      auto model = std::make_unique<SubModel>();
      model->name = path;
      const fs::path inner = fs::path(path).parent_path();
      parse_xml(model->document,
                expand_mjcf(read(path), path,
                            [&](const std::string& included) {
                              return read((inner / included).lexically_normal().generic_string());
                            }),
                path);
      model->model = attribute(model->root(), "model");
      count_read(model->root(), path, elements);
      require_rigid(model->root(), path);
      chain.push_back(path);
      write_out(model->root(), model->name, inner, read, chain, elements);
      chain.pop_back();
      const std::string own = attribute(*e, "name");
      const std::string called = own.empty() ? model->model : own;
      attacher.add_model(called, std::move(model), *e);
    }
  attacher.run();
}

}  // namespace

std::string attach_mjcf(std::string_view text, const std::string& name, const FileText& read) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  if (!attaches(*document.RootElement())) return std::string(text);
  std::vector<std::string> chain{fs::path(name).filename().generic_string()};
  std::size_t elements = 0;
  write_out(*document.RootElement(), name, {}, read, chain, elements);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace kaboum::robot
