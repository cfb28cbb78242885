# The relief command as a user meets it: exit statuses, messages, files.
if(TARGET relief_app)
  add_test(NAME app.command
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_command.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_command)
  set_tests_properties(app.command PROPERTIES LABELS app TIMEOUT 600)
endif()

# What `relief eval` counts.
if(TARGET relief_app)
  relief_test(${PROJECT_SOURCE_DIR}/tests/app/test_eval.c app)
  target_sources(test_eval PRIVATE ${PROJECT_SOURCE_DIR}/app/eval_collisions.c
                 ${PROJECT_SOURCE_DIR}/app/eval_foreground.c ${PROJECT_SOURCE_DIR}/app/eval_normals.c
                 ${PROJECT_SOURCE_DIR}/app/measure_points.c)
  target_include_directories(test_eval PRIVATE ${PROJECT_SOURCE_DIR}/app)
endif()
