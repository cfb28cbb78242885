# Hosts as hosts: two network namespaces with a cable between them, and another maker's DDS. Exit status
# 77 is a visible skip: no root, no namespaces, no Fast DDS.
set(network ${CMAKE_CURRENT_LIST_DIR})
if(TARGET bench_ros2 AND NOT RELIEF_SANITIZE)
  add_test(NAME network.ros2_hosts COMMAND ${network}/ros2_hosts.sh $<TARGET_FILE:bench_ros2> 2)
  set_tests_properties(network.ros2_hosts PROPERTIES LABELS network SKIP_RETURN_CODE 77 TIMEOUT 300)
  add_test(NAME network.ros2_security COMMAND ${network}/ros2_security.sh $<TARGET_FILE:bench_ros2>
           ${CMAKE_CURRENT_BINARY_DIR}/ros2_security)
  set_tests_properties(network.ros2_security PROPERTIES LABELS network SKIP_RETURN_CODE 77 TIMEOUT 300)
endif()
if(TARGET test_io_ros2 AND TARGET relief_app AND NOT RELIEF_SANITIZE)
  add_test(NAME network.fast_dds
           COMMAND ${network}/fast_dds.sh ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/fast_dds
                   $<TARGET_FILE:test_io_ros2> $<TARGET_FILE:relief_app>)
  set_tests_properties(network.fast_dds PROPERTIES LABELS network SKIP_RETURN_CODE 77 TIMEOUT 600)
endif()
