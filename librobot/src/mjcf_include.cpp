// What MJCF includes, put in its place. Names of files in it are found as MuJoCo finds them.

#include <kaboum/base/error.h>
#include <kaboum/robot/mjcf.h>

#include <array>
#include <filesystem>
#include <set>

#include "xml.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;
using ReadFile = std::function<std::string(const std::string& file)>;
using FileExists = std::function<bool(const std::string& file)>;

/// Elements that name a file of an asset, and the attribute of the compiler that has its folder.
constexpr std::array<std::pair<std::string_view, const char*>, 4> kAssets{
    {{"mesh", "meshdir"}, {"skin", "meshdir"}, {"hfield", "meshdir"}, {"texture", "texturedir"}}};
/// On such an element, while includes are put in their places: the file that has it.
constexpr const char* kFrom = "included-from";

bool includes_more(const XMLElement& element) {
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    if (std::string_view(e->Name()) == "include" || includes_more(*e)) return true;
  return false;
}

/// The text of a file that another one includes. MuJoCo looks beside the model, then beside the
/// file that includes it.
/// @param file  its name there, and relative to the model on return
/// @param from  the file that includes it, relative to the model; empty: the model
std::string included_text(std::string& file, const std::string& from, const ReadFile& read) {
  const fs::path folder = fs::path(from).parent_path();
  if (folder.empty()) return read(file);
  try {
    return read(file);
  } catch (const Error&) {
    std::string beside = (folder / file).string(), text;
    try {
      text = read(beside);
    } catch (const Error&) {
      text.clear();
    }
    if (text.empty()) throw;
    file = std::move(beside);
    return text;
  }
}

/// Calls `change` with every element that names the file of an asset, and its folder's attribute.
template <typename Change>
void for_each_asset(XMLElement& element, const Change& change) {
  for (XMLElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    for (const auto& [tag, folder] : kAssets)
      if (tag == e->Name() && e->Attribute("file") != nullptr) change(*e, folder);
    for_each_asset(*e, change);
  }
}

/// Replaces the includes below an element.
/// @param from  the file that has it, relative to the model; empty: the model
void expand(XMLElement& element, const std::string& name, const std::string& from,
            const ReadFile& read, std::set<std::string>& included) {
  for (XMLElement* e = element.FirstChildElement(); e != nullptr;) {
    XMLElement* next = e->NextSiblingElement();
    if (std::string_view(e->Name()) != "include") {
      expand(*e, name, from, read, included);
      e = next;
      continue;
    }
    const char* given = e->Attribute("file");
    if (given == nullptr) fail_at(name, e->GetLineNum(), "<include> without a file");
    std::string file = given;
    const auto require_new = [&] {
      if (included.contains(file))
        fail_at(name, e->GetLineNum(), "'" + file + "' is included already");
    };
    require_new();
    const std::string text = included_text(file, from, read);
    require_new();
    included.insert(file);
    tinyxml2::XMLDocument other;
    parse_xml(other, text, file);
    expand(*other.RootElement(), file, file, read, included);
    for_each_asset(*other.RootElement(), [&](XMLElement& asset, const char* /*folder*/) {
      if (asset.Attribute(kFrom) == nullptr) asset.SetAttribute(kFrom, file.c_str());
    });
    tinyxml2::XMLNode* after = e;
    for (const auto* child = other.RootElement()->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement())
      after = element.InsertAfterChild(after, child->DeepClone(element.GetDocument()));
    element.DeleteChild(e);
    e = next;
  }
}

/// A folder that the compiler names, the last one; assetdir is both.
std::string compiler_folder(const XMLElement& root, std::string_view key) {
  std::string out;
  for (const auto* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler"))
    for (const char* named : {"assetdir", key.data()})
      if (const char* folder = e->Attribute(named); folder != nullptr) out = folder;
  return out;
}

/// Files of assets that included files name: MuJoCo looks in the compiler's folder, then beside the
/// file that names them. The latter are named from the compiler's folder.
void settle_assets(XMLElement& root, const FileExists& exists) {
  for_each_asset(root, [&](XMLElement& asset, const char* key) {
    const char* from = asset.Attribute(kFrom);
    if (from == nullptr) return;
    const fs::path file = asset.Attribute("file"), beside = fs::path(from).parent_path() / file;
    asset.DeleteAttribute(kFrom);
    const fs::path folder = compiler_folder(root, key);
    if (!exists || file.is_absolute() || exists((folder / file).string()) ||
        !exists(beside.string()))
      return;
    const fs::path moved = folder.is_absolute()
                               ? fs::absolute(beside)
                               : beside.lexically_normal().lexically_relative(
                                     folder.empty() ? fs::path(".") : folder.lexically_normal());
    if (!moved.empty()) asset.SetAttribute("file", moved.string().c_str());
  });
}

}  // namespace

std::string expand_mjcf(std::string_view text, const std::string& name, const ReadFile& read,
                        const FileExists& exists) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  XMLElement& root = *document.RootElement();
  if (std::string_view(root.Name()) != "mujoco")
    fail_at(name, root.GetLineNum(), std::string("expected <mujoco>, found <") + root.Name() + ">");
  if (!includes_more(root)) return std::string(text);
  std::set<std::string> included;
  expand(root, name, {}, read, included);
  settle_assets(root, exists);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace kaboum::robot
