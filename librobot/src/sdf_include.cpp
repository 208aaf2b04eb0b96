// Included models of SDF, written out as nested ones, as libsdformat does:
// <http://sdformat.org/spec?ver=1.12&elem=model#model_include>. tests/engines compares.

#include <kaboum/base/error.h>
#include <kaboum/robot/sdf.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <vector>

#include "xml.h"

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

constexpr int kNoOldFrames = 7;  ///< from 1.7 on, frames are named by `relative_to`

/// The second number of a version: 9 of "1.9"; −1 where it is none.
int minor_of(const XMLElement& root) {
  const char* version = root.Attribute("version");
  const std::string_view text = version == nullptr ? "" : version;
  if (!text.starts_with("1.")) return -1;
  const auto minor = finite_number(text.substr(2));
  if (!minor || *minor < 0 || *minor > 1000 || *minor != std::floor(*minor)) return -1;
  return static_cast<int>(*minor);
}

bool includes(const XMLElement& element) {
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    if (std::string_view(e->Name()) == "include" || includes(*e)) return true;
  return false;
}

/// States frames as from 1.7 on.
void use_new_frames(XMLElement& top, int minor) {
  for_all(top, [&](XMLElement& e) {
    const std::string_view tag = e.Name();
    if (const char* frame = e.Attribute("frame"); tag == "pose" && frame != nullptr) {
      if (*frame != '\0' && e.Attribute("relative_to") == nullptr)
        e.SetAttribute("relative_to", frame);
      e.DeleteAttribute("frame");
    }
    if (tag != "axis" && tag != "axis2") return;
    bool of_model = minor <= 4;
    if (XMLElement* old = e.FirstChildElement("use_parent_model_frame"); old != nullptr) {
      const std::string value = trimmed(old->GetText());
      of_model = of_model || value == "1" || value == "true";
      e.DeleteChild(old);
    }
    if (XMLElement* xyz = e.FirstChildElement("xyz"); of_model && xyz != nullptr)
      xyz->SetAttribute("expressed_in", "__model__");
  });
}

/// Writes out what one document includes, and what that includes.
class Includer {
 public:
  Includer(std::string folder, const ModelSource& source)
      : folder_(std::move(folder)), source_(source) {}

  /// @param chain  files that this one is included by, and itself
  void run(XMLElement& root, const std::string& name, std::vector<std::string>& chain) {
    require_known(root, name);
    expand(root, name, chain);
  }

  /// Brings all that was written out into one version.
  void settle(XMLElement& root, int minor) {
    int least = minor, most = minor;
    for (const auto& [model, its] : versions_) {
      least = std::min(least, its);
      most = std::max(most, its);
    }
    const bool alike = least >= kNoOldFrames || most <= 4 || (least >= 5 && most < kNoOldFrames);
    if (!alike) {
      most = std::max(most, kNoOldFrames);
      for (const auto& [model, its] : versions_)
        if (its < kNoOldFrames) use_new_frames_around(*model, its);
      if (minor < kNoOldFrames) use_new_frames_around(root, minor);
    }
    root.SetAttribute("version", ("1." + std::to_string(most)).c_str());
  }

 private:
  static void require_known(const XMLElement& root, const std::string& name) {
    if (std::string_view(root.Name()) != "sdf")
      fail_at(name, root.GetLineNum(), std::string("expected <sdf>, found <") + root.Name() + ">");
    if (minor_of(root) < 0) fail_at(name, root.GetLineNum(), "<sdf> without a known version");
  }

  /// All in an element but the models that were included, which have versions of their own.
  void use_new_frames_around(XMLElement& element, int minor) {
    for (XMLElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const auto is_this = [&](const auto& model) { return model.first == e; };
      if (std::ranges::any_of(versions_, is_this)) continue;
      const std::string_view tag = e->Name();
      if (tag == "world" || tag == "model") {
        use_new_frames_around(*e, minor);
      } else {
        use_new_frames(*e, minor);
      }
    }
  }

  void expand(XMLElement& parent, const std::string& name, std::vector<std::string>& chain) {
    for (XMLElement* e = parent.FirstChildElement(); e != nullptr;) {
      XMLElement* next = e->NextSiblingElement();
      const std::string_view tag = e->Name();
      if (tag == "include") {
        if (XMLElement* model = included(*e, name, chain); model != nullptr)
          parent.InsertAfterChild(e, model);
        parent.DeleteChild(e);
      } else if (tag == "world" || tag == "model") {
        expand(*e, name, chain);
      }
      e = next;
    }
  }

