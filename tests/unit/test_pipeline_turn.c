/* The frame loop where geometry does not tell all of a camera's pose. It turns in place before
 * walls and boxes without colour: when the wall beside it has left the view, outlines alone seem to
 * tell how far it slides along the other. Or it stands before one bare wall. */
#include "relief/map.h"

#include "relief/pipeline.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 240, FRAMES = 26 };

typedef struct turning {
    uint16_t depth[WIDTH * HEIGHT];
    rlf_camera camera;
    int64_t frame;
    bool is_bare; /* a wall without end ahead; the camera stands */
} turning;

static turning room;

static double to_box(const rlf_aabb *box, rlf_vec3 way)
{
    const double w[3] = {way.x, way.y, way.z};
    const double low[3] = {box->min.x, box->min.y, box->min.z};
    const double high[3] = {box->max.x, box->max.y, box->max.z};
    double in = 0.0, out = 1e9;
    for (int k = 0; k < 3; k++) {
        const double by = fabs(w[k]) > 1e-12 ? w[k] : 1e-12;
        in = fmax(in, fmin(low[k] / by, high[k] / by));
        out = fmin(out, fmax(low[k] / by, high[k] / by));
    }
    return in < out ? in : 1e9;
}

/* From the camera, which is the origin: a wall ahead, one to the left, the floor and boxes. */
static double to_room(rlf_vec3 way)
{
    static const rlf_aabb boxes[] = {
        {{-0.8, 0.35, 1.9}, {-0.4, 0.6, 2.3}},
        {{0.1, 0.2, 1.6}, {0.6, 0.6, 2.0}},
        {{-0.2, -0.1, 2.6}, {0.0, 0.6, 2.8}},
    };
    double t = way.z > 0.0 ? 3.0 / way.z : 1e9;
    t = way.x < 0.0 ? fmin(t, -1.5 / way.x) : t;
    t = way.y > 0.0 ? fmin(t, 0.6 / way.y) : t;
    for (int k = 0; k < 3; k++) {
        t = fmin(t, to_box(&boxes[k], way));
    }
    return t;
}

static rlf_result next(void *self, rlf_frame *out)
{
    turning *s = self;
    if (s->frame == FRAMES) {
        return RLF_END;
    }
    const double turn = s->is_bare ? 0.0 : (double)s->frame * RLF_PI / 180.0;
    const rlf_quat q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.0, turn, 0.0));
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&s->camera, i % WIDTH, i / WIDTH, &ray);
        const double away = s->is_bare ? 2.0 : to_room(rlf_rotate(q, ray));
        s->depth[i] = (uint16_t)(1000.0 * away + 0.5);
    }
    *out = (rlf_frame){.sequence = (uint64_t)s->frame,
                       .time_ns = s->frame * 33333333,
                       .depth_u16 = s->depth,
                       .depth_stride = WIDTH * sizeof(uint16_t),
                       .depth_units_per_metre = 1000};
    s->frame++;
    return RLF_OK;
}

static rlf_source *open_room(bool is_bare)
{
    rlf_source_info info = {.frame_count = FRAMES, .frames_per_second = 30};
    strcpy(info.name, "turn");
    info.rig.depth = (rlf_camera){
        .width = WIDTH, .height = HEIGHT, .fx = 280, .fy = 280, .cx = 159.5, .cy = 119.5};
    info.rig.T_color_depth = rlf_pose_identity();
    info.rig.depth_min_m = 0.3;
    info.rig.depth_max_m = 8.0;
    info.rig.noise = (rlf_depth_noise){0.0008, 0.0, 0.0012};
    room = (turning){.camera = info.rig.depth, .is_bare = is_bare};
    const rlf_source_methods methods = {.next = next};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &room, &source), RLF_OK);
    return source;
}

/* How far the camera strays at most; it is told to move from `out_from` on. */
static double find_stray(rlf_camera_mode camera, int64_t *out_from)
{
    rlf_source *source = open_room(false);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.enable_render = false;
    def.camera = camera;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output out;
    double stray = 0.0;
    *out_from = FRAMES;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        stray = fmax(stray, rlf_length(out.T_world_camera.p));
        *out_from = out.track != NULL && out.frame_index < *out_from ? out.frame_index : *out_from;
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return stray;
}

static void a_camera_that_stood_stays_in_place_while_it_turns(void **state)
{
    (void)state;
    int64_t from;
    const double stray = find_stray(RLF_CAMERA_AUTO, &from);
    print_message("%.1f mm, tracked from frame %d\n", 1000.0 * stray, (int)from);
    assert_true(from < 10);
    assert_true(stray < 0.02);
}

static void a_camera_that_moves_stays_in_place_while_it_turns(void **state)
{
    (void)state;
    int64_t from;
    const double stray = find_stray(RLF_CAMERA_MOVING, &from);
    print_message("%.1f mm\n", 1000.0 * stray);
    assert_int_equal(from, 0);
    assert_true(stray < 0.02);
}

/* No direction along the wall is determined, but the camera moves along none. */
static void a_camera_that_stands_before_a_bare_wall_makes_its_mesh(void **state)
{
    (void)state;
    rlf_source *source = open_room(true);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.enable_render = false;
    def.camera = RLF_CAMERA_MOVING;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output out;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        assert_true(out.track->health == (out.frame_index == 0 ? RLF_TRACK_GOOD : RLF_TRACK_WEAK));
        assert_true(rlf_length(out.T_world_camera.p) == 0.0);
    }
    rlf_map_mesh mesh;
    assert_int_equal(rlf_map_mesh_create(rlf_pipeline_get_map(pipeline), 8, &mesh), RLF_OK);
    print_message("%zu triangles\n", mesh.triangle_count);
    assert_true(mesh.triangle_count > 1000);
    rlf_map_mesh_destroy(&mesh);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_camera_that_stood_stays_in_place_while_it_turns),
        cmocka_unit_test(a_camera_that_moves_stays_in_place_while_it_turns),
        cmocka_unit_test(a_camera_that_stands_before_a_bare_wall_makes_its_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
