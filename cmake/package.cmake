include(CMakePackageConfigHelpers)
set(_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kaboum)
configure_package_config_file(cmake/kaboum-config.cmake.in ${PROJECT_BINARY_DIR}/kaboum-config.cmake
  INSTALL_DESTINATION ${_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/kaboum-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kaboum-config.cmake
              ${PROJECT_BINARY_DIR}/kaboum-config-version.cmake DESTINATION ${_dir})
install(EXPORT kaboum-targets NAMESPACE kaboum:: DESTINATION ${_dir})
