# Stand-ins for cameras that some tests need: drivers and libraries of our own.
set(support ${CMAKE_CURRENT_LIST_DIR})

# OpenNI2 looks for drivers beside itself: a folder of links with our driver makes a private set. The
# library resolves that folder from the path by which it was opened.
find_file(RELIEF_OPENNI2_LIBRARY libOpenNI2.so.0
          PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} /usr/lib64 /usr/lib NO_DEFAULT_PATH)
if(RELIEF_WITH_OPENNI2 AND RELIEF_OPENNI2_LIBRARY AND TARGET test_io_openni2)
  set(place ${CMAKE_CURRENT_BINARY_DIR}/openni2)
  file(MAKE_DIRECTORY ${place}/OpenNI2/Drivers)
  file(CREATE_LINK ${RELIEF_OPENNI2_LIBRARY} ${place}/libOpenNI2.so.0 SYMBOLIC)
  add_library(openni2_test_driver MODULE ${support}/openni2_driver/driver.c)
  relief_settings(openni2_test_driver)
  target_compile_options(openni2_test_driver PRIVATE -Wno-missing-prototypes)
  target_include_directories(openni2_test_driver PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(openni2_test_driver PRIVATE relief Threads::Threads)
  set_target_properties(openni2_test_driver PROPERTIES OUTPUT_NAME ReliefTest SUFFIX .so.0
                        LIBRARY_OUTPUT_DIRECTORY ${place}/OpenNI2/Drivers)
  add_dependencies(test_io_openni2 openni2_test_driver)
  target_compile_definitions(test_io_openni2 PRIVATE RLF_TEST_OPENNI2="${place}")
  # OpenNI2 itself leaks some hundred bytes each time it starts. Nothing else may.
  set_tests_properties(unit.io_openni2 PROPERTIES ENVIRONMENT
                       "LSAN_OPTIONS=suppressions=${support}/openni2_leaks.txt:print_suppressions=0")
endif()

# libfreenect: a stand-in with a factory calibration, and Debian's fakenect, which plays dumps.
if(RELIEF_WITH_FREENECT AND TARGET test_io_freenect)
  add_library(freenect_stub MODULE ${support}/freenect_stub.c)
  relief_settings(freenect_stub)
  target_compile_options(freenect_stub PRIVATE -Wno-missing-prototypes)
  target_include_directories(freenect_stub PRIVATE ${PROJECT_SOURCE_DIR}/src ${support})
  target_link_libraries(freenect_stub PRIVATE relief)
  set_target_properties(freenect_stub PROPERTIES OUTPUT_NAME freenect SUFFIX .so.0.5
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/freenect)
  add_dependencies(test_io_freenect freenect_stub)
  target_compile_definitions(test_io_freenect PRIVATE
                             RLF_TEST_FREENECT_STUB="$<TARGET_FILE:freenect_stub>")
  find_file(RELIEF_FAKENECT_LIBRARY libfreenect.so.0.5
            PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/fakenect /usr/lib/fakenect
            NO_DEFAULT_PATH)
  if(RELIEF_FAKENECT_LIBRARY)
    target_compile_definitions(test_io_fakenect PRIVATE
                               RLF_TEST_FAKENECT="${RELIEF_FAKENECT_LIBRARY}")
  endif()
endif()

# Cyclone DDS's headers have "asm", which C17 without extensions spells so.
if(TARGET test_io_ros2_bad)
  target_link_libraries(test_io_ros2_bad PRIVATE PkgConfig::relief_io_ros2)
  target_compile_definitions(test_io_ros2_bad PRIVATE asm=__asm__)
endif()
