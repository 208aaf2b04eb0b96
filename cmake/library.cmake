# kaboum_add_library(<name> SOURCES ... PUBLIC ... PRIVATE ...)
# A static library with the alias and exported target kaboum::<name>; headers in include/.
function(kaboum_add_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(kaboum_${name} STATIC ${arg_SOURCES})
  add_library(kaboum::${name} ALIAS kaboum_${name})
  set_target_properties(kaboum_${name} PROPERTIES EXPORT_NAME ${name} CXX_EXTENSIONS OFF
                        POSITION_INDEPENDENT_CODE ON)
  target_compile_features(kaboum_${name} PUBLIC cxx_std_20)
  target_include_directories(kaboum_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(kaboum_${name}
    PUBLIC ${arg_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:kaboum_options> ${arg_PRIVATE})
  install(TARGETS kaboum_${name} EXPORT kaboum-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# kaboum_add_tool(<name> SOURCES ... LIBRARIES ...): an installed executable.
function(kaboum_add_tool name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES CXX_EXTENSIONS OFF
                        RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(${name} PRIVATE kaboum_options ${arg_LIBRARIES})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()
