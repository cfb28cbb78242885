/* The frame loop where geometry does not tell all of a camera's pose. It turns in place before
 * walls and boxes without colour: when the wall beside it has left the view, outlines alone seem to
 * tell how far it slides along the other. Or it stands before one bare wall. */
#include "analytic.h"
#include "drawn_source.h"
#include "test.h"

#include <math.h>

enum { WIDTH = 320, HEIGHT = 240, FRAMES = 26 };

static bool is_bare; /* a wall without end ahead; the camera stands */

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
        double in, leave;
        t = box_ray(&boxes[k], rlf_vec3_make(0, 0, 0), way, &in, &leave) ? fmin(t, in) : t;
    }
    return t;
}

static void draw(rlf_frame *frame)
{
    (void)frame;
    const double turn = is_bare ? 0.0 : (double)drawn.frame * RLF_PI / 180.0;
    const rlf_quat q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.0, turn, 0.0));
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&drawn.camera, i % WIDTH, i / WIDTH, &ray);
        const double away = is_bare ? 2.0 : to_room(rlf_rotate(q, ray));
        drawn.depth[i] = (uint16_t)(1000.0 * away + 0.5);
    }
}

static void open_room(bool without_things, rlf_camera_mode camera)
{
    rlf_source_info info = drawn_info(WIDTH, HEIGHT, 280, FRAMES);
    info.rig.noise = (rlf_depth_noise){0.0008, 0.0, 0.0012};
    is_bare = without_things;
    open_drawn(&info, draw);
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.enable_render = false;
    def.camera = camera;
    pipeline = pipeline_of(&def);
}

/* How far the camera strays at most; it is told to move from `out_from` on. */
static double find_stray(rlf_camera_mode camera, int64_t *out_from)
{
    open_room(false, camera);
    double stray = 0.0;
    *out_from = FRAMES;
    while (step()) {
        stray = fmax(stray, rlf_length(out.T_world_camera.p));
        *out_from = out.track != NULL && out.frame_index < *out_from ? out.frame_index : *out_from;
    }
    return stray;
}

TEST_CASE(a_camera_that_stood_stays_in_place_while_it_turns)
{
    int64_t from;
    const double stray = find_stray(RLF_CAMERA_AUTO, &from);
    assert_less(from, 10);
    assert_less(stray, 0.02);
}

TEST_CASE(a_camera_that_moves_stays_in_place_while_it_turns)
{
    int64_t from;
    const double stray = find_stray(RLF_CAMERA_MOVING, &from);
    print_message("%.1f mm\n", 1000.0 * stray);
    assert_int_equal(from, 0);
    assert_true(stray < 0.02);
}

/* No direction along the wall is determined, but the camera moves along none. */
TEST_CASE(a_camera_that_stands_before_a_bare_wall_makes_its_mesh)
{
    open_room(true, RLF_CAMERA_MOVING);
    while (step()) {
        assert_true(out.track->health == (out.frame_index == 0 ? RLF_TRACK_GOOD : RLF_TRACK_WEAK));
        assert_true(rlf_length(out.T_world_camera.p) == 0.0);
    }
    rlf_map_mesh mesh;
    assert_int_equal(rlf_map_mesh_create(rlf_pipeline_get_map(pipeline), 8, &mesh), RLF_OK);
    assert_less(1000, mesh.triangle_count);
    rlf_map_mesh_destroy(&mesh);
}

TEST_EACH(NULL, close_drawn)
