# A rule is only as good as its alarm: each bad tree below must be rejected, with the line that says
# why, and the good one accepted. cmake -DCHECK=include_graph.cmake -DWORK=<folder> -P this
cmake_minimum_required(VERSION 3.25)

# expect(WHY FILE TEXT [FILE TEXT]...): a tree of these files is rejected with a message that matches
# WHY, or accepted when WHY is empty.
function(expect why)
  file(REMOVE_RECURSE ${WORK})
  set(rest ${ARGN})
  while(rest)
    list(POP_FRONT rest path text)
    file(WRITE ${WORK}/${path} "${text}\n")
  endwhile()
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${WORK} -P ${CHECK}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(why STREQUAL "" AND NOT status EQUAL 0)
    message(FATAL_ERROR "a good tree was rejected:\n${output}")
  endif()
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(NOT why STREQUAL "" AND (status EQUAL 0 OR NOT output MATCHES "${why}"))
    message(FATAL_ERROR "expected '${why}' for '${ARGN}', got:\n${output}")
  endif()
endfunction()

expect("" src/physics/world.c "#include \"relief/world.h\"")
expect("physics must not include relief/camera.h" src/physics/world.c "#include \"relief/camera.h\"")
expect("surface must not include relief/world.h" src/surface/a.c "#include <relief/world.h>")
expect("render must not include physics/a.h" src/render/a.c "  #  include \"physics/a.h\"")
expect("environment must not include relief/compositor.h" src/environment/a.c
       "#include \"relief/compositor.h\"")
expect("surface must not include environment/a.h" src/surface/a.c "#include \"environment/a.h\"")
expect("io must not include relief/gl.h" src/io/a.c "#include \"relief/gl.h\"")
expect("render must not include relief/gl.h" src/render/soft/a.c "#include \"relief/gl.h\"")
expect("" src/render/gl/a.c "#include \"relief/gl.h\"")
expect("write it from src/" src/surface/a.c "#include \"../physics/a.h\"")
expect("core must not include <sys/mman.h>" src/surface/a.c "#include <sys/mman.h>")
expect("core must not include <png.h>" src/capture/a.c "#include <png.h>")
expect("module 'audio' has no line" src/audio/a.c "#include \"relief/base.h\"")
expect("frame.h: must not include" src/base/a.c "int a;" include/relief/frame.h
       "#include \"relief/surface.h\"")
expect("in a circle" src/base/a.c "#include \"math/a.h\"" src/math/a.h "#include \"base/b.h\"")
expect("no sources" include/relief/base.h "int a;")
file(REMOVE_RECURSE ${WORK})
