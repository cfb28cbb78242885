/* Depth of the back against bodies whose back is known: quadrics, boxes, bodies that touch, hide
 * one another or leave the image; all with the sensor's noise. */

#include "heavy.h"
#include "seen_view.h"
#include "test.h"

enum { WIDTH = 512, HEIGHT = 424, COUNT = WIDTH * HEIGHT, BODIES = 4 };

static const double wall_z = 3.6, room_for_noise_m = 0.01;

/* An ellipsoid, or with an infinite y axis a cylinder; or a box. Turned about y, then about z. */
typedef struct body {
    bool is_box;
    rlf_vec3 centre, half;
    double heading, lean;
    double top; /* y from which it begins */
} body;

typedef struct span {
    double near, far;
} span;

static rlf_vec3 to_body(const body *b, rlf_vec3 v)
{
    rlf_quat q = rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), b->lean),
                              rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), b->heading));
    return rlf_rotate(rlf_quat_conjugate(q), v);
}

/* Depths at which the ray (x, y, 1) enters and leaves the body. */
static bool body_span(const body *b, double x, double y, span *out)
{
    rlf_vec3 m = to_body(b, rlf_vec3_make(x, y, 1.0)), o = to_body(b, rlf_neg(b->centre));
    bool hit;
    if (b->is_box) {
        const rlf_aabb upright = {rlf_neg(b->half), b->half};
        hit = box_ray(&upright, o, m, &out->near, &out->far);
    } else {
        rlf_vec3 p = {m.x / b->half.x, m.y / b->half.y, m.z / b->half.z};
        rlf_vec3 q = {o.x / b->half.x, o.y / b->half.y, o.z / b->half.z};
        double a = rlf_dot(p, p), h = rlf_dot(p, q), root = h * h - a * (rlf_dot(q, q) - 1.0);
        hit = root > 0.0;
        root = hit ? sqrt(root) : 0.0;
        *out = (span){(-h - root) / a, (-h + root) / a};
    }
    return hit && out->near > 0.0 && y * out->near >= b->top;
}

static const body *shown;
static int shown_count;
static float depth[COUNT], exit_depth[COUNT];
static int which[COUNT]; /* body seen; -1 = wall */

/* First solid along the ray: bodies that touch there are one. */
static void see(double x, double y, int i)
{
    span spans[BODIES] = {{0.0, 0.0}};
    double near = 1e9;
    which[i] = -1;
    for (int k = 0; k < shown_count; k++) {
        if (!body_span(&shown[k], x, y, &spans[k])) {
            spans[k] = (span){1e9, -1e9};
        } else if (spans[k].near < near) {
            near = spans[k].near;
            which[i] = k;
        }
    }
    double end = which[i] < 0 ? wall_z : spans[which[i]].far;
    for (int pass = 0; pass < shown_count; pass++) {
        for (int k = 0; k < shown_count; k++) {
            end = spans[k].near < end && spans[k].far > end ? spans[k].far : end;
        }
    }
    depth[i] = (float)(which[i] < 0 ? wall_z : near);
    exit_depth[i] = (float)end;
}

/* The surface after the wall was learnt and the bodies appeared. */
static const rlf_surface *show(const body *bodies, int count, rlf_reconstruct **stage)
{
    static float noisy[COUNT];
    rlf_rig rig = analytic_rig(WIDTH, HEIGHT);
    rlf_reconstruct_def def = rlf_reconstruct_def_default(RLF_PROFILE_LIVE, &rig);
    analytic_random random = {17};
    const rlf_surface *surface = NULL;
    *stage = stage_of(&def);
    shown = bodies;
    shown_count = count;
    for (int i = 0; i < COUNT; i++) {
        see((i % WIDTH - rig.depth.cx) / rig.depth.fx, (i / WIDTH - rig.depth.cy) / rig.depth.fy,
            i);
    }
    for (int frame = 0; frame < 9; frame++) {
        for (int i = 0; i < COUNT; i++) {
            double z = frame < 7 ? wall_z : depth[i];
            noisy[i] = (float)(z + rlf_depth_noise_sigma(&rig.noise, z) * random_normal(&random));
        }
        surface = seen_depth_process(&rig, noisy, *stage, frame);
    }
    return surface;
}

typedef struct errors {
    double mean, close; /* metres, share within 4 cm */
    int count;
} errors;

