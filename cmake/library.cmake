# Sources compiled at a time (KABOUM_UNITY): twice as many as 8 take 15 % less.
set(KABOUM_UNITY_BATCH 16)

# kaboum_compile_quickly(<target>): of programs that parse, call and print, of tests and of bindings, nobody waits for
# the run but all wait for the compiler, which takes two thirds of the time without the last optimisations.
function(kaboum_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# What most sources of libraries include is read once, for all of them: for those that are compiled quickly a second time,
# since GCC compiles with the optimisations that precompiled headers were made with, whatever else is asked for. Clang-tidy
# reads each source by itself and sees what one forgot to include.
if(KABOUM_UNITY)
  foreach(_headers IN ITEMS kaboum_library_headers kaboum_quick_library_headers)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${_headers}.cpp CONTENT "")  # not anew each time
    add_library(${_headers} OBJECT ${PROJECT_BINARY_DIR}/${_headers}.cpp)
    set_target_properties(${_headers} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(${_headers} PRIVATE kaboum_options Eigen3::Eigen nlohmann_json::nlohmann_json)
    target_precompile_headers(${_headers} PRIVATE <algorithm> <array> <charconv> <cmath> <filesystem> <functional>
                              <map> <memory> <numeric> <optional> <set> <span> <sstream> <string> <unordered_map> <vector>
                              <Eigen/Geometry> <nlohmann/json.hpp>)
  endforeach()
  kaboum_compile_quickly(kaboum_quick_library_headers)
endif()

# kaboum_add_library(<name> SOURCES ... PUBLIC ... PRIVATE ... HEADERS_OF ... ALONE ... [AT_A_TIME n] [QUICKLY])
# A library (static, or with BUILD_SHARED_LIBS shared) with the alias and exported target kaboum::<name>, a component of the package; headers
# in include/. HEADERS_OF are libraries of which only this one's sources include something: who uses the
# installed library needs none of them. ALONE are sources that use names others give to something else: they
# are never compiled together with others (KABOUM_UNITY). AT_A_TIME is how many others are, where sources have names in
# common. QUICKLY: it reads, writes and describes, and computes little (kaboum_compile_quickly).
function(kaboum_add_library name)
  cmake_parse_arguments(arg "QUICKLY" "AT_A_TIME" "SOURCES;PUBLIC;PRIVATE;HEADERS_OF;ALONE" ${ARGN})
  if(NOT arg_AT_A_TIME)
    set(arg_AT_A_TIME ${KABOUM_UNITY_BATCH})
  endif()
  add_library(kaboum_${name} ${arg_SOURCES})
  add_library(kaboum::${name} ALIAS kaboum_${name})
  set_target_properties(kaboum_${name} PROPERTIES EXPORT_NAME ${name} INSTALL_RPATH "$ORIGIN"
                        POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL ""
                        UNITY_BUILD ${KABOUM_UNITY} UNITY_BUILD_BATCH_SIZE ${arg_AT_A_TIME})
  if(NOT SKBUILD)  # a wheel has no symbolic links, so each library has one name there
    set_target_properties(kaboum_${name} PROPERTIES VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
  set_source_files_properties(${arg_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set(_headers kaboum_library_headers)
  if(arg_QUICKLY)
    kaboum_compile_quickly(kaboum_${name})
    set(_headers kaboum_quick_library_headers)
  endif()
  if(KABOUM_UNITY)
    target_precompile_headers(kaboum_${name} REUSE_FROM ${_headers})
  endif()
  target_compile_features(kaboum_${name} PUBLIC cxx_std_20)
  target_include_directories(kaboum_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM arg_HEADERS_OF REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
  target_link_libraries(kaboum_${name}
    PUBLIC ${arg_PUBLIC}
    PRIVATE $<BUILD_INTERFACE:kaboum_options> ${arg_HEADERS_OF} ${arg_PRIVATE})
  install(TARGETS kaboum_${name} EXPORT kaboum-${name}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libraries NAMELINK_COMPONENT dev)
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  kaboum_add_component(${name} ${arg_PUBLIC} ${arg_PRIVATE})
endfunction()

# What the package configuration has to find before it can offer the component <name>, which links the
# libraries in ARGN: written by cmake/package.cmake.
function(kaboum_add_component name)
  set(_components ${ARGN})
  list(FILTER _components INCLUDE REGEX "^kaboum_")
  list(TRANSFORM _components REPLACE "^kaboum_" "")
  set(_packages ${ARGN})
  list(FILTER _packages EXCLUDE REGEX "^kaboum_")
  list(TRANSFORM _packages REPLACE "^PkgConfig::" "")
  list(TRANSFORM _packages REPLACE "::.*" "")
  set_property(GLOBAL APPEND PROPERTY KABOUM_COMPONENTS ${name})
  set_property(GLOBAL APPEND_STRING PROPERTY KABOUM_COMPONENT_NEEDS
    "set(kaboum_${name}_components \"${_components}\")\nset(kaboum_${name}_packages \"${_packages}\")\n")
endfunction()

# kaboum_add_tool(<name> SOURCES ... LIBRARIES ...): an installed executable.
function(kaboum_add_tool name)
  cmake_parse_arguments(arg "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${KABOUM_UNITY} UNITY_BUILD_BATCH_SIZE ${KABOUM_UNITY_BATCH}
                        RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(${name} PRIVATE kaboum_options ${arg_LIBRARIES})
  if(BUILD_SHARED_LIBS)
    file(RELATIVE_PATH _libraries ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/${_libraries}")
  endif()
  kaboum_compile_quickly(${name})
  if(KABOUM_UNITY)
    target_precompile_headers(${name} REUSE_FROM kaboum_cli)
  endif()
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  set_property(GLOBAL APPEND PROPERTY KABOUM_TOOLS ${name})
endfunction()

# kaboum_embed(<target> FILES...): the files' text in the target, as kaboum::embedded(NAME) of <embedded.h>
# where NAME is a file's name without its folder.
function(kaboum_embed target)
  set(_entries "")
  foreach(_file ${ARGN})
    get_filename_component(_name ${_file} NAME)
    file(READ ${_file} _text)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${_file})
    string(APPEND _entries "  if (name == \"${_name}\")\n    return R\"KABOUM_FILE(${_text})KABOUM_FILE\";\n")
  endforeach()
  set(_content "#include <embedded.h>\n\nstd::string_view kaboum::embedded(std::string_view name) {\n${_entries}  return {};\n}\n")
  set(_folder ${CMAKE_CURRENT_BINARY_DIR}/${target}-embedded)
  file(CONFIGURE OUTPUT ${_folder}/embedded.cpp CONTENT "@_content@" @ONLY)
  file(CONFIGURE OUTPUT ${_folder}/embedded.h @ONLY CONTENT
       "#pragma once\n\n#include <string_view>\n\nnamespace kaboum {\n\n/// The text of a file that is part of the program; empty: there is none of that name.\nstd::string_view embedded(std::string_view name);\n\n}  // namespace kaboum\n")
  target_sources(${target} PRIVATE ${_folder}/embedded.cpp)
  target_include_directories(${target} PRIVATE ${_folder})
endfunction()
