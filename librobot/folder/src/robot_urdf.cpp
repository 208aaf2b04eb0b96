// URDFs with other shapes: the document is edited, so that what is not known of it stays.

#include "robot_urdf.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot_folder/urdf_text.h>

#include <functional>
#include <string_view>

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

std::vector<XMLElement*> children(XMLElement* element, const char* tag) {
  std::vector<XMLElement*> out;
  for (XMLElement* e = element->FirstChildElement(tag); e != nullptr;
       e = e->NextSiblingElement(tag))
    out.push_back(e);
  return out;
}

constexpr const char* kDeclareConvex = "drake:declare_convex";

const char* tag_of(bool visual) { return visual ? "visual" : "collision"; }

}  // namespace

RobotUrdf::RobotUrdf(const robot::RobotFile& robot, fs::path folder)
    : robot_(robot.robot),
      file_(robot.path.string()),
      from_(fs::absolute(robot.path).parent_path()),
      folder_(std::move(folder)),
      text_(robot.text) {
  if (document_.Parse(text_.data(), text_.size()) != tinyxml2::XML_SUCCESS ||
      document_.RootElement() == nullptr || std::string(document_.RootElement()->Name()) != "robot")
    throw Error(ErrorCode::InvalidInput, file_ + ": not a URDF");
  state_world();
}

void RobotUrdf::state_world() {
  XMLElement* root = document_.RootElement();
  const std::string world = "world";
  for (const XMLElement* e : children(root, "link"))
    if (const char* name = e->Attribute("name"); name != nullptr && world == name) return;
  for (const XMLElement* joint : children(root, "joint")) {
    const XMLElement* parent = joint->FirstChildElement("parent");
    const char* link = parent != nullptr ? parent->Attribute("link") : nullptr;
    if (link == nullptr || world != link) continue;
    XMLElement* stated = document_.NewElement("link");
    stated->SetAttribute("name", link);
    root->InsertFirstChild(stated);
    return;
  }
}

std::vector<std::string> RobotUrdf::mesh_stems() const {
  std::vector<std::string> out;
  const std::function<void(const XMLElement*)> visit = [&](const XMLElement* element) {
    for (const XMLElement* e = element->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      visit(e);
      const char* name = e->Attribute("filename");
      if (name != nullptr && std::string_view(e->Name()) == "mesh")
        out.push_back(fs::path(name).stem().string());
    }
  };
  visit(document_.RootElement());
  return out;
}

XMLElement* RobotUrdf::element_of(const std::string& link) {
  for (XMLElement* e : children(document_.RootElement(), "link"))
    if (const char* name = e->Attribute("name"); name != nullptr && link == name) return e;
  throw Error(ErrorCode::Internal, file_ + ": link '" + link + "' is lost");
}

void RobotUrdf::require_shapes(const std::string& link, bool visual, std::size_t shapes) {
  const char* tag = tag_of(visual);
  if (children(element_of(link), tag).size() != shapes)
    throw Error(ErrorCode::InvalidInput,
                file_ + ": link '" + link + "' has <" + tag + "> elements that cannot be read");
}

/// A <collision> with the pose and geometry of a <collision> or <visual>.
XMLElement* RobotUrdf::collision(const XMLElement* original, const std::string& link,
                                 std::size_t number) {
  XMLElement* copy = document_.NewElement("collision");
  copy->SetAttribute("name", (link + "_" + std::to_string(number)).c_str());
  for (const char* part : {"origin", "geometry"})
    if (const XMLElement* e = original->FirstChildElement(part))
      copy->InsertEndChild(e->DeepClone(&document_));
  return copy;
}

void RobotUrdf::replace(const std::string& link, bool visual, const std::vector<NewShape>& shapes,
                        const MeshNames& names) {
  XMLElement* element = element_of(link);
  const std::vector<XMLElement*> originals = children(element, tag_of(visual));
  const std::vector<XMLElement*> old = children(element, "collision");
  tinyxml2::XMLNode* last = element->LastChild();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i].meshes) {
      XMLElement* copy = collision(originals[i], link, shapes[i].first);
      move_references(copy);  // of a mesh that stays
      last = element->InsertAfterChild(last, copy);
      continue;
    }
    for (std::size_t b = 0; b < shapes[i].meshes->size(); ++b) {
      XMLElement* copy = collision(originals[i], link, shapes[i].first + b);
      XMLElement* mesh = copy->FirstChildElement("geometry")->FirstChildElement("mesh");
      mesh->SetAttribute("filename", (names.prefix + (*shapes[i].meshes)[b]).c_str());
      mesh->DeleteChildren();
      if (names.declare_convex) mesh->InsertNewChildElement(kDeclareConvex);
      last = element->InsertAfterChild(last, copy);
    }
  }
  for (XMLElement* e : old) element->DeleteChild(e);
  if (names.declare_convex)
    document_.RootElement()->SetAttribute("xmlns:drake", "http://drake.mit.edu");
}

void RobotUrdf::keep(const std::string& link) {
  for (XMLElement* e : children(element_of(link), "collision")) move_references(e);
}

void RobotUrdf::move_references(XMLElement* element) {
  for (XMLElement* e = element->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string tag = e->Name();
    const char* name = e->Attribute("filename");
    if (tag != "collision") move_references(e);
    if (name == nullptr || (tag != "mesh" && tag != "texture")) continue;
    e->SetAttribute("filename", moved_reference(name, from_, folder_).c_str());
  }
}

std::string RobotUrdf::text(const NewShapes& shapes, bool visual, const MeshNames& names) {
  for (std::size_t l = 0; l < shapes.size(); ++l) {
    if (shapes[l].empty())
      keep(robot_.links[l].name);
    else
      replace(robot_.links[l].name, visual, shapes[l], names);
  }
  move_references(document_.RootElement());
  if (let_mujoco_find_meshes(*document_.RootElement()))
    notes_ = {
        "MuJoCo is told to leave out shapes for drawing (discardvisual): it finds no meshes that "
        "are named by package://"};
  tinyxml2::XMLPrinter printer;
  document_.Print(&printer);
  return printer.CStr();
}

}  // namespace kaboum::robot_folder
