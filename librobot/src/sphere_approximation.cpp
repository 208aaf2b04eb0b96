// Spheres of links in SRDF files.
#include <kaboum/robot/sphere_approximation.h>

#include <algorithm>

#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

SphereApproximation read_link(const XmlFile& file, const XMLElement& element) {
  SphereApproximation out{file.text(element, "link"), element.GetLineNum(), {}};
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()) != "sphere")
      file.fail(*child, "a <sphere> is expected here");
    LinkSphere sphere{file.vector(*child, "center"), file.number(*child, "radius"),
                      child->GetLineNum()};
    if (sphere.radius < 0) file.fail(*child, "radius is negative");
    out.spheres.push_back(sphere);
  }
  if (out.spheres.empty()) file.fail(element, "it has no <sphere>");
  return out;
}

}  // namespace

std::vector<SphereApproximation> parse_sphere_approximations(std::string_view text,
                                                             const std::string& name) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  const XmlFile file(name);
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot")
    fail_at(name, root == nullptr ? 1 : root->GetLineNum(), "an SRDF begins with <robot>");
  std::vector<SphereApproximation> out;
  constexpr const char* kTag = "link_sphere_approximation";
  for (const XMLElement* element = root->FirstChildElement(kTag); element != nullptr;
       element = element->NextSiblingElement(kTag)) {
    SphereApproximation link = read_link(file, *element);
    if (std::ranges::any_of(out, [&](const auto& known) { return known.link == link.link; }))
      file.fail(*element, "link '" + link.link + "' has one already");
    out.push_back(std::move(link));
  }
  return out;
}

}  // namespace kaboum::robot
