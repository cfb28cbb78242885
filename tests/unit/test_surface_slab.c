/* Plates of three sizes on a stick, carried past the camera as they turn edge-on, beyond, and back:
 * what their faces showed says where a ray leaves them when only the edge is seen. And a barrel,
 * which is no plate. */

#include "heavy.h"
#include "seen_view.h"
#include "surface/stage.h"
#include "surface/thin/slab.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 512, HEIGHT = 200, COUNT = WIDTH * HEIGHT, BAND = 2, EMPTY_FRAMES = 8 };

static const double wall_z = 4.0, middle_z = 2.6, stick_m = 0.02;

static int make_fixture(void **state)
{
    static staged_view f;
    const rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    staged_view_create(&f, &def, 7);
    *state = &f;
    return 0;
}

/* Half extents along the view, down and across when it is edge-on, and where it is. */
typedef struct plate {
    double half[3];
    double x, turn; /* metres, radians from edge-on */
} plate;

/* Where the ray (u, v, 1) enters and leaves it; false when it misses. */
static bool cut(const plate *p, double u, double v, double out[2])
{
    double c = rlf_cos(p->turn), s = rlf_sin(p->turn);
    const rlf_vec3 from = {-p->x * s - middle_z * c, 0.0, -p->x * c + middle_z * s};
    const rlf_vec3 way = {u * s + c, v, u * c - s};
    const rlf_vec3 half = {p->half[0], p->half[1], p->half[2]};
    const rlf_aabb box = {rlf_neg(half), half};
    return box_ray(&box, from, way, &out[0], &out[1]) && out[0] > 0.0;
}

/* A wall, the stick under the plate, and the plate, if any. */
static void draw(staged_view *f, const plate *p)
{
    const rlf_camera *c = &f->view.rig.depth;
    for (int32_t i = 0; i < COUNT; i++) {
        double u = (i % WIDTH - c->cx) / c->fx, v = (i / WIDTH - c->cy) / c->fy, z[2];
        bool is_plate = p != NULL && cut(p, u, v, z);
        f->view.truth[i] = (float)(is_plate ? z[0] : wall_z);
        f->back[i] = (float)(is_plate ? z[1] : 0.0);
        if (p != NULL && v * middle_z >= p->half[1] && fabs(u * middle_z - p->x) < stick_m) {
            f->view.truth[i] = (float)middle_z;
        }
    }
}

static bool is_at_step(const staged_view *f, int32_t i)
{
    int32_t x = i % WIDTH, y = i / WIDTH;
    for (int32_t dy = -BAND; dy <= BAND; dy++) {
        for (int32_t dx = -BAND; dx <= BAND; dx++) {
            bool is_inside = x + dx >= 0 && x + dx < WIDTH && y + dy >= 0 && y + dy < HEIGHT;
            if (is_inside && fabsf(f->view.truth[i + dy * WIDTH + dx] - f->view.truth[i]) > 0.2f) {
                return true;
            }
        }
    }
    return false;
}

/* As the sensor shows it: noise, and no depth beside steps. */
static const rlf_surface *process(staged_view *f, int32_t number)
{
    for (int32_t i = 0; i < COUNT; i++) {
        float noisy = seen_view_noisy(&f->view, f->view.truth[i]);
        f->view.seen[i] = is_at_step(f, i) ? 0.0f : noisy;
    }
    return seen_view_process(&f->view, f->stage, number);
}

static void start(staged_view *f)
{
    f->view.random = (analytic_random){7};
    rlf_reconstruct_reset(f->stage);
    draw(f, NULL);
    for (int32_t t = 0; t < EMPTY_FRAMES; t++) {
        process(f, t);
    }
}

/* Metres, mean over the pixels of the plate that are known. */
static double back_error(const staged_view *f, const rlf_surface *s, int32_t *count)
{
    double sum = 0.0;
    for (int32_t i = 0; i < COUNT; i++) {
        if (f->back[i] > 0.0f && s->foreground[i] != 0 && s->depth[i] < 3.5f) {
            sum += fabs((double)(s->depth[i] + s->thickness[i] - f->back[i]));
            (*count)++;
        }
    }
    return sum;
}

/* It turns from `from` to -from degrees and back while it is carried along. */
static double error_edge_on(staged_view *f, const double half[3], double from_deg)
{
    const int32_t FRAMES = 90;
    const double edge_on = 12.0 * RLF_PI / 180.0;
    double sum = 0.0;
    int32_t count = 0;
    start(f);
    for (int32_t t = 0; t < FRAMES; t++) {
        double phase = 2.0 * RLF_PI * t / FRAMES;
        plate p = {.half = {half[0], half[1], half[2]}, .x = 0.15 * rlf_sin(phase)};
        double sight = rlf_atan2(p.x, middle_z); /* of its own */
        p.turn = from_deg * RLF_PI / 180.0 * rlf_cos(phase);
        draw(f, &p);
        const rlf_surface *s = process(f, EMPTY_FRAMES + t);
        if (t > FRAMES / 8 && fabs(p.turn - sight) < edge_on) {
            sum += back_error(f, s, &count);
        }
    }
    assert_true(count > 500);
    return sum / count;
}

