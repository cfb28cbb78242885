# The window's tests look inside librelief_window, and they need a display, which xvfb-run lends.
if(NOT TARGET relief_window)
  return()
endif()
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
find_program(RELIEF_XVFB_RUN xvfb-run DOC "Lends the viewer's tests a display")
set(launcher "")
if(RELIEF_XVFB_RUN)
  # A server that starts anew when its last window closes refuses the next one meanwhile.
  set(launcher ${RELIEF_XVFB_RUN} -a -s "-screen 0 1280x1024x24 -noreset")
endif()
foreach(name viewer_test viewer_live_test viewer_output_test viewer_play_test)
  string(REGEX REPLACE "_test$" "" what ${name})
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.c)
  relief_settings(${name})
  # setenv is POSIX.
  target_compile_definitions(${name} PRIVATE _POSIX_C_SOURCE=200809L)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests/support)
  target_link_libraries(${name} PRIVATE relief_window relief_gl relief_io relief_sim relief PkgConfig::glfw3
                        PkgConfig::epoxy relief_test_main m)
  add_test(NAME gl.${what} COMMAND ${launcher} $<TARGET_FILE:${name}>)
  # Window system and driver libraries are unloaded with memory they still hold.
  set_tests_properties(gl.${what} PROPERTIES LABELS gl TIMEOUT 1800
                       ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")
endforeach()
# What docs/window.md tells, with the command itself.
if(TARGET relief_app AND RELIEF_XVFB_RUN)
  add_test(NAME gl.window_tasks
           COMMAND ${RELIEF_XVFB_RUN} -a -s "-screen 0 1480x900x24 -noreset"
                   ${CMAKE_CURRENT_LIST_DIR}/window_tasks.sh $<TARGET_FILE:relief_app>
                   ${CMAKE_CURRENT_BINARY_DIR}/window_tasks)
  set_tests_properties(gl.window_tasks PROPERTIES LABELS "gl;slow" TIMEOUT 600 SKIP_RETURN_CODE 77
                       ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")
endif()
