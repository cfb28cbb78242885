# What the object code of the core library gives away:
#   * from libm only sqrt, so that results are the same bits with every C library;
#   * no writable globals outside base/hooks.c, so that any number of pipelines can live side by side.
# cmake -DLIBRARY=librelief.a -DNM=nm -P symbols.cmake
cmake_minimum_required(VERSION 3.25)

set(libm sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2
    log10 log1p pow cbrt hypot fmod remainder erf erfc tgamma lgamma fma floor ceil round trunc rint
    nearbyint lround lrint llround modf frexp ldexp)
list(JOIN libm "|" libm)

execute_process(COMMAND ${NM} -f sysv ${LIBRARY} RESULT_VARIABLE status OUTPUT_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "symbols: ${NM} cannot read ${LIBRARY}")
endif()
string(REPLACE "[" "(" output "${output}") # brackets would glue the elements of a list together
string(REPLACE "]" ")" output "${output}")
string(REPLACE "\n" ";" lines "${output}")
set(object "")
set(symbol_count 0)
set(problems "")
foreach(line IN LISTS lines)
  if(line MATCHES "^Symbols from (.*\\()?([^() ]+\\.o)\\)?:") # nm: library(object), llvm-nm: object
    set(object ${CMAKE_MATCH_2})
  elseif(line MATCHES "^([A-Za-z0-9_.]+) *\\|.*\\|([^|]*)$")
    set(symbol ${CMAKE_MATCH_1})
    string(STRIP "${CMAKE_MATCH_2}" section)
    math(EXPR symbol_count "${symbol_count} + 1")
    if(section MATCHES "UND" AND symbol MATCHES "^(${libm})[fl]?$")
      string(APPEND problems "  ${object}: calls ${symbol} of libm\n")
    elseif(section MATCHES "^\\.(bss|data)$" AND NOT object MATCHES "^hooks\\.")
      string(APPEND problems "  ${object}: writable global ${symbol}\n")
    endif()
  endif()
endforeach()
if(symbol_count EQUAL 0)
  message(FATAL_ERROR "symbols: none found in ${LIBRARY}: ${output}")
endif()
if(problems)
  message(FATAL_ERROR "symbols:\n${problems}")
endif()
message("symbols: ${symbol_count} looked at; libm: sqrt at most; no writable global but the hooks")
