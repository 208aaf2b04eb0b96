// Documents of robots with other inertials: the document is edited, so that all else stays.

#include <kaboum/robot/inertial_edit.h>

#include <functional>

#include "model_words.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;
using Write = std::function<void(XMLElement& inertial, const Inertial&)>;

constexpr std::array<const char*, 6> kEntries{"ixx", "iyy", "izz", "ixy", "ixz", "iyz"};

/// xx, yy, zz, xy, xz, yz.
std::array<double, 6> entries(const Mat3& i) {
  return {i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)};
}

void write_urdf(XMLElement& e, const Inertial& inertial) {
  XMLElement* origin = e.InsertNewChildElement("origin");
  origin->SetAttribute("xyz", digits(inertial.origin.translation).c_str());
  origin->SetAttribute("rpy", "0 0 0");
  e.InsertNewChildElement("mass")->SetAttribute("value", digits(inertial.mass).c_str());
  XMLElement* inertia = e.InsertNewChildElement("inertia");
  const std::array<double, 6> values = entries(inertial.inertia);
  for (std::size_t k = 0; k < values.size(); ++k)
    inertia->SetAttribute(kEntries[k], digits(values[k]).c_str());
}

void write_sdf(XMLElement& e, const Inertial& inertial) {
  const Vec3& c = inertial.origin.translation;
  e.InsertNewChildElement("pose")->SetText(digits({c.x(), c.y(), c.z(), 0, 0, 0}).c_str());
  e.InsertNewChildElement("mass")->SetText(digits(inertial.mass).c_str());
  XMLElement* inertia = e.InsertNewChildElement("inertia");
  const std::array<double, 6> values = entries(inertial.inertia);
  for (std::size_t k = 0; k < values.size(); ++k)
    inertia->InsertNewChildElement(kEntries[k])->SetText(digits(values[k]).c_str());
}

void write_mjcf(XMLElement& e, const Inertial& inertial) {
  const auto [xx, yy, zz, xy, xz, yz] = entries(inertial.inertia);
  e.SetAttribute("pos", digits(inertial.origin.translation).c_str());
  e.SetAttribute("mass", digits(inertial.mass).c_str());
  e.SetAttribute("fullinertia", digits({xx, yy, zz, xy, xz, yz}).c_str());
}

/// Gives the elements of a tag, wherever they are below this one, the inertials of their names.
void edit_below(XMLElement& parent, std::string_view tag, const Write& write,
                std::map<std::string, Inertial>& left) {
  for (XMLElement* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view own = e->Name();
    if (own == "replicate") continue;  // one element for several links
    const char* name = e->Attribute("name");
    if (const auto found = own == tag && name != nullptr ? left.find(name) : left.end();
        found != left.end()) {
      XMLElement* fresh = parent.GetDocument()->NewElement("inertial");
      write(*fresh, found->second);
      XMLElement* old = e->FirstChildElement("inertial");
      if (old != nullptr)
        e->InsertAfterChild(old, fresh);
      else
        e->InsertFirstChild(fresh);
      if (old != nullptr) e->DeleteChild(old);
      left.erase(found);
    }
    edit_below(*e, tag, write, left);
  }
}

void require_own_masses(const XmlFile& file, const XMLElement& root) {
  for (const XMLElement* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    const char* from = e->Attribute("inertiafromgeom");
    if (from != nullptr && std::string_view(from) == "true")
      file.fail(*e,
                "inertiafromgeom=\"true\" takes masses from geoms whatever bodies state; "
                "take it out first");
    if (e->Attribute("settotalmass") != nullptr && e->DoubleAttribute("settotalmass", -1) > 0)
      file.fail(*e, "settotalmass scales the masses that bodies state; take it out first");
  }
}

}  // namespace

InertialEdit with_inertials(std::string_view text, const std::string& name,
                            const std::map<std::string, Inertial>& inertials) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  XMLElement& root = *document.RootElement();
  const XmlFile file(name);
  const std::string_view kind = root.Name();
  std::map<std::string, Inertial> left = inertials;
  if (kind == "robot") {
    edit_below(root, "link", write_urdf, left);
  } else if (kind == "sdf") {
    edit_below(root, "link", write_sdf, left);
  } else if (kind == "mujoco") {
    require_own_masses(file, root);
    edit_below(root, "body", write_mjcf, left);
  } else {
    file.fail(root, "neither URDF nor MJCF nor SDF: no masses can be written");
  }
  InertialEdit out;
  for (const auto& [link, inertial] : left) out.missing.push_back(link);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  out.text = printer.CStr();
  return out;
}

}  // namespace kaboum::robot
