// Documents of robots with other inertials: the document is edited, so that all else stays.

#include <kaboum/base/error.h>
#include <kaboum/robot/inertial_edit.h>

#include <array>
#include <functional>

#include "link_elements.h"
#include "model_words.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

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

/// Takes the inertials of a link's element out: MJCF has frames in bodies.
void delete_inertials(XMLElement& link) {
  for (XMLElement* e = link.FirstChildElement(); e != nullptr;) {
    XMLElement* next = e->NextSiblingElement();
    const std::string_view tag = e->Name();
    if (tag == "inertial")
      link.DeleteChild(e);
    else if (tag == "frame" || tag == "replicate")
      delete_inertials(*e);
    e = next;
  }
}

/// About the axes of the link.
Inertial in_link_axes(const Inertial& inertial) {
  Inertial out = inertial;
  out.origin.linear = Mat3::Identity();
  const Mat3& r = inertial.origin.linear;
  if (!r.isIdentity(0)) out.inertia = r * inertial.inertia * r.transpose();
  return out;
}

bool is_same(const Inertial& a, const Inertial& b) {
  return a.mass == b.mass && a.origin.translation == b.origin.translation &&
         a.origin.linear == b.origin.linear && a.inertia == b.inertia;
}

/// A kind of document: how its links are found, and how an inertial is stated.
struct Kind {
  std::function<LinkElements(tinyxml2::XMLDocument&, const std::string&)> links;
  std::function<void(XMLElement& inertial, const Inertial&)> write;
};

const Kind* kind_of(std::string_view root) {
  static const std::map<std::string_view, Kind> kinds{{"robot", {urdf_links, write_urdf}},
                                                      {"sdf", {sdf_links, write_sdf}},
                                                      {"mujoco", {mjcf_links, write_mjcf}}};
  const auto found = kinds.find(root);
  return found == kinds.end() ? nullptr : &found->second;
}

/// Reads the new text: these links have these inertials, and all others theirs.
void require_written(const Kind& kind, const std::string& text, const std::string& name,
                     std::map<std::string, Inertial> wanted) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  const auto fail = [&](const std::string& link) {
    throw Error(ErrorCode::OutputFailed,
                name + ": link '" + link + "' has not the inertial that was written");
  };
  const LinkElements got = kind.links(document, name);
  for (const auto& [link, inertial] : got.inertials) {
    const auto found = wanted.find(link);
    if (found == wanted.end() || !is_same(found->second, inertial)) fail(link);
    wanted.erase(found);
  }
  if (!wanted.empty()) fail(wanted.begin()->first);
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
  const Kind* kind = kind_of(root.Name());
  if (kind == nullptr) file.fail(root, "neither URDF nor MJCF nor SDF: no masses can be written");
  if (std::string_view(root.Name()) == "mujoco") require_own_masses(file, root);
  const LinkElements links = kind->links(document, name);
  std::map<std::string, Inertial> wanted = links.inertials;
  InertialEdit out;
  for (const auto& [link, inertial] : inertials) {
    const auto found = links.elements.find(link);
    if (found == links.elements.end()) {
      out.missing.push_back(link);
      continue;
    }
    auto& e = *const_cast<XMLElement*>(found->second);  // of our document
    XMLElement* fresh = document.NewElement("inertial");
    wanted[link] = in_link_axes(inertial);
    kind->write(*fresh, wanted[link]);
    tinyxml2::XMLNode* old = e.FirstChildElement("inertial");
    tinyxml2::XMLNode* before = old != nullptr ? old->PreviousSibling() : nullptr;
    delete_inertials(e);
    if (before != nullptr)
      e.InsertAfterChild(before, fresh);
    else
      e.InsertFirstChild(fresh);
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  out.text = printer.CStr();
  require_written(*kind, out.text, name, std::move(wanted));
  return out;
}

}  // namespace kaboum::robot
