/* The tracker against rooms of planes, of which everything is known. */

#include "relief/track.h"
#include "pinhole.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 256, HEIGHT = 212, PIXELS = WIDTH * HEIGHT };

/* n . p = d in the world; the normal towards the camera. */
typedef struct plane {
    rlf_vec3 n;
    double d;
} plane;

/* A wall ahead, a wall to the right and a floor. */
static const plane corner[] = {{{0, 0, -1}, -3.0}, {{-0.8, 0, -0.6}, -2.2}, {{0, -1, 0}, -1.0}};

typedef struct fixture {
    rlf_rig rig;
    float depth[PIXELS], seen[PIXELS], normal[3][PIXELS];
    uint8_t is_static[PIXELS], grey[PIXELS], seen_grey[PIXELS];
    bool has_grey;
    rlf_prediction prediction;
    rlf_tracker *tracker;
} fixture;

static fixture f;

static rlf_vec3 ray_of(int32_t i)
{
    const rlf_camera *c = &f.rig.depth;
    return rlf_vec3_make((i % WIDTH - c->cx) / c->fx, (i / WIDTH - c->cy) / c->fy, 1.0);
}

/* What a camera at the pose sees; `normal` may be NULL. */
static void render(const plane *planes, int count, const rlf_pose *T, float *depth,
                   float (*normal)[PIXELS])
{
    for (int32_t i = 0; i < PIXELS; i++) {
        const rlf_vec3 way = rlf_rotate(T->q, ray_of(i));
        double best = 0.0;
        rlf_vec3 n = {0, 0, 0};
        for (int k = 0; k < count; k++) {
            const double z = (planes[k].d - rlf_dot(planes[k].n, T->p)) / rlf_dot(planes[k].n, way);
            if (z > 0.0 && (best == 0.0 || z < best)) {
                best = z;
                n = rlf_rotate(rlf_quat_conjugate(T->q), planes[k].n);
            }
        }
        depth[i] = best < 8.0 ? (float)best : 0.0f;
        if (normal != NULL) {
            normal[0][i] = (float)n.x;
            normal[1][i] = (float)n.y;
            normal[2][i] = (float)n.z;
        }
    }
}

static int end(void **state)
{
    (void)state;
    rlf_tracker_destroy(&f.tracker);
    return 0;
}

/* The room is predicted from the identity, and seen from `T`; instead of what was there. */
static void begin(const plane *planes, int count, const rlf_pose *T)
{
    const rlf_pose identity = rlf_pose_identity();
    end(NULL);
    memset(&f, 0, sizeof(f));
    f.rig.depth = pinhole(WIDTH, HEIGHT, 183.0);
    f.rig.depth_min_m = 0.3;
    f.rig.depth_max_m = 8.0;
    f.rig.noise = (rlf_depth_noise){0.0015, -0.0005, 0.0003};
    memset(f.is_static, 1, sizeof(f.is_static));
    render(planes, count, &identity, f.depth, f.normal);
    render(planes, count, T, f.seen, NULL);
    f.prediction = (rlf_prediction){f.rig.depth, identity,    f.depth, f.normal[0],
                                    f.normal[1], f.normal[2], NULL};
    rlf_tracker_def def = rlf_tracker_def_default();
    def.rig = f.rig;
    assert_int_equal(rlf_tracker_create(&def, &f.tracker), RLF_OK);
}

static rlf_track_result align_from(rlf_pose start)
{
    const rlf_track_view view = {f.seen, f.is_static, f.has_grey ? f.seen_grey : NULL};
    rlf_track_result result;
    assert_int_equal(rlf_tracker_align(f.tracker, &view, &f.prediction, &start, &result), RLF_OK);
    assert_true(rlf_vec3_is_finite(result.T_world_camera.p));
    return result;
}

static rlf_track_result align(void)
{
    return align_from(rlf_pose_identity());
}

/* Waves of brightness; the frame's lie `right` pixels to the right of the prediction's. */
static void paint(double right)
{
    for (int32_t i = 0; i < PIXELS; i++) {
        const double x = i % WIDTH, y = i / WIDTH;
        f.grey[i] = (uint8_t)(128.0 + 50.0 * rlf_sin(0.15 * x) + 40.0 * rlf_sin(0.2 * y));
        f.seen_grey[i] =
            (uint8_t)(128.0 + 50.0 * rlf_sin(0.15 * (x - right)) + 40.0 * rlf_sin(0.2 * y));
    }
    f.has_grey = true;
    f.prediction.grey = f.grey;
}

