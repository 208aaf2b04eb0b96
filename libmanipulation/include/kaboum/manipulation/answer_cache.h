#pragma once

#include <kaboum/plan/externals.h>

#include <filesystem>
#include <memory>
#include <string>

namespace kaboum::manipulation {

/// Answers of external functions kept in a file, between runs: each with all that the function
/// read, in order. It is given again where the state agrees on every one of these reads; so a
/// call's footprint is the same with and without.
class AnswerCache {
 public:
  /// Reads the file, if there is one; damaged ones are as none.
  /// @param key  of all that answers depend on beside questions: what has another key is not used.
  AnswerCache(std::filesystem::path file, std::string key);
  ~AnswerCache();
  AnswerCache(const AnswerCache&) = delete;
  AnswerCache& operator=(const AnswerCache&) = delete;

  /// Functions that are asked only for what is not kept. They outlive neither cache nor bindings.
  [[nodiscard]] plan::ExternalBindings wrap(const plan::ExternalBindings& bindings);
  /// Writes the file, when answers came to it. @throws Error{OutputFailed}
  void save() const;

  [[nodiscard]] std::size_t reused() const;

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace kaboum::manipulation
