#pragma once

/// Abilities of the processor that the program runs on. Code for it is in functions of their own
/// (`[[gnu::target("avx2")]]`), never by options for whole sources: inline functions of headers
/// have to run everywhere.
#if defined(__x86_64__) && defined(__GNUC__)
#define KABOUM_AVX2
#endif

namespace kaboum {

/// True if what is compiled where KABOUM_AVX2 is defined may be called.
inline bool has_avx2() {
#ifdef KABOUM_AVX2
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace kaboum
