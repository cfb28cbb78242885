# The check of what a library shows must see a name too many.
# cmake -DCHECK=exports.cmake -DWORK= -DCC= -DAR= -DNM= -P exports_rejects.cmake
cmake_minimum_required(VERSION 3.25)

# expect(WHY TEXT): libraries of this C file are rejected for WHY, or accepted when WHY is empty.
function(expect why text)
  file(REMOVE_RECURSE ${WORK})
  file(WRITE ${WORK}/include/relief/own.h "int rlf_own(void);\n")
  file(WRITE ${WORK}/own.c "${text}\n")
  execute_process(COMMAND ${CC} -fPIC -c own.c -o own.o WORKING_DIRECTORY ${WORK}
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${AR} rcs libown.a own.o WORKING_DIRECTORY ${WORK}
                  COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CC} -shared own.o -o libown.so WORKING_DIRECTORY ${WORK}
                  COMMAND_ERROR_IS_FATAL ANY)
  foreach(library libown.a libown.so)
    execute_process(COMMAND ${CMAKE_COMMAND} -DLIBRARY=${WORK}/${library} -DNM=${NM}
                            -DINCLUDE=${WORK}/include -P ${CHECK}
                    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(why STREQUAL "" AND NOT status EQUAL 0)
      message(FATAL_ERROR "a good ${library} was rejected:\n${output}")
    elseif(NOT why STREQUAL "" AND (status EQUAL 0 OR NOT output MATCHES "${why}"))
      message(FATAL_ERROR "${library}: expected '${why}', got:\n${output}")
    endif()
  endforeach()
endfunction()

set(own "int rlf_own(void) { return 0; }")
expect("" "${own}")
expect("" "${own} static int io_file_read(void) { return 0; }")
expect("io_file_read" "${own} int io_file_read(void) { return 0; }")
expect("rlf_hidden" "${own} int rlf_hidden(void) { return 0; }")
expect("counter" "${own} int counter = 1;")
file(REMOVE_RECURSE ${WORK})
