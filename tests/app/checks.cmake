# The relief command as a user meets it: exit statuses, messages, files.
if(TARGET relief_app)
  add_test(NAME app.command
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_command.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_command)
  set_tests_properties(app.command PROPERTIES LABELS app TIMEOUT 3600) # minutes with sanitizers
  add_test(NAME app.live
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_live.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_live)
  set_tests_properties(app.live PROPERTIES LABELS app TIMEOUT 600)
endif()

# What shells offer; and the pages of the manual.
if(TARGET relief_app)
  foreach(shell bash zsh fish)
    add_test(NAME app.completion_${shell}
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/test_completion.sh $<TARGET_FILE:relief_app>
                     ${PROJECT_SOURCE_DIR}/app/completion
                     ${CMAKE_CURRENT_BINARY_DIR}/app_completion_${shell} ${shell})
    set_tests_properties(app.completion_${shell} PROPERTIES LABELS app SKIP_RETURN_CODE 77 TIMEOUT 600)
  endforeach()
endif()
add_test(NAME app.desktop COMMAND ${CMAKE_CURRENT_LIST_DIR}/test_desktop.sh
         ${PROJECT_SOURCE_DIR}/app/desktop)
set_tests_properties(app.desktop PROPERTIES LABELS app SKIP_RETURN_CODE 77 TIMEOUT 60)
if(TARGET relief_man)
  add_test(NAME app.man
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/test_man.sh $<TARGET_FILE:relief_app>
                   ${PROJECT_BINARY_DIR}/app/man)
  set_tests_properties(app.man PROPERTIES LABELS app SKIP_RETURN_CODE 77 TIMEOUT 600)
endif()

# Fusing as a user meets it.
if(TARGET relief_app)
  add_test(NAME app.fuse
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_fuse.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_fuse)
  set_tests_properties(app.fuse PROPERTIES LABELS app TIMEOUT 600)
endif()

# Recording as a user meets it.
if(TARGET relief_app AND RELIEF_WITH_MCAP)
  add_test(NAME app.record
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_record.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_record)
  set_tests_properties(app.record PROPERTIES LABELS app TIMEOUT 3600)
endif()

# Somebody else's readers read what Relief records.
if(TARGET relief_app AND RELIEF_WITH_MCAP)
  add_test(NAME app.mcap_reader
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_mcap_reader.sh $<TARGET_FILE:relief_app>
                   ${PROJECT_SOURCE_DIR}/tests/app/mcap_reader
                   ${CMAKE_CURRENT_BINARY_DIR}/app_mcap_reader)
  set_tests_properties(app.mcap_reader PROPERTIES LABELS app SKIP_RETURN_CODE 77 TIMEOUT 3600)
endif()

# What `relief eval` and its kin count, and what they say about it.
if(TARGET relief_app)
  foreach(name test_bench test_bench_peers test_calibrate test_measure_noise test_eval test_eval_real test_eval_report test_eval_sections
          test_eval_sensed test_info test_settings)
    relief_test(${PROJECT_SOURCE_DIR}/tests/app/${name}.c app)
    target_link_libraries(${name} PRIVATE relief_measures relief_io relief)
    string(REGEX REPLACE "^test_" "" what ${name})
    set_tests_properties(app.${what} PROPERTIES TIMEOUT 3600) # minutes with sanitizers
  endforeach()
endif()

if(TARGET relief_opencv)
  # By its path: a sanitizer's dlopen does not know the program's run path.
  set_property(TEST app.calibrate PROPERTY ENVIRONMENT
               RELIEF_OPENCV_LIBRARY=$<TARGET_FILE:relief_opencv>)
  add_dependencies(test_calibrate relief_opencv)
endif()

if(TARGET relief_app AND RELIEF_WITH_VIEWER)
  relief_test(${PROJECT_SOURCE_DIR}/tests/app/test_recent.c app)
  target_sources(test_recent PRIVATE ${PROJECT_SOURCE_DIR}/app/recent.c)
  target_include_directories(test_recent PRIVATE ${PROJECT_SOURCE_DIR}/app)
endif()

# Figures within their bounds, of one seed; `relief eval` takes the mean of three, and has the other
# scenes; test_eval_sections has those without a camera. Single seeds of the picture spread by more than they are above its bound, so that one takes
# two. A random room has no bounds and need only come to its end. Minutes with sanitizers, so only
# as released.
if(TARGET relief_app AND CMAKE_BUILD_TYPE STREQUAL Release)
  foreach(scene room chair book simulator known)
    add_test(NAME app.bounds_${scene}
             COMMAND relief_app eval --scene ${scene} --profile live --seeds 1 --threads 1)
  endforeach()
  add_test(NAME app.bounds_picture COMMAND relief_app eval --scene picture --profile live --seeds 2)
  add_test(NAME app.eval_random COMMAND relief_app eval --random --rooms 1 --frames 20 --threads 1 --profile live)
  set_tests_properties(app.bounds_room app.bounds_chair app.bounds_book app.bounds_simulator
                       app.bounds_known app.bounds_picture app.eval_random PROPERTIES LABELS app TIMEOUT 3600)
endif()

# The report page; measures a little itself, so only as released.
find_package(Python3 COMPONENTS Interpreter)
if(TARGET relief_app AND Python3_FOUND AND CMAKE_BUILD_TYPE STREQUAL Release)
  add_test(NAME app.report
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_report.sh $<TARGET_FILE:relief_app>
                   ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/app_report)
  set_tests_properties(app.report PROPERTIES LABELS app TIMEOUT 3600)
endif()
