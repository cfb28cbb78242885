# The core in a browser's machine code, and the page around it in a browser.
if(TARGET relief_app)
  add_test(NAME web.page COMMAND ${CMAKE_CURRENT_LIST_DIR}/page.sh ${PROJECT_SOURCE_DIR}
           $<TARGET_FILE:relief_app>)
  set_tests_properties(web.page PROPERTIES LABELS web SKIP_RETURN_CODE 77 TIMEOUT 3000)
  add_test(NAME web.core COMMAND ${CMAKE_CURRENT_LIST_DIR}/core.sh ${PROJECT_SOURCE_DIR}
           $<TARGET_FILE:relief_app>)
  set_tests_properties(web.core PROPERTIES LABELS web SKIP_RETURN_CODE 77 TIMEOUT 600)
endif()
