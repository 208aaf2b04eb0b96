// External functions for shelf.kpl as a shared library (docs/planning/externals.md):
//   g++ -std=c++20 -shared -fPIC -I<include> shelf.cpp -o shelf.so
//   kaboum-plan solve shelf.kpl --plugin ./shelf.so -o plan.json
#include <kaboum/plan/externals.h>

extern "C" void kaboum_externals_1(kaboum::plan::ExternalBindings& bindings) {
  using kaboum::plan::Answer;
  using kaboum::plan::Question;
  bindings["reach"] = [](const Question& q) {
    const auto here = q.state.value("pose", {q.arguments[0]});
    if (!here) return Answer::not_found("its place is not known");
    if (q.arguments[0] == "o2" && q.state.value("pose", {"o1"}) == "p1")
      return Answer::impossible("blocked by o1");
    return Answer::found("over " + *here, R"({"waypoints":[[0,0],[1,1]]})");
  };
  bindings["isBox"] = [](const Question& q) { return Answer::holds(q.arguments[0] == "box"); };
}