/* Of the exit depth, over the pixels that show body k. */
static errors errors_of(const rlf_surface *f, int k)
{
    errors e = {0};
    for (int i = 0; i < COUNT; i++) {
        if (which[i] != k || !f->foreground[i]) {
            continue;
        }
        double error = (double)f->depth[i] + f->thickness[i] - exit_depth[i];
        assert_true(f->depth[i] + f->thickness[i] <= wall_z + room_for_noise_m);
        e.mean += rlf_max(error, -error);
        e.close += error < 0.04 && error > -0.04 ? 1.0 : 0.0;
        e.count++;
    }
    assert_true(e.count > 200);
    e.mean /= e.count;
    e.close /= e.count;
    return e;
}

#define ENDLESS 50.0

/* The front of a quadric shows how deep it is: deeper than wide, flatter than wide, turned,
 * leaning, anywhere in the image. */
TEST_CASE(quadrics_have_their_back)
{
    static const body bodies[] = {
        {.centre = {0.0, 0.0, 2.4}, .half = {0.12, 0.12, 0.12}, .top = -9},
        {.centre = {0.7, -0.5, 2.4}, .half = {0.15, 0.15, 0.15}, .top = -9},
        {.centre = {0.0, 0.0, 2.5}, .half = {0.12, 0.25, 0.17}, .top = -9},
        {.centre = {0.3, 0.1, 2.5}, .half = {0.17, 0.25, 0.12}, .top = -9},
        {.centre = {-0.3, 0.1, 2.5}, .half = {0.17, 0.3, 0.12}, .heading = 0.785, .top = -9},
        {.centre = {0.2, 0.0, 2.2}, .half = {0.06, 0.5, 0.06}, .lean = 0.6, .top = -9},
        {.centre = {-0.4, 0.0, 2.2}, .half = {0.05, 0.5, 0.05}, .lean = 1.57, .top = -9},
        {.centre = {0.1, 0.0, 2.0}, .half = {0.09, ENDLESS, 0.09}, .top = -0.3},
    };
    const size_t count = sizeof bodies / sizeof bodies[0];
    for (size_t i = 0; i < count; i += (size_t)heavy(1, 6)) {
        rlf_reconstruct *stage = NULL;
        errors e = errors_of(show(&bodies[i], 1, &stage), 0);
        assert_true(e.mean < 0.012);
        assert_true(e.close > 0.97);
        rlf_reconstruct_destroy(&stage);
    }
}

/* One or two bodies, and what their exits may be off: the mean in metres, and the share that must
 * be within 4 cm. */
typedef struct group {
    const char *name;
    int count;
    body bodies[2];
    double mean[2], close[2];
} group;

static const group groups[] = {
    {"a book face on is a plate",
     1,
     {{.is_box = true, .centre = {0.1, 0, 2.3}, .half = {0.2, 0.25, 0.0125}, .top = -9}},
     {0.006},
     {0.0}},
    /* A bag shows one face: it is as deep as things of its width, no plate. */
    {"a bag at the side of a trunk",
     2,
     {{.centre = {-0.1, 0.0, 2.5}, .half = {0.17, 0.35, 0.12}, .top = -9},
      {.is_box = true, .centre = {0.15, 0.0, 2.495}, .half = {0.15, 0.2, 0.09}, .top = -9}},
     {1.0, 0.06},
     {0.0, 0.0}},
    /* Each of the two has its own back, with air between. */
    {"a limb before a trunk",
     2,
     {{.centre = {0.0, 0.0, 2.6}, .half = {0.17, 0.3, 0.12}, .top = -9},
      {.centre = {0.03, 0.0, 2.2}, .half = {0.05, 0.5, 0.05}, .lean = 0.3, .top = -9}},
     {0.025, 0.012},
     {0.9, 0.97}},
    /* It is one solid with the trunk. */
    {"a limb on a trunk",
     2,
     {{.centre = {0.0, 0.0, 2.6}, .half = {0.12, 0.3, 0.17}, .top = -9},
      {.centre = {0.0, 0.0, 2.41}, .half = {0.045, ENDLESS, 0.045}, .top = -0.2}},
     {0.02, 0.03},
     {0.0, 0.85}},
    /* It hides the side of the trunk, which goes on behind it. */
    {"a limb on the side of a trunk",
     2,
     {{.centre = {0.0, 0.0, 2.6}, .half = {0.15, 0.3, 0.17}, .top = -9},
      {.centre = {-0.10, 0.0, 2.45}, .half = {0.05, ENDLESS, 0.05}, .top = -0.2}},
     {0.026, 0.027},
     {0.0, 0.8}},
    /* Rows that show little of their own depth take it from those above and below. */
    {"a trunk with flat faces on a part of it",
     2,
     {{.centre = {0.0, 0.0, 2.5}, .half = {0.16, ENDLESS, 0.14}, .top = -0.4},
      {.is_box = true, .centre = {0.0, 0.1, 2.5}, .half = {0.1, 0.05, 0.14}, .top = -9}},
     {0.023, 0.035},
     {0.0, 0.7}},
    /* No background between two legs: the crease between them parts them. */
    {"legs that touch",
     2,
     {{.centre = {-0.075, 0.0, 2.4}, .half = {0.08, ENDLESS, 0.08}, .top = -0.1},
      {.centre = {0.075, 0.0, 2.4}, .half = {0.08, ENDLESS, 0.08}, .top = -0.1}},
     {0.015, 0.015},
     {0.95, 0.95}},
    /* The image's border is no silhouette. */
    {"bodies that leave the image",
     2,
     {{.centre = {-1.75, 0.0, 2.5}, .half = {0.2, 0.4, 0.2}, .top = -9},
      {.centre = {0.4, 1.5, 2.5}, .half = {0.14, 0.4, 0.14}, .top = -9}},
     {0.015, 0.015},
     {0.0, 0.0}}};