static rlf_pose moved(void)
{
    return (rlf_pose){{0.021, -0.012, 0.017},
                      rlf_quat_from_rotation_vector(rlf_vec3_make(0.008, -0.012, 0.005))};
}

static double turn_between(rlf_quat a, rlf_quat b)
{
    const rlf_quat q = rlf_quat_mul(rlf_quat_conjugate(a), b);
    return 2.0 * rlf_length(rlf_vec3_make(q.x, q.y, q.z)) * 180.0 / RLF_PI;
}

TEST_CASE(test_a_corner_gives_the_pose)
{
    const rlf_pose T = moved();
    begin(corner, 3, &T);
    const rlf_track_result found = align();
    assert_int_equal(found.health, RLF_TRACK_GOOD);
    assert_true(rlf_length(rlf_sub(found.T_world_camera.p, T.p)) < 1e-4);
    assert_true(turn_between(found.T_world_camera.q, T.q) < 0.01);
    assert_true(found.overlap > 0.9);
    const rlf_track_result again = align();
    assert_memory_equal(&again.T_world_camera, &found.T_world_camera, sizeof(rlf_pose));
}

/* A blank wall says nothing of the ways along it, and the pose stays where it was in them. */
TEST_CASE(test_a_plane_alone_is_weak)
{
    const rlf_pose T = {{0.03, 0.0, 0.02}, rlf_quat_identity()};
    begin(corner, 1, &T);
    const rlf_track_result found = align();
    assert_int_equal(found.health, RLF_TRACK_WEAK);
    assert_true(fabs(found.weak_way.z) < 0.05);
    assert_float_equal(found.T_world_camera.p.z, 0.02, 2e-4);
    assert_true(fabs(found.T_world_camera.p.x) < 1e-3);
}

/* A seventh of the view goes to the side and nearer, as a person does. With the mask it does not
 * pull at all; without, what is far in front of the room is left out. */
TEST_CASE(test_a_mover_does_not_pull)
{
    const rlf_pose T = moved();
    for (int is_masked = 0; is_masked < 2; is_masked++) {
        begin(corner, 3, &T);
        for (int32_t i = 0; i < PIXELS; i++) {
            if (i % WIDTH > 100 && i % WIDTH < 140) {
                f.seen[i] -= 0.5f;
                f.is_static[i] = is_masked != 0 ? 0 : 1;
            }
        }
        const rlf_track_result found = align();
        assert_int_equal(found.health, RLF_TRACK_GOOD);
        assert_true(rlf_length(rlf_sub(found.T_world_camera.p, T.p)) < 1e-3);
    }
}

/* Where depth settles the pose brightness that says otherwise changes nothing; along a wall it is
 * all that there is. */
TEST_CASE(test_brightness_tells_what_depth_does_not)
{
    const rlf_pose T = moved(), here = rlf_pose_identity();
    begin(corner, 3, &T);
    const rlf_track_result alone = align();
    paint(6.0);
    const rlf_track_result found = align();
    assert_true(rlf_length(rlf_sub(found.T_world_camera.p, alone.T_world_camera.p)) < 1e-4);
    assert_true(turn_between(found.T_world_camera.q, alone.T_world_camera.q) < 0.01);
    begin(corner, 1, &here);
    paint(2.0);
    const rlf_track_result slid = align();
    assert_int_equal(slid.health, RLF_TRACK_GOOD);
    assert_float_equal(slid.T_world_camera.p.x, -2.0 / 183.0 * 3.0, 2e-3);
    assert_float_equal(slid.T_world_camera.p.z, 0.0, 1e-4);
}

