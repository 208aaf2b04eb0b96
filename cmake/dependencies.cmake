# Every find_package of the project. The package configuration repeats those that installed
# libraries need (kaboum-config.cmake.in).
set(CMAKE_FIND_PACKAGE_PREFER_CONFIG OFF)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED CONFIG)
find_package(embree 3.13 REQUIRED CONFIG)
find_package(nlohmann_json 3.11 REQUIRED CONFIG)
if(KABOUM_BUILD_TOOLS OR KABOUM_BUILD_EXAMPLES)
  find_package(CLI11 2.1 REQUIRED CONFIG)
endif()
if(KABOUM_BUILD_TOOLS OR KABOUM_BUILD_EXAMPLES OR KABOUM_WITH_PYTHON)
  find_package(PNG REQUIRED)
else()
  find_package(PNG QUIET)  # without it there are no libpicture and libpage/results
endif()
find_package(tinyxml2 REQUIRED CONFIG)
if(KABOUM_WITH_YAML)
  find_package(yaml-cpp 0.7 CONFIG QUIET)
endif()
# Not by its own configuration: Debian's names programs that are in other packages.
find_package(PkgConfig REQUIRED)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)

# CGAL's Kernel and number types (LGPL) only; its mesh packages are GPL and stay out of the libraries.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL 5.5 REQUIRED CONFIG QUIET)

if(KABOUM_WITH_ASSIMP)
  find_package(assimp 5.2 REQUIRED CONFIG)
endif()
if(KABOUM_SANITIZE)
  set(KABOUM_WITH_PYTHON OFF)  # an interpreter that is not instrumented cannot load it
endif()
if(KABOUM_WITH_PYTHON)
  # Debian's, whose packages scripts/setup installs, before others on PATH; -DPython3_EXECUTABLE=... names one.
  if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python3_EXECUTABLE /usr/bin/python3)
  endif()
  find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
  set(PYTHON_EXECUTABLE ${Python3_EXECUTABLE})
  find_package(pybind11 2.10 REQUIRED CONFIG)
endif()
# Collision libraries that may decide a scene's contacts (libworld/engines). By pkg-config, which remembers what it found.
foreach(_engine FCL BULLET ODE)
  set(KABOUM_${_engine}_FOUND FALSE)
endforeach()
if(KABOUM_WITH_FCL)
  pkg_check_modules(KABOUM_FCL QUIET fcl ccd)
endif()
if(KABOUM_WITH_BULLET)
  pkg_check_modules(KABOUM_BULLET QUIET bullet)
  list(FILTER KABOUM_BULLET_LINK_LIBRARIES EXCLUDE REGEX "Dynamics|SoftBody")  # programs start faster
endif()
if(KABOUM_WITH_ODE)
  pkg_check_modules(KABOUM_ODE QUIET ode)
endif()
# STEP and IGES. Not by its own configuration, which asks for what draws as well.
set(KABOUM_OPENCASCADE_FOUND FALSE)
if(KABOUM_WITH_OPENCASCADE)
  find_path(KABOUM_OPENCASCADE_INCLUDE STEPControl_Reader.hxx PATH_SUFFIXES opencascade)
  set(KABOUM_OPENCASCADE_LIBRARIES)
  foreach(_name TKSTEP TKSTEPBase TKSTEPAttr TKIGES TKXSBase TKMesh TKShHealing TKTopAlgo TKBRep TKG3d TKG2d
                TKGeomBase TKMath TKernel)
    find_library(KABOUM_${_name} ${_name})
    list(APPEND KABOUM_OPENCASCADE_LIBRARIES ${KABOUM_${_name}})
  endforeach()
  if(KABOUM_OPENCASCADE_INCLUDE AND NOT KABOUM_OPENCASCADE_LIBRARIES MATCHES "NOTFOUND")
    set(KABOUM_OPENCASCADE_FOUND TRUE)
  endif()
endif()
if(KABOUM_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
  find_package(console_bridge REQUIRED CONFIG)
  find_package(urdfdom REQUIRED CONFIG)  # whose reading ours is compared with
  # What users load our results with: tested where it is installed (tests/engines).
  find_path(KABOUM_MUJOCO_INCLUDE mujoco/mujoco.h)
  find_library(KABOUM_MUJOCO mujoco)  # Debian's package configuration names folders of other packages
  find_package(sdformat12 CONFIG QUIET)
  find_package(Bullet MODULE QUIET)
endif()
if(KABOUM_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
  find_package(meshoptimizer REQUIRED CONFIG)
endif()
if(KABOUM_BUILD_TESTS OR KABOUM_BUILD_BENCHMARKS)
  pkg_check_modules(KABOUM_COLLISION_ENGINES QUIET fcl ccd ode bullet)  # libcollide's, to compare with
endif()
