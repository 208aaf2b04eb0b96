#pragma once

#include <kaboum/plan/externals.h>

#include <memory>
#include <string>

namespace kaboum::manipulation {

/// Answers of external functions kept between runs: each with all that the function read, in order.
/// It is given again where the state agrees on every one of these reads; so a call's footprint is
/// the same with and without.
class AnswerCache {
 public:
  /// @param content  what `content` gave an earlier run of the same functions; damaged or empty:
  /// none.
  explicit AnswerCache(const std::string& content);
  ~AnswerCache();
  AnswerCache(const AnswerCache&) = delete;
  AnswerCache& operator=(const AnswerCache&) = delete;

  /// Functions that are asked only for what is not kept. This outlives them.
  [[nodiscard]] plan::ExternalBindings wrap(const plan::ExternalBindings& bindings);
  /// All answers, to be kept; empty: none came to them.
  [[nodiscard]] std::string content() const;

  [[nodiscard]] std::size_t reused() const;

 private:
  struct Entries;
  std::unique_ptr<Entries> kept_;
};

}  // namespace kaboum::manipulation