TEST_CASE(a_plate_edge_on_is_as_deep_as_its_face_was_wide)
{
    static const double halves[3][3] = {
        {0.085, 0.120, 0.0125}, {0.150, 0.100, 0.006}, {0.060, 0.080, 0.015}};
    for (int k = 0; k < heavy(3, 1); k++) {
        double error = error_edge_on(*state, halves[k], k == 1 ? 40.0 : 50.0);
        assert_less(error, 0.25 * halves[k][0]);
    }
}

/* An upright barrel has a front as wide as a book and no outline of its own there. */
TEST_CASE(a_barrel_is_no_plate)
{
    const double radius = 0.16, half_height = 0.2;
    staged_view *f = *state;
    const rlf_camera *c = &f->view.rig.depth;
    double sum = 0.0;
    int32_t count = 0;
    start(f);
    for (int32_t t = 0; t < 30; t++) {
        double x = 0.3 - 0.02 * t;
        for (int32_t i = 0; i < COUNT; i++) {
            double u = (i % WIDTH - c->cx) / c->fx, v = (i / WIDTH - c->cy) / c->fy;
            double b = u * x + middle_z, a = u * u + 1.0;
            double root = b * b - a * (x * x + middle_z * middle_z - radius * radius);
            bool is_barrel = root > 0.0 && fabs(v) * middle_z < half_height;
            f->view.truth[i] = (float)(is_barrel ? (b - sqrt(root)) / a : wall_z);
            f->back[i] = (float)(is_barrel ? (b + sqrt(root)) / a : 0.0);
        }
        sum += back_error(f, process(f, EMPTY_FRAMES + t), &count);
    }
    assert_true(sum / count < 0.08); /* a plate would be 20 off */
}

/* A box that is a little off comes to where its outline is seen, with edges along rows and columns,
 * too, and the same frame does not move it on: where it began has no say but by its doubt. */
TEST_CASE(a_frame_places_a_plate_and_does_not_move_it_again)
{
    staged_view *f = *state;
    const plate seen = {.half = {0.01, 0.12, 0.09}, .x = 0.05};
    const double pixel_m = middle_z / f->view.rig.depth.fx;
    start(f);
    draw(f, &seen);
    const thin_in in = {
        .grid = &f->stage->grid, .noise = &f->view.rig.noise, .depth = f->view.truth};
    for (int k = 0; k < 20; k++) {
        slab box = {.half = {0.122, 0.092, 0.011}};
        box.pose.p = rlf_vec3_make(0.05 + 0.0007 * k, 0.004, middle_z - 0.003);
        box.pose.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.0, 0.0, RLF_PI / 2.0));
        for (int u = 0; u < SLAB_UNKNOWNS; u++) {
            box.doubt[u][u] = 0.02 * 0.02;
        }
        slab_improve(&in, &box);
        assert_true(fabs(box.pose.p.x - seen.x) < pixel_m);
        assert_true(fabs(box.pose.p.y) < pixel_m);
        assert_true(fabs(box.half[0] - seen.half[1]) < pixel_m);
        assert_true(fabs(box.half[1] - seen.half[2]) < pixel_m);
        const slab before = box;
        slab_improve(&in, &box);
        assert_true(rlf_length(rlf_sub(box.pose.p, before.pose.p)) < 0.0005);
    }
}

static double most(const double v[3])
{
    return fmax(fmax(v[0], v[1]), v[2]);
}

/* How far p = z (u, v, 1) is beyond the faces of the box along each axis, metres. */
static double beyond_faces(const slab_view *box, double u, double v, double z)
{
    const slab_point at = slab_local(box, rlf_vec3_make(z * u, z * v, z));
    const double beyond[3] = {fabs(at.q[0]) - box->half[0], fabs(at.q[1]) - box->half[1],
                              fabs(at.q[2]) - box->half[2]};
    return most(beyond);
}

/* Where a ray enters or leaves a box it is on a face, and outside a millimetre beyond. */
TEST_CASE(a_ray_is_cut_where_it_meets_the_faces)
{
    analytic_random r = {11};
    int32_t met = 0;
    for (int t = 0; t < 5000; t++) {
        const rlf_vec3 turn = {random_uniform(&r), random_uniform(&r), random_uniform(&r)};
        const slab box = {
            .pose = {rlf_vec3_make(0.1, -0.05, 2.0), rlf_quat_from_rotation_vector(turn)},
            .half = {0.2, 0.1, 0.01 + 0.1 * random_uniform(&r)}};
        const slab_view view = slab_look(&box);
        double u = 0.3 * random_uniform(&r) - 0.1, v = 0.3 * random_uniform(&r) - 0.15;
        double enter, leave;
        if (slab_cut_ray(&view, u, v, &enter, &leave)) {
            met++;
            assert_true(fabs(beyond_faces(&view, u, v, enter)) < 1e-9);
            assert_true(fabs(beyond_faces(&view, u, v, leave)) < 1e-9);
            assert_true(beyond_faces(&view, u, v, enter - 0.001) > 0.0);
            assert_true(beyond_faces(&view, u, v, leave + 0.001) > 0.0);
            rlf_vec3 middle = rlf_scale(rlf_vec3_make(u, v, 1.0), 0.5 * (enter + leave));
            assert_true(slab_is_near(&view, middle, 1e-9));
        }
    }
    assert_true(met > 500);
}

TEST_GROUP(make_fixture, staged_view_destroy)
