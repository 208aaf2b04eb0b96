# The examples against the installed package, as a project of their own. Included by tests/CMakeLists.txt.
set(_consumer_flags "")
if(KABOUM_SANITIZE)
  set(_consumer_flags -fsanitize=${KABOUM_SANITIZE})
endif()
if(KABOUM_COVERAGE)
  set(_consumer_flags --coverage)
endif()
add_test(NAME installed_package
  COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${PROJECT_SOURCE_DIR}/examples/library
          -DCOMPONENTS=${CMAKE_CURRENT_LIST_DIR}/component -DDOCS=${CMAKE_INSTALL_DOCDIR}
          -DWORK=${CMAKE_CURRENT_BINARY_DIR}/consumer -DCONFIG=$<CONFIG> -DCMAKE_CTEST_COMMAND=${CMAKE_CTEST_COMMAND}
          -DGENERATOR=${CMAKE_GENERATOR} -DCOMPILER=${CMAKE_CXX_COMPILER} -DFLAGS=${_consumer_flags}
          -P ${CMAKE_CURRENT_LIST_DIR}/run.cmake)
set_tests_properties(installed_package PROPERTIES TIMEOUT 1800)
