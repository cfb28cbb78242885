# What a build of shared libraries gives: the soname, and what install.cmake looks at.
# cmake with what install.cmake needs -P shared.cmake
cmake_minimum_required(VERSION 3.25)

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
