/* Parts of the registered depth: what is far apart stays apart, and holds what the whole would. */

#include "environment/real_depth.h"
#include "render_scene.h"
#include "test.h"

#define NEAREST_M 2.0

TEST_CASE(windows_that_meet_grow_together)
{
    const pixel_rect given[3] = {{0, 0, 100, 80}, {400, 0, 500, 80}, {90, 70, 200, 150}};
    real_windows windows = {.count = 0};
    for (int i = 0; i < 3; i++) {
        real_windows_add(&windows, &given[i]);
    }
    const pixel_rect both = {0, 0, 200, 150};
    assert_int_equal(windows.count, 2);
    assert_memory_equal(&windows.window[0], &both, sizeof(both));
    assert_memory_equal(&windows.window[1], &given[1], sizeof(both));
}

TEST_CASE(there_are_never_too_many)
{
    real_windows windows = {.count = 0};
    for (int i = 0; i < 2 * REAL_WINDOWS_MOST; i++) {
        const pixel_rect one = {50 * i, 0, 50 * i + 20, 20};
        real_windows_add(&windows, &one);
    }
    assert_int_equal(windows.count, REAL_WINDOWS_MOST);
    assert_int_equal(windows.window[REAL_WINDOWS_MOST - 1].x0, 50 * (REAL_WINDOWS_MOST - 1));
    assert_int_equal(windows.window[REAL_WINDOWS_MOST - 1].x1,
                     50 * (2 * REAL_WINDOWS_MOST - 1) + 20);
}

static float *plane_of(const rlf_camera *camera, rlf_plane_f32 *out)
{
    float *data = calloc((size_t)camera->width * (size_t)camera->height, sizeof(*data));
    *out = (rlf_plane_f32){data, camera->width, camera->height,
                           camera->width * (ptrdiff_t)sizeof(*data)};
    return data;
}

/* A wall with a strip before it: registered whole, and in windows `gap` pixels apart. Returns how
 * many windows were left. */
static int32_t compare_to_whole(int32_t gap)
{
    render_scene *s = scene_make(3.0);
    rlf_registration *registration = NULL;
    rlf_plane_f32 whole, parts;
    real_windows windows = {{{300, 100, 420, 300}, {420 + gap, 150, 700, 400}}, 2};
    scene_add_strip(s, 220, 280, NEAREST_M);
    assert_int_equal(rlf_registration_create(&s->grid, s->ray_x, s->ray_y, &s->rig.color,
                                             &s->rig.T_color_depth, &registration),
                     RLF_OK);
    float *all = plane_of(&s->rig.color, &whole);
    float *some = plane_of(&s->rig.color, &parts);
    const rlf_plane_u8 no_state = {NULL, whole.width, whole.height, whole.width};
    const pixel_rect everything = {0, 0, whole.width, whole.height};
    registration_apply_window(registration, s->planes[PLANE_DEPTH], &everything, 0.0, &whole,
                              &no_state);
    real_windows_join(&windows, registration, NEAREST_M);
    for (int32_t i = 0; i < windows.count; i++) {
        registration_apply_window(registration, s->planes[PLANE_DEPTH], &windows.window[i],
                                  NEAREST_M, &parts, &no_state);
    }
    for (int32_t i = 0; i < windows.count; i++) {
        const pixel_rect *w = &windows.window[i];
        for (int32_t y = w->y0; y < w->y1; y++) {
            assert_memory_equal(rlf_f32_row(&parts, y) + w->x0, rlf_f32_row(&whole, y) + w->x0,
                                (size_t)(w->x1 - w->x0) * sizeof(float));
        }
    }
    rlf_registration_destroy(&registration);
    free(all);
    free(some);
    scene_free(s);
    return windows.count;
}

TEST_CASE(windows_hold_what_the_whole_would)
{
    assert_int_equal(compare_to_whole(150), 2);
    assert_int_equal(compare_to_whole(10), 1); /* one is drawn into what the other needs */
}
