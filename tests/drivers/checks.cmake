# Stub driver libraries: the vendors' C functions over a synthetic camera with the faults of real
# ones. A test is linked with its stub to choose the fault, and Relief opens the same file at run
# time as it would the vendor's.
if(NOT TARGET relief_io)
  return()
endif()
foreach(backend realsense k4a freenect2)
  set(name ${backend})
  if(backend STREQUAL "realsense")
    set(name realsense2) # as the library is called
  endif()
  add_library(stub_${name} SHARED ${CMAKE_CURRENT_LIST_DIR}/../support/stub_${name}/stub_${name}.c)
  relief_settings(stub_${name})
  set_target_properties(stub_${name} PROPERTIES C_VISIBILITY_PRESET default)
  target_include_directories(stub_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src
                             ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/tests/support
                             ${PROJECT_SOURCE_DIR}/tests/support/stub_${name})
  target_link_libraries(test_io_${backend} PRIVATE stub_${name})
  target_compile_definitions(test_io_${backend} PRIVATE
                             RLF_TEST_STUB="$<TARGET_FILE:stub_${name}>")
endforeach()
target_link_libraries(stub_k4a PRIVATE PkgConfig::relief_io_files)
