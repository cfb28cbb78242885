# A stranger's project that builds Relief within itself (FetchContent), and whose targets have the
# names of system libraries, links none of them by mistake. And without pkg-config and with every
# option off, nothing but a C compiler is asked for. All is configured, nothing compiled.
# cmake -DROOT= -DWORK= -DCC= -DWITH_IO= -DWITH_GL= -P embedded.cmake
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} -S ${ROOT} -B "${WORK}/minimal" -G Ninja --log-level=WARNING
    -DCMAKE_C_COMPILER=${CC} -DPKG_CONFIG_EXECUTABLE=PKG_CONFIG_EXECUTABLE-NOTFOUND
    -DRELIEF_WITH_IO=OFF -DRELIEF_WITH_VIDEO=OFF -DRELIEF_WITH_GL=OFF -DRELIEF_WITH_VIEWER=OFF
    -DRELIEF_BUILD_APP=OFF -DRELIEF_BUILD_LAB=OFF -DRELIEF_BUILD_TESTS=OFF)

set(components "")
foreach(component io gl)
  string(TOUPPER ${component} name)
  if(WITH_${name})
    list(APPEND components ${component})
  endif()
endforeach()
# BUILD_SHARED_LIBS of the whole project says which libraries Relief makes in it.
foreach(is_shared ON OFF)
  set(build "${WORK}/shared_${is_shared}")
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/embedded -B "${build}" -G Ninja
      --log-level=WARNING -DCMAKE_C_COMPILER=${CC} -DBUILD_SHARED_LIBS=${is_shared}
      -DRELIEF_ROOT=${ROOT} "-DCOMPONENTS=${components}" -DRELIEF_WITH_IO=${WITH_IO}
      -DRELIEF_WITH_GL=${WITH_GL} -DRELIEF_BUILD_APP=OFF)
  file(STRINGS "${build}/build.ninja" links REGEX "this-is-the-strangers-own")
  if(links)
    message(FATAL_ERROR "embedded: a stranger's target of the name of a system library is linked:\n"
                        "${links}")
  endif()
  set(wanted "librelief\\.a")
  if(is_shared)
    set(wanted "librelief\\.so")
  endif()
  file(STRINGS "${build}/build.ninja" links REGEX "^build consumer:.*${wanted}")
  if(NOT links)
    message(FATAL_ERROR "embedded: with BUILD_SHARED_LIBS=${is_shared} no ${wanted} is linked")
  endif()
endforeach()
file(REMOVE_RECURSE "${WORK}")
