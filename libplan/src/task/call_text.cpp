// Calls of external functions, and what they read, as messages name them.
#include "task/call_text.h"

#include "task/atom_knowledge.h"

namespace kaboum::plan {

std::string call_text(const Model& model, const HandleTable& handles, Index external,
                      const std::vector<Index>& objects) {
  std::string text;
  for (const Index o : objects) text += (text.empty() ? "" : ", ") + model.name_of(o, handles);
  const std::string& name = model.externals[external].name;
  return objects.empty() ? name : name + "(" + text + ")";
}

std::string state_text(const Model& model, const HandleTable& handles, const Layout& layout,
                       const Footprint& read) {
  std::string text;
  for (const auto& [item, content] : read) {
    if (is_call(item)) continue;
    const Fluent& f = layout.fluents()[item];
    const Symbol& s = (f.function ? model.functions : model.predicates)[f.symbol];
    std::string name;
    for (const Index o : f.arguments)
      name.append(name.empty() ? "" : ", ").append(model.objects[o].name);
    if (!f.arguments.empty()) name.insert(0, "(").append(")");
    name.insert(0, s.name);
    text += text.empty() ? ", in a state where " : ", ";
    const auto k = static_cast<AtomKnowledge>(content);
    if (f.function ? content < kFirstValue
                   : k != AtomKnowledge::True && k != AtomKnowledge::False) {
      text.append(name).append(" is not known");
    } else if (f.function) {
      text.append(name).append(" = ").append(
          model.name_of(layout.object(item, content - kFirstValue), handles));
    } else {
      text.append(k == AtomKnowledge::True ? "" : "!").append(name);
    }
  }
  return text;
}

}  // namespace kaboum::plan
