# Public headers: see headers.sh.
find_program(RELIEF_CXX NAMES c++ g++ clang++ DOC "C++ compiler for the header check")
set(cxx "")
if(RELIEF_CXX)
  set(cxx ${RELIEF_CXX})
endif()
add_test(NAME house.headers COMMAND ${CMAKE_CURRENT_LIST_DIR}/headers.sh
         ${PROJECT_SOURCE_DIR}/include ${CMAKE_C_COMPILER} ${cxx})
set_tests_properties(house.headers PROPERTIES LABELS house TIMEOUT 1800)

if(WIN32) # the tests below are not there
  return()
endif()

# Every public function with NULL, and every number of what a caller fills in: both are read from the
# headers that are built here.
file(GLOB built_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/relief/*.h)
# Calls of the window open one where there is a display: gl.viewer gives them NULL.
list(FILTER built_headers EXCLUDE REGEX "/window\\.h$")
set(is_partial 0)
foreach(component io gl)
  if(TARGET relief_${component})
    string(TOUPPER ${component} name)
    foreach(test test_null_calls test_def_fields)
      target_compile_definitions(${test} PRIVATE RLF_TEST_WITH_${name})
    endforeach()
  else()
    list(FILTER built_headers EXCLUDE REGEX "/${component}\\.h$")
    set(is_partial 1)
  endif()
endforeach()

# read_headers(NAME VARIABLES...): NAME.h of test_NAME, made by NAME.awk.
set(headers ${CMAKE_CURRENT_LIST_DIR})
function(read_headers name)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/read_headers)
  file(MAKE_DIRECTORY ${folder})
  add_custom_command(OUTPUT ${folder}/${name}.h
    COMMAND awk ${ARGN} -f ${headers}/comments.awk -f ${headers}/${name}.awk ${built_headers}
            > ${folder}/${name}.h
    DEPENDS ${built_headers} ${headers}/comments.awk ${headers}/${name}.awk
            ${headers}/may_be_null.txt VERBATIM)
  target_sources(test_${name} PRIVATE ${folder}/${name}.h)
  target_include_directories(test_${name} PRIVATE ${folder})
endfunction()
read_headers(null_calls -v MAY_BE_NULL=${headers}/may_be_null.txt -v PARTIAL=${is_partial})
read_headers(def_fields -v "STRUCTS=rlf_source_info rlf_frame rlf_reconstruct_def rlf_hand_tracker_def \
rlf_map_def rlf_tracker_def rlf_world_def rlf_body_def rlf_known_def rlf_compositor_def \
rlf_pipeline_def rlf_synthetic_def")
