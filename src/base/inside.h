/* What librelief_gl uses of librelief beside the public API. It is shown by the libraries, too, but
 * under a prefix, so that it stays clear of names in a user's program. Not for users: it may change
 * with every version. */
#ifndef RLF_BASE_INSIDE_H
#define RLF_BASE_INSIDE_H

#include "relief/base.h"

/* Ends the prototype of such a function: void f(int x) RLF_INSIDE(f); */
#define RLF_INSIDE(name) __asm__("rlf_inside_" #name) RLF_API

#endif
