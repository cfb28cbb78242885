# The relief command as a user meets it: exit statuses, messages, files.
if(TARGET relief_app)
  add_test(NAME app.command
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_command.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_command)
  set_tests_properties(app.command PROPERTIES LABELS app TIMEOUT 600)
endif()
