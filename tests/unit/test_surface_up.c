/* Which way is up, in analytic rooms seen by tilted and rolled cameras. */

#include "analytic.h"
#include "test.h"

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

/* Degrees between what is found and the truth. */
static double error_of(const room_view *v, rlf_quat turn, double *out_confidence)
{
    rlf_vec3 up;
    *out_confidence = rlf_surface_find_up(&v->surface, &up);
    rlf_vec3 truth = rlf_rotate(turn, rlf_vec3_make(0, -1, 0));
    assert_true(*out_confidence >= 0.0 && *out_confidence <= 1.0);
    return rlf_acos(rlf_clamp(rlf_dot(up, truth), -1.0, 1.0)) / RAD;
}

static room_view view;

TEST_CASE(a_room_is_found_from_any_usual_camera)
{
    double confidence;
    for (double down = -15.0; down <= 50.0; down += 5.0) {
        for (double roll = -20.0; roll <= 20.0; roll += 10.0) {
            rlf_quat turn = camera_turn(down, roll);
            look(&view, room, 5, turn, 0.05);
            assert_true(error_of(&view, turn, &confidence) <
                        0.3); /* at -15 by a few normals of the ceiling */
        }
    }
}

TEST_CASE(a_table_alone_is_enough)
{
    double confidence;
    for (double down = 10.0; down <= 60.0; down += 10.0) {
        rlf_quat turn = camera_turn(down, 5.0);
        look(&view, room, 1, turn, 0.05);
        assert_true(error_of(&view, turn, &confidence) < 0.1);
    }
}

/* The wall ahead has most of the picture; the floor is a strip. */
TEST_CASE(a_wall_is_no_floor)
{
    double confidence;
    const plane near_wall[2] = {room[0], room[4]};
    rlf_quat turn = camera_turn(0.0, 3.0);
    look(&view, near_wall, 2, turn, 0.05);
    assert_true(error_of(&view, turn, &confidence) < 0.1);
}

/* A box on the floor of the level frame, its edges along x, y and z. */
typedef struct box {
    rlf_vec3 low, high;
} box;

/* Puts a box, turned about the upright by yaw, in front of what is seen. */
static void put_box(room_view *v, const box *b, double yaw_deg, rlf_quat turn)
{
    rlf_quat about = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), yaw_deg * RAD);
    rlf_quat back = rlf_quat_conjugate(rlf_quat_mul(turn, about));
    const double low[3] = {b->low.x, b->low.y, b->low.z};
    const double high[3] = {b->high.x, b->high.y, b->high.z};
    for (int32_t i = 0; i < COUNT; i++) {
        rlf_vec3 r = rlf_rotate(back, rlf_vec3_make(v->ray_x[i], v->ray_y[i], 1.0));
        const double ray[3] = {r.x, r.y, r.z};
        double near = 0.0, far = 1e9;
        int32_t face = 0;
        for (int32_t k = 0; k < 3; k++) {
            double a = low[k] / ray[k], c = high[k] / ray[k];
            face = rlf_min(a, c) > near ? k : face;
            near = rlf_max(near, rlf_min(a, c));
            far = rlf_min(far, rlf_max(a, c));
        }
        if (near < far && near > 0.0 && (v->depth[i] == 0.0f || near < v->depth[i])) {
            double sign = ray[face] > 0.0 ? -1.0 : 1.0;
            rlf_vec3 n = {face == 0 ? sign : 0, face == 1 ? sign : 0, face == 2 ? sign : 0};
            n = rlf_rotate(rlf_quat_conjugate(back), n);
            v->depth[i] = (float)near;
            v->nx[i] = (float)n.x;
            v->ny[i] = (float)n.y;
            v->nz[i] = (float)n.z;
        }
    }
}

/* Three boxes on a table 0.6 m under the camera. */
static const box boxes[3] = {{{-0.25, 0.45, 0.75}, {-0.10, 0.6, 0.87}},
                             {{0.05, 0.40, 0.60}, {0.17, 0.6, 0.72}},
                             {{-0.05, 0.5, 1.0}, {0.15, 0.6, 1.1}}};
