# Installs libraries, headers, the command and the scenes, with a CMake package (relief::relief,
# relief::io, relief::gl) and pkg-config files (relief, relief_io, relief_gl).
include(CMakePackageConfigHelpers)

set(relief_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/relief)
set(relief_pc_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH relief_pc_to_prefix /prefix/${relief_pc_folder} /prefix)
string(REGEX REPLACE "/$" "" relief_pc_to_prefix "${relief_pc_to_prefix}")

# relief_pkg_config(NAME REQUIRES LIBS DESCRIPTION): writes NAME.pc. A static library hands its own
# needs on to whoever links it; a shared one keeps them to itself.
function(relief_pkg_config name requires libs description)
  set(private "")
  set(define "")
  if(BUILD_SHARED_LIBS)
    set(private ".private")
    set(define " -DRLF_SHARED")
  endif()
  set(base "")
  if(NOT name STREQUAL "relief")
    set(base "Requires: relief = ${PROJECT_VERSION}\n")
  endif()
  set(needs "")
  if(requires)
    set(needs "Requires${private}: ${requires}\n")
  endif()
  if(base AND needs AND NOT private)
    set(base "")
    set(needs "Requires: relief = ${PROJECT_VERSION} ${requires}\n")
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
    "Cflags: -I\${includedir}${define}\n")
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${relief_pc_folder})
endfunction()

# relief_packages(TARGET OUT_FINDS OUT_MODULES): the system packages of a target, as lines for the
# CMake package and as a list for pkg-config.
function(relief_packages target out_finds out_modules)
  set(finds "")
  set(modules "")
  get_target_property(names ${target} RELIEF_PACKAGES)
  if(names)
    foreach(name IN LISTS names)
      get_target_property(package ${target} RELIEF_PACKAGES_${name})
      string(REPLACE ">=" " >= " needs "${package}")
      list(APPEND modules ${needs})
      list(JOIN package " " words)
      string(APPEND finds "  pkg_check_modules(${name} REQUIRED IMPORTED_TARGET GLOBAL ${words})\n")
    endforeach()
  endif()
  list(JOIN modules " " modules)
  string(STRIP "${modules}" modules)
  set(${out_finds} "${finds}" PARENT_SCOPE)
  set(${out_modules} "${modules}" PARENT_SCOPE)
endfunction()

# ---- libraries and headers -----------------------------------------------------------------------
set(relief_libraries relief)
set(relief_absent_headers io.h gl.h)
set(relief_has_io NO)
set(relief_has_gl NO)
set(relief_io_finds "")
set(relief_gl_finds "")
relief_pkg_config(relief "" "-lm -lpthread" "Virtual things touch what a depth camera sees: the core")
foreach(component io gl)
  if(NOT TARGET relief_${component})
    continue()
  endif()
  list(APPEND relief_libraries relief_${component})
  list(REMOVE_ITEM relief_absent_headers ${component}.h)
  set(relief_has_${component} YES)
  set_target_properties(relief_${component} PROPERTIES EXPORT_NAME ${component})
  relief_packages(relief_${component} relief_${component}_finds modules)
  get_target_property(libs relief_${component} RELIEF_LIBS)
  if(NOT libs)
    set(libs "")
  endif()
  list(JOIN libs " " libs)
  relief_pkg_config(relief_${component} "${modules}" "${libs}" "Relief, component ${component}")
endforeach()
if(BUILD_SHARED_LIBS)
  foreach(library IN LISTS relief_libraries)
    target_compile_definitions(${library} PUBLIC RLF_SHARED)
    set_target_properties(${library} PROPERTIES INSTALL_RPATH "$ORIGIN")
  endforeach()
endif()

install(TARGETS ${relief_libraries} EXPORT relief_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
set(exclude "")
foreach(header IN LISTS relief_absent_headers)
  list(APPEND exclude PATTERN ${header} EXCLUDE)
endforeach()
install(DIRECTORY include/relief DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${exclude})

# ---- the CMake package ---------------------------------------------------------------------------
install(EXPORT relief_targets NAMESPACE relief:: FILE reliefTargets.cmake
        DESTINATION ${relief_package_folder})
configure_package_config_file(cmake/reliefConfig.cmake.in ${PROJECT_BINARY_DIR}/reliefConfig.cmake
                              INSTALL_DESTINATION ${relief_package_folder}
                              NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/reliefConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/reliefConfig.cmake
              ${PROJECT_BINARY_DIR}/reliefConfigVersion.cmake
        DESTINATION ${relief_package_folder})

# ---- the command ---------------------------------------------------------------------------------
if(TARGET relief_app)
  set_target_properties(relief_app PROPERTIES
                        INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS relief_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY scenes clips DESTINATION ${CMAKE_INSTALL_DATADIR}/relief)
endif()
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
