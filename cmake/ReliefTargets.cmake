# Compile settings that every target of Relief shares.
include(GNUInstallDirs)
find_package(Threads REQUIRED)
find_package(PkgConfig)

# relief_settings(TARGET): C17 without extensions, warnings, and exact floating point: no contraction
# into fused multiply-adds and no fast-math, so results are the same bits everywhere.
function(relief_settings target)
  set_target_properties(${target} PROPERTIES C_STANDARD 17 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
                        C_VISIBILITY_PRESET hidden POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wundef
                         -Wstrict-prototypes -Wmissing-prototypes -ffp-contract=off
                         $<$<CONFIG:Release>:-O3 -fno-math-errno -fno-trapping-math>)
  if(RELIEF_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(RELIEF_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${RELIEF_SANITIZE} -fno-omit-frame-pointer
                           -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${RELIEF_SANITIZE})
  endif()
endfunction()

# relief_use(TARGET NAME CURE MODULE...): links system libraries found by pkg-config as
# PkgConfig::NAME, or stops with CURE, and remembers them for the package files that
# ReliefInstall.cmake writes.
function(relief_use target name cure)
  pkg_check_modules(${name} IMPORTED_TARGET GLOBAL ${ARGN})
  if(NOT ${name}_FOUND)
    message(FATAL_ERROR "${cure}")
  endif()
  target_link_libraries(${target} PRIVATE PkgConfig::${name})
  set_property(TARGET ${target} APPEND PROPERTY RELIEF_PACKAGES ${name})
  set_property(TARGET ${target} PROPERTY RELIEF_PACKAGES_${name} ${ARGN})
endfunction()

# relief_use_if(TARGET NAME OPTION DEFINITION MODULE...): as relief_use for a library that may be
# absent: OPTION is AUTO (used where it is found), ON (needed) or OFF. DEFINITION is set when it is
# used.
function(relief_use_if target name option definition)
  if(NOT ${option})
    return()
  endif()
  pkg_check_modules(${name} QUIET IMPORTED_TARGET GLOBAL ${ARGN})
  if(NOT ${name}_FOUND)
    if(NOT ${option} STREQUAL "AUTO")
      message(FATAL_ERROR "${option} is ON, but ${ARGN} is not installed")
    endif()
    message(STATUS "${ARGN}: not installed, ${option} is OFF")
    return()
  endif()
  target_link_libraries(${target} PRIVATE PkgConfig::${name})
  target_compile_definitions(${target} PUBLIC ${definition})
  set_property(TARGET ${target} APPEND PROPERTY RELIEF_PACKAGES ${name})
  set_property(TARGET ${target} PROPERTY RELIEF_PACKAGES_${name} ${ARGN})
endfunction()

# relief_optional(OPTION HELP MODULE...): an option that is ON where pkg-config finds the modules.
function(relief_optional option help)
  if(DEFINED ${option})
    return()
  endif()
  set(is_found OFF)
  if(RELIEF_WITH_IO AND PKG_CONFIG_FOUND)
    pkg_check_modules(${option}_PROBE QUIET ${ARGN})
    if(${option}_PROBE_FOUND)
      set(is_found ON)
    endif()
  endif()
  set(${option} ${is_found} CACHE BOOL "${help}")
endfunction()
