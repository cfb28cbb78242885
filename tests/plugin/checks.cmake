# Plug-ins: one that works (examples/plugin_camera.c), and each way in which one cannot be used.
if(NOT TARGET relief_io OR NOT TARGET plugin_camera)
  return()
endif()

relief_test(${CMAKE_CURRENT_LIST_DIR}/test_io_plugin.c unit)
target_compile_definitions(test_io_plugin PRIVATE GOOD_PLUGIN="$<TARGET_FILE:plugin_camera>"
                           BAD_PLUGIN_FOLDER="${CMAKE_CURRENT_BINARY_DIR}/bad_plugins")
add_dependencies(test_io_plugin plugin_camera)
set(bad_kind 0)
foreach(name version symbol null scheme open taken unavailable)
  math(EXPR bad_kind "${bad_kind} + 1")
  add_library(bad_plugin_${name} MODULE ${CMAKE_CURRENT_LIST_DIR}/bad_plugin.c)
  relief_settings(bad_plugin_${name})
  target_include_directories(bad_plugin_${name} PRIVATE ${PROJECT_SOURCE_DIR}/include)
  target_compile_definitions(bad_plugin_${name} PRIVATE BAD_KIND=${bad_kind})
  set_target_properties(bad_plugin_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name}
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/bad_plugins)
  add_dependencies(test_io_plugin bad_plugin_${name})
endforeach()

# The command with plug-ins: by name, and by the folders of $RELIEF_PLUGIN_PATH.
if(TARGET relief_app)
  add_test(NAME app.plugins
           COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/test_plugins.sh $<TARGET_FILE:relief_app>
                   $<TARGET_FILE:plugin_camera> ${CMAKE_CURRENT_BINARY_DIR}/bad_plugins
                   ${CMAKE_CURRENT_BINARY_DIR}/app_plugins)
  set_tests_properties(app.plugins PROPERTIES LABELS app TIMEOUT 600)
endif()
