/* The frame loop over a source of analytic frames: a floor seen from above. */

#include "relief/pipeline.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define WIDTH 160
#define HEIGHT 120
#define PLANE_MM 2000

/* Frames of a plane at 2 m, with a chosen time step and an end. */
typedef struct plane_source {
    uint16_t depth[WIDTH * HEIGHT];
    int64_t frame, frame_count, step_ns;
    int64_t jump_frame, jump_ns; /* this frame does not follow the one before: that much later */
    double silence_s;
    bool is_live;
} plane_source;

static rlf_result plane_next(void *self, rlf_frame *out)
{
    plane_source *s = self;
    if (s->frame == s->frame_count) {
        return RLF_END;
    }
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)s->frame;
    out->time_ns = s->frame * s->step_ns;
    if (s->jump_ns != 0 && s->frame >= s->jump_frame) {
        out->time_ns += s->jump_ns;
    }
    out->host_time_ns = s->is_live ? rlf_clock_ns() - 5000000 : 0;
    s->frame++;
    out->depth_u16 = s->depth;
    out->depth_stride = WIDTH * sizeof(uint16_t);
    out->depth_units_per_metre = 1000;
    return RLF_OK;
}

static rlf_result plane_restart(void *self)
{
    ((plane_source *)self)->frame = 0;
    return RLF_OK;
}

static void plane_status(void *self, rlf_source_status *out)
{
    out->silence_s = ((plane_source *)self)->silence_s;
}

static plane_source plane_memory;

static rlf_source *open_plane(int64_t frame_count, int64_t step_ns)
{
    plane_memory = (plane_source){.frame = 0};
    plane_memory.frame_count = frame_count;
    plane_memory.step_ns = step_ns;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        plane_memory.depth[i] = PLANE_MM;
    }
    rlf_source_info info;
    memset(&info, 0, sizeof(info));
    strcpy(info.name, "plane");
    info.rig.depth = (rlf_camera){
        .width = WIDTH, .height = HEIGHT, .fx = 120, .fy = 120, .cx = 79.5, .cy = 59.5};
    info.rig.T_color_depth = rlf_pose_identity();
    info.rig.depth_min_m = 0.3;
    info.rig.depth_max_m = 8.0;
    info.rig.noise = (rlf_depth_noise){0.001, 0.0, 0.001};
    info.frame_count = frame_count;
    info.frames_per_second = 30;
    const rlf_source_methods methods = {
        .next = plane_next, .restart = plane_restart, .status = plane_status};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &plane_memory, &source), RLF_OK);
    return source;
}

/* Gravity along z: the plane is the floor. A 0.2 m cube starts 0.5 m above it. */
static rlf_scene drop_scene(rlf_body_def *body)
{
    *body = rlf_body_def_default();
    body->shape.size = rlf_vec3_make(0.2, 0.2, 0.2);
    body->position = rlf_vec3_make(0, 0, 1.4);
    body->restitution = 0.0;
    rlf_scene scene = {.gravity = {0, 0, 9.81}, .bodies = body, .body_count = 1};
    return scene;
}

static rlf_pipeline *open_pipeline(rlf_source *source, rlf_profile profile, rlf_pool *pool)
{
    rlf_body_def body;
    rlf_scene scene = drop_scene(&body);
    rlf_pipeline_def def = rlf_pipeline_def_default(profile, source, pool);
    def.scene = &scene;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    return pipeline;
}

