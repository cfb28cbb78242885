/* A camera without the thread that watches it: every frame of its driver, in turn; or a file. */
#ifndef RLF_TEST_DIRECT_SOURCE_H
#define RLF_TEST_DIRECT_SOURCE_H

#include "relief/io.h"

#include <stdio.h>
#include <string.h>

static inline rlf_result test_open_direct(const char *source, rlf_source **out)
{
    char text[1024];
    (void)snprintf(text, sizeof(text), "%s%cdirect=1", source,
                   strchr(source, '?') != NULL ? '&' : '?');
    return rlf_open_source(strchr(source, ':') != NULL ? text : source, NULL, out);
}

#endif
