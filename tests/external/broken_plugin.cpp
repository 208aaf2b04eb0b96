// A plug-in whose functions are broken in all ways; and some that are not.
#include <kaboum/plan/externals.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

using kaboum::plan::Answer;
using kaboum::plan::Question;

namespace {

/// What `at` is, which comes into the footprint.
std::string read_at(const Question& q) { return q.state.value("at", {}).value_or("?"); }

}  // namespace

extern "C" void kaboum_externals_1(kaboum::plan::ExternalBindings& bindings) {
  if (std::getenv("KABOUM_BROKEN_ENTRY") != nullptr) throw 7;
  bindings["good"] = [](const Question& q) {
    return Answer::found("after " + read_at(q), "path\n\"of\" it");
  };
  bindings["ofNames"] = [](std::span<const std::string> a) { return "named " + a[0]; };
  bindings["choose"] = [](const Question& q) {
    if (!q.state.has_term("at", {}) || q.state.has_term("colour", {})) return Answer{};
    Answer a = Answer::found("way" + std::to_string(q.choice));
    a.chosen = true;
    a.choices = 3;
    return a;
  };
  bindings["fits"] = [](const Question& q) {
    return q.arguments[0] == "way2" ? Answer::found("end") : Answer::impossible("too wide");
  };
  bindings["none"] = [](const Question& q) {
    return read_at(q) == "start" ? Answer::impossible("blocked by o3") : Answer::not_found("?");
  };
  bindings["endless"] = [](const Question& q) -> Answer {
    read_at(q);
    std::fputs("endless\n", stderr);
    for (volatile bool on = true; on;) {
    }
    return {};
  };
  bindings["crash"] = [](const Question& q) -> Answer {
    read_at(q);
    std::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would exit
    std::raise(SIGSEGV);
    return {};
  };
  bindings["throws"] = [](const Question& q) -> Answer {
    throw std::runtime_error("no robot at " + read_at(q));
  };
  bindings["throwsNumber"] = [](const Question& q) -> Answer {
    read_at(q);
    throw 7;
  };
  bindings["fickle"] = [n = 0](const Question& q) mutable {
    return Answer::found(read_at(q) + std::to_string(n++));
  };
  bindings["wrongType"] = [](const Question& q) { return Answer::found(read_at(q).substr(5)); };
  bindings["badWord"] = [](const Question& q) { return Answer::found(read_at(q) + "\x80"); };
  bindings["badPayload"] = [](const Question& q) { return Answer::found(read_at(q), "\x81"); };
  bindings["stubborn"] = [](const Question& q) {
    for (;;) {
      try {
        read_at(q);
        return Answer::found(q.state.value("nowhere", {}).value_or("x"));
      } catch (const std::exception&) {  // the end of the call is none: nothing catches it here
      }
    }
  };
}
