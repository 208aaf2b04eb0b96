# Writes copies of the planner's and the checker's sources with mistakes in them, each of which a number switches on:
#   cmake -D SOURCES=libplan/src -D OUT=DIR -P mutate.cmake
# Files: those of MUTATED, and mutants.h with the names. A mistake whose line is not in its file, or there twice, is an error.
cmake_minimum_required(VERSION 3.22)
set(_count 0)
set(_names "")

# mutant(NAME FILE OLD NEW): MUTANT in NEW is whether it is switched on.
function(mutant name file old new)
  string(MD5 _key "${file}")
  if(NOT DEFINED _text_${_key})
    file(READ "${SOURCES}/${file}" _text_${_key})
    set(_files ${_files} ${file} PARENT_SCOPE)
  endif()
  math(EXPR _count "${_count} + 1")
  string(REPLACE "MUTANT" "(kaboum_mutant == ${_count})" _new "${new}")
  string(FIND "${_text_${_key}}" "${old}" _first)
  string(FIND "${_text_${_key}}" "${old}" _last REVERSE)
  if(_first EQUAL -1 OR NOT _first EQUAL _last)
    message(FATAL_ERROR "mutant '${name}': not once in ${file}: ${old}")
  endif()
  string(REPLACE "${old}" "${_new}" _mutated "${_text_${_key}}")
  set(_text_${_key} "${_mutated}" PARENT_SCOPE)
  set(_count ${_count} PARENT_SCOPE)
  get_filename_component(_part ${file} DIRECTORY)
  set(_names "${_names}    {${_count}, \"${_part}\", \"${name}\"},\n" PARENT_SCOPE)
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/planner.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/checker.cmake)

foreach(_file ${_files})
  string(MD5 _key "${_file}")
  file(WRITE "${OUT}/${_file}" "extern int kaboum_mutant;\n#line 1 \"${_file}\"\n${_text_${_key}}")
endforeach()
file(WRITE "${OUT}/mutants.h" "#pragma once

/// Number, part of the library and name of each mistake.
struct Mutant {
  int number;
  const char* part;
  const char* name;
};
inline constexpr Mutant kMutants[] = {
${_names}};
")
