/* A depth picture that a test paints, and the surface stage that sees it: one of each in a test,
 * gone after it. TEST_EACH(NULL, stop_seeing). */
#ifndef RLF_TEST_PAINTED_H
#define RLF_TEST_PAINTED_H

#include "seen_view.h"

static rlf_rig rig;
static float depth[320 * 240]; /* metres, row by row */
static rlf_reconstruct *stage;
static int32_t frames_seen;

/* Of the live profile, for pictures of that size; what the test does not change holds. */
static inline rlf_reconstruct_def see_size(int32_t width, int32_t height)
{
    assert_true(width * height <= 320 * 240);
    rig = analytic_rig(width, height);
    return rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
}

/* Instead of what saw before. */
static inline void start_seeing(const rlf_reconstruct_def *def)
{
    rlf_reconstruct_destroy(&stage);
    stage = stage_of(def);
    frames_seen = 0;
}

static inline int stop_seeing(void **state)
{
    (void)state;
    rlf_reconstruct_destroy(&stage);
    return 0;
}

/* The picture as it is now is the next frame. */
static inline const rlf_surface *see(void)
{
    return seen_depth_process(&rig, depth, stage, frames_seen++);
}

static inline const rlf_surface *see_often(int32_t frames)
{
    const rlf_surface *s = NULL;
    for (int32_t t = 0; t < frames; t++) {
        s = see();
    }
    return s;
}

/* Pixels with x0 <= x < x1 and y0 <= y < y1. */
typedef struct area {
    int x0, x1, y0, y1;
} area;

static inline int size_of(area a)
{
    return (a.x1 - a.x0) * (a.y1 - a.y0);
}

static inline bool is_in(area a, int i)
{
    int x = i % rig.depth.width, y = i / rig.depth.width;
    return x >= a.x0 && x < a.x1 && y >= a.y0 && y < a.y1;
}

static inline void paint(area a, float z)
{
    for (int y = a.y0; y < a.y1; y++) {
        for (int x = a.x0; x < a.x1; x++) {
            depth[y * rig.depth.width + x] = z;
        }
    }
}

static inline void paint_all(float z)
{
    paint((area){0, rig.depth.width, 0, rig.depth.height}, z);
}

/* Pixels of the foreground there. */
static inline int count_front(const rlf_surface *s, area a)
{
    int count = 0;
    for (int y = a.y0; y < a.y1; y++) {
        for (int x = a.x0; x < a.x1; x++) {
            count += s->foreground[y * s->width + x];
        }
    }
    return count;
}

#endif
