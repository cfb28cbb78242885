/* Two pipelines of one world: cameras that face each other across a room with a board between
 * them. Bodies meet what either sees, and each picture hides what its own camera cannot see. */
#include "created.h"
#include "pinhole.h"
#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 320
#define HEIGHT 240
#define FOCAL 220.0
#define APART 4.0
#define FRONT 1.9 /* of the board, from the first camera */
#define BACK 2.1
#define HALF_WIDE 0.5
#define FLOOR 1.0   /* below both */
#define BOTTOM 0.95 /* of the board */
#define FRAMES 90

typedef struct eye {
    rlf_pipeline *pipeline;
    uint16_t depth[WIDTH * HEIGHT]; /* mm */
    rlf_frame frame;
    rlf_pipeline_output out;
} eye;

static rlf_rig rig(void)
{
    rlf_rig out = rlf_rig_default();
    out.depth = pinhole(WIDTH, HEIGHT, FOCAL);
    return out;
}

/* What a camera sees whose side of the board is so far away: the board, the floor, a wall. */
static void draw(eye *e, double board)
{
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double x = (i % WIDTH - 0.5 * (WIDTH - 1)) / FOCAL;
        const double y = (i / WIDTH - 0.5 * (HEIGHT - 1)) / FOCAL;
        double z = APART + 1.0;
        z = y > 0.0 ? rlf_min(z, FLOOR / y) : z;
        if (fabs(x) * board < HALF_WIDE && y * board < BOTTOM) {
            z = rlf_min(z, board);
        }
        e->depth[i] = (uint16_t)(1000.0 * z + 0.5);
    }
}

static void open_eye(eye *e, const rlf_pose *T_world, rlf_pipeline *joins, const rlf_scene *scene)
{
    const rlf_rig cameras = rig();
    rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &cameras, NULL);
    def.world.camera_capacity = 2;
    def.T_world_camera = *T_world;
    def.joins = joins;
    def.scene = scene;
    e->pipeline = pipeline_of(&def);
    e->frame = (rlf_frame){.depth_u16 = e->depth,
                           .depth_stride = WIDTH * sizeof(uint16_t),
                           .depth_units_per_metre = 1000};
}

static void see(eye *e, int32_t k)
{
    e->frame.time_ns = k * INT64_C(33333333);
    e->frame.sequence = (uint64_t)k;
    assert_int_equal(rlf_pipeline_push(e->pipeline, &e->frame, &e->out), RLF_OK);
}

static rlf_body_def ball(rlf_vec3 position, rlf_vec3 velocity)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = RLF_SHAPE_SPHERE;
    def.shape.radius = 0.06;
    def.position = position;
    def.velocity = velocity;
    def.release_time = 1.0; /* both have learned the room */
    return def;
}

static const rlf_pose near_pose = {{0, 0, 0}, {0, 0, 0, 1}};
static const rlf_pose far_pose = {{0, 0, APART}, {0, 1, 0, 0}}; /* turned about the y axis */

/* The body's least z, and its last place. */
static rlf_vec3 play(rlf_body_def *body, bool with_both, double *least_z, eye *first, eye *second)
{
    rlf_scene scene = {.gravity = {0, 9.81, 0}, .bodies = body, .body_count = 1};
    scene.border = RLF_BORDER_EXTEND;
    open_eye(first, &near_pose, NULL, &scene);
    open_eye(second, &far_pose, with_both ? first->pipeline : NULL, NULL);
    draw(first, FRONT);
    draw(second, APART - BACK);
    rlf_vec3 p = {0, 0, 0};
    *least_z = 9.0;
    for (int32_t k = 0; k < FRAMES; k++) {
        see(second, k);
        see(first, k);
        p = first->out.snapshot->bodies[0].T_world_body.p;
        *least_z = rlf_min(*least_z, p.z);
    }
    return p;
}

static void close_eyes(eye *first, eye *second)
{
    rlf_pipeline_destroy(&second->pipeline);
    rlf_pipeline_destroy(&first->pipeline);
}

static double shown(const eye *e)
{
    double sum = 0.0;
    const rlf_plane_u8 *matte = &e->out.render.matte;
    for (int32_t y = 0; y < matte->height; y++) {
        const uint8_t *row = rlf_u8_row(matte, y);
        for (int32_t x = 0; x < matte->width; x++) {
            sum += row[x] / 255.0;
        }
    }
    return sum;
}

