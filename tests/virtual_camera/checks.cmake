# Relief as a camera for other programs.
if(TARGET relief_app AND NOT RELIEF_SANITIZE)
  set(folder ${CMAKE_CURRENT_LIST_DIR})
  add_library(mock_v4l2 MODULE ${folder}/mock_v4l2.c)
  target_link_libraries(mock_v4l2 PRIVATE ${relief_dl_libs})
  add_test(NAME virtual_camera.v4l2
           COMMAND sh ${folder}/test_v4l2.sh $<TARGET_FILE:relief_app> $<TARGET_FILE:mock_v4l2>
                   ${CMAKE_CURRENT_BINARY_DIR}/virtual_camera_v4l2)
  set_tests_properties(virtual_camera.v4l2 PROPERTIES LABELS app TIMEOUT 600)
  get_target_property(io_definitions relief_io COMPILE_DEFINITIONS)
  if("RLF_HAVE_PIPEWIRE" IN_LIST io_definitions)
    add_executable(pipewire_reader ${folder}/pipewire_reader.c)
    target_link_libraries(pipewire_reader PRIVATE PkgConfig::relief_io_pipewire)
    add_test(NAME virtual_camera.pipewire
             COMMAND sh ${folder}/test_pipewire.sh $<TARGET_FILE:relief_app>
                     $<TARGET_FILE:pipewire_reader> ${CMAKE_CURRENT_BINARY_DIR}/virtual_camera_pipewire)
    set_tests_properties(virtual_camera.pipewire PROPERTIES LABELS app TIMEOUT 600
                         SKIP_RETURN_CODE 77)
  endif()
endif()
