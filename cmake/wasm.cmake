# WebAssembly by clang, lld and wasi-libc as Debian has them, without emscripten: the preset wasm.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_SYSROOT /usr) # Debian's wasi-libc lies in /usr/{include,lib}/wasm32-wasi
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
# One thread, so that nothing is local to one: web/core/include has a pthread.h that says so.
set(CMAKE_HAVE_LIBC_PTHREAD TRUE)
set(CMAKE_C_FLAGS_INIT "-msimd128 -mbulk-memory -D_Thread_local= -isystem ${CMAKE_CURRENT_LIST_DIR}/../web/core/include")
