/* The frame loop over a source of analytic frames: a floor seen from above. */

#include "drawn_source.h"
#include "test.h"

#include <math.h>

#define WIDTH 160
#define HEIGHT 120
#define PLANE_MM 2000

/* Of the frames; the one at jump_frame comes that much later. */
static struct timing {
    int64_t step_ns, jump_frame, jump_ns;
    bool is_live;
} timing;

static void tell_time(rlf_frame *frame)
{
    frame->time_ns = drawn.frame * timing.step_ns;
    if (timing.jump_ns != 0 && drawn.frame >= timing.jump_frame) {
        frame->time_ns += timing.jump_ns;
    }
    frame->host_time_ns = timing.is_live ? rlf_clock_ns() - 5000000 : 0;
}

/* A plane 2 m away. */
static void open_plane(int64_t frame_count)
{
    const rlf_source_info info = drawn_info(WIDTH, HEIGHT, 120, frame_count);
    timing = (struct timing){.step_ns = 33333333};
    open_drawn(&info, tell_time);
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

static void open_pipeline(rlf_profile profile, rlf_pool *pool)
{
    rlf_body_def body;
    rlf_scene scene = drop_scene(&body);
    rlf_pipeline_def def = rlf_pipeline_def_default(profile, source, pool);
    def.scene = &scene;
    pipeline = pipeline_of(&def);
}

static void open_drop(int64_t frame_count)
{
    open_plane(frame_count);
    open_pipeline(RLF_PROFILE_LIVE, NULL);
}

TEST_CASE(cube_comes_to_rest_on_the_plane)
{
    open_drop(90);
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
}

static uint64_t run_hash(rlf_profile profile, int32_t workers)
{
    rlf_pool *pool = pool_of(workers);
    open_plane(30);
    open_pipeline(profile, pool);
    while (step()) {
    }
    uint64_t hash = rlf_world_hash(rlf_pipeline_get_world(pipeline));
    close_drawn(NULL);
    rlf_pool_destroy(&pool);
    return hash;
}

TEST_CASE(results_do_not_depend_on_the_worker_count)
{
    for (int profile = 0; profile < 2; profile++) {
        uint64_t one = run_hash((rlf_profile)profile, 1);
        assert_true(one == run_hash((rlf_profile)profile, 2));
        assert_true(one == run_hash((rlf_profile)profile, 4));
    }
    assert_true(run_hash(RLF_PROFILE_LIVE, 1) != run_hash(RLF_PROFILE_THESIS, 1));
}

TEST_CASE(frames_allocate_nothing_after_the_first)
{
    for (int profile = 0; profile < 2; profile++) {
        open_plane(40);
        open_pipeline((rlf_profile)profile, NULL);
        uint64_t after_warm_up = 0;
        while (step()) {
            if (out.frame_index == 9) {
                after_warm_up = rlf_alloc_count();
            }
        }
        assert_int_equal(rlf_alloc_count() - after_warm_up, 0);
        close_drawn(NULL);
    }
}

TEST_CASE(restart_repeats_the_run_exactly)
{
    open_drop(20);
    uint64_t hashes[2];
    for (int run = 0; run < 2; run++) {
        while (step()) {
        }
        hashes[run] = rlf_world_hash(rlf_pipeline_get_world(pipeline));
        assert_int_equal(rlf_pipeline_restart(pipeline), RLF_OK);
    }
    assert_true(hashes[0] == hashes[1]);
}

TEST_CASE(frames_with_the_same_time_do_not_advance_physics)
{
    open_drop(5);
    timing.step_ns = 0;
    while (step()) {
        assert_true(out.snapshot->bodies[0].T_world_body.p.z == 1.4);
        assert_true(out.time_s == 0.0);
    }
}

/* The camera was gone for an hour while the cube fell: it falls on from where it was. */
TEST_CASE(a_frame_after_a_long_gap_does_not_advance_physics)
{
    const int64_t jumps[2] = {INT64_C(3600000000000), -INT64_C(3600000000000)};
    for (int i = 0; i < 2; i++) {
        open_drop(90);
        timing.jump_frame = 5;
        timing.jump_ns = jumps[i];
        rlf_vec3 before = {0, 0, 0};
        while (step()) {
            const rlf_vec3 p = out.snapshot->bodies[0].T_world_body.p;
            const double way = rlf_length(rlf_sub(p, before));
            assert_true(out.frame_index == 0 || way < 0.12);
            assert_true(out.frame_index != 5 || way == 0.0);
            assert_true(out.frame_index != 6 || way > 0.01);
            before = p;
        }
        assert_true(fabs(before.z - 1.9) < 0.005);
        close_drawn(NULL);
    }
}

/* The camera comes back nearer to the floor: the cube that lay there is lifted, not shot away. */
TEST_CASE(a_room_that_changed_meanwhile_pushes_gently)
{
    open_drop(120);
    timing.jump_frame = 60;
    timing.jump_ns = INT64_C(3600000000000);
    while (step()) {
        for (int i = 0; i < WIDTH * HEIGHT && out.frame_index == 59; i++) {
            drawn.depth[i] = PLANE_MM - 200;
        }
        assert_true(out.frame_index < 60 || rlf_length(out.snapshot->bodies[0].velocity) < 1.0);
    }
    assert_true(fabs(out.snapshot->bodies[0].T_world_body.p.z - 1.7) < 0.01);
}

TEST_CASE(latency_and_silence_are_told)
{
    open_drop(2);
    assert_true(step());
    assert_true(out.latency_ms == 0.0); /* nobody knows when a file's frame came */
    timing.is_live = true;
    assert_true(step());
    assert_true(out.latency_ms >= 5.0);
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
    assert_false(out.is_stale);
    drawn.silence_s = 1.5;
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
    assert_true(out.is_stale);
}

TEST_CASE(redraw_shows_the_last_frame_in_another_view)
{
    open_drop(3);
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_NO_FRAME);
    while (step()) {
    }
    uint8_t before[4];
    memcpy(before, out.render.image.data, 4);
    rlf_pipeline_set_view(pipeline, RLF_VIEW_NORMALS);
    assert_int_equal(rlf_pipeline_redraw(pipeline, &out), RLF_OK);
    assert_memory_not_equal(before,
                            rlf_rgba8_row(&out.render.image, out.render.image.height / 2) +
                                4 * (out.render.image.width / 2),
                            4);
}

