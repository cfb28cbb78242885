# The documents: every command in them runs, every link leads somewhere, sentences are short.
add_test(NAME docs.links COMMAND ${CMAKE_CURRENT_LIST_DIR}/links.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(docs.links PROPERTIES LABELS docs TIMEOUT 60)
add_test(NAME docs.sentences COMMAND ${CMAKE_CURRENT_LIST_DIR}/sentences.sh ${PROJECT_SOURCE_DIR}
         ${CMAKE_CURRENT_BINARY_DIR}/sentences)
set_tests_properties(docs.sentences PROPERTIES LABELS docs TIMEOUT 60)
add_test(NAME docs.figures COMMAND ${CMAKE_CURRENT_LIST_DIR}/figures.sh ${PROJECT_SOURCE_DIR}
         ${CMAKE_CURRENT_BINARY_DIR}/figures)
set_tests_properties(docs.figures PROPERTIES LABELS docs TIMEOUT 60)
add_test(NAME docs.readme_code COMMAND ${CMAKE_CURRENT_LIST_DIR}/readme_code.sh ${PROJECT_SOURCE_DIR})
set_tests_properties(docs.readme_code PROPERTIES LABELS docs TIMEOUT 60)
if(TARGET relief_app)
  add_test(NAME docs.commands COMMAND ${CMAKE_CURRENT_LIST_DIR}/commands.sh ${PROJECT_SOURCE_DIR}
           ${PROJECT_BINARY_DIR} ${CMAKE_CURRENT_BINARY_DIR}/docs)
  set_tests_properties(docs.commands PROPERTIES LABELS docs TIMEOUT 1800)
endif()
# The first command of the README builds and runs the release preset, so it is run from there only.
if(TARGET relief_app AND PROJECT_BINARY_DIR STREQUAL "${PROJECT_SOURCE_DIR}/build/release")
  add_test(NAME docs.demo COMMAND ${CMAKE_CURRENT_LIST_DIR}/demo.sh ${PROJECT_SOURCE_DIR}
           ${CMAKE_CURRENT_BINARY_DIR}/demo)
  set_tests_properties(docs.demo PROPERTIES LABELS docs TIMEOUT 1800)
endif()
add_test(NAME docs.site COMMAND ${CMAKE_CURRENT_LIST_DIR}/site.sh ${PROJECT_SOURCE_DIR}
         ${CMAKE_CURRENT_BINARY_DIR}/site)
set_tests_properties(docs.site PROPERTIES LABELS docs SKIP_RETURN_CODE 77 TIMEOUT 600)
add_test(NAME docs.snippets COMMAND ${CMAKE_CURRENT_LIST_DIR}/snippets.sh ${PROJECT_SOURCE_DIR}
         ${CMAKE_CURRENT_BINARY_DIR}/snippets ${CMAKE_C_COMPILER})
set_tests_properties(docs.snippets PROPERTIES LABELS docs TIMEOUT 60)
