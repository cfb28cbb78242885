/* Opening a camera of a stub driver library. Include after cmocka.h. */
#ifndef RLF_TEST_STUB_SOURCE_H
#define RLF_TEST_STUB_SOURCE_H

#include "io/source/address.h"
#include "io/source/backends.h"
#include "io/source/find_backend.h"
#include "relief/io.h"
#include "stub_camera.h"

#include <string.h>

/* The back end itself: rlf_open_source would put a thread and the search for a lost camera between,
 * where moments cannot be told. */
static inline rlf_source *stub_open(const char *source)
{
    io_address parts;
    const rlf_backend *backend = NULL;
    rlf_opened opened;
    rlf_source *s = NULL;
    rlf_rig rig;
    rlf_address address = {.source = source};
    assert_int_equal(io_address_parse(source, &parts), RLF_OK);
    assert_int_equal(io_backend_find(source, &parts, &backend), RLF_OK);
    const char *camera = io_address_take(&parts, "camera");
    if (camera != NULL) {
        assert_int_equal(rlf_rig_load(camera, &rig, &address.units_per_metre), RLF_OK);
        address.rig = &rig;
    }
    address.place = parts.place;
    address.key_count = parts.key_count;
    for (int32_t i = 0; i < parts.key_count; i++) {
        address.keys[i] = parts.keys[i];
        address.values[i] = parts.values[i];
    }
    rlf_result result = backend->open(&address, &opened);
    if (result != RLF_OK) {
        print_error("%s\n", rlf_error_text());
    }
    assert_int_equal(result, RLF_OK);
    assert_int_equal(io_source_create(&opened, &s), RLF_OK);
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
    assert_int_equal(rlf_open_source(source, NULL, &s), wanted);
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
