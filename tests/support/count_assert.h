/* An assert handler that counts broken contracts: rlf_set_assert(count_assert, &count). */
#ifndef RLF_TESTS_COUNT_ASSERT_H
#define RLF_TESTS_COUNT_ASSERT_H

#include <stdbool.h>

/* context: int *, of how many there were. The call then does nothing. */
static bool count_assert(void *context, const char *condition, const char *file, int line)
{
    (void)condition;
    (void)file;
    (void)line;
    ++*(int *)context;
    return false;
}

#endif
