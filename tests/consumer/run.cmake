# Installs the build tree BUILD (configuration CONFIG) below WORK, then configures, builds and runs
# the examples SOURCE against it with the compiler COMPILER and nothing else of this tree; then finds
# components alone, without packages that they do not need.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build
                        -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${COMPILER}
                        -DCMAKE_CXX_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${WORK}/prefix
                        -DCMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/build COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build --output-on-failure --no-tests=error
                COMMAND_ERROR_IS_FATAL ANY)

# find_component(COMPONENT PACKAGE...): links COMPONENT ('' for all of them) while no PACKAGE can be found.
function(find_component component)
  set(without)
  foreach(package IN LISTS ARGN)
    list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
  execute_process(COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${COMPONENTS} -B ${WORK}/component-${component}
                          -DCOMPONENT=${component} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
                          -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON ${without}
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/component-${component} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
find_component("")
find_component(plan Eigen3 CGAL embree assimp PkgConfig)
find_component(collide embree assimp tinyxml2 PkgConfig)
find_component(kinematics embree assimp PkgConfig)
find_component(motion embree)
find_component(bcd embree assimp tinyxml2 PkgConfig)

# A component that does not exist is an error, not a package that is found.
execute_process(COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${COMPONENTS} -B ${WORK}/none -DCOMPONENT=none
                        -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK}/prefix
                        -DCMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON
                RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
if(NOT failed)
  message(FATAL_ERROR "find_package(kaboum COMPONENTS none) succeeded")
endif()

foreach(file IN ITEMS LICENSE README.md docs/guarantees.md)
  if(NOT EXISTS ${WORK}/prefix/${DOCS}/${file})
    message(FATAL_ERROR "${DOCS}/${file} is not installed")
  endif()
endforeach()