static void cube_comes_to_rest_on_the_plane(void **state)
{
    (void)state;
    rlf_source *source = open_plane(90, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    rlf_result result;
    while ((result = rlf_pipeline_step(pipeline, &out)) == RLF_OK) {
        assert_int_equal(out.surface->valid_count, WIDTH * HEIGHT);
        assert_non_null(out.render.image.data);
    }
    assert_int_equal(result, RLF_END);
    assert_int_equal(out.frame_index, 89);
    const rlf_body_state *body = &out.snapshot->bodies[0];
    assert_true(fabs(body->T_world_body.p.z - 1.9) < 0.005);
    assert_true(rlf_length(body->velocity) < 0.01);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

static uint64_t run_hash(rlf_profile profile, int32_t workers)
{
    rlf_pool *pool = NULL;
    assert_int_equal(rlf_pool_create(workers, &pool), RLF_OK);
    rlf_source *source = open_plane(30, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, profile, pool);
    rlf_pipeline_output out;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
    }
    uint64_t hash = rlf_world_hash(rlf_pipeline_get_world(pipeline));
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    rlf_pool_destroy(&pool);
    return hash;
}

static void results_do_not_depend_on_the_worker_count(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        uint64_t one = run_hash((rlf_profile)profile, 1);
        assert_true(one == run_hash((rlf_profile)profile, 2));
        assert_true(one == run_hash((rlf_profile)profile, 4));
    }
    assert_true(run_hash(RLF_PROFILE_LIVE, 1) != run_hash(RLF_PROFILE_THESIS, 1));
}

static void frames_allocate_nothing_after_the_first(void **state)
{
    (void)state;
    for (int profile = 0; profile < 2; profile++) {
        rlf_source *source = open_plane(40, 33333333);
        rlf_pipeline *pipeline = open_pipeline(source, (rlf_profile)profile, NULL);
        rlf_pipeline_output out;
        uint64_t after_warm_up = 0;
        while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
            if (out.frame_index == 9) {
                after_warm_up = rlf_alloc_count();
            }
        }
        assert_int_equal(rlf_alloc_count() - after_warm_up, 0);
        rlf_pipeline_destroy(&pipeline);
        rlf_source_destroy(&source);
    }
}

