# One INTERFACE target carries the language level, the warnings and the instrumentation.
add_library(kaboum_options INTERFACE)
target_compile_features(kaboum_options INTERFACE cxx_std_20)
# No contraction into fused multiply-adds: error bounds and determinism depend on the rounding of
# every single operation.
target_compile_options(kaboum_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual
  -ffp-contract=off)
# GCC 12 and 13 drop double -> float -> double when they vectorise it in straight-line code
# (tests/geom/float32_test.cpp shows it); loops are not affected.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(kaboum_options INTERFACE -fno-tree-slp-vectorize)
  # The compiler collects its garbage later: a tenth of its time, for a quarter more memory (libplan: 16.8 -> 15.1 s,
  # 533 -> 673 MB).
  target_compile_options(kaboum_options INTERFACE "SHELL:--param ggc-min-expand=300" "SHELL:--param ggc-min-heapsize=2000000")
endif()

if(KABOUM_SANITIZE)
  target_compile_options(kaboum_options INTERFACE
    -fsanitize=${KABOUM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(kaboum_options INTERFACE -fsanitize=${KABOUM_SANITIZE})
  # These four checks make a source of templates take more than twice as long to compile (53 s against 22 s). What
  # the others do not see of it: reads at addresses that are not aligned, which x86 allows.
  if(KABOUM_SANITIZE MATCHES "undefined")
    target_compile_options(kaboum_options INTERFACE -fno-sanitize=null,alignment,object-size,vptr)
  endif()
  # ThreadSanitizer does not see what orders tasks inside TBB's binary, and would report races that are
  # none: the project's own loops (libbase, libverify) run by std::thread instead.
  if(KABOUM_SANITIZE MATCHES "thread")
    target_compile_definitions(kaboum_options INTERFACE KABOUM_STD_THREADS)
  endif()
endif()
if(KABOUM_COVERAGE)
  target_compile_options(kaboum_options INTERFACE --coverage)
  target_link_options(kaboum_options INTERFACE --coverage)
endif()
