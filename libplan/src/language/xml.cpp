// The older XML form: its elements hold pieces in the notation of .kpl.
#include "language/xml.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cstring>

#include "language/kpl_parser.h"
#include "language/kpl_printer.h"

namespace kaboum::plan {
namespace {

using tinyxml2::XMLElement;

class XmlReader {
 public:
  explicit XmlReader(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

  syntax::Document read() {
    document_.sources.push_back(source_);
    for (std::size_t i = 0; i < source_->text.size(); ++i)
      if (source_->text[i] == '\n') lines_.push_back(i + 1);
    if (std::count(source_->text.begin(), source_->text.end(), '<') > 1'000'000)
      fail(0, "too many elements");
    tinyxml2::XMLDocument xml;
    if (xml.Parse(source_->text.data(), source_->text.size()) != tinyxml2::XML_SUCCESS)
      fail(xml.ErrorLineNum(), std::string("not well-formed XML (") +
                                   tinyxml2::XMLDocument::ErrorIDToName(xml.ErrorID()) + ")");
    const XMLElement* root = xml.RootElement();
    if (root == nullptr || std::strcmp(root->Name(), "pks") != 0) fail(1, "expected <pks>");
    each(*root, [&](const XMLElement& e) {
      if (is(e, "domain")) {
        domain(e);
      } else if (is(e, "problem")) {
        problem(e);
      } else {
        unknown(e);
      }
    });
    return std::move(document_);
  }

 private:
  /// Where a line begins, counted from 1.
  [[nodiscard]] std::size_t line_start(int line) const {
    const auto i = static_cast<std::size_t>(std::max(line - 1, 0));
    return lines_.at(std::min(i, lines_.size() - 1));
  }

  /// A message about a line of the file.
  [[noreturn]] void fail(int line, const std::string& message) const {
    const std::size_t offset = line_start(line);
    const std::size_t text = source_->text.find_first_not_of(" \t", offset);
    source_->fail(text == std::string::npos ? offset : text, message);
  }
  [[noreturn]] void unknown(const XMLElement& e) const {
    fail(e.GetLineNum(), std::string("unsupported element <") + e.Name() + ">");
  }
  static bool is(const XMLElement& e, const char* name) { return std::strcmp(e.Name(), name) == 0; }

  template <class Visit>
  static void each(const XMLElement& parent, const Visit& visit) {
    for (const XMLElement* e = parent.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement())
      visit(*e);
  }

  /// The element's text as a source of its own whose lines are numbered as in the file.
  const Source& text(const XMLElement& e) {
    std::string content;
    int line = e.GetLineNum();
    for (const tinyxml2::XMLNode* n = e.FirstChild(); n != nullptr; n = n->NextSibling()) {
      if (n->ToText() != nullptr) {
        if (content.empty()) line = n->GetLineNum();
        content += n->Value();
      } else if (n->ToComment() == nullptr) {
        fail(n->GetLineNum(), std::string("unexpected element in <") + e.Name() + ">");
      }
    }
    // The first line's column: where its text stands in the file, if it stands there as it is.
    const std::size_t start = line_start(line);
    const std::string_view raw(
        source_->text.data() + start,
        std::min(source_->text.find('\n', start), source_->text.size()) - start);
    const std::size_t at = raw.find(">" + content.substr(0, content.find('\n')));
    if (at != std::string_view::npos) content.insert(0, at + 1, ' ');
    document_.sources.push_back(std::make_shared<Source>(
        Source{source_->name, std::move(content), static_cast<std::size_t>(std::max(line, 1))}));
    return *document_.sources.back();
  }

  syntax::Name attribute(const XMLElement& e, const char* key) const {
    const char* value = e.Attribute(key);
    if (value == nullptr)
      fail(e.GetLineNum(), std::string("<") + e.Name() + "> needs the attribute '" + key + "'");
    return {value, {source_.get(), line_start(e.GetLineNum())}};
  }

  template <class T>
  static void append(std::vector<T>& to, std::vector<T> from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  }

  void symbols(const XMLElement& parent) {
    each(parent, [&](const XMLElement& e) {
      if (is(e, "predicates")) {
        append(document_.predicates, kpl_piece::signatures(text(e)));
      } else if (is(e, "functions")) {
        append(document_.functions, kpl_piece::signatures(text(e)));
      } else if (is(e, "constants")) {
        append(document_.constants, kpl_piece::constants(text(e)));
      } else {
        unknown(e);
      }
    });
  }

  void domain(const XMLElement& parent) {
    if (parent.Attribute("name") != nullptr) document_.name = attribute(parent, "name");
    each(parent, [&](const XMLElement& e) {
      if (is(e, "symbols")) {
        symbols(e);
      } else if (is(e, "action")) {
        action(e);
      } else {
        unknown(e);
      }
    });
  }

  void action(const XMLElement& parent) {
    syntax::Action a;
    a.name = attribute(parent, "name");
    each(parent, [&](const XMLElement& e) {
      if (is(e, "params")) {
        a.parameters = kpl_piece::parameters(text(e));
      } else if (is(e, "preconds")) {
        const Source& s = text(e);
        if (s.text.find_first_not_of(" \t\r\n") != std::string::npos)
          a.precondition = kpl_piece::formula(s);
      } else if (is(e, "effects")) {
        a.effects = kpl_piece::effects(text(e));
      } else {
        unknown(e);
      }
    });
    document_.actions.push_back(std::move(a));
  }

  void problem(const XMLElement& parent) {
    if (parent.Attribute("name") != nullptr && document_.name.text.empty())
      document_.name = attribute(parent, "name");
    each(parent, [&](const XMLElement& e) {
      if (is(e, "symbols")) {
        symbols(e);
      } else if (is(e, "init")) {
        append(document_.initial, kpl_piece::initial(text(e)));
      } else if (is(e, "updates")) {
        // Rules that the older planner applied after each action; ours infers by itself.
        const Source& s = text(e);
        if (s.text.find_first_not_of(" \t\r\n") != std::string::npos)
          fail(e.GetLineNum(),
               "<updates> are not supported: write the rule as conditional effects of the actions "
               "that it follows");
      } else if (is(e, "goal")) {
        document_.goals.push_back(kpl_piece::formula(text(e)));
      } else {
        unknown(e);
      }
    });
  }

  std::shared_ptr<const Source> source_;
  std::vector<std::size_t> lines_ = {0};
  syntax::Document document_;
};

}  // namespace

syntax::Document parse_xml(std::shared_ptr<const Source> source) {
  return XmlReader(std::move(source)).read();
}

std::string print_xml(const syntax::Document& d) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::InvalidInput, "the XML form cannot say: " + what);
  };
  for (const syntax::Type& t : d.types)
    if (t.name.text != "object") refuse("types ('" + t.name.text + "')");
  if (!d.rules.empty()) refuse("derived predicates ('" + d.rules[0].head.text + "')");
  if (!d.externals.empty()) refuse("external functions ('" + d.externals[0].name.text + "')");
  if (!d.closed.empty() || d.closed_world) refuse("'closed:'");
  for (const syntax::Signature& f : d.functions)
    if (f.range.text == "number") refuse("functions of numbers ('" + f.name.text + "')");
  // The kpl printer's pieces are the XML form's texts.
  tinyxml2::XMLPrinter out;
  const auto element = [&](const char* name, const std::string& text) {
    out.OpenElement(name);
    out.PushText(text.c_str());
    out.CloseElement();
  };
  const auto names = [](const auto& list, const auto& text) {
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : ", ") + text(item);
    return all;
  };
  const auto signature = [](const syntax::Signature& s) {
    return s.name.text + "/" + std::to_string(s.parameters.size());
  };
  out.OpenElement("pks");
  out.OpenElement("domain");
  if (!d.name.text.empty()) out.PushAttribute("name", d.name.text.c_str());
  out.OpenElement("symbols");
  element("predicates", names(d.predicates, signature));
  element("functions", names(d.functions, signature));
  element("constants",
          names(d.constants, [](const syntax::TypedVariable& c) { return c.name.text; }));
  out.CloseElement();
  for (const syntax::Action& a : d.actions) {
    if (!a.cost.empty()) refuse("costs (action '" + a.name.text + "')");
    out.OpenElement("action");
    out.PushAttribute("name", a.name.text.c_str());
    element("params",
            names(a.parameters, [](const syntax::TypedVariable& v) { return "?" + v.name.text; }));
    element("preconds", print_formula(a.precondition));
    element("effects", print_effects(a.effects));
    out.CloseElement();
  }
  out.CloseElement();
  out.OpenElement("problem");
  element("init", print_effects(d.initial));
  for (const syntax::Formula& g : d.goals) element("goal", print_formula(g));
  out.CloseElement();
  out.CloseElement();
  return std::string(out.CStr());
}

}  // namespace kaboum::plan