static eye eyes[2];

TEST_CASE(a_crate_lies_where_one_camera_sees_the_floor)
{
    double least;
    const rlf_vec3 zero = {0, 0, 0};
    rlf_body_def body = ball(rlf_vec3_make(0.1, 0.5, 2.3), zero);
    body.shape.type = RLF_SHAPE_BOX; /* it does not roll */
    body.shape.size = rlf_vec3_make(0.12, 0.12, 0.12);
    body.restitution = 0.0;
    const rlf_vec3 p = play(&body, true, &least, &eyes[0], &eyes[1]);
    print_message("behind the board, on the floor: %.3f %.3f %.3f; %.0f pixels shown by the first, "
                  "%.0f by the second\n",
                  p.x, p.y, p.z, shown(&eyes[0]), shown(&eyes[1]));
    assert_float_equal(p.y, FLOOR - 0.06, 0.01);
    assert_float_equal(p.z, 2.3, 0.05);
    assert_true(shown(&eyes[0]) < 2.0);  /* the board hides it, */
    assert_true(shown(&eyes[1]) > 80.0); /* from the other side nothing does */
    close_eyes(&eyes[0], &eyes[1]);
}

TEST_CASE(a_ball_meets_the_back_that_is_seen)
{
    double least;
    rlf_body_def body = ball(rlf_vec3_make(0, 0.2, 3.0), rlf_vec3_make(0, -1, -2.5));
    (void)play(&body, true, &least, &eyes[0], &eyes[1]);
    print_message("thrown at the board's back at %.1f: turns round at %.3f\n", BACK, least - 0.06);
    assert_float_equal(least - 0.06, BACK, 0.09); /* 2.5 m/s between two frames */
    close_eyes(&eyes[0], &eyes[1]);
}

/* Frames that a recording of so many frames a second gives beside one of 30, for a second; and
 * after a restart. */
static uint64_t frames_beside(double rate, uint64_t *out_again)
{
    rlf_source *sources[2] = {NULL, NULL};
    rlf_pipeline *pipelines[2] = {NULL, NULL};
    for (int32_t k = 0; k < 2; k++) {
        rlf_synthetic_def room = rlf_synthetic_def_default();
        room.scene = RLF_SYNTHETIC_EMPTY;
        room.enable_color = room.enable_truth = false;
        room.frames_per_second = k == 0 ? 30.0 : rate;
        sources[k] = synthetic_of(&room);
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, sources[k], NULL);
        def.enable_render = false;
        def.world.camera_capacity = 2;
        def.joins = pipelines[0];
        pipelines[k] = pipeline_of(&def);
    }
    rlf_pipeline_output out;
    for (int32_t k = 0; k < 31; k++) {
        assert_int_equal(rlf_pipeline_step(pipelines[0], &out), RLF_OK);
    }
    const uint64_t given = rlf_source_get_status(sources[1]).given;
    assert_int_equal(rlf_pipeline_restart(pipelines[0]), RLF_OK);
    assert_int_equal(rlf_pipeline_step(pipelines[0], &out), RLF_OK);
    *out_again = rlf_source_get_status(sources[1]).given - given;
    for (int32_t k = 1; k >= 0; k--) {
        rlf_pipeline_destroy(&pipelines[k]);
        rlf_source_destroy(&sources[k]);
    }
    return given;
}

TEST_CASE(recordings_keep_together)
{
    static const double rates[3] = {10.0, 30.0, 60.0};
    for (int k = 0; k < 3; k++) {
        uint64_t again;
        const uint64_t given = frames_beside(rates[k], &again);
        print_message("%.0f frames a second beside 30: %d in a second\n", rates[k], (int)given);
        assert_in_range(given, rates[k], rates[k] + 1);
        assert_int_equal(again, 1);
    }
}

TEST_CASE(what_cannot_join_is_told)
{
    const rlf_rig cameras = rig();
    rlf_pipeline_def def = rlf_pipeline_def_for_rig(RLF_PROFILE_LIVE, &cameras, NULL);
    rlf_pipeline *alone = NULL, *other = NULL;
    alone = pipeline_of(&def);
    def.joins = alone;
    assert_int_equal(rlf_pipeline_create(&def, &other), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "camera_capacity"));
    def.camera = RLF_CAMERA_AUTO;
    assert_int_equal(rlf_pipeline_create(&def, &other), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "joins"));
    rlf_pipeline_destroy(&alone);
}
