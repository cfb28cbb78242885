# Public headers: see headers.sh.
find_program(RELIEF_CXX NAMES c++ g++ clang++ DOC "C++ compiler for the header check")
set(cxx "")
if(RELIEF_CXX)
  set(cxx ${RELIEF_CXX})
endif()
add_test(NAME house.headers COMMAND ${CMAKE_CURRENT_LIST_DIR}/headers.sh
         ${PROJECT_SOURCE_DIR}/include ${CMAKE_C_COMPILER} ${cxx})
set_tests_properties(house.headers PROPERTIES LABELS house TIMEOUT 1800)
