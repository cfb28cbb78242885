/* Which way is up, in analytic rooms seen by tilted and rolled cameras. */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "analytic.h"

#define WIDTH 160
#define HEIGHT 120
#define COUNT (WIDTH * HEIGHT)
#define RAD (RLF_PI / 180.0)

typedef struct room_view {
    float depth[COUNT], nx[COUNT], ny[COUNT], nz[COUNT], ray_x[COUNT], ray_y[COUNT];
    rlf_surface surface;
} room_view;

typedef struct plane {
    rlf_vec3 n; /* unit, into the room, level frame */
    double d;   /* n.p = d */
} plane;

/* Floor 1.4 m under the camera, ceiling, side walls and the wall ahead. */
static const plane room[5] = {{{0, -1, 0}, -1.4},
                              {{0, 1, 0}, -1.1},
                              {{1, 0, 0}, -1.8},
                              {{-1, 0, 0}, -2.2},
                              {{0, 0, -1}, -3.5}};

/* From the level frame into that of a camera that looks down and is rolled. */
static rlf_quat camera_turn(double down_deg, double roll_deg)
{
    rlf_quat pitch = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), down_deg * RAD);
    rlf_quat roll = rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), roll_deg * RAD);
    return rlf_quat_mul(roll, pitch);
}

/* The nearest of the planes before each pixel, with `noise` on each normal's parts. */
static void look(room_view *v, const plane *planes, int32_t count, rlf_quat turn, double noise)
{
    analytic_random random = {7};
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_vec3 ray = {((i % WIDTH) - 79.5) / 114.0, ((i / WIDTH) - 59.5) / 114.0, 1.0};
        double best = 1e9;
        rlf_vec3 normal = {0, 0, 0};
        for (int32_t k = 0; k < count; k++) {
            rlf_vec3 n = rlf_rotate(turn, planes[k].n);
            double z = planes[k].d / rlf_dot(n, ray);
            if (z > 0.0 && z < best) {
                best = z;
                rlf_vec3 e = {noise * random_normal(&random), noise * random_normal(&random),
                              noise * random_normal(&random)};
                normal = rlf_normalize(rlf_add(n, e));
            }
        }
        v->depth[i] = best < 8.0 ? (float)best : 0.0f;
        normal = best < 8.0 ? normal : rlf_vec3_make(0, 0, 0);
        v->nx[i] = (float)normal.x;
        v->ny[i] = (float)normal.y;
        v->nz[i] = (float)normal.z;
        v->ray_x[i] = (float)ray.x;
        v->ray_y[i] = (float)ray.y;
    }
    v->surface = (rlf_surface){.width = WIDTH,
                               .height = HEIGHT,
                               .depth = v->depth,
                               .normal_x = v->nx,
                               .normal_y = v->ny,
                               .normal_z = v->nz,
                               .ray_x = v->ray_x,
                               .ray_y = v->ray_y};
}

/* Degrees between what is found and the truth; 180 when nothing is. */
static double error_of(const room_view *v, rlf_quat turn)
{
    rlf_vec3 up;
    if (!rlf_surface_find_up(&v->surface, &up)) {
        assert_true(up.x == 0.0 && up.y == -1.0 && up.z == 0.0);
        return 180.0;
    }
    rlf_vec3 truth = rlf_rotate(turn, rlf_vec3_make(0, -1, 0));
    return rlf_acos(rlf_clamp(rlf_dot(up, truth), -1.0, 1.0)) / RAD;
}

static room_view view;

static void a_room_is_found_from_any_usual_camera(void **state)
{
    (void)state;
    for (double down = -15.0; down <= 50.0; down += 5.0) {
        for (double roll = -20.0; roll <= 20.0; roll += 10.0) {
            rlf_quat turn = camera_turn(down, roll);
            look(&view, room, 5, turn, 0.05);
            assert_true(error_of(&view, turn) < 0.3); /* at -15 by a few normals of the ceiling */
        }
    }
}

static void a_table_alone_is_enough(void **state)
{
    (void)state;
    for (double down = 10.0; down <= 60.0; down += 10.0) {
        rlf_quat turn = camera_turn(down, 5.0);
        look(&view, room, 1, turn, 0.05);
        assert_true(error_of(&view, turn) < 0.1);
    }
}

/* The wall ahead has most of the picture; the floor is a strip. */
static void a_wall_is_no_floor(void **state)
{
    (void)state;
    const plane near_wall[2] = {room[0], room[4]};
    rlf_quat turn = camera_turn(0.0, 3.0);
    look(&view, near_wall, 2, turn, 0.05);
    assert_true(error_of(&view, turn) < 0.1);
}

static void what_tells_nothing_is_told_so(void **state)
{
    (void)state;
    look(&view, &room[4], 1, camera_turn(0.0, 0.0), 0.05); /* one wall, frontal */
    assert_true(error_of(&view, camera_turn(0.0, 0.0)) == 180.0);
    look(&view, room, 0, camera_turn(0.0, 0.0), 0.0); /* nothing at all */
    assert_true(error_of(&view, camera_turn(0.0, 0.0)) == 180.0);
    look(&view, room, 5, camera_turn(85.0, 0.0), 0.05); /* straight down: a floor or a wall? */
    assert_true(error_of(&view, camera_turn(85.0, 0.0)) == 180.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_room_is_found_from_any_usual_camera),
        cmocka_unit_test(a_table_alone_is_enough),
        cmocka_unit_test(a_wall_is_no_floor),
        cmocka_unit_test(what_tells_nothing_is_told_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
