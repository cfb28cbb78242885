/* A view of analytic surfaces as a sensor sees them, and the surface stage on it. */
#ifndef RLF_TEST_SEEN_VIEW_H
#define RLF_TEST_SEEN_VIEW_H

#include "analytic.h"
#include "test.h"

static inline rlf_reconstruct *stage_of(const rlf_reconstruct_def *def)
{
    rlf_reconstruct *stage = NULL;
    assert_int_equal(rlf_reconstruct_create(def, &stage), RLF_OK);
    return stage;
}

/* The stage's surface of a frame. */
static inline const rlf_surface *surface_of(rlf_reconstruct *stage, const rlf_frame *frame)
{
    const rlf_surface *surface = NULL;
    assert_int_equal(rlf_reconstruct_process(stage, frame, &surface), RLF_OK);
    return surface;
}

typedef struct seen_view {
    rlf_rig rig;
    int32_t count; /* pixels */
    float *ray_x, *ray_y;
    float *truth, *seen; /* depth, metres */
    analytic_random random;
} seen_view;

static inline void seen_view_create(seen_view *v, rlf_rig rig, uint64_t seed)
{
    *v = (seen_view){.rig = rig, .count = rig.depth.width * rig.depth.height, .random = {seed}};
    analytic_rays(&v->rig.depth, &v->ray_x, &v->ray_y);
    v->truth = rlf_alloc_array((size_t)v->count, sizeof(float));
    v->seen = rlf_alloc_array((size_t)v->count, sizeof(float));
}

/* A group's tear-down, with the view as its state. */
static inline int seen_view_destroy(void **state)
{
    seen_view *v = *state;
    float *const parts[4] = {v->ray_x, v->ray_y, v->truth, v->seen};
    for (int i = 0; i < 4; i++) {
        rlf_free(parts[i]);
    }
    return 0;
}

/* Depth with the rig's noise. */
static inline float seen_view_noisy(seen_view *v, float z)
{
    double sigma = rlf_depth_noise_sigma(&v->rig.noise, z);
    return z + (float)(sigma * random_normal(&v->random));
}

/* The stage's surface of a depth image, metres. */
static inline const rlf_surface *seen_depth_process(const rlf_rig *rig, const float *depth,
                                                    rlf_reconstruct *stage, int32_t number)
{
    rlf_frame frame = analytic_frame(rig, depth, number);
    return surface_of(stage, &frame);
}

/* The stage's surface of what is seen. */
static inline const rlf_surface *seen_view_process(const seen_view *v, rlf_reconstruct *stage,
                                                   int32_t number)
{
    return seen_depth_process(&v->rig, v->seen, stage, number);
}

/* A view with its stage, the state of a group of tests. */
typedef struct staged_view {
    seen_view view;
    float *back; /* where rays leave what is looked at, metres; 0 = they miss it */
    rlf_reconstruct *stage;
} staged_view;

static inline void staged_view_create(staged_view *s, const rlf_reconstruct_def *def, uint64_t seed)
{
    seen_view_create(&s->view, def->rig, seed);
    s->back = rlf_alloc_array((size_t)s->view.count, sizeof(float));
    s->stage = stage_of(def);
}

/* A group's tear-down. */
static inline int staged_view_destroy(void **state)
{
    staged_view *s = *state;
    void *view = &s->view;
    rlf_free(s->back);
    rlf_reconstruct_destroy(&s->stage);
    return seen_view_destroy(&view);
}

#endif
