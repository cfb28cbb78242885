/* Pipelines in several threads at once: none knows of the others. The thread sanitizer's build runs
 * this as well. */
#include "golden_hash.h"
#include "test.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#define THREADS 3
#define WORKERS 2 /* of each thread's own pool */
#define FRAMES 3

typedef struct replay {
    rlf_profile profile;
    golden result;
    bool keeps_error; /* of its own thread, whatever the others say */
    pthread_t thread;
} replay;

static void *run(void *argument)
{
    replay *r = argument;
    char line[64];
    snprintf(line, sizeof(line), "the line of %p", (void *)r);
    (void)rlf_fail(RLF_ERROR_INVALID, "%s", line);
    r->result = golden_replay(r->profile, WORKERS, FRAMES, 1);
    r->keeps_error = strcmp(rlf_error_text(), line) == 0;
    return NULL;
}

static bool is_same(const golden *a, const golden *b)
{
    return a->surface == b->surface && a->world == b->world && a->picture == b->picture;
}

TEST_CASE(pipelines_do_not_disturb_each_other)
{
    replay replays[THREADS] = {{.profile = RLF_PROFILE_LIVE},
                               {.profile = RLF_PROFILE_THESIS},
                               {.profile = RLF_PROFILE_LIVE}};
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_create(&replays[i].thread, NULL, run, &replays[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(replays[i].thread, NULL), 0);
        assert_true(replays[i].keeps_error);
    }
    const golden live = golden_replay(RLF_PROFILE_LIVE, 1, FRAMES, 1);
    const golden thesis = golden_replay(RLF_PROFILE_THESIS, 1, FRAMES, 1);
    assert_true(is_same(&replays[0].result, &live));
    assert_true(is_same(&replays[1].result, &thesis));
    assert_true(is_same(&replays[2].result, &live));
    assert_false(is_same(&live, &thesis));
}
