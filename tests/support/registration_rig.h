/* A depth camera beside a colour camera, and the registration between them: one in a test, gone
 * after it. TEST_EACH(NULL, free_rig). */
#ifndef RLF_TEST_REGISTRATION_RIG_H
#define RLF_TEST_REGISTRATION_RIG_H

#include "test.h"
#include "relief/camera.h"

#include <stdlib.h>

static struct rig {
    rlf_camera depth, color;
    float *ray_x, *ray_y, *z; /* z: what the depth camera sees, metres */
    rlf_plane_f32 out;        /* as the colour camera sees it */
    rlf_plane_u8 state;
    rlf_registration *registration;
} g;

static inline int free_rig(void **state)
{
    (void)state;
    void *const parts[5] = {g.ray_x, g.ray_y, g.z, g.out.data, g.state.data};
    rlf_registration_destroy(&g.registration);
    assert_null(g.registration);
    for (int i = 0; i < 5; i++) {
        free(parts[i]);
    }
    g = (struct rig){.registration = NULL};
    return 0;
}

/* Instead of one that is there. */
static inline void make_rig(rlf_camera depth, rlf_camera color, rlf_pose T_color_depth)
{
    const size_t count = (size_t)depth.width * (size_t)depth.height;
    const size_t pixels = (size_t)color.width * (size_t)color.height;
    free_rig(NULL);
    g = (struct rig){.depth = depth, .color = color};
    g.ray_x = calloc(count, sizeof(float));
    g.ray_y = calloc(count, sizeof(float));
    g.z = calloc(count, sizeof(float));
    for (int32_t i = 0; i < depth.width * depth.height; i++) {
        rlf_vec3 ray;
        assert_true(rlf_camera_unproject(&depth, i % depth.width, i / depth.width, &ray));
        g.ray_x[i] = (float)ray.x;
        g.ray_y[i] = (float)ray.y;
    }
    g.out = (rlf_plane_f32){calloc(pixels, sizeof(float)), color.width, color.height,
                            color.width * (ptrdiff_t)sizeof(float)};
    g.state = (rlf_plane_u8){calloc(pixels, 1), color.width, color.height, color.width};
    assert_int_equal(rlf_registration_create(&g.depth, g.ray_x, g.ray_y, &g.color, &T_color_depth,
                                             &g.registration),
                     RLF_OK);
}

static inline void apply_rig(void)
{
    rlf_registration_apply(g.registration, g.z, &g.out, &g.state);
}

#endif
