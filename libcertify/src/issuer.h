#pragma once

#include <kaboum/certify/certified.h>

#include <utility>
#include <vector>

// The only place that makes certified values. Internal to kaboum_certify.
namespace kaboum::certify {

class Issuer {
 public:
  /// @pre `certificate` is what was decided of `artefact`, as read back from `bytes`.
  template <class Artefact, class Certificate>
  static Certified<Artefact, Certificate> issue(Artefact artefact, Certificate certificate,
                                                std::vector<char> bytes) {
    using Made = Certified<Artefact, Certificate>;
    return Made(
        typename Made::Value{std::move(artefact), std::move(certificate), std::move(bytes)});
  }
};

}  // namespace kaboum::certify
