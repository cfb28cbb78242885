# Builds shared libraries with every part that is there, and has install.cmake look at them.
# cmake -DROOT= and what install.cmake needs, but BUILD -P shared.cmake
cmake_minimum_required(VERSION 3.25)

set(BUILD "${WORK} build")
set(CONFIG Debug) # not optimised: what is exported and linked is the same
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${ROOT} -B "${BUILD}" -G ${GENERATOR} --log-level=WARNING
          -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_C_FLAGS_DEBUG=-O0 -DCMAKE_C_COMPILER=${CC}
          -DBUILD_SHARED_LIBS=ON -DRELIEF_BUILD_EXAMPLES=OFF
          -DRELIEF_WITH_IO=${WITH_IO} -DRELIEF_WITH_GL=${WITH_GL} -DRELIEF_BUILD_APP=${WITH_APP}
          -DRELIEF_BUILD_TESTS=OFF -DRELIEF_BUILD_BENCH=OFF
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build "${BUILD}" OUTPUT_VARIABLE output
                COMMAND_ECHO NONE RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "shared: the build failed\n${output}")
endif()
file(GLOB found "${BUILD}/src/librelief*.so*")
if(NOT found)
  message(FATAL_ERROR "shared: no librelief.so in ${BUILD}/src")
endif()
# Before 1.0 a new minor version may change the API: its number is part of the soname.
file(STRINGS ${ROOT}/include/relief/base.h version REGEX "RLF_VERSION_(MAJOR|MINOR) ")
string(REGEX REPLACE "[^0-9;]" "" version "${version}")
list(GET version 0 major)
list(GET version 1 minor)
set(soversion ${major})
if(major EQUAL 0)
  set(soversion 0.${minor})
endif()
find_program(readelf NAMES readelf llvm-readelf REQUIRED)
execute_process(COMMAND ${readelf} -d "${BUILD}/src/librelief.so" OUTPUT_VARIABLE output)
if(NOT output MATCHES "\\[librelief\\.so\\.${soversion}\\]")
  message(FATAL_ERROR "shared: the soname is not librelief.so.${soversion}:\n${output}")
endif()
include(${CMAKE_CURRENT_LIST_DIR}/install.cmake)
file(REMOVE_RECURSE "${BUILD}")