/* Noise moves nothing: the pose is the prediction's, bit for bit. */
TEST_CASE(test_a_camera_at_rest_stays)
{
    const rlf_pose here = rlf_pose_identity();
    uint32_t hash = 1;
    begin(corner, 3, &here);
    for (int32_t i = 0; i < PIXELS; i++) {
        hash = hash * 1664525u + 1013904223u;
        f.seen[i] += 0.004f * ((float)(hash >> 8) * 0x1p-24f - 0.5f) * f.seen[i];
    }
    const rlf_track_result found = align();
    assert_memory_equal(&found.T_world_camera, &here, sizeof(here));
}

/* A guess that nothing confirms is not believed: along a wall the camera stays where it was. */
TEST_CASE(test_a_guess_along_a_wall_is_not_kept)
{
    const rlf_pose here = rlf_pose_identity(), guess = {{0.03, 0.0, 0.0}, rlf_quat_identity()};
    begin(corner, 1, &here);
    const rlf_track_result found = align_from(guess);
    assert_int_equal(found.health, RLF_TRACK_WEAK);
    assert_true(rlf_length(found.T_world_camera.p) < 1e-3);
}

TEST_CASE(test_nothing_seen_is_lost)
{
    const rlf_pose T = moved();
    begin(corner, 3, &T);
    memset(f.seen, 0, sizeof(f.seen));
    assert_int_equal(align().health, RLF_TRACK_LOST);
    for (int32_t i = 0; i < PIXELS; i++) {
        f.seen[i] = i % 2 != 0 ? NAN : INFINITY;
    }
    assert_int_equal(align().health, RLF_TRACK_LOST);
}

TEST_CASE(test_no_pose_is_refused)
{
    const rlf_pose T = moved();
    begin(corner, 3, &T);
    const rlf_track_view view = {f.seen, NULL, NULL};
    const rlf_pose bad[] = {{{NAN, 0, 0}, rlf_quat_identity()}, {{0, 0, 0}, {0, 0, 0, 0}}};
    for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); i++) {
        rlf_track_result result;
        assert_int_equal(rlf_tracker_align(f.tracker, &view, &f.prediction, &bad[i], &result),
                         RLF_ERROR_INVALID);
    }
}

/* Two views that do not look alike: each is recalled by itself. */
TEST_CASE(test_a_view_is_recalled)
{
    const rlf_pose T = moved();
    begin(corner, 3, &T);
    rlf_track_result at = {.T_world_camera = rlf_pose_identity(), .health = RLF_TRACK_GOOD};
    rlf_track_view view = {f.depth, NULL, NULL};
    rlf_tracker_accept(f.tracker, &view, 0, &at);
    for (int32_t i = 0; i < PIXELS; i++) {
        f.seen[i] = 1.0f + (float)(i % WIDTH) / WIDTH;
    }
    at.T_world_camera.p.x = 5.0;
    view.depth = f.seen;
    rlf_tracker_accept(f.tracker, &view, 33000000, &at);
    rlf_pose poses[4];
    assert_int_equal(rlf_tracker_recall(f.tracker, &view, poses, 4), 2);
    assert_true(poses[0].p.x == 5.0);
    view.depth = f.depth;
    assert_int_equal(rlf_tracker_recall(f.tracker, &view, poses, 4), 2);
    assert_true(poses[0].p.x == 0.0);
}

/* Constant velocity, but not over a jump in time. */
TEST_CASE(test_the_camera_goes_on_as_it_did)
{
    const rlf_pose T = moved();
    begin(corner, 3, &T);
    rlf_track_result at = {.T_world_camera = rlf_pose_identity(), .health = RLF_TRACK_WEAK};
    rlf_tracker_accept(f.tracker, NULL, 0, &at);
    at.T_world_camera.p.x = 0.01;
    rlf_tracker_accept(f.tracker, NULL, 33000000, &at);
    assert_float_equal(rlf_tracker_guess(f.tracker, 66000000).p.x, 0.02, 1e-9);
    assert_float_equal(rlf_tracker_guess(f.tracker, 5000000000).p.x, 0.01, 1e-9);
    assert_float_equal(rlf_tracker_guess(f.tracker, 0).p.x, 0.01, 1e-9);
    assert_float_equal(rlf_tracker_guess(f.tracker, INT64_MAX).p.x, 0.01, 1e-9);
    assert_float_equal(rlf_tracker_guess(f.tracker, INT64_MIN).p.x, 0.01, 1e-9);
}

TEST_EACH(NULL, end)
