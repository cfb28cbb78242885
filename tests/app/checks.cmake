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

# The room of a moving camera as a user meets it.
if(TARGET relief_app)
  add_test(NAME app.room
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_room.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_room)
  set_tests_properties(app.room PROPERTIES LABELS app TIMEOUT 600)
endif()

# Several cameras of one room.
if(TARGET relief_app)
  add_test(NAME app.cameras
           COMMAND sh ${PROJECT_SOURCE_DIR}/tests/app/test_cameras.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/app_cameras)
  set_tests_properties(app.cameras PROPERTIES LABELS app TIMEOUT 600)
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

# What lies behind the command.
if(TARGET relief_app)
  foreach(name test_info test_info_noise test_settings)
    relief_test(${PROJECT_SOURCE_DIR}/tests/app/${name}.c app)
    target_link_libraries(${name} PRIVATE relief_command relief_io relief)
    string(REGEX REPLACE "^test_" "" what ${name})
    set_tests_properties(app.${what} PROPERTIES TIMEOUT 3600) # minutes with sanitizers
  endforeach()
endif()

# Events for other programs: what can be tested without a network.
if(TARGET relief_app)
  set(names test_publish)
  if(RELIEF_WITH_OSC AND relief_osc_FOUND)
    list(APPEND names test_publish_osc)
  endif()
  foreach(name IN LISTS names)
    relief_test(${PROJECT_SOURCE_DIR}/tests/app/${name}.c app)
    target_link_libraries(${name} PRIVATE relief_command relief_io relief)
  endforeach()
  # And with one: the examples of docs/events.md, friends, and strangers who are slow or hostile.
  add_test(NAME app.publish_network
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/test_publish.sh $<TARGET_FILE:relief_app>
                   ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/app_publish)
  set_tests_properties(app.publish_network PROPERTIES LABELS app SKIP_RETURN_CODE 77 TIMEOUT 600)
endif()

if(TARGET relief_app AND RELIEF_WITH_VIEWER)
  relief_test(${PROJECT_SOURCE_DIR}/tests/app/test_recent.c app)
  target_sources(test_recent PRIVATE ${PROJECT_SOURCE_DIR}/app/picture_file.c
                 ${PROJECT_SOURCE_DIR}/app/recent.c ${PROJECT_SOURCE_DIR}/app/state_folder.c)
  target_include_directories(test_recent PRIVATE ${PROJECT_SOURCE_DIR}/app)
endif()
