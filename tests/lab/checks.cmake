# What the laboratory counts, and what it says about it.
if(NOT TARGET relief_lab)
  return()
endif()
foreach(name test_bench test_bench_peers test_calibrate test_eval test_eval_real test_eval_report
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
add_test(NAME lab.command
         COMMAND sh ${PROJECT_SOURCE_DIR}/tests/lab/test_command.sh $<TARGET_FILE:relief_lab>
                 $<TARGET_FILE:relief_app> ${CMAKE_CURRENT_BINARY_DIR}/lab_command)
set_tests_properties(lab.command PROPERTIES LABELS lab TIMEOUT 3600) # minutes with sanitizers

# Figures within their bounds, of one seed; `relief-lab eval` takes the mean of three, and has the
# other scenes; test_eval_sections has those without a camera. Single seeds of the picture spread by
# more than they are above its bound, so that one takes two. A random room has no bounds and need only come to its end. Minutes with sanitizers, so only
# as released.
if(CMAKE_BUILD_TYPE STREQUAL Release)
  foreach(scene room chair book simulator known)
    add_test(NAME lab.bounds_${scene}
             COMMAND relief_lab eval --scene ${scene} --profile live --seeds 1 --threads 1)
  endforeach()
  add_test(NAME lab.bounds_picture COMMAND relief_lab eval --scene picture --profile live --seeds 2)
  add_test(NAME lab.eval_random COMMAND relief_lab eval --random --rooms 1 --frames 20 --threads 1 --profile live)
  set_tests_properties(lab.bounds_room lab.bounds_chair lab.bounds_book lab.bounds_simulator
                       lab.bounds_known lab.bounds_picture lab.eval_random PROPERTIES LABELS lab TIMEOUT 3600)
endif()

# The report page; measures a little itself, so only as released.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND AND CMAKE_BUILD_TYPE STREQUAL Release)
  add_test(NAME lab.report
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/lab/test_report.sh $<TARGET_FILE:relief_lab>
                   $<TARGET_FILE:relief_app> ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/lab_report)
  set_tests_properties(lab.report PROPERTIES LABELS lab TIMEOUT 3600)
endif()
