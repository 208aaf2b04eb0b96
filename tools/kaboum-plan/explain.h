#pragma once

#include <kaboum/plan/externals.h>

#include <map>
#include <memory>
#include <string>

#include "common/cli.h"

namespace kaboum::tools {

/// Why external functions returned no value: how often each, and what was in the way.
class Explanation {
 public:
  /// Functions whose failures are noted. They outlive this.
  [[nodiscard]] plan::ExternalBindings watch(const plan::ExternalBindings& bindings);

  /// The most frequent failures first.
  [[nodiscard]] Json json() const;
  /// The same for people; empty: nothing has failed.
  [[nodiscard]] std::string text() const;

 private:
  struct Failure {
    std::string call, reason;
    bool final = false;  ///< impossible, rather than not found
    std::size_t times = 0;
  };
  [[nodiscard]] std::vector<Failure> failures() const;

  using Notes = std::map<std::pair<std::string, std::string>, std::pair<bool, std::size_t>>;
  std::shared_ptr<Notes> notes_ = std::make_shared<Notes>();
};

}  // namespace kaboum::tools
