// MJCF documents with other collision geoms: the document is edited, so that all else stays.

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include "mjcf_model.h"
#include "model_words.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

/// What a geom says of its size and place.
constexpr std::array kPlace{"type",    "size",  "pos",      "quat",        "axisangle", "xyaxes",
                            "zaxis",   "euler", "fromto",   "mesh",        "hfield",    "fitscale",
                            "density", "mass",  "material", "shellinertia"};

/// What a geom says of contacts.
constexpr std::array kContact{"contype", "conaffinity", "condim", "priority", "friction",
                              "solmix",  "solref",      "solimp", "margin",   "gap"};

/// Of these, what meets what.
constexpr std::array kBits{"contype", "conaffinity"};

template <class Action>
void visit(XMLElement& element, const Action& action) {
  for (XMLElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    action(*e);
    visit(*e, action);
  }
}

class Editor {
 public:
  Editor(tinyxml2::XMLDocument& document, const std::string& name, const ShapeEdit& edit)
      : document_(document),
        root_(*document.RootElement()),
        edit_(edit),
        model_(read_mjcf(document, name)) {}

  std::string edit() {
    collect_names();
    move_assets();
    for (std::size_t l = 0; l < edit_.links.size() && l < model_.robot.links.size(); ++l)
      if (!edit_.links[l].empty()) edit_link(l);
    for (const auto& [l, shapes] : edit_.primitives) replace_link(l, shapes);
    drop_missing();
    for (const auto& [old, fresh] : replaced_) replace_pairs(old, fresh);
    if (!edit_.primitives.empty()) drop_doubled_pairs();
    for (XMLElement* e : removed_) document_.DeleteNode(e);
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return printer.CStr();
  }

  /// As it was read.
  [[nodiscard]] const Robot& robot() const { return model_.robot; }

 private:
  void collect_names() {
    visit(root_, [&](XMLElement& e) {
      const std::string_view tag = e.Name();
      const char* name = e.Attribute("name");
      if (tag == "geom" && name != nullptr) geoms_.give(name);
      if (tag == "geom") return;
      for (const auto* a = e.FirstAttribute(); a != nullptr; a = a->Next())
        if (std::string_view(a->Name()) != "name" && tag != "pair") mentioned_.insert(a->Value());
    });
    for (const auto& [mesh, unused] : model_.meshes) meshes_.give(mesh);
  }

  /// Names of files as the new document has them.
  void move_assets() {
    bool strips = false;
    for (XMLElement* e = root_.FirstChildElement("compiler"); e != nullptr;
         e = e->NextSiblingElement("compiler")) {
      if (const char* value = e->Attribute("strippath"); value != nullptr)
        strips = std::string_view(value) == "true";
      for (const char* key : {"assetdir", "meshdir", "texturedir", "strippath"})
        e->DeleteAttribute(key);
    }
    for (XMLElement* assets = root_.FirstChildElement("asset"); assets != nullptr;
         assets = assets->NextSiblingElement("asset"))
      visit(*assets, [&](XMLElement& e) {
        const bool texture = std::string_view(e.Name()) == "texture";
        const std::string& folder = texture ? model_.texture_folder : model_.mesh_folder;
        for (const char* key :
             {"file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback"})
          if (const char* file = e.Attribute(key); file != nullptr)
            e.SetAttribute(key, edit_.moved(place_of(file, folder, strips)).c_str());
      });
  }

  static std::string place_of(std::string file, const std::string& folder, bool strips) {
    std::ranges::replace(file, '\\', '/');
    if (strips) file = file.substr(file.find_last_of('/') + 1);
    if (folder.empty() || file.starts_with('/')) return file;
    return folder + (folder.ends_with('/') ? "" : "/") + file;
  }

  /// An element of the document, which is ours to change.
  static XMLElement& mine(const XMLElement* e) { return *const_cast<XMLElement*>(e); }

