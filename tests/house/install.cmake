# Installs into a fresh folder (whose name has a blank in it), looks at what the libraries of one kind
# show, and builds a stranger's programs in C and C++ against them, with find_package and with
# pkg-config, and runs them.
# cmake -DKIND=static|shared -DROOT= -DBUILD= -DWORK= -DCONSUMER= -DCC= -DCXX= -DNM= -DGENERATOR=
#       -DCONFIG= -DHAS_BOTH= -DWITH_IO= -DWITH_GL= -DWITH_APP= -P install.cmake
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

function(expect_file path)
  if(NOT EXISTS ${path})
    message(FATAL_ERROR "install: ${path} is missing")
  endif()
endfunction()

set(prefix "${WORK}/prefix")
file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --install ${BUILD} --prefix "${prefix}" --config ${CONFIG})

set(components sim)
set(definitions -DWITH_SIM)
set(packages relief_sim relief)
foreach(component io gl window)
  string(TOUPPER ${component} name)
  if(WITH_${name})
    list(APPEND components ${component})
    list(APPEND definitions -DWITH_${name})
    list(PREPEND packages relief_${component})
    expect_file("${prefix}/include/relief/${component}.h")
  elseif(EXISTS "${prefix}/include/relief/${component}.h")
    message(FATAL_ERROR "install: ${component}.h is installed, but not its library")
  endif()
endforeach()
expect_file("${prefix}/include/relief/relief.h")
if(WITH_APP)
  expect_file("${prefix}/bin/relief")
  expect_file("${prefix}/share/relief/scenes/two_cubes.json")
  run("${prefix}/bin/relief" --version)
endif()
file(GLOB_RECURSE pc_files "${prefix}/*/relief.pc")
if(NOT pc_files)
  message(FATAL_ERROR "install: no relief.pc under ${prefix}")
endif()
get_filename_component(pc_folder "${pc_files}" DIRECTORY)
get_filename_component(library_folder "${pc_folder}" DIRECTORY)

# Before 1.0 a new minor version may change the API: its number is part of the soname.
file(STRINGS ${ROOT}/include/relief/base.h version REGEX "RLF_VERSION_(MAJOR|MINOR) ")
string(REGEX REPLACE "[^0-9;]" "" version "${version}")
string(REGEX REPLACE "^([1-9][0-9]*);.*" "\\1" soversion "${version}")
string(REPLACE ";" "." soversion "${soversion}")
find_program(readelf NAMES readelf llvm-readelf REQUIRED)

# Only public names, and no path of the machine that built them.
foreach(package IN LISTS packages)
  set(library "${library_folder}/lib${package}.a")
  if(KIND STREQUAL "shared")
    set(library "${library_folder}/lib${package}.so")
    run(${readelf} -d "${library}")
    if(NOT run_output MATCHES "\\[lib${package}\\.so\\.${soversion}\\]")
      message(FATAL_ERROR "install: the soname is not lib${package}.so.${soversion}:\n${run_output}")
    endif()
  endif()
  run(${CMAKE_COMMAND} "-DLIBRARY=${library}" "-DINCLUDE=${prefix}/include" -DNM=${NM}
      -P ${CMAKE_CURRENT_LIST_DIR}/exports.cmake)
  message("install: ${run_output}")
endforeach()
execute_process(COMMAND grep -rlF -e "${ROOT}/" -e "${BUILD}/" "${prefix}" OUTPUT_VARIABLE leaks)
if(leaks)
  message(FATAL_ERROR "install: these files tell where they were built:\n${leaks}")
endif()

# run_consumers(FOLDER OPTIONS...): configures and builds the stranger's programs there, runs them.
function(run_consumers folder)
  run(${CMAKE_COMMAND} -S ${CONSUMER} -B "${WORK}/${folder}" -G ${GENERATOR} -DKIND=${KIND}
      -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_PREFIX_PATH=${prefix}" ${ARGN})
  run(${CMAKE_COMMAND} --build "${WORK}/${folder}")
  file(GLOB programs "${WORK}/${folder}/consumer_*")
  foreach(program IN LISTS programs)
    run("${program}")
    get_filename_component(name "${program}" NAME)
    message("install: ${folder}: ${name}: ${run_output}")
  endforeach()
endfunction()

run_consumers(core -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON) # it needs nothing but a C compiler
run_consumers(with_cmake "-DCOMPONENTS=${components}")

# pkg-config. Beside a shared library the archive is for programs that have everything in them: the
# core's needs are the C library's own; those of the components are not all in Debian as archives.
find_program(pkg_config NAMES pkg-config REQUIRED)
set(ENV{PKG_CONFIG_PATH} "${pc_folder}")
set(ENV{LD_LIBRARY_PATH} "${library_folder}") # of shared ones, outside the system's folders
set(static "")
if(KIND STREQUAL "static" AND HAS_BOTH)
  set(static --static)
  set(packages relief)
  set(definitions -static)
endif()
run(${pkg_config} ${static} --cflags --libs ${packages})
string(STRIP "${run_output}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${CC} ${definitions} ${CONSUMER}/consumer.c -o "${WORK}/with_pkg_config" ${flags})
run("${WORK}/with_pkg_config")
message("install: pkg-config: ${run_output}")
run(${readelf} -d "${WORK}/with_pkg_config")
if(run_output MATCHES "\\[librelief\\." AND KIND STREQUAL "static"
   OR NOT run_output MATCHES "\\[librelief\\." AND KIND STREQUAL "shared")
  message(FATAL_ERROR "install: not linked with the ${KIND} libraries:\n${run_output}")
endif()
file(REMOVE_RECURSE "${WORK}")
