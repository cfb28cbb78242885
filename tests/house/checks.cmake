# Checks of the house itself: who may include whom, what the object code may contain, style, format,
# scripts, and that what is installed can be used by a stranger's project.
set(house ${CMAKE_CURRENT_LIST_DIR})

# house_check(NAME COMMAND...): one test labelled house; exit status 77 is a visible skip.
function(house_check name)
  add_test(NAME house.${name} COMMAND ${ARGN})
  set_tests_properties(house.${name} PROPERTIES LABELS house SKIP_RETURN_CODE 77 TIMEOUT 1800)
endfunction()

house_check(include_graph ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR}
            -P ${house}/include_graph.cmake)
house_check(include_graph_rejects ${CMAKE_COMMAND} -DCHECK=${house}/include_graph.cmake
            -DWORK=${CMAKE_CURRENT_BINARY_DIR}/include_graph -P ${house}/include_graph_rejects.cmake)
house_check(style ${house}/style.sh ${PROJECT_SOURCE_DIR})
house_check(style_rejects ${house}/style_rejects.sh ${house}/style.sh
            ${CMAKE_CURRENT_BINARY_DIR}/style)
house_check(format ${PROJECT_SOURCE_DIR}/script/format --check)
house_check(scripts ${house}/scripts.sh ${PROJECT_SOURCE_DIR})
house_check(sizes ${PROJECT_SOURCE_DIR}/script/lines --check ${house}/sizes.txt)
house_check(thresholds ${house}/thresholds.sh ${PROJECT_SOURCE_DIR}
            ${CMAKE_CURRENT_BINARY_DIR}/thresholds)

if(NOT RELIEF_SANITIZE)
  house_check(symbols ${CMAKE_COMMAND} -DLIBRARY=$<TARGET_FILE:relief> -DNM=${CMAKE_NM}
              -P ${house}/symbols.cmake)
  house_check(symbols_rejects ${CMAKE_COMMAND} -DCHECK=${house}/symbols.cmake
              -DWORK=${CMAKE_CURRENT_BINARY_DIR}/symbols -DCC=${CMAKE_C_COMPILER} -DAR=${CMAKE_AR}
              -DNM=${CMAKE_NM} -P ${house}/symbols_rejects.cmake)
  house_check(exports_rejects ${CMAKE_COMMAND} -DCHECK=${house}/exports.cmake
              -DWORK=${CMAKE_CURRENT_BINARY_DIR}/exports -DCC=${CMAKE_C_COMPILER} -DAR=${CMAKE_AR}
              -DNM=${CMAKE_NM} -P ${house}/exports_rejects.cmake)
endif()

if(NOT RELIEF_SANITIZE)
  set(objects $<TARGET_OBJECTS:relief>)
  foreach(part IN ITEMS relief_io relief_gl relief_window relief_command relief_app)
    if(TARGET ${part})
      list(APPEND objects $<TARGET_OBJECTS:${part}>)
    endif()
  endforeach()
  add_test(NAME house.circles COMMAND ${house}/circles.sh ${CMAKE_NM} ${PROJECT_SOURCE_DIR} ${objects}
           COMMAND_EXPAND_LISTS)
  set_tests_properties(house.circles PROPERTIES LABELS house TIMEOUT 1800)
  house_check(circles_rejects ${house}/circles_rejects.sh ${house}/circles.sh
              ${CMAKE_CURRENT_BINARY_DIR}/circles ${CMAKE_C_COMPILER} ${CMAKE_NM})
endif()

# A sanitized library would ask the stranger's program for the same sanitizers.
if(NOT RELIEF_SANITIZE)
  include(CheckLanguage)
  check_language(CXX)
  set(has_both OFF)
  if(RELIEF_LIBRARIES STREQUAL "both")
    set(has_both ON)
  endif()
  foreach(kind IN LISTS relief_kinds)
    set(name install)
    if(kind STREQUAL "shared")
      set(name shared)
    endif()
    house_check(${name} ${CMAKE_COMMAND} -DKIND=${kind} -DHAS_BOTH=${has_both}
                -DROOT=${PROJECT_SOURCE_DIR} -DBUILD=${PROJECT_BINARY_DIR} -DNM=${CMAKE_NM}
                -DWORK=${CMAKE_CURRENT_BINARY_DIR}/${name}\ here -DCONSUMER=${house}/consumer
                -DCC=${CMAKE_C_COMPILER} -DCXX=${CMAKE_CXX_COMPILER} -DGENERATOR=${CMAKE_GENERATOR}
                -DCONFIG=$<CONFIG> -DWITH_IO=$<TARGET_EXISTS:relief_io>
                -DWITH_GL=$<TARGET_EXISTS:relief_gl> -DWITH_WINDOW=$<TARGET_EXISTS:relief_window>
                -DWITH_APP=$<TARGET_EXISTS:relief_app> -P ${house}/install.cmake)
  endforeach()
  # Each shared library has a list of its own; a new one needs its package in debian/, too.
  house_check(deb_version grep -q "^relief (${PROJECT_VERSION})" ${PROJECT_SOURCE_DIR}/debian/changelog)
  foreach(part relief relief_io relief_gl relief_sim relief_window)
    if(TARGET ${part}_shared)
      string(REPLACE "_" "-" package lib${part})
      house_check(abi_${part} ${house}/abi.sh ${CMAKE_NM} $<TARGET_FILE:${part}_shared>
                  ${PROJECT_SOURCE_DIR}/debian/${package}${relief_soversion}.symbols)
    endif()
  endforeach()
  house_check(abi_rejects ${house}/abi_rejects.sh ${house}/abi.sh ${CMAKE_CURRENT_BINARY_DIR}/abi
              ${CMAKE_C_COMPILER} ${CMAKE_NM})
  house_check(embedded ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR}
              -DWORK=${CMAKE_CURRENT_BINARY_DIR}/embedded -DCC=${CMAKE_C_COMPILER}
              -DWITH_IO=$<TARGET_EXISTS:relief_io> -DWITH_GL=$<TARGET_EXISTS:relief_gl>
              -P ${house}/embedded.cmake)
  add_test(NAME golden.other_compiler
           COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DCC=${CMAKE_C_COMPILER}
                   -DWORK=${CMAKE_CURRENT_BINARY_DIR}/other_compiler
                   -P ${house}/../golden/other_compiler.cmake)
  set_tests_properties(golden.other_compiler PROPERTIES LABELS golden TIMEOUT 1800
                       SKIP_REGULAR_EXPRESSION "other_compiler: SKIPPED")
endif()
