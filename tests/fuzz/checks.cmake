# Fuzz harnesses of librelief_io, run here on seeded mutations, in builds with AddressSanitizer: without
# it most faults of a reader go unseen. With clang, libFuzzer can take the harness files as they are:
# clang -fsanitize=fuzzer,address fuzz_NAME.c (without fuzz_driver.c).
if(NOT TARGET relief_io OR NOT RELIEF_SANITIZE MATCHES "address")
  return()
endif()

add_library(relief_fuzz STATIC ${CMAKE_CURRENT_LIST_DIR}/fuzz_driver.c)
relief_settings(relief_fuzz)
target_include_directories(relief_fuzz PUBLIC ${PROJECT_SOURCE_DIR}/src
                           ${PROJECT_SOURCE_DIR}/tests/support ${CMAKE_CURRENT_LIST_DIR})
target_link_libraries(relief_fuzz PUBLIC relief_io relief_sim relief)

set(RELIEF_FUZZ_ITERATIONS 4000 CACHE STRING "Mutations per fuzz test")
set(fuzz_names address camera_json frame_list layout log matroska model oni pcd picture rosbag rvl scene_json)
if(RELIEF_WITH_MCAP)
  list(APPEND fuzz_names mcap)
endif()
if(relief_io_ros2_FOUND)
  list(APPEND fuzz_names ros2)
endif()
# What programs send to `relief run --publish`.
set(publish_names "")
if(TARGET relief_command)
  list(APPEND publish_names publish_json)
  if(RELIEF_WITH_OSC AND relief_osc_FOUND)
    list(APPEND publish_names publish_osc)
  endif()
endif()
foreach(name IN LISTS fuzz_names publish_names)
  add_executable(fuzz_${name} ${CMAKE_CURRENT_LIST_DIR}/fuzz_${name}.c)
  relief_settings(fuzz_${name})
  if(name IN_LIST publish_names)
    target_link_libraries(fuzz_${name} PRIVATE relief_command)
  endif()
  target_link_libraries(fuzz_${name} PRIVATE relief_fuzz)
  add_dependencies(relief_tests fuzz_${name})
  set(iterations ${RELIEF_FUZZ_ITERATIONS})
  if(name STREQUAL "rosbag") # each opens a bag several times
    math(EXPR iterations "${iterations} / 32")
  elseif(name STREQUAL "matroska") # ten times as slow
    math(EXPR iterations "${iterations} / 2")
  endif()
  add_test(NAME fuzz.${name} COMMAND fuzz_${name} ${iterations}
           WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 1800)
endforeach()
