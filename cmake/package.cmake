# The package that `find_package(kaboum COMPONENTS ...)` finds: a component for each library, which
# needs the packages that this library links and no others.
include(CMakePackageConfigHelpers)
set(_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kaboum)
get_property(_components GLOBAL PROPERTY KABOUM_COMPONENTS)
get_property(KABOUM_COMPONENT_NEEDS GLOBAL PROPERTY KABOUM_COMPONENT_NEEDS)
set(KABOUM_COMPONENTS "${_components}")
configure_package_config_file(cmake/kaboum-config.cmake.in ${PROJECT_BINARY_DIR}/kaboum-config.cmake
  INSTALL_DESTINATION ${_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/kaboum-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kaboum-config.cmake
              ${PROJECT_BINARY_DIR}/kaboum-config-version.cmake DESTINATION ${_dir})
foreach(_component IN LISTS _components)
  install(EXPORT kaboum-${_component} NAMESPACE kaboum:: DESTINATION ${_dir}
          FILE kaboum-${_component}.cmake)
endforeach()

install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY examples/pipeline examples/python DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT doc
        USE_SOURCE_PERMISSIONS)
