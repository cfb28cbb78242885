/* Opening a camera of a stub driver library. Include after cmocka.h. */
#ifndef RLF_TEST_STUB_SOURCE_H
#define RLF_TEST_STUB_SOURCE_H

#include "test.h"
#include "direct_source.h"
#include "stub_camera.h"

#include <string.h>

static inline rlf_source *stub_open(const char *source)
{
    rlf_source *s = NULL;
    rlf_result result = test_open_direct(source, &s);
    if (result != RLF_OK) {
        print_error("%s\n", rlf_error_text());
    }
    assert_int_equal(result, RLF_OK);
    return s;
}

static inline rlf_frame stub_next(rlf_source *s)
{
    rlf_frame frame;
    assert_int_equal(rlf_source_next(s, &frame), RLF_OK);
    return frame;
}

/* The source cannot be opened; the line has these words. */
static inline void stub_refuse(const char *source, rlf_result wanted, const char *word)
{
    rlf_source *s = NULL;
    assert_int_equal(test_open_direct(source, &s), wanted);
    assert_null(s);
    if (strstr(rlf_error_text(), word) == NULL) {
        fail_msg("\"%s\" does not mention \"%s\"", rlf_error_text(), word);
    }
}

/* Skips RLF_NO_FRAME; the first other answer. */
static inline rlf_result stub_answer(rlf_source *s, int waits_max)
{
    rlf_frame frame;
    rlf_result result = RLF_NO_FRAME;
    for (int i = 0; i < waits_max && result == RLF_NO_FRAME; i++) {
        result = rlf_source_next(s, &frame);
    }
    return result;
}

#endif