static const double yaws[3] = {20.0, -35.0, 5.0};

static void look_at_table(rlf_quat turn)
{
    const plane table = {{0, -1, 0}, -0.6};
    look(&view, &table, 1, turn, 0.05);
    for (int32_t k = 0; k < 3; k++) {
        put_box(&view, &boxes[k], yaws[k], turn);
    }
}

/* A desk arm's camera hangs upside down, or on its side. */
TEST_CASE(things_on_a_table_tell_for_any_roll)
{
    double confidence;
    for (double roll = 0.0; roll < 360.0; roll += 30.0) {
        rlf_quat turn = camera_turn(40.0, roll);
        look_at_table(turn);
        assert_true(error_of(&view, turn, &confidence) < 1.0);
        bool lies_on_its_side = roll == 90.0 || roll == 270.0;
        assert_true(confidence >= RLF_UP_SURE || lies_on_its_side);
    }
}

/* Its walls are as good floors: whatever is answered, it is not sure. */
TEST_CASE(a_rolled_empty_room_is_not_sure)
{
    double confidence;
    for (double roll = 60.0; roll <= 300.0; roll += 30.0) {
        rlf_quat turn = camera_turn(10.0, roll);
        look(&view, room, 5, turn, 0.05);
        double error = error_of(&view, turn, &confidence);
        assert_true(error < 1.0 || confidence < RLF_UP_SURE);
    }
}

/* Who set a camera up to be level with a floor and walls: sure, with nothing standing there. */
TEST_CASE(a_level_camera_in_an_empty_room_is_sure)
{
    double confidence;
    for (double off = -4.0; off <= 4.0; off += 4.0) {
        rlf_quat turn = camera_turn(off < 0.0 ? 0.0 : off, 0.0);
        look(&view, room, 5, turn, 0.05);
        assert_true(error_of(&view, turn, &confidence) < 1.0);
        assert_true(confidence >= RLF_UP_SURE);
        turn = camera_turn(0.0, off);
        look(&view, room, 5, turn, 0.05);
        assert_true(error_of(&view, turn, &confidence) < 1.0);
        assert_true(confidence >= RLF_UP_SURE);
    }
}

/* Before a wall ramps are as level as a tilted camera says; a wall alone says nothing. */
TEST_CASE(a_ramp_and_a_tilted_wall_do_not_make_sure)
{
    double confidence;
    for (double slope = 12.0; slope <= 30.0; slope += 6.0) {
        const double s = sin(slope * RAD), c = cos(slope * RAD);
        const plane ramp[2] = {{{0, -c, -s}, -1.4 * c}, room[4]};
        for (double down = -10.0; down <= 40.0; down += 5.0) {
            rlf_quat turn = camera_turn(down, 0.0);
            look(&view, ramp, 2, turn, 0.02);
            double error = error_of(&view, turn, &confidence);
            assert_true(error < 10.0 || confidence < RLF_UP_SURE);
            look(&view, &room[4], 1, turn, 0.02);
            error = error_of(&view, turn, &confidence);
            assert_true(error < 10.0 || confidence < RLF_UP_SURE);
        }
    }
}

TEST_CASE(what_tells_nothing_is_told_so)
{
    double confidence;
    rlf_quat level = camera_turn(0.0, 0.0), down = camera_turn(88.0, 0.0);
    look(&view, &room[4], 1, level, 0.05); /* one wall, frontal */
    assert_true(error_of(&view, level, &confidence) < 1.0);
    assert_true(confidence < RLF_UP_SURE);
    look(&view, room, 0, level, 0.0); /* nothing at all */
    assert_true(error_of(&view, level, &confidence) == 0.0);
    assert_true(confidence == 0.0);
    look(&view, room, 1, down, 0.05); /* straight down: a floor or a wall? */
    error_of(&view, down, &confidence);
    assert_true(confidence < RLF_UP_SURE);
}
