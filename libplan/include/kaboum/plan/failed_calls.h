#pragma once

#include <kaboum/plan/externals.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::plan {

/// Calls of external functions that returned no value, with their reasons: why a search found no
/// plan, or took long.
class FailedCalls {
 public:
  struct Failure {
    std::string call, reason;
    bool impossible = false;  ///< each time; else not found, at least once
    std::size_t times = 0;
  };

  /// Functions whose failures are noted. They may outlive this.
  [[nodiscard]] ExternalBindings watch(const ExternalBindings& bindings);
  /// The most frequent ones first.
  [[nodiscard]] std::vector<Failure> failures() const;

 private:
  using Notes = std::map<std::pair<std::string, std::string>, std::pair<bool, std::size_t>>;
  std::shared_ptr<Notes> notes_ = std::make_shared<Notes>();
};

}  // namespace kaboum::plan
