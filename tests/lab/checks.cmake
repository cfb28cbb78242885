# What the laboratory counts, and what it says about it.
if(NOT TARGET relief_lab_program)
  return()
endif()
foreach(name test_bench test_bench_peers test_calibrate test_eval_real
        test_eval_sections test_eval_sensed)
  relief_test(${PROJECT_SOURCE_DIR}/tests/lab/${name}.c lab)
  target_link_libraries(${name} PRIVATE relief_lab_sections relief_command relief_io relief)
  string(REGEX REPLACE "^test_" "" what ${name})
  set_tests_properties(lab.${what} PROPERTIES TIMEOUT 3600) # minutes with sanitizers
endforeach()
if(TARGET relief_opencv)
  # By its path: a sanitizer's dlopen does not know the program's run path.
  set_property(TEST lab.calibrate PROPERTY ENVIRONMENT
               RELIEF_OPENCV_LIBRARY=$<TARGET_FILE:relief_opencv>)
  add_dependencies(test_calibrate relief_opencv)
endif()
set(lab_program $<TARGET_FILE_DIR:relief_lab_program>/relief-lab)
set(lab_python "PYTHONPATH=${PROJECT_SOURCE_DIR}/lab:${PROJECT_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1")

# lab_check(NAME COMMAND...): of what is Python; exit status 77 is a visible skip.
function(lab_check name)
  if(TARGET relief_lab)
    add_test(NAME lab.${name} COMMAND ${ARGN})
  else()
    add_test(NAME lab.${name} COMMAND sh -c "echo 'SKIPPED: needs `import relief`'; exit 77")
  endif()
  set_tests_properties(lab.${name} PROPERTIES LABELS lab SKIP_RETURN_CODE 77 TIMEOUT 3600)
endfunction()

lab_check(command sh ${PROJECT_SOURCE_DIR}/tests/lab/test_command.sh ${lab_program}
          $<TARGET_FILE:relief_app> ${CMAKE_CURRENT_BINARY_DIR}/lab_command)
lab_check(python ${Python_EXECUTABLE} -m unittest discover -s ${PROJECT_SOURCE_DIR}/tests/lab)
set_tests_properties(lab.python PROPERTIES ENVIRONMENT "${lab_python}")

# Figures within their bounds, of one seed; `relief-lab eval` takes the mean of three, and has the
# other scenes. Single seeds of the picture spread by more than they are above its bound, so that one
# takes two. A random room has no bounds and need only come to its end. Minutes with sanitizers, so
# only as released.
if(CMAKE_BUILD_TYPE STREQUAL Release)
  foreach(scene room chair book simulator planes plate cameras physics known)
    lab_check(bounds_${scene} ${lab_program} eval --scene ${scene} --profile live --seeds 1 --threads 1)
  endforeach()
  lab_check(bounds_picture ${lab_program} eval --scene picture --profile live --seeds 2)
  lab_check(eval_random ${lab_program} eval --random --rooms 1 --frames 20 --threads 1 --profile live)
endif()

# The report page; measures a little itself, so only as released.
if(CMAKE_BUILD_TYPE STREQUAL Release)
  lab_check(report sh ${PROJECT_SOURCE_DIR}/tests/lab/test_report.sh ${lab_program}
            $<TARGET_FILE:relief_app> ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/lab_report)
endif()
