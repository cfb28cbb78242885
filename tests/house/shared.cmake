# Shared libraries with every part that is there, built by another compiler than this build's, within
# a stranger's project (FetchContent) whose targets have the names of system libraries. install.cmake
# then looks at what it installs. The core's bits do not depend on the compiler: an example and the
# short golden replays run. By the same compiler where there is no other.
# cmake -DROOT= and what install.cmake needs, but BUILD -P shared.cmake
cmake_minimum_required(VERSION 3.25)

function(run_here)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "shared: '${command}' gave ${status}\n${output}")
  endif()
  set(run_output "${output}" PARENT_SCOPE)
endfunction()

run_here(${CC} --version)
set(other clang)
if(run_output MATCHES "clang")
  set(other gcc)
endif()
find_program(OTHER_CC NAMES ${other})
if(NOT OTHER_CC)
  message("shared: no ${other} on this machine: only one compiler is tested")
  set(OTHER_CC ${CC})
endif()

# Without pkg-config and with every option off nothing but a C compiler is asked for.
set(BUILD "${WORK} build")
file(REMOVE_RECURSE "${BUILD}")
run_here(${CMAKE_COMMAND} -S ${ROOT} -B "${BUILD}/minimal" -G ${GENERATOR} --log-level=WARNING
         -DCMAKE_C_COMPILER=${OTHER_CC} -DPKG_CONFIG_EXECUTABLE=PKG_CONFIG_EXECUTABLE-NOTFOUND
         -DRELIEF_WITH_IO=OFF -DRELIEF_WITH_VIDEO=OFF -DRELIEF_WITH_GL=OFF -DRELIEF_WITH_VIEWER=OFF
         -DRELIEF_BUILD_APP=OFF -DRELIEF_BUILD_BENCH=OFF -DRELIEF_BUILD_TESTS=OFF)

set(CONFIG Release)
set(components "")
foreach(component io gl)
  string(TOUPPER ${component} name)
  if(WITH_${name})
    list(APPEND components ${component})
  endif()
endforeach()
run_here(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/embedded -B "${BUILD}" -G ${GENERATOR}
         --log-level=WARNING -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_C_COMPILER=${OTHER_CC}
         -DBUILD_SHARED_LIBS=ON -DRELIEF_ROOT=${ROOT} "-DCOMPONENTS=${components}"
         -DRELIEF_WITH_IO=${WITH_IO} -DRELIEF_WITH_GL=${WITH_GL} -DRELIEF_BUILD_APP=${WITH_APP}
         -DCMOCKA=ON)
run_here(${CMAKE_COMMAND} --build "${BUILD}")
run_here("${BUILD}/consumer")
message("shared: FetchContent: ${run_output}")
run_here("${BUILD}/hello_bounce")
run_here("${BUILD}/build_hash")
file(GLOB_RECURSE found "${BUILD}/*/librelief.so")
if(NOT found)
  message(FATAL_ERROR "shared: no librelief.so in ${BUILD}")
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
run_here(${readelf} -d ${found})
if(NOT run_output MATCHES "\\[librelief\\.so\\.${soversion}\\]")
  message(FATAL_ERROR "shared: the soname is not librelief.so.${soversion}:\n${run_output}")
endif()
include(${CMAKE_CURRENT_LIST_DIR}/install.cmake)
file(REMOVE_RECURSE "${BUILD}")
