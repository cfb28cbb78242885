# Installs libraries, headers, the command and the scenes, with a CMake package (relief::relief,
# relief::sim, relief::io, relief::gl, relief::window, each also with _static or _shared) and pkg-config
# files (relief, relief_io, ...).
include(CMakePackageConfigHelpers)

set(relief_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/relief)
set(relief_pc_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH relief_pc_to_prefix /prefix/${relief_pc_folder} /prefix)
string(REGEX REPLACE "/$" "" relief_pc_to_prefix "${relief_pc_to_prefix}")

# relief_pkg_config(NAME OWN REQUIRES LIBS DESCRIPTION): writes NAME.pc. OWN are libraries of Relief,
# REQUIRES those of the system. A static library hands its own needs on to whoever links it; a shared
# one keeps them to itself, and to `pkg-config --static`.
function(relief_pkg_config name own requires libs description)
  set(private "")
  if(NOT RELIEF_LIBRARIES STREQUAL "static")
    set(private ".private")
  endif()
  set(base "")
  if(own)
    list(TRANSFORM own APPEND " = ${PROJECT_VERSION}")
    list(JOIN own ", " own)
    set(base "Requires: ${own}\n")
  endif()
  set(needs "")
  if(requires)
    set(needs "Requires${private}: ${requires}\n")
  endif()
  if(base AND needs AND NOT private)
    set(base "")
    set(needs "Requires: ${own}, ${requires}\n")
  endif()
  set(own_libs "")
  if(libs AND private)
    set(own_libs "Libs.private: ${libs}\n")
    set(libs "")
  endif()
  file(WRITE ${PROJECT_BINARY_DIR}/${name}.pc
    "prefix=\${pcfiledir}/${relief_pc_to_prefix}\n"
    "libdir=\${prefix}/${CMAKE_INSTALL_LIBDIR}\n"
    "includedir=\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}\n\n"
    "Name: ${name}\nDescription: ${description}\nVersion: ${PROJECT_VERSION}\n"
    "${base}${needs}${own_libs}"
    "Libs: -L\${libdir} -l${name} ${libs}\n"
    "Cflags: -I\${includedir}\n")
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${relief_pc_folder})
endfunction()

# relief_packages(TARGET OUT_FINDS OUT_MODULES): the system packages of a target, as lines for the
# CMake package and as a list for pkg-config. Only a static library needs them: where there is a
# shared one, too, whoever links that does without.
function(relief_packages target out_finds out_modules)
  set(finds "")
  set(modules "")
  set(is_needed QUIET)
  if(RELIEF_LIBRARIES STREQUAL "static")
    set(is_needed REQUIRED)
  endif()
  get_target_property(names ${target} RELIEF_PACKAGES)
  if(names)
    foreach(name IN LISTS names)
      get_target_property(package ${target} RELIEF_PACKAGES_${name})
      string(REPLACE ">=" " >= " needs "${package}")
      list(APPEND modules ${needs})
      list(JOIN package " " words)
      string(APPEND finds "  pkg_check_modules(${name} ${is_needed} IMPORTED_TARGET GLOBAL ${words})\n")
    endforeach()
  endif()
  list(JOIN modules " " modules)
  string(STRIP "${modules}" modules)
  set(${out_finds} "${finds}" PARENT_SCOPE)
  set(${out_modules} "${modules}" PARENT_SCOPE)
endfunction()

# ---- libraries and headers -----------------------------------------------------------------------
# relief_install(TARGET): its libraries with their part of the CMake package.
function(relief_install target)
  list(TRANSFORM relief_kinds PREPEND ${target}_ OUTPUT_VARIABLE libraries)
  install(TARGETS ${libraries} EXPORT ${target}_targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT ${target}_targets NAMESPACE relief:: FILE ${target}_targets.cmake
          DESTINATION ${relief_package_folder})
endfunction()

list(GET relief_kinds 0 relief_kind)
set(relief_absent_headers io.h gl.h window.h)
relief_install(relief)
relief_pkg_config(relief "" "" "-lm -lpthread" "Virtual things touch what a depth camera sees: the core")
foreach(component sim io gl window)
  if(NOT TARGET relief_${component})
    continue()
  endif()
  list(REMOVE_ITEM relief_absent_headers ${component}.h)
  relief_install(relief_${component})
  relief_packages(relief_${component} relief_finds modules)
  # The libraries of Relief that it needs beside the core.
  set(own "")
  get_target_property(libraries relief_${component} LINK_LIBRARIES)
  foreach(needed sim io gl)
    if(relief_${needed} IN_LIST libraries)
      list(APPEND own relief_${needed})
      string(APPEND relief_finds "include(\"\${CMAKE_CURRENT_LIST_DIR}/relief_${needed}.cmake\")\n")
    endif()
  endforeach()
  list(PREPEND own relief)
  configure_file(cmake/relief_component.cmake.in
                 ${PROJECT_BINARY_DIR}/relief_${component}.cmake @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/relief_${component}.cmake
          DESTINATION ${relief_package_folder})
  get_target_property(libs relief_${component} RELIEF_LIBS)
  if(NOT libs)
    set(libs "")
  endif()
  list(JOIN libs " " libs)
  relief_pkg_config(relief_${component} "${own}" "${modules}" "${libs}" "Relief, component ${component}")
endforeach()

set(exclude "")
foreach(header IN LISTS relief_absent_headers)
  list(APPEND exclude PATTERN ${header} EXCLUDE)
endforeach()
install(DIRECTORY include/relief DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${exclude})

# ---- the CMake package: named so that find_package(relief) and find_package(Relief) find it ---------
configure_package_config_file(cmake/relief-config.cmake.in ${PROJECT_BINARY_DIR}/relief-config.cmake
                              INSTALL_DESTINATION ${relief_package_folder}
                              NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/relief-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/relief-config.cmake
              ${PROJECT_BINARY_DIR}/relief-config-version.cmake
        DESTINATION ${relief_package_folder})

# ---- the command ---------------------------------------------------------------------------------
if(TARGET relief_app)
  set(rpath "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/relief")
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(rpath ${CMAKE_INSTALL_FULL_LIBDIR}/relief)
  endif()
  set_target_properties(relief_app PROPERTIES INSTALL_RPATH "${rpath}")
  install(TARGETS relief_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY scenes clips DESTINATION ${CMAKE_INSTALL_DATADIR}/relief)
endif()
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
