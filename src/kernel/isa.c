/* Which clone of the kernels the loader picks: the same questions in the same order. */
#include "kernel/kernel.h"

#include "relief/base.h"

const char *rlf_isa_name(void)
{
#ifdef RLF_KERNEL_HAS_CLONES
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v4")) {
        return "AVX-512 (x86-64-v4)";
    }
    if (__builtin_cpu_supports("avx2")) {
        return "AVX2";
    }
#endif
    return "portable";
}
