# A toolchain file for Debian's cross compilers; script/portable uses it:
# -DCMAKE_TOOLCHAIN_FILE=cmake/DebianCross.cmake -DRELIEF_TARGET=aarch64-linux-gnu -DRELIEF_SYSROOT=DIR
# RELIEF_TARGET is the compiler's prefix. RELIEF_SYSROOT holds the target's libraries: its Debian
# packages unpacked, or for Windows what was built from Debian's sources.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES RELIEF_TARGET RELIEF_SYSROOT)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${RELIEF_TARGET})
set(sysroot_libraries ${RELIEF_SYSROOT}/usr/lib/${RELIEF_TARGET})

if(RELIEF_TARGET MATCHES "mingw32$")
  set(CMAKE_SYSTEM_NAME Windows)
  set(CMAKE_C_COMPILER ${RELIEF_TARGET}-gcc-posix) # with pthreads
  set(CMAKE_RC_COMPILER ${RELIEF_TARGET}-windres)
  set(sysroot_libraries ${RELIEF_SYSROOT}/usr/lib)
  # One file that runs on any Windows.
  set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
  set(CMAKE_FIND_ROOT_PATH ${RELIEF_SYSROOT}/usr /usr/${RELIEF_TARGET})
  set(CMAKE_CROSSCOMPILING_EMULATOR /usr/lib/wine/wine64)
else()
  set(CMAKE_SYSTEM_NAME Linux)
  set(CMAKE_C_COMPILER ${RELIEF_TARGET}-gcc)
  set(CMAKE_SYSROOT ${RELIEF_SYSROOT})
  if(RELIEF_TARGET MATCHES "^i686") # an amd64 runs this itself
    set(sysroot_libraries ${RELIEF_SYSROOT}/usr/lib/i386-linux-gnu)
    set(CMAKE_CROSSCOMPILING_EMULATOR ${RELIEF_SYSROOT}/lib/ld-linux.so.2 --library-path
        ${sysroot_libraries}:${RELIEF_SYSROOT}/lib/i386-linux-gnu)
  elseif(RELIEF_TARGET MATCHES "^arm-") # gcc leaves floats to the VFP: NEON here flushes subnormals
    set(CMAKE_CROSSCOMPILING_EMULATOR qemu-arm -L ${RELIEF_SYSROOT})
  else()
    set(CMAKE_CROSSCOMPILING_EMULATOR qemu-${CMAKE_SYSTEM_PROCESSOR} -L ${RELIEF_SYSROOT})
  endif()
endif()

foreach(what LIBRARY INCLUDE PACKAGE)
  set(CMAKE_FIND_ROOT_PATH_MODE_${what} ONLY)
endforeach()
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# pkg-config reads this where CMake runs it: nothing of the machine that builds is found.
set(ENV{PKG_CONFIG_LIBDIR} ${sysroot_libraries}/pkgconfig:${RELIEF_SYSROOT}/usr/share/pkgconfig)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${RELIEF_SYSROOT})
