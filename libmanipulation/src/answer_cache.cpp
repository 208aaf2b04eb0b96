// Answers of external functions between runs.
#include <kaboum/base/error.h>
#include <kaboum/manipulation/answer_cache.h>

#include <map>
#include <nlohmann/json.hpp>
#include <vector>

namespace kaboum::manipulation {
namespace answers {  // what a class with a name holds has one, too

/// One thing that was read, and what it was.
struct Reading {
  bool truth = false;
  std::string name;
  std::vector<std::string> arguments;
  std::optional<std::string> value;  ///< of an atom "true" or "false"

  [[nodiscard]] bool same_place(const Reading& other) const {
    return truth == other.truth && name == other.name && arguments == other.arguments;
  }
};

struct Entry {
  std::vector<Reading> reads;
  plan::Answer answer;
};

}  // namespace answers

namespace {

using answers::Entry;
using answers::Reading;
using nlohmann::json;
using plan::Answer;
using plan::Question;

/// Beyond that nothing more is kept. [bytes]
constexpr std::size_t kMost = std::size_t{1} << 26U;

/// Notes what a function reads for the first time.
class Notes final : public plan::StateView {
 public:
  explicit Notes(plan::StateView& view) : view_(view) {}

  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) override {
    auto known = view_.value(function, arguments);
    note({false, function, arguments, known});
    return known;
  }
  std::optional<bool> truth(const std::string& predicate,
                            const std::vector<std::string>& arguments) override {
    const auto known = view_.truth(predicate, arguments);
    note({true, predicate, arguments,
          known ? std::optional<std::string>(*known ? "true" : "false") : std::nullopt});
    return known;
  }
  bool has_term(const std::string& function, const std::vector<std::string>& arguments) override {
    return view_.has_term(function, arguments);
  }
  std::vector<Reading> reads;

 private:
  void note(Reading read) {
    for (const Reading& r : reads)
      if (r.same_place(read)) return;
    reads.push_back(std::move(read));
  }
  plan::StateView& view_;
};

std::optional<std::string> read_again(const Reading& read, plan::StateView& view) {
  if (!read.truth) return view.value(read.name, read.arguments);
  const auto known = view.truth(read.name, read.arguments);
  return known ? std::optional<std::string>(*known ? "true" : "false") : std::nullopt;
}

std::string place_of_question(const std::string& function, const Question& question) {
  std::string out = function + '\n' + std::to_string(question.seed) + '\n' +
                    std::to_string(question.attempt) + '\n' + std::to_string(question.choice);
  for (const std::string& argument : question.arguments) out += '\n' + argument;
  return out;
}

json to_json(const std::string& place, const Entry& entry) {
  json reads = json::array();
  for (const Reading& r : entry.reads)
    reads.push_back({r.truth, r.name, r.arguments, r.value ? json(*r.value) : json()});
  return {{"q", place},
          {"reads", reads},
          {"kind", static_cast<int>(entry.answer.kind)},
          {"value", entry.answer.value},
          {"payload", entry.answer.payload},
          {"reason", entry.answer.reason},
          {"chosen", entry.answer.chosen},
          {"choices", entry.answer.choices},
          {"fixed", entry.answer.fixed},
          {"listed", entry.answer.listed}};
}

Entry entry_of(const json& j) {
  Entry out;
  for (const json& r : j.at("reads"))
    out.reads.push_back(
        {r.at(0).get<bool>(), r.at(1).get<std::string>(), r.at(2).get<std::vector<std::string>>(),
         r.at(3).is_null() ? std::nullopt : std::optional(r.at(3).get<std::string>())});
  // `get` would convert any number.
  const auto kind = j.at("kind").get_ref<const json::number_unsigned_t&>();
  if (kind > 2) throw Error(ErrorCode::InvalidInput, "no kind of answer");
  out.answer = {static_cast<Answer::Kind>(kind), j.at("value").get<std::string>(),
                j.at("payload").get<std::string>(), j.at("reason").get<std::string>()};
  out.answer.chosen = j.at("chosen").get<bool>();
  out.answer.choices = j.at("choices").get<unsigned>();
  out.answer.fixed = j.at("fixed").get<bool>();
  out.answer.listed = j.at("listed").get<bool>();
  return out;
}

}  // namespace

struct AnswerCache::Entries {
  std::map<std::string, std::vector<answers::Entry>> entries;
  std::size_t bytes = 0, reused = 0, fresh = 0;

  void load(const std::string& content) {
    if (content.empty()) return;
    try {
      const json all = json::parse(content);
      for (const json& e : all.at("answers")) {
        entries[e.at("q").get<std::string>()].push_back(entry_of(e));
        bytes += e.at("payload").get_ref<const std::string&>().size() + 200;
      }
    } catch (const std::exception&) {
      entries.clear();  // damaged: as none
    }
  }

  Answer ask(const std::string& name, const plan::ExternalBinding& function,
             const Question& question) {
    std::vector<answers::Entry>& all = entries[place_of_question(name, question)];
    std::vector<const Entry*> fitting;
    fitting.reserve(all.size());
    for (const Entry& e : all) fitting.push_back(&e);
    // A function that reads the same reads the same thing next, so all that fit agree on it.
    for (std::size_t k = 0; !fitting.empty(); ++k) {
      if (fitting.front()->reads.size() == k) {
        ++reused;
        return fitting.front()->answer;
      }
      const Reading& next = fitting.front()->reads[k];
      const auto now = read_again(next, question.state);
      std::erase_if(fitting, [&](const Entry* e) {
        return e->reads.size() <= k || !e->reads[k].same_place(next) || e->reads[k].value != now;
      });
    }
    Notes notes(question.state);
    Entry made;
    made.answer = function({question.arguments, notes, question.seed, question.attempt,
                            question.choice, question.early});
    made.reads = std::move(notes.reads);
    Answer answer = made.answer;
    const std::size_t size = answer.payload.size() + 200 + 100 * made.reads.size();
    if (bytes + size > kMost) return answer;
    bytes += size;
    ++fresh;
    all.push_back(std::move(made));
    return answer;
  }
};

AnswerCache::AnswerCache(const std::string& content) : kept_(std::make_unique<Entries>()) {
  kept_->load(content);
}

AnswerCache::~AnswerCache() = default;

plan::ExternalBindings AnswerCache::wrap(const plan::ExternalBindings& bindings) {
  plan::ExternalBindings out;
  for (const auto& [name, function] : bindings) {
    plan::ExternalBinding& binding = out[name];
    binding = [kept = kept_.get(), name = name, function = function](const Question& question) {
      return kept->ask(name, function, question);
    };
    if (function.refuses_early()) binding.refuse_early();
  }
  return out;
}

std::string AnswerCache::content() const {
  if (kept_->fresh == 0) return "";
  json answers = json::array();
  for (const auto& [place, entries] : kept_->entries)
    for (const Entry& e : entries) answers.push_back(to_json(place, e));
  return json{{"answers", answers}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::size_t AnswerCache::reused() const { return kept_->reused; }

}  // namespace kaboum::manipulation
