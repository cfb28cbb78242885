# The symbol check must see a call into libm and a writable global.
# cmake -DCHECK=symbols.cmake -DWORK= -DCC= -DAR= -DNM= -P symbols_rejects.cmake
cmake_minimum_required(VERSION 3.25)

# expect(WHY TEXT): a library of this C file is rejected for WHY, or accepted when WHY is empty.
function(expect why text)
  file(REMOVE_RECURSE ${WORK})
  file(WRITE ${WORK}/bad.c "${text}\n")
  execute_process(COMMAND ${CC} -O0 -fno-builtin -c bad.c -o bad.c.o WORKING_DIRECTORY ${WORK}
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${AR} rcs libbad.a bad.c.o WORKING_DIRECTORY ${WORK}
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} -DLIBRARY=${WORK}/libbad.a -DNM=${NM} -P ${CHECK}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(why STREQUAL "" AND NOT status EQUAL 0)
    message(FATAL_ERROR "a good library was rejected:\n${output}")
  elseif(NOT why STREQUAL "" AND (status EQUAL 0 OR NOT output MATCHES "${why}"))
    message(FATAL_ERROR "expected '${why}', got:\n${output}")
  endif()
endfunction()

expect("" "double sqrt(double); double f(double x) { return sqrt(x); }")
expect("bad.c.o: calls sin of libm" "double sin(double); double f(double x) { return sin(x); }")
expect("bad.c.o: calls powf of libm"
       "float powf(float, float); float f(float x) { return powf(x, x); }")
expect("bad.c.o: writable global counter" "int counter = 1; int f(void) { return counter++; }")
expect("bad.c.o: writable global (f.)?count" "int f(void) { static int count; return count++; }")
file(REMOVE_RECURSE ${WORK})
