# Fuzz harnesses of librelief_io, run here on seeded mutations. With clang, libFuzzer can take the
# harness files as they are: clang -fsanitize=fuzzer,address fuzz_NAME.c (without fuzz_driver.c).
if(NOT TARGET relief_io)
  return()
endif()

# The readers are built again with AddressSanitizer where it runs (it needs /proc), unless the whole
# build has a sanitizer.
include(CheckCSourceRuns)
set(fuzz_flags "")
if(NOT RELIEF_SANITIZE)
  set(CMAKE_REQUIRED_FLAGS "-fsanitize=address,undefined")
  check_c_source_runs("int main(void) { return 0; }" RELIEF_HAVE_ASAN)
  unset(CMAKE_REQUIRED_FLAGS)
  if(RELIEF_HAVE_ASAN)
    set(fuzz_flags -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  endif()
endif()

get_target_property(fuzz_sources relief_io SOURCES)
get_target_property(fuzz_source_dir relief_io SOURCE_DIR)
list(TRANSFORM fuzz_sources PREPEND "${fuzz_source_dir}/" REGEX "^[^/]")
add_library(relief_io_fuzz STATIC ${fuzz_sources} ${CMAKE_CURRENT_LIST_DIR}/fuzz_driver.c)
relief_settings(relief_io_fuzz)
get_target_property(fuzz_definitions relief_io COMPILE_DEFINITIONS)
if(fuzz_definitions)
  target_compile_definitions(relief_io_fuzz PUBLIC ${fuzz_definitions})
endif()
target_include_directories(relief_io_fuzz PUBLIC ${PROJECT_SOURCE_DIR}/src
                           ${PROJECT_SOURCE_DIR}/tests/support ${CMAKE_CURRENT_LIST_DIR})
target_compile_options(relief_io_fuzz PUBLIC ${fuzz_flags})
target_link_options(relief_io_fuzz PUBLIC ${fuzz_flags})
get_target_property(fuzz_libraries relief_io LINK_LIBRARIES)
target_link_libraries(relief_io_fuzz PUBLIC ${fuzz_libraries})

set(RELIEF_FUZZ_ITERATIONS 6000 CACHE STRING "Mutations per fuzz test")
set(fuzz_names address camera_json frame_list layout log matroska oni pcd picture rosbag rvl scene_json)
if(RELIEF_WITH_MCAP)
  list(APPEND fuzz_names mcap)
endif()
if(RELIEF_WITH_MODELS)
  list(APPEND fuzz_names model)
endif()
foreach(name IN LISTS fuzz_names)
  add_executable(fuzz_${name} ${CMAKE_CURRENT_LIST_DIR}/fuzz_${name}.c)
  relief_settings(fuzz_${name})
  target_link_libraries(fuzz_${name} PRIVATE relief_io_fuzz)
  set(iterations ${RELIEF_FUZZ_ITERATIONS})
  if(name STREQUAL "rosbag") # each opens a bag several times
    math(EXPR iterations "${iterations} / 4")
  endif()
  add_test(NAME fuzz.${name} COMMAND fuzz_${name} ${iterations}
           WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
  set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 1800)
  # Assimp itself leaks a few hundred bytes per damaged file: docs/limits.md. Nothing else may.
  if(name STREQUAL "model")
    set_tests_properties(fuzz.${name} PROPERTIES ENVIRONMENT
      "LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/assimp_leaks.txt:print_suppressions=0")
  endif()
endforeach()