  void edit_link(std::size_t l) {
    const auto& originals = (edit_.visual ? model_.visual : model_.collision)[l];
    const std::vector<ShapeMeshes>& shapes = edit_.links[l];
    const bool drawn_besides = model_.visual[l] != model_.collision[l];
    std::vector<std::string> fresh;  // of the link
    for (std::size_t i = 0; i < shapes.size() && i < originals.size(); ++i) {
      if (!done_.insert(originals[i]).second) continue;  // replicated: the same element
      if (!shapes[i] && !edit_.visual) continue;         // it stays
      std::vector<std::string> names = add_geoms(l, i);
      if (!edit_.visual) take_out(l, *originals[i], drawn_besides, names);
      std::ranges::move(names, std::back_inserter(fresh));
    }
    if (!edit_.visual) return;
    for (const XMLElement* old : model_.collision[l])
      if (gone_.insert(old).second) take_out(l, *old, drawn_besides, fresh);
  }

  /// Primitives for all shapes of a link, in its body.
  void replace_link(std::size_t l, const std::vector<Primitive>& shapes) {
    const auto& originals = (edit_.visual ? model_.visual : model_.collision).at(l);
    const XMLElement* body = l == 0 ? root_.FirstChildElement("worldbody") : model_.bodies[l];
    if (originals.empty() || body == nullptr) return;
    if (!filled_.insert(body).second) return;  // replicated: the same element
    const bool drawn_besides = model_.visual[l] != model_.collision[l];
    const char* own = body->Attribute("name");
    const std::string name = l == 0 ? "world" : own != nullptr ? own : model_.robot.links[l].name;
    // In the body, a frame's class is not its own.
    const XMLElement& first = *originals.front();
    const bool alike = first.Parent() == body && std::ranges::all_of(kBits, [&](const char* key) {
                         return bits_of(first, key) == bits_of_all(l, key);
                       });
    std::vector<std::string> fresh;
    for (const auto& [g, rpy] : shapes) {
      XMLElement* e = originals.front()->ShallowClone(&document_)->ToElement();
      for (const char* key : kPlace) e->DeleteAttribute(key);
      fresh.push_back(geoms_.give(name + "_" + std::to_string(fresh.size())));
      e->SetAttribute("name", fresh.back().c_str());
      state_primitive(*e, g);
      if (edit_.visual)
        let_collide(l, *e);
      else if (!alike)
        collide_as_all(l, *e);
      if (model_.weighed_by_geoms[l]) e->SetAttribute("mass", "0");
      mine(body).InsertEndChild(e);
    }
    std::set<const XMLElement*> old(originals.begin(), originals.end());
    if (edit_.visual) old = {model_.collision[l].begin(), model_.collision[l].end()};
    for (const XMLElement* e : old) take_out(l, *e, drawn_besides, fresh);
  }

  static void state_primitive(XMLElement& e, const Geometry& g) {
    using Shape = Geometry::Shape;
    e.SetAttribute("type", g.shape == Shape::Box      ? "box"
                           : g.shape == Shape::Sphere ? "sphere"
                                                      : "capsule");
    e.SetAttribute("size", g.shape == Shape::Box ? digits((g.size / 2).eval()).c_str()
                           : g.shape == Shape::Sphere
                               ? digits({g.size.x()}).c_str()
                               : digits({g.size.x(), g.size.y() / 2}).c_str());
    e.SetAttribute("pos", digits(g.origin.translation).c_str());
    if (g.shape == Shape::Sphere) return;
    const auto [w, x, y, z] = quaternion(g.origin.linear);
    e.SetAttribute("quat", digits({w, x, y, z}).c_str());
  }

