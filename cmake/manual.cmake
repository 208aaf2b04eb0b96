# Manual pages and completions, made of what the tools print with --help; and what else is installed for users.
if(NOT KABOUM_BUILD_TOOLS)
  return()
endif()
get_property(_tools GLOBAL PROPERTY KABOUM_TOOLS)
find_package(Python3 3.9 COMPONENTS Interpreter QUIET)
if(Python3_Interpreter_FOUND AND NOT KABOUM_SANITIZE AND NOT KABOUM_COVERAGE)
  set(_pages)
  foreach(_tool IN LISTS _tools)
    set(_page ${PROJECT_BINARY_DIR}/man/${_tool}.1)
    set(_completion ${PROJECT_BINARY_DIR}/completions/${_tool})
    add_custom_command(OUTPUT ${_page} ${_completion}
      COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/make-manual $<TARGET_FILE:${_tool}> ${PROJECT_VERSION}
              ${_page} ${_completion}
      DEPENDS ${_tool} ${PROJECT_SOURCE_DIR}/scripts/make-manual VERBATIM)
    list(APPEND _pages ${_page})
    install(FILES ${_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
    install(FILES ${_completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT tools)
  endforeach()
  add_custom_target(manual ALL DEPENDS ${_pages})
endif()
install(FILES share/kaboum.mk DESTINATION ${CMAKE_INSTALL_DATADIR}/kaboum COMPONENT tools)
install(PROGRAMS share/slurm/kaboum-batch.slurm DESTINATION ${CMAKE_INSTALL_DATADIR}/kaboum/slurm COMPONENT tools)
