# Writes a header that tells the build type and the commit, only when they have changed:
# cmake -DROOT=<sources> -DBUILD_TYPE=<type> -DOUT=<header> -P BuildHeader.cmake
cmake_minimum_required(VERSION 3.25)
set(commit unknown)
find_program(git git)
if(git)
  execute_process(COMMAND ${git} -C ${ROOT} describe --always --dirty --exclude=*
                  OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                  RESULT_VARIABLE failed)
  if(NOT failed)
    set(commit ${found})
  endif()
endif()
if(NOT BUILD_TYPE)
  set(BUILD_TYPE "unnamed")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "/* Made by cmake/BuildHeader.cmake. */
#define RELIEF_BUILD_TYPE \"@BUILD_TYPE@\"
#define RELIEF_COMMIT \"@commit@\"
" @ONLY)
