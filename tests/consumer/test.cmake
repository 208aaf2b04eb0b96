# Included by tests/CMakeLists.txt; CMakeLists.txt beside it is the consumer's own.
set(_consumer_flags "")
if(KABOUM_SANITIZE)
  set(_consumer_flags -fsanitize=${KABOUM_SANITIZE})
endif()
if(KABOUM_COVERAGE)
  set(_consumer_flags --coverage)
endif()
add_test(NAME installed_package
  COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${CMAKE_CURRENT_LIST_DIR}
          -DWORK=${CMAKE_CURRENT_BINARY_DIR}/consumer -DCONFIG=$<CONFIG>
          -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER} -DFLAGS=${_consumer_flags}
          -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set_tests_properties(installed_package PROPERTIES TIMEOUT 600)