  /// The model that an <include> stands for, in its document; null: a light.
  XMLElement* included(XMLElement& e, const std::string& name, std::vector<std::string>& chain) {
    const auto fail = [&](const std::string& what) {
      fail_at(name, e.GetLineNum(), "<include>: " + what);
    };
    const XMLElement* uri = e.FirstChildElement("uri");
    const std::string stated = uri == nullptr ? std::string() : trimmed(uri->GetText());
    if (stated.empty()) fail("no <uri>");
    if (const char* merge = e.Attribute("merge");
        merge != nullptr && (std::string_view(merge) == "true" || std::string_view(merge) == "1"))
      fail("merge, which puts a model's parts into another one: have `gz sdf -p` write them out");
    for (const auto* child = e.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement())
      if (std::string_view(child->Name()).find(':') != std::string_view::npos)
        fail(std::string("<") + child->Name() +
             "> may change the model: have `gz sdf -p` write it");
    IncludedModel found;
    try {
      found = source_(stated, chain.back());
    } catch (const Error& error) {
      fail(error.what());
    }
    if (std::ranges::find(chain, found.file) != chain.end())
      fail("'" + found.file + "' includes itself, by way of others");
    if (chain.size() > kMostNested)
      fail("models are included more than " + std::to_string(kMostNested) + " deep");
    tinyxml2::XMLDocument other;
    parse_xml(other, found.text, found.file);
    XMLElement& root = *other.RootElement();
    require_known(root, found.file);
    chain.push_back(found.file);
    XMLElement* model = root.FirstChildElement("model");
    if (model == nullptr && root.FirstChildElement("include") == nullptr) {
      chain.pop_back();
      if (root.FirstChildElement("light") != nullptr) return nullptr;
      fail("'" + found.file + "' has no <model>");
    }
    expand(root, found.file, chain);
    chain.pop_back();
    model = root.FirstChildElement("model");
    if (model == nullptr || model->NextSiblingElement("model") != nullptr)
      fail("'" + found.file + "' has not one model");
    XMLElement* out = placed(e, *model, found.file, minor_of(root));
    forget(root);
    return out;
  }

  /// What is known of elements of a document, which goes now.
  void forget(XMLElement& root) {
    std::erase_if(versions_, [&](const auto& model) {
      return model.first->GetDocument() == root.GetDocument();
    });
    for_all(root, [&](XMLElement& e) { settled_.erase(&e); });
  }

  /// The copy of an included model, with what the <include> says of it.
  XMLElement* placed(XMLElement& e, XMLElement& model, const std::string& file, int minor) {
    tinyxml2::XMLDocument& document = *e.GetDocument();
    XMLElement* out = copy(model, document, file);
    // Where the document had it from another one, it is of that one's version.
    if (std::ranges::none_of(versions_, [&](const auto& known) { return known.first == out; }))
      versions_.emplace_back(out, minor);
    const XMLElement* own_pose = e.FirstChildElement("pose");
    if (const XMLElement* name = e.FirstChildElement("name"); name != nullptr)
      out->SetAttribute("name", trimmed(name->GetText()).c_str());
    if (own_pose != nullptr) {
      while (XMLElement* old = out->FirstChildElement("pose")) out->DeleteChild(old);
      out->InsertFirstChild(own_pose->DeepClone(&document));
    }
    if (const XMLElement* frame = e.FirstChildElement("placement_frame"); frame != nullptr)
      out->SetAttribute("placement_frame", trimmed(frame->GetText()).c_str());
    for (const char* tag : {"static", "plugin"})
      for (const auto* child = e.FirstChildElement(tag); child != nullptr;
           child = child->NextSiblingElement(tag)) {
        if (std::string_view(tag) == "static")
          while (XMLElement* old = out->FirstChildElement(tag)) out->DeleteChild(old);
        out->InsertEndChild(child->DeepClone(&document));
      }
    return out;
  }

  /// A copy in another document, with files named from the first one's folder, and what was
  /// included in it known again.
  XMLElement* copy(XMLElement& from, tinyxml2::XMLDocument& to, const std::string& file) {
    XMLElement* out = from.DeepClone(&to)->ToElement();
    std::vector<XMLElement*> before, after;
    for_all(from, [&](XMLElement& e) { before.push_back(&e); });
    for_all(*out, [&](XMLElement& e) { after.push_back(&e); });
    elements_ += after.size();
    if (elements_ > kMostExpanded)
      throw Error(ErrorCode::LimitReached, file + ": included models multiply to more than " +
                                               std::to_string(kMostExpanded) + " elements");
    for (auto& [model, minor] : versions_)
      if (const auto at = std::ranges::find(before, model); at != before.end())
        model = after[static_cast<std::size_t>(at - before.begin())];
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (std::string_view(after[i]->Name()) != "uri") continue;
      if (settled_.erase(before[i]) == 0) move(*after[i], file);
      settled_.insert(after[i]);
    }
    return out;
  }

  void move(XMLElement& uri, const std::string& file) {
    constexpr std::string_view kFile = "file://";
    std::string name = trimmed(uri.GetText());
    if (name.starts_with(kFile)) name = name.substr(kFile.size());  // relative ones, too
    if (name.empty() || name.find("://") != std::string::npos || name.starts_with('/')) return;
    const fs::path place = (fs::path(file).parent_path() / name).lexically_normal();
    uri.SetText(place.lexically_relative(folder_).generic_string().c_str());
  }

  std::string folder_;
  const ModelSource& source_;
  std::size_t elements_ = 0;
  std::vector<std::pair<XMLElement*, int>> versions_;  // models that were included, the second
  std::set<const XMLElement*> settled_;                // names of files, from folder_
};

}  // namespace

std::string include_sdf(std::string_view text, const std::string& name, const std::string& file,
                        const ModelSource& source) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  XMLElement& root = *document.RootElement();
  if (!includes(root)) return std::string(text);
  std::vector<std::string> chain{file};
  Includer includer(fs::path(file).parent_path().string(), source);
  includer.run(root, name, chain);
  includer.settle(root, minor_of(root));
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace kaboum::robot