static void restart_repeats_the_run_exactly(void **state)
{
    (void)state;
    rlf_source *source = open_plane(20, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    uint64_t hashes[2];
    for (int run = 0; run < 2; run++) {
        while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        }
        hashes[run] = rlf_world_hash(rlf_pipeline_get_world(pipeline));
        assert_int_equal(rlf_pipeline_restart(pipeline), RLF_OK);
    }
    assert_true(hashes[0] == hashes[1]);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

static void frames_with_the_same_time_do_not_advance_physics(void **state)
{
    (void)state;
    rlf_source *source = open_plane(5, 0);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        assert_true(out.snapshot->bodies[0].T_world_body.p.z == 1.4);
        assert_true(out.time_s == 0.0);
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* The camera was gone for an hour while the cube fell: it falls on from where it was. */
static void a_frame_after_a_long_gap_does_not_advance_physics(void **state)
{
    (void)state;
    const int64_t jumps[2] = {INT64_C(3600000000000), -INT64_C(3600000000000)};
    for (int i = 0; i < 2; i++) {
        rlf_source *source = open_plane(90, 33333333);
        rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
        rlf_pipeline_output out;
        plane_memory.jump_frame = 5;
        plane_memory.jump_ns = jumps[i];
        rlf_vec3 before = {0, 0, 0};
        while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
            const rlf_vec3 p = out.snapshot->bodies[0].T_world_body.p;
            const double way = rlf_length(rlf_sub(p, before));
            assert_true(out.frame_index == 0 || way < 0.12);
            assert_true(out.frame_index != 5 || way == 0.0);
            assert_true(out.frame_index != 6 || way > 0.01);
            before = p;
        }
        assert_true(fabs(before.z - 1.9) < 0.005);
        rlf_pipeline_destroy(&pipeline);
        rlf_source_destroy(&source);
    }
}

/* The camera comes back nearer to the floor: the cube that lay there is lifted, not shot away. */
static void a_room_that_changed_meanwhile_pushes_gently(void **state)
{
    (void)state;
    rlf_source *source = open_plane(120, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    plane_memory.jump_frame = 60;
    plane_memory.jump_ns = INT64_C(3600000000000);
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        for (int i = 0; i < WIDTH * HEIGHT && out.frame_index == 59; i++) {
            plane_memory.depth[i] = PLANE_MM - 200;
        }
        assert_true(out.frame_index < 60 || rlf_length(out.snapshot->bodies[0].velocity) < 1.0);
    }
    assert_true(fabs(out.snapshot->bodies[0].T_world_body.p.z - 1.7) < 0.01);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

static void latency_and_silence_are_told(void **state)
{
    (void)state;
    rlf_source *source = open_plane(2, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    assert_true(out.latency_ms == 0.0); /* nobody knows when a file's frame came */
    plane_memory.is_live = true;
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    assert_true(out.latency_ms >= 5.0);
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
    assert_false(out.is_stale);
    plane_memory.silence_s = 1.5;
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
    assert_true(out.is_stale);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

static void redraw_shows_the_last_frame_in_another_view(void **state)
{
    (void)state;
    rlf_source *source = open_plane(3, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_NO_FRAME);
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
    }
    uint8_t before[4];
    memcpy(before, out.render.image.data, 4);
    rlf_pipeline_set_view(pipeline, RLF_VIEW_NORMALS);
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
    assert_memory_not_equal(before,
                            rlf_rgba8_row(&out.render.image, out.render.image.height / 2) +
                                4 * (out.render.image.width / 2),
                            4);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* A renderer that loses its device with its third picture. */
static rlf_result render_until_lost(void *self, const rlf_render_input *input,
                                    rlf_render_output *out)
{
    static uint8_t pixel[4];
    (void)input;
    *out = (rlf_render_output){.image = {pixel, 1, 1, 4}};
    return ++*(int *)self < 3 ? RLF_OK : rlf_fail(RLF_ERROR_DEVICE, "test: the context is lost");
}

static int warnings;

static void count_warnings(void *context, rlf_log_level level, const char *text)
{
    (void)context;
    warnings += level == RLF_LOG_WARNING && strstr(text, "context is lost; going on") != NULL;
}

static void a_lost_device_gives_way_to_the_soft_renderer(void **state)
{
    (void)state;
    static const rlf_compositor_methods methods = {render_until_lost, NULL, "frail"};
    rlf_source *source = open_plane(6, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_compositor *frail = NULL;
    rlf_pipeline_output out;
    int pictures = 0;
    assert_int_equal(rlf_compositor_create_custom(&methods, &pictures, &frail), RLF_OK);
    assert_int_equal(rlf_pipeline_set_compositor(pipeline, frail), RLF_OK);
    warnings = 0;
    rlf_set_log(count_warnings, NULL);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
        assert_int_equal(out.render.image.width, i < 2 ? 1 : WIDTH);
    }
    rlf_set_log(NULL, NULL);
    assert_int_equal(pictures, 3);
    assert_int_equal(warnings, 1);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* Every view of a sheet is the same picture as by itself, in its place. */
static void views_lie_side_by_side(void **state)
{
    (void)state;
    static const rlf_view views[3] = {RLF_VIEW_CAMERA, RLF_VIEW_NORMALS, RLF_VIEW_DEPTH};
    rlf_source *source = open_plane(3, 33333333);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_PROFILE_LIVE, NULL);
    rlf_pipeline_output out;
    assert_int_equal(rlf_pipeline_set_views(pipeline, views, 3), RLF_OK);
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
    }
    const rlf_image_rgba8 sheet = out.render.image;
    assert_null(out.render.matte.data);
    for (int32_t i = 0; i < 3; i++) {
        rlf_pipeline_set_view(pipeline, views[i]);
        assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
        const rlf_image_rgba8 *one = &out.render.image;
        assert_int_equal(sheet.width, 2 * one->width);
        assert_int_equal(sheet.height, 2 * one->height);
        for (int32_t y = 0; y < one->height; y++) {
            const uint8_t *row = rlf_rgba8_row(&sheet, i / 2 * one->height + y);
            assert_memory_equal(row + 4 * (i % 2) * one->width, rlf_rgba8_row(one, y),
                                4 * (size_t)one->width);
        }
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

/* A table seen from 45 degrees above, by a camera that is mounted level or tilted by 30. */
static void gravity_is_that_of_the_floor(void **state)
{
    (void)state;
    rlf_source *source = open_plane(2, 33000000);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double ray_y = (i / WIDTH - 59.5) / 120.0;
        plane_memory.depth[i] = (uint16_t)(PLANE_MM / (1.0 + ray_y) + 0.5);
    }
    for (int32_t tilt = 0; tilt <= 30; tilt += 30) {
        rlf_body_def body;
        rlf_scene scene = drop_scene(&body);
        scene.gravity = rlf_vec3_make(0, 1.6, 0);
        scene.finds_gravity = true;
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.scene = &scene;
        def.T_world_camera.q =
            rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), tilt * RLF_PI / 180.0);
        rlf_pipeline *pipeline = NULL;
        rlf_pipeline_output out;
        assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
        assert_int_equal(rlf_source_restart(source), RLF_OK);
        assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
        double angle = rlf_atan2(out.snapshot->gravity.z, out.snapshot->gravity.y);
        assert_true(fabs(rlf_length(out.snapshot->gravity) - 1.6) < 1e-9);
        assert_true(fabs(angle - (45.0 + tilt) * RLF_PI / 180.0) < 0.01);
        rlf_pipeline_destroy(&pipeline);
    }
    rlf_source_destroy(&source);
}

/* More bodies than a world has room for by default, and throws beside them. */
static void the_world_is_as_large_as_its_scene(void **state)
{
    (void)state;
    enum { BODIES = 1500, THROWS = 256 };
    static rlf_body_def bodies[BODIES];
    for (int32_t i = 0; i < BODIES; i++) {
        (void)drop_scene(&bodies[i]);
        bodies[i].shape.size = rlf_vec3_make(0.02, 0.02, 0.02);
        bodies[i].position = rlf_vec3_make(i % 50 * 0.03 - 0.75, i / 50 * 0.03 - 0.45, 1.0);
    }
    assert_true(BODIES > rlf_world_def_default().body_capacity);
    rlf_scene scene = {.gravity = {0, 0, 9.81}, .bodies = bodies, .body_count = BODIES};
    rlf_source *source = open_plane(2, 33333333);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.scene = &scene;
    rlf_pipeline *pipeline = NULL;
    rlf_pipeline_output out;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    for (int32_t i = 0; i < THROWS; i++) {
        rlf_body_id id;
        assert_int_equal(rlf_world_add_body(rlf_pipeline_get_world(pipeline), &bodies[i], &id),
                         RLF_OK);
    }
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    assert_int_equal(out.snapshot->body_count, BODIES + THROWS);
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_comes_to_rest_on_the_plane),
        cmocka_unit_test(results_do_not_depend_on_the_worker_count),
        cmocka_unit_test(frames_allocate_nothing_after_the_first),
        cmocka_unit_test(restart_repeats_the_run_exactly),
        cmocka_unit_test(frames_with_the_same_time_do_not_advance_physics),
        cmocka_unit_test(a_frame_after_a_long_gap_does_not_advance_physics),
        cmocka_unit_test(a_room_that_changed_meanwhile_pushes_gently),
        cmocka_unit_test(latency_and_silence_are_told),
        cmocka_unit_test(redraw_shows_the_last_frame_in_another_view),
        cmocka_unit_test(a_lost_device_gives_way_to_the_soft_renderer),
        cmocka_unit_test(views_lie_side_by_side),
        cmocka_unit_test(gravity_is_that_of_the_floor),
        cmocka_unit_test(the_world_is_as_large_as_its_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
