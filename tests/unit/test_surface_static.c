/* The thickness of what stands, against a room whose backs are known: a floor, a wall, and on the
 * floor a ball and a box that shows two sides and its top; with the sensor's noise. */
#include "created.h"
#include "heavy.h"
#include "painted.h"
#include "test.h"

enum { WIDTH = 320, HEIGHT = 240, COUNT = WIDTH * HEIGHT, FRAMES = 80 };
enum { WALL, FLOOR, BALL, BOX, PLATE, KINDS };

static const double wall_z = 3.0, floor_y = 0.9, ball_radius = 0.2, plate_z = 2.6;
static const rlf_vec3 ball_centre = {-0.6, 0.7, 2.2};

typedef struct standing_box {
    rlf_vec3 centre, half;
    double heading;
} standing_box;

static const standing_box low_box = {{0.4, 0.7, 2.3}, {0.2, 0.2, 0.15}, 0.6};
/* Taller than the eye, with one side seen at ten degrees. */
static const standing_box high_box = {{0.4, 0.4, 2.3}, {0.12, 0.5, 0.15}, -0.05};
/* Goes on beyond the left border. */
static const standing_box cut_box = {{-1.7, 0.4, 2.3}, {0.6, 0.4, 0.15}, 0.0};
static const standing_box *box = &low_box;

static float truth[COUNT], exit_depth[COUNT];
static analytic_random noise;
static int kind[COUNT];

static void hit(int i, int what, double near, double far)
{
    if (near > 0.0 && near < (double)truth[i]) {
        truth[i] = (float)near;
        exit_depth[i] = (float)far;
        kind[i] = what;
    }
}

static void see_ball(int i, rlf_vec3 ray)
{
    double near, far;
    if (sphere_ray(ball_centre, ball_radius, rlf_vec3_make(0, 0, 0), ray, &near, &far)) {
        hit(i, BALL, near, far);
    }
}

static void see_box(int i, rlf_vec3 ray)
{
    rlf_quat q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), -box->heading);
    rlf_vec3 o = rlf_rotate(q, rlf_neg(box->centre)), m = rlf_rotate(q, ray);
    const rlf_aabb upright = {rlf_neg(box->half), box->half};
    double near, far;
    if (box_ray(&upright, o, m, &near, &far)) {
        hit(i, BOX, near, far);
    }
}

/* The room, with the box and the ball or without. */
static void draw(bool has_things)
{
    for (int i = 0; i < COUNT; i++) {
        rlf_vec3 ray = {(i % WIDTH - rig.depth.cx) / rig.depth.fx,
                        (i / WIDTH - rig.depth.cy) / rig.depth.fy, 1.0};
        truth[i] = (float)wall_z;
        exit_depth[i] = 0.0f;
        kind[i] = WALL;
        if (ray.y > 0.0) {
            hit(i, FLOOR, floor_y / ray.y, 0.0);
        }
        if (ray.x > -0.1 && ray.x < 0.05 && ray.y > -0.25 && ray.y < -0.15) {
            hit(i, PLATE, plate_z, plate_z + 0.05);
        }
        if (has_things) {
            see_ball(i, ray);
            see_box(i, ray);
        }
    }
}

/* Of a lens that shows `zoom` times as much of the middle. */
static void begin(double zoom, rlf_pool *pool)
{
    rlf_reconstruct_def def = see_size(WIDTH, HEIGHT);
    rig.depth.fx *= zoom;
    rig.depth.fy *= zoom;
    def.rig = rig;
    def.pool = pool;
    noise = (analytic_random){23};
    start_seeing(&def);
}

static const rlf_surface *watch(int frames)
{
    const rlf_surface *surface = NULL;
    for (int k = 0; k < frames; k++) {
        for (int i = 0; i < COUNT; i++) {
            double z = truth[i];
            depth[i] = (float)(z + rlf_depth_noise_sigma(&rig.noise, z) * random_normal(&noise));
        }
        surface = see();
    }
    return surface;
}

TEST_CASE(backs_of_what_stands_are_found)
{
    begin(1.0, NULL);
    draw(true);
    const rlf_surface *surface = watch(FRAMES);
    double known[KINDS] = {0}, all[KINDS] = {0}, off[KINDS] = {0};
    for (int i = 0; i < COUNT; i++) {
        double thickness = surface->background_thickness[i];
        all[kind[i]] += 1.0;
        known[kind[i]] += thickness > 0.0;
        double error = surface->background_depth[i] + thickness - exit_depth[i];
        off[kind[i]] += thickness > 0.0 ? (error < 0.0 ? -error : error) : 0.0;
    }
    assert_true(known[BALL] > 0.9 * all[BALL] && off[BALL] < 0.03 * known[BALL]);
    assert_true(known[BOX] > 0.983 * all[BOX] && off[BOX] < 0.012 * known[BOX]);
    /* walls and floors end nowhere; one face alone says nothing about its back */
    assert_less(known[WALL] + known[FLOOR], 0.005 * (all[WALL] + all[FLOOR]));
    assert_less(known[PLATE], 0.1 * all[PLATE]);
}