/* A renderer that loses its device with its third picture. */
static rlf_result render_until_lost(void *self, const rlf_render_input *input,
                                    rlf_render_output *picture)
{
    static uint8_t pixel[4];
    (void)input;
    *picture = (rlf_render_output){.image = {pixel, 1, 1, 4}};
    return ++*(int *)self < 3 ? RLF_OK : rlf_fail(RLF_ERROR_DEVICE, "test: the context is lost");
}

static int warnings;

static void count_warnings(void *context, rlf_log_level level, const char *text)
{
    (void)context;
    warnings += level == RLF_LOG_WARNING && strstr(text, "context is lost; going on") != NULL;
}

TEST_CASE(a_lost_device_gives_way_to_the_soft_renderer)
{
    static const rlf_compositor_methods methods = {render_until_lost, NULL, "frail"};
    open_drop(6);
    rlf_compositor *frail = NULL;
    int pictures = 0;
    assert_int_equal(rlf_compositor_create_custom(&methods, &pictures, &frail), RLF_OK);
    assert_int_equal(rlf_pipeline_set_compositor(pipeline, frail), RLF_OK);
    warnings = 0;
    rlf_set_log(count_warnings, NULL);
    for (int i = 0; i < 6; i++) {
        assert_true(step());
        assert_int_equal(out.render.image.width, i < 2 ? 1 : WIDTH);
    }
    rlf_set_log(NULL, NULL);
    assert_int_equal(pictures, 3);
    assert_int_equal(warnings, 1);
}

/* Every view of a sheet is the same picture as by itself, in its place. */
TEST_CASE(views_lie_side_by_side)
{
    static const rlf_view views[3] = {RLF_VIEW_CAMERA, RLF_VIEW_NORMALS, RLF_VIEW_DEPTH};
    open_drop(3);
    assert_int_equal(rlf_pipeline_set_views(pipeline, views, 3), RLF_OK);
    while (step()) {
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
}

/* A table seen from 45 degrees above, by a camera that is mounted level or tilted by 30. */
TEST_CASE(gravity_is_that_of_the_floor)
{
    open_plane(2);
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        double ray_y = (i / WIDTH - 59.5) / 120.0;
        drawn.depth[i] = (uint16_t)(PLANE_MM / (1.0 + ray_y) + 0.5);
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
        pipeline = pipeline_of(&def);
        assert_int_equal(rlf_source_restart(source), RLF_OK);
        assert_true(step());
        double angle = rlf_atan2(out.snapshot->gravity.z, out.snapshot->gravity.y);
        assert_true(fabs(rlf_length(out.snapshot->gravity) - 1.6) < 1e-9);
        assert_true(fabs(angle - (45.0 + tilt) * RLF_PI / 180.0) < 0.01);
        rlf_pipeline_destroy(&pipeline);
    }
}

/* More bodies than a world has room for by default, and throws beside them. */
TEST_CASE(the_world_is_as_large_as_its_scene)
{
    enum { BODIES = 1500, THROWS = 256 };
    static rlf_body_def bodies[BODIES];
    for (int32_t i = 0; i < BODIES; i++) {
        (void)drop_scene(&bodies[i]);
        bodies[i].shape.size = rlf_vec3_make(0.02, 0.02, 0.02);
        bodies[i].position = rlf_vec3_make(i % 50 * 0.03 - 0.75, i / 50 * 0.03 - 0.45, 1.0);
    }
    assert_true(BODIES > rlf_world_def_default().body_capacity);
    rlf_scene scene = {.gravity = {0, 0, 9.81}, .bodies = bodies, .body_count = BODIES};
    open_plane(2);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.scene = &scene;
    pipeline = pipeline_of(&def);
    for (int32_t i = 0; i < THROWS; i++) {
        rlf_body_id id;
        assert_int_equal(rlf_world_add_body(rlf_pipeline_get_world(pipeline), &bodies[i], &id),
                         RLF_OK);
    }
    assert_true(step());
    assert_true(step());
    assert_int_equal(out.snapshot->body_count, BODIES + THROWS);
}

TEST_EACH(NULL, close_drawn)