  /// The geoms that stand for a shape, before it. @return their names
  std::vector<std::string> add_geoms(std::size_t l, std::size_t i) {
    const XMLElement& original = *(edit_.visual ? model_.visual : model_.collision)[l][i];
    const ShapeMeshes& meshes = edit_.links[l][i];
    const char* own = original.Attribute("name");
    const std::string name = own != nullptr ? own : model_.robot.links[l].name;
    std::vector<std::string> out;
    const auto add = [&](const std::string* file) {
      XMLElement* e = original.ShallowClone(&document_)->ToElement();
      out.push_back(geoms_.give(name + "_" + std::to_string(out.size())));
      e->SetAttribute("name", out.back().c_str());
      if (file != nullptr) e->SetAttribute("mesh", mesh_of(l, i, *file).c_str());
      if (edit_.visual) let_collide(l, *e);
      if (model_.weighed_by_geoms[l]) e->SetAttribute("mass", "0");
      auto* parent = mine(&original).Parent();
      if (tinyxml2::XMLNode* before = mine(&original).PreviousSibling(); before != nullptr)
        parent->InsertAfterChild(before, e);
      else
        parent->InsertFirstChild(e);
    };
    if (!meshes)
      add(nullptr);
    else
      for (const std::string& file : *meshes) add(&file);
    return out;
  }

  /// With what a shape for collisions of the link says of contacts; by default with everything.
  void let_collide(std::size_t l, XMLElement& e) const {
    std::map<std::string, std::string> like;
    if (!model_.collision[l].empty()) like = model_.geoms.at(model_.collision[l].front());
    like.emplace("contype", "1");
    like.emplace("conaffinity", "1");
    for (const char* key : kContact)
      if (const auto found = like.find(key); found != like.end())
        e.SetAttribute(key, found->second.c_str());
    if (const auto group = like.find("group"); group != like.end())
      e.SetAttribute("group", group->second.c_str());
    e.DeleteAttribute("material");
    collide_as_all(l, e);
  }

  /// With all that any of the link's shapes for collisions meets: its bits are those of all.
  void collide_as_all(std::size_t l, XMLElement& e) const {
    if (model_.collision[l].empty()) return;
    for (const char* key : kBits) e.SetAttribute(key, static_cast<int>(bits_of_all(l, key)));
  }

  [[nodiscard]] unsigned bits_of_all(std::size_t l, const char* key) const {
    unsigned out = 0;
    for (const XMLElement* geom : model_.collision[l]) out |= bits_of(*geom, key);
    return out;
  }

  /// What a geom says itself or by its class.
  [[nodiscard]] unsigned bits_of(const XMLElement& geom, const char* key) const {
    const std::map<std::string, std::string>& own = model_.geoms.at(&geom);
    const auto found = own.find(key);
    const auto stated = found == own.end() ? std::optional(1.0) : finite_number(found->second);
    if (!stated || !(std::abs(*stated) < 0x1p31)) return 0;
    return static_cast<unsigned>(static_cast<int>(*stated));
  }

  /// The mesh of a new file, with the scale and reference of the one that it stands for; once.
  std::string mesh_of(std::size_t l, std::size_t i, const std::string& file) {
    const XMLElement* original = (edit_.visual ? model_.visual : model_.collision)[l][i];
    const MjcfMesh& mesh = model_.meshes.at(model_.geoms.at(original).at("mesh"));
    const auto [at, fresh] = new_meshes_.try_emplace({file, mesh.element});
    if (!fresh) return at->second;
    std::string stem = file.substr(file.find_last_of('/') + 1);
    stem = stem.substr(0, stem.rfind('.'));
    at->second = meshes_.give(stem.empty() ? "mesh" : stem);
    XMLElement* e = assets().InsertNewChildElement("mesh");
    e->SetAttribute("name", at->second.c_str());
    e->SetAttribute("file", file.c_str());
    e->SetAttribute("scale", digits(mesh.scale).c_str());
    for (const char* key : {"refpos", "refquat"})
      if (const char* value = mesh.element->Attribute(key); value != nullptr)
        e->SetAttribute(key, value);
    return at->second;
  }

  XMLElement& assets() {
    XMLElement* e = root_.FirstChildElement("asset");
    if (e == nullptr) {
      e = document_.NewElement("asset");
      root_.InsertFirstChild(e);
    }
    return *e;
  }

