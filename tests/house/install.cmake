# Installs into a fresh folder (whose name has a blank in it), looks at what the libraries show, and
# builds a stranger's program against them, with find_package and with pkg-config, and runs it.
# cmake -DROOT= -DBUILD= -DWORK= -DCONSUMER= -DCC= -DNM= -DGENERATOR= -DCONFIG= -DWITH_IO= -DWITH_GL=
#       -DWITH_APP= -P install.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message("${output}")
    message(FATAL_ERROR "install: '${command}' gave ${status}")
  endif()
  set(run_output "${output}" PARENT_SCOPE)
endfunction()

function(expect_file path)
  if(NOT EXISTS ${path})
    message(FATAL_ERROR "install: ${path} is missing")
  endif()
endfunction()

set(prefix "${WORK}/prefix")
file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --install ${BUILD} --prefix "${prefix}" --config ${CONFIG})

set(components "")
set(definitions "")
set(packages relief)
foreach(component io gl)
  string(TOUPPER ${component} name)
  if(WITH_${name})
    list(APPEND components ${component})
    list(APPEND definitions -DWITH_${name})
    list(APPEND packages relief_${component})
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

# Only public names, and no path of the machine that built them.
file(GLOB_RECURSE libraries "${prefix}/*/librelief*.a" "${prefix}/*/librelief*.so")
foreach(library IN LISTS libraries)
  if(NOT library MATCHES "freenect2|opencv") # opened at run time, linked by nobody
    run(${CMAKE_COMMAND} "-DLIBRARY=${library}" "-DINCLUDE=${prefix}/include" -DNM=${NM}
        -P ${CMAKE_CURRENT_LIST_DIR}/exports.cmake)
    message("install: ${run_output}")
  endif()
endforeach()
execute_process(COMMAND grep -rlF -e "${ROOT}/" -e "${BUILD}/" "${prefix}" OUTPUT_VARIABLE leaks)
if(leaks)
  message(FATAL_ERROR "install: these files tell where they were built:\n${leaks}")
endif()

# find_package of the core alone: nothing but a C compiler
run(${CMAKE_COMMAND} -S ${CONSUMER} -B "${WORK}/core" -G ${GENERATOR} -DCMAKE_C_COMPILER=${CC}
    "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)
run(${CMAKE_COMMAND} --build "${WORK}/core")
run("${WORK}/core/consumer")
message("install: core: ${run_output}")

# find_package
run(${CMAKE_COMMAND} -S ${CONSUMER} -B "${WORK}/with_cmake" -G ${GENERATOR}
    -DCMAKE_C_COMPILER=${CC} "-DCMAKE_PREFIX_PATH=${prefix}" "-DCOMPONENTS=${components}")
run(${CMAKE_COMMAND} --build "${WORK}/with_cmake")
run("${WORK}/with_cmake/consumer")
message("install: find_package: ${run_output}")

# pkg-config
find_program(pkg_config NAMES pkg-config)
file(GLOB_RECURSE pc_files "${prefix}/*/relief.pc")
if(NOT pc_files)
  message(FATAL_ERROR "install: no relief.pc under ${prefix}")
endif()
list(GET pc_files 0 pc_file)
get_filename_component(pc_folder "${pc_file}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} "${pc_folder}")
run(${pkg_config} --cflags --libs ${packages})
string(STRIP "${run_output}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(${CC} ${definitions} ${CONSUMER}/consumer.c -o "${WORK}/with_pkg_config" ${flags})
get_filename_component(library_folder "${pc_folder}" DIRECTORY)
set(ENV{LD_LIBRARY_PATH} "${library_folder}") # of shared ones, outside the system's folders
run("${WORK}/with_pkg_config")
message("install: pkg-config: ${run_output}")
file(REMOVE_RECURSE "${WORK}")