/* Metres that the box's exit is off on average; nearly all of it must be known. */
static double watch_box(const standing_box *what)
{
    box = what;
    begin(1.0, NULL);
    draw(true);
    const rlf_surface *surface = watch(FRAMES);
    double known = 0.0, all = 0.0, off = 0.0;
    for (int i = 0; i < COUNT; i++) {
        double thickness = surface->background_thickness[i];
        double error = surface->background_depth[i] + thickness - exit_depth[i];
        bool is_known = kind[i] == BOX && thickness > 0.0;
        all += kind[i] == BOX;
        known += is_known;
        off += is_known ? (error < 0.0 ? -error : error) : 0.0;
    }
    assert_less(0.95 * all, known);
    box = &low_box;
    return off / known;
}

/* Depth jumps by five centimetres from pixel to pixel there, and yet it is one face. */
TEST_CASE(a_side_at_a_low_angle_shows_how_deep_a_box_is)
{
    assert_true(watch_box(&high_box) < 0.035);
}

/* What is seen of it ends at the border, and it does not. */
TEST_CASE(a_box_that_the_border_cuts_goes_on)
{
    assert_true(watch_box(&cut_box) < 0.02);
}

TEST_CASE(what_has_left_has_no_back)
{
    begin(1.0, NULL);
    draw(true);
    (void)watch(FRAMES);
    draw(false);
    const rlf_surface *surface = watch(20);
    int known = 0;
    for (int i = 0; i < COUNT; i++) {
        known += kind[i] != PLATE && surface->background_thickness[i] > 0.0f;
    }
    assert_true(known < COUNT / 200);
}

/* Pixels of the ball that have a back. */
static int count_known(const rlf_surface *surface)
{
    int known = 0;
    for (int i = 0; i < COUNT; i++) {
        known += kind[i] == BALL && surface->background_thickness[i] > 0.0f;
    }
    return known;
}

/* A ball close to the wall: that is hardly farther than its back, and is another thing. */
TEST_CASE(a_wall_is_not_thick_where_a_ball_was)
{
    heavy_needs_whole(); /* the same code as what_has_left_has_no_back */
    const double radius = 0.08;
    const rlf_vec3 middle = {0.2, -0.1, wall_z - radius - 0.02};
    begin(2.0, NULL);
    draw(false);
    for (int i = 0; i < COUNT; i++) {
        double z = sphere_depth(middle, radius, (i % WIDTH - rig.depth.cx) / rig.depth.fx,
                                (i / WIDTH - rig.depth.cy) / rig.depth.fy);
        kind[i] = z > 0.0 ? BALL : WALL;
        truth[i] = z > 0.0 ? (float)z : truth[i];
    }
    int there = count_known(watch(120));
    for (int i = 0; i < COUNT; i++) {
        truth[i] = kind[i] == BALL ? (float)wall_z : truth[i];
    }
    int left = count_known(watch(16));
    assert_true(there > 300 && left * 50 < there);
}

/* A surface keeps its plane while it is valid, also while a new one is published. */
TEST_CASE(planes_of_valid_surfaces_stay)
{
    static float kept[COUNT];
    int changes = 0;
    int64_t version = 0;
    begin(1.0, NULL);
    draw(true);
    for (int k = 0; k < 60; k++) {
        const rlf_surface *surface = watch(1);
        const float *plane = surface->background_thickness;
        changes += surface->background_version != version;
        version = surface->background_version;
        memcpy(kept, plane, sizeof kept);
        for (int later = 1; later < RLF_RECONSTRUCT_SURFACES; later++) {
            (void)watch(1);
            assert_memory_equal(kept, plane, sizeof kept);
        }
    }
    assert_true(changes >= 3); /* learnt, found, and found again when the means were better */
    assert_true(changes < 10);
}

TEST_CASE(workers_change_nothing)
{
    static float one[COUNT];
    heavy_needs_whole(); /* unit.surface_stage has them with sanitizers */
    for (int32_t workers = 1; workers <= 3; workers += 2) {
        rlf_pool *pool = pool_of(workers);
        begin(1.0, pool);
        draw(true);
        const rlf_surface *surface = watch(FRAMES);
        if (workers == 1) {
            memcpy(one, surface->background_thickness, sizeof one);
        } else {
            assert_memory_equal(one, surface->background_thickness, sizeof one);
        }
        stop_seeing(NULL);
        rlf_pool_destroy(&pool);
    }
}

TEST_EACH(NULL, stop_seeing)