TEST_CASE(every_body_of_a_group_has_its_back)
{
    for (size_t g = 0; g < sizeof groups / sizeof groups[0]; g++) {
        rlf_reconstruct *stage = NULL;
        const rlf_surface *f = show(groups[g].bodies, groups[g].count, &stage);
        for (int k = 0; k < groups[g].count; k++) {
            const errors e = errors_of(f, k);
            if (!(e.mean < groups[g].mean[k]) || e.close < groups[g].close[k]) {
                fail_msg("%s, body %d: %.1f cm off, %.0f %% close", groups[g].name, k,
                         100.0 * e.mean, 100.0 * e.close);
            }
        }
        rlf_reconstruct_destroy(&stage);
    }
}

static rlf_vec3 back_point(const rlf_camera *c, int i, double z)
{
    return rlf_vec3_make(z * (i % WIDTH - c->cx) / c->fx, z * (i / WIDTH - c->cy) / c->fy, z);
}

/* Normal of the back by central differences; exit depths in `z` at the pixels left, right, above
 * and below. */
static rlf_vec3 back_normal(const rlf_camera *c, int i, const double z[4])
{
    rlf_vec3 across = rlf_sub(back_point(c, i + 1, z[1]), back_point(c, i - 1, z[0]));
    rlf_vec3 down = rlf_sub(back_point(c, i + WIDTH, z[3]), back_point(c, i - WIDTH, z[2]));
    return rlf_normalize(rlf_cross(across, down));
}

/* What hits the back bounces off in the right direction. */
TEST_CASE(backs_face_the_right_way)
{
    static const body bodies[] = {
        {.centre = {0.0, 0.0, 2.4}, .half = {0.15, 0.15, 0.15}, .top = -9},
        {.centre = {-0.3, 0.1, 2.5}, .half = {0.17, 0.3, 0.12}, .heading = 0.785, .top = -9},
        {.centre = {0.2, 0.0, 2.2}, .half = {0.06, 0.5, 0.06}, .lean = 0.6, .top = -9},
    };
    const int beside[4] = {-1, 1, -WIDTH, WIDTH};
    for (size_t b = 0; b < sizeof bodies / sizeof bodies[0]; b++) {
        rlf_reconstruct *stage = NULL;
        const rlf_surface *f = show(&bodies[b], 1, &stage);
        double sum = 0.0;
        int count = 0;
        for (int i = WIDTH; i < COUNT - WIDTH; i++) {
            double found[4], truth[4];
            int inside = 0;
            for (int k = 0; k < 4; k++) {
                int n = i + beside[k];
                inside += which[n] == 0 && f->foreground[n];
                found[k] = (double)f->depth[n] + f->thickness[n];
                truth[k] = exit_depth[n];
            }
            if (inside == 4) {
                sum +=
                    angle_deg(back_normal(&f->camera, i, found), back_normal(&f->camera, i, truth));
                count++;
            }
        }
        assert_true(count > 500 && sum / count < 15.0);
        rlf_reconstruct_destroy(&stage);
    }
}
