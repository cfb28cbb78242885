/* The library's version. */
#include "relief/base.h"

#define TEXT(number) TEXT_OF(number)
#define TEXT_OF(number) #number

const char *rlf_version(void)
{
    return TEXT(RLF_VERSION_MAJOR) "." TEXT(RLF_VERSION_MINOR) "." TEXT(RLF_VERSION_PATCH);
}
