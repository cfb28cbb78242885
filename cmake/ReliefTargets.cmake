# Compile settings that every target of Relief shares.
include(GNUInstallDirs)
find_package(Threads REQUIRED)
find_package(PkgConfig)

# System libraries are linked as flags (-lm), never by bare names: a name would mean a target of the
# project that uses Relief, where it has one of that name.
set(relief_dl_libs ${CMAKE_DL_LIBS})
list(TRANSFORM relief_dl_libs PREPEND "-l")

# A test is linked in a fifth of the time.
if(NOT CMAKE_CROSSCOMPILING)
  include(CheckLinkerFlag)
  check_linker_flag(C -fuse-ld=gold RELIEF_HAS_GOLD)
endif()
if(RELIEF_HAS_GOLD AND RELIEF_SANITIZE)
  add_link_options(-fuse-ld=gold)
endif()

# relief_settings(TARGET): C17 without extensions, warnings, and exact floating point: no contraction
# into fused multiply-adds and no fast-math, so results are the same bits everywhere.
function(relief_settings target)
  set_target_properties(${target} PROPERTIES C_STANDARD 17 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
                        C_VISIBILITY_PRESET hidden POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wundef
                         -Wstrict-prototypes -Wmissing-prototypes -ffp-contract=off
                         $<$<CONFIG:Release>:-O3 -fno-math-errno -fno-trapping-math>)
  # Floats are IEEE singles and doubles: 32-bit x86 would have the x87's, and gcc for s390 has doubles
  # where the standard lets it.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(i.86|x86)" AND CMAKE_SIZEOF_VOID_P EQUAL 4)
    target_compile_options(${target} PRIVATE -msse2 -mfpmath=sse)
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^s390" AND CMAKE_C_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fexcess-precision=fast)
  endif()
  # No path of the machine that builds it ends up in what is shipped.
  target_compile_options(${target} PRIVATE -ffile-prefix-map=${PROJECT_BINARY_DIR}/=build/
                         -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
  if(WIN32) # what POSIX has and Windows has not comes before every source
    set_target_properties(${target} PROPERTIES C_EXTENSIONS ON)
    target_compile_definitions(${target} PRIVATE _FILE_OFFSET_BITS=64 __USE_MINGW_ANSI_STDIO=1
                               _WIN32_WINNT=0x0601)
    target_compile_options(${target} PRIVATE -isystem${PROJECT_SOURCE_DIR}/src/windows/include
                           "SHELL:-include ${PROJECT_SOURCE_DIR}/src/windows/posix.h")
  endif()
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

# relief_python_found(OUT): whether RELIEF_WITH_PYTHON is ON, or AUTO with pybind11 and NumPy there.
function(relief_python_found out)
  set(${out} OFF PARENT_SCOPE)
  if(NOT RELIEF_WITH_PYTHON OR NOT TARGET relief_io OR RELIEF_SANITIZE)
    return()
  endif()
  set(python /usr/bin/python3)
  if(Python_EXECUTABLE)
    set(python ${Python_EXECUTABLE})
  endif()
  execute_process(COMMAND ${python} -c "import numpy, pybind11" RESULT_VARIABLE missing
                  OUTPUT_QUIET ERROR_QUIET)
  if(missing EQUAL 0)
    set(${out} ON PARENT_SCOPE)
  elseif(NOT RELIEF_WITH_PYTHON STREQUAL "AUTO")
    message(FATAL_ERROR "RELIEF_WITH_PYTHON is ON, but ${python} has no pybind11 and NumPy: "
                        "apt-get install pybind11-dev python3-pybind11 python3-numpy python3-dev")
  else()
    message(STATUS "pybind11: not installed, RELIEF_WITH_PYTHON is OFF")
  endif()
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

# Before 1.0 a new minor version may change the API, so its number is part of the soname.
set(relief_soversion ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(relief_soversion 0.${PROJECT_VERSION_MINOR})
endif()

# The kinds of library that RELIEF_LIBRARIES asks for; the first one is what relief::NAME means. An
# installer gets both, on Windows the archive; a project that builds Relief within itself what
# BUILD_SHARED_LIBS says. With a sanitizer every program must have it, too, so there the archive is
# enough.
set(default static)
if(BUILD_SHARED_LIBS)
  set(default shared)
elseif(PROJECT_IS_TOP_LEVEL AND NOT RELIEF_SANITIZE AND NOT WIN32 AND NOT DEFINED BUILD_SHARED_LIBS)
  set(default both)
endif()
set(RELIEF_LIBRARIES ${default} CACHE STRING "Libraries for users: static, shared or both")
set_property(CACHE RELIEF_LIBRARIES PROPERTY STRINGS static shared both)
set(relief_kinds ${RELIEF_LIBRARIES})
if(RELIEF_LIBRARIES STREQUAL "both")
  set(relief_kinds shared static)
elseif(NOT RELIEF_LIBRARIES MATCHES "^(static|shared)$")
  message(FATAL_ERROR "RELIEF_LIBRARIES is '${RELIEF_LIBRARIES}': use static, shared or both")
endif()

# relief_one_object(TARGET OUT): the objects of a static library as one, in which only what RLF_API
# marks is global. A user's program may then define any name without rlf_. Functions that exist once
# per instruction set are named here: gcc shows them whatever the visibility says. Archives of
# RELIEF_INSIDE_FILES become a part of it.
function(relief_one_object target out)
  if(WIN32) # whose objects know no hidden names
    set(${out} $<TARGET_OBJECTS:${target}> PARENT_SCOPE)
    return()
  endif()
  set(object ${CMAKE_CURRENT_BINARY_DIR}/${target}_public.o)
  separate_arguments(flags NATIVE_COMMAND "${CMAKE_C_FLAGS}") # the target machine's
  add_custom_command(OUTPUT ${object}
    COMMAND ${CMAKE_C_COMPILER} ${flags} -r -nostdlib -o ${object} -Wl,--whole-archive
            $<TARGET_FILE:${target}> -Wl,--no-whole-archive
            $<TARGET_PROPERTY:${target},RELIEF_INSIDE_FILES>
    COMMAND ${CMAKE_OBJCOPY} --localize-hidden --wildcard --keep-global-symbol=rlf_*
            --localize-symbol=rlf_kernel_* --localize-symbol=*.resolver ${object}
    DEPENDS ${target} VERBATIM COMMAND_EXPAND_LISTS)
  set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
  set(${out} ${object} PARENT_SCOPE)
endfunction()

# Libraries find each other where they are installed together; under /usr the loader looks by itself.
set(relief_rpath "$ORIGIN")
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(relief_rpath "")
endif()

# relief_library(TARGET NAME KIND OBJECT): relief::NAME_static or relief::NAME_shared of one object.
function(relief_library target name kind object)
  set(library ${target}_${kind})
  string(TOUPPER ${kind} type)
  add_library(${library} ${type} ${object})
  add_dependencies(${library} ${target}_object)
  add_library(relief::${name}_${kind} ALIAS ${library})
  set_target_properties(${library} PROPERTIES LINKER_LANGUAGE C EXPORT_NAME ${name}_${kind}
                        OUTPUT_NAME ${target} VERSION ${PROJECT_VERSION}
                        SOVERSION ${relief_soversion} INSTALL_RPATH "${relief_rpath}")
  if(kind STREQUAL "shared" AND NOT WIN32)
    target_link_options(${library} PRIVATE LINKER:-Bsymbolic-functions LINKER:-z,defs
                        LINKER:--version-script,${PROJECT_SOURCE_DIR}/cmake/librelief.map)
  endif()
  target_include_directories(${library} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  get_target_property(definitions ${target} INTERFACE_COMPILE_DEFINITIONS)
  if(definitions)
    target_compile_definitions(${library} INTERFACE ${definitions})
  endif()
  get_target_property(needed ${target} LINK_LIBRARIES)
  get_target_property(inside ${target} RELIEF_INSIDE)
  if(inside)
    list(REMOVE_ITEM needed ${inside})
    get_target_property(others ${target} RELIEF_PUBLIC_LIBRARIES)
    list(APPEND needed ${others})
  endif()
  foreach(item IN LISTS needed)
    if(item MATCHES "^relief(_gl|_io|_sim)?$")
      target_link_libraries(${library} PUBLIC ${item}_${kind})
    else()
      target_link_libraries(${library} PRIVATE ${item})
    endif()
  endforeach()
endfunction()

# relief_publish(TARGET NAME): makes what users link and what is installed of the static library
# TARGET, compiled once: relief::NAME_shared, relief::NAME_static, or both, as RELIEF_LIBRARIES
# says. relief::NAME is the shared one where it is made.
function(relief_publish target name)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${target}_inside)
  relief_one_object(${target} object)
  add_custom_target(${target}_object DEPENDS ${object}) # or make would run its command twice at once
  foreach(kind IN LISTS relief_kinds)
    relief_library(${target} ${name} ${kind} ${object})
  endforeach()
  list(GET relief_kinds 0 kind)
  add_library(relief::${name} ALIAS ${target}_${kind})
endfunction()
