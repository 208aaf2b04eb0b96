#pragma once

#include <kaboum/base/error.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

/// What the fuzz targets share: each takes any bytes, and what it asks for holds or the process
/// ends.
namespace kaboum::fuzz {

[[noreturn]] inline void broken(const char* what, const std::string& detail) {
  std::fprintf(stderr, "%s: %s\n", what, detail.c_str());
  std::abort();
}

/// Errors about the input are what is wished for; others are not.
template <class Function>
void survive(const Function& function) {
  try {
    function();
  } catch (const Error& e) {
    if (e.code() == ErrorCode::Internal) broken("internal error", e.what());
  }
}

/// The first byte, which selects what is read, and the rest.
inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data) + 1, size - 1};
}

/// A whole target: calls look(kind, text), of which the first byte says the kind, 0 to kinds - 1.
template <class Look>
int select(const std::uint8_t* data, std::size_t size, int kinds, const Look& look) {
  if (size > 0) survive([&] { look(data[0] % kinds, text_of(data, size)); });
  return 0;
}

}  // namespace kaboum::fuzz
