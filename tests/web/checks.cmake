# The core in a browser's machine code, and the page around it in a browser.
if(TARGET relief_app)
  add_test(NAME web.page COMMAND ${CMAKE_CURRENT_LIST_DIR}/page.sh ${PROJECT_SOURCE_DIR}
           $<TARGET_FILE:relief_app>)
  set_tests_properties(web.page PROPERTIES LABELS web SKIP_RETURN_CODE 77 TIMEOUT 3000)
  add_test(NAME web.core COMMAND ${CMAKE_CURRENT_LIST_DIR}/core.sh ${PROJECT_SOURCE_DIR}
           $<TARGET_FILE:relief_app>)
  set_tests_properties(web.core PROPERTIES LABELS web SKIP_RETURN_CODE 77 TIMEOUT 600)
endif()

# See-through devices: by a mock in node, and a session in Chromium under an emulator.
foreach(name xr ar)
  add_test(NAME web.${name} COMMAND ${CMAKE_CURRENT_LIST_DIR}/xr.sh ${PROJECT_SOURCE_DIR} ${name}.mjs)
  set_tests_properties(web.${name} PROPERTIES LABELS web SKIP_RETURN_CODE 77 TIMEOUT 600)
endforeach()
