# The bits do not depend on the compiler: the core as released, built by another one than this
# build's; an example and the short golden replays run with it. Skipped where there is no other.
# cmake -DROOT= -DWORK= -DCC= -P other_compiler.cmake
cmake_minimum_required(VERSION 3.25)
include(${ROOT}/tests/house/run.cmake)

run(${CC} --version)
set(other clang)
if(run_output MATCHES "clang")
  set(other gcc)
endif()
find_program(other_cc NAMES ${other})
if(NOT other_cc)
  message("other_compiler: SKIPPED: no ${other} on this machine")
  return()
endif()
file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} -S ${ROOT}/tests/house/embedded -B "${WORK}" -G Ninja
    --log-level=WARNING -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=${other_cc}
    -DBUILD_SHARED_LIBS=ON -DRELIEF_ROOT=${ROOT} -DRELIEF_WITH_IO=OFF -DRELIEF_WITH_GL=OFF
    -DRELIEF_BUILD_APP=OFF -DCMOCKA=ON)
run(${CMAKE_COMMAND} --build "${WORK}")
foreach(program consumer hello_bounce build_hash)
  run("${WORK}/${program}")
endforeach()
message("other_compiler: ${other}: the same bits")
file(REMOVE_RECURSE "${WORK}")
