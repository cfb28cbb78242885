# run(COMMAND...): runs it into run_output; ends the test that includes this with its output when it
# fails.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message("${output}")
    message(FATAL_ERROR "'${command}' gave ${status}")
  endif()
  set(run_output "${output}" PARENT_SCOPE)
endfunction()