  /// Has a geom collide no more. It goes where nothing else needs it: what is drawn, the body's
  /// mass, elements that name it.
  void take_out(std::size_t l, const XMLElement& old, bool drawn_besides,
                const std::vector<std::string>& fresh) {
    const char* name = old.Attribute("name");
    if (name != nullptr) replaced_[name].insert(replaced_[name].end(), fresh.begin(), fresh.end());
    const bool named = name != nullptr && mentioned_.contains(name);
    if (drawn_besides && !model_.weighed_by_geoms[l] && !named) {
      removed_.insert(&mine(&old));
      return;
    }
    mine(&old).SetAttribute("contype", "0");
    mine(&old).SetAttribute("conaffinity", "0");
  }

  /// Takes out the geoms and assets of meshes without a file.
  void drop_missing() {
    const auto drop = [&](const std::vector<Geometry>& shapes,
                          const std::vector<const XMLElement*>& elements) {
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (shapes[i].shape != Geometry::Shape::Mesh || !edit_.left_out.contains(shapes[i].mesh))
          continue;
        const XMLElement* geom = elements[i];
        if (const char* name = geom->Attribute("name"); name != nullptr) replaced_[name];
        removed_.insert(&mine(geom));
        removed_.insert(&mine(model_.meshes.at(model_.geoms.at(geom).at("mesh")).element));
      }
    };
    for (std::size_t l = 0; l < model_.robot.links.size(); ++l) {
      const Link& link = model_.robot.links[l];
      drop(link.collision, model_.collision[l]);
      drop(link.visual, model_.visual[l]);
    }
  }

  /// Pairs of the old geom become pairs of the new ones.
  void replace_pairs(const std::string& old, const std::vector<std::string>& fresh) {
    for (XMLElement* contact = root_.FirstChildElement("contact"); contact != nullptr;
         contact = contact->NextSiblingElement("contact"))
      for (XMLElement* pair = contact->FirstChildElement("pair"); pair != nullptr;) {
        XMLElement* next = pair->NextSiblingElement("pair");
        for (const char* key : {"geom1", "geom2"}) {
          const char* value = pair->Attribute(key);
          if (value == nullptr || old != value) continue;
          for (const std::string& name : fresh) {
            XMLElement* e = pair->ShallowClone(&document_)->ToElement();
            e->SetAttribute(key, name.c_str());
            e->DeleteAttribute("name");
            contact->InsertAfterChild(pair, e);
          }
          contact->DeleteChild(pair);
          break;
        }
        pair = next;
      }
  }

  /// Pairs of several old geoms that the same new ones stand for.
  void drop_doubled_pairs() {
    std::set<std::pair<std::string, std::string>> seen;
    for (XMLElement* contact = root_.FirstChildElement("contact"); contact != nullptr;
         contact = contact->NextSiblingElement("contact"))
      for (XMLElement* pair = contact->FirstChildElement("pair"); pair != nullptr;) {
        XMLElement* next = pair->NextSiblingElement("pair");
        const char *a = pair->Attribute("geom1"), *b = pair->Attribute("geom2");
        if (a != nullptr && b != nullptr && pair->Attribute("name") == nullptr &&
            !seen.insert(std::minmax(std::string(a), std::string(b))).second)
          contact->DeleteChild(pair);
        pair = next;
      }
  }

  tinyxml2::XMLDocument& document_;
  XMLElement& root_;
  const ShapeEdit& edit_;
  MjcfModel model_;
  UniqueNames geoms_, meshes_;
  std::set<std::string> mentioned_;  // by other elements than geoms and pairs
  std::map<std::pair<std::string, const XMLElement*>, std::string> new_meshes_;  // file, mesh
  std::map<std::string, std::vector<std::string>> replaced_;  // geoms by the name of the old one
  std::set<const XMLElement*> done_, gone_, filled_;
  std::set<XMLElement*> removed_;
};

}  // namespace

std::string mjcf_with_shapes(std::string_view text, const std::string& name,
                             const ShapeEdit& edit) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  if (edit.primitives.empty()) return Editor(document, name, edit).edit();
  Editor editor(document, name, edit);
  std::string out = editor.edit();
  // Classes may state what a geom does not.
  require_primitives(parse_mjcf(out, name).robot, editor.robot(), edit.primitives, name);
  return out;
}

}  // namespace kaboum::robot
