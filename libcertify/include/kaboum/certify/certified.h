#pragma once

#include <kaboum/base/error.h>

#include <memory>
#include <utility>
#include <vector>

namespace kaboum::certify {

class Issuer;

/// An artefact with what is certified of it and the bytes that were certified. This library alone
/// makes such values, and nobody changes one; copies share it. One made by default holds nothing
/// and claims nothing.
template <class Artefact, class Certificate>
class Certified {
 public:
  Certified() = default;

  [[nodiscard]] explicit operator bool() const { return value_ != nullptr; }

  /// As read back from the bytes, where there are some.
  /// @throws Error{Internal}, as all below, of a value made by default or moved from.
  [[nodiscard]] const Artefact& artefact() const& { return value().artefact; }
  [[nodiscard]] const Certificate& certificate() const& { return value().certificate; }
  /// Bytes to be written; empty where nothing is.
  [[nodiscard]] const std::vector<char>& bytes() const& { return value().bytes; }
  // Parts of a temporary would be gone before they are used. Through `->` of a temporary optional
  // they still would: keep what certify_set and its like return.
  const Artefact& artefact() const&& = delete;
  const Certificate& certificate() const&& = delete;
  const std::vector<char>& bytes() const&& = delete;

 private:
  friend class Issuer;
  struct Value {
    Artefact artefact;
    Certificate certificate;
    std::vector<char> bytes;
  };

  explicit Certified(Value value) : value_(std::make_shared<const Value>(std::move(value))) {}

  [[nodiscard]] const Value& value() const {
    ensure(value_ != nullptr, "nothing is certified of a value that holds nothing");
    return *value_;
  }

  std::shared_ptr<const Value> value_;
};

}  // namespace kaboum::certify
